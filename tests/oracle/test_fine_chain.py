"""The fine chain against independently written equations, closed forms, and the spectral simulator."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh_tridiagonal

from data_synth.ships import StandardInput, standard_input
from ident import truth
from ident.configuration import builtin_names, load
from models import fine_chain
from models.current import Current
from models.quantity import InvalidInput
from models.statics import static_shape
from models.tow import Tow
from models.trace import Trace

TOWS = ("mangus-740", "autec-1200", "mangus-2500")
STANDING = Trace.along_x(np.arange(0.0, 301.0), np.zeros(301))


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def velocity(tow: Tow, ship: Trace, **resolution: float) -> np.ndarray:
    trace = fine_chain.simulate(tow, ship, **resolution).vehicle  # type: ignore[arg-type]
    assert trace.velocity is not None
    return trace.velocity[:, 0]


def eased_sine(t: np.ndarray) -> np.ndarray:
    """A ship that starts at rest and without a jump of speed or of acceleration."""
    return 15.0 * (1.0 - np.exp(-((t / 40.0) ** 3))) * np.sin(0.05 * t)


def test_agrees_with_equations_written_anew_and_integrated_by_scipy() -> None:
    """Forces of all links as differences along the cable, tension W + w s of a hanging cable; scipy steps it."""
    tow = load("mangus-740").tow
    cable, body, n = tow.cable, tow.vehicle, 60
    part = cable.length / n
    ship = Trace.along_x(t := np.arange(0.0, 181.0), eased_sine(t))
    height = cable.length - (np.arange(n) + 0.5) * part
    tension = body.weight_in_water + cable.weight_in_water * height
    share = np.append(np.ones(n - 1), 0.5) * part
    mass = share * (cable.mass + cable.added_mass) + np.append(np.zeros(n - 1), body.mass + body.added_mass)
    drag = share * 0.5 * 1025.0 * cable.diameter * cable.normal_drag_coefficient
    drag[-1] += 0.5 * 1025.0 * body.drag_coefficient * body.area  # type: ignore[union-attr]
    water = tow.current.at(0.0) if tow.current else 0.0

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        x, v = state[:n], state[n:]
        lean = np.diff(x, prepend=ship.spline(time)[0]) / part
        pull = np.diff(-tension * lean, append=0.0)
        return np.concatenate([v, (-pull - drag * np.abs(v - water) * (v - water)) / mass])

    exact = solve_ivp(rate, (0.0, 180.0), np.zeros(2 * n), t_eval=t, method="DOP853", rtol=1e-9, atol=1e-10)
    assert exact.success
    found = fine_chain.simulate(tow, ship, links=n, step=0.02).vehicle
    assert found.velocity is not None
    assert np.abs(exact.y[2 * n - 1]).max() > 0.15
    np.testing.assert_allclose(found.velocity[:, 0], exact.y[2 * n - 1], atol=2e-6)
    np.testing.assert_allclose(found.position[:, 0], exact.y[n - 1], atol=2e-5)


@pytest.mark.parametrize("name", TOWS)
def test_spectral_simulator_and_fine_chain_agree(name: str) -> None:
    """Two methods that share the static tension only: sines about a shape, and a chain of small angles."""
    configuration = load(name)
    ship = truth.identification_ship(configuration, 0)
    spectral = truth.reference_run(configuration, ship).vehicle.velocity
    assert spectral is not None
    difference = rms(velocity(configuration.tow, ship) - spectral[:, 0])
    assert 1e-6 < difference < 5e-4


@pytest.mark.parametrize("name", TOWS)
def test_error_estimate_is_honest(name: str) -> None:
    tow = load(name).tow
    ship = standard_input(StandardInput(duration=1200.0), np.random.default_rng(7))
    run = fine_chain.simulate(tow, ship)
    assert run.vehicle.velocity is not None
    far_finer = velocity(tow, ship, links=240, step=0.0625)
    error = rms(run.vehicle.velocity[:, 0] - far_finer)
    assert 0.5 * run.error < error < 2.0 * run.error


@pytest.mark.parametrize("speed", [0.03, -0.03])
def test_in_a_uniform_current_the_chain_rests_at_the_offset_of_the_linear_string(speed: float) -> None:
    """Force below s is (R + b s) U|U|, slope is force over W + w s; its integral over the cable is in closed form."""
    tow = replace(load("autec-1200").tow, current=Current.uniform(speed))
    cable, W, w = tow.cable, tow.vehicle.weight_in_water, tow.cable.weight_in_water
    R, b = tow.vehicle.drag(1025.0), cable.normal_drag(1025.0)
    closed = b / w * cable.length + (R - b * W / w) / w * math.log1p(w * cable.length / W)
    run = fine_chain.simulate(tow, STANDING, links=240).vehicle
    assert run.velocity is not None
    assert run.position[0, 0] == pytest.approx(closed * speed * abs(speed), rel=1e-4)
    np.testing.assert_allclose(run.position[:, 0], run.position[0, 0], rtol=0.0, atol=1e-9)
    assert np.abs(run.velocity).max() < 1e-10


def test_a_tow_in_still_water_is_a_standing_ship_in_the_opposite_current() -> None:
    tow, speed = load("mangus-740").tow, 0.2
    t = STANDING.t
    ship = Trace.along_x(t, eased_sine(t))
    flowing = fine_chain.simulate(replace(tow, current=Current.uniform(-speed)), ship).vehicle
    towed = fine_chain.simulate(replace(tow, speed=speed), Trace.along_x(t, ship.position[:, 0] + speed * t)).vehicle
    assert towed.velocity is not None
    assert flowing.velocity is not None
    np.testing.assert_allclose(towed.position[:, 0] - speed * t, flowing.position[:, 0], atol=1e-8)
    np.testing.assert_allclose(towed.velocity[:, 0] - speed, flowing.velocity[:, 0], atol=1e-9)


def free_chain(drag: float, steps: int) -> list[float]:
    """Energies [J] of a chain that is let go from a bent shape under a ship that stands, one a 10 s."""
    n = 12
    k, M = np.linspace(90.0, 40.0, n), np.append(np.full(n - 1, 60.0), 900.0)
    x, v = np.sin(np.arange(1, n + 1)) + np.arange(n), np.zeros(n)
    energies = []
    for _ in range(steps):
        bend = np.diff(x, prepend=0.0)
        energies.append(0.5 * float(M @ v**2 + k @ bend**2))
        times, out = np.linspace(0.0, 10.0, 41), np.zeros((2, 2))
        done = fine_chain._march(
            times, np.zeros(41), np.array([40]), k, M, np.full(n, drag), np.zeros(n), x, v, out, np.zeros(3)
        )
        assert done
    return energies


def test_energy_is_kept_without_drag() -> None:
    energies = free_chain(0.0, 60)
    assert energies[0] > 100.0
    np.testing.assert_allclose(energies, energies[0], rtol=1e-9)


def test_energy_never_grows_with_drag() -> None:
    energies = free_chain(30.0, 60)
    assert (np.diff(energies) < 0.0).all()
    assert energies[-1] < 1e-2 * energies[0]


def test_slowest_free_motion_has_the_period_of_the_chains_own_matrices() -> None:
    """Without drag, after a push: the record's strongest frequency is the smallest eigenvalue's."""
    tow = load("mangus-740").tow
    bare = replace(
        tow,
        cable=replace(tow.cable, normal_drag_coefficient=0.0),
        vehicle=replace(tow.vehicle, drag_coefficient=0.0),
    )
    n, part = 60, tow.cable.length / 60
    k = (
        tow.vehicle.weight_in_water + tow.cable.weight_in_water * (tow.cable.length - (np.arange(n) + 0.5) * part)
    ) / part
    m = np.full(n, (tow.cable.mass + tow.cable.added_mass) * part)
    m[-1] = 0.5 * m[-1] + tow.vehicle.mass + tow.vehicle.added_mass
    low = eigh_tridiagonal(
        (k + np.append(k[1:], 0.0)) / m,
        -k[1:] / np.sqrt(m[1:] * m[:-1]),
        eigvals_only=True,
        select="i",
        select_range=(0, 0),
    )
    period = 2.0 * math.pi / math.sqrt(float(low[0]))
    # An easing of one period from rest to 0.1 m leaves free motion about the new place.
    t = np.arange(0.0, 12.0 * period, 1.0)
    x = np.where(t < 20.0, 0.05 * (1.0 - np.cos(math.pi * np.minimum(t, 20.0) / 20.0)), 0.1)
    run = fine_chain.simulate(bare, Trace.along_x(t, x)).vehicle
    late = t > 20.0
    motion, since = run.position[late, 0] - 0.1, t[late]
    error = []
    for factor in (0.99, 1.0, 1.01):
        basis = np.column_stack(
            [np.sin(2 * math.pi * since / (factor * period)), np.cos(2 * math.pi * since / (factor * period))]
        )
        error.append(rms(motion - basis @ np.linalg.lstsq(basis, motion, rcond=None)[0]))
    assert error[1] < 0.2 * rms(motion)
    assert error[1] < min(error[0], error[2])


def test_vehicle_is_on_the_ships_own_times_and_below_its_track() -> None:
    t = np.array([0.0, 0.7, 2.0, 2.1, 5.0, 9.0, 9.5, 14.0, 20.0])
    tow = load("mangus-740").tow
    even = fine_chain.simulate(tow, Trace.along_x(t, 0.05 * t)).vehicle
    position = np.column_stack([1000.0 + 0.05 * t, np.full(t.size, 7.0), np.full(t.size, -3.0)])
    moved = fine_chain.simulate(tow, Trace(t=t, position=position)).vehicle
    np.testing.assert_array_equal(moved.t, t)
    np.testing.assert_allclose(moved.position[:, 0] - 1000.0, even.position[:, 0], atol=1e-9)
    np.testing.assert_array_equal(moved.position[:, 1], 7.0)
    np.testing.assert_allclose(moved.position[:, 2], -3.0 - static_shape(tow).depth)


@pytest.mark.parametrize(
    ("resolution", "words"),
    [
        ({"links": 59}, "at least 60 links, but 59"),
        ({"step": 0.0}, "above 0 s, but 0 s"),
        ({"step": -1.0}, "above 0 s, but -1 s"),
        ({"step": math.nan}, "above 0 s, but nan s"),
        ({"step": math.inf}, "above 0 s, but inf s"),
    ],
)
def test_bad_resolution_is_refused(resolution: dict[str, float], words: str) -> None:
    with pytest.raises(InvalidInput, match=words):
        fine_chain.simulate(load(builtin_names()[0]).tow, STANDING, **resolution)  # type: ignore[arg-type]
