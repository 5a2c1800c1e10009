"""The continuum solutions that the link-joint chain is judged by, against closed forms, balances and each other."""

import math
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.linalg import eigh_tridiagonal
from scipy.special import j0, j1, y0, y1

from models.body import Body
from models.cable import Cable
from models.current import Current
from models.statics import static_shape
from models.tow import Tow
from models.towed_system import Part, TowedSystem

FINNED = Body(
    weight=9000.0,
    buoyancy=3000.0,
    mass=900.0,
    added_mass_surge=100.0,
    added_mass_sway=500.0,
    added_mass_heave=800.0,
    area_surge=0.3,
    area_sway=1.5,
    area_heave=1.0,
    drag_coefficient=1.2,
)


def system(configurations: Callable[[str], Tow], **cable: float) -> TowedSystem:
    """The tow of mangus-740 with other fields of its cable."""
    tow = configurations("mangus-740")
    return TowedSystem.from_tow(replace(tow, cable=replace(tow.cable, **cable)))


def with_body(tow: TowedSystem, body: Body) -> TowedSystem:
    return replace(tow, parts=(replace(tow.parts[0], body=body),))


@pytest.mark.parametrize("stiffness", [1e15, 2e6])
def test_straight_tow_is_the_planar_shape(
    continuum: ModuleType, configurations: Callable[[str], Tow], stiffness: float
) -> None:
    """Turned by 0.7 rad."""
    tow = replace(configurations("mangus-740"), speed=1.3)
    tow = replace(tow, cable=replace(tow.cable, axial_stiffness=stiffness, tangential_drag_coefficient=0.1))
    planar = static_shape(tow, stations=4000)
    ahead = np.array([math.cos(0.7), math.sin(0.7), 0.0])
    (line,) = continuum.straight_tow(TowedSystem.from_tow(tow), 1.3 * ahead)
    np.testing.assert_allclose(line.upper - line.lower, planar.trail * ahead + [0.0, 0.0, planar.depth], rtol=1e-9)
    np.testing.assert_allclose(line.tension, [planar.T[-1], planar.T[0]], rtol=1e-9)


def test_sheared_current_along_the_track(continuum: ModuleType, configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    tow = replace(tow, cable=replace(tow.cable, axial_stiffness=1e15), speed=0.4)
    tow = replace(tow, current=Current.from_profile([0.0, 300.0, 600.0], [0.8, 0.2, -0.3]))
    planar = static_shape(tow, stations=4000)
    (line,) = continuum.straight_tow(TowedSystem.from_tow(tow), np.array([0.4, 0.0, 0.0]))
    assert line.upper[0] - line.lower[0] == pytest.approx(planar.trail, rel=1e-6)
    assert -line.lower[2] == pytest.approx(planar.depth, rel=1e-6)


def test_wide_circle_is_the_straight_tow(continuum: ModuleType, configurations: Callable[[str], Tow]) -> None:
    """Depth and trail differ by 1/R^2; both bodies, of which one turns its long side."""
    for tow in (system(configurations), with_body(system(configurations), FINNED)):
        (straight,) = continuum.straight_tow(tow, np.array([1.0, 0.0, 0.0]))
        misses = []
        for radius in (1e4, 1e5):
            (circle,) = continuum.circular_tows(tow, radius, 1.0)
            trail = circle.radius[0] * math.sin(circle.lag[0])
            misses.append([circle.depth[0] + straight.lower[2], trail - straight.upper[0] + straight.lower[0]])
        wide, wider = np.abs(misses)
        assert (wide < 1.0).all()
        np.testing.assert_allclose(wider, wide / 100.0, rtol=0.05)


def test_left_and_right_are_mirrored(continuum: ModuleType, configurations: Callable[[str], Tow]) -> None:
    tow = with_body(system(configurations), FINNED)
    (left,), (right,) = (continuum.circular_tows(tow, 400.0, speed) for speed in (1.5, -1.5))
    np.testing.assert_allclose([*left.radius, *left.depth], [*right.radius, *right.depth], rtol=1e-9)
    np.testing.assert_allclose(left.lag, right.lag, rtol=1e-8)


def test_conical_pendulum(continuum: ModuleType, configurations: Callable[[str], Tow]) -> None:
    """A light cable without drag stands at tan(theta) = Omega^2 r (M + M_a)/W."""
    tow = system(configurations, mass=1e-9, weight_in_water=0.0, added_mass=0.0, normal_drag_coefficient=0.0,
                 tangential_drag_coefficient=0.0, axial_stiffness=1e15)  # fmt: skip
    body = replace(FINNED, drag_coefficient=0.0)
    circle = continuum.circle_from(with_body(tow, body), 0.05, 300.0)
    # The horizontal pull is inward, along the surge axis.
    slope = 0.05**2 * 300.0 * (900.0 + 100.0) / 6000.0
    assert circle.depth[0] == pytest.approx(740.0 / math.hypot(1.0, slope), rel=1e-9)
    assert math.hypot(*circle.lines[0].upper[:2]) == pytest.approx(
        abs(300.0 - 740.0 * slope / math.hypot(1.0, slope)), rel=1e-9
    )


@pytest.mark.parametrize("radius", [60.0, 600.0])
@pytest.mark.parametrize("stiffness", [1e15, 1e6])
def test_torque_balance_of_the_circle(
    continuum: ModuleType, configurations: Callable[[str], Tow], radius: float, stiffness: float
) -> None:
    """The ship's torque about the axis is that of the water on cable and body, an integral beside the shooting."""
    tow = system(configurations, axial_stiffness=stiffness)
    cable, body, rate = tow.parts[0].cable, tow.parts[0].body, 1.0 / radius
    circle = continuum.circular_tows(tow, radius, 1.0)[0]
    line = circle.lines[0]
    s, weights = np.polynomial.legendre.leggauss(200)
    s, weights = 0.5 * cable.length * (s + 1.0), 0.5 * cable.length * weights
    torque = rate * abs(rate) * 0.5 * 1025.0 * body.drag_coefficient * body.area_surge * circle.radius[0] ** 3
    for one, weight in zip(s, weights, strict=True):
        y = line.at(one)
        t = y[3:] / np.linalg.norm(y[3:])
        u = -rate * np.array([-y[1], y[0], 0.0])
        u_n, a = u - (u @ t) * t, -(rate**2) * np.array([y[0], y[1], 0.0])
        drag = cable.normal_drag(1025.0) * np.linalg.norm(u_n) * u_n
        drag = drag + cable.tangential_drag(1025.0) * abs(u @ t) * (u @ t) * t
        e = np.linalg.norm(y[3:]) / stiffness
        drag *= (1.0 + e) * (1.0 - 0.5 * e)
        force = drag - cable.added_mass * (a - (a @ t) * t)
        torque -= weight * (y[0] * force[1] - y[1] * force[0])
    pull = line.pull_upper
    assert line.upper[0] * pull[1] - line.upper[1] * pull[0] == pytest.approx(torque, rel=1e-7)


def test_small_circle_without_drag_is_the_bessel_string(
    continuum: ModuleType, configurations: Callable[[str], Tow]
) -> None:
    """Small radius, no drag: (T r')' + mu Omega^2 r = 0 has r = A J0(z) + B Y0(z), as the hanging chain."""
    tow = system(configurations, normal_drag_coefficient=0.0, tangential_drag_coefficient=0.0, axial_stiffness=1e15)
    cable, body = tow.parts[0].cable, replace(tow.parts[0].body, drag_coefficient=0.0)
    rate, tip, M, W = 0.11, 1e-3, body.mass + body.added_mass_surge, body.weight_in_water
    circle = continuum.circle_from(with_body(tow, body), rate, tip)
    mu, w = cable.mass + cable.added_mass, cable.weight_in_water
    z = [2.0 * rate / w * math.sqrt(mu * T) for T in (W, W + w * cable.length)]
    slope = rate * math.sqrt(mu / W)
    # r = tip and W r' = -M Omega^2 tip at the body.
    A, B = np.linalg.solve(
        [[j0(z[0]), y0(z[0])], [-slope * j1(z[0]), -slope * y1(z[0])]], [tip, -M * rate**2 * tip / W]
    )
    top = A * j0(z[1]) + B * y0(z[1])
    assert circle.lines[0].upper[0] == pytest.approx(top, rel=1e-6)
    assert top < 0.0


@pytest.mark.parametrize("stiffness", [1e15, 2e6])
def test_circle_by_collocation(continuum: ModuleType, configurations: Callable[[str], Tow], stiffness: float) -> None:
    """The same circle as a two-point problem with the ship's place given, solved by collocation from a plain helix."""
    tow = system(configurations, axial_stiffness=stiffness)
    cable, body, speed, radius = tow.parts[0].cable, tow.parts[0].body, 1.2, 500.0
    rate, L = speed / radius, cable.length
    W, k_b = body.weight_in_water, 0.5 * 1025.0 * body.drag_coefficient * body.area_surge
    M = body.mass + body.added_mass_surge

    def derivative(s: np.ndarray, y: np.ndarray) -> np.ndarray:
        """y = place/100 m and pull/10 kN; inertia as a tensor on the acceleration, drag on the relative water."""
        x, F = 100.0 * y[:3], 1e4 * y[3:]
        T = np.sqrt((F**2).sum(0))
        t = F / T
        v = rate * np.stack([-x[1], x[0], 0.0 * x[0]])
        a = rate**2 * np.stack([-x[0], -x[1], 0.0 * x[0]])
        v_t, a_t = (v * t).sum(0), (a * t).sum(0)
        v_n = v - v_t * t
        dF = cable.mass * a + cable.added_mass * (a - a_t * t)
        e = T / cable.axial_stiffness
        dF = dF + (1.0 + e) * (1.0 - 0.5 * e) * 0.5 * 1025.0 * cable.diameter * (
            cable.normal_drag_coefficient * np.sqrt((v_n**2).sum(0)) * v_n
            + cable.tangential_drag_coefficient * np.abs(v_t) * v_t * t
        )
        dF[2] += cable.weight_in_water
        return np.concatenate([(1.0 + T / cable.axial_stiffness) * t / 100.0, dF / 1e4])

    def ends(y_0: np.ndarray, y_1: np.ndarray) -> np.ndarray:
        x = 100.0 * y_0[:3]
        v = rate * np.array([-x[1], x[0], 0.0])
        F = np.array([0.0, 0.0, W]) + k_b * np.linalg.norm(v) * v - M * rate**2 * np.array([x[0], x[1], 0.0])
        return np.concatenate([y_0[3:] - F / 1e4, y_1[:3] - [radius / 100.0, 0.0, 0.0]])

    s = np.linspace(0.0, L, 60)
    guess = np.stack([radius - 0.1 * (L - s), -0.4 * (L - s), 0.9 * (s - L), 0.0 * s, 0.0 * s, W + 8.0 * s])
    guess[:3] /= 100.0
    guess[3:] /= 1e4
    solved = solve_bvp(derivative, ends, s, guess, tol=1e-8, max_nodes=20000)
    assert solved.success, solved.message
    (circle,) = continuum.circular_tows(tow, radius, speed)
    body_place = 100.0 * solved.y[:3, 0]
    assert math.hypot(*body_place[:2]) == pytest.approx(circle.radius[0], rel=1e-6)
    assert -body_place[2] == pytest.approx(circle.depth[0], rel=1e-6)
    assert -math.atan2(body_place[1], body_place[0]) == pytest.approx(circle.lag[0], rel=1e-6)
    tension = 1e4 * np.linalg.norm(solved.y[3:, [-1, 0]], axis=0)
    np.testing.assert_allclose(tension, circle.lines[0].tension, rtol=1e-6)


def test_two_parts_in_one_line_are_the_cable_they_make(
    continuum: ModuleType, configurations: Callable[[str], Tow]
) -> None:
    whole = system(configurations)
    part = whole.parts[0]
    parts = (
        Part(name="upper", cable=replace(part.cable, length=300.0), body=None),
        Part(name="lower", cable=replace(part.cable, length=440.0), body=part.body, after="upper"),
    )
    (one,), (two,) = (continuum.circular_tows(each, 500.0, 1.5) for each in (whole, replace(whole, parts=parts)))
    assert two.radius[1] == pytest.approx(one.radius[0], rel=1e-9)
    np.testing.assert_allclose(two.lines[0].pull_upper, one.lines[0].pull_upper, rtol=1e-7)
    np.testing.assert_allclose(two.lines[1].upper, one.lines[0].at(440.0)[:3], rtol=1e-7)


def test_hanging_frequencies_are_those_of_a_fine_difference_string(
    continuum: ModuleType, configurations: Callable[[str], Tow]
) -> None:
    cable = configurations("mangus-740").cable
    W, M, n = 3000.0, 500.0, 2000
    h = cable.length / n
    T = W + cable.weight_in_water * (np.arange(n) + 0.5) * h
    mass = np.full(n, (cable.mass + cable.added_mass) * h)
    mass[0] = 0.5 * mass[0] + M
    inner = -T[:-1] / h / np.sqrt(mass[:-1] * mass[1:])
    values = eigh_tridiagonal((T + np.append(0.0, T[:-1])) / h / mass, inner, select="i", select_range=(0, 2))[0]
    np.testing.assert_allclose(continuum.hanging_frequencies(cable, W, M), np.sqrt(values), rtol=1e-6)
    # No cable: the pendulum.
    light = replace(cable, mass=1e-6, added_mass=0.0, weight_in_water=1e-4)
    pendulum = math.sqrt(W / M / cable.length)
    assert continuum.hanging_frequencies(light, W, M, 1)[0] == pytest.approx(pendulum, rel=1e-4)


@pytest.mark.parametrize("stiffness", [1e15, 1e5])
def test_catenary_between_two_ends(
    continuum: ModuleType, configurations: Callable[[str], Tow], stiffness: float
) -> None:
    """The element's own balance, by differences of the closed form; the ends where they should be."""
    cable: Cable = replace(configurations("mangus-740").cable, axial_stiffness=stiffness)
    held = continuum.catenary(cable, 400.0, 100.0)
    s = np.linspace(0.0, cable.length, 20001)
    x, z, T = held.at(s)
    assert x[-1] == pytest.approx(400.0, rel=1e-12)
    assert z[-1] == pytest.approx(-100.0, rel=1e-11)
    dx, dz = np.gradient(x, s), np.gradient(z, s)
    inner = slice(2, -2)
    np.testing.assert_allclose(np.hypot(dx, dz)[inner], (1.0 + T / stiffness)[inner], rtol=1e-6)
    stretch = 1.0 + T / stiffness
    np.testing.assert_allclose((T * dx / stretch)[inner], held.H, rtol=1e-6)
    pull = (-T * dz / stretch)[inner]
    np.testing.assert_allclose(pull, held.V_upper - cable.weight_in_water * s[inner], atol=1e-6 * held.V_upper)


def test_tractrix_of_a_straight_path(continuum: ModuleType) -> None:
    """From a rod at right angles: x = a (u - tanh u), y = a / cosh u, u = V t / a."""
    times = np.linspace(0.0, 400.0, 9)
    path = continuum.tractrix(lambda t: (np.array([0.5 * t, 0.0]), np.array([0.5, 0.0])), np.array([0.0, 60.0]), times)
    u = 0.5 * times / 60.0
    np.testing.assert_allclose(path, 60.0 * np.stack([u - np.tanh(u), 1.0 / np.cosh(u)], axis=1), atol=1e-7)
