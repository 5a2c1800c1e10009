"""Heave in a turn: its peaks, and the second-order system that it is taken for (W section 3.2).

    z'' + 2 zeta om z' + om^2 (z - z_e(t)) = 0,    z_e(t) = z_end + D exp(-t/tau)

A body that begins to turn sinks by far more than it swings: the depth that it swings about is itself on its way to
that of the steady circle. With `z_e` fixed, as W has it, the system describes neither; both fits are made, and how
much of the velocity each explains is reported.

| symbol | meaning | unit |
| --- | --- | --- |
| a, w | decay rate zeta om, damped frequency om sqrt(1 - zeta^2) | 1/s |
| tau, D | time constant and size of the sinking | s, m |
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from ident.simplex import search

Floats = NDArray[np.float64]

#: A peak or a trough stands out from its surroundings by this share of the whole range of heave.
PROMINENCE = 2e-3
#: Heave this near to its highest, as a share of its range, has not begun to fall.
LEVEL = 1e-4
#: Samples that a fit is made on: some 80 for each swing of a turn of five circles.
SAMPLES = 400
#: A system more damped than this loses 97 % in one period: there is no oscillation to speak of.
MOST_DAMPED = 0.5
#: Fewer gaps between peaks than this show no period: the first is that of the fall.
LEAST_GAPS = 2
#: Share of the velocity [%] that a fit must explain to be one.
LEAST_FIT = 50.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Peaks:
    """The upper turning points of heave.

    Parameters
    ----------
    t, z
        (k,) [s], [m]; the first is where the body begins to fall.
    height
        (k,) [m] above the line through the troughs on both sides, so that a slow sinking does not count; NaN where a
        trough is missing.
    dips
        Number of troughs.
    rise
        The farthest that the body comes up again after falling [m].
    """

    t: Floats
    z: Floats
    height: Floats
    dips: int
    rise: float

    @property
    def gaps(self) -> Floats:
        """(k - 1,) time from each peak to the next [s]."""
        return np.diff(self.t)

    @property
    def decay(self) -> Floats:
        """(k,) height over that of the peak before; NaN where either is missing."""
        return np.concatenate([[math.nan], self.height[1:] / self.height[:-1]])


@dataclass(frozen=True, slots=True, kw_only=True)
class Oscillation:
    """What the second-order system makes of a body's heave; NaN, and a note, where it does not fit.

    Parameters
    ----------
    period
        Damped period 2 pi/w [s].
    damping_ratio
        zeta [-].
    amplitude
        Of the oscillation at the first peak [m].
    drop, relaxation
        Sinking D [m], positive down, and its time constant tau [s].
    fit_percent
        Share of the velocity that it explains, ``100 (1 - |v - vhat|/|v - mean v|)``.
    plain_fit_percent
        The same without the sinking: the system as W has it.
    """

    period: float = math.nan
    damping_ratio: float = math.nan
    amplitude: float = math.nan
    drop: float = math.nan
    relaxation: float = math.nan
    fit_percent: float = math.nan
    plain_fit_percent: float = math.nan
    note: str = ""


def find_heave_peaks(t: Floats, z: Floats) -> Peaks:
    """The peaks of heave z (n,) [m], up, from where the body begins to fall."""
    span = float(np.ptp(z))
    if span == 0.0:
        return Peaks(t=t[:1], z=z[:1], height=np.full(1, math.nan), dips=0, rise=0.0)
    troughs = find_peaks(-z, prominence=PROMINENCE * span)[0]
    tops = find_peaks(z, prominence=PROMINENCE * span)[0]
    fall = z[: int(troughs[0]) + 1] if troughs.size else z
    first = int(np.flatnonzero(fall >= fall.max() - LEVEL * span)[-1])
    tops = np.concatenate([[first], tops[tops > (troughs[0] if troughs.size else z.size)]]).astype(int)
    height = np.full(tops.size, math.nan)
    for i, top in enumerate(tops[1:], start=1):
        before, after = troughs[troughs < top], troughs[troughs > top]
        if before.size and after.size:
            ends = [before[-1], after[0]]
            height[i] = z[top] - np.interp(t[top], t[ends], z[ends])
    when = np.array([_vertex(t, z, int(top)) for top in tops])
    rise = float((z[first:] - np.minimum.accumulate(z[first:])).max())
    return Peaks(t=when, z=z[tops], height=height, dips=int(troughs.size), rise=rise)


def _vertex(t: Floats, z: Floats, i: int) -> float:
    """Time of the top of the parabola through the samples about i."""
    if not 0 < i < z.size - 1:
        return float(t[i])
    left, right = z[i] - z[i - 1], z[i + 1] - z[i]
    bend = left - right
    shift = 0.5 * (left + right) / bend if bend > 0.0 else 0.0
    return float(t[i] + min(max(shift, -0.5), 0.5) * (t[i + 1] - t[i]))


def fit_heave(t: Floats, velocity: Floats, peaks: Peaks) -> Oscillation:
    """Fit the second-order system to the velocity (n,) [m/s] from the first peak on, as the learning model does.

    The frequencies are searched with the simplex of `ident.simplex`; the sizes follow from them by least squares.
    """
    if peaks.gaps.size < LEAST_GAPS:
        return Oscillation(note=f"no oscillation: fewer than {LEAST_GAPS + 1} peaks")
    begin, end = float(peaks.t[0]), float(t[-1])
    times = np.linspace(begin, end, SAMPLES)
    cost = _Cost(times - begin, np.interp(times, t, velocity))
    sinking = _fitted(cost, [(gap, z, s) for gap in _periods(peaks) for z in (0.05, 0.3) for s in (0.1, 0.3)])
    plain = _fitted(cost, [(gap, z) for gap in _periods(peaks) for z in (0.05, 0.3)])
    found = replace(sinking, plain_fit_percent=plain.fit_percent)
    note = _doubt(found, end - begin)
    if not note:
        return found
    return Oscillation(fit_percent=found.fit_percent, plain_fit_percent=found.plain_fit_percent, note=note)


def _periods(peaks: Peaks) -> tuple[float, ...]:
    """Where the search for the period begins [s]."""
    return float(np.median(peaks.gaps)), float(peaks.gaps[0])


def _doubt(found: Oscillation, duration: float) -> str:
    """Why a fit is none; empty where it is one."""
    if found.fit_percent < LEAST_FIT:
        return f"no fit: the second-order system explains {found.fit_percent:.0f} % of the velocity"
    if found.damping_ratio > MOST_DAMPED:
        return f"no oscillation: the best damping ratio is {found.damping_ratio:.2f}"
    if found.period > duration:
        return f"no oscillation: the best period, {found.period:.0f} s, is longer than the record"
    return ""


def _fitted(cost: "_Cost", starts: Sequence[tuple[float, ...]]) -> Oscillation:
    """The best of several searches, each from a period [s], a damping ratio and, for the sinking, a share of time."""
    duration = float(cost.t[-1])
    cost = replace(cost)
    for period, zeta, *shares in starts:
        w = 2.0 * math.pi / period
        search(cost, np.log([w, zeta * w, *(1.0 / (share * duration) for share in shares)]), [])
    assert cost.best_at is not None
    w, a, *rest = np.exp(cost.best_at)
    sizes, residual = cost.sizes(cost.best_at)
    om = math.hypot(a, w)
    return Oscillation(
        period=2.0 * math.pi / w,
        damping_ratio=a / om,
        amplitude=math.hypot(sizes[0], sizes[1]) / om,
        drop=-float(sizes[2]) / rest[0] if rest else math.nan,
        relaxation=1.0 / rest[0] if rest else math.nan,
        fit_percent=100.0 * (1.0 - float(np.linalg.norm(residual) / np.linalg.norm(cost.v - cost.v.mean()))),
    )


@dataclass(slots=True, eq=False)
class _Cost:
    """RMS velocity error [m/s] against the logarithms of w, a and, with a sinking, 1/tau [1/s].

    Coordinates outside the range are clipped to it and pay a factor that grows with their distance.
    """

    t: Floats
    v: Floats
    best: float = math.inf
    best_at: Floats | None = field(default=None)

    @property
    def upper(self) -> Floats:
        """(3,) highest rates: a period of 8 samples, and as fast a decay."""
        return np.full(3, math.log(2.0 * math.pi * SAMPLES / (8.0 * self.t[-1])))

    @property
    def lower(self) -> Floats:
        """(3,) lowest rates: a period of four times the record, hardly any decay, hardly any sinking."""
        rates: Floats = np.array([0.5 * math.pi, 1e-3, 0.1]) / self.t[-1]
        return np.log(rates)

    def sizes(self, u: Floats) -> tuple[Floats, Floats]:
        """Sizes of the parts of the velocity [m/s] by least squares, and what they leave (n,) [m/s]."""
        w, a, *rest = np.exp(np.clip(u, self.lower[: u.size], self.upper[: u.size]))
        ringing = np.exp(-a * self.t)
        parts = [ringing * np.cos(w * self.t), ringing * np.sin(w * self.t), *(np.exp(-r * self.t) for r in rest)]
        basis = np.stack(parts, axis=1)
        sizes = np.linalg.lstsq(basis, self.v, rcond=None)[0]
        return sizes, basis @ sizes - self.v

    def residuals(self, u: Floats) -> Floats:
        """(n,) model minus velocity [m/s] at coordinates u; the best so far is kept."""
        residual = self.sizes(u)[1]
        cost = math.sqrt(float(residual @ residual) / residual.size)
        if cost < self.best:
            self.best, self.best_at = cost, np.clip(u, self.lower[: u.size], self.upper[: u.size])
        return residual

    def __call__(self, u: Floats) -> float:
        """The cost [m/s]."""
        residual = self.residuals(u)
        outside = np.maximum(self.lower[: u.size] - u, 0.0) + np.maximum(u - self.upper[: u.size], 0.0)
        return math.sqrt(float(residual @ residual) / residual.size) * (1.0 + float(outside.sum()))
