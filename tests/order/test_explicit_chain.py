"""The explicit stepper of the quadratic chains: order, limit of stability, error estimate, and where it is chosen."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ident.configuration import load
from models import chain, reduced
from models.chain import Chain, quadratic_motion
from models.drive import Drive
from models.explicit_chain import RADIUS, largest_frequency
from models.inertial import Inertial
from models.quantity import NumericalFailure
from models.statics import static_shape
from models.trace import Trace

Floats = NDArray[np.float64]
TOW = load("autec-1200").tow
SHAPE = static_shape(TOW)
#: Two links that swing, with drag that a step of a second carries.
SLOW = Chain(np.array([400.0, 350.0]), np.array([900.0, 700.0]), np.array([2500.0, 3000.0]))


def nodes(name: str) -> Chain:
    return reduced.section(name, TOW, SHAPE).chain()


def wandering(sample: float = 1.0) -> Trace:
    """From rest, and to and fro at up to 0.36 m/s."""
    t = np.arange(0.0, 600.0 + sample, sample)
    return Trace.along_x(t, 12.0 * (1.0 - np.cos(0.03 * t)))


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize("loose", [1.0, 0.3])
def test_order_four(loose: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chain, "STEP_ERROR", np.inf)
    of = SLOW._replace(r=loose * SLOW.r)
    ship = wandering(4.0)

    def run(step: float) -> Floats:
        return quadratic_motion(of, Drive.from_trace(ship, max_step=step), path="explicit").v

    exact = run(1 / 64)
    errors = [rms(run(step) - exact) for step in (1.0, 0.5, 0.25, 0.125)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] > 1e-12, "the errors must stand above rounding to show an order"
    assert np.all(np.abs(orders - 4.0) < 0.2), (orders, errors)


def test_the_half_disc_is_stable_and_a_larger_one_is_not() -> None:
    def growth(radius: float) -> float:
        # A polynomial is largest on the boundary: the arc and the imaginary axis.
        z = radius * np.exp(1j * np.linspace(0.5 * np.pi, np.pi, 20001))
        z = np.append(z, 1j * np.linspace(0.0, radius, 20001))
        return float(np.abs(1.0 + z + z**2 / 2.0 + z**3 / 6.0 + z**4 / 24.0).max())

    assert growth(RADIUS) <= 1.0 + 1e-12
    assert growth(1.01 * RADIUS) > 1.0


@pytest.mark.parametrize("n", [1, 2, 5, 64])
def test_the_largest_frequency_is_a_sharp_bound(n: int) -> None:
    rng = np.random.default_rng(n)
    k, m = rng.uniform(20.0, 90.0, n), 10.0 ** rng.uniform(-2.0, 4.0, n)
    K = np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    exact = float(np.sqrt(np.linalg.eigvalsh(K / np.sqrt(np.outer(m, m)))[-1]))
    assert exact * (1.0 - 1e-12) <= largest_frequency(k, m) <= 1.001 * exact
    assert largest_frequency(k, np.append(m[1:], 0.0)) == np.inf


@pytest.mark.parametrize("name", ["second-order-quadratic", "inertial-1-quadratic", "inertial-16-quadratic"])
def test_both_steppers_agree(name: str) -> None:
    ship = wandering()
    explicit = quadratic_motion(nodes(name), Drive.from_trace(ship), path="explicit")
    implicit = quadratic_motion(nodes(name), Drive.from_trace(ship, max_step=1 / 64), path="implicit")
    np.testing.assert_allclose(explicit.v, implicit.v, atol=1e-6)
    np.testing.assert_allclose(explicit.x, implicit.x, atol=1e-5)


@pytest.mark.parametrize("name", ["second-order-quadratic", "inertial-4-quadratic", "inertial-16-quadratic"])
def test_an_ordinary_tow_is_explicit_all_along(name: str) -> None:
    drive = Drive.from_trace(wandering())
    either, explicit, implicit = (
        quadratic_motion(nodes(name), drive, path=path).v for path in ("either", "explicit", "implicit")
    )
    np.testing.assert_array_equal(either, explicit)
    assert not np.array_equal(either, implicit)


@pytest.mark.parametrize("share", [1e-6, 1e-3])
def test_a_tow_of_next_to_no_mass_stays_implicit(share: float) -> None:
    model = reduced.section("inertial-4-quadratic", TOW, SHAPE)
    assert isinstance(model, Inertial)
    light = replace(model, cable_mass=share * model.cable_mass, vehicle_mass=share * model.vehicle_mass).chain()
    drive = Drive.from_trace(wandering())
    either, implicit = (quadratic_motion(light, drive, path=path).v for path in ("either", "implicit"))
    np.testing.assert_allclose(either, implicit, atol=5e-9)
    with pytest.raises(NumericalFailure, match=r"need .* steps for the 1 s after t = 0 s, but may take 8; give a sho"):
        quadratic_motion(light, drive, path="explicit")


def test_where_drag_grows_too_fast_the_implicit_stepper_takes_over_and_hands_back() -> None:
    """Five knots in the middle of the record: drag slows the cable's nodes at 50 1/s there."""
    t = np.arange(0.0, 2401.0)
    burst = 2.5 * np.exp(-(((t - 500.0) / 60.0) ** 2))
    ship = Trace.along_x(t, np.cumsum(0.2 + 0.15 * np.sin(0.05 * t) + burst))
    of = nodes("inertial-4-quadratic")
    drive = Drive.from_trace(ship)
    with pytest.raises(NumericalFailure, match="explicit stepper would need"):
        quadratic_motion(of, drive, path="explicit")
    either, implicit = (quadratic_motion(of, drive, path=path).v for path in ("either", "implicit"))
    exact = quadratic_motion(of, Drive.from_trace(ship, max_step=1 / 32), path="implicit").v
    assert rms(either - exact) < 1.1 * rms(implicit - exact)
    for calm in (t < 250.0, t > 1500.0):
        assert rms((either - exact)[calm]) < 0.1 * rms((implicit - exact)[calm])


def test_the_error_estimate_shortens_the_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    swinging = Chain(np.array([100.0]), np.array([50.0]), np.array([400.0]))
    t = np.arange(0.0, 400.0, 2.0)
    ship = Trace.along_x(t, 2.0 * np.sin(0.45 * t) * np.minimum(t / 100.0, 1.0))
    exact = quadratic_motion(swinging, Drive.from_trace(ship, max_step=1 / 64)).v

    def error(allowed: float) -> float:
        monkeypatch.setattr(chain, "STEP_ERROR", allowed)
        return rms(quadratic_motion(swinging, Drive.from_trace(ship, max_step=2.0), path="explicit").v - exact)

    assert error(0.005) < 0.2 * error(np.inf)
    with pytest.raises(NumericalFailure, match="explicit stepper would need"):
        error(1e-9)
