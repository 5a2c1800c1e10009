"""Reading a record from a file, whichever of the known formats it is in."""

from pathlib import Path

from data_synth.records.deep_tow import deep_tow_record, is_deep_tow
from data_synth.records.record import Record
from data_synth.records.table import read_table
from data_synth.records.trace_file import trace_record


def read_record(path: str | Path) -> Record:
    """Read a trace file, or a file of the deep-tow camera, recognised by its header.

    Raises
    ------
    InvalidInput
        The file cannot be read as either; says file, line and column.
    """
    table = read_table(Path(path))
    return deep_tow_record(table) if is_deep_tow(table.header) else trace_record(table)
