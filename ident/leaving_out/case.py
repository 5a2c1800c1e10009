"""What a scene does without: that it equals the full model with the term at zero, what that saves, what it costs.

Every case has up to three forms of one scene: `off`, without the term; `zero`, the same with the term built and next
to nothing (`NOTHING`), so that all of its work is done and no digit changes; `on`, the term as strong as it may well
be. `off` against `zero` shows that leaving out changes nothing and what it saves, `on` against `off` what it would
cost where the term matters.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple, dataclass
from itertools import zip_longest

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ident.timing import Timing, interleaved

Floats = NDArray[np.float64]
#: A simulator's answer by quantity; a simulation in time has a ``velocity`` of the vehicle among them [m/s].
Answer = Mapping[str, NDArray[np.float64] | NDArray[np.complex128]]

#: What a term is set to, in its own unit: above zero, so that no array or branch is spared, and lost in every sum;
#: its square is no denormal number, which would be slow to compute with.
NOTHING = 1e-60
#: A timing lasts at least so long [s].
_LEAST = 0.004


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One term of one scene with one simulator.

    Parameters
    ----------
    off, zero, on
        The forms that are timed, as `scene` runs them; without `zero` the simulator has no such form.
    same_off, same_zero
        What is compared in their place, where both forms must be brought onto the same steps.
    beside
        What `on` is compared with; `off` where left out.
    built_off, built_on
        The arrays that the kernels read, split into what belongs to one quantity each.
    strength
        How strong the term is in `on`, in words.
    note
        What a reader must know of the row.
    """

    scene: str
    simulator: str
    term: str
    strength: str
    off: Callable[[], Answer]
    on: Callable[[], Answer]
    zero: Callable[[], Answer] | None = None
    same_off: Callable[[], Answer] | None = None
    same_zero: Callable[[], Answer] | None = None
    beside: Callable[[], Answer] | None = None
    built_off: Callable[[], Sequence[Floats]] = tuple
    built_on: Callable[[], Sequence[Floats]] = tuple
    note: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """What was found of a case.

    `seconds_*` are those of a call, NaN without the form; `apart` is the largest difference of `off` and `zero` over
    the largest value of each quantity; `idle` [bytes] the arrays that are built of zeros for the term that is off, of
    `built` [bytes], which is 0 where no arrays are compared; `error` is the RMS velocity error [m/s], or the largest
    share of an amplitude, as `error_unit` says.
    """

    scene: str
    simulator: str
    term: str
    seconds_off: float
    seconds_zero: float
    seconds_on: float
    spread: float
    apart: float
    built: int
    idle: int
    strength: str
    error: float
    error_unit: str
    note: str


def measure(case: Case, repetitions: int) -> Row:
    """Run, compare and time the forms of one case."""
    works = [case.off, case.on, *([] if case.zero is None else [case.zero])]
    timings: list[Timing] = interleaved(works, repetitions, _LEAST)
    zero = timings[2].seconds if case.zero is not None else float("nan")
    built, idle = _arrays(case.built_off(), case.built_on())
    error, unit = difference((case.beside or case.off)(), case.on())
    same = (case.same_off or case.off, case.same_zero or case.zero)
    return Row(
        scene=case.scene,
        simulator=case.simulator,
        term=case.term,
        seconds_off=timings[0].seconds,
        seconds_zero=zero,
        seconds_on=timings[1].seconds,
        spread=max(timing.spread for timing in timings),
        apart=float("nan") if same[1] is None else apart(same[0](), same[1]()),
        built=built,
        idle=idle,
        strength=case.strength,
        error=error,
        error_unit=unit,
        note=case.note,
    )


def table(rows: Sequence[Row]) -> pd.DataFrame:
    """One line a row, in the order of its fields."""
    return pd.DataFrame([astuple(row) for row in rows], columns=list(Row.__dataclass_fields__))


def apart(one: Answer, other: Answer) -> float:
    """The largest difference of two answers, over the largest value of each quantity."""
    return max(_share(one[name], other[name]) for name in one)


def difference(one: Answer, other: Answer) -> tuple[float, str]:
    """RMS difference in velocity [m/s] where there is one, else the largest share of an amplitude, with its unit."""
    if "velocity" in one:
        square = np.abs(one["velocity"] - other["velocity"]) ** 2
        return float(np.sqrt(square.sum() / len(square))), "m/s RMS"
    return apart(one, other), "of the largest amplitude"


def _share(one: NDArray[np.generic], other: NDArray[np.generic]) -> float:
    size, gap = float(np.abs(one).max(initial=0.0)), float(np.abs(one - other).max(initial=0.0))  # type: ignore[operator]
    return gap / size if size > 0.0 else gap


def _arrays(off: Sequence[Floats], on: Sequence[Floats]) -> tuple[int, int]:
    """Bytes that are built without the term, and those of them that are zeros which only the term would fill."""
    idle = 0
    for without, within in zip_longest(off, on, fillvalue=np.zeros(0)):
        if not without.any() and within.any():
            idle += without.nbytes
    return sum(each.nbytes for each in off), idle
