"""Reading a record from a file, whichever of the known formats it is in."""

import csv
from pathlib import Path

from data_synth.records.creel import creel_record, is_creel
from data_synth.records.deep_tow import deep_tow_record, is_deep_tow
from data_synth.records.nmea import is_nmea, nmea_record
from data_synth.records.record import Record
from data_synth.records.table import read_table
from data_synth.records.trace_file import trace_record


def read_record(path: str | Path) -> Record:
    """Read a trace file, a file of the deep-tow camera, a vessel's positions or a log of NMEA, known by its first line.

    Raises
    ------
    InvalidInput
        The file cannot be read as any of them; says file, line and column.
    """
    path = Path(path)
    first = _first_line(path)
    if is_nmea(first):
        return nmea_record(path)
    if is_creel(next(csv.reader([first]), [])):
        return creel_record(read_table(path, row_names=True))
    table = read_table(path)
    return deep_tow_record(table) if is_deep_tow(table.header) else trace_record(table)


def _first_line(path: Path) -> str:
    """Empty where there is none to be read: the table's reader says why."""
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            return file.readline(10_000).strip()
    except OSError:
        return ""
