"""The stability catalogue: how a case is judged, that cases and tables match, and that the references are theirs."""

import cmath
import math
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.sparse import lil_matrix
from scipy.sparse.linalg import spsolve

from ident.stability import chain_cases, controls, matrix_cases
from ident.stability.case import Case, Expectation, Figure, Finding, Outcome, expectations, judge, pairs
from ident.stability.catalogue import TABLES, catalogue
from models.quantity import InvalidInput, NumericalFailure
from models.statics import SlackCable
from models.towed_system import TowedSystem
from models.vehicle import Towfish, Vehicle

HEADER = "name,model,expected,quantity,reference,unit,allowed,source\n"


def outcome_of(expected: str, run: Callable[[], Finding], *, may_fail: bool = False) -> Outcome:
    """Two figures: 10 m within 2 m and 0 within 1."""
    figures = (
        Figure(quantity="depth", reference=10.0, unit="m", allowed=2.0, source="known"),
        Figure(quantity="error", reference=0.0, unit="-", allowed=1.0, source="known"),
    )
    shown = figures if expected in ("answer", "caught") else ()
    case = Case(name="one", run=run, may_fail=may_fail)
    return judge(case, Expectation(name="one", model="any", expected=expected, figures=shown, source="known"))


def finding(depth: float, error: float = 0.1) -> Callable[[], Finding]:
    return lambda: Finding(figures={"depth": depth, "error": error})


def raising(error: Exception) -> Callable[[], Finding]:
    def run() -> Finding:
        raise error

    return run


@pytest.mark.parametrize(
    ("depth", "error", "margin"), [(10.0, 0.1, 0.9), (11.0, 0.1, 0.5), (9.0, 0.7, 0.3), (13.0, 0.1, -0.5)]
)
def test_the_margin_is_that_of_the_worst_figure(depth: float, error: float, margin: float) -> None:
    outcome = outcome_of("answer", finding(depth, error))
    assert outcome.margin == pytest.approx(margin)
    assert outcome.passed == (margin > 0.0)
    assert outcome.seconds >= 0.0


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_a_figure_that_is_no_number_fails(wrong: float) -> None:
    outcome = outcome_of("answer", finding(wrong))
    assert not outcome.passed
    assert outcome.margin == -math.inf


@pytest.mark.parametrize("expected", ["answer", "caught"])
def test_a_figure_that_is_missing_fails(expected: str) -> None:
    outcome = outcome_of(expected, lambda: Finding(figures={"depth": 50.0}))
    assert not outcome.passed
    assert "error" in outcome.text


def test_an_error_must_be_the_one_that_is_named() -> None:
    assert outcome_of("SlackCable", raising(SlackCable("slack"))).passed
    # A more general error, or one of another kind, is not it.
    for error in (NumericalFailure("other"), InvalidInput("other"), ZeroDivisionError("other")):
        assert not outcome_of("SlackCable", raising(error)).passed
    assert not outcome_of("SlackCable", finding(10.0)).passed
    assert not outcome_of("answer", raising(NumericalFailure("none"))).passed
    assert outcome_of("answer", raising(ZeroDivisionError("none"))).ended == "crash"


def test_a_control_passes_where_its_figures_are_off() -> None:
    caught = outcome_of("caught", finding(18.0))
    assert caught.passed
    assert caught.margin == pytest.approx(0.75)
    assert outcome_of("caught", finding(math.nan)).margin == 1.0
    assert not outcome_of("caught", finding(11.9)).passed
    assert outcome_of("caught", raising(NumericalFailure("out of bounds")), may_fail=True).passed
    # A simulator that is broken, or input that is refused, shows nothing of the fault.
    assert not outcome_of("caught", raising(NumericalFailure("out of bounds"))).passed
    assert not outcome_of("caught", raising(InvalidInput("no such tow")), may_fail=True).passed


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("a,m,answer,depth,x,m,1,s\n", "must be numbers"),
        ("a,m,answer,depth,1,m,0,s\n", "above 0"),
        ("a,m,answer,,1,m,1,s\n", "needs a quantity"),
        ("a,m,answer,depth,1,m,1,s\na,m,caught,trail,1,m,1,s\n", "another model or outcome"),
        ("a,m,InvalidInput,,,,,s\na,m,InvalidInput,,,,,s\n", "no second row"),
    ],
)
def test_a_table_with_a_wrong_row_is_refused(tmp_path: Path, rows: str, said: str) -> None:
    (tmp_path / "expected.csv").write_text(HEADER + rows)
    with pytest.raises(InvalidInput, match=said):
        expectations(tmp_path / "expected.csv")


def test_a_table_with_other_columns_is_refused(tmp_path: Path) -> None:
    (tmp_path / "expected.csv").write_text("name,expected\na,answer\n")
    with pytest.raises(InvalidInput, match="needs the columns"):
        expectations(tmp_path / "expected.csv")


def test_cases_and_rows_must_match(tmp_path: Path) -> None:
    (tmp_path / "expected.csv").write_text(HEADER + "a,m,answer,depth,1,m,1,s\n")
    table = expectations(tmp_path / "expected.csv")
    one, other = Case(name="a", run=finding(1.0)), Case(name="b", run=finding(1.0))
    assert [case.name for case, _ in pairs([one], table)] == ["a"]
    for cases, said in (([one, one], "There twice: a"), ([one, other], "Not in a table: b"), ([], "never run: a")):
        with pytest.raises(InvalidInput, match=said):
            pairs(cases, table)


def test_the_catalogue_has_a_row_for_every_case() -> None:
    whole, reduced = catalogue(), catalogue(reduced=True)
    assert {case.name for case, _ in reduced} < {case.name for case, _ in whole}
    assert sum(row.expected == "caught" for _, row in whole) >= 5
    assert {case.name for case, _ in catalogue(("chain-links",))} == {
        "chain-links-5000",
        *(f"chain-links-{n}" for n in (4, 8, 16, 32, 64)),
    }
    with pytest.raises(InvalidInput, match='begins with "nothing"'):
        catalogue(("nothing",))


def test_a_control_is_held_to_the_figures_of_its_twin() -> None:
    table = expectations(*TABLES)
    for case in controls.CASES:
        row = table[case.name]
        if not row.source.startswith("as "):
            continue
        twin = table[row.source.removeprefix("as ")]
        asked = {figure.quantity: (figure.reference, figure.allowed) for figure in twin.figures}
        assert row.figures
        for figure in row.figures:
            assert asked[figure.quantity] == (figure.reference, figure.allowed)
    # Both plain schemes are held to the same, within and beyond their limits.
    plain = [table[name].figures for name in ("control-naive-scheme", "twin-naive-scheme", "twin-explicit-scheme")]
    assert plain[0] == plain[1] == plain[2] == table["control-step-past-the-limit"].figures


def holds(name: str, found: dict[str, float], share: float = 2e-3) -> None:
    """Every figure found is the table's, to a small share of what is allowed."""
    asked = {figure.quantity: figure for figure in expectations(*TABLES)[name].figures}
    for quantity, value in found.items():
        assert abs(value - asked[quantity].reference) < share * asked[quantity].allowed, (quantity, value)


def steady(continuum: ModuleType, system: TowedSystem, speed: float) -> dict[str, float]:
    velocity = np.array([speed, 0.0, 0.0])
    if system.current is None:
        nothing = np.zeros(3)
        (line,) = continuum.climb(system, nothing, lambda _: nothing, lambda _: velocity, lambda _: nothing)
    else:
        (line,) = continuum.straight_tow(system, velocity)
    behind = line.upper - line.lower
    return {"trail": float(behind[0]), "depth": float(behind[2]), "tension_top": line.tension[0]}


@pytest.mark.parametrize("name", sorted(chain_cases.TOWED))
def test_references_of_steady_tows_are_the_continuum(continuum: ModuleType, name: str) -> None:
    scene = chain_cases.TOWED[name]()
    holds(name, steady(continuum, scene.last_system, scene.last_speed))


def test_references_of_the_plain_chain_are_the_continuum(continuum: ModuleType) -> None:
    holds("twin-explicit-scheme", steady(continuum, controls.soft_system(), 1.0))


def test_references_of_the_circle_are_the_continuum(continuum: ModuleType) -> None:
    scene = chain_cases.CIRCLED["chain-full-turn-50"]()
    (circle,) = continuum.circular_tows(scene.system, scene.radius, scene.speed)
    holds(
        "chain-full-turn-50",
        {
            "radius": float(circle.radius[0]),
            "depth": float(circle.depth[0]),
            "tension_top": circle.lines[0].tension[0],
        },
    )


@pytest.mark.parametrize("name", ["chain-drag-zero", "chain-vehicle-massless", "chain-vehicle-mass-hundredfold"])
def test_references_of_the_swinging_are_bessel(continuum: ModuleType, name: str) -> None:
    scene = chain_cases.SWUNG[name]()
    part = scene.system.parts[0]
    assert part.body is not None
    mass = part.body.mass + part.body.added_mass_surge
    found = continuum.hanging_frequencies(part.cable, part.body.weight_in_water, mass, len(scene.near))
    holds(name, {f"omega_{i}": each for i, each in enumerate(found, start=1)})


def test_references_of_rubber_and_of_the_jerk_are_closed_forms() -> None:
    part = chain_cases.SWUNG["chain-rubber-bounce"]().system.parts[0]
    assert part.body is not None
    cable, mass = part.cable, part.body.mass + part.body.added_mass_heave
    b = brentq(lambda b: b * math.tan(b) - cable.mass * cable.length / mass, 1e-6, 1.57)
    holds("chain-rubber-bounce", {"omega_1": b / cable.length * math.sqrt(cable.axial_stiffness / cable.mass)})
    steel = chain_cases.mangus().parts[0].cable
    holds("chain-jerk", {"lowest_jump": 0.3 * math.sqrt(steel.axial_stiffness * steel.mass)})
    hung = 6000.0 + steel.weight_in_water * 740.0
    stretch = 740.0 * 0.5 * (6000.0 + hung) / steel.axial_stiffness
    holds("chain-speed-0", {"depth": 740.0 + stretch, "tension_top": hung})


@pytest.mark.parametrize("name", sorted(matrix_cases.BARS))
def test_references_of_bars_and_strings(name: str) -> None:
    """H (31)-(33) without drag, and (T q'/(1 + e))' = -(m + m_a) omega^2 q."""
    scene = matrix_cases.BARS[name]()
    cable, body, omega = scene.tow.cable, scene.tow.vehicle, scene.omega
    assert isinstance(body, Vehicle)
    m, EA, L, w = cable.mass, cable.axial_stiffness, cable.length, cable.weight_in_water
    mass, kappa = body.mass + body.added_mass, omega * math.sqrt(m / EA)
    end = mass * omega**2 / EA
    below = math.cos(kappa * L) - end / kappa * math.sin(kappa * L)

    def rates(s: float, y: np.ndarray) -> list[float]:
        T = body.weight_in_water + w * s
        return [(1.0 + T / EA) * y[1] / T, -(m + cable.added_mass) * omega**2 * y[0]]

    up = solve_ivp(rates, (0.0, L), [1.0, -mass * omega**2], method="DOP853", rtol=1e-10, atol=1e-8).y[0, -1]
    holds(
        name,
        {
            "along": abs(1.0 / below),
            "tension_top": abs(EA * (kappa * math.sin(kappa * L) + end * math.cos(kappa * L)) / below),
            "across": abs(1.0 / up),
        },
    )


@pytest.mark.parametrize("name", ["matrix-damped-waves", "matrix-overflow"])
def test_references_of_damped_waves(name: str) -> None:
    scene = matrix_cases.DAMPED[name]()
    cable, body, omega = scene.tow.cable, scene.tow.vehicle, scene.omega
    assert isinstance(body, Vehicle)
    T = body.weight_in_water
    stretch = 1.0 + T / cable.axial_stiffness
    g = cmath.sqrt((-(cable.mass + cable.added_mass) * omega**2 + 1j * omega * scene.normal) / T * stretch)
    b = -stretch * (body.mass + body.added_mass) * omega**2 / T
    found = {"angle_top": abs(g) / stretch}
    if name == "matrix-damped-waves":
        found["decades"] = -(g.real * cable.length / math.log(10.0) + math.log10(abs(0.5 * (1.0 + b / g))))
    holds(name, found)


@pytest.mark.parametrize(("name", "net"), [("matrix-weight-zero", 0.0), ("matrix-slightly-buoyant", -200.0)])
def test_references_of_slow_motion_are_differences_of_the_continuum(
    continuum: ModuleType, name: str, net: float
) -> None:
    system = TowedSystem.from_tow(matrix_cases.light_body(net))
    still = TowedSystem(parts=system.parts, water_density=system.water_density)
    step = 4e-3
    up, up2, down, down2 = (
        steady(continuum, still, change * step - 0.5)["tension_top"] for change in (1.0, 2.0, -1.0, -2.0)
    )
    slope = (8.0 * (up - down) - (up2 - down2)) / (12.0 * step)
    at = steady(continuum, still, -0.5)
    holds(name, {"depth": at["depth"], "tension_top": at["tension_top"], "tension_per_speed": slope})


def test_reference_of_the_inclined_cable_is_one_band_matrix() -> None:
    """The four equations of physics.md section 5 by the trapezoidal rule, about a shape integrated here."""
    scene = matrix_cases.INCLINED
    tow, omega, n = scene.tow, scene.omega, 2000
    cable, body, rho, flow = tow.cable, tow.vehicle, tow.water_density, 0.5
    assert isinstance(body, Vehicle)
    k_n, k_t, w, EA = cable.normal_drag(rho), cable.tangential_drag(rho), cable.weight_in_water, cable.axial_stiffness
    grown = lambda T: (1.0 + T / EA) * (1.0 - cable.poisson_ratio * T / EA)  # noqa: E731

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        t = y / np.hypot(*y)
        along, across = flow * t[0], -flow * t[1]
        drag = k_n * abs(across) * across * np.array([-t[1], t[0]]) + k_t * abs(along) * along * t
        return np.array([0.0, w]) - grown(np.hypot(*y)) * drag

    s = np.linspace(0.0, cable.length, n + 1)
    start = [-body.drag(rho) * flow**2, body.weight_in_water]
    y = solve_ivp(rates, (0.0, cable.length), start, t_eval=s, method="DOP853", rtol=1e-11, atol=1e-8).y
    T, phi = np.hypot(*y), np.arctan2(y[1], y[0])
    bend = (w * np.cos(phi) + k_n * grown(T) * (flow * np.sin(phi)) ** 2) / T
    # T~ in tens of kilonewtons, so that the entries are of one size.
    unit, mass = 1e4, body.mass + body.added_mass
    A = np.zeros((n + 1, 4, 4), dtype=complex)
    A[:, 0, 1], A[:, 0, 2] = w * np.cos(phi) / unit, -cable.mass * omega**2 / unit
    A[:, 1, 0], A[:, 1, 1] = -bend / T * unit, -w * np.sin(phi) / T
    A[:, 1, 3] = (-(cable.mass + cable.added_mass) * omega**2 + 1j * omega * scene.normal) / T
    A[:, 2, 0], A[:, 2, 3], A[:, 3, 1], A[:, 3, 2] = unit / EA, bend, 1.0 + T / EA, -bend
    half, size = 0.5 * cable.length / n, 4 * (n + 1)
    K, right = lil_matrix((size, size), dtype=complex), np.zeros(size, dtype=complex)
    for i in range(n):
        K[4 * i : 4 * i + 4, 4 * i : 4 * i + 4] = -np.eye(4) - half * A[i]
        K[4 * i : 4 * i + 4, 4 * i + 4 : 4 * i + 8] = np.eye(4) - half * A[i + 1]
    K[size - 4, 0], K[size - 4, 2] = 1.0, mass * omega**2 / unit
    K[size - 3, 1], K[size - 3, 3] = T[0] / unit, mass * omega**2 / unit
    K[size - 2, size - 2], K[size - 1, size - 1] = 1.0, 1.0
    right[size - 2 :] = [math.cos(phi[-1]), -math.sin(phi[-1])]
    state = spsolve(K.tocsc(), right).reshape(n + 1, 4)
    across = state[0, 2] * math.cos(phi[0]) - state[0, 3] * math.sin(phi[0])
    found = {"tension_top": abs(unit * state[-1, 0]), "angle_top": abs(state[-1, 1]), "across": abs(across)}
    holds("matrix-inclined", found)
    assert all(value > 0.0 for value in found.values())


def test_references_of_the_pendulum_and_of_the_upended_towfish() -> None:
    """Harmonic balance; surge and pitch of H (21)-(23) with the axes of the body renamed."""
    k, omega = 0.5 * 1025.0 * 10.0 * 0.5, math.sqrt(500.0 / 900.0)
    holds("matrix-drag-tenfold", {"swing": math.sqrt(50.0 * 0.1 / (omega**2 * 8.0 / (3.0 * math.pi) * k))})
    tow = matrix_cases.upended_tow()
    fish, omega = tow.vehicle, 0.8
    assert isinstance(fish, Towfish)
    T, lever = fish.weight_in_water, fish.tow_point_p
    pull = T / (tow.cable.length * (1.0 + T / tow.cable.axial_stiffness))
    righting = fish.buoyancy * fish.buoyancy_centre_p + T * lever
    motion = np.linalg.solve(
        [
            [pull - (fish.mass + fish.added_mass_q) * omega**2, -pull * lever],
            [-pull * lever, pull * lever**2 + righting - fish.inertia * omega**2],
        ],
        pull * 0.01 * np.array([1.0, -lever]),
    )
    holds("matrix-pitch-90", {"across": abs(motion[0]), "swing": abs(motion[1])}, share=1e-2)
