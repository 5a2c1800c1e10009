"""The sea study: its tables beside sums of their own, what its page says, and what is refused."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from data_synth.rao import read_rao
from ident.configuration import Configuration, load
from ident.sea_tables import COLUMNS
from ident.studies.sea import SeaResult, sea
from models import response_statistics as statistics
from models.quantity import InvalidInput
from models.statics import static_shape

SWATH = Path(__file__).parents[2] / "ident" / "vessels" / "swath.csv"
SEA = {"spectrum": "bretschneider", "height": 4.99, "peak_period": 11.3}
FILES = ("sea.csv", "sea-details.csv", "spectra.csv", "extremes.csv", "durations.csv", "cable.csv", "manifest.json")


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


@pytest.fixture(scope="module")
def swath() -> Configuration:
    return load("swath-4000")


@pytest.fixture(scope="module")
def made(swath: Configuration, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, SeaResult]:
    """The towfish under the SWATH vessel in sea state 6, its compensator locked."""
    out = tmp_path_factory.mktemp("sea") / "six"
    return out, sea(swath, **SEA, rao=SWATH, out=out, progress=quiet)


def read(made: tuple[Path, SeaResult], name: str) -> pd.DataFrame:
    return pd.read_csv(made[0] / f"{name}.csv")


def test_rows_and_columns(made: tuple[Path, SeaResult]) -> None:
    table = read(made, "sea")
    assert tuple(table.columns) == COLUMNS
    motions = ["wave", "vessel_heave", "top", "surge", "heave", "pitch"]
    assert table["quantity"].to_list() == [*motions, "tension_bottom", "tension_top"]
    assert all((made[0] / name).is_file() for name in FILES)
    assert len(made[1].table) == len(table)


def test_locked_compensator_of_table_four(made: tuple[Path, SeaResult]) -> None:
    # H Table IV, sea state 6, locked: heights [m], 1/1000 of the tensions as amplitudes [N]; the RAO is not H's.
    table = read(made, "sea").set_index("quantity")
    assert table.loc["wave", "significant"] == pytest.approx(4.99, rel=2e-3)
    assert table.loc["vessel_heave", "significant"] == pytest.approx(5.25, rel=1e-3)
    assert table.loc["top", "significant"] == pytest.approx(5.25, rel=1e-3)
    assert table.loc["heave", "significant"] == pytest.approx(7.02, rel=0.03)
    assert table.loc["tension_bottom", "one_in_1000"] == pytest.approx(7770.0, rel=0.06)
    assert table.loc["tension_top", "one_in_1000"] == pytest.approx(13550.0, rel=0.06)
    assert table.loc["tension_bottom", "static"] == pytest.approx(3140.0)
    assert table.loc["tension_top", "static"] == pytest.approx(35700.0)


def test_the_table_is_the_integral_of_the_spectra(made: tuple[Path, SeaResult]) -> None:
    table, spectra = read(made, "sea").set_index("quantity"), read(made, "spectra")
    omega = spectra["omega_rad_s"].to_numpy()
    for column in spectra.columns[1:]:
        row = table.loc[column.rsplit("_", 2)[0]]
        sigma = np.sqrt(np.trapezoid(spectra[column], omega))
        rate = np.sqrt(np.trapezoid(spectra[column] * omega**2, omega))
        share = 0.5 if row["unit"] == "N" else 1.0
        assert row["sigma"] == pytest.approx(sigma, rel=1e-6)
        assert row["zero_crossing_s"] == pytest.approx(2.0 * np.pi * sigma / rate, rel=1e-6)
        assert row["significant"] == pytest.approx(share * 4.0043 * sigma, rel=1e-4)
        assert row["one_in_10"] == pytest.approx(share * 5.0907 * sigma, rel=1e-4)
        assert row["one_in_1000"] == pytest.approx(share * 7.4338 * sigma, rel=1e-4)
    slack = np.exp(-0.5 * (table["static"] / table["sigma"]) ** 2).loc[["tension_bottom", "tension_top"]]
    assert table.loc[slack.index, "slack_probability"].to_list() == pytest.approx(slack.to_list(), rel=1e-5)
    assert table["slack_probability"].drop(slack.index).isna().all()
    motion = read_rao(SWATH).motion(omega)[:, 1]
    assert spectra["vessel_heave_m2_s"].to_numpy() == pytest.approx(abs(motion) ** 2 * spectra["wave_m2_s"], rel=1e-6)


def test_extremes_over_the_duration(made: tuple[Path, SeaResult]) -> None:
    table, extremes = read(made, "sea").set_index("quantity"), read(made, "extremes").set_index("quantity")
    assert (extremes["duration_s"] == 10800.0).all()
    assert extremes["cycles"].to_numpy() == pytest.approx(10800.0 / table.loc[extremes.index, "zero_crossing_s"])
    top = extremes.loc["tension_top"]
    root = np.sqrt(2.0 * np.log(top["cycles"]))
    assert top["most_probable"] == pytest.approx(table.loc["tension_top", "sigma"] * root, rel=1e-6)
    assert top["most_probable"] < top["expected"] < top["one_in_100"]
    assert top["largest"] + top["least"] == pytest.approx(2.0 * 35700.0)
    assert extremes.loc["tension_bottom", "slack_in_duration"] == pytest.approx(1.0)
    growth = read(made, "durations")
    own = growth[growth["quantity"] == "tension_top"]
    between = np.interp(np.log(10800.0), np.log(own["duration_s"]), own["expected_N"])
    assert between == pytest.approx(top["expected"], rel=1e-3)
    assert own["expected_N"].is_monotonic_increasing


def test_slack_along_the_cable(made: tuple[Path, SeaResult]) -> None:
    cable, table = read(made, "cable"), read(made, "sea").set_index("quantity")
    for name, end in (("tension_bottom", cable.iloc[0]), ("tension_top", cable.iloc[-1])):
        assert end["sigma_N"] == pytest.approx(table.loc[name, "sigma"], rel=1e-6)
        assert end["static_N"] == pytest.approx(table.loc[name, "static"], rel=1e-6)
    expected = statistics.slack_probability(cable["static_N"], cable["sigma_N"])
    assert cable["slack_probability"].to_numpy() == pytest.approx(expected, rel=1e-4)
    chance = 100.0 * cable["slack_probability"].max()
    assert 30.0 < chance < 40.0
    assert any(f"slack in {chance:.2g} %" in note for note in made[1].notes)


def test_the_page_says_what_the_tables_say(made: tuple[Path, SeaResult]) -> None:
    page = (made[0] / "report.md").read_text()
    table = read(made, "sea").set_index("quantity")
    assert f"significant height of {table.loc['heave', 'significant']:.2f} m" in page
    assert f" {table.loc['tension_top', 'one_in_1000']:.0f} |" in page
    chance = 100.0 * table.loc["tension_bottom", "slack_probability"]
    assert f"Slack is likeliest at the vehicle, in {chance:.0f} % of the cycles." in page
    assert "an assumed shape" in page
    assert "not the average of the highest thousandth" in page
    assert "Checked by other means" not in page
    links = re.findall(r"\]\((figures/[^)]+)\)", page)
    assert len(links) == 5
    for link in links:
        assert (made[0] / link).stat().st_size > 1000
    assert any("one in a thousand exceeds" in note for note in made[1].notes)


def test_errors_are_small_beside_what_they_are_of(made: tuple[Path, SeaResult]) -> None:
    details = read(made, "sea-details")
    assert details["mesh_error_percent"].max() < 1.0
    assert details["frequency_error_percent"].max() < 0.05
    assert details["tail_percent"].max() < 0.5


def test_a_finer_sea_gives_the_same(swath: Configuration, made: tuple[Path, SeaResult], tmp_path: Path) -> None:
    sea(swath, **SEA, rao=SWATH, points=800, out=tmp_path / "fine", progress=quiet)
    fine, own = pd.read_csv(tmp_path / "fine" / "sea.csv"), read(made, "sea")
    for name in ("sigma", "zero_crossing_s"):
        assert own[name].to_numpy() == pytest.approx(fine[name], rel=2e-3)


def test_a_small_sea_is_linear_but_for_drag(swath: Configuration, tmp_path: Path) -> None:
    """Twice the sea gives twice the motion of the top, and less than that of what resonates: drag grows with it."""
    tables = []
    for height in (2.0, 4.0):
        out = tmp_path / f"{height:g}"
        given = {"spectrum": "bretschneider", "height": height, "peak_period": 8.0, "segments": 64}
        sea(swath, **given, out=out, progress=quiet)
        tables.append(pd.read_csv(out / "sea.csv").set_index("quantity")["sigma"])
    ratio = tables[1] / tables[0]
    assert ratio["wave"] == pytest.approx(2.0)
    assert ratio["top"] == pytest.approx(2.0)
    assert 1.3 < ratio["heave"] < 1.95


def test_a_measured_sea_without_vessel(tmp_path: Path) -> None:
    path = tmp_path / "buoy.csv"
    path.write_text("frequency_Hz,density_m2_Hz\n0.05,0\n0.08,6\n0.1,12\n0.15,4\n0.3,0.1\n")
    result = sea(load("mangus-740"), spectrum=str(path), direction="axial", out=tmp_path / "sea", progress=quiet)
    table = pd.read_csv(tmp_path / "sea" / "sea.csv").set_index("quantity")
    area = 0.5 * (0.03 * 6.0 + 0.02 * 18.0 + 0.05 * 16.0 + 0.15 * 4.1)
    assert table.loc["wave", "sigma"] == pytest.approx(np.sqrt(area), rel=1e-6)
    assert table.loc["top", "sigma"] == pytest.approx(np.sqrt(area), rel=1e-6)
    # A point mass on a straight cable: no pitch, and no surge to have a period or an extreme.
    assert "pitch" not in table.index
    assert table.loc["surge", "sigma"] == 0.0
    assert np.isnan(table.loc["surge", "zero_crossing_s"])
    extremes = pd.read_csv(tmp_path / "sea" / "extremes.csv")
    assert "surge" not in extremes["quantity"].to_list()
    page = (tmp_path / "sea" / "report.md").read_text()
    assert "buoy.csv" in page
    assert "**pitch of the vehicle**" in page
    assert len(result.table) == len(table)


def test_a_spectrum_that_ends_too_soon_is_named(swath: Configuration, tmp_path: Path) -> None:
    path = tmp_path / "cut.csv"
    path.write_text("omega_rad_s,density_m2_s_rad\n0.3,0\n0.5,1\n1.0,1\n")
    result = sea(swath, spectrum=str(path), segments=64, out=tmp_path / "sea", progress=quiet)
    assert any("variance of tension_top lies in the last tenth" in note for note in result.notes)


def test_surge_of_the_vessel_has_a_row(tmp_path: Path) -> None:
    path = tmp_path / "vessel.csv"
    path.write_text("omega_rad_s,heave_m_m,surge_m_m,surge_phase_rad\n0.1,1,0.8,-1.57\n6,0.5,0.2,-1.57\n")
    given = SEA | {"rao": path, "segments": 64}
    tow = load("multipart-2200")
    sea(tow, **given, out=tmp_path / "sea", progress=quiet)
    sea(tow, **given, direction="axial", out=tmp_path / "along", progress=quiet)
    table, along = (pd.read_csv(tmp_path / name / "sea.csv").set_index("quantity") for name in ("sea", "along"))
    assert table.loc["vessel_surge", "sigma"] > 0.0
    statics = static_shape(tow.tow).T
    assert table.loc["tension_bottom", "static"] == pytest.approx(statics[0], rel=1e-5)
    assert table.loc["tension_top", "static"] == pytest.approx(statics[-1], rel=1e-5)
    # Of a cable at an angle, only a part of the heave goes along it, unless it is told to.
    assert along.loc["top", "sigma"] == pytest.approx(along.loc["vessel_heave", "sigma"])
    assert abs(table.loc["top", "sigma"] / along.loc["top", "sigma"] - 1.0) > 0.1


def cut_vessel(folder: Path) -> Path:
    path = folder / "cut.csv"
    path.write_text("omega_rad_s,heave_m_m\n0.1,1\n0.7,0.5\n")
    return path


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"spectrum": "bretschneider"}, "neither is given"),
        ({"spectrum": "jonswap", "height": 2.0}, "only one is given"),
        (SEA | {"height": 0.0}, "height"),
        (SEA | {"record": "first"}, "no records"),
        (SEA | {"spectrum": "none.csv"}, "a height and a period of its own"),
        ({"spectrum": "none.csv"}, "no such file"),
        (SEA | {"rao": "none.csv"}, "no such file"),
        (SEA | {"rao": cut_vessel}, "of the sea's variance lies outside"),
        (SEA | {"rao": SWATH, "direction": "surge"}, "surge is a column of the RAO"),
        (SEA | {"duration": 0.0}, "above 0 s"),
        (SEA | {"duration": 60.0, "segments": 64}, "at least 10 cycles"),
        (SEA | {"points": 2}, "at least 8 frequencies"),
    ],
)
def test_what_cannot_be_studied(swath: Configuration, given: dict[str, Any], message: str, tmp_path: Path) -> None:
    rao: Path | Callable[[Path], Path] | str | None = given.get("rao")
    made = {"rao": rao(tmp_path) if callable(rao) else None if rao is None else tmp_path / rao}
    with pytest.raises(InvalidInput, match=message):
        sea(swath, **given | made, out=tmp_path / "sea", progress=quiet)
    assert not (tmp_path / "sea").exists()
