"""The spectral simulator's errors fall at their rates, and its default keeps its word."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from data_synth.ships import StandardInput, standard_input
from models.spectral import SpectralResult, simulate
from models.spectral.tableau import DEFECT, EMBEDDED, NODES, STAGES
from models.tow import Tow
from models.trace import Trace

NAMES = ["mangus-740", "autec-1200", "mangus-2500"]


def difference(one: SpectralResult, other: SpectralResult, axes: slice = slice(None)) -> float:
    """RMS difference of the vehicle's velocity [m/s]."""
    assert one.vehicle.velocity is not None
    assert other.vehicle.velocity is not None
    gap = (one.vehicle.velocity - other.vehicle.velocity)[:, axes]
    return float(np.sqrt(np.mean(np.sum(gap**2, axis=1))))


@pytest.fixture(scope="module")
def ship() -> Trace:
    return standard_input(StandardInput(), np.random.default_rng(0))


@pytest.fixture(scope="module")
def references(configurations: Callable[[str], Tow], ship: Trace) -> dict[str, SpectralResult]:
    """Each configuration under the standard input, at tolerance 1e-6 with 40 harmonics."""
    return {name: simulate(configurations(name), ship, harmonics=40, tolerance=1e-6) for name in NAMES}


@pytest.mark.parametrize(("name", "harmonics"), [("mangus-740", (6, 9, 14)), ("mangus-2500", (8, 11, 16))])
def test_order_in_harmonics(
    configurations: Callable[[str], Tow],
    ship: Trace,
    references: dict[str, SpectralResult],
    name: str,
    harmonics: tuple[int, ...],
) -> None:
    """Third order or better in the weak form; first in the printed pointwise one, to the same limit."""
    errors = {
        end: [
            difference(
                simulate(configurations(name), ship, harmonics=n, tolerance=1e-6, end_condition=end), references[name]
            )
            for n in harmonics
        ]
        for end in ("weak", "pointwise")
    }
    span = np.log(harmonics[-1] / harmonics[0])
    order = {end: float(np.log(e[0] / e[-1]) / span) for end, e in errors.items()}
    assert order["weak"] >= 3.0, (order, errors)
    assert 0.7 <= order["pointwise"] <= 1.5, (order, errors)
    assert all(p > 10.0 * w for p, w in zip(errors["pointwise"], errors["weak"], strict=True))


@pytest.mark.parametrize("name", NAMES)
def test_the_default_meets_its_tolerance_and_its_estimate_is_honest(
    configurations: Callable[[str], Tow], ship: Trace, references: dict[str, SpectralResult], name: str
) -> None:
    result = simulate(configurations(name), ship)
    true = difference(result, references[name])
    assert result.error is not None
    assert true <= 1e-4
    assert 0.5 * true <= result.error <= 1e-4


@pytest.fixture(scope="module")
def opening(configurations: Callable[[str], Tow]) -> tuple[Tow, Trace, SpectralResult]:
    """Ten minutes of the standard input on the longest cable, with Runge-Kutta at a tight tolerance."""
    tow = configurations("mangus-2500")
    ship = standard_input(StandardInput(duration=600.0), np.random.default_rng(1))
    return tow, ship, simulate(tow, ship, harmonics=10, tolerance=1e-6, stepper="runge-kutta")


def test_newmark_is_of_second_order(opening: tuple[Tow, Trace, SpectralResult]) -> None:
    """In the surge velocity: the heave ringing at 2 rad/s needs smaller steps to be in its asymptotic range."""
    tow, ship, truth = opening
    errors = [
        difference(simulate(tow, ship, harmonics=10, tolerance=1e-6, stepper="newmark", step=h), truth, slice(0, 1))
        for h in (0.5, 0.25, 0.125)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(np.abs(orders - 2.0) < 0.2), (orders, errors)


def test_the_implicit_error_falls_with_the_tolerance(opening: tuple[Tow, Trace, SpectralResult]) -> None:
    tow, ship, truth = opening
    tolerances = np.array([1e-3, 1e-4, 1e-5, 1e-6])
    runs = [simulate(tow, ship, harmonics=10, tolerance=tolerance) for tolerance in tolerances]
    surge = np.array([difference(run, truth, slice(0, 1)) for run in runs])
    both = np.array([difference(run, truth) for run in runs])
    # With the harmonics given there is no companion run to check by: the steps alone stay near the tolerance.
    assert np.all(surge < 1.5 * tolerances), surge
    assert np.all(np.diff(both) < 0.0), both
    assert surge[0] / surge[-1] > 100.0, surge
    assert all(a.steps < b.steps for a, b in pairwise(runs))


def test_runge_kutta_agrees_with_the_implicit_method(opening: tuple[Tow, Trace, SpectralResult]) -> None:
    tow, ship, truth = opening
    assert difference(simulate(tow, ship, harmonics=10, tolerance=1e-5, stepper="runge-kutta"), truth) < 3e-5
    assert difference(simulate(tow, ship, harmonics=10, tolerance=1e-7), truth) < 1e-5


def test_the_tableau_has_its_order_and_is_l_stable() -> None:
    """Conditions of third order; the embedded solution is of second; every stage is of second order."""
    ones, b = np.ones(4), STAGES[-1]
    for weights, third in ((b, True), (EMBEDDED, False)):
        assert weights @ ones == pytest.approx(1.0, abs=1e-14)
        assert weights @ NODES == pytest.approx(1.0 / 2.0, abs=1e-14)
        assert bool(abs(weights @ NODES**2 - 1.0 / 3.0) < 1e-14) is third
        assert bool(abs(weights @ STAGES @ NODES - 1.0 / 6.0) < 1e-14) is third
    np.testing.assert_allclose(STAGES @ NODES, NODES**2 / 2.0, atol=1e-14)
    np.testing.assert_allclose(DEFECT, b - EMBEDDED)
    assert NODES[-1] == pytest.approx(1.0, abs=1e-14)
    # |R(iy)| <= 1 on the imaginary axis and R = 0 at infinity, with y' = z y.
    for y in np.geomspace(1e-2, 1e6, 200):
        assert abs(np.linalg.solve(np.eye(4) - 1j * y * STAGES, ones)[-1]) <= 1.0 + 1e-12
    assert abs(np.linalg.solve(np.eye(4) + 1e9 * STAGES, ones)[-1]) < 1e-6


def test_the_steps_along_a_stiff_cable_follow_the_ship(configurations: Callable[[str], Tow]) -> None:
    """A thousand times as stiff and without loss, the vehicle heaves with the ship: steps alone, no companion run."""
    tow = configurations("mangus-740")
    stiff = replace(tow.cable, axial_stiffness=1e3 * tow.cable.axial_stiffness, axial_damping=0.0)
    t = np.arange(0.0, 120.0, 0.25)
    heave = 0.5 * (1.0 - np.cos(0.8 * t))
    run = simulate(replace(tow, cable=stiff), Trace.along_x(t, np.zeros(t.size), heave), harmonics=4).vehicle
    assert run.velocity is not None
    miss = run.velocity[:, 2] - 0.4 * np.sin(0.8 * t)
    assert np.sqrt(np.mean(miss**2)) < 5e-3
