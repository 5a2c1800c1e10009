"""Reading a wave spectrum from a file, whichever of the known formats it is in."""

import json
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from data_synth.records.ndbc import Found, bin_widths, is_densities, is_summary, read_densities, read_summary
from data_synth.records.text import numbered_lines, read_columns, read_text
from data_synth.spectra import Spectrum
from models.quantity import InvalidInput

#: Headers of a plain table and what turns the first column into [rad/s].
_TABLES = {
    ("omega_rad_s", "density_m2_s_rad"): 1.0,
    ("frequency_Hz", "density_m2_Hz"): 2.0 * np.pi,
}
_KNOWN = (
    f"a table with the columns {' or '.join(', '.join(pair) for pair in _TABLES)}, NDBC's spectral densities (.txt, "
    ".txt.gz) or summary (.spec), and JSON with the densities [m2/Hz] of named spectra by frequency [Hz] under S"
)


def read_spectrum(path: str | Path, record: str | None = None) -> Found:
    """Read a spectrum; of a file that has several the highest, unless one is asked for.

    Parameters
    ----------
    record
        Date and time such as ``1996-12-04 13:00`` in NDBC's files, a name in JSON; a plain table has one alone.

    Raises
    ------
    InvalidInput
        The file cannot be read or is of another format, there is no such record, all are fill values, or the
        spectrum is none: zero or disordered frequencies, negative densities, no energy.
    """
    path = Path(path)
    text = read_text(path)
    try:
        return _read(path, text, record)
    except InvalidInput as error:
        if str(error).startswith(str(path)):
            raise
        raise InvalidInput(f"{path}: {error}") from None


def _read(path: Path, text: str, record: str | None) -> Found:
    if text.lstrip().startswith("{"):
        return _from_json(path, text, record)
    # The first line of NDBC's files may begin with the mark of a comment.
    first = next(line for line in text.splitlines() if line.strip())
    for known, read in ((is_densities, read_densities), (is_summary, read_summary)):
        if known(first.split()):
            return read(path, [(0, first), *_rows(text, first)], _instant(record))
    lines = numbered_lines(text)
    header = tuple(cell.strip() for cell in lines[0][1].split(",")) if lines else ()
    for columns, scale in _TABLES.items():
        if set(columns) & set(header):
            if record is not None:
                raise InvalidInput(f"{path}: a plain table has one spectrum; leave out the record {record!r}.")
            table = read_columns(path, text, columns)
            spectrum = Spectrum(omega=scale * table[columns[0]], density=table[columns[1]] / scale)
            return Found(spectrum=spectrum, record="", notes=())
    raise InvalidInput(f"{path}: not a spectrum of a known format; known are {_KNOWN}.")


def _rows(text: str, header: str) -> list[tuple[int, str]]:
    """The numbered rows below the header, comments and units left out."""
    return [(i, line) for i, line in numbered_lines(text) if line != header.strip()]


def _instant(record: str | None) -> datetime | None:
    if record is None:
        return None
    try:
        return datetime.fromisoformat(record.removesuffix("Z")).replace(tzinfo=None)
    except ValueError:
        raise InvalidInput(
            f"A record is chosen by its date and time, such as 1996-12-04 13:00, but {record!r} was given."
        ) from None


def _from_json(path: Path, text: str, record: str | None) -> Found:
    """``{name: {"S": {frequency: density}, "freqBinWidth": {frequency: width}}}``, the widths optional."""
    try:
        content = json.loads(text)
    except json.JSONDecodeError as error:
        raise InvalidInput(f"{path}, line {error.lineno}: not JSON: {error.msg}.") from None
    named = {str(name): each for name, each in content.items() if isinstance(each, Mapping) and "S" in each}
    if not named:
        raise InvalidInput(f"{path}: not a spectrum of a known format; known are {_KNOWN}.")
    if record is not None and record not in named:
        raise InvalidInput(f"{path}: there is no spectrum {record!r}; there are {', '.join(named)}.")
    spectra = {
        name: _of_bins(f"{path}, {name}", each) for name, each in named.items() if record is None or name == record
    }
    name = max(spectra, key=lambda each: spectra[each].sigma)
    chosen = "the highest" if record is None else "one"
    return Found(spectrum=spectra[name], record=name, notes=(f"The spectrum is {chosen} of {len(named)} in the file.",))


def _of_bins(place: str, content: Mapping[str, Any]) -> Spectrum:
    densities, widths = content["S"], content.get("freqBinWidth")
    try:
        frequency = np.array([float(key) for key in densities])
        density = np.array([float(value) for value in densities.values()])
        width = bin_widths(frequency) if widths is None else np.array([float(widths[key]) for key in densities])
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InvalidInput(
            f"{place}: frequencies [Hz] with a density each under S, and with a width each under freqBinWidth where "
            f"there is one, are needed, but they do not fit: {error}."
        ) from None
    per_radian = 2.0 * np.pi
    try:
        return Spectrum(omega=per_radian * frequency, density=density / per_radian, width=per_radian * width)
    except InvalidInput as error:
        raise InvalidInput(f"{place}: {error}") from None
