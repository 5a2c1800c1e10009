"""Noise-free records give parameters back, from starts 30 % off."""

from collections.abc import Callable

import numpy as np
import pytest

from ident.cases import case_from_truth
from ident.learning import fit
from models import reduced
from models.reduced import ReducedModel
from models.trace import Trace

#: 30 % off, in directions that do not cancel.
STARTS = ((1.3, 0.7, 1.3, 0.7), (0.7, 0.7, 0.7, 1.3))


def values(model: ReducedModel) -> np.ndarray:
    return np.array([p.value for p in reduced.parameters(model)])


@pytest.mark.parametrize("factors", STARTS)
@pytest.mark.parametrize(
    "name",
    [
        "second-order-linear",
        "second-order-quadratic",
        "first-order-linear",
        "first-order-quadratic",
        "massless-4-quadratic",
        "inertial-4-quadratic",
    ],
)
def test_parameters_come_back(
    mapped: Callable[[str], ReducedModel], ship: Trace, name: str, factors: tuple[float, ...]
) -> None:
    truth = mapped(name)
    case = case_from_truth("truth", ship, reduced.simulate(truth, ship), 300.0)
    start = reduced.with_values(truth, values(truth) * factors[: values(truth).size])
    found = fit(start, [case])
    assert found.outcome == "converged"
    assert found.start_rms > 1e-3
    np.testing.assert_allclose(values(found.model), values(truth), rtol=1e-3)


@pytest.mark.parametrize("factors", STARTS)
@pytest.mark.parametrize("name", ["massless-2-linear", "massless-4-linear", "inertial-2-linear", "inertial-4-linear"])
def test_the_response_of_a_linear_chain_comes_back(
    mapped: Callable[[str], ReducedModel], ship: Trace, name: str, factors: tuple[float, ...]
) -> None:
    truth = mapped(name)
    case = case_from_truth("truth", ship, reduced.simulate(truth, ship), 300.0)
    start = reduced.with_values(truth, values(truth) * factors[: values(truth).size])
    found = fit(start, [case])
    error = case.residual(reduced.respond(found.model, case.drive))
    assert np.abs(error).max() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 5))
@pytest.mark.parametrize("name", reduced.MODEL_NAMES)
def test_other_inputs(mapped: Callable[[str], ReducedModel], name: str, seed: int) -> None:
    from data_synth.ships import StandardInput, standard_input

    truth = mapped(name)
    ship = standard_input(StandardInput(), np.random.default_rng(seed))
    case = case_from_truth("truth", ship, reduced.simulate(truth, ship), 300.0)
    factors = np.random.default_rng(seed).choice([0.7, 1.3], values(truth).size)
    found = fit(reduced.with_values(truth, values(truth) * factors), [case])
    if reduced.info(truth).links and truth.drag == "linear":
        assert np.abs(case.residual(reduced.respond(found.model, case.drive))).max() < 1e-6
    else:
        np.testing.assert_allclose(values(found.model), values(truth), rtol=1e-3)
