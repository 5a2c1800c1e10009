"""What an identification costs: the best error found against simulations and CPU time, with and without restart.

Without restart is a search that ends with its first simplex, so that it is the beginning of the search with restarts;
SciPy's Nelder-Mead as it comes, with its own first simplex and its own end, stands beside both.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from scipy.optimize import minimize

from ident.cases import Case, case_from_truth
from ident.configuration import Configuration
from ident.learning import BUDGET
from ident.objective import BudgetSpent, Objective
from ident.search_space import SearchSpace
from ident.simplex import search
from ident.truth import identification_ship, reference_run, start_of
from models.quantity import NumericalFailure
from models.reduced import ReducedModel
from models.trace import Floats, Trace

ONCE, RESTARTED, PLAIN = "once", "with restarts", "SciPy's own simplex"
_SEED, _MANY = 0, 10**9
_T = TypeVar("_T")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Descent:
    """One search of one model.

    Parameters
    ----------
    model, how
        The model's name, and one of `ONCE`, `RESTARTED`, `PLAIN`.
    best, seconds
        (k,) the lowest RMS velocity error [m/s] and the CPU time [s] after every simulation.
    starts
        Simulations done when each simplex began: 0, and one for every restart.
    ended
        The search came to its own end, not to that of its budget.
    """

    model: str
    how: str
    best: Floats
    seconds: Floats
    starts: tuple[int, ...]
    ended: bool

    @property
    def found(self) -> float:
        """The lowest RMS velocity error [m/s]."""
        return float(self.best[-1])

    def until(self, simulations: int) -> "Descent":
        """The beginning of the search, as one without restart."""
        return Descent(
            model=self.model,
            how=ONCE,
            best=self.best[:simulations],
            seconds=self.seconds[:simulations],
            starts=self.starts[:1],
            ended=self.ended or simulations < self.best.size,
        )


class _Timed:
    """An objective that keeps the CPU time at every simulation, and where each simplex begins."""

    def __init__(self, objective: Objective) -> None:
        self.objective = objective
        self.seconds: list[float] = []
        self.starts: list[int] = []
        self._descending = True
        self._begun = time.thread_time()

    @property
    def best(self) -> float:
        """The lowest cost so far [m/s]."""
        return self.objective.best

    @property
    def best_at(self) -> Floats | None:
        """Where it was."""
        return self.objective.best_at

    @property
    def upper(self) -> Floats:
        """(p,) upper ends of the search coordinates."""
        return self.objective.upper

    def residuals(self, u: Floats) -> Floats:
        """(m,) residuals; the search asks for them to orient a simplex, and for nothing but costs within it."""
        if self._descending:
            self.starts.append(len(self.objective.costs))
        self._descending = False
        return self._timed(self.objective.residuals, u)

    def __call__(self, u: Floats) -> float:
        """The cost [m/s]."""
        self._descending = True
        return self._timed(self.objective, u)

    def _timed(self, work: Callable[[Floats], _T], u: Floats) -> _T:
        try:
            return work(u)
        finally:
            if len(self.seconds) < len(self.objective.costs):
                self.seconds.append(time.thread_time() - self._begun)


def record_of(configuration: Configuration) -> Case:
    """The noise-free record of a run: the standard input and the reference simulator's answer."""
    ship = identification_ship(configuration, _SEED)
    return record_from(configuration, ship)


def record_from(configuration: Configuration, ship: Trace) -> Case:
    """The same behind another ship."""
    run = reference_run(configuration, ship, start=start_of(configuration.tow))
    return case_from_truth(
        configuration.name, ship, run.vehicle, configuration.scoring.settle, start=start_of(configuration.tow)
    )


def descents(
    name: str, model: ReducedModel, cases: Sequence[Case], *, budget: int = BUDGET, off: float = 1.0
) -> list[Descent]:
    """The search once, with restarts, and by SciPy's own simplex, all from the same place.

    Parameters
    ----------
    off
        Start with every second parameter so many times the model's own, and the others as many times smaller.

    Raises
    ------
    NumericalFailure
        The model cannot be simulated at the start.
    """
    space = SearchSpace.of(model)
    signs = 1.0 - 2.0 * (np.arange(space.size) % 2)
    start = np.clip(space.coordinates(model) + math.log(off) * signs, space.lower, space.upper)

    def plain(cost: _Timed) -> bool:
        options = {"maxiter": _MANY, "maxfev": _MANY}
        return bool(minimize(cost, start, method="Nelder-Mead", options=options).success)

    full = _descent(name, RESTARTED, Objective(space, cases, budget), lambda cost: search(cost, start, []))
    once = full.until(full.starts[1]) if len(full.starts) > 1 else full.until(full.best.size)
    return [once, full, _descent(name, PLAIN, Objective(space, cases, budget), plain)]


def _descent(name: str, how: str, objective: Objective, work: Callable[[_Timed], bool]) -> Descent:
    timed = _Timed(objective)
    try:
        ended = work(timed)
    except BudgetSpent:
        ended = False
    if not math.isfinite(objective.best):
        raise NumericalFailure(f"{name} cannot be simulated where its search starts: {objective.last_failure}")
    return Descent(
        model=name,
        how=how,
        best=np.minimum.accumulate(np.array(objective.costs)),
        seconds=np.array(timed.seconds),
        starts=tuple(timed.starts) if timed.starts else (0,),
        ended=ended,
    )
