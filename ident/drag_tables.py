"""What T section 6.7 compares with the continuous quantities: b/k of the delayed models, total drag of the chains."""

import math
from collections.abc import Sequence

import pandas as pd

from ident.learning import Fit
from ident.total_drag import cable_share, total_of
from models import reduced
from models.delayed import FirstOrder, SecondOrder
from models.inertial import Inertial
from models.massless import Massless
from models.reduced import ReducedModel
from models.statics import StaticShape
from models.tow import Tow


def drag_over_spring(model: ReducedModel) -> float | None:
    """b/k of a delayed model [s2/m, or s when linear]; ``None`` for a chain."""
    match model:
        case SecondOrder():
            return model.damping / model.spring
        case FirstOrder():
            return 1.0 / model.spring
        case _:
            return None


def predicted_drag_over_spring(tow: Tow, shape: StaticShape) -> float:
    """b/k from the continuous quantities, (B_veh + beta L/2)/(T_mid/L) [s2/m] (T 6.7)."""
    length = tow.cable.length
    drag = tow.vehicle.drag(tow.water_density) + 0.5 * length * tow.cable.normal_drag(tow.water_density)
    middle = float(shape.tension_at(0.5 * float(shape.s[-1])))
    return drag / (middle / length)


def drag_over_spring_table(tow: Tow, shape: StaticShape, fits: Sequence[Fit]) -> pd.DataFrame:
    """Columns model, predicted, identified [s2/m]: a row for each delayed model with quadratic drag."""
    predicted = predicted_drag_over_spring(tow, shape)
    rows = [
        (reduced.info(fit.model).model, predicted, found)
        for fit in fits
        if fit.model.drag == "quadratic" and (found := drag_over_spring(fit.model)) is not None
    ]
    return pd.DataFrame(rows, columns=["model", "predicted", "identified"])


def total_drag_table(fits: Sequence[Fit]) -> pd.DataFrame:
    """Drag of the cable's nodes, of the vehicle's and of both [N s2/m2], a row for each chain with quadratic drag.

    Columns model, cable, vehicle, total, mapped_total, low, high; the last two bound the total at 95 %. The
    record determines the total though not its parts.
    """
    rows = []
    for fit in fits:
        model, total, mapped = fit.model, total_of(fit.model), total_of(fit.start)
        if not isinstance(model, Massless | Inertial) or model.drag != "quadratic" or total is None:
            continue
        bounds = None if fit.identifiability is None else fit.identifiability.total_drag
        low, high = (math.nan, math.nan) if bounds is None else (bounds.low, bounds.high)
        rows.append((reduced.info(model).model, cable_share(model), model.vehicle_drag, total, mapped, low, high))
    return pd.DataFrame(rows, columns=["model", "cable", "vehicle", "total", "mapped_total", "low", "high"])
