"""What holds for every motion of the link-joint chain: symmetries, equal descriptions, energy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ident.configuration import load
from models import link_joint
from models.current import Current
from models.towed_system import Part, TowedSystem
from models.trace import Trace

TOW = load("mangus-740").tow
ELASTIC = TowedSystem.from_tow(TOW)
RIGID = TowedSystem.from_tow(replace(TOW, cable=replace(TOW.cable, axial_stiffness=1e15)))
T = np.arange(0.0, 121.0)
SYSTEMS = pytest.mark.parametrize("system", [RIGID, ELASTIC], ids=["rigid", "elastic"])


def track(speed: float, sway: float, heave: float) -> np.ndarray:
    """(n, 3) places of a ship that begins straight on."""
    ease = 1.0 - np.exp(-((T / 30.0) ** 3))
    return np.stack([speed * T, sway * ease * np.sin(0.05 * T), heave * ease * np.sin(0.3 * T)], axis=1)


def towed(system: TowedSystem, position: np.ndarray, t: np.ndarray = T, links: int = 16) -> Trace:
    """The body under a fixed step, so that equal problems get equal steps."""
    run = link_joint.simulate(
        system, Trace(t=t, position=position), links=links, step=0.25, tolerance=1e-6, companion=False
    )
    assert run.drift < 1e-8
    assert run.imbalance < 1e-2
    return run.vehicle


def agree(one: Trace, other: Trace, within: float = 1e-5) -> None:
    """Places to `within` [m], tensions to as much of themselves."""
    np.testing.assert_allclose(one.position, other.position, rtol=0.0, atol=within)
    assert one.tension is not None
    assert other.tension is not None
    np.testing.assert_allclose(one.tension, other.tension, rtol=within)


speeds = st.floats(0.0, 2.0)
amplitudes = st.floats(-10.0, 10.0)


@SYSTEMS
@settings(max_examples=12, deadline=None)
@given(speed=speeds, sway=amplitudes, heave=st.floats(-1.5, 1.5), turn=st.floats(-3.0, 3.0), shift=st.floats(-1e4, 1e4))
def test_the_body_turns_shifts_and_waits_with_the_ship(
    system: TowedSystem, speed: float, sway: float, heave: float, turn: float, shift: float
) -> None:
    c, s = math.cos(turn), math.sin(turn)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    move = np.array([shift, -0.3 * shift, 0.0])
    position = track(speed, sway, heave)
    one = towed(system, position)
    other = towed(system, position @ rotation.T + move, T + 1000.0)
    agree(replace(one, position=one.position @ rotation.T + move), other)


@SYSTEMS
@settings(max_examples=8, deadline=None)
@given(speed=speeds, sway=amplitudes)
def test_port_and_starboard_are_mirrored(system: TowedSystem, speed: float, sway: float) -> None:
    one, other = towed(system, track(speed, sway, 0.5)), towed(system, track(speed, -sway, 0.5))
    agree(replace(one, position=one.position * [1.0, -1.0, 1.0]), other)


@SYSTEMS
@settings(max_examples=8, deadline=None)
@given(speed=speeds, sway=amplitudes, along=st.floats(-0.7, 0.7), across=st.floats(-0.7, 0.7))
def test_a_uniform_current_is_a_moving_frame(
    system: TowedSystem, speed: float, sway: float, along: float, across: float
) -> None:
    flowing = replace(system, current=Current.uniform(math.hypot(along, across), math.atan2(across, along)))
    drift = T[:, None] * np.array([along, across, 0.0])
    position = track(speed, sway, 0.5)
    still, carried = towed(system, position, links=32), towed(flowing, position + drift, links=32)
    # The links are graded for the ship's speed over the ground, so that they differ a little.
    agree(replace(still, position=still.position + drift), carried, 5e-3)


@SYSTEMS
def test_no_input_no_motion(system: TowedSystem) -> None:
    body = towed(system, np.tile([5.0, -3.0, 0.0], (T.size, 1)))
    np.testing.assert_allclose(body.position, np.broadcast_to(body.position[0], body.position.shape), atol=1e-8)
    np.testing.assert_allclose(body.rates(), 0.0, atol=1e-9)


@SYSTEMS
def test_one_cable_in_two_pieces_is_the_same_cable(system: TowedSystem) -> None:
    """Its links are graded piece by piece, so that they are not quite the same."""
    part = system.parts[0]
    halves = replace(part.cable, length=370.0)
    pieces = (
        Part(name="upper", cable=halves, body=None),
        Part(name="lower", cable=halves, body=part.body, after="upper"),
    )
    position = track(1.0, 8.0, 1.0)
    run = link_joint.simulate(
        replace(system, parts=pieces), Trace(t=T, position=position), links=24, step=0.25, companion=False
    )
    upper, lower = (body.tension for body in run.bodies)
    assert upper is not None
    assert lower is not None
    agree(
        replace(run.bodies[1], tension=np.stack([upper[:, 0], lower[:, 1]], axis=1)),
        towed(system, position, links=48),
        0.02,
    )


@pytest.mark.parametrize("drag", [0.0, 1.0], ids=["without drag", "with drag"])
@pytest.mark.parametrize("stiffness", [1e15, 1e6], ids=["rigid", "elastic"])
@pytest.mark.parametrize("speed", [0.5, 2.0])
def test_energy_never_grows_without_input(stiffness: float, drag: float, speed: float) -> None:
    """A straight tow whose ship stops within five seconds: from then on only the water takes energy.

    Kinetic, potential and elastic energy from the nodes' places at times a millisecond apart. Added mass that turns
    with a link has no energy of its own in this model, so the cable has none here.
    """
    cable = replace(
        TOW.cable,
        axial_stiffness=stiffness,
        added_mass=0.0,
        axial_damping=0.0,
        normal_drag_coefficient=1.6,
        tangential_drag_coefficient=0.02,
    )
    system = TowedSystem.from_tow(replace(TOW, cable=cable))
    part, n, fine = system.parts[0], 20, 1e-3
    assert part.body is not None
    if drag == 0.0:
        free = replace(cable, normal_drag_coefficient=0.0, tangential_drag_coefficient=0.0)
        body = replace(part.body, drag_coefficient=0.0)
        system = replace(system, parts=(replace(part, cable=free, body=body),))
    looks = np.arange(10.0, 200.0, 2.0)
    t = np.unique(np.concatenate([np.arange(0.0, 201.0, 0.5), looks - fine, looks + fine]))
    u = np.clip(t / 5.0, 0.0, 1.0)
    travelled = np.where(t < 5.0, t - 5.0 * (2.5 * u**4 - 3.0 * u**5 + u**6), 2.5)
    ship = Trace.along_x(t, speed * travelled)
    times = np.stack([looks - fine, looks, looks + fine], axis=1).ravel()
    run = link_joint.simulate(system, ship, links=n, step=0.05, shapes_at=times, companion=False)
    x = np.array(run.shapes).reshape(looks.size, 3, n + 1, 3)
    v = (x[:, 2] - x[:, 0]) / (2.0 * fine)
    size = run.layout.chain.length
    share = 0.5 * (np.append(size, 0.0) + np.append(0.0, size))
    mass, weight = share * cable.mass, share * cable.weight_in_water
    mass[0] += part.body.mass + part.body.added_mass_surge
    weight[0] += part.body.weight_in_water
    strain = np.linalg.norm(np.diff(x[:, 1], axis=1), axis=2) / size - 1.0
    stretch = 0.5 * stiffness * strain**2 @ size if stiffness < 1e14 else 0.0
    moving = 0.5 * ((v**2).sum(axis=2) * mass)[:, :-1].sum(axis=1)
    energy = moving + x[:, 1, :, 2] @ weight + stretch
    swing = moving.max()
    assert swing > 50.0
    assert np.diff(energy).max() < 1e-5 * swing
    lost = (energy[0] - energy[-1]) / swing
    assert lost > 0.3 if drag else abs(lost) < 0.02
