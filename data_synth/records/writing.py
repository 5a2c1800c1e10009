"""Writing a trace file."""

import math
import os
from pathlib import Path

import numpy as np

from data_synth.records.record import Record
from data_synth.records.trace_file import DEPTH, SECOND, SHIP, TENSION, TIME, VEHICLE, body_columns
from models.quantity import InvalidInput
from models.trace import Floats


def write_record(record: Record, path: str | Path, *, digits: int | None = None) -> None:
    """Write a record as a trace file, whole or not at all.

    Parameters
    ----------
    digits
        Significant digits; without them the file reads back to the same bits.

    Raises
    ------
    InvalidInput
        The place cannot be written to.
    """
    path = Path(path)
    header: list[str] = [TIME, *SHIP]
    columns: list[Floats] = [record.t, *record.ship.position.T]
    if record.vehicle is not None:
        header += VEHICLE
        columns += [*record.vehicle.position.T]
    if record.depth is not None:
        header.append(DEPTH)
        columns.append(record.depth)
    if record.tension is not None:
        header += TENSION
        columns += [*record.tension.T]
    for number, body in enumerate(record.bodies, start=SECOND):
        header += body_columns(number)
        columns += [*body.position.T]
    rows = np.column_stack(columns).tolist()
    write = repr if digits is None else f"{{:.{digits}g}}".format
    lines = [",".join(header), *(",".join(write(x) if math.isfinite(x) else "" for x in row) for row in rows), ""]
    try:
        _replace(path, "\n".join(lines))
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be written: {error.strerror}.") from None


def _replace(path: Path, text: str) -> None:
    """Write to a new file beside, then move it into place."""
    beside = path.parent / f".{path.name}.{os.getpid()}.part"
    try:
        beside.write_text(text, encoding="utf-8", newline="")
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)
