"""What must hold of every static shape."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.integrate import simpson

from models.current import Current
from models.statics import static_shape
from models.tow import Tow

FEW = settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True
)
speeds = st.floats(-1.5, 1.5)
weights = st.floats(1e3, 2e4)


def scene(tow: Tow, speed: float, weight: float, surface: float = 0.0) -> Tow:
    current = Current.from_profile([0.0, 400.0], [surface, 0.0]) if surface else None
    return replace(tow, speed=speed, vehicle=replace(tow.vehicle, weight_in_water=weight), current=current)


@FEW
@given(speed=speeds, weight=weights, surface=st.floats(-0.5, 0.5))
def test_mirror(configurations: Callable[[str], Tow], speed: float, weight: float, surface: float) -> None:
    tow = configurations("mangus-740")
    here = static_shape(scene(tow, speed, weight, surface), stations=60)
    there = static_shape(scene(tow, -speed, weight, -surface), stations=60)
    np.testing.assert_allclose(here.x, -there.x, atol=1e-6)
    np.testing.assert_allclose(here.z, there.z, atol=1e-6)
    np.testing.assert_allclose(here.T, there.T, rtol=1e-9)
    np.testing.assert_allclose(here.phi, np.pi - there.phi, atol=1e-9)


@FEW
@given(current=st.floats(0.02, 0.6), thrust=st.floats(0.0, 100.0), share=st.floats(0.1, 0.4))
def test_mirror_of_an_s_shape(
    configurations: Callable[[str], Tow], current: float, thrust: float, share: float
) -> None:
    """Buoyant and heavy lengths and a thrusting towfish, the other way round."""
    tow = configurations("s-shape-205")
    (floated,) = tow.sections
    sections = (replace(floated, length=share * 205.0),)
    cable = replace(tow.cable, length=(1.0 - share) * 205.0)
    here, there = (
        static_shape(
            replace(
                tow,
                cable=cable,
                sections=sections,
                vehicle=replace(tow.vehicle, thrust=side * thrust, added_mass_centre_p=0.0, drag_centre_p=0.0),
                current=Current.uniform(side * current),
            )
        )
        for side in (1.0, -1.0)
    )
    np.testing.assert_allclose(here.x, -there.x, atol=1e-7)
    np.testing.assert_allclose(here.z, there.z, atol=1e-7)
    np.testing.assert_allclose(here.T, there.T, rtol=1e-9)
    np.testing.assert_allclose(here.phi, np.pi - there.phi, atol=1e-8)
    assert abs(here.pitch + there.pitch) < 1e-12


@FEW
@given(speed=speeds, weight=weights)
def test_a_tow_is_a_current_the_other_way(configurations: Callable[[str], Tow], speed: float, weight: float) -> None:
    tow = scene(configurations("mangus-740"), speed, weight)
    towed = static_shape(tow, stations=40)
    held = static_shape(replace(tow, speed=0.0, current=Current.uniform(-speed)), stations=40)
    for name in ("phi", "T", "x", "z", "strain", "flow"):
        assert np.array_equal(getattr(towed, name), getattr(held, name)), name


@FEW
@given(speed=speeds, weight=weights, surface=st.floats(-0.5, 0.5))
def test_the_tow_point_carries_weight_and_drag(
    configurations: Callable[[str], Tow], speed: float, weight: float, surface: float
) -> None:
    """The pull at the top is the sum of all weights and drags, integrated over the shape."""
    tow = scene(configurations("mangus-740"), speed, weight, surface)
    shape = static_shape(tow, stations=240)
    c, rho = tow.cable, 1025.0
    t = np.column_stack([np.cos(shape.phi), np.sin(shape.phi)])
    n = np.column_stack([-t[:, 1], t[:, 0]])
    u = np.interp(-shape.z, [0.0, 400.0], [surface, 0.0]) - speed
    area = c.diameter * (1.0 + shape.strain) * (1.0 - 0.5 * shape.strain)
    load = np.zeros((241, 2))
    for side, coefficient in ((n, 1.6), (t, 0.08)):
        across = u * side[:, 0]
        load += (0.5 * rho * area * coefficient * across * np.abs(across))[:, None] * side
    load[:, 1] -= c.weight_in_water
    u_0 = np.interp(shape.depth, [0.0, 400.0], [surface, 0.0]) - speed
    total = simpson(load, x=shape.s, axis=0) + np.array([0.5 * rho * 1.6 * 0.52 * u_0 * abs(u_0), -weight])
    np.testing.assert_allclose(shape.T[-1] * t[-1], -total, atol=2e-4 * shape.T[-1])
