"""The ship's motion along x, prepared once for many runs of the reduced models.

| symbol | meaning | unit |
| --- | --- | --- |
| u | ship position in the local origin x0 | m |
| h | step of the quadratic models | s |
| gamma | abscissa of the first stage of the stepper, in steps | - |
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput, NumericalFailure
from models.trace import Trace

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Start = Literal["rest", "steady"]

#: Abscissa and diagonal entry of the two-stage, stiffly accurate SDIRK of order 2 (Alexander 1977).
GAMMA = 1.0 - 1.0 / math.sqrt(2.0)

#: Longest step of a quadratic model [s]: 1e-4 m/s RMS on an hour below one knot, with a margin of two.
MAX_STEP = 0.5

#: Length of the stretch whose mean ship velocity is the speed of a steady start [s].
STEADY_STRETCH = 60.0


#: Most steps of one simulation: ten minutes of computing, and a few gigabytes.
MOST_STEPS = 20_000_000


class Grid(NamedTuple):
    """The steps of a quadratic model: every sampling interval cut evenly.

    `step` (n-1,) [s] within each interval, `substeps` (n-1,) their number, and `stage` (sum of substeps, 2) the
    ship's positions from the local origin [m] at the two stages of every step.
    """

    step: Floats
    substeps: Integers
    stage: Floats


@dataclass(frozen=True, kw_only=True, eq=False)
class Drive:
    """The ship's cubic spline on its own times, in a local origin.

    Parameters
    ----------
    t
        (n,) [s], the ship's own times, increasing.
    x0
        Local origin [m]: the ship's first position. Everything else counts from it.
    start_speed
        [m/s] of the steady tow before the record; 0 for a start from rest.
    max_step
        Longest step of a quadratic model [s].
    u
        (n,) ship positions from `x0` [m].
    rates
        (n, 3) first, second and third derivative of the ship's position, from the right [m/s, m/s2, m/s3].
    """

    t: Floats
    x0: float
    start_speed: float
    max_step: float
    u: Floats
    rates: Floats

    @classmethod
    def from_trace(cls, ship: Trace, *, start: Start = "rest", max_step: float = MAX_STEP) -> Self:
        """Prepare the x motion of a ship; missing fixes inside the record are bridged by its spline.

        Parameters
        ----------
        start
            ``rest``: everything lies at rest at the ship's first position; ``steady``: the model tows in its own
            steady shape at the ship's mean velocity over the first minute.
        max_step
            Longest step of a quadratic model [s]; the implicit stepper takes half of it where there is mass.

        Raises
        ------
        InvalidInput
            The record starts or ends without a fix, the start is unknown, or `max_step` is not above zero.
        """
        if start not in ("rest", "steady"):
            raise InvalidInput(f"start must be 'rest' or 'steady', but it is {start!r}.")
        if not (math.isfinite(max_step) and max_step > 0.0):
            raise InvalidInput(f"max_step must be above 0 s, but it is {max_step:g} s.")
        if not (ship.valid[0] and ship.valid[-1]):
            raise InvalidInput("The ship needs a fix at the first and at the last time; cut the record there.")
        spline, t = ship.spline, ship.t
        x0 = float(ship.position[0, 0])
        x = np.where(ship.valid, ship.position[:, 0], spline(t)[:, 0])
        rates = np.stack([spline(t, order)[:, 0] for order in (1, 2, 3)], axis=1)
        stretch = min(STEADY_STRETCH, float(t[-1] - t[0]))
        speed = (float(ship.at(t[0] + stretch)[0]) - x0) / stretch if start == "steady" else 0.0
        return cls(t=t, x0=x0, start_speed=speed, max_step=max_step, u=_frozen(x - x0), rates=_frozen(rates))

    @cached_property
    def coarse(self) -> Grid:
        """The grid of `max_step`."""
        return self._grid(self.max_step)

    @cached_property
    def fine(self) -> Grid:
        """The grid of half `max_step`."""
        return self._grid(0.5 * self.max_step)

    @cached_property
    def intervals(self) -> tuple[Floats, Integers]:
        """Distinct sampling intervals (p,) [s], and which of them each interval is (n-1,).

        Intervals that differ only by the rounding of the times count as one.
        """
        interval = np.diff(self.t)
        quantum = 4.0 * np.finfo(float).eps * float(np.abs(self.t).max())
        _, which, count = np.unique(np.round(interval / quantum), return_inverse=True, return_counts=True)
        return np.bincount(which, interval) / count, which.astype(np.int64)

    def first(self, intervals: int) -> Self:
        """The beginning of the drive, of so many sampling intervals."""
        end = intervals + 1
        return replace(self, t=self.t[:end], u=self.u[:end], rates=self.rates[:end])

    def finer(self, parts: int) -> Self:
        """The same drive with each of the longest steps in so many parts."""
        return replace(self, max_step=min(self.max_step, float(np.diff(self.t).max())) / parts)

    def _grid(self, max_step: float) -> Grid:
        interval = np.diff(self.t)
        parts = np.maximum(np.ceil(interval / max_step - 1e-9), 1.0)
        if parts.sum() > MOST_STEPS:
            longest = int(interval.argmax())
            raise NumericalFailure(
                f"The record of {self.t[-1] - self.t[0]:g} s asks for {parts.sum():.3g} steps of at most {max_step:g} "
                f"s, more than {MOST_STEPS:g}; its longest interval is {interval[longest]:g} s, after t = "
                f"{self.t[longest]:g} s. Cut the record, or give a longer max_step."
            )
        substeps = parts.astype(np.int64)
        step = interval / substeps
        k = np.repeat(np.arange(interval.size), substeps)
        begun = (np.arange(k.size) - np.repeat(np.cumsum(substeps) - substeps, substeps)) * step[k]
        since = np.stack([begun + GAMMA * step[k], begun + step[k]], axis=1)
        u1, u2, u3 = self.rates[k].T[:, :, None]
        stage = self.u[k][:, None] + since * (u1 + since * (u2 / 2.0 + since * u3 / 6.0))
        return Grid(_frozen(step), substeps, _frozen(stage))


def _frozen(values: ArrayLike) -> Floats:
    array = np.ascontiguousarray(values, dtype=float)
    array.setflags(write=False)
    return array
