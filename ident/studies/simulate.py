"""A reference simulator on a ship's track from a file."""

from dataclasses import replace
from pathlib import Path

from data_synth.records import read_record, write_record
from ident.configuration import Configuration
from ident.places import new_file
from ident.simulators import Reference, answer
from models.drive import Start
from models.spectral import Stepper


def simulate(
    configuration: Configuration,
    *,
    ship: Path,
    out: Path,
    reference: Reference,
    links: int | None,
    tolerance: float | None,
    start: Start | None,
    stepper: Stepper | None,
) -> str:
    """Simulate and write all bodies on the ship file's own times; says in a sentence what was done.

    Raises
    ------
    InvalidInput
        The spectral simulator is to follow a track that leaves its plane, a setting is the other simulator's, or a
        file cannot be read or written.
    NumericalFailure
        The simulation fails.
    """
    with new_file(out) as temporary:
        record = read_record(ship)
        found, words = answer(
            configuration,
            replace(record, name=str(ship)),
            reference,
            links=links,
            tolerance=tolerance,
            start=start,
            stepper=stepper,
        )
        write_record(found, temporary)
    counted = "".join(f" {note}" for note in record.notes)
    return f"{out} written by {words}{counted}"
