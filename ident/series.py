"""From cases and responses to the plain arrays that figures are drawn from and traces written."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from ident.cases import Case
from models.reduced import Response
from models.trace import Trace
from reports.series import RecordSeries


def truth_series(
    case: Case, ship: Trace, vehicle: Trace, responses: Mapping[str, Response], *, description: str, label: str
) -> RecordSeries:
    """A noise-free record at all its samples."""
    return RecordSeries(
        record=case.name,
        t=ship.t,
        ship_position=ship.position[:, 0],
        ship_velocity=ship.spline(ship.t, 1)[:, 0],
        vehicle_position=vehicle.position[:, 0],
        vehicle_velocity=vehicle.rates()[:, 0],
        model_position={name: response.position for name, response in responses.items()},
        model_velocity={name: response.velocity for name, response in responses.items()},
        scored_from=float(case.time[0]),
        description=description,
        vehicle_label=label,
    )


def measured_series(
    case: Case,
    ship: Trace,
    responses: Mapping[str, Response],
    *,
    description: str,
    label: str,
    scored_from: float | None = None,
) -> RecordSeries:
    """A record of fixes at the times whose velocity is compared, the models through the same operator.

    `scored_from` is the start of the scored window [s] where the case reaches further back.
    """
    at = ship.spline(case.time, 0)[:, 0]
    places = np.searchsorted(case.drive.t, case.time)
    observed = np.full(case.drive.t.size, np.nan)
    observed[case.position_index] = case.position
    positions = {}
    for name, response in responses.items():
        read = np.full(case.drive.t.size, np.nan)
        read[case.position_index] = case.model_position(response)
        positions[name] = read[places]
    return RecordSeries(
        record=case.name,
        t=case.time,
        ship_position=at,
        ship_velocity=ship.spline(case.time, 1)[:, 0],
        vehicle_position=observed[places],
        vehicle_velocity=case.velocity,
        model_position=positions,
        model_velocity={name: case.model_velocity(response) for name, response in responses.items()},
        scored_from=float(case.time[0]) if scored_from is None else scored_from,
        description=description,
        vehicle_label=label,
    )


def response_table(series: RecordSeries) -> pd.DataFrame:
    """The velocities of a record and of every model on it."""
    columns = {"time_s": series.t, "ship_velocity_m_s": series.ship_velocity}
    columns["vehicle_velocity_m_s"] = series.vehicle_velocity
    columns |= {f"{name}_velocity_m_s": value for name, value in series.model_velocity.items()}
    return pd.DataFrame(columns)
