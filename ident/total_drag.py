"""The total drag of a chain, (n - 1) beta ds + B_veh: what a record determines when the split is not (T 6.7)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ident.cases import Case, Floats
from ident.objective import residuals
from ident.profile import CURVED, profile_interval
from ident.search_space import SearchSpace
from ident.sensitivity import Covariance
from models.inertial import Inertial
from models.massless import Massless
from models.reduced import ReducedModel


@dataclass(frozen=True, slots=True, kw_only=True)
class Total:
    """A sum of parameters with its 95 % interval."""

    name: str
    unit: str
    value: float
    low: float
    high: float


def cable_share(model: Massless | Inertial) -> float:
    """Drag of the cable's nodes, (n - 1) beta ds."""
    return (model.stiffness.size - 1) * model.link * model.cable_drag


def total_of(model: ReducedModel) -> float | None:
    """Total drag of a chain of two links or more [N s2/m2, N s/m when linear]; ``None`` for other models."""
    if not isinstance(model, Massless | Inertial) or model.stiffness.size < 2:
        return None
    return cable_share(model) + model.vehicle_drag


def total_drag(
    inner: SearchSpace, u: Floats, spread: Covariance, cases: Sequence[Case], *, profile: bool
) -> Total | None:
    """The total drag at an optimum u (p,) with its 95 % interval; ``None`` where the model has no such sum.

    Parameters
    ----------
    inner, spread
        The parameters that are not at a bound, and their covariance.
    profile
        Let a wide interval follow the profile of the cost with the total held.
    """
    model = inner.model_at(u)
    total = total_of(model)
    if total is None or not isinstance(model, Massless | Inertial):
        return None
    weight = {"cable_drag": cable_share(model) / total, "vehicle_drag": model.vehicle_drag / total}
    axis = np.array([weight.get(name, 0.0) for name in inner.names])
    half = spread.half_width(axis)
    low, high = -half, half
    if profile and half > CURVED and {"cable_drag", "vehicle_drag"} <= set(inner.names):
        low, high = _profiled(inner, u, spread, cases, axis, total)
    unit = "N s2/m2" if model.drag == "quadratic" else "N s/m"
    return Total(
        name="total drag",
        unit=unit,
        value=total,
        low=total * math.exp(max(low, -700.0)),
        high=total * math.exp(min(high, 700.0)),
    )


def _profiled(
    inner: SearchSpace, u: Floats, spread: Covariance, cases: Sequence[Case], axis: Floats, total: float
) -> tuple[float, float]:
    """Ends of the profile interval of log(total), from its value.

    The vehicle's drag gives way to the total as a coordinate; the cable then takes a share of the total below one.
    """
    j, c = inner.names.index("vehicle_drag"), inner.names.index("cable_drag")

    def split(x: Floats) -> Floats:
        model = inner.model_at(x)
        assert isinstance(model, Massless | Inertial)
        vehicle = math.exp(x[j]) - cable_share(model)
        at = x.copy()
        at[j] = math.log(max(vehicle, math.exp(inner.lower[j])))
        if vehicle <= math.exp(inner.lower[j]):
            # All of the total on the cable.
            at[c] = x[c] + x[j] - math.log(cable_share(model))
        return at

    start = u.copy()
    start[j] = math.log(total)
    slope = spread.inverse @ axis / float(axis @ spread.inverse @ axis)
    slope[j] = 1.0
    low, high = profile_interval(
        lambda x: residuals(inner.model_at(split(x)), cases),
        start,
        inner.lower,
        inner.upper,
        j,
        threshold=spread.rise(axis),
        half_width=spread.half_width(axis),
        slope=slope,
    )
    return low - start[j], high - start[j]
