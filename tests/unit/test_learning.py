"""The search: cases, coordinates, outcomes, and runs side by side."""

import math

import numpy as np
import pytest

from ident import objective
from ident.cases import Case, case_from_fixes, case_from_truth
from ident.learning import Job, fit, fit_many
from ident.objective import Objective, rms
from ident.search_space import SearchSpace
from models import reduced
from models.delayed import FirstOrder, SecondOrder
from models.drive import Drive
from models.massless import Massless
from models.quantity import InvalidInput, NumericalFailure
from models.reduced import ReducedModel, Response
from models.trace import Trace

FIRST = FirstOrder(drag="quadratic", spring=0.002, delay=10.0)
SECOND = SecondOrder(drag="quadratic", spring=0.0065, damping=2.8, delay=9.0)


def winding_ship(duration: float = 1200.0, step: float = 2.0) -> Trace:
    t = np.arange(0.0, duration + step, step)
    velocity = 0.25 * np.sin(0.011 * t) + 0.15 * np.sin(0.037 * t + 1.0)
    return Trace.along_x(t, 1000.0 + np.concatenate([[0.0], np.cumsum(0.5 * step * (velocity[1:] + velocity[:-1]))]))


SHIP = winding_ship()


def made(model: ReducedModel, settle: float = 100.0, ship: Trace = SHIP) -> Case:
    return case_from_truth("made", ship, reduced.simulate(model, ship), settle)


def values(model: ReducedModel) -> list[float]:
    return [p.value for p in reduced.parameters(model)]


# Cases


def test_the_settling_time_is_not_scored() -> None:
    case = made(FIRST, settle=500.0)
    assert case.time[0] == 500.0
    assert np.all(case.residual(reduced.respond(FIRST, case.drive)) == 0.0)


def test_gaps_of_the_vehicle_are_not_scored() -> None:
    track = reduced.simulate(FIRST, SHIP)
    position = np.array(track.position)
    position[200:260] = np.nan
    case = case_from_truth("gap", SHIP, Trace(t=track.t, position=position, velocity=track.velocity), 100.0)
    assert not np.any((case.time >= track.t[200]) & (case.time <= track.t[259]))


def test_too_few_samples_are_refused() -> None:
    with pytest.raises(InvalidInput, match="at least 20 scored samples, but 19"):
        made(FIRST, settle=1164.0)


def test_a_vehicle_on_its_own_times_is_compared_there() -> None:
    times = np.arange(3.3, 1190.0, 7.7)
    fine = Trace.along_x(np.union1d(SHIP.t, times), SHIP.at(np.union1d(SHIP.t, times))[:, 0])
    track = reduced.simulate(SECOND, fine)
    keep = np.isin(track.t, times)
    assert track.velocity is not None
    vehicle = Trace(t=track.t[keep], position=track.position[keep], velocity=track.velocity[keep])
    case = case_from_truth("own times", SHIP, vehicle, 100.0)
    assert np.abs(case.residual(reduced.respond(SECOND, case.drive))).max() < 1e-4


def fixes_of(model: ReducedModel, offset: float = 0.0) -> Trace:
    track = reduced.simulate(model, SHIP)
    position = np.array(track.position[::5])
    position[:, 0] += offset
    position[30:33] = np.nan
    return Trace(t=track.t[::5], position=position)


@pytest.mark.parametrize("smoother", [False, True])
def test_the_model_passes_the_operator_of_the_fixes(smoother: bool) -> None:
    vehicle = fixes_of(FIRST, offset=40.0)
    if smoother:
        from data_synth.sensors import usbl_smoother

        keep = vehicle.valid
        published = np.array(vehicle.position)
        smooth = usbl_smoother(vehicle.t[keep])
        published[keep, 0] = smooth.published(vehicle.position[keep, 0], SHIP.spline(vehicle.t[keep], 1)[:, 0])
        vehicle = Trace(t=vehicle.t, position=published)
    case = case_from_fixes("fixes", SHIP, vehicle, 100.0, smoother=smoother)
    response = reduced.respond(FIRST, case.drive)
    assert case.time.size > 80
    assert np.abs(case.residual(response)).max() < 1e-9
    np.testing.assert_allclose(case.model_position(response) + 40.0, case.position, atol=1e-6)


def test_part_of_a_record() -> None:
    whole = case_from_fixes("fixes", SHIP, fixes_of(FIRST), 100.0)
    part = whole.between(100.0, 600.0)
    rest = whole.between(600.0, 1e9)
    assert part.time.max() < 600.0 <= rest.time.min()
    assert part.time.size + rest.time.size == whole.time.size
    response = reduced.respond(SECOND, whole.drive)
    joined = np.concatenate([part.residual(response), rest.residual(response)])
    np.testing.assert_allclose(joined, whole.residual(response), atol=1e-15)


# Coordinates and cost


def test_coordinates_return_the_values() -> None:
    space = SearchSpace.of(SECOND)
    np.testing.assert_allclose(values(space.model_at(space.coordinates(SECOND))), values(SECOND), rtol=1e-13)


def test_coordinates_outside_the_range_are_clipped_and_cost_more() -> None:
    space = SearchSpace.of(FIRST)
    case = made(FIRST)
    outside = space.coordinates(FIRST)
    outside[1] = space.lower[1] - 0.5
    cost = Objective(space, [case], 10)
    assert cost(outside) == pytest.approx(1.5 * cost(np.maximum(outside, space.lower)))
    assert space.values_at(outside)[1] == pytest.approx(0.01)


def test_the_cost_is_the_rms_over_all_records() -> None:
    long, short = made(FIRST), made(FIRST, settle=600.0)
    errors = [case.residual(reduced.respond(SECOND, case.drive)) for case in (long, short)]
    space = SearchSpace.of(SECOND)
    assert Objective(space, [long, short], 10)(space.coordinates(SECOND)) == pytest.approx(rms(np.concatenate(errors)))


# Outcomes


def test_converged() -> None:
    found = fit(FirstOrder(drag="quadratic", spring=0.0026, delay=13.0), [made(FIRST)])
    assert found.outcome == "converged"
    assert found.reason.startswith("The fit is exact to rounding")
    np.testing.assert_allclose(values(found.model), values(FIRST), rtol=1e-3)
    assert found.simulations == found.costs.size
    assert found.costs[0] == found.start_rms
    assert found.costs.min() == found.rms


def test_a_fit_with_model_error_converges_by_its_last_restart() -> None:
    found = fit(FIRST, [made(SecondOrder(drag="linear", spring=0.0065, damping=0.6, delay=9.0))])
    assert found.rms > 1e-3
    assert found.gains[-1] < 1e-4
    assert found.outcome == "converged"


def test_a_parameter_at_the_end_of_its_range_is_no_convergence() -> None:
    # A model without a delay, answered by one whose delay must be above 0.01 s.
    found = fit(FIRST, [made(FirstOrder(drag="quadratic", spring=0.002, delay=0.0))])
    assert found.outcome == "bound"
    assert found.at_bound == ("delay",)
    assert "delay ended at the end of the search range" in found.reason
    assert found.identifiability is not None
    assert found.identifiability.intervals[1].verdict == "no (bound)"


def test_a_spent_budget_is_no_convergence() -> None:
    found = fit(SecondOrder(drag="quadratic", spring=0.01, damping=2.0, delay=5.0), [made(SECOND)], budget=25)
    assert found.outcome == "budget"
    assert found.simulations <= 25
    assert found.rms < found.start_rms


def test_a_budget_below_one_comparison() -> None:
    case = made(FIRST)
    found = fit(FIRST, [case, case], budget=1)
    assert found.outcome == "budget"
    assert found.simulations == 0
    assert values(found.model) == values(FIRST)


def test_a_flat_direction_is_no_convergence() -> None:
    # The mass of a vehicle of no weight in the motion: a first-order record says nothing of it.
    start = SecondOrder(drag="linear", spring=1.0, damping=500.0, delay=10.0)
    found = fit(start, [made(FirstOrder(drag="linear", spring=0.002, delay=10.0))])
    assert found.outcome == "flat"
    assert "other values would do as well" in found.reason
    assert found.identifiability is not None
    assert any(not p.determined for p in found.identifiability.intervals)


def test_a_start_that_cannot_be_simulated_is_a_failed_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(model: ReducedModel, drive: Drive) -> Response:
        raise NumericalFailure("node 3 left the finite range at t = 12 s")

    case = made(FIRST)
    monkeypatch.setattr(objective.reduced, "respond", fail)
    found = fit(FIRST, [case])
    assert found.outcome == "failed"
    assert "node 3 left the finite range" in found.reason
    assert found.failures == 1
    assert values(found.model) == values(FIRST)
    assert math.isinf(found.rms)
    assert found.identifiability is None


def test_failed_simulations_on_the_way_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    respond = reduced.respond

    def picky(model: ReducedModel, drive: Drive) -> Response:
        assert isinstance(model, FirstOrder)
        if model.delay < 9.5:
            raise NumericalFailure("no")
        return respond(model, drive)

    case = made(FIRST)
    monkeypatch.setattr(objective.reduced, "respond", picky)
    found = fit(FirstOrder(drag="quadratic", spring=0.0026, delay=14.0), [case])
    assert found.failures > 0
    np.testing.assert_allclose(values(found.model), values(FIRST), rtol=1e-3)


# Options


def test_fixed_parameters_keep_their_values() -> None:
    start = SecondOrder(drag="quadratic", spring=0.009, damping=2.0, delay=9.0)
    found = fit(start, [made(SECOND)], fixed=["delay"])
    assert found.names == ("spring", "damping")
    np.testing.assert_allclose(values(found.model), values(SECOND), rtol=1e-3)
    assert values(found.model)[2] == 9.0


@pytest.mark.parametrize(
    ("fixed", "message"), [(["tau"], "spring, delay, but tau"), (["spring", "delay"], "at least one")]
)
def test_what_cannot_be_fixed(fixed: list[str], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        fit(FIRST, [made(FIRST)], fixed=fixed)


def test_a_fit_needs_a_record() -> None:
    with pytest.raises(InvalidInput, match="got 0 records"):
        fit(FIRST, [])


def test_more_starts_make_a_sorted_waterfall() -> None:
    found = fit(FIRST, [made(SECOND)], starts=3, seed=5)
    assert len(found.waterfall) == 3
    assert sorted(result.number for result in found.waterfall) == [0, 1, 2]
    costs = [result.rms for result in found.waterfall]
    assert costs == sorted(costs)
    again = fit(FIRST, [made(SECOND)], starts=3, seed=5)
    assert [result.start for result in again.waterfall] == [result.start for result in found.waterfall]


def test_fits_side_by_side_are_those_one_after_another() -> None:
    case = made(SECOND)
    chain = Massless(drag="linear", stiffness=np.array([24.0, 22.0]), link=600.0, cable_drag=3.0, vehicle_drag=900.0)
    jobs = [Job(model=model, cases=[case]) for model in (FIRST, chain, SECOND)]
    order: list[int] = []
    together = fit_many(jobs, workers=2, done=lambda place, _: order.append(place))
    alone = fit_many(jobs, workers=1)
    assert sorted(order) == [0, 1, 2]
    for one, other in zip(together, alone, strict=True):
        assert values(one.model) == values(other.model)
        assert (one.rms, one.simulations, one.reason) == (other.rms, other.simulations, other.reason)
