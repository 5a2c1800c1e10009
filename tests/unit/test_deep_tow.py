"""The deep-tow reader on small files made by hand, and on the real ones where they are at hand."""

import os
from pathlib import Path

import numpy as np
import pytest

from data_synth.records import Record, planar, read_record, require_vehicle
from data_synth.records.deep_tow import unesco_depth
from models.quantity import InvalidInput

RECORDS = Path(__file__).parents[3] / "shared" / "records" / "deep-tow-camera"
HEADER = "Camera,FinalTime,Pres,UsblNorthing,UsblEasting,ShipNorthing,ShipEasting"


def _stamp(second: float) -> str:
    return f"2018-12-01 05:{int(second) // 60:02d}:{second % 60:06.3f}"


def _row(second: float, camera: str = "SCP", *, ship: float | None = None, vehicle: float | None = None) -> str:
    ship = 0.5 * second if ship is None else ship
    vehicle = 0.5 * second - 700.0 if vehicle is None else vehicle
    return f"{camera},{_stamp(second)},1000,{5_000_000 + vehicle},500000,{5_000_000 + ship},500010"


def _read(folder: Path, rows: list[str]) -> Record:
    path = folder / "T1.CSV"
    path.write_text("\n".join([HEADER, *rows]) + "\n")
    return read_record(path)


def test_unesco_depth_at_its_check_value() -> None:
    assert unesco_depth(10000.0, 30.0) == pytest.approx(9712.653, abs=5e-4)


def test_rows_are_sorted_merged_and_counted(tmp_path: Path) -> None:
    rows = [_row(t, camera) for t in range(0, 300, 5) for camera in ("SCP", "SCS")]
    shuffled = [*rows[40:], *rows[:40], rows[7]]
    record = _read(tmp_path, shuffled)
    assert record.source == "deep-tow"
    assert record.name == "T1"
    assert record.t.tolist() == list(range(0, 300, 5))
    assert record.ship.position[:, 1] == pytest.approx(5e6 + 0.5 * record.t)
    assert record.vehicle.position[:, 1] == pytest.approx(5e6 + 0.5 * record.t - 700.0)
    assert record.vehicle.position[:, 2] == pytest.approx(-unesco_depth(1000.0, -44.2))
    assert record.depth == pytest.approx(-record.vehicle.position[:, 2])
    assert record.notes[:3] == (
        "121 rows in 3 stretches out of time order; sorted.",
        "1 row that repeats another exactly; dropped.",
        "2 cameras merged: 60 instants from 120 rows, by their mean.",
    )


def test_rows_of_one_instant_are_averaged(tmp_path: Path) -> None:
    rows = [
        _row(t, camera, ship=0.5 * t + shift) for t in range(0, 50, 5) for camera, shift in (("A", 0.0), ("B", 0.4))
    ]
    assert _read(tmp_path, rows).ship.position[:, 1] == pytest.approx(5e6 + 0.2 + 0.5 * np.arange(0, 50, 5))


def test_a_frozen_stretch_is_noted_and_kept(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    wander = np.cumsum(rng.uniform(0.0, 3.0, 100))
    rows = [_row(5.0 * k, ship=wander[k], vehicle=wander[min(k, 60)]) for k in range(100)]
    record = _read(tmp_path, rows)
    assert len(record.vehicle) == 100
    assert record.notes == ("Vehicle: position frozen from 300 to 495 s (195 s); kept.",)


def test_a_gap_filled_with_a_straight_line_is_noted(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    x = np.cumsum(rng.uniform(0.0, 3.0, 80))
    x[30:51] = np.linspace(x[30], x[50], 21)
    record = _read(tmp_path, [_row(5.0 * k, ship=x[k], vehicle=x[k] - 600.0) for k in range(80)])
    assert record.notes == (
        (
            "Ship and vehicle: 19 of 80 positions halfway between their neighbours, as in a gap filled with a straight "
            "line, the longest run from 150 to 250 s; kept."
        ),
    )


def test_unbelievable_motion_is_noted(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    x = np.cumsum(rng.uniform(1.0, 3.0, 60))
    vehicle = x.copy()
    vehicle[20] += 100.0
    notes = _read(tmp_path, [_row(5.0 * k, ship=x[k], vehicle=vehicle[k]) for k in range(60)]).notes
    assert any(note.startswith("Vehicle: speed above 8.7 m/s 2 times, most at 100 s") for note in notes)
    assert any(note.startswith("Vehicle: acceleration above 1 m/s2 3 times") for note in notes)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([_row(0), "SCP,yesterday,1000,1,1,1,1"], r"line 3, column FinalTime: a date and time .* 'yesterday'"),
        ([_row(0), _row(5).replace(",1000,", ",deep,")], r"line 3, column Pres: a finite number .* 'deep'"),
        ([_row(0), _row(0)], "at least 2 instants"),
        ([_row(0), _row(5), _row(70)], r"line 4: no ship position for 65 s"),
        ([_row(0), _row(10), _row(5, ship=900.0)], r"line 4: the ship's position jumps, 180 m/s"),
        ([_row(0), _row(5).replace("000,", "000+00:00,", 1)], "some times have a zone"),
    ],
)
def test_bad_files_are_refused_with_the_place(tmp_path: Path, rows: list[str], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        _read(tmp_path, rows)


def _real(tow: str) -> Record:
    path = RECORDS / f"{tow}.CSV"
    if not path.exists():
        pytest.skip(f"the recorded tow {tow} is not at hand ({os.path.relpath(path)})")
    return read_record(path)


@pytest.mark.parametrize(
    ("tow", "instants", "minutes", "shallow", "deep"),
    [
        ("025", 630, 56.8, 732, 1191),
        ("026", 639, 57.2, 723, 1113),
        ("045", 437, 37.4, 1221, 1706),
        ("060", 377, 32.9, 1079, 1293),
        ("119", 238, 20.1, 1069, 1376),
        ("168", 365, 31.2, 959, 1252),
    ],
)
def test_recorded_tows_have_their_published_extent(
    tow: str, instants: int, minutes: float, shallow: float, deep: float
) -> None:
    record = _real(tow)
    assert len(record.ship) == instants
    assert record.t[-1] / 60.0 == pytest.approx(minutes, abs=0.06)
    assert record.depth.min() == pytest.approx(shallow, abs=0.6)
    assert record.depth.max() == pytest.approx(deep, abs=0.6)
    assert require_vehicle(record).valid.all()
    assert any("2 cameras merged" in note for note in record.notes)


def test_what_the_records_readme_warns_of_is_found() -> None:
    assert any("frozen from 1725" in note for note in _real("025").notes)
    assert any("noisy fixes" in note for note in _real("026").notes)
    assert any("58 of 238 positions halfway" in note for note in _real("119").notes)
    assert not any("frozen" in note or "noisy" in note for note in _real("045").notes)


@pytest.mark.parametrize(("tow", "off_axis"), [("045", True), ("060", False), ("168", False)])
def test_recorded_tows_are_planar_but_for_the_turn(tow: str, off_axis: bool) -> None:
    result = planar(_real(tow))
    assert result.ship_off_axis_rms < 0.1 * result.ship_axis_rms
    assert (result.warning is not None) == off_axis
    assert result.record.ship.position[-1, 0] > 0.0
    behind = result.record.ship.position[:, 0] - result.record.vehicle.position[:, 0]
    assert 300.0 < np.mean(behind) < 1500.0
