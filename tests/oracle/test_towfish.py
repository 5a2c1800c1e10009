"""The pitching towfish of H Table II against H's matrices, and against the point vehicle where they are one."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import eigvals

from models.spectral import STEPPERS, simulate
from models.statics import static_shape
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Towfish, Vehicle

Floats = NDArray[np.float64]


def fish_of(tow: Tow) -> Towfish:
    assert isinstance(tow.vehicle, Towfish)
    return tow.vehicle


def light_rope(tow: Tow, length: float, **changes: float) -> Tow:
    """The towfish on a rope without mass, weight and drag, itself without drag."""
    cable = replace(
        tow.cable,
        length=length,
        mass=1e-4,
        added_mass=0.0,
        weight_in_water=0.0,
        normal_drag_coefficient=0.0,
        tangential_drag_coefficient=0.0,
    )
    return replace(tow, cable=cable, vehicle=replace(fish_of(tow), drag_coefficient=0.0, **changes))


def natural_frequencies(tow: Tow) -> Floats:
    """Of H (21)-(23): H [P, Q, Phi] = R^T diag(1, T_1) [T~, phi~], with T~ = -EA/L p_1, (1 + T/EA) phi~ = -q_1/L.

    Vertical and still: Phi = 0 and psi = 90 degrees, so that H_13 and H_23 vanish.
    """
    a, L = fish_of(tow), tow.cable.length
    T = a.weight - a.buoyancy
    inertia = np.array(
        [
            [a.mass + a.added_mass_p, 0.0, 0.0],
            [0.0, a.mass + a.added_mass_q, 0.0],
            [-a.added_mass_centre_q * a.added_mass_p, a.added_mass_centre_p * a.added_mass_q, a.inertia],
        ]
    )
    righting = a.buoyancy * a.buoyancy_centre_q + T * a.tow_point_q
    R = np.array([[0.0, 1.0, a.tow_point_p], [-1.0, 0.0, a.tow_point_q]])
    stretched = L * (1.0 + T / tow.cable.axial_stiffness)
    stiffness = R.T @ np.diag([tow.cable.axial_stiffness / L, T / stretched]) @ R
    stiffness[2, 2] += righting
    squares = eigvals(stiffness, inertia)
    assert np.all(np.abs(squares.imag) < 1e-9 * np.abs(squares))
    return np.sort(np.sqrt(squares.real))


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"tow_point_q": 0.3, "added_mass_centre_p": -0.3, "added_mass_centre_q": 0.1, "added_mass_q": 900.0},
    ],
)
def test_free_oscillation_has_the_frequencies_of_the_matrices(table_two: Tow, changes: dict[str, float]) -> None:
    """Surge and pitch after a small push: nothing but H's frequencies is in them."""
    tow = light_rope(table_two, 60.0, **changes)
    omegas = natural_frequencies(tow)
    t = np.arange(0.0, 120.0, 0.1)
    s = np.clip(t / 2.0, 0.0, 1.0)
    push = 2e-3 * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    result = simulate(tow, Trace.along_x(t, push, 0.2 * push), harmonics=2, tolerance=1e-9)
    assert result.pitch is not None
    free = t > 2.5
    later = t[free]
    basis = np.column_stack([np.ones_like(later)] + [f(om * later) for om in omegas for f in (np.cos, np.sin)])
    for motion in (result.vehicle.position[:, 0], result.pitch):
        wave = motion[free]
        fit = np.linalg.lstsq(basis, wave, rcond=None)[0]
        assert np.std(wave - basis @ fit) < 2e-3 * np.std(wave)
    # The frequencies are told apart by the motion: other ones do not fit.
    wrong = np.column_stack([np.ones_like(later)] + [f(1.02 * om * later) for om in omegas for f in (np.cos, np.sin)])
    fit = np.linalg.lstsq(wrong, result.pitch[free], rcond=None)[0]
    assert np.std(result.pitch[free] - wrong @ fit) > 0.05 * np.std(result.pitch[free])


def test_forced_surge_and_heave_on_a_light_rope(table_two: Tow) -> None:
    """Steady response at one frequency: (K - omega^2 M) x = what the moving top pulls with."""
    tow = light_rope(table_two, 60.0, added_mass_centre_p=-0.3)
    omega, omegas = 0.8, natural_frequencies(light_rope(table_two, 60.0, added_mass_centre_p=-0.3))
    a, L, T = fish_of(tow), 60.0, 3140.0
    EA = tow.cable.axial_stiffness
    R = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, a.tow_point_q]])
    inertia = np.diag([900.0, 900.0, 280.0])
    inertia[2, 1] = -0.3 * 500.0
    stiffness = R.T @ np.diag([EA / L, T / L]) @ R
    stiffness[2, 2] += 780.0 * 0.02 + T * 0.8
    # Surge x_n and heave z_n of the top: p_n = z_n, q_n = -x_n.
    pull = R.T @ np.diag([EA / L, T / L]) @ [5e-4, -2e-3]
    steady = np.linalg.solve(stiffness - omega**2 * inertia, pull)
    t = np.arange(0.0, 150.0, 0.1)
    turn = 1.0 - np.cos(omega * t)
    result = simulate(tow, Trace.along_x(t, 2e-3 * turn, 5e-4 * turn), harmonics=2, tolerance=1e-7)
    assert result.pitch is not None
    columns = [np.ones_like(t)] + [f(om * t) for om in (omega, *omegas) for f in (np.cos, np.sin)]
    basis = np.column_stack(columns)
    got = [
        -np.linalg.lstsq(basis, motion, rcond=None)[0][1]
        for motion in (result.vehicle.position[:, 0], result.vehicle.position[:, 2], result.pitch)
    ]
    np.testing.assert_allclose(got, steady, rtol=5e-3, atol=2e-6)


@pytest.mark.parametrize("stepper", STEPPERS)
def test_large_motions_follow_the_equations_of_motion(table_two: Tow, stepper: str) -> None:
    """H (15)-(17) as printed, in body velocities, with every coefficient different; the rope is a straight spring."""
    tow = light_rope(table_two, 60.0)
    fish = replace(
        fish_of(table_two),
        tow_point_p=0.05,
        tow_point_q=0.06,
        added_mass_p=200.0,
        added_mass_q=600.0,
        added_mass_centre_q=0.1,
        buoyancy_centre_p=-0.03,
        drag_centre_p=-0.2,
        drag_centre_q=0.1,
        inertia=90.0,
    )
    tow = replace(tow, cable=replace(tow.cable, axial_stiffness=1e6, mass=0.01), vehicle=fish)
    shape = static_shape(tow)
    a, EA, L = fish, 1e6, 60.0
    T_0 = a.weight - a.buoyancy
    c, k_r = 0.5 * 1025.0 * 2.0, 0.5 * 1025.0 * 2.0 * 1.0 * 2.0**3 / 32.0
    t = np.arange(0.0, 50.0, 0.1)
    ship = Trace.along_x(t, 8.0 * (1.0 - np.cos(0.7 * t)), 0.1 * np.sin(0.9 * t) ** 2)

    def tow_point(X: float, Z: float, Phi: float) -> tuple[float, float]:
        s, co = math.sin(Phi), math.cos(Phi)
        return X + a.tow_point_p * co - a.tow_point_q * s, Z + a.tow_point_p * s + a.tow_point_q * co

    ends = tow_point(0.0, 0.0, shape.pitch)

    def rate(now: float, y: Floats) -> list[float]:
        X, Z, Phi, U, V, spin = y
        s, co = math.sin(Phi), math.cos(Phi)
        x_e, z_e = tow_point(X, Z, Phi)
        x_s, _, z_s = ship.spline(now)
        slope = (x_s - (x_e - ends[0])) / (L * (1.0 + T_0 / EA))
        T = T_0 + EA / L * (z_s - (z_e - ends[1]) + 0.5 * L * slope**2)
        T_P, T_Q = T * slope * co + T * s, -T * slope * s + T * co
        k = c * (a.area_p * abs(U) + a.area_q * abs(V))
        dU = (a.mass * spin * V + (a.buoyancy - a.weight) * s + T_P - k * U) / (a.mass + a.added_mass_p)
        dV = (-a.mass * spin * U + (a.buoyancy - a.weight) * co + T_Q - k * V) / (a.mass + a.added_mass_q)
        moment = (
            -a.added_mass_centre_p * a.added_mass_q * dV
            + a.added_mass_centre_q * a.added_mass_p * dU
            + a.buoyancy * (a.buoyancy_centre_p * co - a.buoyancy_centre_q * s)
            + a.tow_point_p * T_Q
            - a.tow_point_q * T_P
            - k_r * spin * abs(spin)
            - k * (a.drag_centre_p * V - a.drag_centre_q * U)
        )
        return [U * co - V * s, U * s + V * co, spin, dU, dV, moment / a.inertia]

    start = [0.0, 0.0, shape.pitch, 0.0, 0.0, 0.0]
    truth = solve_ivp(rate, (0.0, t[-1]), start, t_eval=t, method="LSODA", rtol=1e-8, atol=1e-9).y
    result = simulate(tow, ship, harmonics=2, tolerance=1e-5, stepper=stepper, step=0.005)
    assert result.pitch is not None
    assert np.ptp(truth[2]) > 1.0
    np.testing.assert_allclose(result.pitch, truth[2], atol=5e-3 * np.ptp(truth[2]))
    for axis, row in ((0, truth[0]), (2, truth[1])):
        moved = result.vehicle.position[:, axis] - result.vehicle.position[0, axis]
        np.testing.assert_allclose(moved, row, atol=5e-3 * np.ptp(row))


@pytest.mark.parametrize("stepper", STEPPERS)
@pytest.mark.parametrize("speed", [0.0, 0.5, -0.5])
def test_a_steady_tow_keeps_its_pitch(table_two: Tow, stepper: str, speed: float) -> None:
    tow = replace(table_two, cable=replace(table_two.cable, length=400.0), speed=speed)
    t = np.arange(0.0, 61.0)
    result = simulate(tow, Trace.along_x(t, speed * t), harmonics=5, stepper=stepper)
    shape = static_shape(tow)
    assert result.pitch is not None
    np.testing.assert_allclose(result.pitch, shape.pitch, atol=3e-6)
    np.testing.assert_allclose(result.vehicle.velocity[:, 0], speed, atol=1e-5)
    # The trace is the centre of mass: 0.8 m below the cable's end along the body's own axis.
    centre = np.array([shape.x[0] + 0.8 * math.sin(shape.pitch), shape.z[0] - 0.8 * math.cos(shape.pitch)])
    np.testing.assert_allclose(result.vehicle.position[0, [0, 2]], centre, atol=1e-9)
    assert (shape.pitch == 0.0) == (speed == 0.0)


def test_without_levers_it_moves_as_the_point_vehicle(table_two: Tow) -> None:
    """Every centre at the centre of mass (but buoyancy, which keeps it upright), in surge under a vertical cable."""
    fish = replace(
        fish_of(table_two),
        added_mass_centre_p=0.0,
        tow_point_q=0.0,
        drag_centre_p=0.0,
        area_q=0.25,
        buoyancy_centre_q=0.05,
    )
    point = Vehicle(weight_in_water=3140.0, mass=400.0, added_mass=500.0, area=0.25, drag_coefficient=2.0)
    cable = replace(table_two.cable, length=400.0)
    t = np.arange(0.0, 301.0)
    ship = Trace.along_x(t, 4.0 * np.sin(0.05 * t))
    runs = [
        simulate(replace(table_two, cable=cable, vehicle=body), ship, harmonics=8, tolerance=1e-5).vehicle
        for body in (fish, point)
    ]
    size = np.std(runs[1].velocity[:, 0])
    assert np.abs(runs[0].velocity[:, 0] - runs[1].velocity[:, 0]).max() < 2e-3 * size
    assert np.abs(runs[0].position[:, 2] - runs[1].position[:, 2]).max() < 2e-3
    assert np.abs(runs[0].tension[:, 1] - runs[1].tension[:, 1]).max() < 2.0


@pytest.mark.parametrize("stepper", ["implicit", "runge-kutta"])
def test_a_changed_tow_speed_settles_on_the_new_pitch(table_two: Tow, stepper: str) -> None:
    tow = replace(table_two, cable=replace(table_two.cable, length=300.0), speed=0.8)
    t = np.arange(0.0, 2001.0, 2.0)
    for change in (0.04, -0.04):
        ship = Trace.along_x(t, 0.8 * t + change * (t + 60.0 * np.expm1(-t / 60.0)))
        result = simulate(tow, ship, harmonics=8, tolerance=1e-5, stepper=stepper)
        due = static_shape(replace(tow, speed=0.8 + change))
        assert result.pitch is not None
        assert result.pitch[-1] == pytest.approx(due.pitch, abs=1e-6)
        assert abs(due.pitch - static_shape(tow).pitch) > 1e-3


def test_pitch_through_ninety_degrees_stays_finite(table_two: Tow) -> None:
    """A planar pitch has no singular angle: a weakly righted body thrown over by a large surge turns and comes back."""
    fish = replace(
        fish_of(table_two), tow_point_q=0.02, inertia=60.0, length=0.5, drag_centre_p=-0.3, drag_coefficient=1.0
    )
    tow = replace(table_two, cable=replace(table_two.cable, length=100.0), vehicle=fish)
    t = np.arange(0.0, 300.0, 0.25)
    ease = np.clip(t / 20.0, 0.0, 1.0) * np.clip((60.0 - t) / 10.0, 0.0, 1.0)
    result = simulate(tow, Trace.along_x(t, 15.0 * ease * np.sin(0.2 * t)), harmonics=5)
    assert result.pitch is not None
    assert result.vehicle.velocity is not None
    assert np.abs(result.pitch).max() > 0.5 * math.pi
    assert np.abs(result.pitch[-40:]).max() < 0.5
    assert np.abs(result.vehicle.velocity).max() < 20.0
