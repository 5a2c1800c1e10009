"""The search from several start points: those asked for, and those that a linear chain or a far guess needs.

The search from the first guess looks around it before (`ident.scouting`). The cost of a chain has a valley where the
cable carries the drag and another where the vehicle does, and near twins within them if its drag is linear: a linear
chain starts in each, a quadratic one only where the guess was found to be far off, as its own valley is the near one.
A second order whose guess was far off starts from moderate damping ratios too: far above one, the mass no longer
matters and the cost is flat along spring and damping.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ident.cases import Case, Floats
from ident.objective import BudgetSpent, Objective, rms
from ident.scouting import scout
from ident.search_space import SearchSpace
from ident.simplex import EXACT, search
from ident.total_drag import cable_share, total_of
from ident.twins import alternatives
from models import reduced
from models.delayed import SecondOrder
from models.equivalent_drag import at_speed
from models.inertial import Inertial
from models.massless import Massless
from models.quantity import NumericalFailure

#: Further start points lie within this of the first in search coordinates (a factor of 2.7 either way).
SCATTER = 1.0

#: Near twins of a linear chain from which its search starts again, if their cost is within this factor.
HOPS, HOP_COST = 2, 3.0

#: The smaller part of the total drag in a one-sided split.
SMALL_SHARE = 0.1

#: Damping ratios from which a second order starts again where its guess was far off.
RATIOS = (1.0, 4.0)

#: Least velocity amplitude of an equivalent drag [m/s]: the vehicle of a record may lie still.
SLOWEST = 1e-3

#: Results whose costs differ by less than this, relative, are equally good.
EQUAL = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StartResult:
    """The search from one start point: one bar of the waterfall.

    Parameters
    ----------
    number
        0 for the given guess, then the scattered start points, then those of a linear chain or a far guess.
    start, begun, values
        The searched parameters at the start, where the first simplex was spread, which is another place only where
        the first guess was found to be far off, and at the end.
    rms
        At the end [m/s]; infinite where no simulation succeeded.
    gains, settled
        Relative gain of every restart, and whether the last was below 1e-4 or the fit exact.
    costs
        (k,) [m/s] of the evaluations in order, infinite where the simulation failed.
    """

    number: int
    start: tuple[float, ...]
    begun: tuple[float, ...]
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
    """Search from the space's model, from `starts` - 1 points scattered about it, and from others where need be.

    Those are the other valleys of a linear chain, or of a model whose guess was found to be far off, and near twins
    of the best result of a linear chain.

    Returns
    -------
    results
        The best first.
    near
        Where a linear chain responds nearly as at the first result, in search coordinates.
    """
    rng = np.random.default_rng(seed)
    guess = space.coordinates(space.model)
    first = _search(space, cases, guess, budget, 0, look=True)
    points = [guess + rng.uniform(-SCATTER, SCATTER, guess.size) for _ in range(starts - 1)]
    begun = space.coordinates(reduced.with_values(space.model, space.all_values(first.begun)))
    points += _other_valleys(space, begun, cases, far=first.begun != first.start)
    results = [first]
    results += [_search(space, cases, point, budget, number) for number, point in enumerate(points, start=1)]
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


def _search(
    space: SearchSpace, cases: Sequence[Case], u: Floats, budget: int, number: int, *, look: bool = False
) -> StartResult:
    """The whole search from one start point, with a look around it before; its troubles are in the result."""
    objective = Objective(space, cases, budget)
    start = begun = np.clip(u, space.lower, space.upper)
    gains: list[float] = []
    settled = spent = False
    try:
        if look:
            objective.residuals(start)
            begun = scout(objective, start)
        settled = search(objective, begun, gains)
    except BudgetSpent:
        spent = True
    except NumericalFailure:
        settled = False  # Kept by the objective; without a best point the result says that it failed.
    at = start if objective.best_at is None else objective.best_at
    return StartResult(
        number=number,
        start=tuple(float(value) for value in space.values_at(start)),
        begun=tuple(float(value) for value in space.values_at(begun)),
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


def _other_valleys(space: SearchSpace, place: Floats, cases: Sequence[Case], *, far: bool) -> list[Floats]:
    """Other start points of a linear chain, or about the place that was found where the guess was `far` off.

    A chain has nearly all of its total drag on the vehicle, and on the cable; a second order its damping ratio at
    each of `RATIOS`, with the same ratio of spring and damping. There are none for other models.
    """
    model = space.model_at(place)
    if far and isinstance(model, SecondOrder) and {"spring", "damping"} <= set(space.names):
        both = np.array([name in ("spring", "damping") for name in space.names], dtype=float)
        ratio = _damping_ratio(model, rms(np.concatenate([case.velocity for case in cases])))
        return [place + 2.0 * math.log(wanted / ratio) * both for wanted in RATIOS]
    total = total_of(model)
    if not isinstance(model, Massless | Inertial) or total is None or not (far or model.drag == "linear"):
        return []
    if not {"cable_drag", "vehicle_drag"} <= set(space.names):
        return []
    points = []
    for cable in (SMALL_SHARE, 1.0 - SMALL_SHARE):
        point = place.copy()
        point[space.names.index("cable_drag")] += math.log(cable * total / cable_share(model))
        point[space.names.index("vehicle_drag")] += math.log((1.0 - cable) * total / model.vehicle_drag)
        points.append(point)
    return points


def _damping_ratio(model: SecondOrder, speed: float) -> float:
    """b/(2 sqrt(a)), where the drag is quadratic of the equivalent linear drag at a velocity amplitude [m/s]."""
    b = np.array([model.damping])
    return float((b if model.drag == "linear" else at_speed(b, max(speed, SLOWEST)))[0]) / (
        2.0 * math.sqrt(model.spring)
    )


def _confused(space: SearchSpace, cases: Sequence[Case], best: StartResult, near: Sequence[Floats]) -> Sequence[Floats]:
    """The places among `near` that fit nearly as well: the search may have ended in the wrong one of two valleys."""
    objective = Objective(space, cases, len(near) * len(cases))
    costs = sorted((objective(point), k) for k, point in enumerate(near))
    return [near[k] for cost, k in costs[:HOPS] if cost <= HOP_COST * best.rms]
