"""Peaks of a response: where between the points of the grid, and how high."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.signal import find_peaks

#: A peak stands out from its surroundings by this much [dB], one that is taken for a mode by that much.
PROMINENCE, MODE = 0.01, 1.0
#: Amplitudes below this share of the largest are rounding [dB].
_FLOOR = -240.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Peak:
    """Frequency [rad/s], amplitude in the unit of the response and in dB over the reference, prominence [dB]."""

    omega: float
    level: float
    decibels: float
    prominence: float


def decibels(amplitude: ArrayLike, reference: float = 1.0) -> np.ndarray:
    """20 log10 of amplitude over reference; -inf for zero."""
    with np.errstate(divide="ignore"):
        level: np.ndarray = 20.0 * np.log10(np.abs(np.asarray(amplitude)) / reference)
    return level


def peaks(
    omega: ArrayLike, amplitude: ArrayLike, *, reference: float = 1.0, prominence: float = PROMINENCE
) -> tuple[Peak, ...]:
    """The maxima inside the range, from the lowest frequency; the ends of the range are none.

    Parameters
    ----------
    omega, amplitude
        (k,) increasing [rad/s], and magnitudes in any unit.
    reference
        What the decibels are over.
    prominence
        How far a maximum must stand out from the higher of the lows beside it [dB].

    Notes
    -----
    Frequency and level are those of the parabola through three points of the decibels.
    """
    x, size = np.asarray(omega, dtype=float), np.abs(np.asarray(amplitude))
    most = float(size.max(initial=0.0))
    if x.size < 3 or not most > 0.0:
        return ()
    y = np.maximum(decibels(size, most), _FLOOR)
    found = []
    places, about = find_peaks(y, prominence=prominence)
    for i, stands_out in zip(places.tolist(), about["prominences"].tolist(), strict=True):
        place, level = _vertex(x[i - 1 : i + 2], y[i - 1 : i + 2])
        height = most * 10.0 ** (level / 20.0)
        over = 20.0 * math.log10(height / reference)
        found.append(Peak(omega=place, level=height, decibels=over, prominence=stands_out))
    return tuple(found)


def highest(found: tuple[Peak, ...]) -> Peak | None:
    """The highest peak, or none."""
    return max(found, key=lambda peak: peak.level, default=None)


def _vertex(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Vertex of the parabola through three points, the middle one not below the others."""
    before, after = (y[1] - y[0]) / (x[1] - x[0]), (y[2] - y[1]) / (x[2] - x[1])
    bend = (after - before) / (x[2] - x[0])
    if not bend < 0.0:
        return float(x[1]), float(y[1])
    place = 0.5 * (x[0] + x[1]) - before / (2.0 * bend)
    return float(place), float(y[0] + before * (place - x[0]) + bend * (place - x[0]) * (place - x[1]))
