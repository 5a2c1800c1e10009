"""The trace file: CSV with the columns ``time_s, ship_x_m, ...`` in SI units, empty cell = missing."""

import re

import numpy as np
from numpy.typing import NDArray

from data_synth.records.record import Record
from data_synth.records.ship_track import repaired_ship_track
from data_synth.records.table import Table
from models.quantity import InvalidInput
from models.trace import Floats, Trace

TIME = "time_s"
SHIP = ("ship_x_m", "ship_y_m", "ship_z_m")
VEHICLE = ("vehicle_x_m", "vehicle_y_m", "vehicle_z_m")
DEPTH = "depth_m"
TENSION = ("tension_top_N", "tension_bottom_N")
COLUMNS = (TIME, *SHIP, *VEHICLE, DEPTH, *TENSION)

#: The vehicle is the first body; the others are numbered from here on.
SECOND = 2
_BODY = re.compile(r"body_([1-9][0-9]*)_[xyz]_m")


def trace_record(table: Table) -> Record:
    """The record in a trace file.

    Raises
    ------
    InvalidInput
        A column is unknown, doubled or missing; a cell is not a finite number; time is missing or does not
        increase; the ship's track has a long gap or a jump. Says file and line.
    """
    numbers = _checked_header(table)
    t = _times(table)
    ship = _positions(table, SHIP)
    notes = []
    if numbers:
        columns = ", ".join(f"body_{number}" for number in numbers)
        notes.append(f"{len(numbers)} further bod{'y' if len(numbers) == 1 else 'ies'} not scored: {columns}.")
    kept, ship, repairs = repaired_ship_track(t, ship, table.at)
    t = t[kept]
    vehicle, depth = _vehicle(table, kept)
    if vehicle is not None:
        missing = int((~np.isfinite(vehicle).all(axis=1)).sum())
        if missing:
            notes.append(f"{missing} of {t.size} vehicle positions missing; not scored.")
    tension = None
    if any(name in table.header for name in TENSION):
        tension = np.column_stack([_optional(table, name)[kept] for name in TENSION])
    return Record(
        name=table.path.stem,
        ship=Trace(t=t, position=ship),
        vehicle=None if vehicle is None else Trace(t=t, position=vehicle),
        depth=depth,
        tension=tension,
        bodies=tuple(Trace(t=t, position=_positions(table, body_columns(number))[kept]) for number in numbers),
        notes=(*repairs, *notes),
    )


def body_columns(number: int) -> tuple[str, str, str]:
    """The columns of a further body."""
    return f"body_{number}_x_m", f"body_{number}_y_m", f"body_{number}_z_m"


def _checked_header(table: Table) -> list[int]:
    """Check the column names; the numbers of the further bodies are handed back, in order."""
    for name in table.header:
        if table.header.count(name) > 1:
            raise InvalidInput(f"{table.path}: the column {name!r} is there {table.header.count(name)} times.")
    unknown = [name for name in table.header if name not in COLUMNS and not _BODY.fullmatch(name)]
    if unknown:
        raise InvalidInput(
            f"{table.path}: unknown columns {', '.join(map(repr, unknown))}; a trace file has "
            f"{', '.join(COLUMNS)} and body_<k>_x_m, body_<k>_y_m, body_<k>_z_m."
        )
    for name in (TIME, SHIP[0]):
        if name not in table.header:
            raise InvalidInput(f"{table.path}: the column {name} is needed, but there is only {table.header}.")
    numbers = sorted({int(found[1]) for name in table.header if (found := _BODY.fullmatch(name))})
    for x, *others in (VEHICLE, *(body_columns(number) for number in numbers)):
        for name in others:
            if name in table.header and x not in table.header:
                raise InvalidInput(f"{table.path}: the column {x} is needed beside {name}.")
    return numbers


def _times(table: Table) -> Floats:
    t = table.numbers(TIME)
    missing = np.isnan(t)
    if missing.any():
        raise InvalidInput(f"{table.at(int(np.argmax(missing)))}, column {TIME}: a time is needed, but it is empty.")
    late = np.diff(t) <= 0.0
    if late.any():
        i = int(np.argmax(late)) + 1
        raise InvalidInput(
            f"{table.at(i)}, column {TIME}: time must increase, but it goes from {float(t[i - 1])!r} to "
            f"{float(t[i])!r} s; sort the record or drop the repeats."
        )
    if t.size < 2:
        raise InvalidInput(f"{table.path}: at least 2 rows are needed, but there is 1.")
    return t


def _optional(table: Table, name: str, absent: float = np.nan) -> Floats:
    return table.numbers(name) if name in table.header else np.full(len(table.rows), absent)


def _positions(table: Table, names: tuple[str, ...]) -> Floats:
    """(n, 3) [m]; a column that is not there is zero, a row with an empty cell is missing as a whole."""
    position = np.column_stack([_optional(table, name, 0.0) for name in names])
    position[~np.isfinite(position).all(axis=1)] = np.nan
    return position


def _vehicle(table: Table, kept: slice) -> tuple[Floats | None, Floats | None]:
    """Vehicle positions (k, 3) and depth (k,); each stands in for the other's vertical where it is absent."""
    depth = _optional(table, DEPTH)[kept] if DEPTH in table.header else None
    if VEHICLE[0] not in table.header:
        return None, depth
    columns: list[NDArray[np.float64]] = [_optional(table, name, 0.0)[kept] for name in VEHICLE]
    if depth is None and VEHICLE[2] in table.header:
        depth = -columns[2]
    elif depth is not None:
        measured = VEHICLE[2] in table.header
        columns[2] = np.where(np.isnan(columns[2]), -depth, columns[2]) if measured else -depth
    vehicle = np.column_stack(columns)
    vehicle[~np.isfinite(vehicle).all(axis=1)] = np.nan
    return vehicle, depth
