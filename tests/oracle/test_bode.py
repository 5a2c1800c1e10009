"""Frequency responses against the undamped hanging chain, another simulator, and python-control."""

import cmath
import math

import control
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ident.configuration import load
from ident.linear import to_state_space
from ident.studies import bode
from models import link_joint, reduced
from models.statics import static_shape
from models.tow import Tow
from models.towed_system import TowedSystem
from models.trace import Trace

TOWS = ("mangus-740", "autec-1200")


def undamped_gain(tow: Tow, omega: float) -> float:
    """A chain under tension W + w s with a mass at its end: (T q')' + omega^2 m q = 0, T q' = -omega^2 M at s = 0."""
    cable, body = tow.cable, tow.vehicle
    m, M = cable.mass + cable.added_mass, body.mass + body.added_mass

    def rate(s: float, y: np.ndarray) -> list[float]:
        return [y[1] / (body.weight_in_water + cable.weight_in_water * s), -(omega**2) * m * y[0]]

    found = solve_ivp(rate, (0.0, cable.length), [1.0, -(omega**2) * M], rtol=1e-9, atol=1e-12)
    return 1.0 / float(found.y[0, -1])


@pytest.mark.parametrize("name", TOWS)
@pytest.mark.parametrize(("omega", "resonance"), [(0.01, 1.01), (0.03, 1.14)])
def test_small_motion_is_that_of_the_undamped_hanging_chain(name: str, omega: float, resonance: float) -> None:
    tow = load(name).tow
    gain, phase = bode.reference_response(tow, 1e-3, omega)
    assert gain == pytest.approx(undamped_gain(tow, omega), rel=5e-3)
    assert gain > resonance
    assert abs(phase) < 0.01


@pytest.mark.parametrize("name", TOWS)
def test_slow_motion_is_followed(name: str) -> None:
    gain, phase = bode.reference_response(load(name).tow, 25.0, 2e-4)
    assert gain == pytest.approx(1.0, abs=1e-4)
    assert -1e-3 < phase < 0.0


def chain_response(tow: Tow, amplitude: float, omega: float) -> complex:
    """The fundamental of the link-joint chain's vehicle, by the Fourier integral over one late period."""
    period = 2.0 * math.pi / omega
    t = np.linspace(0.0, 8.0 * period, 8 * 60 + 1)
    ease = -np.expm1(-((t / period) ** 3))
    ship = Trace.along_x(t, amplitude * ease * np.sin(omega * t))
    run = link_joint.simulate(TowedSystem.from_tow(tow), ship, links=40, tolerance=1e-4, companion=False).vehicle
    last = slice(7 * 60, 8 * 60)
    return complex(2j * np.mean(run.position[last, 0] * np.exp(-1j * omega * t[last])) / amplitude)


@pytest.mark.parametrize("name", TOWS)
@pytest.mark.parametrize(("amplitude", "omega"), [(25.0, 0.012), (50.0, 0.02), (25.0, 0.035)])
def test_reference_response_is_the_chains(name: str, amplitude: float, omega: float) -> None:
    tow = load(name).tow
    gain, phase = bode.reference_response(tow, amplitude, omega)
    other = chain_response(tow, amplitude, omega)
    assert gain == pytest.approx(abs(other), rel=1e-2)
    assert math.remainder(phase - cmath.phase(other), 2.0 * math.pi) == pytest.approx(0.0, abs=0.01)
    assert abs(other) < 0.9


def test_points_come_sorted_with_a_continuous_phase() -> None:
    table, missing = bode.reference_points(load("autec-1200").tow, (25.0, 50.0), (0.09, 0.004, 0.02, 0.06))
    assert missing == []
    assert list(table.columns) == ["amplitude_m", "omega_rad_s", "gain_db", "phase_deg"]
    for amplitude, part in table.groupby("amplitude_m"):
        assert amplitude in (25.0, 50.0)
        assert part["omega_rad_s"].tolist() == [0.004, 0.02, 0.06, 0.09]
        assert (np.diff(part["gain_db"]) < 0.0).all()
        assert (np.diff(part["phase_deg"]) < 0.0).all()
        assert part["phase_deg"].iloc[-1] < -180.0


@pytest.mark.parametrize(
    "name", ["second-order-linear", "first-order-linear", "inertial-4-linear", "massless-3-linear"]
)
def test_linear_curves_are_those_of_python_control(name: str) -> None:
    tow = load("autec-1200").tow
    model = reduced.section(name, tow, static_shape(tow))
    table = bode.reduced_curves([model], (25.0, 50.0), (0.002, 0.06))
    omega = table["omega_rad_s"].to_numpy()
    assert omega[[0, -1]] == pytest.approx([0.002, 0.06])
    assert table["amplitude_m"].isna().all()
    linear = reduced.linearise(model)
    system = to_state_space(linear, pade_order=0)
    expected = control.frequency_response(system, omega, squeeze=True)
    phase = np.unwrap(np.asarray(expected.phase)) - omega * linear.delay
    np.testing.assert_allclose(table["gain_db"], 20.0 * np.log10(np.asarray(expected.magnitude)), atol=1e-9)
    np.testing.assert_allclose(table["phase_deg"], np.degrees(phase), atol=1e-7)


def test_quadratic_curves_depend_on_the_amplitude_and_meet_the_chain() -> None:
    """Harmonic balance against the time domain: the describing function lacks the third harmonic, a few percent."""
    tow = load("autec-1200").tow
    model = reduced.section("inertial-32-quadratic", tow, static_shape(tow))
    table = bode.reduced_curves([model], (25.0, 50.0), (0.012, 0.03))
    assert table.groupby("amplitude_m").size().tolist() == [60, 60]
    small, large = (part.set_index("omega_rad_s") for _, part in table.groupby("amplitude_m"))
    assert (small["gain_db"] > large["gain_db"]).all()
    other = chain_response(tow, 25.0, 0.012)
    assert small["gain_db"].iloc[0] == pytest.approx(20.0 * math.log10(abs(other)), abs=0.2)
    assert small["phase_deg"].iloc[0] == pytest.approx(math.degrees(cmath.phase(other)), abs=4.0)


def test_no_models_give_an_empty_table_with_its_columns() -> None:
    table = bode.reduced_curves([], (25.0,), (0.01, 0.02))
    assert list(table.columns) == ["model", "amplitude_m", "omega_rad_s", "gain_db", "phase_deg"]
    assert table.empty
