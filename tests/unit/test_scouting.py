"""The look around the first guess, and the start points of a guess that is far off."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from ident import scouting
from ident.cases import Case, case_from_truth
from ident.learning import fit
from ident.objective import Objective
from ident.search_space import SearchSpace
from ident.starts import RATIOS, search_all
from ident.total_drag import total_of
from models import reduced
from models.delayed import FirstOrder, SecondOrder
from models.massless import Massless
from models.reduced import ReducedModel
from models.trace import Trace

CHAIN = Massless(
    drag="quadratic", stiffness=np.array([88.0, 81.0, 74.0, 67.0]), link=300.0, cable_drag=14.0, vehicle_drag=2200.0
)
FIRST = FirstOrder(drag="quadratic", spring=0.002, delay=9.0)
SECOND = SecondOrder(drag="linear", spring=0.0065, damping=0.4, delay=9.0)


def case_of(truth: ReducedModel) -> Case:
    t = np.arange(0.0, 1200.0, 2.0)
    ship = Trace.along_x(t, 20.0 * (1.0 - np.cos(0.011 * t)) + 4.0 * np.sin(0.037 * t) ** 2)
    return case_from_truth("made", ship, reduced.simulate(truth, ship), 100.0)


def moved(model: ReducedModel, factors: Sequence[float]) -> ReducedModel:
    values = [parameter.value for parameter in reduced.parameters(model)]
    return reduced.with_values(model, [value * factor for value, factor in zip(values, factors, strict=True)])


def looked(start: ReducedModel, truth: ReducedModel, **fixed: list[str]) -> tuple[Objective, np.ndarray, np.ndarray]:
    """The objective, the guess, and the place that is found from it."""
    space = SearchSpace.of(start, **fixed)
    objective = Objective(space, [case_of(truth)], 1000)
    guess = space.coordinates(start)
    objective.residuals(guess)
    return objective, guess, scouting.scout(objective, guess)


@pytest.mark.parametrize(
    ("truth", "factors", "moves"),
    [(CHAIN, (1.3, 1.3), 6), (CHAIN, (1.3, 0.7), 6), (SECOND, (0.7, 1.3, 0.7), 8), (FIRST, (1.3, 0.7), 4)],
)
def test_a_fair_guess_is_left_where_it_is(truth: ReducedModel, factors: Sequence[float], moves: int) -> None:
    objective, guess, place = looked(moved(truth, factors), truth)
    np.testing.assert_array_equal(place, guess)
    assert objective.simulations == 1 + moves


def test_a_guess_that_nearly_fits_is_not_looked_around() -> None:
    objective, guess, place = looked(moved(CHAIN, (1.001, 0.999)), CHAIN)
    np.testing.assert_array_equal(place, guess)
    assert objective.simulations == 1


@pytest.mark.parametrize("factors", [(100.0, 100.0), (0.01, 0.01), (100.0, 0.01), (1.0, 0.01), (6.0, 1.0 / 6.0)])
def test_a_far_guess_is_left_for_a_better_place(factors: Sequence[float]) -> None:
    objective, guess, place = looked(moved(CHAIN, factors), CHAIN)
    total = total_of(objective.space.model_at(place))
    assert total is not None
    assert total == pytest.approx(total_of(CHAIN), rel=0.5)
    assert objective(place) < 0.3 * objective(guess)


def test_a_held_parameter_is_not_moved() -> None:
    start = moved(CHAIN, (0.01, 1.0))
    _, guess, place = looked(start, CHAIN, fixed=["vehicle_drag"])
    assert place.shape == (1,)
    assert abs(place[0] - math.log(CHAIN.cable_drag)) < 1.0 < abs(guess[0] - math.log(CHAIN.cable_drag))


def test_the_look_stays_in_the_range() -> None:
    objective, _, place = looked(moved(CHAIN, (3000.0, 1e-2)), CHAIN)
    assert (objective.space.lower <= place).all()
    assert (place <= objective.space.upper).all()


@pytest.mark.parametrize("factors", [(0.01, 0.01), (100.0, 0.01), (1.0, 0.01)])
def test_a_far_guess_is_fitted_in_the_right_valley(factors: Sequence[float]) -> None:
    start = moved(CHAIN, factors)
    found = fit(start, [case_of(CHAIN)], profile=False)
    values = [parameter.value for parameter in reduced.parameters(found.model)]
    np.testing.assert_allclose(values, [14.0, 2200.0], rtol=1e-3)
    assert sorted(result.number for result in found.waterfall) == [0, 1, 2]
    first = next(result for result in found.waterfall if result.number == 0)
    assert first.start == pytest.approx([parameter.value for parameter in reduced.parameters(start)])
    assert first.begun != first.start
    assert found.start_rms == first.costs[0]
    assert found.simulations == sum(result.simulations for result in found.waterfall)
    again = fit(start, [case_of(CHAIN)], profile=False)
    assert [result.values for result in again.waterfall] == [result.values for result in found.waterfall]


def test_a_fair_guess_of_a_quadratic_chain_has_one_start() -> None:
    found = fit(moved(CHAIN, (1.3, 1.3)), [case_of(CHAIN)], profile=False)
    assert [result.number for result in found.waterfall] == [0]
    assert found.waterfall[0].begun == found.waterfall[0].start


@pytest.mark.parametrize("drag", ["linear", "quadratic"])
def test_a_far_second_order_starts_at_moderate_damping_too(drag: str) -> None:
    truth = SecondOrder(drag=drag, spring=0.0065, damping=0.4 if drag == "linear" else 2.8, delay=9.0)
    case = case_of(truth)
    space = SearchSpace.of(moved(truth, (100.0, 100.0, 0.01)))
    results, _ = search_all(space, [case], budget=4000, starts=1, seed=0)
    results.sort(key=lambda result: result.number)
    assert len(results) == 1 + len(RATIOS)
    spring, damping, delay = results[0].begun
    speed = math.sqrt(float(case.velocity @ case.velocity) / case.velocity.size)
    share = 1.0 if drag == "linear" else 8.0 / (3.0 * math.pi) * speed
    for result, wanted in zip(results[1:], RATIOS, strict=True):
        a, b, tau = result.start
        assert share * b / (2.0 * math.sqrt(a)) == pytest.approx(wanted)
        assert (a / b, tau) == pytest.approx((spring / damping, delay))
    best = min(results, key=lambda result: result.rms)
    np.testing.assert_allclose(best.values, (truth.spring, truth.damping, truth.delay), rtol=1e-3)


@pytest.mark.parametrize("budget", [1, 5, 12])
def test_the_look_counts_in_the_budget(budget: int) -> None:
    found = fit(CHAIN, [case_of(CHAIN)], budget=budget)
    assert found.simulations <= budget
    assert found.waterfall[0].costs.size == found.waterfall[0].simulations
