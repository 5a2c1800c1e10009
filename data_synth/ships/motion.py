"""What every ship motion shares: its times, a trace with its exact velocity, and the sum of several."""

from collections.abc import Sequence

import numpy as np

from models.quantity import InvalidInput
from models.trace import Floats, Trace

_FEWEST_STEPS = 4  # the spline through the samples is cubic
_MOST_STEPS = 10_000_000


def sample_times(duration: float, sample: float) -> Floats:
    """(n,) [s] from 0 to `duration` in steps of `sample`; the last one may fall short of it by under a step.

    Raises
    ------
    InvalidInput
        The duration holds fewer than four steps, or more than ten million: a day in hundredths of a second.
    """
    steps = int(np.floor(duration / sample + 1e-9))
    if steps < _FEWEST_STEPS:
        raise InvalidInput(
            f"A ship input needs at least {_FEWEST_STEPS} steps, but {duration:g} s at {sample:g} s has {steps}; "
            "make the duration longer or the sample shorter."
        )
    if steps > _MOST_STEPS:
        raise InvalidInput(
            f"A ship input has at most {_MOST_STEPS:,} steps, but {duration:g} s at {sample:g} s has {steps:,}; "
            "make the duration shorter or the sample longer."
        )
    return np.asarray(sample * np.arange(steps + 1), dtype=float)


def planar_motion(
    t: Floats, surge: Floats, surge_rate: Floats, heave: Floats | None = None, heave_rate: Floats | None = None
) -> Trace:
    """A ship trace in the x-z plane with its velocity at the samples, all (n,) [m] and [m/s]."""
    position, velocity = np.zeros((t.size, 3)), np.zeros((t.size, 3))
    position[:, 0], velocity[:, 0] = surge, surge_rate
    if heave is not None and heave_rate is not None:
        position[:, 2], velocity[:, 2] = heave, heave_rate
    return Trace(t=t, position=position, velocity=velocity)


def eased(
    t: Floats, orders: Sequence[float], levels: Sequence[float], rise: float, first: float = 0.0
) -> tuple[Floats, Floats]:
    """Distance [m] and speed [m/s], each (n,): `first`, then a change to each level over `rise` along half a cosine."""
    x, v = first * t, np.full_like(t, first)
    for order, change in zip(orders, np.diff(levels, prepend=first), strict=True):
        since = np.maximum(t - order, 0.0)
        within = np.minimum(since, rise)
        v += change * 0.5 * (1.0 - np.cos(np.pi * within / rise))
        x += change * (0.5 * (within - rise / np.pi * np.sin(np.pi * within / rise)) + since - within)
    return x, v


def superpose(first: Trace, *others: Trace) -> Trace:
    """The sum of several motions at the first one's times.

    Raises
    ------
    InvalidInput
        A motion does not last over the first one's times: it would have to be guessed outside its own.
    """
    position, velocity = np.array(first.position), np.array(first.rates())
    for number, other in enumerate(others, start=2):
        if other.t[0] > first.t[0] or other.t[-1] < first.t[-1]:
            raise InvalidInput(
                f"Motions to add must cover {first.t[0]:g} to {first.t[-1]:g} s, but number {number} lasts from "
                f"{other.t[0]:g} to {other.t[-1]:g} s; make it as long as the first."
            )
        if np.array_equal(other.t, first.t):
            position += other.position
            velocity += other.rates()
        else:
            position += other.at(first.t)
            velocity += other.spline(first.t, 1)
    return Trace(t=first.t, position=position, velocity=velocity)
