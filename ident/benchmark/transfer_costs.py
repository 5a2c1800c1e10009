"""What H's run of the matrix method takes (section IV-D), by part: time, operations beside H Table VI, compiling."""

import math
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ident.benchmark import operations
from ident.benchmark.banded_response import Drag
from ident.benchmark.transfer_bench import (
    AMPLITUDE,
    FULL,
    HIGH,
    LOW,
    SEGMENTS,
    TIGHT,
    TOLERANCE,
    Effort,
    March,
    frequencies,
    line_with,
)
from ident.timing import Timing, interleaved
from models.statics import static_shape
from models.tow import Tow
from models.transfer_matrix import frequency_response
from models.transfer_matrix.line import Line, linearise
from models.transfer_matrix.march import harmonic_march
from models.transfer_matrix.setup import Floats, nodes_of

#: Its CPU time [s] and iterations a frequency on an HP 705, and the operations of H Table VI for its 83 nodes.
PRINTED_SECONDS, PRINTED_ITERATIONS, PRINTED_OPERATIONS = 1160.0, 6, 227100
#: Names of three parts of it: as a user asks for it, on a given mesh as H's, and its solves alone.
WHOLE, GIVEN, SOLVES = "whole run", "whole run on a given mesh", "solves of all frequencies"
#: Frequencies, iterations and segments of the runs that the time of each part is fitted to.
_FITTED, _ROUNDS, _FEW = 8, 6, (4, 8, 16, 32, 64, 128)


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What a part of a run takes; `tolerance` and `solves`, of all frequencies, where it has any."""

    part: str
    timing: Timing
    tolerance: float
    solves: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """Operations of one iteration at one frequency, H's printed and ours, all and of a node, and the time of both."""

    part: str
    printed: int
    printed_per_node: int
    counted: int
    counted_per_node: float
    nanoseconds_per_node: float
    nanoseconds: float


def parts(tow: Tow, effort: Effort = FULL) -> list[Part]:
    """The run of H as a user calls it, at its tolerance, and what its parts take."""
    omega = frequencies(effort.frequencies)
    nodes = nodes_of(tow, SEGMENTS, omega, AMPLITUDE)
    shape = static_shape(tow, nodes=nodes)
    line = linearise(tow, shape)
    run = partial(frequency_response, tow, omega, amplitude=AMPLITUDE)
    solve, solve_on = March(line, omega), March(line, omega, TIGHT)
    works: dict[str, tuple[Callable[[], object], float]] = {
        WHOLE: (partial(run, segments=SEGMENTS, tolerance=TOLERANCE, companion=False), TOLERANCE),
        GIVEN: (partial(run, nodes=nodes, tolerance=TOLERANCE, companion=False), TOLERANCE),
        "mesh": (partial(nodes_of, tow, SEGMENTS, omega, AMPLITUDE), math.nan),
        "steady shape": (partial(static_shape, tow, nodes=nodes), math.nan),
        "linearised about it": (partial(linearise, tow, shape), math.nan),
        SOLVES: (solve, TOLERANCE),
        f"the same to {TIGHT:g}": (solve_on, TIGHT),
        "whole run with the error of its mesh": (partial(run, segments=SEGMENTS, tolerance=TOLERANCE), TOLERANCE),
    }
    timings = interleaved([work for work, _ in works.values()], effort.repetitions)
    solves = {TOLERANCE: int(solve.iterations.sum()), TIGHT: int(solve_on.iterations.sum())}
    return [
        Part(part=name, timing=timing, tolerance=tolerance, solves=solves.get(tolerance, 0))
        for (name, (_, tolerance)), timing in zip(works.items(), timings, strict=True)
    ]


def costs(tow: Tow, effort: Effort = FULL) -> tuple[list[Cost], Counter[str]]:
    """One iteration at one frequency, by part beside H Table VI, and our operations by kernel.

    The time of a part is fitted as a + c n to runs of so many segments each, with the drag brought up to date
    and without; what needs no node is a.
    """
    line = line_with(tow, SEGMENTS, frequencies(effort.frequencies))
    tally = _counted(line)
    nodes = line.h.size + 1
    solve, march = _fits(tow, effort)
    lower = tally["solve.lower_end"] + tally["march._solve"]
    sweep = sum(count for name, count in tally.items() if name.startswith("solve.")) - tally["solve.lower_end"]
    rows = (
        ("A(s), steps and states along the cable", 212900, 2566, sweep, solve[1], 0.0),
        ("lower end", 4400, 0, lower, 0.0, solve[0]),
        ("drag brought up to date, error norm", 9800, 118, tally.total() - sweep - lower, *(march - solve)[::-1]),
    )
    found = [
        Cost(
            part=part,
            printed=printed,
            printed_per_node=per_node,
            counted=counted,
            counted_per_node=counted / nodes if per_node else 0.0,
            nanoseconds_per_node=1e9 * slope,
            nanoseconds=1e9 * (constant + slope * nodes),
        )
        for part, printed, per_node, counted, slope, constant in rows
    ]
    return found, tally


def _counted(line: Line) -> Counter[str]:
    """Operations of one iteration at the middle frequency, by function."""
    tally: Counter[str] = Counter()
    count = partial(operations.counting, tally=tally)
    omega = np.array([0.5 * (LOW + HIGH)])
    march = March(line, omega)
    drag = march()
    n = line.h.size
    tally.clear()
    operations.in_python(harmonic_march)(
        count(omega), count(line.ends), count(line.nodes), line.h, count(line.body), count(march.scales),
        count(march.tops), np.zeros(4), False, -1.0, 1, operations.empty(1, n + 1, 4), operations.empty(1, 3),
        count(drag.b), count(drag.D), np.zeros(1, dtype=int), operations.empty(1), operations.empty(1),
    )  # fmt: skip
    return tally


def _fits(tow: Tow, effort: Effort) -> tuple[Floats, Floats]:
    """(a, c) [s] of one solve at one frequency with c n segments, with given drag and with the drag brought up."""
    omega = frequencies(_FITTED)
    works: list[partial[None]] = []
    for segments in _FEW:
        # A tolerance below zero is never met: every frequency takes all rounds.
        march = March(line_with(tow, segments, omega), omega, -1.0, _ROUNDS)
        works += [partial(_rounds, march, march()), partial(_march, march)]
    taken = np.array([each.seconds for each in interleaved(works, effort.repetitions)]).reshape(-1, 2)
    taken /= _FITTED * _ROUNDS
    # Of equal relative weight, so that the short runs tell the constant.
    solve, march_time = (np.polyfit(_FEW, each, 1, w=1.0 / each)[::-1] for each in taken.T)
    return solve, march_time


def _rounds(march: March, drag: Drag) -> None:
    for _ in range(_ROUNDS):
        march.once(drag)


def _march(march: March) -> None:
    march()


def first_call(tow: Tow) -> float:
    """CPU time of the first call less that of the second [s]: what is left of compiling, nothing once it is kept."""
    taken = []
    for _ in range(2):
        began = time.thread_time()
        frequency_response(tow, frequencies(2), segments=16, companion=False)
        taken.append(time.thread_time() - began)
    return taken[0] - taken[1]
