"""Linear chains have twins, which the record cannot tell apart; they are found and reported."""

from collections.abc import Callable

import numpy as np
import pytest

from ident.cases import Case, case_from_truth
from ident.learning import fit
from ident.search_space import SearchSpace
from ident.twins import alternatives, find_twins
from models import reduced
from models.massless import Massless
from models.reduced import ReducedModel
from models.trace import Trace


def made(model: ReducedModel, ship: Trace) -> Case:
    return case_from_truth("truth", ship, reduced.simulate(model, ship), 300.0)


def closed_form(model: Massless) -> tuple[float, float]:
    """r1' = r2 (k1 + k2)/k2, r2' = r1 k2/(k1 + k2), with r1 the drag of one length of cable."""
    k1, k2 = model.stiffness
    return model.vehicle_drag * (k1 + k2) / k2 / model.link, model.cable_drag * model.link * k2 / (k1 + k2)


@pytest.mark.parametrize("factor", [0.2, 1.0, 5.0])
def test_two_massless_links_have_the_twin_of_the_closed_form(
    mapped: Callable[[str], ReducedModel], ship: Trace, factor: float
) -> None:
    model = mapped("massless-2-linear")
    assert isinstance(model, Massless)
    model = reduced.with_values(model, [model.cable_drag * factor, model.vehicle_drag])
    assert isinstance(model, Massless)
    space = SearchSpace.of(model)
    twins = find_twins(space, space.coordinates(model), [made(model, ship)])
    assert len(twins) == 1
    np.testing.assert_allclose(twins[0].values, closed_form(model), rtol=1e-6)
    assert twins[0].difference < 1e-9


def test_every_twin_of_two_inertial_links_responds_the_same(mapped: Callable[[str], ReducedModel], ship: Trace) -> None:
    model = mapped("inertial-2-linear")
    case, space = made(model, ship), SearchSpace.of(model)
    twins = find_twins(space, space.coordinates(model), [case])
    assert twins
    for twin in twins:
        other = reduced.with_values(model, twin.values)
        assert np.abs(case.residual(reduced.respond(other, case.drive))).max() < 1e-6
        assert min(twin.values) > 0.0


def test_four_links_have_no_exact_twin_but_a_near_one(mapped: Callable[[str], ReducedModel], ship: Trace) -> None:
    model = mapped("massless-4-linear")
    case, space = made(model, ship), SearchSpace.of(model)
    u = space.coordinates(model)
    assert find_twins(space, u, [case]) == ()
    near = [case.residual(reduced.respond(space.model_at(x), case.drive)) for x in alternatives(space, u, [case])]
    assert any(1e-6 < np.abs(error).max() < 1e-4 for error in near)


@pytest.mark.parametrize("name", ["massless-2-quadratic", "second-order-linear", "massless-1-linear"])
def test_other_models_have_none(mapped: Callable[[str], ReducedModel], ship: Trace, name: str) -> None:
    model = mapped(name)
    space = SearchSpace.of(model)
    assert alternatives(space, space.coordinates(model), [made(model, ship)]) == []


def test_a_twin_is_reported_as_indistinguishable(mapped: Callable[[str], ReducedModel], ship: Trace) -> None:
    model = mapped("massless-2-linear")
    found = fit(reduced.with_values(model, [p.value * 1.05 for p in reduced.parameters(model)]), [made(model, ship)])
    assert found.identifiability is not None
    assert [p.verdict for p in found.identifiability.intervals] == ["no (twin)", "no (twin)"]
    # Of the two, the one near the first guess is given.
    np.testing.assert_allclose(
        [p.value for p in reduced.parameters(found.model)], [p.value for p in reduced.parameters(model)], rtol=1e-3
    )
