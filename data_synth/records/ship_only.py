"""A record of a ship alone, from noisy positions: what must be done before they can drive a cable, and no more."""

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from data_synth.records.record import Record
from data_synth.records.ship_track import FASTEST_SHIP, HARDEST, counted, repaired_ship_track
from models.quantity import InvalidInput
from models.trace import Floats, Trace

#: Steepest smoothing tried, as its half-power period in median time steps.
_LONGEST_SMOOTHING = 200.0
_HALVINGS = 20
_FEWEST_SMOOTHED = 5  # of the smoothing spline


def ship_record(
    name: str,
    t: Floats,
    xy: Floats,
    place: Callable[[int], str],
    notes: tuple[str, ...],
    *,
    source: Literal["nmea", "creel"],
) -> Record:
    """The record of positions (n, 2) [m] at times (n,) [s], as read: every change is told in its notes.

    Positions that do not come after all before them are dropped, single ones that jump out and back are bridged, and
    a track harder than 1 m/s2 is smoothed by as little as brings it there.

    Raises
    ------
    InvalidInput
        The track has a long gap or jumps for good, or no smoothing makes it believable; says where.
    """
    rows = _in_order(t)
    if rows.size < t.size:
        notes += (f"{counted(t.size - rows.size, 'position')} at or before the time of an earlier one; dropped.",)
    t = np.round(t[rows] - t[rows[0]], 6)
    position = np.column_stack([xy[rows], np.zeros(t.size)])
    spikes = _spikes(t, position)
    if spikes.size:
        position[spikes] = np.nan
        notes += (f"{counted(spikes.size, 'position')} out of the track and back by a jump; taken as missing.",)
    kept, position, repairs = repaired_ship_track(t, position, lambda i: place(int(rows[i])))
    t = np.round(t[kept] - t[kept.start], 6)
    position, smoothing = _believable(name, t, position)
    return Record(name=name, ship=Trace(t=t, position=position), notes=(*notes, *repairs, *smoothing), source=source)


def hardness(t: Floats, position: Floats) -> Floats:
    """(n,) [m/s2] acceleration of the spline through positions; between samples it is nowhere larger."""
    return np.asarray(np.linalg.norm(Trace(t=t, position=position).spline(t, 2), axis=1))


def _in_order(t: Floats) -> NDArray[np.intp]:
    """Rows later than all before them."""
    before = np.concatenate([[-np.inf], np.maximum.accumulate(t)[:-1]])
    return np.flatnonzero(t > before)


def _spikes(t: Floats, position: Floats) -> NDArray[np.intp]:
    """Places whose steps from the one before and to the one after are both jumps, while those two agree."""
    known = np.flatnonzero(np.isfinite(position).all(axis=1))
    t, position = t[known], position[known]

    def jumps(apart: int) -> NDArray[np.bool_]:
        steps = np.linalg.norm(position[apart:] - position[:-apart], axis=1)
        return np.asarray(steps > FASTEST_SHIP * (t[apart:] - t[:-apart]))

    single = jumps(1)
    return known[1:-1][single[:-1] & single[1:] & ~jumps(2)] if known.size > 2 else known[:0]


def _believable(name: str, t: Floats, position: Floats) -> tuple[Floats, tuple[str, ...]]:
    """Positions with no acceleration above the believable, by the least smoothing spline, and a note on it.

    Notes
    -----
    The spline minimises ``sum (y - f)^2 + lam integral f''^2``; evenly sampled it is a filter without lag whose
    gain falls to one half at the period ``2 pi (lam/dt)^(1/4)``.
    """
    from scipy.interpolate import make_smoothing_spline

    before = float(hardness(t, position).max())
    if before <= HARDEST or t.size < _FEWEST_SMOOTHED:
        return position, ()
    dt = float(np.median(np.diff(t)))

    def smooth(period: float) -> Floats:
        lam = dt * (period / (2.0 * np.pi)) ** 4
        return np.column_stack([make_smoothing_spline(t, p, lam=lam)(t) for p in position.T])

    low, high = np.log(dt), np.log(_LONGEST_SMOOTHING * dt)
    best = smooth(np.exp(high))
    if hardness(t, best).max() > HARDEST:
        raise InvalidInput(
            f"Record {name}: the ship's acceleration reaches {before:.3g} m/s2 and no smoothing up to "
            f"{np.exp(high):.3g} s brings it to {HARDEST:g} m/s2; repair the track."
        )
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        tried = smooth(np.exp(middle))
        if hardness(t, tried).max() > HARDEST:
            low = middle
        else:
            high, best = middle, tried
    moved = np.linalg.norm(best - position, axis=1)
    note = (
        f"Ship smoothed, its acceleration reached {before:.3g} m/s2: a smoothing spline of half-gain period "
        f"{np.exp(high):.3g} s brings it to {HARDEST:g} m/s2 and moves positions by {np.sqrt(np.mean(moved**2)):.2g} m "
        f"RMS, at most {moved.max():.2g} m."
    )
    return best, (note,)
