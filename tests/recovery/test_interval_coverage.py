"""With the sensor's noise the 95 % intervals cover the truth as often as they should."""

from collections.abc import Callable

import numpy as np
import pytest

from data_synth.sensors import SensorModel, measure
from data_synth.ships import StandardInput, standard_input
from ident.cases import case_from_fixes
from ident.learning import fit
from ident.total_drag import total_of
from models import reduced
from models.reduced import ReducedModel


def coverage(truth: ReducedModel, records: int) -> dict[str, float]:
    """Share of seeded noisy records whose interval covers the true value, by parameter and for the total drag."""
    covered: dict[str, int] = {}
    for seed in range(records):
        rng = np.random.default_rng(seed)
        ship = standard_input(StandardInput(), rng)
        fixes = measure(reduced.simulate(truth, ship), SensorModel(), rng)
        found = fit(truth, [case_from_fixes("noisy", ship, fixes, 300.0)])
        assert found.identifiability is not None
        for p, interval in zip(reduced.parameters(truth), found.identifiability.intervals, strict=True):
            covered[p.name] = covered.get(p.name, 0) + (interval.low <= p.value <= interval.high)
        total, bounds = total_of(truth), found.identifiability.total_drag
        if total is not None and bounds is not None:
            covered["total drag"] = covered.get("total drag", 0) + (bounds.low <= total <= bounds.high)
    return {name: count / records for name, count in covered.items()}


@pytest.mark.parametrize("name", ["massless-1-quadratic", "first-order-linear"])
def test_twenty_records(mapped: Callable[[str], ReducedModel], name: str) -> None:
    shares = coverage(mapped(name), 20)
    assert min(shares.values()) >= 0.85


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "massless-1-quadratic",
        "first-order-linear",
        "first-order-quadratic",
        "second-order-quadratic",
        "inertial-1-quadratic",
        "massless-4-quadratic",
    ],
)
def test_a_hundred_records(mapped: Callable[[str], ReducedModel], name: str) -> None:
    shares = coverage(mapped(name), 100)
    assert all(0.90 <= share <= 0.99 for share in shares.values()), shares
