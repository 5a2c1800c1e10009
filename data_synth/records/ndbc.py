"""Files of the National Data Buoy Center: yearly spectral densities, and summaries of swell and wind sea.

Densities [m2/Hz] are averages over bins of frequency [Hz]; a row that holds the fill value 999.00 or the mark MM
has no spectrum. Summaries have the heights [m] and peak periods [s] of the two parts alone.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np

from data_synth.records.text import as_number
from data_synth.spectra import SeaState, Spectrum, total
from models.quantity import InvalidInput
from models.trace import Floats

_FILL = 999.0
_MARK = "MM"
_FREQUENCY = re.compile(r"0?\.\d+")
#: Of a summary: the parts' names and the columns of their height and period.
_PARTS = {"swell": ("SwH", "SwP"), "wind sea": ("WWH", "WWP")}


@dataclass(frozen=True, slots=True, kw_only=True)
class Found:
    """A spectrum of a file: which of its records, and what there is to say of the choice."""

    spectrum: Spectrum
    record: str
    notes: tuple[str, ...]


def is_densities(header: Sequence[str]) -> bool:
    """Whether the first line's words are date columns and then frequencies."""
    frequencies = header[_dates(header) :]
    return 0 < len(frequencies) < len(header) and all(map(_FREQUENCY.fullmatch, frequencies))


def is_summary(header: Sequence[str]) -> bool:
    """Whether the first line's words are those of a summary of swell and wind sea."""
    return _dates(header) > 0 and all(name in header for pair in _PARTS.values() for name in pair)


def read_densities(path: Path, lines: Sequence[tuple[int, str]], when: datetime | None) -> Found:
    """The spectrum of a time, or the highest of the file, from its numbered lines.

    Raises
    ------
    InvalidInput
        A row is damaged, all of them are fill values, or there is none at that time.
    """
    header = lines[0][1].split()
    dates = _dates(header)
    frequency = np.array([float(cell) for cell in header[dates:]])
    width = bin_widths(frequency)
    times, densities, filled = [], [], []
    for number, line in lines[1:]:
        cells = _cells(path, number, line, header)
        time = _time(path, number, cells[:dates])
        values = [
            _FILL if cell == _MARK else as_number(path, number, name, cell)
            for name, cell in zip(header[dates:], cells[dates:], strict=True)
        ]
        if _FILL in values:
            filled.append(time)
            continue
        times.append(time)
        densities.append(values)
    if not times:
        raise InvalidInput(f"{path}: a spectrum is needed, but all {len(filled)} rows hold the fill value {_FILL:g}.")
    heights = 4.0 * np.sqrt(np.maximum(np.array(densities) @ width, 0.0))
    i = _chosen(path, times, filled, heights, when)
    per_radian = 2.0 * np.pi
    spectrum = Spectrum(
        omega=per_radian * frequency, density=np.array(densities[i]) / per_radian, width=per_radian * width
    )
    notes = (_choice(times, when) + (f"; {len(filled)} further rows hold a fill value." if filled else "."),)
    return Found(spectrum=spectrum, record=_told(times[i]), notes=notes)


def read_summary(path: Path, lines: Sequence[tuple[int, str]], when: datetime | None) -> Found:
    """A spectrum made from the swell and the wind sea of a time, or of the highest sea of the file.

    Each part is given Bretschneider's form, which the file does not know.

    Raises
    ------
    InvalidInput
        A row is damaged, all of them lack a part, or there is none at that time.
    """
    header = lines[0][1].split()
    dates = _dates(header)
    times, seas, filled = [], [], []
    for number, line in lines[1:]:
        cells = _cells(path, number, line, header)
        time = _time(path, number, cells[:dates])
        row = dict(zip(header, cells, strict=True))
        if any(row[name] == _MARK for pair in _PARTS.values() for name in pair):
            filled.append(time)
            continue
        times.append(time)
        seas.append(
            [
                (as_number(path, number, height, row[height]), as_number(path, number, period, row[period]))
                for height, period in _PARTS.values()
            ]
        )
    if not times:
        raise InvalidInput(f"{path}: heights of swell and wind sea are needed, but all {len(filled)} rows lack one.")
    i = _chosen(path, times, filled, np.hypot(*np.array(seas)[:, :, 0].T), when)
    parts = [SeaState(height=height, peak_period=period).spectrum() for height, period in seas[i] if height > 0.0]
    if not parts:
        raise InvalidInput(f"{path}: the sea of {_told(times[i])} has no energy: swell and wind sea have no height.")
    told = [f"{name} {height:g} m, {period:g} s" for name, (height, period) in zip(_PARTS, seas[i], strict=True)]
    notes = (
        _choice(times, when) + (f"; {len(filled)} further rows lack swell or wind sea." if filled else "."),
        f"The file has heights and peak periods alone ({' and '.join(told)}); each part is given Bretschneider's form.",
    )
    return Found(spectrum=total(*parts), record=_told(times[i]), notes=notes)


def bin_widths(frequency: Floats) -> Floats:
    """Widths of bins whose edges lie midway between their centres, the outer two even about theirs."""
    if frequency.size < 2 or np.any(np.diff(frequency) <= 0.0):
        raise InvalidInput("The bins of a spectrum need at least 2 increasing frequencies.")
    middle = 0.5 * (frequency[1:] + frequency[:-1])
    edges = np.concatenate([[2.0 * frequency[0] - middle[0]], middle, [2.0 * frequency[-1] - middle[-1]]])
    return np.diff(edges)


def _dates(header: Sequence[str]) -> int:
    """Number of date columns at the head of the first line: year, month, day, hour and sometimes minute; 0 for none."""
    words = [word.lstrip("#") for word in header[:5]]
    if len(words) < 4 or words[0] not in ("YY", "YYYY") or words[1:4] != ["MM", "DD", "hh"]:
        return 0
    return 5 if words[4:] == ["mm"] else 4


def _cells(path: Path, number: int, line: str, header: Sequence[str]) -> list[str]:
    cells = line.split()
    if len(cells) != len(header):
        raise InvalidInput(f"{path}, line {number}: {len(header)} values are needed, but it has {len(cells)}.")
    return cells


def _time(path: Path, number: int, cells: Sequence[str]) -> datetime:
    try:
        year, month, day, hour, *minute = (int(cell) for cell in cells)
        century = 1900 if 70 <= year < 100 else 2000 if year < 70 else 0
        return datetime(century + year, month, day, hour, minute[0] if minute else 0)
    except ValueError:
        raise InvalidInput(
            f"{path}, line {number}: a date and hour are needed, but it begins {' '.join(cells)}."
        ) from None


def _chosen(
    path: Path, times: Sequence[datetime], filled: Sequence[datetime], heights: Floats, when: datetime | None
) -> int:
    """Place of the spectrum of a time, or of the highest."""
    if when is None:
        return int(heights.argmax())
    if when in times:
        return times.index(when)
    why = "that row holds the fill value" if when in filled else "there is none"
    nearest = min(times, key=lambda time: abs(time - when))
    raise InvalidInput(f"{path}: a spectrum at {_told(when)} is needed, but {why}; the nearest is of {_told(nearest)}.")


def _choice(times: Sequence[datetime], when: datetime | None) -> str:
    return f"The spectrum is {'the highest' if when is None else 'one'} of {len(times)} in the file"


def _told(time: datetime) -> str:
    return f"{time:%Y-%m-%d %H:%M}"
