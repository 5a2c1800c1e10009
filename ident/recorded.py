"""Records from files as cases: projected on the ship's direction, and read through the operator they were made with."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from data_synth.records import PlanarRecord, planar, read_record, require_vehicle
from ident.cases import Case, case_from_fixes, case_from_truth
from models.drive import Start
from models.quantity import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RecordedCase:
    """A record in its plane, and as a case to fit or score."""

    planar: PlanarRecord
    case: Case

    @property
    def notes(self) -> tuple[str, ...]:
        """What was counted or repaired on reading, and what to doubt, a line each."""
        record, warning = self.planar.record, self.planar.warning
        return tuple(f"{self.case.name}: {note}" for note in (*record.notes, *((warning,) if warning else ())))


def distinct(paths: Sequence[Path]) -> None:
    """Refuse records that a table could not tell apart, and one given twice, which would count as two.

    Raises
    ------
    InvalidInput
        Two paths have one name.
    """
    names = [path.name for path in paths]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InvalidInput(
            f"Records are told apart by their file names, but {', '.join(twice)} is there more than once; "
            "drop one or rename it."
        )


def recorded_case(path: Path, *, settle: float, window: float, start: Start) -> RecordedCase:
    """Read a record, the vehicle's included.

    Parameters
    ----------
    settle
        Time from the record's start that is not scored [s].
    window
        Length of the differentiator's window [s]; 0 compares with the derivative of the record's own spline, for
        records without noise.

    Raises
    ------
    InvalidInput
        The file is no record, has no vehicle, or leaves fewer than 20 scored samples.
    """
    record = planar(read_record(path))
    vehicle = require_vehicle(record.record)
    ship, name = record.record.ship, path.name
    if window == 0.0:
        case = case_from_truth(name, ship, vehicle, settle, start=start)
    else:
        smoothed = record.record.source == "deep-tow"
        case = case_from_fixes(name, ship, vehicle, settle, window=window, smoother=smoothed, start=start)
    return RecordedCase(planar=record, case=case)
