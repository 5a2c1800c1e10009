"""What must hold of every response: mirror images, proportion, passivity."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from models.current import Current
from models.tow import Tow
from models.transfer_matrix import Direction, UniformDamping, frequency_response

few = settings(max_examples=15, deadline=None)
EVEN = np.linspace(0.0, 4000.0, 41)
frequencies = st.lists(st.floats(0.02, 3.0), min_size=1, max_size=4, unique=True).map(sorted)


@few
@given(omega=frequencies, speed=st.floats(0.05, 2.0), amplitude=st.floats(0.01, 3.0))
def test_a_current_the_other_way_mirrors_the_response(
    configurations: Callable[[str], Tow], omega: list[float], speed: float, amplitude: float
) -> None:
    tow = configurations("autec-1200")
    there, back = (
        frequency_response(
            replace(tow, current=Current.uniform(sign * speed)),
            omega,
            amplitude=amplitude,
            direction="surge",
            segments=48,
            companion=False,
        )
        for sign in (1.0, -1.0)
    )
    size = np.abs(there.states).max(axis=(0, 1))
    assert np.abs(there.tension + back.tension).max() < 1e-3 * size[0] + 1e-9
    assert np.abs(there.horizontal - back.horizontal).max() < 1e-3 * amplitude
    assert np.abs(there.vertical + back.vertical).max() < 1e-3 * amplitude


@few
@given(omega=frequencies, scale=st.floats(0.1, 10.0), direction=st.sampled_from(["axial", "heave", "surge"]))
def test_given_damping_makes_the_response_proportional(
    table_two: Tow, omega: list[float], scale: float, direction: Direction
) -> None:
    damping = UniformDamping(axial=0.1, normal=5.0, surge=50.0, heave=300.0, pitch=40.0)
    one, many = (
        frequency_response(
            table_two, omega, amplitude=a, direction=direction, nodes=EVEN, damping=damping, companion=False
        )
        for a in (1.0, scale)
    )
    assert np.abs(many.states - scale * one.states).max() < 1e-9 * np.abs(many.states).max()


@few
@given(
    omega=frequencies,
    amplitude=st.floats(0.01, 5.0),
    direction=st.sampled_from(["axial", "heave", "surge"]),
    thrust=st.floats(-400.0, 400.0),
)
def test_in_still_water_the_top_never_gets_work_back(
    configurations: Callable[[str], Tow], omega: list[float], amplitude: float, direction: Direction, thrust: float
) -> None:
    tow = configurations("mangus-740")
    tow = replace(tow, vehicle=replace(tow.vehicle, thrust=thrust))
    answer = frequency_response(tow, omega, amplitude=amplitude, direction=direction, segments=48, companion=False)
    velocity = 1j * answer.omega[:, None] * answer.states[:, -1, 2:]
    force = np.column_stack([answer.tension_top, answer.shape.T[-1] * answer.angle[:, -1]])
    power = 0.5 * np.real(np.sum(force * np.conj(velocity), axis=1))
    assert np.all(power > -1e-9 * np.abs(force).max() * np.abs(velocity).max())
