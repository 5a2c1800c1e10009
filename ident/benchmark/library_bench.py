"""The reduced models beside SciPy's integrators at equal error: both march the same equations behind the same ship."""

import math
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from ident.benchmark import library_integrators as library
from ident.benchmark.library_integrators import IMPLICIT, Method, Problem
from ident.benchmark.reduced_bench import Precision, rms
from ident.timing import Timing, front, interleaved
from models import reduced
from models.drive import Drive
from models.quantity import NumericalFailure
from models.trace import Floats

#: No library is asked for less than this error [m/s]: the linear models are exact to rounding.
FLOOR = 1e-7
#: The search of a tolerance: the first over the model's largest error, and its range; the last; the share of the error
#: wanted that is aimed at; and a loose one for the first call.
_FIRST, _LOWEST, _HIGHEST, _TIGHT, _AIM, _CALL = 10.0, 1e-4, 1e-1, 1e-13, 0.8, 1e-2
#: A run is cut off after so many times the fastest so far, or after so long [s], but not before it took a few times the
#: fastest; the first ones have so long [s].
_HOPELESS, _ENOUGH, _FAIR, _PATIENCE = 12.0, 0.25, 2.0, 4.0
#: Runs are repeated up to so long [s], and up to so many times the fastest.
_LONG, _NEAR = 1.0, 1.5
#: A run at the tightest tolerance, that tells how far two codes' converged runs are apart.
_CONVERGED_TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class LibraryPoint:
    """One run: RMS velocity error [m/s] and CPU time of the record."""

    method: Method
    jacobian: bool
    tolerance: float
    error: float
    timing: Timing


@dataclass(frozen=True, slots=True, kw_only=True)
class Met:
    """What one integrator needs for the error wanted; `point` is its best where it was cut off before."""

    point: LibraryPoint
    reached: bool
    why: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Comparison:
    """One model beside the integrators.

    Parameters
    ----------
    wanted
        Error that the libraries have to meet [m/s]: the model's own at its usual step, or `FLOOR`.
    own
        Time of the model at its usual step, interleaved with theirs.
    runs
        Every run of every integrator.
    met
        What each needs for the error wanted.
    apart
        RMS difference of the model's converged run from LSODA's at a tolerance of 1e-9 [m/s].
    """

    precision: Precision
    wanted: float
    own: Timing
    runs: list[LibraryPoint]
    met: list[Met]
    apart: float

    @property
    def fastest(self) -> LibraryPoint:
        """The fastest run of those that meet the error.

        Raises
        ------
        NumericalFailure
            None of them does.
        """
        reached = [each.point for each in self.met if each.reached]
        if not reached:
            raise NumericalFailure(
                f"{self.precision.name}: no library integrator reached an error of {self.wanted:g} m/s; "
                "allow more time."
            )
        return min(reached, key=lambda point: point.timing.seconds)

    @property
    def ratio(self) -> float:
        """The fastest library's time over the model's."""
        return self.fastest.timing.seconds / self.own.seconds

    def ratios(self) -> list[float]:
        """The same at every step of the model, the libraries' time between their runs by log-log interpolation.

        Where the libraries have no run of so large an error, their cheapest counts; of so small a one, nan.
        """
        runs = [*self.runs, *(each.point for each in self.met)]
        best = front([(run.error, run.timing.seconds) for run in runs], lambda point: point)
        errors, seconds = np.log(np.array(best)[::-1].T)
        found = []
        for point in self.precision.points:
            at = np.interp(math.log(max(point.error, FLOOR)), errors, seconds, left=np.nan)
            found.append(float(np.exp(at)) / point.timing.seconds)
        return found


def compare(found: Precision, drive: Drive, methods: Sequence[Method], *, repetitions: int = 3) -> Comparison:
    """A model beside the integrators: each at the tolerance that just meets the model's error, as far as it pays.

    Raises
    ------
    NumericalFailure
        LSODA gives up at the tightest tolerance.
    """
    model = found.model
    given = library.problem(model.chain(), model.drag, drive)
    wanted = max(found.usual.error, FLOOR)
    loosest = max(FLOOR, *(point.error for point in found.points))
    library.velocity(given, "LSODA", _CALL, jacobian=True)  # compiles
    search = _Search(given, found.converged, wanted, loosest)
    met = [search.meet(method) for method in methods]
    best = min((each.point.timing.seconds for each in met if each.reached), default=math.inf)
    near = [each for each in met if each.reached and each.point.timing.seconds < min(_LONG, _NEAR * best)]
    works: list[Callable[[], object]] = [lambda: reduced.respond(model, drive)]
    works += [_again(given, each.point) for each in near]
    own, *timings = interleaved(works, repetitions)
    timed = {id(each): timing for each, timing in zip(near, timings, strict=True)}
    met = [
        replace(each, point=replace(each.point, timing=timed[id(each)])) if id(each) in timed else each for each in met
    ]
    tight = library.velocity(given, "LSODA", _CONVERGED_TOLERANCE)
    return Comparison(
        precision=found,
        wanted=wanted,
        own=own,
        runs=search.runs,
        met=met,
        apart=rms(tight - found.converged),
    )


def _again(given: Problem, point: LibraryPoint) -> Callable[[], object]:
    return lambda: library.velocity(given, point.method, point.tolerance, jacobian=point.jacobian)


class _Search:
    """Tolerances of the integrators for one problem; `best` is the shortest time that met the error so far [s]."""

    def __init__(self, given: Problem, exact: Floats, wanted: float, loosest: float) -> None:
        self.given, self.exact, self.wanted = given, exact, wanted
        self.begin = min(max(_FIRST * loosest, _LOWEST), _HIGHEST)
        self.runs: list[LibraryPoint] = []
        self.best = math.inf

    def meet(self, method: Method) -> Met:
        """The loosest tolerance that meets the error: by decades, then between the two that bracket it."""
        above: LibraryPoint | None = None
        try:
            run = self._first(method)
            jacobian = run.jacobian
            while run.error > self.wanted and run.tolerance > _TIGHT:
                above = run
                run = self._run(method, 0.1 * run.tolerance, jacobian)
        except NumericalFailure as failure:
            return self._given_up(method, above, str(failure))
        if run.error > self.wanted:
            return self._given_up(method, run, "no tolerance meets the error")
        with suppress(NumericalFailure):
            while above is None and run.tolerance < _HIGHEST:
                looser = self._run(method, 10.0 * run.tolerance, jacobian)
                if looser.error > self.wanted:
                    above = looser
                else:
                    run = looser
            if above is not None:
                run = self._between(run, above)
        self.best = min(self.best, run.timing.seconds)
        return Met(point=run, reached=True)

    def _between(self, below: LibraryPoint, above: LibraryPoint) -> LibraryPoint:
        """A looser tolerance than `below` that still meets the error: by the slope, else halfway; or `below` itself."""
        slope = math.log(above.error / below.error) / math.log(above.tolerance / below.tolerance)
        aimed = below.tolerance * (_AIM * self.wanted / below.error) ** (1.0 / slope)
        for tolerance in (aimed, math.sqrt(below.tolerance * min(aimed, above.tolerance))):
            if below.tolerance < tolerance < above.tolerance:
                run = self._run(below.method, tolerance, below.jacobian)
                if run.error <= self.wanted:
                    return run
        return below

    def _first(self, method: Method) -> LibraryPoint:
        """The first run, with compiled derivatives where they make it faster."""
        if method not in IMPLICIT:
            return self._run(method, self.begin, False)
        return min((self._run(method, self.begin, each) for each in (False, True)), key=lambda run: run.timing.seconds)

    def _run(self, method: Method, tolerance: float, jacobian: bool) -> LibraryPoint:
        limit = max(min(_HOPELESS * self.best, _ENOUGH), _FAIR * self.best) if math.isfinite(self.best) else _PATIENCE
        began = time.thread_time()
        velocity = library.velocity(self.given, method, tolerance, jacobian=jacobian, limit=limit)
        timing = Timing(time.thread_time() - began, 0.0, 1)
        error = rms(velocity - self.exact)
        self.runs.append(
            LibraryPoint(method=method, jacobian=jacobian, tolerance=tolerance, error=error, timing=timing)
        )
        return self.runs[-1]

    def _given_up(self, method: Method, last: LibraryPoint | None, why: str) -> Met:
        blank = LibraryPoint(
            method=method, jacobian=False, tolerance=math.nan, error=math.nan, timing=Timing(math.nan, math.nan, 0)
        )
        return Met(point=last or blank, reached=False, why=why)
