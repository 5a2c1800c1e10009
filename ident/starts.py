"""The search from several start points: those asked for, and those that a linear chain needs.

The cost of a linear chain has a valley where the cable carries the drag and another where the vehicle does,
and near twins within them: the search starts in each.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ident.cases import Case, Floats
from ident.objective import BudgetSpent, Objective
from ident.search_space import SearchSpace
from ident.simplex import EXACT, search
from ident.total_drag import cable_share, total_of
from ident.twins import alternatives
from models import reduced
from models.inertial import Inertial
from models.massless import Massless
from models.quantity import NumericalFailure

#: Further start points lie within this of the first in search coordinates (a factor of 2.7 either way).
SCATTER = 1.0

#: Near twins of a linear chain from which its search starts again, if their cost is within this factor.
HOPS, HOP_COST = 2, 3.0

#: The smaller part of the total drag in a one-sided split.
SMALL_SHARE = 0.1

#: Results whose costs differ by less than this, relative, are equally good.
EQUAL = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StartResult:
    """The search from one start point: one bar of the waterfall.

    Parameters
    ----------
    number
        0 for the given guess, then the scattered start points, then those of a linear chain.
    start, values
        The searched parameters at the start and at the end.
    rms
        At the end [m/s]; infinite where no simulation succeeded.
    gains, settled
        Relative gain of every restart, and whether the last was below 1e-4 or the fit exact.
    costs
        (k,) [m/s] of the evaluations in order, infinite where the simulation failed.
    """

    number: int
    start: tuple[float, ...]
    values: tuple[float, ...]
    rms: float
    gains: tuple[float, ...]
    settled: bool
    budget_spent: bool
    simulations: int
    failures: int
    last_failure: str
    costs: Floats

    def coordinates(self, space: SearchSpace) -> Floats:
        """(p,) search coordinates of the end."""
        return space.coordinates(reduced.with_values(space.model, space.all_values(self.values)))


def search_all(
    space: SearchSpace, cases: Sequence[Case], *, budget: int, starts: int, seed: int
) -> tuple[list[StartResult], list[Floats]]:
    """Search from the space's model, from `starts` - 1 points scattered about it, and for a linear chain from others.

    Those are the two one-sided splits of its drag, and near twins of the best result.

    Returns
    -------
    results
        The best first.
    near
        Where a linear chain responds nearly as at the first result, in search coordinates.
    """
    rng = np.random.default_rng(seed)
    guess = space.coordinates(space.model)
    points = [guess, *(guess + rng.uniform(-SCATTER, SCATTER, guess.size) for _ in range(starts - 1))]
    points += _other_splits(space, guess)
    results = [_search(space, cases, point, budget, number) for number, point in enumerate(points)]
    best = min(results, key=lambda result: result.rms)
    near: list[Floats] = []
    if math.isfinite(best.rms):
        near = alternatives(space, best.coordinates(space), cases, seed=seed)
        for point in _confused(space, cases, best, near):
            results.append(_search(space, cases, point, budget, len(results)))
        results.sort(key=lambda result: result.rms)
        if results[0] is not best:
            near = alternatives(space, results[0].coordinates(space), cases, seed=seed)
    return results, near


def nearest_of_equals(space: SearchSpace, results: Sequence[StartResult]) -> StartResult:
    """The best result; of several that only rounding tells apart (twins), the one nearest to the first guess.

    Parameters
    ----------
    results
        The best first.
    """
    guess = space.coordinates(space.model)
    equals = [result for result in results if result.rms <= results[0].rms * (1.0 + EQUAL) + EXACT]
    if not math.isfinite(results[0].rms):
        return results[0]
    return min(equals, key=lambda result: float(np.abs(result.coordinates(space) - guess).max()))


def _search(space: SearchSpace, cases: Sequence[Case], u: Floats, budget: int, number: int) -> StartResult:
    """The whole search from one start point; its troubles are in the result."""
    objective = Objective(space, cases, budget)
    start = np.clip(u, space.lower, space.upper)
    gains: list[float] = []
    settled = spent = False
    try:
        settled = search(objective, start, gains)
    except BudgetSpent:
        spent = True
    except NumericalFailure:
        settled = False  # Kept by the objective; without a best point the result says that it failed.
    at = start if objective.best_at is None else objective.best_at
    return StartResult(
        number=number,
        start=tuple(float(value) for value in space.values_at(start)),
        values=tuple(float(value) for value in space.values_at(at)),
        rms=objective.best,
        gains=tuple(gains),
        settled=settled,
        budget_spent=spent,
        simulations=objective.simulations,
        failures=objective.failures,
        last_failure=objective.last_failure,
        costs=np.array(objective.costs),
    )


def _other_splits(space: SearchSpace, guess: Floats) -> list[Floats]:
    """The guess with nearly all of its total drag on the vehicle, and on the cable; none unless a linear chain."""
    model = space.model
    total = total_of(model)
    if not isinstance(model, Massless | Inertial) or model.drag != "linear" or total is None:
        return []
    if not {"cable_drag", "vehicle_drag"} <= set(space.names):
        return []
    points = []
    for cable in (SMALL_SHARE, 1.0 - SMALL_SHARE):
        point = guess.copy()
        point[space.names.index("cable_drag")] += math.log(cable * total / cable_share(model))
        point[space.names.index("vehicle_drag")] += math.log((1.0 - cable) * total / model.vehicle_drag)
        points.append(point)
    return points


def _confused(space: SearchSpace, cases: Sequence[Case], best: StartResult, near: Sequence[Floats]) -> Sequence[Floats]:
    """The places among `near` that fit nearly as well: the search may have ended in the wrong one of two valleys."""
    objective = Objective(space, cases, len(near) * len(cases))
    costs = sorted((objective(point), k) for k, point in enumerate(near))
    return [near[k] for cost, k in costs[:HOPS] if cost <= HOP_COST * best.rms]
