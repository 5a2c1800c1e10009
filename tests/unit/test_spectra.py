"""Spectra: moments beside reference values, made and resampled spectra, known file formats, and what is refused."""

import gzip
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from data_synth import seas
from data_synth.records.ndbc import bin_widths
from data_synth.records.spectra import read_spectrum
from data_synth.spectra import BAND, FORMS, SEA_STATES, SeaState, Spectrum, sea_state, total
from models.quantity import InvalidInput

RECORDS = Path(__file__).parents[3] / "shared" / "records" / "sea"
CDIP, NDBC, SUMMARY = "mhkit_ValData2_CDiP.json", "ndbc_46042w1996.txt.gz", "wavespectra_41010.spec"
TWO_PI = 2.0 * np.pi


def record(name: str) -> Path:
    if not (RECORDS / name).is_file():
        pytest.skip(f"needs the recorded spectra {name} in {RECORDS}")
    return RECORDS / name


def flat(**changes: Any) -> Spectrum:
    return Spectrum(**{"omega": [0.5, 1.0, 1.5], "density": [1.0, 1.0, 1.0]} | changes)


@pytest.mark.parametrize("name", ["CDiP1", "CDiP6"])
def test_moments_and_periods_of_the_reference_set(name: str) -> None:
    path = record(CDIP)
    reference = json.loads(path.read_text())[name]
    spectrum = read_spectrum(path, name).spectrum

    def moment(n: float) -> float:  # of frequency in Hz
        return spectrum.moment(n) / TWO_PI**n

    for n, value in reference["m"].items():
        assert moment(int(n)) == pytest.approx(value, rel=1e-12), n
    metrics = reference["metrics"]
    assert spectrum.significant_height == pytest.approx(metrics["Hm0"], rel=1e-12)
    assert spectrum.energy_period == pytest.approx(metrics["Te"], rel=1e-12)
    assert spectrum.zero_crossing_period == pytest.approx(metrics["T0"], rel=1e-12)
    assert TWO_PI / spectrum.peak == pytest.approx(metrics["Tp"], rel=1e-12)
    assert moment(0) / moment(1) == pytest.approx(metrics["Tm"], rel=1e-12)
    # As the set has them: Tc without its root, e with m_0/m_4 in the place of their product, v by m_-1.
    assert moment(2) / moment(4) == pytest.approx(metrics["Tc"], rel=1e-12)
    assert np.sqrt(1.0 - moment(2) ** 2 / (moment(0) / moment(4))) == pytest.approx(metrics["e"], rel=1e-12)
    assert np.sqrt(moment(0) * moment(-2) / moment(-1) ** 2 - 1.0) == pytest.approx(metrics["v"], rel=1e-9)
    for case, flux in reference["J"].items():
        if reference["h"][int(case)] == 1000.0:  # deep water: rho g^2 m_-1/(4 pi)
            rho, g = reference["rho"][int(case)], reference["g"][int(case)]
            assert rho * g**2 / (4.0 * np.pi) * moment(-1) == pytest.approx(flux, rel=1e-5)


def test_the_highest_of_the_reference_set_is_the_default() -> None:
    found = read_spectrum(record(CDIP))
    assert found.record == "CDiP1"
    assert found.spectrum.significant_height == pytest.approx(3.0481, abs=5e-5)
    with pytest.raises(InvalidInput, match="there are CDiP1, CDiP6"):
        read_spectrum(record(CDIP), "CDiP2")


def test_a_year_of_hourly_spectra() -> None:
    path = record(NDBC)
    highest = read_spectrum(path)
    assert "highest of 8600" in highest.notes[0]
    assert "112 further rows" in highest.notes[0]
    rows = [line.split() for line in gzip.decompress(path.read_bytes()).decode().splitlines()[1:]]
    sums = [0.01 * sum(map(float, row[4:])) for row in rows if "999.00" not in row]
    assert highest.spectrum.significant_height == pytest.approx(4.0 * np.sqrt(max(sums)), rel=1e-9)
    first = read_spectrum(path, "1996-01-01T00:00")
    assert first.record == "1996-01-01 00:00"
    assert first.spectrum.moment(0) == pytest.approx(sums[0], rel=1e-9)
    with pytest.raises(InvalidInput, match="that row holds the fill value"):
        read_spectrum(path, "1996-01-01 11:00")
    with pytest.raises(InvalidInput, match="there is none; the nearest is of 1996-12-31"):
        read_spectrum(path, "1997-06-01 00:00")


def test_a_summary_gives_a_sea_of_its_height() -> None:
    path = record(SUMMARY)
    found = read_spectrum(path, "2020-06-08 03:40")  # WVHT 1.1 m, swell 1.0 m of 5.6 s, wind sea 0.5 m of 4.0 s
    assert found.spectrum.significant_height == pytest.approx(np.hypot(1.0, 0.5), rel=1e-9)
    assert found.spectrum.significant_height == pytest.approx(1.1, abs=0.05)
    assert TWO_PI / found.spectrum.peak == pytest.approx(5.6, rel=0.02)
    assert "Bretschneider" in found.notes[1]
    assert read_spectrum(path).spectrum.significant_height > 2.9


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("points", [60, 200])
def test_a_made_sea_keeps_its_height_and_peak(form: Any, points: int) -> None:
    spectrum = SeaState(height=3.0, peak_period=9.0).spectrum(form, points=points)
    assert spectrum.significant_height == pytest.approx(3.0, rel=1e-12)
    step = (BAND[1] / BAND[0]) ** (0.5 / (points - 1))
    assert TWO_PI / 9.0 / step <= spectrum.peak <= TWO_PI / 9.0 * step
    fine = SeaState(height=3.0, peak_period=9.0).spectrum(form, points=4000)
    assert spectrum.zero_crossing_period == pytest.approx(fine.zero_crossing_period, rel=1e-3)


@pytest.mark.parametrize("gamma", [1.0, 3.3, 20.0])
def test_the_band_keeps_the_variance(gamma: float) -> None:
    low, high = BAND
    whole = np.geomspace(0.2, 200.0, 200_001)

    def variance(omega: np.ndarray) -> float:
        return float(np.trapezoid(seas.jonswap(omega, 4.0, 1.0, gamma), omega))

    inside = whole[(whole >= low) & (whole <= high)]
    assert variance(whole) == pytest.approx(1.0, abs=1e-5)
    assert variance(inside) > 0.999


def test_moments_of_bretschneider_in_closed_form() -> None:
    # m_1/m_0 = (5/4)^(1/4) Gamma(3/4) om_m, m_2/m_0 = sqrt(5/4 pi) om_m^2; the band leaves out a little of m_2.
    spectrum = SeaState(height=2.0, peak_period=TWO_PI).spectrum(points=2000)
    assert spectrum.moment(1) / spectrum.moment(0) == pytest.approx(1.25**0.25 * 1.2254167, rel=4e-3)
    assert spectrum.moment(2) / spectrum.moment(0) == pytest.approx(np.sqrt(1.25 * np.pi), rel=0.03)


def test_resampling_keeps_the_variance_and_the_given_points() -> None:
    coarse = Spectrum(omega=[0.3, 0.5, 0.6, 2.0], density=[0.0, 3.0, 1.0, 0.0])
    fine = coarse.resampled(100)
    assert fine.moment(0) == pytest.approx(coarse.moment(0), rel=1e-12)
    assert np.isin(coarse.omega, fine.omega).all()
    assert fine.at(0.55) == pytest.approx(2.0)
    bins = Spectrum(omega=[0.5, 1.0, 1.5], density=[0.1, 2.0, 0.1], width=[0.5, 0.5, 0.5])
    assert bins.moment(0) == pytest.approx(1.1)
    assert bins.resampled(50).moment(0) == pytest.approx(1.1, rel=1e-12)
    assert bins.resampled(50).width is None


def test_periods_by_hand() -> None:
    spectrum = flat()  # weights 0.25, 0.5, 0.25
    assert spectrum.sigma == pytest.approx(1.0)
    assert spectrum.energy_period == pytest.approx(TWO_PI * (0.5 + 0.5 + 0.25 / 1.5))
    assert spectrum.zero_crossing_period == pytest.approx(TWO_PI / np.sqrt(0.0625 + 0.5 + 0.5625))


def test_what_lies_outside_a_spectrum_has_no_energy() -> None:
    spectrum = flat()
    assert spectrum.at([0.4, 0.75, 1.6]) == pytest.approx([0.0, 1.0, 0.0])
    assert spectrum.share(0.0, 3.0) == pytest.approx(1.0)
    assert spectrum.share(0.9, 1.1) == pytest.approx(0.5)


def test_seas_together_have_their_variances_together() -> None:
    swell, wind = SeaState(height=1.0, peak_period=16.0).spectrum(), SeaState(height=2.0, peak_period=7.0).spectrum()
    assert total(swell, wind).significant_height == pytest.approx(np.hypot(1.0, 2.0), rel=1e-12)


def test_sea_states_of_the_paper() -> None:
    assert {number: state.height for number, state in SEA_STATES.items()} == {5: 3.23, 6: 4.99}
    assert sea_state(6).spectrum().significant_height == pytest.approx(4.99)
    with pytest.raises(InvalidInput, match="5, 6, but 7"):
        sea_state(7)


def test_spectra_are_read_only() -> None:
    given = np.array([1.0, 1.0, 1.0])
    spectrum = flat(density=given)
    given[0] = 9.0
    assert spectrum.density[0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        spectrum.density[0] = 2.0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"density": [0.0, 0.0, 0.0]}, "no energy"),
        ({"density": [1.0, -0.5, 1.0]}, r"at 1 rad/s it is -0\.5"),
        ({"density": [1.0, np.nan, 1.0]}, r"density\[1\] is nan"),
        ({"omega": [0.0, 1.0, 1.5]}, "above zero, but its first is 0 rad/s"),
        ({"omega": [0.5, 1.5, 1.0]}, r"omega\[1\] = 1\.5 rad/s and omega\[2\] = 1 rad/s"),
        ({"omega": [0.5, 1.0, 1.0]}, "increasing"),
        ({"density": [1.0, 1.0]}, "one density for each of its 3"),
        ({"width": [0.5, 0.0, 0.5]}, r"width\[1\] = 0"),
        ({"omega": [0.5], "density": [1.0]}, "at least 2 frequencies"),
    ],
)
def test_what_is_no_spectrum(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        flat(**changes)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: SeaState(height=0.0, peak_period=9.0), "height"),
        (lambda: SeaState(height=3.0, peak_period=-1.0), "peak_period"),
        (lambda: SeaState(height=3.0, peak_period=9.0).spectrum("pierson"), "one of bretschneider, jonswap"),
        (lambda: SeaState(height=3.0, peak_period=9.0).spectrum("jonswap", gamma=0.2), "gamma"),
        (lambda: SeaState(height=3.0, peak_period=9.0).spectrum(points=3), "at least 8 frequencies"),
    ],
)
def test_seas_that_cannot_be_made(make: Callable[[], Spectrum], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        make()


@pytest.mark.parametrize(
    "text",
    [
        "# measured\nomega_rad_s,density_m2_s_rad\n0.5,1.0\n1.0,2.0\n\n1.5,0.5\n",
        "density_m2_Hz, frequency_Hz\n6.283185307,0.0795774715\n12.566370614,0.159154943\n3.141592654,0.238732415\n",
    ],
)
def test_plain_tables(text: str, tmp_path: Path) -> None:
    path = tmp_path / "spectrum.csv"
    path.write_text(text)
    spectrum = read_spectrum(path).spectrum
    assert spectrum.omega == pytest.approx([0.5, 1.0, 1.5])
    assert spectrum.density == pytest.approx([1.0, 2.0, 0.5])


def test_bins_of_uneven_frequencies() -> None:
    assert bin_widths(np.array([0.02, 0.0325, 0.0375, 0.0425])) == pytest.approx([0.0125, 0.00875, 0.005, 0.005])


def test_newer_densities_have_minutes_and_four_digits(tmp_path: Path) -> None:
    path = tmp_path / "swden.txt"
    path.write_text(
        "#YY MM DD hh mm .0200 .0300 .0400\n2020 06 08 03 40 0.00 2.00 MM\n2020 06 08 04 40 0.00 1.00 0.5\n"
    )
    found = read_spectrum(path)
    assert found.record == "2020-06-08 04:40"
    assert found.spectrum.moment(0) == pytest.approx(0.015)


HEAD = "YY MM DD hh .030 .040 .050\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("time,height\n1,2\n", "known format"),
        ("[1, 2]\n", "known format"),
        ('{"a": 1}', "known format"),
        ('{"a": ', "not JSON"),
        ('{"a": {"S": {"x": 1.0}}}', "do not fit"),
        ('{"a": {"S": {"0.1": 1.0, "0.2": 1.0}, "freqBinWidth": {"0.1": 0.1}}}', "do not fit"),
        ('{"a": {"S": {"0": 1.0, "0.2": 1.0}}}', "a: A spectrum needs frequencies above zero"),
        ('{"a": {"S": {"0.1": -1.0, "0.2": 1.0}}}', "no negative density"),
        ("omega_rad_s,density_m2_s_rad\n", "rows are needed"),
        ("omega_rad_s,density_m2_s_rad\n0.5,1.0\n1.0,high\n", "line 3, column density_m2_s_rad.*'high'"),
        ("omega_rad_s,density_m2_s_rad\n0.5,1.0,3\n", "line 2: 2 cells are needed, but it has 3"),
        ("omega_rad_s,density_m2_Hz\n0.5,1.0\n", "columns omega_rad_s, density_m2_s_rad are needed"),
        ("omega_rad_s,density_m2_s_rad\n0.5,0\n1.0,0\n", "no energy"),
        ("frequency_Hz,density_m2_Hz\n0,1\n1.0,0\n", "above zero"),
        (HEAD + "96 01 01 00 999.00 999.00 999.00\n", "all 1 rows hold the fill value 999"),
        (HEAD + "96 01 01 00 0.00 0.00 0.00\n", "no energy"),
        (HEAD + "96 01 01 00 1.00 -1.00 0.10\n", "no negative density"),
        (HEAD + "96 01 01 00 1.00 0.10\n", "line 2: 7 values are needed, but it has 6"),
        (HEAD + "96 13 01 00 1.00 0.10 0.10\n", "date and hour"),
        (HEAD + "96 01 01 00 1.00 x 0.10\n", r"line 2, column \.040"),
    ],
)
def test_files_that_hold_no_spectrum(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "spectrum.txt"
    path.write_text(text)
    with pytest.raises(InvalidInput, match=message) as caught:
        read_spectrum(path)
    assert str(caught.value).startswith(str(path))


def test_a_summary_without_waves_or_parts(tmp_path: Path) -> None:
    path = tmp_path / "calm.spec"
    head = "#YY  MM DD hh mm WVHT  SwH  SwP  WWH  WWP SwD WWD  STEEPNESS  APD MWD\n"
    path.write_text(head + "2020 06 08 03 40  0.0  0.0  5.6  0.0  4.0 SSW  SE      STEEP  4.9 196\n")
    with pytest.raises(InvalidInput, match="no energy"):
        read_spectrum(path)
    path.write_text(head + "2020 06 08 03 40  1.1  MM  MM  0.5  4.0 SSW  SE      STEEP  4.9 196\n")
    with pytest.raises(InvalidInput, match="all 1 rows lack one"):
        read_spectrum(path)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="no such file"):
        read_spectrum(tmp_path / "none.txt")
    with pytest.raises(InvalidInput, match="folder"):
        read_spectrum(tmp_path)
    (tmp_path / "cut.gz").write_bytes(gzip.compress(HEAD.encode())[:-9])
    with pytest.raises(InvalidInput, match="damaged"):
        read_spectrum(tmp_path / "cut.gz")
    (tmp_path / "noise.txt").write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(InvalidInput, match="not text"):
        read_spectrum(tmp_path / "noise.txt")


def test_a_record_is_chosen_where_there_are_several(tmp_path: Path) -> None:
    path = tmp_path / "spectrum.csv"
    path.write_text("omega_rad_s,density_m2_s_rad\n0.5,1.0\n1.0,1.0\n")
    with pytest.raises(InvalidInput, match="leave out the record"):
        read_spectrum(path, "first")
    path.write_text(HEAD + "96 01 01 00 1.00 0.10 0.10\n")
    with pytest.raises(InvalidInput, match="date and time"):
        read_spectrum(path, "first")
