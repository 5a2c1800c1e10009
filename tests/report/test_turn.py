"""The turning study: tables, page and verdicts, on heave that is known and on the real simulator."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from data_synth.ships import KNOT
from ident import turning
from ident.claims import claims
from ident.claims.view import AGREES, DISAGREES, PARTLY, UNKNOWN
from ident.configuration import Configuration, load
from ident.studies import turn as study
from ident.turning import Turning, run, ship_heave
from models.quantity import InvalidInput, NumericalFailure
from models.towed_system import TowedSystem
from models.trace import Trace

FAST = 6.0 * KNOT
TURN = {"radii": None, "turns": None, "parts": None, "lengths": None, "speeds": None}


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


def swing(system: TowedSystem, ship: Trace, **_: Any) -> SimpleNamespace:
    """Bodies that sink by 900 m from 60 s on and swing with the period 500 s, each half as far as the one above."""
    t = np.maximum(ship.t - 60.0, 0.0)
    bodies = []
    for i, _part in enumerate(system.parts):
        position = ship.position.copy()
        position[:, 0] -= 100.0 * (i + 1)
        size = 0.5**i * 150.0 * np.exp(-6e-4 * t)
        position[:, 2] = -1500.0 + 900.0 * np.exp(-t / 700.0) + size * np.cos(2.0 * math.pi * t / 500.0)
        tension = np.column_stack([2e4 + position[:, 2], 1e4 + position[:, 2]])
        bodies.append(Trace(t=ship.t, position=position, tension=tension))
    event = SimpleNamespace(part=system.parts[0].name, t=100.0, until=110.0, s=10.0, peak=21000.0)
    return SimpleNamespace(
        names=tuple(part.name for part in system.parts),
        bodies=tuple(bodies),
        tension_max=np.full(len(bodies), 2e4),
        slack=(event,),
        error=1e-3,
        position_error=0.5,
    )


@pytest.fixture
def simulator(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[..., Any]], None]:
    """Puts another simulator in the place of the chain."""
    return lambda made: monkeypatch.setattr(turning.link_joint, "simulate", made)


@pytest.fixture(scope="module")
def tow() -> Configuration:
    return load("multipart-2200")


def test_a_sweep_runs_the_product_of_its_lists(
    tow: Configuration, simulator: Callable[..., None], tmp_path: Path
) -> None:
    simulator(swing)
    given = TURN | {"parts": (1, 3), "lengths": (1000.0, 3200.0), "radii": (250.0,), "turns": (4.0,)}
    result = study.turn(tow, **given, out=tmp_path / "turns", progress=quiet)
    table = pd.read_csv(tmp_path / "turns" / "turn.csv")
    assert tuple(table.columns) == study.COLUMNS[: study.MAIN]
    assert len(table) == len(result.table) == 2 * (1 + 3)
    assert sorted(set(table["sigma"].round(3))) == [1.071, 3.429]
    assert table["circle_s"].to_numpy() == pytest.approx(2.0 * math.pi * 250.0 / tow.tow.speed)
    assert table["peak_gap_s"].iloc[0] == pytest.approx(510.0, abs=10.0)
    assert table["period_s"].iloc[0] == pytest.approx(500.0, rel=0.01)
    assert table["slack_events"].to_list() == [1, 1, 1, 0, 0, 1, 0, 0]
    peaks = pd.read_csv(tmp_path / "turns" / "peaks.csv")
    first = peaks[(peaks["parts"] == 1) & (peaks["length_m"] == 1000.0)]
    assert first["gap_s"].dropna().iloc[1] == pytest.approx(table["peak_gap_s"].iloc[0], abs=1e-3)


def test_the_page_says_what_the_table_says(tow: Configuration, simulator: Callable[..., None], tmp_path: Path) -> None:
    simulator(swing)
    given = TURN | {"radii": (250.0, 500.0)}
    study.turn(tow, **given, heave_periods=(60.0,), out=tmp_path / "turns", progress=quiet)
    page = (tmp_path / "turns" / "report.md").read_text()
    table = pd.read_csv(tmp_path / "turns" / "turn.csv")
    for value in (table["depth_m"].iloc[0], table["period_s"].iloc[0]):
        assert f" {value:.0f} |" in page
    links = re.findall(r"\]\((figures/[^)]+)\)", page)
    assert len(links) == 5
    for link in links:
        assert (tmp_path / "turns" / link).stat().st_size > 1000
    assert "R = 500 m" in page


def test_a_u_turn_has_no_period_and_says_so(tow: Configuration, simulator: Callable[..., None], tmp_path: Path) -> None:
    simulator(swing)
    study.turn(tow, **TURN | {"parts": (1,)}, u_turn=True, out=tmp_path / "turns", progress=quiet)
    row = pd.read_csv(tmp_path / "turns" / "turn-details.csv").iloc[0]
    assert math.isnan(row["period_s"])
    assert math.isnan(row["tow_radius_m"])
    assert row["note"]
    assert "deepest, m" in (tmp_path / "turns" / "report.md").read_text()


def test_a_run_that_fails_is_named_and_the_others_stand(
    tow: Configuration, simulator: Callable[..., None], tmp_path: Path
) -> None:
    def weak(system: TowedSystem, ship: Trace, **keywords: Any) -> SimpleNamespace:
        if len(system.parts) == 2:
            raise NumericalFailure("the chain broke at t = 5 s")
        return swing(system, ship, **keywords)

    simulator(weak)
    result = study.turn(tow, **TURN | {"parts": (1, 2)}, out=tmp_path / "turns", progress=quiet)
    table = pd.read_csv(tmp_path / "turns" / "turn-details.csv")
    assert table["note"].to_list()[1] == "the chain broke at t = 5 s"
    assert table["period_s"].isna().to_list() == [False, True]
    assert len(result.notes) == 1
    assert "the chain broke" in result.notes[0]
    with pytest.raises(NumericalFailure, match="the chain broke"):
        study.turn(tow, **TURN | {"parts": (2,)}, out=tmp_path / "none", progress=quiet)
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"turns": (2.0,), "u_turn": True}, "U-turn"),
        ({"parts": (4,)}, "4 were asked for"),
        ({"lengths": (-5.0,)}, "length .* above 0"),
        ({"turns": (0.0,)}, "turns .* above 0"),
    ],
)
def test_what_cannot_be_turned(tow: Configuration, given: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=message):
        study.turn(tow, **TURN | given, out=tmp_path / "turns", progress=quiet)


def test_a_hanging_cable_needs_a_speed(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="speed"):
        study.turn(load("mangus-740"), **TURN, out=tmp_path / "turns", progress=quiet)


def made_table(tow: Configuration, change: Callable[[dict[str, Any]], dict[str, Any]]) -> pd.DataFrame:
    """The claims' table, of rows that do not change with anything but as `change` has it."""
    rows = []
    for group in study.groups(tow):
        for each in group.turnings:
            for i in range(each.parts):
                row = {
                    "parts": each.parts,
                    "body": f"body {i}",
                    "length_m": each.length,
                    "radius_m": each.radius,
                    "speed_m_s": each.speed,
                    "sigma": 0.75 * each.length / 700.0,
                    "circle_s": each.circle,
                    "manoeuvre": "u-turn" if each.u_turn else "full-turn",
                    "peak_gap_s": 523.0,
                    "period_s": 520.0,
                    "damping_ratio": 0.1,
                    "decay_per_turn": 0.5,
                    "relaxation_s": 600.0,
                    "dips": 1,
                    "dip_s": 900.0,
                    "rise_m": 100.0,
                    "start_depth_m": 600.0,
                    "deepest_m": 2000.0,
                    "fit_percent": 90.0,
                    "plain_fit_percent": 90.0,
                    "tension_max_N": 18000.0,
                    "tension_start_N": 14000.0,
                    "slack_events": 0,
                    "snap_peak_N": math.nan,
                }
                rows.append(row | change(row | {"place": i}))
    return pd.DataFrame(rows)


def verdicts(tow: Configuration, change: Callable[[dict[str, Any]], dict[str, Any]]) -> dict[str, str]:
    table = claims(tow, made_table(tow, change), pd.DataFrame())
    return dict(zip(table["about"], table["verdict"], strict=True))


def test_claims_that_hold(tow: Configuration) -> None:
    found = verdicts(
        tow,
        lambda row: {
            "peak_gap_s": 523.0 * (2200.0 / row["length_m"]),
            "damping_ratio": 0.1 * row["radius_m"] / 250.0 * row["speed_m_s"] / FAST * 2200.0 / row["length_m"],
            "relaxation_s": row["length_m"],
            "period_s": 5e5 / row["length_m"],
            "rise_m": 10.0 * row["radius_m"] / 250.0 * 0.1 ** row["place"],
            "deepest_m": 600.0 + 1e5 / row["radius_m"] / row["speed_m_s"],
            "dip_s": 100.0 * row["speed_m_s"],
            "slack_events": int(row["radius_m"] == 250.0),
            "snap_peak_N": 20000.0,
        },
    )
    assert {about for about, verdict in found.items() if verdict != AGREES} <= {"Ship heave", "Duration against sigma"}
    assert found["Ship heave"] == UNKNOWN


def test_claims_that_do_not_hold(tow: Configuration) -> None:
    found = verdicts(
        tow,
        lambda row: {
            "peak_gap_s": 600.0,
            "damping_ratio": 0.1 * 250.0 / row["radius_m"] * FAST / row["speed_m_s"] * row["length_m"] / 2200.0,
            "period_s": 520.0,
            "relaxation_s": 600.0,
            "rise_m": 100.0 * 250.0 / row["radius_m"] * 2.0 ** row["place"],
            "deepest_m": 600.0 + row["radius_m"] * row["speed_m_s"],
            "dip_s": 1000.0 / row["speed_m_s"],
            "dips": 2,
            "plain_fit_percent": 30.0,
        },
    )
    assert {about for about, verdict in found.items() if verdict != DISAGREES} == {"Ship heave"}


def test_claims_without_figures_cannot_be_told(tow: Configuration) -> None:
    empty = dict.fromkeys(("peak_gap_s", "damping_ratio", "rise_m", "deepest_m", "plain_fit_percent"), math.nan)
    found = verdicts(tow, lambda row: empty | {"dips": math.nan, "dip_s": math.nan, "slack_events": math.nan})
    assert set(found.values()) == {UNKNOWN}


def test_a_snap_below_the_steady_tension_is_half_a_snap(tow: Configuration) -> None:
    tight = {"slack_events": 1, "snap_peak_N": 11000.0}
    assert verdicts(tow, lambda row: tight if row["radius_m"] == 250.0 else {})["Snap loads"] == PARTLY


def test_the_heave_period_of_the_paper(tow: Configuration) -> None:
    turn = Turning(parts=1, length=2200.0, radius=250.0, speed=FAST, turns=4.0)
    row = run(tow, turn).rows[0]
    assert row["peak_gap_s"] == pytest.approx(523.0, rel=0.02)
    assert row["circle_s"] == pytest.approx(509.0, rel=1e-3)
    assert row["slack_events"] == 0
    finer = run(replace(tow, link_joint=replace(tow.link_joint, links=88)), turn).rows[0]
    for name in ("depth_m", "tow_radius_m", "peak_gap_s"):
        assert row[name] == pytest.approx(finer[name], rel=0.01), name


def test_ship_heave_dies_from_body_to_body(tow: Configuration) -> None:
    rows = ship_heave(tow, parts=3, speed=FAST, amplitude=1.0, period=60.0)
    assert [row["body"] for row in rows] == ["vehicle", "damping-unit", "towed-body"]
    assert all(row["of_above"] < 0.5 for row in rows)
    assert rows[2]["of_ship"] == pytest.approx(rows[0]["of_above"] * rows[1]["of_above"] * rows[2]["of_above"])
