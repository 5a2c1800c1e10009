"""The matrix method against the printed equations in dense form, the statics, and the paper's figures."""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from data_synth.seas import bretschneider
from models.cable import Cable
from models.current import Current
from models.statics import static_shape
from models.tow import Tow
from models.transfer_matrix import (
    Compensator,
    Response,
    UniformDamping,
    frequency_response,
    product_digits,
    sea_response,
)
from models.transfer_matrix.drag import harmonic
from models.vehicle import Towfish, Vehicle


def dense(tow: Tow, answer: Response, k: int, damping: UniformDamping) -> tuple[np.ndarray, np.ndarray]:
    """States (n+1, 4) and body motion (3,) from physics.md section 5 term by term, all equations in one full matrix."""
    shape, omega = answer.shape, float(answer.omega[k])
    cable, fish = tow.cable, tow.vehicle
    assert isinstance(fish, Towfish)
    w, m, m_a, EA = cable.weight_in_water, cable.mass, cable.added_mass, cable.axial_stiffness
    n = shape.s.size - 1

    def A(i: int) -> np.ndarray:
        T, phi = shape.T[i], shape.phi[i]
        bend = w * math.cos(phi) / T
        return np.array(
            [
                [0, w * math.cos(phi), -m * omega**2 + 1j * omega * damping.axial, 0],
                [-bend / T, -w * math.sin(phi) / T, 0, (-(m + m_a) * omega**2 + 1j * omega * damping.normal) / T],
                [1 / EA, 0, 0, bend],
                [0, 1 + T / EA, -bend, 0],
            ]
        )

    size = 4 * (n + 1) + 3
    K, right = np.zeros((size, size), dtype=complex), np.zeros(size, dtype=complex)
    for i in range(n):
        h = shape.s[i + 1] - shape.s[i]
        rows = slice(4 * i, 4 * i + 4)
        K[rows, 4 * i : 4 * i + 4] = -np.eye(4) - h / 2 * A(i)
        K[rows, 4 * i + 4 : 4 * i + 8] = np.eye(4) - h / 2 * A(i + 1)
    T, psi, Phi = shape.T[0], shape.phi[0] - shape.pitch, shape.pitch
    s, c, net, B = math.sin(psi), math.cos(psi), fish.buoyancy - fish.weight, fish.buoyancy
    r_cP, r_cQ, r_dP, r_dQ = fish.tow_point_p, fish.tow_point_q, fish.drag_centre_p, fish.drag_centre_q
    R = np.array([[c, s, -r_cQ * c + r_cP * s], [-s, c, r_cQ * s + r_cP * c]])
    j = 1j * omega
    H = np.array(
        [
            [-(fish.mass + fish.added_mass_p) * omega**2 + j * damping.surge, 0, -T * s - net * math.cos(Phi)],
            [0, -(fish.mass + fish.added_mass_q) * omega**2 + j * damping.heave, T * c + net * math.sin(Phi)],
            [
                omega**2 * fish.added_mass_centre_q * fish.added_mass_p - j * damping.surge * r_dQ,
                -(omega**2) * fish.added_mass_centre_p * fish.added_mass_q + j * damping.heave * r_dP,
                -fish.inertia * omega**2
                + j * damping.pitch
                + B * (fish.buoyancy_centre_p * math.sin(Phi) + fish.buoyancy_centre_q * math.cos(Phi))
                + T * (r_cP * c + r_cQ * s),
            ],
        ]
    )
    row, body = 4 * n, slice(4 * n + 4, size)
    K[row : row + 3, body] = H
    K[row : row + 3, :2] = -R.T @ np.diag([1.0, T])
    K[row + 3 : row + 5, 2:4], K[row + 3 : row + 5, body] = np.eye(2), -R
    K[row + 5, 4 * n + 2], K[row + 6, 4 * n + 3] = 1.0, 1.0
    right[row + 5], right[row + 6] = answer.states[k, n, 2], answer.states[k, n, 3]
    # Rows and columns of the size of one.
    K /= (rows_of := np.abs(K).max(axis=1))[:, None]
    K /= (columns_of := np.abs(K).max(axis=0))
    solved = np.linalg.solve(K, right / rows_of) / columns_of
    return solved[: 4 * n + 4].reshape(n + 1, 4), solved[body]


GIVEN = UniformDamping(axial=0.05, normal=8.0, surge=120.0, heave=400.0, pitch=60.0)


@pytest.mark.parametrize("direction", ["axial", "surge", "heave"])
@pytest.mark.parametrize("solver", ["stable", "product"])
def test_the_printed_equations_in_one_full_matrix(table_two: Tow, direction: str, solver: str) -> None:
    """An inclined cable: the shape is that in a current, whose drag on the motion is not asked for."""
    fish = replace(
        table_two.vehicle, added_mass_centre_q=0.1, buoyancy_centre_p=0.03, tow_point_p=0.1, drag_centre_q=0.04
    )
    still = replace(
        table_two,
        cable=replace(table_two.cable, length=400.0, normal_drag_coefficient=0.0, tangential_drag_coefficient=0.0),
        vehicle=fish,
        current=Current.uniform(1.5),
    )
    answer = frequency_response(
        still, [0.3, 1.7], segments=40, direction=direction, solver=solver, damping=GIVEN, companion=False
    )  # type: ignore[call-overload]
    assert abs(math.degrees(answer.shape.phi[0]) - 90.0) > 25.0
    for k in range(2):
        states, body = dense(still, answer, k, GIVEN)
        assert np.all(np.abs(answer.states[k] - states).max(axis=0) < 1e-9 * np.abs(states).max(axis=0))
        assert np.abs(answer.motion[k] - body).max() < 1e-9 * np.abs(body).max()


def slow(tow: Tow, omega: float, drag: str = "consistent", segments: int = 1600) -> Response:
    """Slow horizontal motion of the top, small enough that the drag is linear."""
    return frequency_response(
        tow, [omega], amplitude=1e-3, direction="surge", segments=segments, drag=drag, tolerance=1e-22, companion=False
    )  # type: ignore[call-overload]


def missed(tow: Tow, answer: Response) -> dict[str, float]:
    """The part in phase with the velocity against the derivative of the statics by the tow speed, as shares."""
    step = 2e-3

    def at(change: float) -> np.ndarray:
        shape = static_shape(replace(tow, speed=tow.speed + change), nodes=answer.shape.s)
        return np.vstack([shape.T, shape.phi, np.full(shape.T.shape, shape.pitch)])

    up, down, up2, down2 = (at(change) for change in (step, -step, 2 * step, -2 * step))
    derivative = (8.0 * (up - down) - (up2 - down2)) / (12.0 * step)
    velocity = 1j * answer.omega[0] * answer.amplitude[0]
    ours = np.vstack([answer.tension[0], answer.angle[0], np.full(answer.shape.s.shape, answer.pitch[0])]) / velocity
    apart = np.abs(ours.real - derivative).max(axis=1) / np.abs(derivative).max(axis=1)
    return dict(zip(("tension", "angle", "pitch"), apart.tolist(), strict=True))


def extrapolated(tow: Tow, omega: float) -> Response:
    """Two meshes extrapolated: the trapezoidal rule's own error is second order."""
    fine = slow(tow, omega, segments=3200)
    coarse = frequency_response(
        tow, [omega], amplitude=1e-3, direction="surge", nodes=fine.shape.s[::2], tolerance=1e-22, companion=False
    )
    states = fine.states.copy()
    states[:, ::2] += (fine.states[:, ::2] - coarse.states) / 3.0
    keep = slice(None, None, 2)
    shape = static_shape(tow, nodes=fine.shape.s[keep])
    return replace(fine, states=states[:, keep], motion=fine.motion + (fine.motion - coarse.motion) / 3.0, shape=shape)


@pytest.mark.parametrize("flow", [0.2, 1.0, 2.0])
def test_slow_motion_in_a_current_is_the_derivative_of_the_statics(table_two: Tow, flow: float) -> None:
    tow = replace(table_two, current=Current.uniform(flow))
    assert max(missed(tow, extrapolated(tow, 1e-7)).values()) < 1e-6


def test_slow_motion_in_shear_with_a_soft_compressible_cable_too(table_two: Tow) -> None:
    tow = replace(
        table_two,
        current=Current.from_profile([0.0, 1500.0, 6000.0], [0.9, 0.6, 0.1]),
        cable=replace(table_two.cable, poisson_ratio=0.3, axial_stiffness=2e6, length=1400.0),
    )
    assert max(missed(tow, extrapolated(tow, 1e-7)).values()) < 1e-6


def test_the_printed_form_misses_the_statics_the_more_the_faster(table_two: Tow) -> None:
    wrong = [
        missed(tow, slow(tow, 3e-7, "printed"))["tension"]
        for flow in (0.1, 0.4, 1.0, 2.0)
        for tow in [replace(table_two, current=Current.uniform(flow))]
    ]
    assert all(b > 3.0 * a for a, b in pairwise(wrong))
    assert wrong[0] > 1e-3
    assert wrong[-1] > 1.0


def test_raising_the_top_in_a_sheared_current_is_lowering_the_current(table_two: Tow) -> None:
    depth, speed, step = np.array([0.0, 1500.0, 6000.0]), [0.9, 0.6, 0.1], 0.5
    tow = replace(table_two, current=Current.from_profile(depth, speed), cable=replace(table_two.cable, length=1400.0))
    answer = frequency_response(
        tow, [1e-9], amplitude=1e-3, direction="heave", segments=1600, tolerance=1e-22, companion=False
    )
    up, down = (
        static_shape(replace(tow, current=Current.from_profile(depth + d + 10.0, speed)), nodes=answer.shape.s)
        for d in (step - 10.0, -step - 10.0)
    )
    derivative = (up.T - down.T) / (2.0 * step)
    assert np.abs(answer.tension[0].real / 1e-3 - derivative).max() < 1e-4 * np.abs(derivative).max()


@pytest.mark.parametrize(
    ("area", "decibel", "heave", "tension"), [("diameter", 5.83, 0.85, 1.15), ("circumference", 5.04, 0.81, 1.25)]
)
def test_h_example_one(table_two: Tow, area: str, decibel: float, heave: float, tension: float) -> None:
    """H figure 2 prints 5.25 dB at 0.90 rad/s and a first tension peak at 1.19; physics.md has an axial trial."""
    tow = replace(table_two, cable=replace(table_two.cable, tangential_area=area))
    answer = frequency_response(tow, np.linspace(0.3, 1.5, 241))
    peak = int(np.abs(answer.heave).argmax())
    level = 20.0 * math.log10(abs(answer.heave[peak]))
    assert level == pytest.approx(decibel, abs=0.02)
    assert answer.omega[peak] == pytest.approx(heave, abs=0.01)
    assert answer.omega[np.abs(answer.tension_bottom).argmax()] == pytest.approx(tension, abs=0.01)
    assert abs(level - 5.25) < 0.8
    assert abs(answer.omega[peak] - 0.90) < 0.12
    assert abs(tension / 1.19 - 1.0) < 0.07


def local_peaks(omega: np.ndarray, values: np.ndarray) -> list[float]:
    size = np.abs(values)
    inner = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])) + 1
    return omega[inner].tolist()


def test_h_example_two(configurations: Callable[[str], Tow]) -> None:
    """H prints modes at 0.280 (surge), 0.435 (heave) and 0.550 rad/s, heave at -40 dB at 0.80 rad/s."""
    tow = configurations("s-shape-205-thrust")
    omega = np.linspace(0.15, 0.85, 141)
    answer = frequency_response(replace(tow, current=None), omega, amplitude=0.01)
    surge, heave = local_peaks(omega, answer.surge), local_peaks(omega, answer.heave)
    for found, printed in ((surge, 0.280), (heave, 0.435), (surge, 0.550)):
        assert min(abs(each / printed - 1.0) for each in found) < 0.05
    windy = frequency_response(tow, [0.8])
    assert 20.0 * math.log10(abs(windy.heave[0])) == pytest.approx(-40.0, abs=5.0)


def test_in_a_strong_current_a_sea_is_a_sum_of_small_sinusoids(table_two: Tow) -> None:
    """Where the flow is faster than the motion, drag is linear and both linearisations are the same."""
    tow = replace(table_two, cable=replace(table_two.cable, length=800.0), speed=2.0)
    omega = np.linspace(0.3, 1.6, 27)
    density = bretschneider(omega, 0.02, 0.7)
    sea = sea_response(tow, omega, density, direction="heave", segments=128, companion=False)
    small = frequency_response(
        tow, omega, amplitude=1e-6, direction="heave", nodes=sea.response.shape.s, companion=False
    )
    for name in ("surge", "heave", "pitch", "tension_top", "tension_bottom"):
        square = np.abs(getattr(small, name)) ** 2 / 1e-12
        assert sea.sigma[name] == pytest.approx(math.sqrt(np.trapezoid(square * density, omega)), rel=2e-3)


def test_a_narrow_sea_is_damped_as_a_sinusoid_of_the_same_drag(table_two: Tow) -> None:
    """Of 8/(3 pi) a and sqrt(8/pi) sigma the same drag comes from a = 1.88 sigma; then both move alike."""
    omega = 0.8 + np.linspace(-0.01, 0.01, 41)
    density = np.exp(-0.5 * ((omega - 0.8) / 0.002) ** 2)
    sea = sea_response(table_two, omega, density, segments=128, companion=False)
    amplitude = math.sqrt(8.0 / math.pi) * 3.0 * math.pi / 8.0 * sea.sigma["top"]
    alike = frequency_response(table_two, [0.8], amplitude=amplitude, nodes=sea.response.shape.s, companion=False)
    assert sea.sigma["heave"] / sea.sigma["top"] == pytest.approx(abs(alike.heave[0]) / amplitude, rel=2e-3)


def test_a_compensator_turns_deck_motion_into_top_motion(table_two: Tow) -> None:
    """H (27) with the cable's own tension, drag iterated inside the loop."""
    sprung = Compensator(mass=530.0, stiffness=900.0, damping=2000.0)
    answer = frequency_response(table_two, [0.4, 0.9, 1.3], amplitude=1.5, compensator=sprung)
    omega = answer.omega
    force = answer.tension_top - sprung.mass * omega**2 * answer.top
    assert np.abs(force - (sprung.stiffness + 1j * omega * sprung.damping) * (1.5 - answer.top)).max() < 1e-6
    for k, each in enumerate(omega):
        direct = frequency_response(table_two, [each], amplitude=float(abs(answer.top[k])))
        assert abs(direct.heave[0]) == pytest.approx(abs(answer.heave[k]), rel=2e-3)


def test_a_section_cut_in_two_is_the_same_cable(table_two: Tow) -> None:
    half = replace(table_two.cable, length=2000.0)
    cut = replace(table_two, cable=half, sections=(half,), speed=0.5)
    nodes = np.union1d(np.linspace(0.0, 4000.0, 301), [2000.0])
    whole, parted = (frequency_response(tow, [0.3, 0.9], nodes=nodes) for tow in (replace(table_two, speed=0.5), cut))
    assert np.abs(whole.states - parted.states).max() < 1e-9 * np.abs(whole.states).max()


#: A light inextensible cable, for pendulums.
THREAD = Cable(
    length=10.0,
    diameter=1e-4,
    mass=1e-6,
    weight_in_water=1e-6,
    added_mass=0.0,
    axial_stiffness=1e12,
    normal_drag_coefficient=0.0,
    tangential_drag_coefficient=0.0,
)


def test_the_swinging_of_a_weight_on_a_light_cable() -> None:
    """A pendulum: a light inextensible cable with a point body, moved to and fro at its top."""
    body = Vehicle(weight_in_water=500.0, mass=60.0, added_mass=30.0, area=0.5, drag_coefficient=0.0)
    omega = np.array([0.2, 0.6, 0.9, 2.0])
    answer = frequency_response(Tow(cable=THREAD, vehicle=body), omega, direction="surge", segments=4, companion=False)
    own = 500.0 / (90.0 * 10.0)
    assert answer.horizontal.real == pytest.approx(own / (own - omega**2), rel=1e-5)


def test_quadratic_drag_of_a_swinging_weight() -> None:
    """The same with drag: the amplitude solves the cubic of harmonic balance."""
    body = Vehicle(weight_in_water=500.0, mass=60.0, added_mass=30.0, area=0.5, drag_coefficient=1.0)
    tow, omega = Tow(cable=THREAD, vehicle=body), math.sqrt(500.0 / 900.0)
    answer = frequency_response(tow, [omega], amplitude=0.1, direction="surge", segments=4, companion=False)
    X = abs(answer.horizontal[0])
    drag = body.drag(tow.water_density) * harmonic(omega * X, 0.0)
    assert omega * drag * X == pytest.approx(50.0 * 0.1, rel=1e-4)


def test_digits_of_the_product_are_those_it_has(table_two: Tow) -> None:
    """The count of digits that the sums have left, against what is wrong with the answer."""
    tow = replace(table_two, cable=replace(table_two.cable, length=1000.0), current=Current.uniform(0.5))
    omega = np.array([0.1, 0.2, 0.3])
    told = product_digits(tow, omega, direction="surge", segments=600)
    for k, each in enumerate(omega):
        stable = frequency_response(tow, [each], direction="surge", segments=600, tolerance=1e-24, companion=False)
        nodes = stable.shape.s
        product = frequency_response(
            tow, [each], direction="surge", nodes=nodes, solver="product", tolerance=1e-24, companion=False
        )
        error = np.abs(product.states - stable.states).max(axis=(0, 1)) / np.abs(stable.states).max(axis=(0, 1))
        assert -math.log10(error.max()) == pytest.approx(told[k], abs=1.5)
    assert np.all(np.diff(told) < -1.0)
