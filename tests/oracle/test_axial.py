"""The closed forms of the axial motion against springs and masses, a boundary value solver, the matrix and limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_bvp, trapezoid
from scipy.optimize import brentq

from models.quantity import InvalidInput, NumericalFailure
from models.tow import Tow
from models.transfer_matrix import Compensator, UniformDamping, frequency_response
from models.transfer_matrix.axial import AxialString, axial_response, compensated_response

Floats = NDArray[np.float64]
OMEGA = np.array([0.05, 0.3, 0.55, 0.9, 1.19, 2.0, 4.0])
NAMES = ("bottom", "tension_bottom", "tension_top")
MASS, STIFFNESS, DAMPING = 530.0, 2500.0, 900.0


@pytest.fixture
def string(table_two: Tow) -> AxialString:
    return AxialString.from_tow(table_two, velocity=1.4)


def chain(string: AxialString, omega: float, links: int, compensator: bool) -> Floats:
    """p_1, T_1, T_n, p_n, R of n springs and dashpots between n + 1 masses, by a dense solve.

    The top is moved by one metre, or the vessel is and a compensator lies between the two. Masses and dampings at
    the ends are half of those inside, so that the error falls with the square of the links' length.
    """
    h = string.length / links
    lumps = np.full(links + 1, h)
    lumps[[0, -1]] = 0.5 * h
    dynamic = np.diag((-string.mass * omega**2 + 1j * omega * string.damping) * lumps)
    spring = string.axial_stiffness * (1.0 + 1j * omega * string.loss_time) / h
    for i in range(links):
        dynamic[i : i + 2, i : i + 2] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
    dynamic[0, 0] += -string.end_mass * omega**2 + 1j * omega * string.end_damping
    cable = dynamic.copy()
    forced = np.zeros(links + 1, dtype=complex)
    held = STIFFNESS + 1j * omega * DAMPING
    if compensator:
        dynamic[-1, -1] += held - omega**2 * MASS
        forced[-1] = held
    else:
        dynamic[-1] = 0.0
        dynamic[-1, -1] = forced[-1] = 1.0
    p = np.linalg.solve(dynamic, forced)
    end = (-string.end_mass * omega**2 + 1j * omega * string.end_damping) * p[0]
    return np.array([p[0], end, cable[-1] @ p, p[-1], p[-1] - 1.0])


def extrapolated(string: AxialString, omega: float, compensator: bool) -> Floats:
    """The chain's limit from 60, 120 and 240 links."""
    a, b, c = (chain(string, omega, links, compensator) for links in (60, 120, 240))
    first, second = (4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0
    return np.asarray((16.0 * second - first) / 15.0)


@pytest.mark.parametrize("loss", [0.0, 0.05])
def test_the_closed_forms_are_the_limit_of_a_chain_of_springs_and_masses(string: AxialString, loss: float) -> None:
    string = replace(string, loss_time=loss)
    response = axial_response(string, OMEGA)
    ours = np.array([getattr(response, name) for name in NAMES])
    theirs = np.array([extrapolated(string, omega, False)[:3] for omega in OMEGA]).T
    assert np.abs(ours / theirs - 1.0).max() < 1e-7


def test_a_compensator_in_the_loop_is_one_between_the_chain_and_the_vessel(string: AxialString) -> None:
    made = compensated_response(axial_response(string, OMEGA), MASS, STIFFNESS, DAMPING)
    ours = np.array([made.bottom, made.tension_bottom, made.tension_top, made.top, made.relative])
    theirs = np.array([extrapolated(string, omega, True) for omega in OMEGA]).T
    assert np.abs(ours / theirs - 1.0).max() < 1e-7


def test_the_closed_forms_solve_the_boundary_value_problem(string: AxialString) -> None:
    """Over x = s/L, real and imaginary parts apart: p, p' as (4,)."""
    omega, EA, L = 0.9, string.axial_stiffness, string.length
    square = L**2 * (-string.mass * omega**2 + 1j * omega * string.damping) / EA
    end = L * (-string.end_mass * omega**2 + 1j * omega * string.end_damping) / EA

    def rates(_: Floats, y: Floats) -> Floats:
        bent = square * (y[0] + 1j * y[1])
        return np.array([y[2], y[3], bent.real, bent.imag])

    def ends(low: Floats, high: Floats) -> Floats:
        pulled = low[2] + 1j * low[3] - end * (low[0] + 1j * low[1])
        return np.array([pulled.real, pulled.imag, high[0] - 1.0, high[1]])

    x = np.linspace(0.0, 1.0, 100)
    found = solve_bvp(rates, ends, x, np.zeros((4, x.size)), tol=1e-9, max_nodes=20_000)
    assert found.success
    p = found.y[:2].T @ [1.0, 1j]
    T = EA / L * (found.y[2:].T @ [1.0, 1j])
    response = axial_response(string, omega)
    assert response.bottom[0] == pytest.approx(p[0], rel=1e-7)
    assert response.tension_bottom[0] == pytest.approx(T[0], rel=1e-7)
    assert response.tension_top[0] == pytest.approx(T[-1], rel=1e-7)


def test_the_matrix_solve_with_uniform_damping_comes_to_the_closed_forms(string: AxialString, table_two: Tow) -> None:
    """Of a hanging cable and an upright towfish: its heave makes it pitch, but the pitch does not act on the heave."""
    damping = UniformDamping(axial=string.damping, normal=30.0, surge=200.0, heave=string.end_damping, pitch=50.0)
    closed = axial_response(string, OMEGA[:-1])

    def worst(segments: int) -> float:
        nodes = np.linspace(0.0, string.length, segments + 1)
        made = frequency_response(table_two, OMEGA[:-1], nodes=nodes, damping=damping, companion=False)
        ratios = (
            made.axial[:, 0] / closed.bottom,
            made.heave / closed.bottom,
            made.tension_bottom / closed.tension_bottom,
            made.tension_top / closed.tension_top,
        )
        return float(max(np.abs(ratio - 1.0).max() for ratio in ratios))

    fine = worst(4000)
    assert fine < 1e-6
    assert math.log2(worst(2000) / fine) == pytest.approx(2.0, abs=0.02)


def test_the_matrix_solve_has_the_compensator_of_the_closed_form(string: AxialString, table_two: Tow) -> None:
    damping = UniformDamping(axial=string.damping, heave=string.end_damping)
    device = Compensator(mass=MASS, stiffness=STIFFNESS, damping=DAMPING)
    nodes = np.linspace(0.0, string.length, 4001)
    omega = OMEGA[:-1]
    made = frequency_response(
        table_two, omega, amplitude=2.0, nodes=nodes, damping=damping, compensator=device, companion=False
    )
    closed = compensated_response(axial_response(string, omega), MASS, STIFFNESS, DAMPING)
    assert np.abs(made.top / (2.0 * closed.top) - 1.0).max() < 1e-6
    assert np.abs(made.heave / (2.0 * closed.bottom) - 1.0).max() < 1e-6
    assert np.abs(made.tension_top / (2.0 * closed.tension_top) - 1.0).max() < 1e-6


def test_exchanged_labels_as_printed_are_refused_by_the_weight_of_the_cable(string: AxialString) -> None:
    """At low frequency the top carries body and cable, the bottom the body alone; the print has it the other way."""
    omega = 1e-3
    response = axial_response(replace(string, damping=0.0, end_damping=0.0), omega)
    body, cable = string.end_mass, string.mass * string.length
    assert response.tension_bottom[0] == pytest.approx(-body * omega**2, rel=1e-4)
    assert response.tension_top[0] == pytest.approx(-(body + cable) * omega**2, rel=1e-4)
    assert response.bottom[0] == pytest.approx(1.0, rel=1e-4)


def test_work_at_the_top_is_what_the_dampers_take(string: AxialString) -> None:
    """Mean power put in at the top, Re(T_n (i omega p_n)*)/2, against the dissipation integrated along the cable."""
    for omega in OMEGA:
        response = axial_response(string, omega)
        gamma = np.sqrt((-string.mass * omega**2 + 1j * omega * string.damping) / string.axial_stiffness)
        end = (-string.end_mass * omega**2 + 1j * omega * string.end_damping) / string.axial_stiffness
        s = np.linspace(0.0, string.length, 20_001)
        p = response.bottom[0] * (np.cosh(gamma * s) + end / gamma * np.sinh(gamma * s))
        assert p[-1] == pytest.approx(1.0)
        given = 0.5 * omega * response.tension_top[0].imag
        along = 0.5 * omega**2 * string.damping * trapezoid(np.abs(p) ** 2, s)
        assert given == pytest.approx(along + 0.5 * omega**2 * string.end_damping * abs(p[0]) ** 2, rel=1e-6)


def test_undamped_resonances_lie_where_the_mass_and_the_string_balance(string: AxialString) -> None:
    """k = M omega^2/EA tan(k L) with k = omega sqrt(m/EA), the fixed-top modes of a rod with an end mass."""
    bare = replace(string, damping=0.0, end_damping=1e-3)
    wave = math.sqrt(bare.mass / bare.axial_stiffness)

    def balance(omega: float) -> float:
        k = omega * wave
        return k * math.cos(k * bare.length) - bare.end_mass * omega**2 / bare.axial_stiffness * math.sin(
            k * bare.length
        )

    mode = brentq(balance, 0.2, 2.0, xtol=1e-12)
    near = np.abs(axial_response(bare, mode + np.array([-0.01, 0.0, 0.01])).bottom)
    assert near[1] > 1000.0 * near[0]
    assert near[1] > 1000.0 * near[2]


def test_a_long_damped_cable_lets_nothing_through_and_overflows_nowhere(string: AxialString) -> None:
    long = replace(string, length=4e8, damping=50.0)
    response = axial_response(long, 1.0)
    assert abs(response.bottom[0]) == 0.0
    gamma = np.sqrt((-long.mass + 50.0j) / long.axial_stiffness)
    assert response.tension_top[0] == pytest.approx(long.axial_stiffness * gamma, rel=1e-12)


def test_the_drag_is_linearised_once_for_cable_and_body(table_two: Tow) -> None:
    string = AxialString.from_tow(table_two, velocity=2.0)
    factor = 8.0 / (3.0 * math.pi) * 2.0 * 0.5 * 1025.0
    assert string.damping == pytest.approx(factor * 0.0173 * 0.01)
    assert string.end_damping == pytest.approx(factor * 2.0 * 1.0)
    assert string.end_mass == 900.0
    around = replace(table_two, cable=replace(table_two.cable, tangential_area="circumference"))
    assert AxialString.from_tow(around, velocity=2.0).damping == pytest.approx(math.pi * string.damping)


def test_a_point_vehicle_has_one_mass_and_drag(configurations: object) -> None:
    tow = configurations("mangus-740")  # type: ignore[operator]
    string = AxialString.from_tow(tow, velocity=0.5)
    assert string.end_mass == 760.0 + 545.0
    assert string.end_damping == pytest.approx(8.0 / (3.0 * math.pi) * 0.5 * 0.5 * 1025.0 * 1.6 * 0.52)


def test_what_the_closed_form_cannot_do_is_refused(string: AxialString, table_two: Tow) -> None:
    with pytest.raises(InvalidInput, match=r"omega\[1\] = 0 rad/s"):
        axial_response(string, [0.5, 0.0])
    with pytest.raises(InvalidInput, match=r"omega\[0\] = nan rad/s"):
        axial_response(string, math.nan)
    with pytest.raises(InvalidInput, match=r"shape \(0,\)"):
        axial_response(string, [])
    with pytest.raises(InvalidInput, match="at least 0 m/s, but it is -1 m/s"):
        AxialString.from_tow(table_two, velocity=-1.0)
    two = replace(table_two, sections=(replace(table_two.cable, length=100.0),))
    with pytest.raises(InvalidInput, match="one uniform cable"):
        AxialString.from_tow(two, velocity=1.0)
    free = AxialString(length=math.pi, mass=1.0, axial_stiffness=1.0)
    assert abs(axial_response(free, 0.5 + 1e-9).bottom[0]) > 1e8
    with pytest.raises(NumericalFailure, match=r"without any damping at omega = 0.5 rad/s"):
        axial_response(free, [0.4, 0.5])  # a quarter wave
