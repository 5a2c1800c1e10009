"""Motions of the link-joint chain that have closed forms: swinging, dragging, snapping."""

import math
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from models import link_joint
from models.body import Body
from models.cable import Cable
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.trace import Trace


def ball(weight_in_water: float, mass: float, area: float = 1.0, drag_coefficient: float = 0.0) -> Body:
    """A body that is the same in every direction and has no added mass."""
    return Body(
        weight=weight_in_water,
        buoyancy=0.0,
        mass=mass,
        added_mass_surge=0.0,
        added_mass_sway=0.0,
        added_mass_heave=0.0,
        area_surge=area,
        area_sway=area,
        area_heave=area,
        drag_coefficient=drag_coefficient,
    )


def one_part(cable: Cable, body: Body) -> TowedSystem:
    return TowedSystem(parts=(Part(name="body", cable=cable, body=body),))


def smooth(t: np.ndarray) -> np.ndarray:
    """From 0 to 1 over 0 to 1, with two continuous derivatives."""
    t = np.clip(t, 0.0, 1.0)
    return t**3 * (10.0 - 15.0 * t + 6.0 * t**2)


def strongest(t: np.ndarray, x: np.ndarray, near: float) -> float:
    """The frequency [rad/s] within 15 % of `near` at which the windowed record is strongest."""
    weighted = np.hanning(t.size) * (x - x.mean())
    low, high = 0.85 * near, 1.15 * near
    for _ in range(6):
        grid = np.linspace(low, high, 41)
        best = grid[np.argmax(np.abs(np.exp(-1j * np.outer(grid, t)) @ weighted))]
        low, high = best - 2.0 * (grid[1] - grid[0]), best + 2.0 * (grid[1] - grid[0])
    return float(best)


@pytest.mark.parametrize("stiffness", [1e15, None], ids=["rigid", "elastic"])
def test_hanging_frequencies(
    continuum: ModuleType, configurations: Callable[[str], Tow], stiffness: float | None
) -> None:
    """The first three of a chain with an end mass within 0.3 % at 50 links: marched without drag after a push."""
    tow = configurations("mangus-740")
    cable = replace(tow.cable, normal_drag_coefficient=0.0, tangential_drag_coefficient=0.0)
    if stiffness is not None:
        cable = replace(cable, axial_stiffness=stiffness)
    exact = continuum.hanging_frequencies(cable, 3000.0, 600.0)
    t = np.arange(0.0, 2000.0, 0.5)
    position = np.zeros((t.size, 3))
    position[:, 1] = 0.5 * smooth(t / 6.0)
    ship = Trace(t=t, position=position)
    run = link_joint.simulate(one_part(cable, ball(3000.0, 600.0)), ship, links=50, step=0.1, companion=False)
    free = t > 10.0
    found = [strongest(t[free], run.vehicle.position[free, 1], omega) for omega in exact]
    np.testing.assert_allclose(found, exact, rtol=3e-3)


def u_turn(radius: float, speed: float) -> Trace:
    """Straight, half a circle eased in and out, straight."""
    t = np.arange(0.0, 8.0 * radius / speed, 0.5)
    heading = math.pi * smooth((speed * t / radius - 1.0) / 4.0)
    velocity = speed * np.stack([np.cos(heading), np.sin(heading), 0.0 * t], axis=1)
    steps = 0.5 * np.diff(t)[:, None] * (velocity[1:] + velocity[:-1])
    return Trace(t=t, position=np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)]))


@pytest.mark.parametrize("stiffness", [1e15, 1e7], ids=["rigid", "elastic"])
def test_tractrix(continuum: ModuleType, stiffness: float) -> None:
    """A light body with drag on a light cable goes where the cable pulls it: along the cable, a tractrix.

    The limit is that of no inertia and no weight against the body's drag, the same in all directions. The ship turns
    less sharply than the cable is long: in a tighter turn a tractrix comes to a cusp, where its rod would push.
    """
    cable = Cable(
        length=60.0,
        diameter=1e-3,
        mass=1e-5,
        weight_in_water=1e-5,
        added_mass=0.0,
        axial_stiffness=stiffness,
        normal_drag_coefficient=0.0,
        tangential_drag_coefficient=0.0,
    )
    ship = u_turn(120.0, 1.0)
    run = link_joint.simulate(one_part(cable, ball(1e-2, 1e-2, 1.0, 1.2)), ship, links=6, tolerance=1e-4)
    body = run.vehicle.position
    path = continuum.tractrix(lambda t: (ship.spline(t)[:2], ship.spline(t, 1)[:2]), np.array([-60.0, 0.0]), ship.t)
    np.testing.assert_allclose(body[:, :2], path, atol=1e-3 * 60.0)
    assert np.abs(body[:, 2]).max() < 0.05
    # The body cuts the corner by far.
    assert path[:, 0].max() < ship.position[:, 0].max() - 10.0
    assert run.vehicle.tension is not None
    v = np.linalg.norm(run.vehicle.rates(), axis=1)
    np.testing.assert_allclose(run.vehicle.tension[5:, 0], 0.5 * 1025.0 * 1.2 * v[5:] ** 2, rtol=0.02, atol=1.0)


def test_snap_of_a_long_bar(configurations: Callable[[str], Tow]) -> None:
    """The upper end of a taut cable jerked at v: T rises by v sqrt(EA m) until the wave is back from the body."""
    tow = configurations("mangus-740")
    cable, v = replace(tow.cable, tangential_drag_coefficient=0.0, axial_damping=0.0), 0.3
    rise = 0.04
    wave = math.sqrt(cable.axial_stiffness / cable.mass)
    back = 2.0 * cable.length / wave
    t = np.arange(0.0, back, 0.002)
    lift = v * rise * np.where(t < rise, (t / rise) ** 3 - 0.5 * (t / rise) ** 4, t / rise - 0.5)
    ship = Trace.along_x(t, 0.0 * t, lift)
    still = replace(TowedSystem.from_tow(replace(tow, cable=cable)), current=None)
    run = link_joint.simulate(still, ship, links=200, step=0.0005, companion=False).vehicle
    assert run.tension is not None
    jump = v * math.sqrt(cable.axial_stiffness * cable.mass)
    plateau = (t > 0.15 * back) & (t < 0.95 * back)
    assert jump > 1000.0
    np.testing.assert_allclose(run.tension[plateau, 0] - run.tension[0, 0], jump, rtol=0.01)
    # The body does not feel it before half of that time.
    assert np.abs(run.tension[t < 0.45 * back, 1] - run.tension[0, 1]).max() < 0.01 * jump


def test_snap_of_a_mass_on_a_light_spring() -> None:
    """A slackened cable catches a sinking mass: T = W + sqrt(W^2 + k M v^2), v its speed when it is taut again.

    A little internal loss: without any, the links of a light cable fall taut one by one and not at a time.
    """
    cable = Cable(
        length=100.0,
        diameter=0.005,
        mass=1e-3,
        weight_in_water=1e-4,
        added_mass=0.0,
        axial_stiffness=2e6,
        normal_drag_coefficient=1.0,
        tangential_drag_coefficient=0.01,
        axial_damping=1e-3,
    )
    W, M, k, drop = 400.0, 800.0, 2e6 / 100.0, 1.0
    t = np.arange(0.0, 5.0, 0.02)
    ship = Trace.along_x(t, 0.0 * t, -drop * smooth(t / 0.6))
    run = link_joint.simulate(one_part(cable, ball(W, M)), ship, links=20, tolerance=1e-4, companion=False)

    # The same by hand: one mass, one spring that only pulls.
    def stretch(time: float, y: np.ndarray) -> float:
        return float(y[0] + ship.spline(time)[2])

    stretch.direction = 1.0  # type: ignore[attr-defined]
    exact = solve_ivp(
        lambda time, y: [y[1], (W - k * max(0.0, stretch(time, y))) / M],
        (0.0, 2.5),
        [W / k, 0.0],
        events=stretch,
        max_step=2e-3,
        rtol=1e-9,
    )
    until, v = float(exact.t_events[0][0]), float(exact.y_events[0][0][1])
    event = run.slack[0]
    assert event.part == "body"
    assert 0.0 <= event.t < 0.1
    assert 0.0 <= event.s <= 100.0
    assert event.until == pytest.approx(until, rel=0.01)
    # Without its own weight the snap is v sqrt(k M).
    assert event.peak == pytest.approx(W + math.sqrt(W**2 + k * M * v**2), rel=0.01)
    assert run.tension_max[0] == pytest.approx(event.peak, rel=1e-6)


def test_snap_of_a_tow_that_goes_slack(configurations: Callable[[str], Tow]) -> None:
    """The ship drops faster than the body sinks: the error-controlled run against one far finer in links and steps."""
    system = TowedSystem.from_tow(configurations("mangus-740"))
    t = np.arange(0.0, 15.0, 0.05)
    ship = Trace.along_x(t, 0.0 * t, -8.0 * smooth(t / 2.0))
    run = link_joint.simulate(system, ship, links=50, companion=False)
    fine = link_joint.simulate(system, ship, links=150, step=0.002, companion=False)
    assert len(run.slack) == len(fine.slack) == 2
    for one, other in zip(run.slack, fine.slack, strict=True):
        assert one.peak == pytest.approx(other.peak, rel=0.02)
        assert [one.t, one.until] == pytest.approx([other.t, other.until], abs=0.03)
    # Three times the standing tension, and never a push.
    assert run.tension_max[0] == pytest.approx(fine.tension_max[0], rel=0.02)
    assert fine.tension_max[0] > 2.0 * 11_700.0
    assert run.vehicle.tension is not None
    assert run.vehicle.tension.min() == 0.0
