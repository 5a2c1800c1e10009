"""What a ship's track must satisfy before a model is driven with it: gaps bridged up to 60 s, no jumps."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput
from models.trace import Floats

#: Longest time without a ship position that is bridged [s].
LONGEST_GAP = 60.0
#: Fastest that a ship's position may move [m/s]; anything faster is a jump.
FASTEST_SHIP = 15.0
#: Rules of the R2R programme for a believable ship track: speed [m/s], acceleration [m/s2].
FASTEST, HARDEST = 8.7, 1.0

_GAP_STEPS = 3.0  # a time step longer than so many usual ones is a gap


def repaired_ship_track(
    t: Floats, position: Floats, place: Callable[[int], str]
) -> tuple[slice, Floats, tuple[str, ...]]:
    """Bridge the gaps of a ship's track, or refuse it.

    Parameters
    ----------
    t
        (n,) [s], increasing.
    position
        (n, 3) [m], NaN rows where missing.
    place
        Says where a row was read from.

    Returns
    -------
    tuple
        The rows from the first to the last ship position, their positions (k, 3) without gaps, and notes.

    Raises
    ------
    InvalidInput
        There are fewer than two positions, a gap is longer than 60 s, or a position jumps.
    """
    from scipy.interpolate import PchipInterpolator

    known = np.flatnonzero(np.isfinite(position).all(axis=1))
    if known.size < 2:
        row = place(int(known[0]) if known.size else 0)
        raise InvalidInput(f"{row}: a ship's track needs at least 2 positions, but has {known.size}.")
    steps = np.diff(t[known])
    if steps.max() > LONGEST_GAP:
        k = int(np.argmax(steps > LONGEST_GAP))
        raise InvalidInput(
            f"{place(int(known[k + 1]))}: no ship position for {steps[k]:g} s, from {t[known[k]]:g} to "
            f"{t[known[k + 1]]:g} s; gaps up to {LONGEST_GAP:g} s can be bridged, so cut the record there."
        )
    speeds = np.linalg.norm(np.diff(position[known], axis=0), axis=1) / steps
    if speeds.max() > FASTEST_SHIP:
        k = int(np.argmax(speeds > FASTEST_SHIP))
        raise InvalidInput(
            f"{place(int(known[k + 1]))}: the ship's position jumps, {speeds[k]:.3g} m/s since the one before; "
            f"the most that is believed is {FASTEST_SHIP:g} m/s, so remove or repair the position."
        )
    kept = slice(int(known[0]), int(known[-1]) + 1)
    filled = np.array(position)
    missing = np.ones(t.size, dtype=bool)
    missing[known] = False
    bridged = np.flatnonzero(missing[kept]) + kept.start
    if bridged.size:
        filled[bridged] = PchipInterpolator(t[known], position[known])(t[bridged])
    notes = _notes(t, known, bridged, kept)
    return kept, filled[kept], notes


def _notes(t: Floats, known: NDArray[np.intp], bridged: NDArray[np.intp], kept: slice) -> tuple[str, ...]:
    """What was bridged, dropped and found."""
    notes = []
    if bridged.size:
        longest = np.diff(t[known])[np.diff(known) > 1].max()
        notes.append(f"{counted(bridged.size, 'missing ship position')} interpolated, longest gap {longest:g} s.")
    steps = np.diff(t[kept])
    gaps = steps > _GAP_STEPS * np.median(steps)
    if gaps.any():
        notes.append(
            f"{counted(int(gaps.sum()), 'gap')} in time bridged by the ship's spline, longest {steps[gaps].max():g} s."
        )
    dropped = t.size - (kept.stop - kept.start)
    if dropped:
        notes.append(f"{counted(dropped, 'row')} before the first or after the last ship position left out.")
    return tuple(notes)


def counted(number: int, thing: str) -> str:
    """A number and its thing, in the plural where there are several."""
    return f"{number} {thing}{'' if number == 1 else 's'}"
