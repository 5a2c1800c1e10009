"""The winch against the statics of the longer cable, and the depth regulator against its own promises."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from data_synth.ships import Sinusoids, sinusoids
from models.spectral import DepthWinch, Payout, simulate
from models.statics import static_shape
from models.tow import Tow
from models.trace import Trace


def still(duration: float, speed: float = 0.0) -> Trace:
    t = np.arange(0.0, duration + 0.5)
    return Trace.along_x(t, speed * t)


@pytest.mark.parametrize("stepper", ["implicit", "newmark", "runge-kutta"])
@pytest.mark.parametrize("length", [30.0, -25.0])
def test_payout_lowers_the_vehicle_by_the_cable_and_its_stretch(
    configurations: Callable[[str], Tow], stepper: str, length: float
) -> None:
    tow = configurations("mangus-740")
    winch = Payout(t=[0.0, 10.0, 200.0], length=[0.0, 0.0, length])
    result = simulate(tow, still(400.0), harmonics=4, winch=winch, stepper=stepper, step=0.2)
    W, w, EA = 6000.0, tow.cable.weight_in_water, tow.cable.axial_stiffness
    deep = [a + (W * a + 0.5 * w * a**2) / EA for a in (740.0, 740.0 + length)]
    lowered = result.vehicle.position[0, 2] - result.vehicle.position[-1, 2]
    assert lowered == pytest.approx(deep[1] - deep[0], abs=5e-4)
    assert abs(lowered - length) > 0.01
    assert result.vehicle.tension is not None
    np.testing.assert_allclose(result.vehicle.tension[-1], [W + w * (740.0 + length), W], rtol=1e-4)
    x, z = result.cable_at(400)
    np.testing.assert_allclose([x[0], z[0]], result.vehicle.position[-1, [0, 2]], atol=1e-9)
    np.testing.assert_allclose([x[-1], z[-1]], [0.0, 0.0], atol=1e-9)


def test_payout_under_tow_settles_near_the_shape_of_the_longer_cable(configurations: Callable[[str], Tow]) -> None:
    """Exact to the first order in the added length."""
    tow = replace(configurations("mangus-740"), speed=0.4)
    place, tension = [], []
    for length in (30.0, 15.0):
        winch = Payout(t=[0.0, 10.0, 400.0], length=[0.0, 0.0, length])
        result = simulate(tow, still(6000.0, 0.4), harmonics=10, winch=winch)
        due = static_shape(replace(tow, cable=replace(tow.cable, length=740.0 + length)))
        got = result.vehicle.position[-1] - result.ship.position[-1]
        place.append(np.hypot(got[0] - due.x[0], got[2] - due.z[0]))
        assert result.vehicle.tension is not None
        tension.append(result.vehicle.tension[-1, 0] - due.T[-1])
    # Of the trail's own change of metres, under a millimetre is missed.
    assert abs(static_shape(tow).trail - due.trail) > 1.0
    assert max(place) < 1e-3, place
    assert tension[0] / tension[1] == pytest.approx(4.0, abs=0.5)


@pytest.mark.parametrize("change", [12.0, -8.0])
def test_the_regulator_reaches_the_depth_within_its_limits(configurations: Callable[[str], Tow], change: float) -> None:
    tow = configurations("mangus-740")
    winch = DepthWinch(t=[30.0], change=[change], rate_limit=0.2, acceleration_limit=0.02)
    result = simulate(tow, still(900.0), harmonics=3, winch=winch)
    assert result.payout is not None
    lowered = result.vehicle.position[0, 2] - result.vehicle.position[:, 2]
    assert np.abs(lowered[:30]).max() < 1e-6
    assert np.abs(lowered[-200:] - change).max() < 0.1
    rate = np.diff(result.payout)
    assert np.abs(rate).max() == pytest.approx(0.2, abs=0.002)
    assert np.abs(np.diff(rate)).max() < 0.0202
    assert np.abs(result.payout).max() < abs(change) * 1.3


def test_the_regulator_holds_depth_against_a_slow_change_of_speed(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    t = np.arange(0.0, 2001.0)
    ship = Trace.along_x(t, 0.6 * (t + 300.0 * np.expm1(-t / 300.0)))
    free = simulate(tow, ship, harmonics=8).vehicle.position[:, 2]
    held = simulate(tow, ship, harmonics=8, winch=DepthWinch(t=[0.0], change=[0.0])).vehicle.position[:, 2]
    assert free[-1] - free[0] > 5.0
    assert np.abs(held - held[0]).max() < 0.3


def test_the_drum_stops_at_a_twentieth_of_the_cable(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    result = simulate(tow, still(400.0), harmonics=3, winch=DepthWinch(t=[0.0], change=[60.0]))
    assert result.payout is not None
    assert result.payout.max() <= 37.0 + 1e-9
    assert result.payout[-1] == pytest.approx(37.0, abs=0.1)
    rate = np.diff(result.payout)
    assert rate.min() > -1e-6
    assert np.abs(np.diff(rate)).max() < 0.0502


def test_the_regulator_in_waves_agrees_between_steppers(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    ship = sinusoids(
        Sinusoids(
            duration=120.0,
            sample=0.5,
            surge_amplitudes=(5.0,),
            surge_omegas=(0.1,),
            heave_amplitudes=(0.2,),
            heave_omegas=(0.6,),
        )
    )
    winch = DepthWinch(t=[10.0], change=[5.0])
    one, two = (
        simulate(tow, ship, harmonics=6, tolerance=1e-5, winch=winch, stepper=stepper)
        for stepper in ("implicit", "runge-kutta")
    )
    assert one.payout is not None
    assert two.payout is not None
    np.testing.assert_allclose(one.payout, two.payout, atol=2e-3)
    np.testing.assert_allclose(one.vehicle.position, two.vehicle.position, atol=3e-3)
