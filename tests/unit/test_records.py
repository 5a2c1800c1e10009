"""Trace files: what is read, repaired, counted and refused, and that writing loses nothing."""

from pathlib import Path

import numpy as np
import pytest

from data_synth.records import Record, join, planar, read_record, require_vehicle, write_record
from models.quantity import InvalidInput
from models.trace import Trace


def _write(folder: Path, text: str, name: str = "tow.csv") -> Path:
    path = folder / name
    path.write_bytes(text.encode())
    return path


def _ship_only(folder: Path, rows: list[str], header: str = "time_s,ship_x_m") -> Path:
    return _write(folder, "\n".join([header, *rows]) + "\n")


def test_every_column_is_read(tmp_path: Path) -> None:
    header = (
        "time_s,ship_x_m,ship_y_m,ship_z_m,vehicle_x_m,vehicle_y_m,vehicle_z_m,depth_m,tension_top_N,tension_bottom_N"
    )
    record = read_record(_ship_only(tmp_path, ["0,1,2,3,4,5,-6,6.5,7e3,8e3", "1,2,3,4,5,6,-7,,,"], header))
    assert record.name == "tow"
    assert record.source == "trace"
    assert record.ship.position.tolist() == [[1, 2, 3], [2, 3, 4]]
    assert record.vehicle.position.tolist() == [[4, 5, -6], [5, 6, -7]]
    assert record.depth[0] == 6.5
    assert np.isnan(record.depth[1])
    assert record.tension[0].tolist() == [7000, 8000]
    assert np.isnan(record.tension[1]).all()
    assert record.notes == ()


def test_the_least_file_has_time_and_ship_x(tmp_path: Path) -> None:
    record = read_record(_ship_only(tmp_path, ["0,1", "1,2", "2.5,4"]))
    assert record.t.tolist() == [0, 1, 2.5]
    assert record.ship.position.tolist() == [[1, 0, 0], [2, 0, 0], [4, 0, 0]]
    assert record.vehicle is None
    assert record.depth is None
    assert record.tension is None


def test_depth_and_vertical_stand_in_for_each_other(tmp_path: Path) -> None:
    by_depth = read_record(_ship_only(tmp_path, ["0,0,1,700", "1,0,1,701"], "time_s,ship_x_m,vehicle_x_m,depth_m"))
    assert by_depth.vehicle.position[:, 2].tolist() == [-700, -701]
    by_z = read_record(_ship_only(tmp_path, ["0,0,1,-700", "1,0,1,-701"], "time_s,ship_x_m,vehicle_x_m,vehicle_z_m"))
    assert by_z.depth.tolist() == [700, 701]


def test_text_editors_leave_no_trace(tmp_path: Path) -> None:
    text = "\ufefftime_s, ship_x_m\r\n0, 1\r\n1, 2\r\n\r\n2,3\r\n\r\n\r\n"
    record = read_record(_write(tmp_path, text))
    assert record.ship.position[:, 0].tolist() == [1, 2, 3]


def test_missing_vehicle_cells_are_gaps_and_counted(tmp_path: Path) -> None:
    rows = ["0,0,1,2,-3", "1,0,,,", "2,0,1,,-3", "3,0,1,2,-3"]
    record = read_record(_ship_only(tmp_path, rows, "time_s,ship_x_m,vehicle_x_m,vehicle_y_m,vehicle_z_m"))
    assert record.vehicle.valid.tolist() == [True, False, False, True]
    assert record.notes == ("2 of 4 vehicle positions missing; not scored.",)


def test_short_ship_gaps_are_interpolated_and_counted(tmp_path: Path) -> None:
    rows = [f"{k},{'' if k in (4, 5, 9) else 0.5 * k}" for k in range(20)]
    record = read_record(_ship_only(tmp_path, rows))
    assert record.ship.position[:, 0] == pytest.approx(0.5 * np.arange(20))
    assert record.notes == ("3 missing ship positions interpolated, longest gap 3 s.",)


def test_gaps_in_time_are_counted(tmp_path: Path) -> None:
    rows = [f"{t},{0.5 * t}" for t in (0, 1, 2, 3, 63, 64, 65, 66)]
    assert read_record(_ship_only(tmp_path, rows)).notes == (
        "1 gap in time bridged by the ship's spline, longest 60 s.",
    )


@pytest.mark.parametrize(
    "rows", [["0,0", "1,1", "62,2", "63,3"], ["0,0", "1,1", *(f"{k}," for k in range(2, 62)), "62,3"]]
)
def test_long_ship_gaps_are_refused_with_the_place(tmp_path: Path, rows: list[str]) -> None:
    line = 4 if len(rows) == 4 else 64
    with pytest.raises(InvalidInput, match=rf"tow\.csv, line {line}: no ship position for 61 s, from 1 to 62 s"):
        read_record(_ship_only(tmp_path, rows))


def test_rows_outside_the_ships_track_are_left_out_and_counted(tmp_path: Path) -> None:
    rows = ["0,,1", "1,1,1", "2,2,1", "3,,1", "4,,1"]
    record = read_record(_ship_only(tmp_path, rows, "time_s,ship_x_m,vehicle_x_m"))
    assert record.t.tolist() == [1, 2]
    assert len(record.vehicle) == 2
    assert record.notes == ("3 rows before the first or after the last ship position left out.",)


def test_a_speed_jump_is_fine_and_a_position_jump_is_not(tmp_path: Path) -> None:
    read_record(_ship_only(tmp_path, ["0,0", "1,0", "2,5", "3,10"]))
    with pytest.raises(InvalidInput, match=r"line 4: the ship's position jumps, 20 m/s"):
        read_record(_ship_only(tmp_path, ["0,0", "1,0", "2,20", "3,20"]))


def test_further_bodies_are_handed_back_in_order_and_noted(tmp_path: Path) -> None:
    header = "time_s,ship_x_m,body_10_x_m,body_2_x_m,body_2_z_m"
    record = read_record(_ship_only(tmp_path, ["0,0,5,1,-7", "1,1,6,2,", "2,2,7,3,-9"], header))
    assert record.notes == ("2 further bodies not scored: body_2, body_10.",)
    second, tenth = record.bodies
    assert second.position[:, 0].tolist()[::2] == [1.0, 3.0]
    assert second.valid.tolist() == [True, False, True]
    assert tenth.position.tolist() == [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [7.0, 0.0, 0.0]]
    with pytest.raises(InvalidInput, match="the column body_2_x_m is needed beside body_2_z_m"):
        read_record(_ship_only(tmp_path, ["0,0,1", "1,1,1"], "time_s,ship_x_m,body_2_z_m"))
    other = Trace.along_x([0.0, 2.0], [0.0, 1.0])
    with pytest.raises(InvalidInput, match="same times"):
        Record(name="a", ship=Trace.along_x([0.0, 1.0], [0.0, 1.0]), bodies=(other,))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("\n\n", "empty"),
        ("time_s,ship_x_m\n", "only a header line"),
        ("time_s,ship_x_m\n0,1\n", "at least 2 rows"),
        ("time_s,ship_x_m\n0,1\n1,a\n", r"line 3, column ship_x_m: a finite number .* holds 'a'"),
        ("time_s,ship_x_m\n0,1\n1,nan\n", r"line 3, column ship_x_m: .* holds 'nan'"),
        ("time_s,ship_x_m\n0,1\n1,-inf\n", r"line 3, column ship_x_m: .* holds '-inf'"),
        ("time_s,ship_x_m\n0,1\n1,1_0\n", r"line 3, column ship_x_m: .* holds '1_0'"),
        ("time_s,ship_x_m\n0,1\n1,1e999\n", r"line 3, column ship_x_m: .* holds '1e999'"),
        (
            "time_s,ship_x_m\n0,1\n\n1,1\n1,2\n",
            r"line 5, column time_s: time must increase, but it goes from 1\.0 to 1\.0",
        ),
        ("time_s,ship_x_m\n0,1\n,1\n", r"line 3, column time_s: a time is needed"),
        ("time_s,ship_x_m\n0,1\n1\n", r"line 3: 2 cells are needed, but it has 1"),
        ("time_s,ship_x_m\n0,\n1,\n", r"line 2: a ship's track needs at least 2 positions, but has 0"),
        ("time_s,ship_x\n0,1\n1,1\n", r"unknown columns 'ship_x'; a trace file has time_s, ship_x_m"),
        ("time_s,ship_x_m,\n0,1,\n1,1,\n", "unknown columns ''"),
        ("time_s,ship_y_m\n0,1\n1,1\n", "column ship_x_m is needed"),
        ("ship_x_m\n0\n1\n", "column time_s is needed"),
        ("time_s,ship_x_m,vehicle_z_m\n0,1,1\n1,1,1\n", "column vehicle_x_m is needed beside vehicle_z_m"),
        ("time_s,ship_x_m,ship_x_m\n0,1,1\n1,1,1\n", "'ship_x_m' is there 2 times"),
        ("time_s;ship_x_m\n0;1\n1;1\n", "unknown columns"),
        ('time_s,ship_x_m\n0,"1\n', "not a CSV file"),
    ],
)
def test_bad_files_are_refused_in_words(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InvalidInput, match=message) as error:
        read_record(_write(tmp_path, text))
    assert str(error.value).startswith(str(tmp_path / "tow.csv"))
    assert "\n" not in str(error.value)


def test_what_is_no_text_file_is_refused_in_words(tmp_path: Path) -> None:
    (tmp_path / "binary.csv").write_bytes(bytes(range(256)))
    (tmp_path / "zeros.csv").write_bytes(b"time_s,ship_x_m\n0,\0\n1,1\n")
    (tmp_path / "wide.csv").write_bytes("time_s,ship_x_m\n0,1\n1,1\n".encode("utf-16"))
    for name in ("binary.csv", "zeros.csv", "wide.csv"):
        with pytest.raises(InvalidInput, match=r"not text|finite number|not a CSV"):
            read_record(tmp_path / name)
    with pytest.raises(InvalidInput, match="no such file"):
        read_record(tmp_path / "absent.csv")
    with pytest.raises(InvalidInput, match="this is a folder"):
        read_record(tmp_path)


def test_a_vehicle_is_required_where_it_is_scored(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="has no vehicle"):
        require_vehicle(read_record(_ship_only(tmp_path, ["0,0", "1,1"])))
    rows = [f"{k},0,{k if k < 19 else ''}" for k in range(30)]
    record = read_record(_ship_only(tmp_path, rows, "time_s,ship_x_m,vehicle_x_m"))
    with pytest.raises(InvalidInput, match="has 19 vehicle fixes, but at least 20 are needed"):
        require_vehicle(record)
    assert require_vehicle(record, 19) is record.vehicle


def test_writing_into_nothing_is_refused_and_leaves_nothing(tmp_path: Path) -> None:
    record = join("tow", Trace.along_x([0.0, 1.0], [0.0, 1.0]))
    folder = tmp_path / "folder"
    folder.mkdir()
    for place in (tmp_path / "absent" / "tow.csv", folder):
        with pytest.raises(InvalidInput, match="cannot be written"):
            write_record(record, place)
    assert list(tmp_path.iterdir()) == [folder]
    assert list(folder.iterdir()) == []


def test_writing_replaces_a_file_whole(tmp_path: Path) -> None:
    path = _write(tmp_path, "something longer than what comes after it" * 100)
    write_record(join("tow", Trace.along_x([0.0, 1.0], [0.0, 1.0])), path)
    assert path.read_text() == "time_s,ship_x_m,ship_y_m,ship_z_m\n0.0,0.0,0.0,0.0\n1.0,1.0,0.0,0.0\n"
    assert [file.name for file in tmp_path.iterdir()] == ["tow.csv"]


def test_join_puts_fixes_among_the_ships_times() -> None:
    t = np.arange(0.0, 101.0)
    ship = Trace.along_x(t, 0.5 * t)
    vehicle = Trace(t=[0.0, 10.0, 22.5], position=[[1, 0, -7], [2, 0, -8], [3, 0, -9]], tension=[[3, 2]] * 3)
    record = join("tow", ship, vehicle)
    assert record.t.size == 102
    assert record.vehicle.valid.sum() == 3
    assert record.vehicle.position[record.t == 22.5].tolist() == [[3, 0, -9]]
    assert record.ship.position[:, 0] == pytest.approx(0.5 * record.t)
    assert record.depth[record.t == 10.0] == 8.0
    assert record.tension[record.t == 22.5].tolist() == [[3, 2]]
    assert join("tow", ship, Trace.along_x(t, t)).ship is ship


@pytest.mark.parametrize("seed", range(5))
def test_join_keeps_the_ships_own_positions_to_the_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    t = np.sort(rng.uniform(0.0, 500.0, 200))
    ship = Trace(t=t, position=5e6 + np.cumsum(rng.standard_normal((200, 3)), axis=0))
    record = join("tow", ship, Trace.along_x([100.0, 200.0], [0.0, 1.0]))
    assert np.array_equal(record.ship.position[np.isin(record.t, t)], ship.position)


def test_join_takes_times_that_differ_in_the_last_digit_for_one() -> None:
    t = 0.1 * np.arange(201)
    fixes = 0.3 * np.arange(67)
    assert not np.isin(fixes, t).all()
    record = join("tow", Trace.along_x(t, 0.5 * t), Trace.along_x(fixes, 0.5 * fixes))
    assert np.array_equal(record.t, t)
    assert record.vehicle.valid.sum() == 67


def test_join_does_not_guess_the_ship() -> None:
    ship = Trace.along_x([0.0, 1.0], [0.0, 1.0])
    with pytest.raises(InvalidInput, match="outside the ship's 0 to 1 s"):
        join("tow", ship, Trace.along_x([0.0, 2.0], [0.0, 1.0]))


def test_a_record_keeps_its_shapes() -> None:
    ship = Trace.along_x([0.0, 1.0], [0.0, 1.0])
    with pytest.raises(InvalidInput, match="same times"):
        Record(name="a", ship=ship, vehicle=Trace.along_x([0.0, 2.0], [0.0, 1.0]))
    with pytest.raises(InvalidInput, match=r"Record\.depth needs the shape \(2,\)"):
        Record(name="a", ship=ship, depth=np.zeros(3))
    with pytest.raises(InvalidInput, match="position at every time"):
        Record(name="a", ship=Trace.along_x([0.0, 1.0], [0.0, np.nan]))


def test_a_record_along_x_is_left_alone() -> None:
    t = np.arange(0.0, 100.0)
    ship = Trace.along_x(t, 500.0 - 0.3 * t)
    result = planar(join("tow", ship, Trace.along_x(t, 480.0 - 0.3 * t, -700.0)))
    assert result.angle == 0.0
    assert np.array_equal(result.record.ship.position, ship.position)
    assert result.off_plane == 0.0
    assert result.warning is None


def test_a_turn_is_measured_and_warned_of() -> None:
    t = np.arange(0.0, 100.0)
    position = np.column_stack([1e5 + 3.0 * t, 5e6 + 4.0 * t + 40.0 * np.sin(0.3 * t), 0.0 * t])
    result = planar(join("bend", Trace(t=t, position=position)))
    assert result.angle == pytest.approx(np.arctan2(4.0, 3.0), abs=0.05)
    assert result.ship_off_axis_rms == pytest.approx(40.0 / np.sqrt(2.0) * 0.6, rel=0.1)
    assert result.off_plane > 20.0
    assert result.warning is None
    tighter = planar(
        join("bend", Trace(t=t, position=position * [0.2, 0.2, 1.0] + [0.0, 30.0, 0.0] * np.sin(0.3 * t[:, None])))
    )
    assert "above 20 %" in tighter.warning


def test_a_ship_that_stays_has_no_direction() -> None:
    position = np.tile([5e5, 5e6, 0.0], (10, 1))
    result = planar(join("hove-to", Trace(t=np.arange(10.0), position=position)))
    assert result.angle == 0.0
    assert not result.record.ship.position.any()
    assert result.warning is None
