"""Coordinates of the parameter search: logarithms, and a shifted logarithm for the delay.

A parameter v is searched as u = log v. A delay may be next to nothing, so it is searched as
u = log(v + 1 s): relative steps far above a second, absolute steps below it.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models import reduced
from models.quantity import InvalidInput
from models.reduced import ReducedModel

Floats = NDArray[np.float64]

#: Added to a delay before its logarithm [s].
SHIFT = 1.0

#: A coordinate closer than this to the end of its range is at its bound.
AT_BOUND = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SearchSpace:
    """The free parameters of a model and the map between their values and search coordinates.

    `model` gives the family and the values of the fixed parameters; `free` holds the positions of the
    searched ones among all parameters, `shift` (p,) what is added before the logarithm, `lower` and
    `upper` (p,) the range in search coordinates.
    """

    model: ReducedModel
    names: tuple[str, ...]
    free: tuple[int, ...]
    values: tuple[float, ...]
    shift: Floats
    lower: Floats
    upper: Floats

    @classmethod
    def of(cls, model: ReducedModel, *, fixed: Collection[str] = (), within: float | None = None) -> "SearchSpace":
        """The search space of a model's parameters except those named in `fixed`.

        Parameters
        ----------
        within
            Search each parameter within this factor of the value it has, instead of over its whole range.

        Raises
        ------
        InvalidInput
            `fixed` names a parameter that the model does not have, or leaves nothing to search.
        """
        parameters = reduced.parameters(model)
        known = [p.name for p in parameters]
        unknown = sorted(set(fixed) - set(known))
        if unknown:
            raise InvalidInput(
                f"Parameters to hold fixed must be among {', '.join(known)}, but {', '.join(unknown)} was given."
            )
        free = tuple(i for i, p in enumerate(parameters) if p.name not in fixed)
        if not free:
            raise InvalidInput(
                f"A fit needs at least one free parameter, but all of {', '.join(known)} are held fixed."
            )
        searched = [parameters[i] for i in free]
        shift = np.array([SHIFT if p.unit == "s" else 0.0 for p in searched])
        lower, upper = np.array([p.lower for p in searched]), np.array([p.upper for p in searched])
        if within is not None:
            values = np.array([p.value for p in searched])
            lower, upper = np.maximum(lower, values / within), np.minimum(upper, values * within)
        return cls(
            model=model,
            names=tuple(parameters[i].name for i in free),
            free=free,
            values=tuple(p.value for p in parameters),
            shift=shift,
            lower=np.log(lower + shift),
            upper=np.log(upper + shift),
        )

    @property
    def size(self) -> int:
        """Number of free parameters."""
        return len(self.free)

    def coordinates(self, model: ReducedModel) -> Floats:
        """(p,) search coordinates of a model of this family, clipped to the range."""
        parameters = reduced.parameters(model)
        values = np.array([parameters[i].value for i in self.free]) + self.shift
        return np.clip(np.log(np.maximum(values, np.exp(self.lower))), self.lower, self.upper)

    def model_at(self, u: Floats) -> ReducedModel:
        """The model at search coordinates (p,), which are clipped to the range."""
        return reduced.with_values(self.model, self.all_values(self.values_at(u)))

    def values_at(self, u: Floats) -> Floats:
        """(p,) values of the free parameters at search coordinates (p,), clipped to the range."""
        values: Floats = np.exp(np.minimum(np.maximum(u, self.lower), self.upper)) - self.shift
        return values

    def all_values(self, free_values: Sequence[float] | Floats) -> list[float]:
        """The values of all parameters in the model's order, the fixed ones as they are."""
        values = list(self.values)
        for i, value in zip(self.free, free_values, strict=True):
            values[i] = float(value)
        return values

    def excess(self, u: Floats) -> float:
        """How far coordinates lie outside the range, summed over the parameters; zero inside."""
        return float((np.maximum(self.lower - u, 0.0) + np.maximum(u - self.upper, 0.0)).sum())

    def at_bound(self, u: Floats) -> tuple[int, ...]:
        """The positions in (0, p) of coordinates at an end of their range."""
        at = (u <= self.lower + AT_BOUND) | (u >= self.upper - AT_BOUND)
        return tuple(int(j) for j in np.flatnonzero(at))

    def without(self, positions: Collection[int], u: Floats) -> "SearchSpace":
        """The same space with the coordinates at `positions` held at their values in `u`."""
        keep = [j for j in range(self.size) if j not in positions]
        return SearchSpace(
            model=self.model,
            names=tuple(self.names[j] for j in keep),
            free=tuple(self.free[j] for j in keep),
            values=tuple(self.all_values(self.values_at(u))),
            shift=self.shift[keep],
            lower=self.lower[keep],
            upper=self.upper[keep],
        )
