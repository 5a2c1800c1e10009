"""The learning model, T chapter 5: parameters moved until the open-loop response matches the record.

The cost is the RMS velocity error over all scored samples of all records; the search is SciPy's Nelder-Mead on
log-parameters, restarted from its best point (`ident.simplex`), after a look around the guess (`ident.scouting`).
Position is never fitted.
"""

import math
import sys
import time
from collections.abc import Callable, Collection, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

from ident.cases import Case, Floats
from ident.identifiability import Identifiability, examine
from ident.search_space import SearchSpace
from ident.simplex import EXACT, GAIN, RESTARTS
from ident.starts import StartResult, nearest_of_equals, search_all
from models import reduced
from models.quantity import InvalidInput, NumericalFailure
from models.reduced import ReducedModel

Outcome = Literal["converged", "bound", "budget", "flat", "failed"]

#: Simulations of one start, all restarts together, unless given.
BUDGET = 4000

#: Longest wait for the interpreter's lock while fits run side by side [s].
SWITCH = 2e-4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Fit:
    """A fitted model and how it came about.

    Parameters
    ----------
    model, start
        The fitted model, and the one that the search started from (the mapped guess).
    names
        The parameters that were searched; `at_bound` those that ended at the end of their range.
    rms, start_rms
        RMS velocity error at the end and at the start [m/s].
    simulations, failures, seconds
        Simulations of the whole search, how many of them failed, and its wall time.
    reason
        Why the search stopped, a sentence for the user.
    costs
        (k,) RMS velocity error [m/s] of every evaluation of the best start's search, in order.
    gains
        Relative gain of every restart of the best start.
    waterfall
        All starts, the best first.
    identifiability
        ``None`` where the fit failed.
    step_error
        RMS velocity error [m/s] that the fitted model's steps leave on the worst record, estimated by finer ones;
        NaN where nothing was examined, infinite where finer steps fail.
    """

    model: ReducedModel
    start: ReducedModel
    records: tuple[str, ...]
    names: tuple[str, ...]
    at_bound: tuple[str, ...]
    rms: float
    start_rms: float
    simulations: int
    failures: int
    seconds: float
    outcome: Outcome
    reason: str
    costs: Floats
    gains: tuple[float, ...]
    waterfall: tuple[StartResult, ...]
    identifiability: Identifiability | None
    step_error: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Job:
    """One fit of `fit_many`; the fields are the arguments of `fit`."""

    model: ReducedModel
    cases: Sequence[Case]
    fixed: Collection[str] = ()
    budget: int = BUDGET
    starts: int = 1
    seed: int = 0
    profile: bool = True
    within: float | None = None


def fit(
    model: ReducedModel,
    cases: Sequence[Case],
    *,
    fixed: Collection[str] = (),
    budget: int = BUDGET,
    starts: int = 1,
    seed: int = 0,
    profile: bool = True,
    within: float | None = None,
) -> Fit:
    """Fit a model's parameters to records, from the values it has.

    Parameters
    ----------
    fixed
        Names of parameters that keep their values.
    budget
        Simulations for each start point, its restarts and the look around the first guess (`ident.scouting`) included.
    starts
        Start points: the model itself, and others scattered about it; some models have more (`ident.starts`).
    seed
        Of the further start points and of the search for twins.
    profile
        Let wide 95 % intervals follow the profile of the cost (`ident.profile`).
    within
        Search within this factor of the model's own values (`SearchSpace.of`).

    Raises
    ------
    InvalidInput
        There is no record, a count is below one, or `fixed` does not fit the model.
    """
    if not cases or starts < 1 or budget < 1:
        raise InvalidInput(
            f"A fit needs at least one record, one start and one simulation, but got {len(cases)} records, "
            f"{starts} starts and a budget of {budget}."
        )
    began = time.perf_counter()
    space = SearchSpace.of(model, fixed=fixed, within=within)
    results, near = search_all(space, cases, budget=budget, starts=starts, seed=seed)
    best = nearest_of_equals(space, results)
    seconds = time.perf_counter() - began
    fitted, trouble = model, ""
    at_bound: tuple[str, ...] = ()
    examined: Identifiability | None = None
    if math.isfinite(best.rms):
        u = best.coordinates(space)
        fitted = space.model_at(u)
        at_bound = tuple(space.names[j] for j in space.at_bound(u))
        try:
            examined = examine(space, u, cases, candidates=near if best is results[0] else None, profile=profile)
        except NumericalFailure as failure:
            trouble = str(failure)
    guess = next(result for result in results if result.number == 0)
    outcome, reason = _verdict(best, examined, at_bound, trouble)
    return Fit(
        model=fitted,
        start=model,
        records=tuple(case.name for case in cases),
        names=space.names,
        at_bound=at_bound,
        rms=best.rms,
        start_rms=float(guess.costs[0]) if guess.costs.size else math.inf,
        simulations=sum(result.simulations for result in results),
        failures=sum(result.failures for result in results),
        seconds=seconds,
        outcome=outcome,
        reason=reason,
        costs=best.costs,
        gains=best.gains,
        waterfall=tuple(results),
        identifiability=examined,
        step_error=math.nan if examined is None else _step_error(fitted, cases),
    )


def _step_error(model: ReducedModel, cases: Sequence[Case]) -> float:
    """On the worst record [m/s]; infinite where finer steps fail."""
    try:
        return max(reduced.step_error(model, case.drive) for case in cases)
    except NumericalFailure:
        return math.inf


def fit_many(
    jobs: Iterable[Job], *, workers: int = 2, done: Callable[[int, Fit], None] | None = None
) -> tuple[Fit, ...]:
    """Run fits side by side in threads; the kernels release the interpreter's lock.

    Parameters
    ----------
    done
        Called with the job's position and its fit as each ends, in the thread that ran it.

    Returns
    -------
    tuple of Fit
        In the order of the jobs; the same whatever the number of workers.
    """

    def run(place: int, job: Job) -> Fit:
        result = fit(
            job.model,
            job.cases,
            fixed=job.fixed,
            budget=job.budget,
            starts=job.starts,
            seed=job.seed,
            profile=job.profile,
            within=job.within,
        )
        if done is not None:
            done(place, result)
        return result

    interval = sys.getswitchinterval()
    # A kernel of a millisecond must not wait five for the lock that its neighbour holds between two kernels.
    sys.setswitchinterval(SWITCH)
    try:
        with ThreadPoolExecutor(max_workers=workers) as pool:
            futures = [pool.submit(run, place, job) for place, job in enumerate(jobs)]
            try:
                return tuple(future.result() for future in futures)
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
    finally:
        sys.setswitchinterval(interval)


def _verdict(
    best: StartResult, examined: Identifiability | None, at_bound: Sequence[str], trouble: str
) -> tuple[Outcome, str]:
    """The outcome, the gravest first, and why."""
    if not math.isfinite(best.rms):
        if best.budget_spent:
            return "budget", f"The budget of {best.simulations} simulations did not reach one comparison."
        return "failed", f"The simulation at the start point failed: {best.last_failure}"
    ending = f"RMS velocity error {best.rms:.3g} m/s after {best.simulations} simulations"
    if best.failures:
        ending += f" ({best.failures} failed and counted as infinite)"
    if best.budget_spent:
        return "budget", f"The simulations were used up before the search had settled: {ending}."
    if not best.settled:
        return "budget", (
            f"The last of {RESTARTS} restarts still gained {(best.gains or (1.0,))[-1]:.1e}, above {GAIN:g}: {ending}."
        )
    if examined is None:
        return "failed", f"The model cannot be simulated right beside the best point: {trouble}"
    if at_bound:
        return "bound", f"{', '.join(at_bound)} ended at the end of the search range: {ending}."
    if examined.flat:
        return "flat", (
            f"The record does not tell {examined.directions[-1].text}: {ending}, and other values would do as well."
        )
    if best.rms <= EXACT:
        return "converged", f"The fit is exact to rounding: {ending}."
    return "converged", f"A restart from a fresh simplex gained less than {GAIN:g}: {ending}."
