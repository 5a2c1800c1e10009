"""What must hold for every manoeuvre: the ship keeps its speed, turns by what is asked, and follows the map."""

import math

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from data_synth import ships

speeds = st.floats(0.5, 8.0)
radii = st.floats(30.0, 2000.0)


@given(speed=speeds, radius=radii, turns=st.floats(0.2, 3.0), ease=st.floats(0.5, 60.0), sample=st.floats(0.2, 5.0))
@settings(max_examples=50, deadline=None)
def test_turns_keep_speed_radius_and_heading(
    speed: float, radius: float, turns: float, ease: float, sample: float
) -> None:
    lasts = 2.0 * math.pi * turns * radius / speed
    assume(ease < lasts)
    asked = ships.FullTurn(
        speed=speed, radius=radius, turns=turns, ease=ease, sample=sample, approach=5.0 * sample, exit=5.0 * sample
    )
    trace = ships.full_turn(asked)
    velocity = trace.rates()
    assert np.allclose(np.linalg.norm(velocity, axis=1), speed, rtol=1e-12)
    last = 2.0 * math.pi * turns
    assert np.allclose(velocity[-1] / speed, [math.cos(last), math.sin(last), 0.0], atol=1e-9)
    # A chord of the arc by its heading change: 2 R sin(d psi/2), whatever the sample.
    arc = (trace.t > 5.0 * sample + ease) & (trace.t < 5.0 * sample + lasts)
    chords = np.linalg.norm(np.diff(trace.position[arc], axis=0), axis=1)
    assert np.allclose(chords, 2.0 * radius * abs(math.sin(0.5 * speed * sample / radius)), atol=1e-8)


@given(
    legs=st.lists(st.tuples(st.floats(500.0, 3000.0), st.floats(-2.3, 2.3)), min_size=2, max_size=6),
    speed=speeds,
    angle=st.floats(-3.0, 3.0),
)
@settings(max_examples=50, deadline=None)
def test_waypoints_turn_and_shift_with_the_map(legs: list[tuple[float, float]], speed: float, angle: float) -> None:
    courses = np.cumsum([change for _, change in legs])
    points = np.cumsum([0.0, *(length * np.exp(1j * psi) for (length, _), psi in zip(legs, courses, strict=True))])
    moved = points * np.exp(1j * angle) + (3e4 - 2e5j)
    here, there = (
        ships.waypoints(ships.Waypoints(points_x=tuple(p.real), points_y=tuple(p.imag), radius=60.0, speed=speed))
        for p in (points, moved)
    )
    n = min(len(here), len(there))
    one = (here.position[:n, 0] + 1j * here.position[:n, 1]) * np.exp(1j * angle) + (3e4 - 2e5j)
    assert np.abs(one - (there.position[:n, 0] + 1j * there.position[:n, 1])).max() < 1e-6
    assert abs(here.position[-1, 0] + 1j * here.position[-1, 1] - points[-1]) < speed * 1.001 + 1e-6
    sharpest = np.abs(np.diff(here.rates(), axis=0)).max()
    assert sharpest <= speed**2 / 60.0 * 1.01
