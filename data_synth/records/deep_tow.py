"""Files of the deep-towed camera of voyage IN2018_V06: two rows an instant, UTM metres, pressure for depth.

The published CSV files come from the source's own processing: two cameras share the instants, a few rows are
out of order, gaps were filled with straight lines, and a stretch can stand still. All of it is kept, counted
and said in the record's notes; only rows of one instant are merged.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from data_synth.records.record import Record
from data_synth.records.ship_track import FASTEST, HARDEST, repaired_ship_track
from data_synth.records.table import Table
from models.quantity import InvalidInput
from models.trace import Floats, Trace

#: Latitude of the survey for the depth formula [degrees].
LATITUDE = -44.2
#: A position unchanged for longer is frozen [s].
FROZEN = 60.0

_SHIP = ("ShipEasting", "ShipNorthing")
_USBL = ("UsblEasting", "UsblNorthing")
_SAME = 1e-6  # m, between positions that are one
_NOISY = 5.0  # times the median speed
_STRAIGHT = 1e-5  # m, between steps of a straight line filled by index


def is_deep_tow(header: Iterable[str]) -> bool:
    """Whether a header line is that of a deep-tow file."""
    return {"FinalTime", "Pres", *_SHIP, *_USBL} <= set(header)


def deep_tow_record(table: Table) -> Record:
    """The record in a deep-tow file: UTM positions, time from the first instant, depth from pressure.

    Raises
    ------
    InvalidInput
        A cell is not a number, a time is not one, or the ship's track has a long gap or a jump.
    """
    times = table.instants("FinalTime")
    values = np.column_stack([table.numbers(name) for name in (*_SHIP, *_USBL, "Pres")])
    kept_rows, notes = _distinct_rows(table, times, values)
    t, first, group = np.unique(times[kept_rows], return_index=True, return_inverse=True)
    merged = _mean_by_group(values[kept_rows], group, t.size)
    notes += _merge_note(table, kept_rows.size, t.size)
    if t.size < 2:
        raise InvalidInput(f"{table.path}: at least 2 instants are needed, but there is {t.size}.")
    t = t - t[0]
    ship = np.column_stack([merged[:, :2], np.zeros(t.size)])
    ship[~np.isfinite(ship).all(axis=1)] = np.nan
    kept, ship, repairs = repaired_ship_track(t, ship, lambda i: table.at(int(kept_rows[first[i]])))
    t, merged = t[kept], merged[kept]
    depth = unesco_depth(merged[:, 4], LATITUDE)
    vehicle = np.column_stack([merged[:, 2:4], -depth])
    vehicle[~np.isfinite(vehicle).all(axis=1)] = np.nan
    missing = int((~np.isfinite(vehicle).all(axis=1)).sum())
    if missing:
        notes.append(f"{missing} of {t.size} vehicle positions missing; not scored.")
    notes += _of_both(_suspicions(t, ship[:, :2]), _suspicions(t, vehicle[:, :2]))
    return Record(
        name=table.path.stem,
        ship=Trace(t=t, position=ship),
        vehicle=Trace(t=t, position=vehicle),
        depth=depth,
        notes=(*notes, *repairs),
        source="deep-tow",
    )


def unesco_depth(pressure: ArrayLike, latitude: float) -> Floats:
    """Depth [m] of sea pressure [dbar] at a latitude [degrees].

    Notes
    -----
    Fofonoff and Millard, UNESCO Technical Papers in Marine Science 44 (1983); check value 9712.653 m at
    10000 dbar and 30 degrees.
    """
    p = np.asarray(pressure, dtype=float)
    x = np.sin(np.radians(latitude)) ** 2
    gravity = 9.780318 * (1.0 + (5.2788e-3 + 2.36e-5 * x) * x) + 1.092e-6 * p
    return np.asarray((((-1.82e-15 * p + 2.279e-10) * p - 2.2512e-5) * p + 9.72659) * p / gravity, dtype=float)


def _distinct_rows(table: Table, times: Floats, values: Floats) -> tuple[NDArray[np.intp], list[str]]:
    """The rows without exact repeats, and notes on those and on the order of time."""
    notes = []
    breaks = int((np.diff(times) < 0.0).sum())
    if breaks:
        notes.append(f"{times.size} rows in {breaks + 1} stretches out of time order; sorted.")
    cameras = table.cells("Camera") if "Camera" in table.header else [""] * times.size
    seen, kept = set(), []
    for i in range(times.size):
        key = (times[i], cameras[i], values[i].tobytes())
        if key not in seen:
            seen.add(key)
            kept.append(i)
    repeats = times.size - len(kept)
    if repeats:
        which = "row that repeats" if repeats == 1 else "rows that repeat"
        notes.append(f"{repeats} {which} another exactly; dropped.")
    return np.array(kept, dtype=np.intp), notes


def _merge_note(table: Table, rows: int, instants: int) -> list[str]:
    if rows == instants:
        return []
    cameras = len(set(table.cells("Camera"))) if "Camera" in table.header else 0
    who = f"{cameras} cameras merged" if cameras > 1 else "Rows of one instant merged"
    return [f"{who}: {instants} instants from {rows} rows, by their mean."]


def _mean_by_group(values: Floats, group: NDArray[np.intp], groups: int) -> Floats:
    """(groups, columns) mean of what is there, NaN where nothing is."""
    known = np.isfinite(values)
    total, count = np.zeros((groups, values.shape[1])), np.zeros((groups, values.shape[1]))
    np.add.at(total, group, np.where(known, values, 0.0))
    np.add.at(count, group, known)
    return np.where(count > 0, total / np.maximum(count, 1.0), np.nan)


def _of_both(ship: list[str], vehicle: list[str]) -> list[str]:
    """Findings on the two tracks as notes, what is the same for both said once."""
    both = [f"Ship and vehicle: {finding}" for finding in ship if finding in vehicle]
    only_ship = [f"Ship: {finding}" for finding in ship if finding not in vehicle]
    return both + only_ship + [f"Vehicle: {finding}" for finding in vehicle if finding not in ship]


def _suspicions(t: Floats, track: Floats) -> list[str]:
    """Frozen stretches, straight-line fills and unbelievable motion of (n, 2) positions, in words."""
    known = np.isfinite(track).all(axis=1)
    t, track = t[known], track[known]
    if t.size < 3:
        return []
    steps, dt = np.diff(track, axis=0), np.diff(t)
    still = np.abs(steps).max(axis=1) <= _SAME
    findings = [
        f"position frozen from {t[a]:.0f} to {t[b]:.0f} s ({t[b] - t[a]:.0f} s); kept."
        for a, b in _runs(still)
        if t[b] - t[a] > FROZEN
    ]
    straight = (np.abs(np.diff(steps, axis=0)).max(axis=1) <= _STRAIGHT) & ~still[1:] & ~still[:-1]
    if straight.any():
        a, b = max(_runs(straight), key=lambda run: run[1] - run[0])
        findings.append(
            f"{int(straight.sum())} of {t.size} positions halfway between their neighbours, as in a gap filled "
            f"with a straight line, the longest run from {t[a]:.0f} to {t[b + 1]:.0f} s; kept."
        )
    velocity = steps / dt[:, None]
    speed = np.linalg.norm(velocity, axis=1)
    hardness = np.linalg.norm(np.diff(velocity, axis=0), axis=1) / (0.5 * (dt[1:] + dt[:-1]))
    for what, values, limit, unit in (("speed", speed, FASTEST, "m/s"), ("acceleration", hardness, HARDEST, "m/s2")):
        if values.max() > limit:
            i = int(np.argmax(values))
            findings.append(
                f"{what} above {limit:g} {unit} {int((values > limit).sum())} times, most at {t[i + 1]:.0f} s "
                f"({values[i]:.3g} {unit}); kept."
            )
    usual = float(np.median(speed[~still])) if (~still).any() else 0.0
    if FASTEST >= speed.max() > _NOISY * usual:
        at = t[int(np.argmax(speed)) + 1]
        findings.append(
            f"speed between neighbours up to {speed.max():.2f} m/s at {at:.0f} s (median {usual:.2f} m/s), as of "
            "noisy fixes; kept."
        )
    return findings


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and one-past-last place of every run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(int)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
