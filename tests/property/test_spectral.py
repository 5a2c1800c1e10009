"""What must hold of every spectral run."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from models.current import Current
from models.spectral import STEPPERS, simulate
from models.tow import Tow
from models.trace import Trace

FEW = settings(
    max_examples=8, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True
)
TIMES = np.arange(0.0, 121.0)
#: Fixed steps: an adaptive one may differ by a step, within its tolerance, when a number is rounded otherwise.
FIXED = {"stepper": "newmark", "step": 0.25, "tolerance": 1e-5}
motions = st.tuples(st.floats(-0.6, 0.6), st.floats(0.5, 10.0), st.floats(0.02, 0.1), st.floats(0.0, 0.3))


def track(motion: tuple[float, float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Surge and heave [m]: a steady speed, a sinusoid in surge and one in heave."""
    speed, amplitude, omega, heave = motion
    return speed * TIMES + amplitude * np.sin(omega * TIMES), heave * (1.0 - np.cos(0.3 * TIMES))


@FEW
@given(motion=motions, place=st.floats(-5e6, 5e6), start=st.floats(-1e5, 1e5))
def test_shifting_place_and_time_loses_nothing(
    configurations: Callable[[str], Tow], motion: tuple[float, float, float, float], place: float, start: float
) -> None:
    tow = replace(configurations("mangus-740"), speed=0.2)
    x, z = track(motion)
    here = simulate(tow, Trace.along_x(TIMES, x, z), harmonics=5, **FIXED).vehicle
    there = simulate(tow, Trace.along_x(TIMES + start, x + place, z), harmonics=5, **FIXED).vehicle
    np.testing.assert_allclose(there.velocity, here.velocity, atol=1e-6)
    np.testing.assert_allclose(there.position[:, 0] - place, here.position[:, 0], atol=1e-6)
    np.testing.assert_allclose(there.tension, here.tension, rtol=1e-6)


@FEW
@given(motion=motions, speed=st.floats(-0.5, 0.5), surface=st.floats(-0.4, 0.4))
def test_mirror(
    configurations: Callable[[str], Tow], motion: tuple[float, float, float, float], speed: float, surface: float
) -> None:
    x, z = track(motion)
    runs = []
    for sign in (1.0, -1.0):
        current = Current.from_profile([0.0, 500.0], [sign * surface, 0.0])
        tow = replace(configurations("mangus-740"), speed=sign * speed, current=current)
        runs.append(simulate(tow, Trace.along_x(TIMES, sign * x, z), harmonics=5, **FIXED).vehicle)
    np.testing.assert_allclose(runs[1].position * [-1.0, 1.0, 1.0], runs[0].position, atol=1e-6)
    np.testing.assert_allclose(runs[1].velocity * [-1.0, 1.0, 1.0], runs[0].velocity, atol=1e-6)


@FEW
@given(motion=motions, speed=st.floats(-0.8, 0.8))
def test_a_tow_in_still_water_is_a_still_ship_in_a_current(
    configurations: Callable[[str], Tow], motion: tuple[float, float, float, float], speed: float
) -> None:
    tow = configurations("mangus-740")
    x, z = track(motion)
    ship = Trace.along_x(TIMES, x + speed * TIMES, z)
    towed = simulate(replace(tow, speed=speed), ship, harmonics=5, **FIXED).vehicle
    still = replace(tow, current=Current.uniform(-speed))
    held = simulate(still, Trace.along_x(TIMES, x, z), harmonics=5, **FIXED).vehicle
    np.testing.assert_allclose(towed.position[:, 0] - speed * TIMES, held.position[:, 0], atol=1e-6)
    np.testing.assert_allclose(towed.position[:, 2], held.position[:, 2], atol=1e-6)
    np.testing.assert_allclose(towed.tension, held.tension, rtol=1e-6)


@FEW
@given(motion=motions, wait=st.integers(1, 60))
def test_a_later_motion_gives_the_same_response_later(
    configurations: Callable[[str], Tow], motion: tuple[float, float, float, float], wait: int
) -> None:
    tow = configurations("mangus-740")
    # From rest to rest smoothly, so that the splines of both tracks agree.
    s = np.clip(TIMES / 60.0, 0.0, 1.0)
    x = 60.0 * motion[0] * s**4 * (35.0 - 84.0 * s + 70.0 * s**2 - 20.0 * s**3)
    now = simulate(tow, Trace.along_x(TIMES, x), harmonics=5, tolerance=1e-6).vehicle
    t = np.arange(0.0, 121.0 + wait)
    later = simulate(tow, Trace.along_x(t, np.append(np.zeros(wait), x)), harmonics=5, tolerance=1e-6).vehicle
    np.testing.assert_allclose(later.position[wait:, 0], now.position[:, 0], atol=2e-4)
    assert np.abs(later.velocity[:wait]).max() < 1e-4


@pytest.mark.parametrize("stepper", STEPPERS)
@pytest.mark.parametrize("speed", [0.0, 0.4])
def test_no_input_no_motion(configurations: Callable[[str], Tow], stepper: str, speed: float) -> None:
    tow = replace(configurations("mangus-740"), speed=speed, current=Current.from_profile([0.0, 700.0], [0.3, 0.0]))
    ship = Trace.along_x(TIMES, speed * TIMES)
    result = simulate(tow, ship, harmonics=6, stepper=stepper)
    at_rest = result.vehicle.velocity - [speed, 0.0, 0.0]
    # The series stands on a shape that was integrated to 1e-8: what is left is its residual force.
    assert np.abs(at_rest).max() < 1e-5
    assert np.abs(result.amplitudes).max() < 1e-3


def test_identical_runs(configurations: Callable[[str], Tow]) -> None:
    x, z = track((0.3, 5.0, 0.05, 0.1))
    one, two = (simulate(configurations("mangus-740"), Trace.along_x(TIMES, x, z)) for _ in range(2))
    assert np.array_equal(one.vehicle.position, two.vehicle.position)
    assert np.array_equal(one.vehicle.tension, two.vehicle.tension)
    assert np.array_equal(one.amplitudes, two.amplitudes)
    assert (one.steps, one.error) == (two.steps, two.error)


@FEW
@given(reach=st.floats(2.0, 30.0), drag=st.sampled_from([0.0, 0.5, 1.6]))
def test_energy_never_grows_without_input(configurations: Callable[[str], Tow], reach: float, drag: float) -> None:
    """Kinetic energy of vehicle and cable, T_s phi^2/2, and the elastic energy, once the ship has stopped."""
    tow = configurations("mangus-740")
    cable = replace(
        tow.cable,
        normal_drag_coefficient=drag,
        tangential_drag_coefficient=0.05 * drag,
        axial_damping=0.02 * drag,
    )
    tow = replace(tow, cable=cable, vehicle=replace(tow.vehicle, drag_coefficient=drag))
    t = np.arange(0.0, 240.0, 0.25)
    s = np.clip(t / 40.0, 0.0, 1.0)
    x = reach * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    result = simulate(tow, Trace.along_x(t, x), harmonics=6, tolerance=1e-6)
    free = t > 45.0
    y = result.amplitudes
    rate = CubicSpline(t, y)(t, 1)
    sigma = np.linspace(0.0, 1.0, 401)
    n = np.arange(1, 7)
    basis = np.vstack([1.0 - sigma, np.sin(np.pi * n[:, None] * sigma)])
    slopes = np.vstack([-np.ones_like(sigma), n[:, None] * np.pi * np.cos(np.pi * n[:, None] * sigma)]) / 740.0
    tension = 6000.0 + cable.weight_in_water * 740.0 * sigma
    strain = tension / cable.axial_stiffness
    q_t = rate[free][:, 1:] @ basis
    phi = (y[free][:, 1:] @ slopes - x[-1] / 740.0) / (1.0 + strain)
    stretch = -y[free][:, 0] + 0.5 * 740.0 * np.trapezoid(phi**2, sigma, axis=1)
    vehicle = 0.5 * (760.0 + 545.0) * np.sum(rate[free][:, :2] ** 2, axis=1)
    lateral = 0.5 * 740.0 * (cable.mass + 0.24) * np.trapezoid(q_t**2, sigma, axis=1)
    bent = 0.5 * 740.0 * np.trapezoid(tension * (1.0 + strain) * phi**2, sigma, axis=1)
    bent -= 0.5 * 740.0 * np.trapezoid(tension * strain * phi**2, sigma, axis=1)
    elastic = 0.5 * cable.axial_stiffness / 740.0 * stretch**2
    energy = vehicle + lateral + bent + elastic
    inner = slice(4, -4)
    assert np.all(np.diff(energy[inner]) < 2e-4 * energy.max())
    if drag == 0.0:
        np.testing.assert_allclose(energy[inner], energy[4], rtol=1e-3)
    else:
        assert energy[-5] < 0.9 * energy[4]
