"""What drives a sea study: the spectrum by a formula or from a file, and the vessel in it."""

from dataclasses import dataclass
from pathlib import Path

from data_synth.rao import Rao, read_rao
from data_synth.records.spectra import read_spectrum
from data_synth.records.text import read_text
from data_synth.spectra import FORMS, SeaState, Spectrum
from models.quantity import InvalidInput
from models.transfer_matrix import Direction


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ChosenSea:
    """The spectrum to compute with, what it is, and what there is to say of it."""

    spectrum: Spectrum
    label: str
    notes: tuple[str, ...]


def choose_sea(
    spectrum: str, height: float | None, peak_period: float | None, record: str | None, points: int
) -> ChosenSea:
    """The spectrum by its formula or from its file.

    Raises
    ------
    InvalidInput
        A height, period or record is missing or has no place here, or the file holds no such spectrum.
    """
    for form in FORMS:
        if spectrum != form:
            continue
        if height is None or peak_period is None:
            raise InvalidInput(
                f"The form {form} needs a significant height [m] and the period of its peak [s], but "
                f"{'neither' if height is None and peak_period is None else 'only one'} is given."
            )
        if record is not None:
            raise InvalidInput(f"The form {form} has no records to choose from; leave out the record {record!r}.")
        state = SeaState(height=height, peak_period=peak_period)
        label = f"{form.capitalize() if form == 'bretschneider' else 'JONSWAP'} of {height:g} m and {peak_period:g} s"
        return ChosenSea(spectrum=state.spectrum(form, points=points), label=label, notes=())
    if height is not None or peak_period is not None:
        raise InvalidInput(
            f"The spectrum {spectrum} is a file with a height and a period of its own; leave those out, or take one of "
            f"the forms {', '.join(FORMS)}."
        )
    read = read_spectrum(spectrum, record)
    label = Path(spectrum).name + (f", {read.record}" if read.record else "")
    return ChosenSea(spectrum=read.spectrum.resampled(points), label=label, notes=read.notes)


def choose_vessel(rao: Path | None, direction: Direction, spectrum: Spectrum) -> Rao | None:
    """The vessel, where the sea lies inside its table.

    Raises
    ------
    InvalidInput
        The file is no RAO, it does not cover the sea, or the direction is not one of a vessel.
    """
    if rao is None:
        return None
    if direction == "surge":
        raise InvalidInput(
            "With an RAO the cable's top moves as the vessel does (heave), or by its heave along the cable (axial); "
            "surge is a column of the RAO."
        )
    vessel = read_rao(rao)
    vessel.check(spectrum)
    return vessel


def top_motion(rao: Path | None, direction: Direction) -> str:
    """How the cable's top moves, in words."""
    if rao is None:
        way = {"axial": "along the cable", "heave": "up and down", "surge": "to and fro"}[direction]
        return f"The cable's top follows the wave itself {way}; the vessel's own response is taken as one."
    if direction == "axial":
        return f"The cable's top moves along the cable as the vessel of {rao.name} heaves.{_said(rao)}"
    return f"The cable's top moves as the vessel of {rao.name} does.{_said(rao)}"


def _said(rao: Path) -> str:
    """What the table of an RAO says of itself in its first line, where that is a comment."""
    first = read_text(rao).splitlines()[0].strip()
    return f" The table is headed: {first.lstrip('# ')}" if first.startswith("#") else ""
