"""Logs of NMEA 0183 sentences, each behind a logger's time stamp: the ship's positions from ``$..GGA``.

    2018-12-06T00:00:00.8138Z $GPGGA,000000.69,4812.030845,N,12307.411216,W,2,08,1.1,-1.44,M,-18.40,M,1.2,0001*59

The date is always the logger's: a receiver's may be wrong by 1024 weeks, or still yesterday's at midnight. The time of
day is the fix's own, since the logger's stamps come late by an uneven tenth of a second, half a metre at six knots.
"""

import math
import re
from datetime import UTC, datetime, timedelta
from functools import reduce
from operator import xor
from pathlib import Path
from typing import NamedTuple

import numpy as np

from data_synth.records.record import Record
from data_synth.records.ship_only import ship_record
from data_synth.records.ship_track import counted
from models.quantity import InvalidInput
from models.trace import Floats

_DAY = 86400.0
_WRONG_CLOCK = timedelta(hours=1)  # between a receiver's date and time and the logger's
_LINE = re.compile(r"(\S+)\s+\$([^*]*)\*([0-9A-Fa-f]{2})\s*")
_ANGLE = re.compile(r"(\d{2,3})(\d{2}(?:\.\d*)?)")
_TIME = re.compile(r"(\d{2})(\d{2})(\d{2}(?:\.\d*)?)")

# WGS84: semi-major axis [m], first eccentricity squared.
_RADIUS, _E2 = 6378137.0, 6.69437999014e-3


class Fix(NamedTuple):
    """A line's number, the logger's seconds and the fix's time of day [s], latitude and longitude [rad]."""

    line: int
    logged: float
    time_of_day: float
    latitude: float
    longitude: float


def is_nmea(first_line: str) -> bool:
    """Whether a file's first line is a sentence behind a logger's stamp."""
    return re.match(r"\d{4}-\d\d-\d\dT\S+\s+[$!][A-Z]", first_line) is not None


def nmea_record(path: Path) -> Record:
    """The ship's track, x east and y north of its first position on the plane that touches WGS84 there.

    Raises
    ------
    InvalidInput
        The file cannot be read, has no two positions, or the track has a long gap or a jump.
    """
    fixes, notes = _fixes(path)
    if len(fixes) < 2:
        raise InvalidInput(f"{path}: at least 2 positions ($..GGA) are needed, but {len(fixes)} can be read.")
    line, logged, time_of_day, latitude, longitude = (np.array(column) for column in zip(*fixes, strict=True))
    t = np.round(time_of_day + _DAY * np.round((logged - time_of_day) / _DAY), 6)
    late = logged - t
    lag = f"{late.min():.2f} to {late.max():.2f} s"
    notes.append(f"Times are the fixes' own on the logger's date; the logger stamped them {lag} later.")
    where = f"{_degrees(latitude[0], 'NS')}, {_degrees(longitude[0], 'EW')}"
    notes.append(f"Positions in metres east and north of {where}, on the sea surface.")
    return ship_record(
        path.stem,
        t,
        tangent_plane(latitude, longitude),
        lambda i: f"{path}, line {line[i]}",
        tuple(notes),
        source="nmea",
    )


def tangent_plane(latitude: Floats, longitude: Floats) -> Floats:
    """(n, 2) [m] east and north of the first of (n,) places [rad], on the plane that touches WGS84 there."""
    sin, cos = np.sin(latitude), np.cos(latitude)
    normal = _RADIUS / np.sqrt(1.0 - _E2 * sin**2)
    across, turned = normal * cos, longitude - longitude[0]
    # Earth-fixed axes with the first place on the meridian plane, each relative to it.
    out, east, up = across * np.cos(turned), across * np.sin(turned), normal * (1.0 - _E2) * sin
    north = -sin[0] * (out - out[0]) + cos[0] * (up - up[0])
    return np.column_stack([east, north])


def _fixes(path: Path) -> tuple[list[Fix], list[str]]:
    """The positions in the order of the file, and notes on what could not be used."""
    fixes, broken, without, wrong = [], 0, 0, []
    midnight: datetime | None = None
    try:
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}.") from None
    for number, line in enumerate(lines, start=1):
        if "GGA," not in line and "ZDA," not in line:
            continue
        sentence = _sentence(line)
        if sentence is None:
            broken += 1
            continue
        stamp, fields = sentence
        midnight = midnight or stamp.replace(hour=0, minute=0, second=0, microsecond=0)
        try:
            if fields[0].endswith("ZDA"):
                wrong += _wrong_clock(stamp, fields)
            elif fields[6] in ("", "0"):
                without += 1
            else:
                place = _angle(fields[2], fields[3], "NS"), _angle(fields[4], fields[5], "EW")
                fixes.append(Fix(number, (stamp - midnight).total_seconds(), _time_of_day(fields[1]), *place))
        except (ValueError, IndexError):
            broken += 1
    notes = []
    if broken:
        notes.append(f"{counted(broken, 'sentence')} broken or with a wrong checksum; left out.")
    if without:
        notes.append(f"{counted(without, 'sentence')} without a position; left out.")
    if wrong:
        several = counted(len(wrong), "sentence")
        notes.append(f"The receiver's clock was wrong in {several}, first {wrong[0]:%Y-%m-%d %H:%M:%S}; not used.")
    return fixes, notes


def _sentence(line: str) -> tuple[datetime, list[str]] | None:
    """The logger's stamp and the fields of a sentence, none if it is not whole."""
    found = _LINE.fullmatch(line)
    if not found or reduce(xor, found[2].encode(), 0) != int(found[3], 16):
        return None
    try:
        stamp = datetime.fromisoformat(found[1])
    except ValueError:
        return None
    return stamp.astimezone(UTC) if stamp.tzinfo else stamp.replace(tzinfo=UTC), found[2].split(",")


def _wrong_clock(stamp: datetime, fields: list[str]) -> list[datetime]:
    """The date and time of a ``$..ZDA`` where the logger's differs."""
    day, month, year = (int(field) for field in fields[2:5])
    clock = datetime(year, month, day, tzinfo=UTC) + timedelta(seconds=_time_of_day(fields[1]))
    return [clock] if abs(clock - stamp) > _WRONG_CLOCK else []


def _time_of_day(text: str) -> float:
    """``hhmmss.ss`` in seconds."""
    found = _TIME.fullmatch(text)
    if not found:
        raise ValueError(text)
    return 3600.0 * int(found[1]) + 60.0 * int(found[2]) + float(found[3])


def _angle(text: str, side: str, sides: str) -> float:
    """``dddmm.mmmm`` and its hemisphere in radians."""
    found = _ANGLE.fullmatch(text)
    if not found or side not in sides or not side:
        raise ValueError(text)
    degrees = int(found[1]) + float(found[2]) / 60.0
    if degrees > (90.0 if sides == "NS" else 180.0):
        raise ValueError(text)
    return math.radians(degrees if side == sides[0] else -degrees)


def _degrees(angle: float, sides: str) -> str:
    return f"{abs(math.degrees(angle)):.6f} {sides[int(angle < 0.0)]}"
