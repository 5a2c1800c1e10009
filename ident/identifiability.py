"""Which parameters a record determines: information, correlations, intervals, verdicts.

The rule of a verdict, stated once. A parameter is determined when

1. its fit is not at a bound, and no other parameter set gives the same response (a twin);
2. its 95 % interval reaches less than 20 % to either side on average; and
3. it is not one of a pair with a correlation above 0.98 in size, unless its interval stays below 4 %: such a
   correlation widens an interval fivefold, so a model error too small to see in the residuals moves the split
   of the pair five times as far as it would move either alone.

Where a split is not determined, a combination mostly is: the eigen-directions of the covariance of the
search coordinates say which, and the total drag of a link model is reported with an interval of its own.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ident.cases import Case, Floats
from ident.objective import residuals
from ident.profile import CURVED, profiled
from ident.residuals import ResidualTest, examine_residuals
from ident.search_space import SearchSpace
from ident.sensitivity import Covariance, covariance
from ident.total_drag import Total, total_drag
from ident.twins import DIFFERENT, Twin, find_twins
from models import reduced

Verdict = Literal["yes", "no (wide)", "no (correlated)", "no (twin)", "no (bound)"]

#: Widest relative half-width of a determined parameter, alone and in a pair of collinear ones.
WIDEST, WIDEST_COLLINEAR = 0.20, 0.04

#: Correlation, in size, of a collinear pair.
COLLINEAR = 0.98

#: Factor either way that the data allow along a flat direction, by curvature and by profile.
FLAT = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterInterval:
    """A parameter's 95 % interval `low` to `high`, and whether the record determines it."""

    name: str
    symbol: str
    unit: str
    value: float
    low: float
    high: float
    verdict: Verdict

    @property
    def determined(self) -> bool:
        """Whether the verdict is yes."""
        return self.verdict == "yes"

    @property
    def half_width(self) -> float:
        """Half the interval, relative to the value."""
        return 0.5 * (self.high - self.low) / self.value if self.value > 0.0 else math.inf


@dataclass(frozen=True, slots=True, kw_only=True)
class Direction:
    """A combination ``product of parameter^weight`` with its relative 95 % half-width as a factor.

    `weights` are those of the search coordinates, of length one; the combination times or over `factor` is the
    interval.
    """

    weights: tuple[tuple[str, float], ...]
    factor: float

    @property
    def text(self) -> str:
        """The combination in words, such as ``cable_drag^0.95 vehicle_drag^0.31 within a factor of 1.02``."""
        terms = " ".join(f"{name}^{weight:.2f}" for name, weight in self.weights if abs(weight) >= 0.05)
        return f"{terms} within a factor of {self.factor:.3g}" if self.factor < 1e6 else f"{terms} at all"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Identifiability:
    """What the record says of the fitted parameters.

    `names` are the parameters inside their bounds, in the order of `information` (p, p) [m2/s2], of
    `correlation` (p, p) and of the weights of `directions`, which run from the best to the worst determined.
    """

    names: tuple[str, ...]
    intervals: tuple[ParameterInterval, ...]
    information: Floats
    correlation: Floats
    directions: tuple[Direction, ...]
    total_drag: Total | None
    residuals: tuple[ResidualTest, ...]
    twins: tuple[Twin, ...]
    flat: bool
    degrees_of_freedom: float


def examine(
    space: SearchSpace,
    u: Floats,
    cases: Sequence[Case],
    *,
    candidates: Sequence[Floats] | None = None,
    profile: bool = True,
) -> Identifiability:
    """Examine a fit at its optimum.

    Parameters
    ----------
    u
        (p,) search coordinates of the optimum.
    candidates
        Search coordinates of possible twins where they are known (`ident.twins.alternatives`).
    profile
        Let wide intervals follow the profile of the cost; else all come from its curvature.

    Raises
    ------
    NumericalFailure
        The model cannot be simulated at or right beside its optimum.
    """
    e = residuals(space.model_at(u), cases)
    sizes = [case.time.size for case in cases]
    parts = np.split(e, np.cumsum(sizes)[:-1])
    bound = space.at_bound(u)
    inner = space.without(bound, u)
    spread = covariance(inner, np.delete(u, bound), cases)
    deviation = np.sqrt(np.diag(spread.inverse))
    correlation = spread.inverse / np.outer(deviation, deviation)
    twins = find_twins(space, u, cases, candidates=candidates)
    ends = _intervals(space, u, bound, spread, cases, profile=profile)
    _, axes = np.linalg.eigh(spread.covariance)
    directions = tuple(_direction(inner.names, axis, spread) for axis in axes.T)
    intervals = _judge(space, u, ends, inner.names, correlation, twins)
    return Identifiability(
        names=inner.names,
        intervals=intervals,
        information=spread.information,
        correlation=correlation,
        directions=directions,
        total_drag=total_drag(inner, np.delete(u, bound), spread, cases, profile=profile),
        residuals=tuple(examine_residuals(case, part) for case, part in zip(cases, parts, strict=True)),
        twins=twins,
        flat=any(_is_flat(direction, intervals) for direction in directions),
        degrees_of_freedom=spread.degrees,
    )


def _intervals(
    space: SearchSpace, u: Floats, bound: Sequence[int], spread: Covariance, cases: Sequence[Case], *, profile: bool
) -> Floats:
    """(p, 2) ends of the 95 % intervals in search coordinates."""
    ends = np.stack([space.lower, space.upper], axis=1)
    inside = [j for j in range(u.size) if j not in bound]
    for k, j in enumerate(inside):
        axis = np.eye(len(inside))[k]
        half = spread.half_width(axis)
        ends[j] = u[j] - half, u[j] + half
        if profile and half > CURVED:
            slope = np.zeros(u.size)
            slope[inside] = spread.inverse[:, k] / spread.inverse[k, k]
            ends[j] = profiled(space, u, j, cases, threshold=spread.rise(axis), half_width=half, slope=slope)
    if profile and inside:
        # A parameter at its bound has no curvature: take the largest residual variance of the others.
        threshold = max(spread.rise(axis) for axis in np.eye(len(inside)))
        for j in bound:
            ends[j] = profiled(space, u, j, cases, threshold=threshold, half_width=CURVED, slope=np.zeros(u.size))
    return np.clip(ends, space.lower[:, None], space.upper[:, None])


def _judge(
    space: SearchSpace, u: Floats, ends: Floats, inner: Sequence[str], correlation: Floats, twins: Sequence[Twin]
) -> tuple[ParameterInterval, ...]:
    """Intervals as values, with the verdict of each parameter by the rule above."""
    parameters = reduced.parameters(space.model_at(u))
    judged = []
    for j, name in enumerate(space.names):
        p = parameters[space.free[j]]
        low, high = np.exp(ends[j]) - space.shift[j]
        verdict: Verdict = "yes"
        if name not in inner:
            verdict = "no (bound)"
        elif any(abs(math.log(twin.values[j] + space.shift[j]) - u[j]) > DIFFERENT for twin in twins):
            verdict = "no (twin)"
        else:
            half = 0.5 * (high - low) / p.value
            k = inner.index(name)
            collinear = np.delete(np.abs(correlation[k]), k).max(initial=0.0) > COLLINEAR
            if half >= WIDEST:
                verdict = "no (wide)"
            elif collinear and half >= WIDEST_COLLINEAR:
                verdict = "no (correlated)"
        judged.append(
            ParameterInterval(
                name=name,
                symbol=p.symbol,
                unit=p.unit,
                value=p.value,
                low=float(low),
                high=float(high),
                verdict=verdict,
            )
        )
    return tuple(judged)


def _is_flat(direction: Direction, intervals: Sequence[ParameterInterval]) -> bool:
    """Whether the data allow a factor of 10 along a direction, and the profiles of its parameters agree.

    The curvature at the optimum alone calls a direction flat that closes a little farther out.
    """
    main = max(direction.weights, key=lambda pair: abs(pair[1]))[0]
    found = next(interval for interval in intervals if interval.name == main)
    reach = max(found.high / found.value, found.value / found.low) if found.low > 0.0 < found.value else math.inf
    return direction.factor > FLAT and reach > FLAT


def _direction(names: Sequence[str], axis: Floats, spread: Covariance) -> Direction:
    """A principal axis of the covariance, its largest weight positive."""
    axis = axis * np.sign(axis[np.argmax(np.abs(axis))])
    weights = tuple((name, float(weight)) for name, weight in zip(names, axis, strict=True))
    return Direction(weights=weights, factor=math.exp(min(spread.half_width(axis), 700.0)))
