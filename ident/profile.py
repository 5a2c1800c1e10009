"""Profile intervals: how far a parameter can go before the best fit of all others shows it.

Where a record hardly determines a parameter, the cost is no parabola in it and an interval from the
curvature at the optimum misleads. The profile follows the valley instead, and finds one-sided intervals of
parameters at a bound.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import least_squares

from ident.cases import Case, Floats
from ident.objective import residuals as residuals_of
from ident.search_space import SearchSpace
from models.quantity import NumericalFailure

Residuals = Callable[[Floats], Floats]

#: Half-width in search coordinates above which an interval follows the profile (10 %).
CURVED = 0.1

#: The end of an interval is found when the root of the rise is this close to its threshold, relative.
CLOSE = 0.03

#: Trial points for one end of an interval.
TRIALS = 10

#: Longest first step along a profile, in search coordinates (a factor of e).
LONGEST = 1.0

#: Iterations for refitting the other coordinates at one trial point.
REFIT = 12


def profiled(
    space: SearchSpace, u: Floats, j: int, cases: Sequence[Case], *, threshold: float, half_width: float, slope: Floats
) -> tuple[float, float]:
    """`profile_interval` of a search coordinate."""
    return profile_interval(
        lambda x: residuals_of(space.model_at(x), cases),
        u,
        space.lower,
        space.upper,
        j,
        threshold=threshold,
        half_width=half_width,
        slope=slope,
    )


def profile_interval(
    residuals: Residuals,
    u: Floats,
    lower: Floats,
    upper: Floats,
    j: int,
    *,
    threshold: float,
    half_width: float,
    slope: Floats,
) -> tuple[float, float]:
    """The interval of coordinate j in which the refitted sum of squares rises by at most `threshold`.

    Parameters
    ----------
    residuals
        From coordinates (p,) to residuals (m,) [m/s].
    u, lower, upper
        (p,) the optimum and the range.
    threshold
        Rise of the sum of squares [m2/s2].
    half_width
        The interval's half-width by curvature, where to look first.
    slope
        (p,) how the refitted coordinates follow coordinate j, by curvature.

    Returns
    -------
    low, high
        An end of the range where the threshold is not reached.
    """
    base = residuals(u)
    floor = float(base @ base)

    def root_of_rise(near: Floats) -> tuple[float, Floats]:
        cost, refitted = _refit(residuals, near, lower, upper, j)
        return math.sqrt(max(cost - floor, 0.0)), refitted

    low = _end(root_of_rise, u, j, float(lower[j]), math.sqrt(threshold), half_width, slope)
    high = _end(root_of_rise, u, j, float(upper[j]), math.sqrt(threshold), half_width, slope)
    return low, high


def _end(
    root_of_rise: Callable[[Floats], tuple[float, Floats]],
    u: Floats,
    j: int,
    limit: float,
    target: float,
    half_width: float,
    slope: Floats,
) -> float:
    """One end: a bracketed search on the root of the rise, which is nearly linear in the coordinate."""
    side = 1.0 if limit >= u[j] else -1.0
    inner, inner_root = float(u[j]), 0.0
    outer, outer_root = math.nan, math.nan
    warm = u
    step = min(max(half_width, 1e-3), LONGEST)
    for _ in range(TRIALS):
        if math.isnan(outer):
            trial = inner + side * step
            if side * (trial - limit) >= 0.0:
                trial = limit
        else:
            share = (target - inner_root) / (outer_root - inner_root) if math.isfinite(outer_root) else 0.5
            trial = inner + min(max(share, 0.1), 0.9) * (outer - inner)
        near = warm + slope * (trial - warm[j])
        near[j] = trial
        root, refitted = root_of_rise(near)
        if abs(root - target) <= CLOSE * target:
            return trial
        if root < target:
            if trial == limit:
                return limit
            slope = (refitted - warm) / (trial - warm[j])
            warm = refitted
            rate = (root - inner_root) / abs(trial - inner)
            step = min((target - root) / rate * 1.1, 2.0 * step) if rate > 0.0 else 2.0 * step
            inner, inner_root = trial, root
        else:
            outer, outer_root = trial, root
    # Ends that the trials did not pin down err on the wide side.
    return limit if math.isnan(outer) else outer


def _refit(residuals: Residuals, near: Floats, lower: Floats, upper: Floats, j: int) -> tuple[float, Floats]:
    """Sum of squares [m2/s2] with coordinate j held and the others refitted from `near`, and where."""
    at = near.copy()
    others = [i for i in range(near.size) if i != j]

    def shortfall(x: Floats) -> Floats:
        at[others] = x
        return residuals(at)

    try:
        if not others:
            e = residuals(at)
            return float(e @ e), at
        margin = 1e-9
        result = least_squares(
            shortfall,
            np.clip(near[others], lower[others] + margin, upper[others] - margin),
            bounds=(lower[others], upper[others]),
            x_scale="jac",
            diff_step=np.full(len(others), 1e-4),
            xtol=1e-4,
            ftol=1e-5,
            gtol=1e-12,
            max_nfev=REFIT,
        )
    except NumericalFailure:
        return math.inf, near
    at[others] = result.x
    return 2.0 * float(result.cost), at
