"""The cost of a learning model: RMS velocity error, open loop over whole records."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ident.cases import Case, Floats
from ident.places import interruption
from ident.search_space import SearchSpace
from models import reduced
from models.quantity import NumericalFailure


class BudgetSpent(Exception):
    """The search used all simulations it was given."""


def residuals(model: reduced.ReducedModel, cases: Sequence[Case]) -> Floats:
    """(m,) model minus observed velocity [m/s] over the scored samples of all records, one after another.

    Raises
    ------
    NumericalFailure
        A simulation failed.
    KeyboardInterrupt
        The user has asked to stop; a search in another thread than the main one learns of it here.
    """
    if interruption.is_set():
        raise KeyboardInterrupt
    parts = [case.residual(reduced.respond(model, case.drive)) for case in cases]
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def rms(values: Floats) -> float:
    """Root of the mean square, every sample with the same weight."""
    return math.sqrt(float(np.dot(values, values)) / values.size)


@dataclass(slots=True)
class Objective:
    """RMS velocity error [m/s] against search coordinates; counts, keeps the best point and every cost.

    Coordinates outside the range are clipped to it and pay a factor that grows with their distance, so
    that a simplex does not collapse onto a bound. A failed simulation costs infinity and is counted.
    """

    space: SearchSpace
    cases: Sequence[Case]
    budget: int
    simulations: int = 0
    failures: int = 0
    last_failure: str = ""
    best: float = math.inf
    best_at: Floats | None = None
    costs: list[float] = field(default_factory=list)

    @property
    def upper(self) -> Floats:
        """(p,) upper ends of the search coordinates."""
        return self.space.upper

    def residuals(self, u: Floats) -> Floats:
        """(m,) residuals at coordinates (p,), counted.

        Raises
        ------
        BudgetSpent
            No simulation is left.
        NumericalFailure
            A simulation failed.
        """
        if self.simulations + len(self.cases) > self.budget:
            raise BudgetSpent
        self.simulations += len(self.cases)
        try:
            values = residuals(self.space.model_at(u), self.cases)
        except NumericalFailure as failure:
            self.failures += 1
            self.last_failure = str(failure)
            self.costs.append(math.inf)
            raise
        cost = rms(values)
        self.costs.append(cost)
        if cost < self.best:
            self.best = cost
            self.best_at = np.minimum(np.maximum(u, self.space.lower), self.space.upper)
        return values

    def __call__(self, u: Floats) -> float:
        """The cost [m/s] at coordinates (p,); infinite where the simulation fails."""
        try:
            self.residuals(u)
        except NumericalFailure:
            return math.inf
        return self.costs[-1] * (1.0 + self.space.excess(u))
