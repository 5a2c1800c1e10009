"""Positions of one fishing vessel: a CSV file of ``x, y`` in UTM metres, ``date`` and ``id``, as R writes it."""

from collections.abc import Iterable

import numpy as np

from data_synth.records.record import Record
from data_synth.records.ship_only import ship_record
from data_synth.records.table import Table
from models.quantity import InvalidInput


def is_creel(header: Iterable[str]) -> bool:
    """Whether a header line is that of such a file."""
    return {"x", "y", "date", "id"} <= set(header)


def creel_record(table: Table) -> Record:
    """The vessel's track, x east and y north as in the file, time from the first position.

    Raises
    ------
    InvalidInput
        The file has several vessels, a cell is no number or time, or the track has a long gap or a jump.
    """
    vessels = list(dict.fromkeys(table.cells("id")))
    if len(vessels) > 1:
        raise InvalidInput(
            f"{table.path} has {len(vessels)} vessels ({', '.join(vessels)}), but a record has one ship; "
            "keep the header and the rows of one."
        )
    position = np.column_stack([table.numbers("x"), table.numbers("y")])
    return ship_record(
        table.path.stem, table.instants("date"), position, table.at, (f"Vessel {vessels[0]}.",), source="creel"
    )
