"""Scores of models on records: the rows of scores.csv and parameters.csv."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from ident.cases import Case
from ident.fit_files import SavedFit
from ident.learning import Fit
from ident.objective import rms
from models import reduced
from models.drive import Drive
from models.reduced import ReducedModel, Response
from reports.files import PARAMETER_COLUMNS, SCORE_COLUMNS

Row = dict[str, object]


@dataclass(frozen=True, slots=True, kw_only=True)
class Score:
    """How a response compares with a record.

    RMS velocity and position error, the latter with and without its mean [m/s, m, m]; fit percent
    ``100 (1 - |y - yhat| / |y - mean y|)`` of the compared velocity; the vehicle's own RMS velocity [m/s].
    """

    rms_velocity: float
    rms_position: float
    rms_position_offset_removed: float
    fit_percent: float
    vehicle_rms_velocity: float


def score(case: Case, response: Response) -> Score:
    """Compare a response with a record."""
    error = case.residual(response)
    position_error = case.model_position(response) - case.position
    spread = rms(case.velocity - case.velocity.mean())
    return Score(
        rms_velocity=rms(error),
        rms_position=rms(position_error),
        rms_position_offset_removed=rms(position_error - position_error.mean()),
        fit_percent=100.0 * (1.0 - rms(error) / spread) if spread > 0.0 else -math.inf,
        vehicle_rms_velocity=rms(case.velocity),
    )


def simulation_seconds_per_hour(model: ReducedModel, drive: Drive, *, repeats: int = 5) -> float:
    """Median wall time of a simulation for each hour of record [s/h], compiled and warm."""
    reduced.respond(model, drive)
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        reduced.respond(model, drive)
        times.append(time.perf_counter() - began)
    return float(np.median(times)) * 3600.0 / float(drive.t[-1] - drive.t[0])


def model_row(fit: Fit, case: Case, *, record: str | None = None, simulation_s_per_hour: float | None = None) -> Row:
    """A row of scores.csv for a fitted model.

    Parameters
    ----------
    record
        Name of the record in the table; that of the case by default.
    simulation_s_per_hour
        Measured here where not given.

    Raises
    ------
    NumericalFailure
        The fitted model cannot be simulated on this record.
    """
    return _row(
        fit.model, len(fit.names), fit.seconds, fit.simulations, fit.outcome, case, record, simulation_s_per_hour
    )


def saved_row(saved: SavedFit, model: ReducedModel, case: Case) -> Row:
    """A row of scores.csv for a model rebuilt from a fit file.

    Raises
    ------
    NumericalFailure
        The model cannot be simulated on this record.
    """
    searched = len(saved.values) - len(saved.fixed)
    return _row(model, searched, saved.identification_s, saved.simulations, saved.outcome, case, None, None)


def baseline_row(name: str, case: Case, response: Response, *, record: str | None = None) -> Row:
    """A row of scores.csv for a baseline; what a baseline does not have stays empty."""
    return {
        "model": name,
        "drag": "",
        "links": 0,
        "states": 0,
        "parameters": 0,
        **_scored(case, response, record),
        "simulation_s_per_hour": math.nan,
        "identification_s": math.nan,
        "simulations": 0,
        "outcome": "",
    }


def scores_table(rows: Sequence[Row]) -> pd.DataFrame:
    """Rows as scores.csv holds them."""
    return pd.DataFrame(list(rows), columns=list(SCORE_COLUMNS))


def parameters_table(fits: Sequence[Fit]) -> pd.DataFrame:
    """One row for each model and parameter, as parameters.csv holds them."""
    rows = [row for fit in fits for row in _parameter_rows(fit)]
    return pd.DataFrame(rows, columns=list(PARAMETER_COLUMNS))


def _row(
    model: ReducedModel,
    searched: int,
    seconds: float,
    simulations: int,
    outcome: str,
    case: Case,
    record: str | None,
    simulation_s_per_hour: float | None,
) -> Row:
    if simulation_s_per_hour is None:
        simulation_s_per_hour = simulation_seconds_per_hour(model, case.drive)
    about = reduced.info(model)
    return {
        "model": about.model,
        "drag": about.drag,
        "links": about.links,
        "states": about.states,
        "parameters": searched,
        **_scored(case, reduced.respond(model, case.drive), record),
        "simulation_s_per_hour": simulation_s_per_hour,
        "identification_s": seconds,
        "simulations": simulations,
        "outcome": outcome,
    }


def _scored(case: Case, response: Response, record: str | None) -> Row:
    found = score(case, response)
    return {
        "record": case.name if record is None else record,
        "rms_velocity_m_s": found.rms_velocity,
        "rms_position_m": found.rms_position,
        "rms_position_offset_removed_m": found.rms_position_offset_removed,
        "fit_percent": found.fit_percent,
        "vehicle_rms_velocity_m_s": found.vehicle_rms_velocity,
    }


def _verdict(fit: Fit, name: str) -> str:
    """The column `determined`."""
    if name not in fit.names:
        return "fixed"
    if fit.identifiability is None:
        return "no (failed)"
    return next(p.verdict for p in fit.identifiability.intervals if p.name == name)


def _parameter_rows(fit: Fit) -> list[Row]:
    intervals = {} if fit.identifiability is None else {p.name: p for p in fit.identifiability.intervals}
    rows = []
    for before, after in zip(reduced.parameters(fit.start), reduced.parameters(fit.model), strict=True):
        interval = intervals.get(after.name)
        rows.append(
            {
                "model": reduced.info(fit.model).model,
                "parameter": after.name,
                "symbol": after.symbol,
                "unit": after.unit,
                "mapped": before.value,
                "identified": after.value,
                "change_percent": 100.0 * (after.value / before.value - 1.0) if before.value else math.nan,
                "low": math.nan if interval is None else interval.low,
                "high": math.nan if interval is None else interval.high,
                "determined": _verdict(fit, after.name),
            }
        )
    return rows
