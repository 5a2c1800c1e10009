"""Readers of ships without a vehicle: small files made by hand, and the real ones where they are at hand."""

import math
from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np
import pytest

from data_synth.records import Record, read_record
from data_synth.records.nmea import tangent_plane
from data_synth.records.ship_only import hardness
from models.quantity import InvalidInput

SHIP = Path(__file__).parents[3] / "shared" / "records" / "ship"


def _line(stamp: str, body: str) -> str:
    return f"{stamp} ${body}*{reduce(xor, body.encode(), 0):02X}"


def _gga(second: float, north: float, *, lag: float = 0.3, quality: int = 1, day: int = 6) -> str:
    """A fix at 48 degrees north, so many minutes of arc north of it, at a time of 2018-12-06."""
    clock, logged = second % 86400.0, second + lag
    stamp = f"2018-12-{day + int(logged // 86400):02d}T{_clock(logged % 86400.0, ':')}Z"
    return _line(
        stamp, f"GPGGA,{_clock(clock)},48{north:09.6f},N,12307.411216,W,{quality},08,1.1,-1.44,M,-18.40,M,1.2,0001"
    )


def _clock(second: float, colon: str = "") -> str:
    return colon.join([f"{int(second) // 3600:02d}", f"{int(second) // 60 % 60:02d}", f"{second % 60.0:05.2f}"])


def _read(folder: Path, lines: list[str], name: str = "log-2018-12-06") -> Record:
    path = folder / name
    path.write_text("\n".join(lines) + "\n")
    return read_record(path)


def _straight(**kwargs: float) -> list[str]:
    return [_gga(100.0 + k, 0.002 * k, **kwargs) for k in range(60)]


def test_fixes_become_metres_and_seconds(tmp_path: Path) -> None:
    record = _read(tmp_path, ["2018-12-06T00:01:39.900Z $GPHDT,92.05,T*3B", *_straight()])
    assert record.source == "nmea"
    assert record.name == "log-2018-12-06"
    assert record.vehicle is None
    assert record.t.tolist() == list(range(60))
    # A minute of arc along the meridian at 48 degrees is 1853.17 m.
    assert record.ship.position == pytest.approx(np.outer(range(60), [0.0, 0.002 * 1853.17, 0.0]), abs=2e-3)
    assert record.notes == (
        "Times are the fixes' own on the logger's date; the logger stamped them 0.30 to 0.30 s later.",
        "Positions in metres east and north of 48.000000 N, 123.123520 W, on the sea surface.",
    )


def test_uneven_logging_moves_no_fix(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    lines = [_gga(100.0 + k, 0.002 * k, lag=float(rng.uniform(0.1, 0.9))) for k in range(60)]
    assert _read(tmp_path, lines).t.tolist() == list(range(60))


def test_midnight_is_passed(tmp_path: Path) -> None:
    lines = [_gga(86380.5 + k, 0.002 * k, lag=0.9) for k in range(40)]
    assert _read(tmp_path, lines).t.tolist() == list(range(40))


def test_a_wrong_date_is_not_used(tmp_path: Path) -> None:
    zda = [
        _line("2018-12-06T00:01:40.1Z", "GPZDA,000140.00,22,04,1999,00,00"),
        _line("2018-12-06T00:01:41.1Z", "GPZDA,000141.00,06,12,2018,00,00"),
    ]
    record = _read(tmp_path, zda + _straight())
    assert record.t.tolist() == list(range(60))
    assert record.notes[0] == "The receiver's clock was wrong in 1 sentence, first 1999-04-22 00:01:40; not used."


def test_what_cannot_be_used_is_counted(tmp_path: Path) -> None:
    lines = _straight()
    lines[5] = lines[5].replace("12307", "12308")
    lines[8] = _line("2018-12-06T00:01:48.3Z", "GPGGA,000148.00,4899.0,N,12307.4,W")
    lines[9] = lines[9][:50]
    lines[10] = _gga(110.0, 0.0, quality=0)
    lines[20] = lines[19]
    record = _read(tmp_path, lines)
    assert len(record.ship) == 55
    assert record.notes[:2] == (
        "3 sentences broken or with a wrong checksum; left out.",
        "1 sentence without a position; left out.",
    )
    assert record.notes[4] == "1 position at or before the time of an earlier one; dropped."
    assert record.notes[5] == "1 gap in time bridged by the ship's spline, longest 4 s."


def test_a_single_jump_is_bridged_and_a_lasting_one_refused(tmp_path: Path) -> None:
    lines = _straight()
    lines[30] = _gga(130.0, 0.1)
    record = _read(tmp_path, lines)
    assert record.ship.position[30, 1] == pytest.approx(30 * 0.002 * 1853.2, abs=0.01)
    assert record.notes[2:] == (
        "1 position out of the track and back by a jump; taken as missing.",
        "1 missing ship position interpolated, longest gap 2 s.",
    )
    lines[31:] = [_gga(131.0 + k, 0.1) for k in range(29)]
    with pytest.raises(InvalidInput, match=r"log-2018-12-06, line 31: the ship's position jumps"):
        _read(tmp_path, lines)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (_straight()[:1], "at least 2 positions .* but 1 can be read"),
        (["2018-12-06T00:01:39.900Z $GPHDT,92.05,T*3B"], "but 0 can be read"),
        ([*_straight()[:20], *(_gga(300.0 + k, 0.1) for k in range(9))], "line 21: no ship position for 181 s"),
    ],
)
def test_logs_without_a_track_are_refused(tmp_path: Path, lines: list[str], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        _read(tmp_path, lines)


def test_noise_is_smoothed_only_as_far_as_needed(tmp_path: Path) -> None:
    noise = np.random.default_rng(2).standard_normal(60)
    quiet, rough = (
        _read(tmp_path, [_gga(100.0 + k, 0.1 + 0.002 * k + level * noise[k]) for k in range(60)])
        for level in (1e-6, 2e-4)
    )
    assert not any("smoothed" in note for note in quiet.notes)
    assert "Ship smoothed, its acceleration reached" in rough.notes[-1]
    assert 0.99 < hardness(rough.t, rough.ship.position).max() <= 1.0


def test_the_tangent_plane_keeps_distances_and_directions() -> None:
    latitude, longitude = np.radians([-22.0, -22.0, -21.99]), np.radians([-18.0, -17.99, -18.0])
    east, north = tangent_plane(latitude, longitude).T
    # Arcs of the parallel and the meridian with the radii of curvature of WGS84.
    sin, cos = math.sin(math.radians(22.0)), math.cos(math.radians(22.0))
    a, e2 = 6378137.0, 6.69437999014e-3
    normal, meridian = a / math.sqrt(1 - e2 * sin**2), a * (1 - e2) / (1 - e2 * sin**2) ** 1.5
    assert east == pytest.approx([0.0, normal * cos * math.radians(0.01), 0.0], abs=1e-3)
    assert north == pytest.approx([0.0, 0.0, meridian * math.radians(0.01)], abs=0.05)
    assert north[1] == pytest.approx(-(east[1] ** 2) * sin / cos / (2 * normal), abs=1e-3)  # the parallel bends south


VESSEL = ['"x","y","date","id","behaviour","ID"'] + [
    f'"{900 + k}",{434000.0 + 100.0 * k},{6451000.0 - 50.0 * k},"2017-05-19 06:{k:02d}:28","AR9","steaming","AR9"'
    for k in range(30)
]


@pytest.mark.parametrize("named", [True, False])
def test_a_vessel_with_or_without_names_of_rows(tmp_path: Path, named: bool) -> None:
    lines = VESSEL if named else [VESSEL[0], *(line.split(",", 1)[1] for line in VESSEL[1:])]
    record = _read(tmp_path, lines, "vessel.csv")
    assert record.source == "creel"
    assert record.t.tolist() == [60.0 * k for k in range(30)]
    assert record.ship.position[-1].tolist() == [436900.0, 6449550.0, 0.0]
    assert record.notes == ("Vessel AR9.",)


def test_several_vessels_and_long_gaps_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"2 vessels \(AR9, AR8\)"):
        _read(tmp_path, [*VESSEL, VESSEL[-1].replace("AR9", "AR8")], "two.csv")
    with pytest.raises(InvalidInput, match=r"gap.csv, line 11: no ship position for 120 s"):
        _read(tmp_path, VESSEL[:10] + VESSEL[11:], "gap.csv")


def _real(*parts: str) -> Path:
    path = SHIP.joinpath(*parts)
    if not path.is_file():
        pytest.skip(f"{path} is not at hand")
    return path


@pytest.mark.parametrize(
    ("path", "seconds", "turned"),
    [
        ("palmer/NBP1406_PCOD-2014-08-01", 999.0, 21.6),
        ("palmer/NBP1406_s330-2014-08-01", 624.0, 19.6),
        ("palmer/NBP1406_seap-2014-08-01", 713.9, 19.8),
        ("sikuliaq/SKQ201822S_gnss_cnav-2018-12-06", 712.0, 32.3),
        ("sikuliaq/SKQ201822S_ins_seapath_position-2018-12-06", 499.0, 20.3),
    ],
)
def test_real_logs_drive_a_cable(path: str, seconds: float, turned: float) -> None:
    record = read_record(_real(*path.split("/")))
    assert record.t[0] == 0.0
    assert record.t[-1] == pytest.approx(seconds, abs=1e-9)
    assert np.diff(record.t) == pytest.approx(1.0, abs=0.011)
    velocity = record.ship.rates()
    assert 3.0 < np.linalg.norm(velocity, axis=1).min() < np.linalg.norm(velocity, axis=1).max() < 7.0
    assert np.degrees(np.ptp(np.arctan2(velocity[:, 1], velocity[:, 0]))) == pytest.approx(turned, abs=0.2)
    assert hardness(record.t, record.ship.position).max() <= 1.0
    assert any("clock was wrong" in note for note in record.notes) == ("PCOD" in path or "cnav" in path)
    assert any("smoothed" in note for note in record.notes) == ("PCOD" in path)


def test_two_sensors_of_one_ship_agree_at_the_fixes_own_times() -> None:
    s330, seapath = (read_record(_real("palmer", f"NBP1406_{name}-2014-08-01")).ship for name in ("s330", "seap"))
    t = np.arange(20.0, 600.0)
    # The first fixes are at 0.16 and 0.70 s past midnight.
    apart = {
        lag: float(np.std(seapath.spline(t + lag, 1) - s330.spline(t + 0.54, 1), axis=0).max())
        for lag in (-0.2, 0.0, 0.2)
    }
    assert apart[0.0] < 0.05  # m/s
    assert apart[0.0] == min(apart.values())


def test_a_real_vessel_turns_many_times(tmp_path: Path) -> None:
    lines = _real("creel", "creel_tracks.csv").read_text().splitlines()
    record = _read(tmp_path, [lines[0], *(line for line in lines if '"AR004"' in line)], "AR004.csv")
    assert len(record.ship) == 510
    velocity = record.ship.rates()
    course = np.unwrap(np.arctan2(velocity[:, 1], velocity[:, 0]))
    assert np.ptp(course) > 4.0 * math.pi
    with pytest.raises(InvalidInput, match="5 vessels"):
        read_record(SHIP / "creel" / "creel_tracks.csv")
