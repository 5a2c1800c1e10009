"""Steady tows of the link-joint chain against the continuum: 50 links within 0.1 % of trail, radius, depth, tension."""

import math
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from models import link_joint
from models.current import Current
from models.link_joint.steady import steady_tow
from models.statics import static_shape
from models.tow import Tow
from models.towed_system import TowedSystem
from models.trace import Trace
from models.vehicle import Vehicle

LINKS = 50
BAR = 1e-3


def system(tow: Tow, stiffness: float | None = None, law: str = "quadratic") -> TowedSystem:
    """The tow as it is, or with another axial stiffness; some tangential drag."""
    cable = replace(tow.cable, tangential_drag_coefficient=0.05)
    if stiffness is not None:
        cable = replace(cable, axial_stiffness=stiffness)
    return replace(TowedSystem.from_tow(replace(tow, cable=cable)), drag_law=law)  # type: ignore[arg-type]


def towed(one: TowedSystem, velocity: np.ndarray) -> Trace:
    """The body behind a ship that keeps its velocity; it must keep its place behind it."""
    t = np.linspace(0.0, 300.0, 31)
    ship = Trace(t=t, position=t[:, None] * velocity)
    body = link_joint.simulate(one, ship, links=LINKS).vehicle
    behind = body.position - ship.position
    np.testing.assert_allclose(behind, np.broadcast_to(behind[0], behind.shape), rtol=0.0, atol=1e-6 * 2500.0)
    return replace(body, position=behind)


@pytest.mark.parametrize("name", ["mangus-740", "autec-1200", "mangus-2500"])
@pytest.mark.parametrize("stiffness", [1e15, None], ids=["rigid", "elastic"])
@pytest.mark.parametrize(("speed", "law"), [(0.5, "quadratic"), (2.0, "quadratic"), (2.0, "incidence")])
def test_straight_tow(
    continuum: ModuleType,
    configurations: Callable[[str], Tow],
    name: str,
    stiffness: float | None,
    speed: float,
    law: str,
) -> None:
    one = system(configurations(name), stiffness, law)
    velocity = speed * np.array([0.6, -0.8, 0.0])
    (line,) = continuum.straight_tow(one, velocity)
    body = towed(one, velocity)
    np.testing.assert_allclose(body.position[-1, :2], (line.lower - line.upper)[:2], rtol=BAR)
    assert body.position[-1, 2] == pytest.approx(line.lower[2], rel=BAR)
    assert body.tension is not None
    np.testing.assert_allclose(body.tension[-1], line.tension, rtol=BAR)


@pytest.mark.parametrize("stiffness", [1e15, None], ids=["rigid", "elastic"])
def test_straight_tow_in_a_current_that_turns_with_depth(
    continuum: ModuleType, configurations: Callable[[str], Tow], stiffness: float | None
) -> None:
    current = Current.from_profile([0.0, 300.0, 600.0], [0.8, 0.4, 0.5], [0.3, 1.2, -1.0])
    one = replace(system(configurations("mangus-740"), stiffness), current=current)
    (line,) = continuum.straight_tow(one, np.array([0.9, 0.2, 0.0]))
    body = towed(one, np.array([0.9, 0.2, 0.0]))
    behind = (line.lower - line.upper)[:2]
    trail = np.linalg.norm(behind)
    np.testing.assert_allclose(body.position[-1, :2], behind, rtol=0.0, atol=BAR * trail)
    assert body.position[-1, 2] == pytest.approx(line.lower[2], rel=BAR)
    assert body.tension is not None
    np.testing.assert_allclose(body.tension[-1], line.tension, rtol=BAR)
    # The current takes the cable out of the ship's plane, and not by a little.
    assert abs(behind[0] * 0.2 - behind[1] * 0.9) > 0.05 * trail


def circled(one: TowedSystem, radius: float, speed: float, turns: float, links: int = LINKS) -> tuple[Trace, Trace]:
    """Ship and body on a circle, from the straight tow; the last two rounds of the body must agree."""
    turn = 2.0 * math.pi * radius / speed
    t = np.linspace(0.0, turns * turn, round(120 * turns) + 1)
    angle = speed / radius * t
    ship = Trace(t=t, position=radius * np.stack([np.sin(angle), 1.0 - np.cos(angle), 0.0 * t], axis=1))
    body = link_joint.simulate(one, ship, links=links, tolerance=1e-4).vehicle
    np.testing.assert_allclose(body.position[-1], body.position[-121], rtol=0.0, atol=2e-4 * radius)
    return ship, body


@pytest.mark.parametrize("stiffness", [1e15, None], ids=["rigid", "elastic"])
@pytest.mark.parametrize(
    ("name", "radius", "speed"), [("mangus-740", 250.0, 1.0), ("autec-1200", 500.0, 1.5), ("mangus-2500", 1000.0, 1.5)]
)
def test_circular_tow(
    continuum: ModuleType,
    configurations: Callable[[str], Tow],
    name: str,
    stiffness: float | None,
    radius: float,
    speed: float,
) -> None:
    one = system(configurations(name), stiffness)
    (circle,) = continuum.circular_tows(one, radius, speed)
    ship, body = circled(one, radius, speed, 6.0)
    centre = np.array([0.0, radius, 0.0])
    outward, ahead = ship.position[-1] - centre, body.position[-1] - centre
    assert math.hypot(ahead[0], ahead[1]) == pytest.approx(circle.radius[0], rel=BAR)
    assert -body.position[-1, 2] == pytest.approx(circle.depth[0], rel=BAR)
    lag = np.mod(math.atan2(outward[1], outward[0]) - math.atan2(ahead[1], ahead[0]), 2.0 * math.pi)
    assert lag == pytest.approx(circle.lag[0], rel=2.0 * BAR)
    assert body.tension is not None
    np.testing.assert_allclose(body.tension[-1], circle.lines[0].tension, rtol=BAR)


@pytest.mark.parametrize("stiffness", [1e15, 1e6], ids=["rigid", "elastic"])
@pytest.mark.parametrize(("span", "drop"), [(400.0, 100.0), (700.0, -150.0)])
def test_both_ends_held(
    continuum: ModuleType, configurations: Callable[[str], Tow], stiffness: float, span: float, drop: float
) -> None:
    """The chain's own balance to 1e-9, written anew; the continuum's catenary at second order in the links."""
    tow = configurations("mangus-740")
    cable = replace(tow.cable, axial_stiffness=stiffness)
    one, held = TowedSystem.from_tow(replace(tow, cable=cable)), continuum.catenary(cable, span, drop)
    misses = []
    for links in (25, 50, 100):
        chain = link_joint.steady_tow(one, links=links, anchor=(0.6 * span, 0.8 * span, -drop))
        x, T = chain.position[::-1], chain.tension[::-1]
        r, size = np.diff(x, axis=0), cable.length / links
        stretched = np.linalg.norm(r, axis=1)
        np.testing.assert_allclose(stretched, size * (1.0 + T * chain.layout.chain.compliance[::-1]), rtol=1e-9)
        pull = T[:, None] * r / stretched[:, None]
        weight = np.array([0.0, 0.0, cable.weight_in_water * size])
        np.testing.assert_allclose(pull[1:] - pull[:-1] - weight, 0.0, atol=1e-9 * T.max())
        s = np.linspace(0.0, cable.length, links + 1)
        across, height, tension = held.at(s)
        place = np.stack([0.6 * across, 0.8 * across, height], axis=1)
        misses.append([np.abs(x - place).max(), np.abs(0.5 * (T[1:] + T[:-1]) - tension[1:-1]).max()])
    orders = np.log2(np.array(misses[:-1]) / misses[1:])
    assert (np.abs(orders - 2.0) < 0.2).all(), (misses, orders)


@pytest.mark.parametrize("current", [0.05, 0.2, -0.5])
def test_s_shape_is_that_of_the_statics(configurations: Callable[[str], Tow], current: float) -> None:
    """A point vehicle on the buoyant and the heavy length: the chain comes to the same S at second order in its links.

    A towfish is another body in the chain, which has it at zero pitch.
    """
    vehicle = Vehicle(weight_in_water=530.0, mass=400.0, added_mass=500.0, area=0.25, drag_coefficient=2.0)
    tow = replace(configurations("s-shape-205"), vehicle=vehicle, current=Current.uniform(current))
    shape = static_shape(tow, stations=2000)
    place = np.array([shape.x[0], 0.0, shape.z[0]])
    misses = []
    for links in (25, 50, 100, 200):
        steady = steady_tow(TowedSystem.from_tow(tow), links=links)
        end = steady.layout.lower_end[-1]
        misses.append(float(np.linalg.norm(steady.position[end] - place)))
        # The tension of a link is that of its middle.
        below, above = 0.5 * steady.layout.chain.length[[end, -1]]
        np.testing.assert_allclose(steady.tension[[end, -1]], shape.tension_at([below, 205.0 - above]), rtol=2e-3)
    assert misses[1] < 0.4
    assert misses[3] < 0.02
    assert misses[3] < misses[1] / 8.0
