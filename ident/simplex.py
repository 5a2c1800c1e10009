"""Nelder-Mead with restarts: SciPy's simplex, spread along the directions that the record can tell apart.

The simplex method is affine invariant, so spreading its first simplex along the eigen-directions of the
information matrix makes collinear parameters (cable drag and vehicle drag: correlation -0.99) as easy as
independent ones. Each restart spreads a fresh simplex about the best point so far.
"""

import math
from typing import Any, Protocol

import numpy as np
from scipy.optimize import minimize

from ident.cases import Floats
from models.quantity import NumericalFailure

#: Relative gain of a restart below which the search has converged.
GAIN = 1e-4

#: Restarts at most.
RESTARTS = 5

#: RMS velocity error [m/s] below which a fit is exact and further gains are rounding.
EXACT = 1e-8

#: Difference in search coordinates for the sensitivities that orient a simplex.
STEP = 1e-3

#: Shortest and longest edge of a first simplex, in search coordinates (0.5 is a factor of 1.65).
SHORTEST, LONGEST = 1e-4, 0.5

#: Size, in edges of its first simplex, below which a simplex has closed in.
CLOSE = 0.03

#: SciPy's own limits stay out of the way: the objective keeps the budget.
MANY = 10**9

#: Rise of the cost, relative, that an edge of a fresh simplex aims at.
RISE = 0.01


class Cost(Protocol):
    """What the search needs of a cost, such as `ident.objective.Objective`.

    `best` and `best_at` are the lowest cost so far and where it was, `upper` (p,) ends the range of the coordinates.
    """

    @property
    def best(self) -> float: ...

    @property
    def best_at(self) -> Floats | None: ...

    @property
    def upper(self) -> Floats: ...

    def residuals(self, u: Floats) -> Floats:
        """(m,) residuals at coordinates (p,)."""
        ...

    def __call__(self, u: Floats) -> float:
        """The cost at coordinates (p,)."""
        ...


def search(objective: Cost, u: Floats, gains: list[float]) -> bool:
    """Minimise from u (p,); the best point is left in the objective, the gain of every restart in `gains`.

    Returns
    -------
    bool
        Whether the last restart gained less than 1e-4, or the fit is exact.

    Raises
    ------
    BudgetSpent
        No simulation is left.
    NumericalFailure
        The simulation at the start point failed.
    """
    _descend(objective, u)
    while len(gains) < RESTARTS and objective.best > EXACT and objective.best_at is not None:
        before = objective.best
        _descend(objective, objective.best_at)
        gains.append((before - objective.best) / before)
        if gains[-1] < GAIN:
            return True
    return objective.best <= EXACT


def _descend(objective: Cost, u: Floats) -> None:
    """One run of SciPy's Nelder-Mead from a fresh simplex about u, in units of its edges."""
    edges = _edges(objective, u)
    p = u.size
    options: Any = {
        "initial_simplex": np.vstack([np.zeros(p), np.eye(p)]),
        "xatol": CLOSE,
        "fatol": max(0.1 * GAIN * objective.best, 0.1 * EXACT),
        "maxiter": MANY,
        "maxfev": MANY,
    }

    def cost(z: Floats) -> float:
        return objective(u + edges @ z)

    minimize(cost, np.zeros(p), method="Nelder-Mead", options=options)


def _edges(objective: Cost, u: Floats) -> Floats:
    """(p, p) columns: the edges of a fresh simplex at u, in search coordinates.

    Along each eigen-direction of J'J the edge points downhill and is as long as the Gauss-Newton step, at
    least long enough to raise the cost by one per cent.
    """
    base = objective.residuals(u)
    m, p = base.size, u.size
    J = np.empty((m, p))
    for j in range(p):
        moved = u.copy()
        moved[j] += STEP if u[j] + STEP < objective.upper[j] else -STEP
        try:
            J[:, j] = (objective.residuals(moved) - base) / (moved[j] - u[j])
        except NumericalFailure:
            return LONGEST * 0.4 * np.eye(p)
    values, directions = np.linalg.eigh(J.T @ J / m)
    values = np.maximum(values, 1e-300)
    newton = -(directions.T @ (J.T @ base / m)) / values
    cost = math.sqrt(float(base @ base) / m)
    shortest = np.maximum(np.sqrt(2.0 * RISE / values) * cost, SHORTEST)
    lengths = np.clip(np.abs(newton), np.minimum(shortest, LONGEST), LONGEST)
    edges: Floats = directions * np.where(newton < 0.0, -lengths, lengths)
    return edges
