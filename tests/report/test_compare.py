"""The comparison of the simulators end to end on a short ladder: its tables, its page, and what it cannot compare."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from ident.configuration import load
from ident.studies import compare as study
from ident.studies.compare import compare, crossing
from models.quantity import InvalidInput
from models.statics import SlackCable, static_shape
from models.tow import Tow
from reports.markdown import significant

SPEEDS = (0.2, 0.5, 1.0)


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One configuration, followed long enough the second time."""
    out = tmp_path_factory.mktemp("compare") / "out"
    result = compare([load("mangus-740")], out=out, progress=quiet, speeds=SPEEDS, durations=(300.0, 1500.0))
    assert result.folder == out
    assert [row["threshold"] for row in result.table] == ["stated error 0.0001 m/s", "1 % of the speed"]
    return out


def test_the_simulators_agree_while_deflections_are_small(folder: Path) -> None:
    table = pd.read_csv(folder / "compare.csv")
    assert tuple(table.columns) == study.COLUMNS
    assert table["speed_m_s"].tolist() == list(SPEEDS)
    difference = table["difference_rms_velocity_m_s"].to_numpy()
    assert difference[0] < 3e-5
    assert 5e-4 < difference[1] < 3e-3
    assert difference[2] > 1e-2
    assert (table["chain_error_m_s"] <= 0.1 * difference).all()
    assert (table["spectral_error_m_s"] <= 1e-4).all()
    assert table["difference_share"].to_numpy() == pytest.approx(difference / SPEEDS)
    assert table["note"].isna().all()


def test_the_record_lasts_until_the_vehicle_follows(folder: Path) -> None:
    table = pd.read_csv(folder / "compare.csv")
    assert (table["duration_s"] == 1500.0).all()
    assert (table["followed_share"] > 0.95).all()


def test_the_angle_is_that_of_the_continuous_cable(folder: Path) -> None:
    table, tow = pd.read_csv(folder / "compare.csv"), load("mangus-740").tow
    for speed, angle, travel in table[["speed_m_s", "angle_rad", "travel_angle_rad"]].to_numpy():
        exact = float(np.abs(static_shape(replace(tow, speed=speed)).phi - 0.5 * math.pi).max())
        assert angle == pytest.approx(exact, rel=0.02)
        assert travel == pytest.approx(angle, rel=0.05)


def test_the_page_says_where_the_thresholds_are(folder: Path) -> None:
    thresholds = pd.read_csv(folder / "thresholds.csv")
    assert (thresholds["speed_m_s"] > 0.2).all()
    assert thresholds["speed_m_s"].is_monotonic_increasing
    page = (folder / "report.md").read_text(encoding="utf-8")
    for speed, angle in thresholds[["speed_m_s", "angle_rad"]].to_numpy():
        assert f"passed at {significant(speed)} m/s" in page
        assert f"({significant(angle)} rad)" in page
    assert "It refuses none of these runs." in page
    links = re.findall(r"\]\((figures/[^)]+)\)", page)
    assert len(links) == 1
    assert (folder / links[0]).stat().st_size > 1000
    told = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    assert list(told["configurations"]) == ["mangus-740"]


def test_a_tow_is_followed_from_rest_and_from_its_speed(tmp_path: Path) -> None:
    compare([load("multipart-2200")], out=tmp_path / "out", progress=quiet, speeds=(0.1,), durations=(600.0,))
    table = pd.read_csv(tmp_path / "out" / "compare.csv")
    assert table["tow_speed_m_s"].tolist() == [0.0, 3.0867]
    assert table["difference_share"].iloc[0] < 1e-3 < table["difference_share"].iloc[1]
    page = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    assert "### multipart-2200 from 3.09 m/s" in page
    assert "the parts behind the vehicle, damping-unit" in page
    assert "not passed up to 0.1 m/s" in page


def test_a_run_that_is_refused_is_named_and_the_others_stand(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    real = study.reference_run

    def refusing(configuration: Any, ship: Any) -> Any:
        if ship.position[-1, 0] > 200.0:
            raise SlackCable("the cable goes slack at t = 7 s")
        return real(configuration, ship)

    monkeypatch.setattr(study, "reference_run", refusing)
    compare([load("mangus-740")], out=tmp_path / "out", progress=quiet, speeds=SPEEDS, durations=(300.0,))
    table = pd.read_csv(tmp_path / "out" / "compare.csv")
    assert table["difference_rms_velocity_m_s"].isna().tolist() == [False, False, True]
    assert table["angle_rad"].notna().all()
    page = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    assert "* 1 m/s: the cable goes slack at t = 7 s" in page
    assert "1 of 3 runs could not be compared" in page


def test_what_cannot_be_compared(table_two: Tow, tmp_path: Path) -> None:
    own = load("mangus-740")
    with pytest.raises(InvalidInput, match="must differ in name"):
        compare([own, own], out=tmp_path / "out", progress=quiet)
    with pytest.raises(InvalidInput, match="pitches"):
        compare([replace(own, tow=table_two)], out=tmp_path / "out", progress=quiet)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("values", "found", "note"),
    [
        ([1e-6, 1e-5, 1e-3], 2.0 * math.sqrt(2.0), ""),
        ([1e-6, 2e-4, 1e-5, 1e-3], 4.0 * math.sqrt(2.0), ""),
        ([math.nan, 1e-5, 1e-3, math.nan], 2.0 * math.sqrt(2.0), ""),
        ([1e-3, 1e-2], math.nan, "passed below 1 m/s"),
        ([1e-6, 1e-5], math.nan, "not passed up to 2 m/s"),
        ([math.nan], math.nan, "nothing to compare"),
    ],
)
def test_a_threshold_is_where_the_difference_stays_above(values: list[float], found: float, note: str) -> None:
    speed = 2.0 ** np.arange(len(values))
    table = pd.DataFrame({"speed_m_s": speed, "angle_rad": 0.1 * speed**2, "difference": values})
    at, angle, why = crossing(table, "difference", 1e-4)
    assert at == pytest.approx(found, nan_ok=True)
    assert angle == pytest.approx(0.1 * found**2, nan_ok=True)
    assert why == note
