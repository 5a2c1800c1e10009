"""RAOs: interpolation, what the built-in vessel gives, and what is refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from data_synth.rao import Rao, read_rao
from data_synth.spectra import SEA_STATES, SeaState, Spectrum
from models import response_statistics
from models.quantity import InvalidInput

SWATH = Path(__file__).parents[2] / "ident" / "vessels" / "swath.csv"


@pytest.mark.parametrize(("number", "significant", "low", "high"), [(6, 5.25, 0.54, 0.56), (5, 2.99, 0.60, 0.61)])
def test_the_built_in_vessel_heaves_as_printed(number: int, significant: float, low: float, high: float) -> None:
    vessel, sea = read_rao(SWATH), SEA_STATES[number].spectrum(points=4000)
    vessel.check(sea)
    heave = np.abs(vessel.motion(sea.omega)[:, 1]) ** 2 * sea.density
    spectrum = Spectrum(omega=sea.omega, density=heave)
    assert response_statistics.significant(spectrum.sigma) == pytest.approx(significant, rel=1e-3)
    assert low <= spectrum.peak <= high
    # The 200 points of a study are enough for it.
    coarse = SEA_STATES[number].spectrum()
    again = np.abs(vessel.motion(coarse.omega)[:, 1]) ** 2 * coarse.density
    assert Spectrum(omega=coarse.omega, density=again).sigma == pytest.approx(spectrum.sigma, rel=1e-4)


def test_the_built_in_vessel_is_the_formula_of_its_comment() -> None:
    vessel = read_rao(SWATH)
    r = vessel.omega / 0.6424
    spring = 1.0 + 2j * 0.4995 * r
    motion = np.exp(-(vessel.omega**2) * 5.090 / 9.80665) * spring / (spring - r**2)
    assert np.allclose(vessel.motion(vessel.omega)[:, 1], motion, atol=1e-4)
    assert not vessel.surges
    assert SWATH.read_text().startswith("# Heave of a SWATH vessel")


def test_amplitude_and_phase_are_interpolated() -> None:
    vessel = Rao(
        omega=[0.5, 1.0, 2.0],
        heave=[1.0, 0.5, 0.1],
        heave_phase=[0.0, -1.0, -3.0],
        surge=[0.4, 0.2, 0.0],
        surge_phase=[1.5, 1.5, 1.5],
    )
    horizontal, vertical = vessel.motion([0.75])[0]
    assert vertical == pytest.approx(0.75 * np.exp(-0.5j))
    assert horizontal == pytest.approx(0.3 * np.exp(1.5j))
    assert not vessel.motion([0.4, 2.1]).any()
    assert vessel.surges


def test_a_phase_takes_the_shorter_way_round() -> None:
    vessel = Rao(omega=[0.5, 1.0], heave=[1.0, 1.0], heave_phase=[3.0, -3.0])
    assert vessel.motion([0.75])[0, 1] == pytest.approx(-1.0)


def test_optional_columns(tmp_path: Path) -> None:
    path = tmp_path / "vessel.csv"
    path.write_text("# ours\nomega_rad_s,surge_m_m,heave_m_m\n0.5,0.3,1.0\n1.0,0.1,0.4\n")
    motion = read_rao(path).motion([0.5, 1.0])
    assert motion == pytest.approx(np.array([[0.3, 1.0], [0.1, 0.4]]))


def test_a_sea_beyond_the_table_is_refused() -> None:
    vessel = Rao(omega=[0.3, 1.0], heave=[1.0, 0.4])
    with pytest.raises(InvalidInput, match=r"from 0\.3 to 1 rad/s, but .* % of the sea's variance lies outside"):
        vessel.check(SeaState(height=3.0, peak_period=8.0).spectrum())
    read_rao(SWATH).check(SeaState(height=3.0, peak_period=5.0).spectrum())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"omega": [0.0, 1.0]}, "above zero, but the first is 0"),
        ({"omega": [1.0, 1.0]}, "increasing"),
        ({"omega": [1.0], "heave": [1.0]}, "at least 2"),
        ({"heave": [1.0, -0.1]}, r"heave\[1\] is -0\.1"),
        ({"heave": [1.0]}, "one heave for each of its 2"),
        ({"heave_phase": [0.0, np.nan]}, r"heave_phase\[1\] is nan"),
        ({"surge": [0.1, 0.2, 0.3]}, "one surge for each of its 2"),
        ({"heave": [0.0, 0.0]}, "never moves"),
    ],
)
def test_what_is_no_rao(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        Rao(**{"omega": [0.5, 1.0], "heave": [1.0, 0.5]} | changes)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("omega_rad_s,roll\n1,2\n", "columns omega_rad_s, heave_m_m are needed and may have"),
        ("omega_rad_s,heave_m_m,heave_m_m\n1,2,3\n", "the header has"),
        ("omega_rad_s,heave_m_m,surge_phase_rad\n1,2,3\n2,1,3\n", "no surge"),
        ("omega_rad_s,heave_m_m\n1,2\n0.5,3\n", "increasing"),
        ("# nothing but words\n", "columns omega_rad_s, heave_m_m are needed"),
    ],
)
def test_files_that_hold_no_rao(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "vessel.csv"
    path.write_text(text)
    with pytest.raises(InvalidInput, match=message) as caught:
        read_rao(path)
    assert str(caught.value).startswith(str(path))


def test_phases_in_degrees_are_refused() -> None:
    with pytest.raises(InvalidInput, match=r"phases in radians, .* heave_phase\[1\] is -170"):
        Rao(omega=[0.5, 1.0], heave=[1.0, 0.5], heave_phase=[0.0, -170.0])
