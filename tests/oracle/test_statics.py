"""The static shape against closed forms and against an independent dense integration."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from models.cable import Cable
from models.current import Current
from models.quantity import GRAVITY
from models.statics import length_for_depth, midpoint_travel_time, static_shape, travel_time
from models.tow import Tow
from models.vehicle import Towfish, Vehicle

RHO = 1025.0


def dense_shape(tow: Tow, water: Callable[[float], float], depth: float) -> tuple[np.ndarray, np.ndarray]:
    """(phi, T, x, z) at the vehicle and at the top, T as a vector (T_x, T_z), from a vehicle at a depth.

    Written from the balance of an element: d(T t)/ds = -(weight + drag), without the angle as a state.
    """
    v = tow.vehicle
    assert isinstance(v, Vehicle)

    def rate(s: float, y: np.ndarray, c: Cable) -> np.ndarray:
        T, area = math.hypot(y[0], y[1]), 0.25 * math.pi * c.diameter**2
        t, n = y[:2] / T, np.array([-y[1], y[0]]) / T
        e = (T - (1.0 - 2.0 * c.poisson_ratio) * RHO * GRAVITY * max(-y[3], 0.0) * area) / c.axial_stiffness
        stretched = (1.0 + e) * (1.0 - c.poisson_ratio * e)
        u = np.array([water(-y[3]) - tow.speed, 0.0])
        drag = 0.5 * RHO * c.diameter * stretched * c.normal_drag_coefficient * abs(u @ n) * (u @ n) * n
        drag += 0.5 * RHO * c.diameter * stretched * c.tangential_drag_coefficient * abs(u @ t) * (u @ t) * t
        pull = -drag + np.array([0.0, c.weight_in_water])
        return np.concatenate([pull, (1.0 + e) * t])

    u_0 = water(depth) - tow.speed
    k = 0.5 * RHO * v.area * v.drag_coefficient
    start = top = np.array([-k * u_0 * abs(u_0) - v.thrust, v.weight_in_water, 0.0, -depth])
    for cable in tow.cables:
        top = solve_ivp(rate, (0.0, cable.length), top, method="Radau", rtol=1e-9, atol=1e-9, args=(cable,)).y[:, -1]
    return start, top


def test_vertical_cable(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("autec-1200")
    shape = static_shape(tow)
    W, w, EA = 19170.0, tow.cable.weight_in_water, tow.cable.axial_stiffness
    np.testing.assert_allclose(shape.T, W + w * shape.s, rtol=1e-12)
    np.testing.assert_allclose(shape.phi, 0.5 * math.pi, atol=1e-12)
    assert shape.trail == pytest.approx(0.0, abs=1e-9)
    assert shape.depth == pytest.approx(1200.0 + (W * 1200.0 + 0.5 * w * 1200.0**2) / EA, rel=1e-10)


def test_catenary(configurations: Callable[[str], Tow]) -> None:
    """Drag on the vehicle alone: the textbook catenary of horizontal tension H."""
    tow = configurations("mangus-740")
    bare = replace(tow.cable, normal_drag_coefficient=0.0, tangential_drag_coefficient=0.0, axial_stiffness=1e14)
    shape = static_shape(replace(tow, cable=bare, speed=1.5))
    H, W, w = 0.5 * RHO * 1.6 * 0.52 * 1.5**2, 6000.0, bare.weight_in_water
    V = W + w * shape.s
    np.testing.assert_allclose(shape.T, np.hypot(H, V), rtol=1e-9)
    np.testing.assert_allclose(np.tan(shape.phi), V / H, rtol=1e-8)
    x = H / w * (np.arcsinh(V / H) - np.arcsinh(V[-1] / H))
    z = (np.hypot(H, V) - np.hypot(H, V[-1])) / w
    np.testing.assert_allclose(shape.x, x, atol=1e-6)
    np.testing.assert_allclose(shape.z, z, atol=1e-6)


@pytest.mark.parametrize("speed", [0.25, -0.8, 1.5])
@pytest.mark.parametrize("poisson", [0.5, 0.3])
def test_tow_against_dense_integration(configurations: Callable[[str], Tow], speed: float, poisson: float) -> None:
    tow = configurations("mangus-2500")
    tow = replace(tow, cable=replace(tow.cable, poisson_ratio=poisson, tangential_drag_coefficient=0.1), speed=speed)
    shape = static_shape(tow)
    start, top = dense_shape(tow, lambda _: 0.0, shape.depth)
    np.testing.assert_allclose([shape.trail, shape.depth], [top[2], shape.depth], rtol=1e-6)
    assert top[3] == pytest.approx(0.0, abs=1e-3)
    assert shape.T[-1] == pytest.approx(math.hypot(top[0], top[1]), rel=1e-7)
    assert shape.phi[-1] == pytest.approx(math.atan2(top[1], top[0]), rel=1e-7)
    assert shape.T[0] == pytest.approx(math.hypot(start[0], start[1]), rel=1e-12)


def test_sheared_current_acts_where_the_cable_is(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    current = Current.from_profile([0.0, 300.0, 600.0], [0.8, 0.2, -0.3])
    shape = static_shape(replace(tow, current=current, speed=0.4), stations=2000)
    sheared = replace(tow, speed=0.4)

    def water(depth: float) -> float:
        return float(np.interp(depth, [0.0, 300.0, 600.0], [0.8, 0.2, -0.3]))

    depth = brentq(lambda d: dense_shape(sheared, water, d)[1][3], 500.0, 745.0, xtol=1e-7)
    top = dense_shape(sheared, water, depth)[1]
    assert shape.depth == pytest.approx(depth, abs=1e-3)
    assert shape.trail == pytest.approx(top[2], abs=1e-3)
    assert shape.T[-1] == pytest.approx(math.hypot(top[0], top[1]), rel=1e-6)
    # The same speeds at other depths give another shape.
    shallow = Current.from_profile([0.0, 100.0, 200.0], [0.8, 0.2, -0.3])
    assert abs(static_shape(replace(sheared, current=shallow)).trail - shape.trail) > 10.0


@pytest.mark.parametrize("speed", [0.5, 2.0, -2.0])
def test_critical_tow_angle(speed: float) -> None:
    """A long cable with a light vehicle leans at w cos phi = 1/2 rho d C_n U^2 sin^2 phi."""
    cable = Cable(
        length=20_000.0,
        diameter=0.02,
        mass=1.0,
        weight_in_water=7.0,
        added_mass=0.3,
        axial_stiffness=1e9,
        normal_drag_coefficient=1.6,
        tangential_drag_coefficient=0.0,
    )
    light = Vehicle(weight_in_water=50.0, mass=10.0, added_mass=0.0, area=0.1, drag_coefficient=1.0)
    shape = static_shape(Tow(cable=cable, vehicle=light, speed=speed), stations=4000)
    drag = 0.5 * RHO * 0.02 * 1.6 * speed**2
    cosine = (-7.0 + math.sqrt(7.0**2 + 4.0 * drag**2)) / (2.0 * drag)
    assert math.cos(shape.phi[-1]) == pytest.approx(math.copysign(cosine, speed), rel=1e-3)


@pytest.mark.parametrize(
    ("length", "weight", "thesis", "front"),
    [
        (500.0, 6000.0, 5.7, 6.4),
        (1000.0, 6000.0, 10.2, 11.6),
        (2500.0, 6000.0, 20.2, 23.8),
        (2500.0, 11000.0, 17.7, None),
        (2500.0, 16000.0, 15.8, None),
    ],
)
def test_delays_of_section_4_1(
    configurations: Callable[[str], Tow], length: float, weight: float, thesis: float, front: float | None
) -> None:
    tow = configurations("mangus-2500")
    tow = replace(
        tow,
        cable=replace(tow.cable, length=length),
        vehicle=replace(tow.vehicle, weight_in_water=weight),
    )
    shape = static_shape(tow)
    m, w, m_a = tow.cable.mass, tow.cable.weight_in_water, 0.24
    by_hand = length * math.sqrt(m / (weight + 0.5 * w * length))
    assert midpoint_travel_time(tow, shape) == pytest.approx(by_hand, rel=1e-9)
    assert by_hand == pytest.approx(thesis, rel=5e-3)
    # int ds / sqrt(T/(m + m_a)) of a linear tension.
    integral = 2.0 / w * math.sqrt(m + m_a) * (math.sqrt(weight + w * length) - math.sqrt(weight))
    assert travel_time(tow, shape) == pytest.approx(integral, rel=1e-5)
    assert front is None or abs(integral - front) < 0.05


def test_pressure_adds_nothing_at_half_and_is_seen_below(configurations: Callable[[str], Tow]) -> None:
    """Strain of a vertical cable: (T - (1 - 2 nu) p A)/EA."""
    tow = configurations("mangus-2500")
    half = static_shape(tow)
    np.testing.assert_allclose(half.strain, half.T / tow.cable.axial_stiffness, rtol=1e-13)
    stiffer = replace(tow, cable=replace(tow.cable, poisson_ratio=0.25))
    shape = static_shape(stiffer)
    np.testing.assert_allclose(shape.T, half.T, rtol=1e-12)
    pressure = -RHO * GRAVITY * shape.z
    expected = (shape.T - 0.5 * pressure * tow.cable.cross_section) / tow.cable.axial_stiffness
    np.testing.assert_allclose(shape.strain, expected, rtol=1e-9)
    # Half of p A at 2500 m is 2.95 kN: the mean strain falls by half of that over EA.
    assert half.depth - shape.depth == pytest.approx(2500.0 * 1477.0 / tow.cable.axial_stiffness, rel=0.01)


@pytest.mark.parametrize(("speed", "thrust"), [(0.25, 0.0), (0.5, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.5, -400.0)])
def test_towfish_pitch_by_moments_in_the_world_frame(table_two: Tow, speed: float, thrust: float) -> None:
    """Force and moment balance of H Table II's towfish, written with world vectors and a numerical search."""
    fish = table_two.vehicle
    assert isinstance(fish, Towfish)
    shape = static_shape(replace(table_two, speed=speed, vehicle=replace(fish, thrust=thrust)), stations=10)

    def turned(p: float, q: float, pitch: float) -> np.ndarray:
        return np.array([p * math.cos(pitch) - q * math.sin(pitch), p * math.sin(pitch) + q * math.cos(pitch)])

    def loads(pitch: float) -> tuple[np.ndarray, np.ndarray]:
        ahead, up = turned(1.0, 0.0, pitch), turned(0.0, 1.0, pitch)
        through = np.array([speed, 0.0])
        along, across = through @ ahead, through @ up
        size = 0.5 * RHO * 2.0 * (0.25 * abs(along) + 1.0 * abs(across))
        drag = -size * through
        return drag, -(drag + np.array([thrust, 780.0 - 3920.0]))

    def moment(pitch: float) -> float:
        drag, rope = loads(pitch)
        total = 0.0
        for place, force in (
            (turned(-0.05, 0.0, pitch), drag),
            (turned(0.0, 0.8, pitch), rope),
            (turned(0.0, 0.02, pitch), np.array([0.0, 780.0])),
        ):
            total += place[0] * force[1] - place[1] * force[0]
        return total

    pitch = brentq(moment, -1.2, 1.2, xtol=1e-13)
    assert shape.pitch == pytest.approx(pitch, abs=1e-10)
    rope = loads(pitch)[1]
    assert shape.T[0] == pytest.approx(np.hypot(*rope), rel=1e-12)
    assert shape.phi[0] == pytest.approx(math.atan2(rope[1], rope[0]), rel=1e-12)
    assert math.copysign(1.0, -shape.pitch) == math.copysign(1.0, speed)


@pytest.mark.parametrize("current", [0.2, -0.5])
def test_sections_against_dense_integration(configurations: Callable[[str], Tow], current: float) -> None:
    """An S of three different lengths of cable below a thrusting point vehicle, in a sheared current."""
    tow = configurations("s-shape-205")
    rope = replace(tow.cable, length=30.0, diameter=0.03, weight_in_water=0.0, axial_stiffness=1e5)
    vehicle = Vehicle(weight_in_water=530.0, mass=400.0, added_mass=500.0, area=0.25, drag_coefficient=2.0, thrust=40.0)
    sheared = Current.from_profile([0.0, 300.0], [current, 0.5 * current])
    tow = replace(tow, sections=(*tow.sections, rope), vehicle=vehicle, current=sheared)

    def water(depth: float) -> float:
        return float(np.interp(depth, [0.0, 300.0], [current, 0.5 * current]))

    shape = static_shape(tow)
    start, top = dense_shape(tow, water, shape.depth)
    assert top[3] == pytest.approx(0.0, abs=1e-5)
    assert shape.trail == pytest.approx(top[2], abs=1e-5)
    assert shape.T[-1] == pytest.approx(math.hypot(top[0], top[1]), rel=1e-7)
    assert shape.T[0] == pytest.approx(math.hypot(start[0], start[1]), rel=1e-12)
    assert np.abs(np.diff(shape.phi)).max() < 1.0
    stiffness = np.where(shape.s <= 30.0, 1e5, tow.cable.axial_stiffness)
    np.testing.assert_allclose(shape.strain, shape.T / stiffness, rtol=1e-12)
    # A cable cut in two is the same cable.
    cut = replace(tow.cable, length=50.0)
    again = static_shape(replace(tow, cable=replace(tow.cable, length=80.0), sections=(cut, *tow.sections)))
    for name in ("phi", "T", "x", "z", "strain"):
        np.testing.assert_allclose(getattr(again, name), getattr(shape, name), rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize(
    ("name", "depth", "share", "pitch"), [("s-shape-205", 100.0, 0.01, 1.0), ("s-shape-205-thrust", 98.7, 0.001, 8.0)]
)
def test_static_s_shape_of_example_2(
    configurations: Callable[[str], Tow], name: str, depth: float, share: float, pitch: float
) -> None:
    """H prints a depth of 100 m, tensions of 530 and 840 N, and 8.0 degrees, which one of the two readings meets."""
    shape = static_shape(configurations(name))
    assert shape.depth == pytest.approx(depth, rel=share)
    assert shape.depth == pytest.approx(100.0, rel=0.015)
    assert shape.T[0] == pytest.approx(530.0, rel=0.01)
    assert shape.T[-1] == pytest.approx(840.0, rel=0.03)
    assert math.degrees(shape.pitch) == pytest.approx(pitch, abs=0.3)
    # Up, over the arc, down, and up again to the ship.
    turns = np.flatnonzero(np.diff(np.sign(np.diff(shape.z))))
    assert turns.size == 2
    assert shape.T[turns[0]] == pytest.approx(shape.T.min(), rel=0.05)


def test_s_shape_with_the_weight_of_the_text_does_not_fit(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("s-shape-205")
    shape = static_shape(replace(tow, vehicle=replace(tow.vehicle, buoyancy=3420.0)))
    assert abs(shape.depth - 100.0) > 5.0
    assert shape.T[0] < 505.0
    assert shape.T[-1] < 800.0


def test_static_swath_4000(configurations: Callable[[str], Tow]) -> None:
    """The static tensions of H Table IV, 3.14 and 35.70 kN."""
    shape = static_shape(configurations("swath-4000"))
    assert (shape.T[0], shape.T[-1]) == pytest.approx((3140.0, 35700.0), rel=1e-9)


@pytest.mark.parametrize(
    ("name", "depth"), [("s-shape-205", 100.0), ("s-shape-205", 60.0), ("mangus-740", 900.0), ("mangus-2500", 80.0)]
)
@pytest.mark.parametrize("sheared", [False, True])
def test_length_for_a_depth_is_the_shortest_that_gives_it(
    configurations: Callable[[str], Tow], name: str, depth: float, sheared: bool
) -> None:
    current = Current.from_profile([0.0, 40.0, 100.0], [0.5, 0.3, 0.1]) if sheared else Current.uniform(0.2)
    tow = replace(configurations(name), current=current)
    found = length_for_depth(tow, depth)
    assert replace(found.cable, length=tow.cable.length) == tow.cable
    assert found.sections == tow.sections
    shape = static_shape(found, stations=1000)
    assert shape.depth == pytest.approx(depth, abs=1e-6)
    # The way up from that depth is the same for any length: it comes to the surface at its end only.
    assert shape.z[:-1].max() < 0.0


def test_length_for_a_depth_of_a_vertical_cable(configurations: Callable[[str], Tow]) -> None:
    tow = replace(configurations("mangus-740"), current=None)
    W, w, EA = 6000.0, tow.cable.weight_in_water, tow.cable.axial_stiffness
    # L + (W L + w L^2/2)/EA = 1000 m.
    length = brentq(lambda L: L + (W * L + 0.5 * w * L**2) / EA - 1000.0, 900.0, 1000.0, xtol=1e-10)
    assert length_for_depth(tow, 1000.0).cable.length == pytest.approx(length, abs=1e-6)
