"""Timings that bear comparison: CPU time of the calling thread, interleaved repetitions, the median and its spread."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

_T = TypeVar("_T")

#: A timing lasts at least so long [s]: shorter work is done several times over.
LEAST = 0.01


@dataclass(frozen=True, slots=True)
class Timing:
    """Median CPU time of one call [s], and the range of its repetitions as a share of it."""

    seconds: float
    spread: float
    repetitions: int

    def over(self, duration: float) -> "Timing":
        """The same as a share of a duration [s]."""
        return replace(self, seconds=self.seconds / duration)


def interleaved(works: Sequence[Callable[[], object]], repetitions: int = 5, least: float = LEAST) -> list[Timing]:
    """Time every work in turn, so often over, so that a slow spell of the machine falls on all of them.

    Each has been called once before, for its compilation and for the number of calls that last `least` seconds.
    """
    counts = []
    for work in works:
        work()
        counts.append(max(1, math.ceil(least / max(_timed(work, 1), 1e-9))))
    taken = np.array(
        [[_timed(work, n) for work, n in zip(works, counts, strict=True)] for _ in range(max(1, repetitions))]
    )
    median = np.median(taken, axis=0)
    spread = np.ptp(taken, axis=0) / median
    return [Timing(float(m), float(s), max(1, repetitions)) for m, s in zip(median, spread, strict=True)]


def front(points: Sequence[_T], cost: Callable[[_T], tuple[float, float]]) -> list[_T]:
    """The points that no other beats in both error and time, given by `cost`, from the largest error down."""
    kept: list[_T] = []
    for point in sorted(points, key=lambda each: (cost(each)[1], cost(each)[0])):
        if not kept or cost(point)[0] < cost(kept[-1])[0]:
            kept.append(point)
    return kept


def exponent(sizes: Sequence[float], seconds: Sequence[float]) -> float:
    """Least-squares slope of log time against log size."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])


def _timed(work: Callable[[], object], count: int) -> float:
    began = time.thread_time()
    for _ in range(count):
        work()
    return (time.thread_time() - began) / count
