"""Error against run time of the matrix method: its tolerance, its mesh, how it grows, and other solvers."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ident.benchmark.banded_response import BandedResponse, Drag
from ident.benchmark.chain_bench import Growth
from ident.timing import Timing, interleaved
from models.statics import static_shape
from models.tow import Tow
from models.transfer_matrix import Response, frequency_response
from models.transfer_matrix.line import Line, linearise
from models.transfer_matrix.response import QUANTITIES
from models.transfer_matrix.setup import Complexes, Floats, direction_of, nodes_of
from models.transfer_matrix.work import MOST_ITERATIONS, Work

#: The run of H: frequencies between two [rad/s], segments, tolerance, motion along the cable's top [m].
LOW, HIGH, FREQUENCIES, SEGMENTS, TOLERANCE, AMPLITUDE = 0.05, 1.5, 100, 82, 1e-4, 1.0
#: Tolerance of runs whose mesh alone is to err; and of those whose drag stands.
TIGHT, _TIGHTEST = 1e-10, 1e-13
#: The converged run has so many times the segments of the finest.
FINER = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is run; `record` of a random sea [s]."""

    frequencies: int = FREQUENCIES
    segments: tuple[int, ...] = (16, 32, 64, 128, 256, 512, 1024)
    tolerances: tuple[float, ...] = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)
    growth_segments: tuple[int, ...] = (41, 82, 164, 328, 656, 1312)
    growth_frequencies: tuple[int, ...] = (25, 50, 100, 200, 400, 800)
    repetitions: int = 5
    record: float = 3600.0


FULL = Effort()
#: Enough to see that everything still runs.
REDUCED = Effort(
    frequencies=10,
    segments=(16, 32),
    tolerances=(1e-2, 1e-4),
    growth_segments=(20, 40, 80),
    growth_frequencies=(5, 10, 20),
    repetitions=1,
    record=120.0,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """A run with one mesh and tolerance.

    `velocity_error` is the RMS velocity error of the body over time and frequencies [m/s]; `share` the largest error
    of a motion of the body or of an end tension, over its largest amplitude.
    """

    segments: int
    tolerance: float
    solves: int
    velocity_error: float
    share: float
    timing: Timing


@dataclass(frozen=True, slots=True, kw_only=True)
class Precision:
    """Every setting of one tow, and the converged run's own errors, estimated with half its segments.

    `start` is the time of mesh and steady shape.
    """

    points: list[Setting]
    start: Timing
    uncertainty: float
    share: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Solved:
    """One way to solve the same equations: how far from the band matrix, and the fewest digits that it says it kept."""

    solver: str
    timing: Timing
    apart: float
    digits: float


def frequencies(count: int) -> Floats:
    """The frequencies of H's run [rad/s]."""
    return np.linspace(LOW, HIGH, count)


class March(Work):
    """The solves of one run on a mesh of so many segments, with the steady shape found before."""

    def __init__(self, line: Line, omega: Floats, tolerance: float = TOLERANCE, most: int = MOST_ITERATIONS) -> None:
        super().__init__(line, omega, np.tile(AMPLITUDE * direction_of(line, "axial"), (omega.size, 1)).astype(complex))
        self._tolerance, self._most = tolerance, most

    def __call__(self) -> Drag:
        """Iterate the drag of every frequency; that of the last."""
        self.march(tolerance=self._tolerance, most=self._most)
        return Drag(b=self.b, D=self.D)

    def once(self, drag: Drag, by_product: bool = False) -> None:
        """Solve every frequency once with the same drag."""
        self.solve(drag.b, drag.D, drag.b_turn, by_product=by_product)


def line_with(tow: Tow, segments: int, omega: Floats) -> Line:
    """The tow linearised on a graded mesh."""
    return linearise(tow, static_shape(tow, nodes=nodes_of(tow, segments, omega, AMPLITUDE)))


def tolerances(tow: Tow, effort: Effort = FULL) -> list[Setting]:
    """What a tolerance leaves, on the mesh of H, beside a run whose drag stands."""
    omega = frequencies(effort.frequencies)
    nodes = nodes_of(tow, SEGMENTS, omega, AMPLITUDE)
    stands = _run(tow, nodes, omega, _TIGHTEST)
    line = linearise(tow, stands.shape)
    timings = interleaved([March(line, omega, each) for each in effort.tolerances], effort.repetitions)
    return [
        _setting(_run(tow, nodes, omega, tolerance), stands, tolerance, timing)
        for tolerance, timing in zip(effort.tolerances, timings, strict=True)
    ]


def precision(tow: Tow, effort: Effort = FULL) -> Precision:
    """Error and time over the segments, the drag iterated until it stands."""
    omega = frequencies(effort.frequencies)
    finest = FINER * max(effort.segments)
    converged, half = (
        _run(tow, nodes_of(tow, count, omega, AMPLITUDE), omega, TIGHT) for count in (finest, finest // 2)
    )
    runs = [_run(tow, nodes_of(tow, count, omega, AMPLITUDE), omega, TIGHT) for count in effort.segments]
    marches = [March(linearise(tow, run.shape), omega, TIGHT) for run in runs]
    *timings, start = interleaved([*marches, partial(line_with, tow, SEGMENTS, omega)], effort.repetitions)
    return Precision(
        points=[_setting(run, converged, TIGHT, timing) for run, timing in zip(runs, timings, strict=True)],
        start=start,
        uncertainty=_velocity_error(converged, half) / 3.0,
        share=_share(half, converged) / 3.0,
    )


def growth(tow: Tow, effort: Effort = FULL) -> tuple[Growth, Growth]:
    """Time of the solves to H's tolerance against segments and against frequencies."""
    omega = frequencies(effort.frequencies)
    by_segments = [March(line_with(tow, count, omega), omega) for count in effort.growth_segments]
    line = line_with(tow, SEGMENTS, omega)
    by_frequencies = [March(line, frequencies(count)) for count in effort.growth_frequencies]
    return (
        _growth("segments", effort.growth_segments, by_segments, effort),
        _growth("frequencies", effort.growth_frequencies, by_frequencies, effort),
    )


def solvers(tow: Tow, effort: Effort = FULL) -> list[Solved]:
    """The stable sweep, H's product and a band matrix on the same equations, once at every frequency.

    The drag is that of the highest frequency; states are compared in the sweep's own measure, over the largest.
    """
    omega = frequencies(effort.frequencies)
    march = March(line_with(tow, SEGMENTS, omega), omega, TIGHT)
    drag = march()
    bands = [
        BandedResponse(line=march.line, drag=drag, top=top, scale=scale)
        for top, scale in zip(march.tops, march.scales, strict=True)
    ]

    def band() -> Complexes:
        return np.array([each.solve(one) for each, one in zip(bands, omega.tolist(), strict=True)])

    reference, found = band(), []
    works = {"stable sweep": partial(march.once, drag), "product of matrices": partial(march.once, drag, True)}
    for name, work in works.items():
        work()
        apart = max(
            each.size_of(states - exact) / each.size_of(exact)
            for each, states, exact in zip(bands, march.states, reference, strict=True)
        )
        found.append((name, apart, float(march.digits.min()) if name != "stable sweep" else float("nan")))
    timings = interleaved([*works.values(), band], effort.repetitions)
    found.append(("band matrix, LAPACK", 0.0, float("nan")))
    return [
        Solved(solver=name, timing=timing, apart=apart, digits=digits)
        for (name, apart, digits), timing in zip(found, timings, strict=True)
    ]


def _run(tow: Tow, nodes: Floats, omega: Floats, tolerance: float) -> Response:
    return frequency_response(tow, omega, amplitude=AMPLITUDE, nodes=nodes, tolerance=tolerance, companion=False)


def _setting(run: Response, converged: Response, tolerance: float, timing: Timing) -> Setting:
    return Setting(
        segments=run.shape.s.size - 1,
        tolerance=tolerance,
        solves=int(run.iterations.sum()),
        velocity_error=_velocity_error(run, converged),
        share=_share(run, converged),
        timing=timing,
    )


def _velocity_error(run: Response, other: Response) -> float:
    """RMS of the error of the body's velocity over time and over the frequencies [m/s]."""
    apart = np.abs(run.motion[:, :2] - other.motion[:, :2]) ** 2
    return float(np.sqrt(0.5 * np.mean(run.omega**2 * apart.sum(axis=1))))


def _share(run: Response, converged: Response) -> float:
    errors = {name: np.abs(getattr(run, name) - getattr(converged, name)) for name in QUANTITIES}
    return max(replace(converged, error=errors).shares.values())


def _growth(what: str, sizes: Sequence[int], works: Sequence[March], effort: Effort) -> Growth:
    timings = interleaved(works, effort.repetitions)
    return Growth(
        what=what,
        sizes=sizes,
        seconds=[timing.seconds for timing in timings],
        iterations=[float(work.iterations.mean()) for work in works],
        spread=[timing.spread for timing in timings],
        repetitions=effort.repetitions,
    )
