"""The main study: truth, fits of every reduced model, verification, and the report."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pandas as pd

from data_synth.records import join, write_record
from ident.baselines import RIGID, rigid
from ident.cases import Case
from ident.configuration import Configuration
from ident.learning import Fit, Job, fit_many
from ident.places import new_folder
from ident.run_material import run_material
from ident.run_records import CURRENT, IDENTIFICATION, MEASURED, TRUTH, Records, prepare_records
from ident.scores import baseline_row, model_row, scores_table, simulation_seconds_per_hour
from ident.series import response_table
from ident.studies import bode
from ident.studies.fit import held_delay
from ident.terminal import Progress
from ident.truth import SEARCH, stream
from models import reduced
from models.quantity import NumericalFailure
from models.reduced import Response
from models.statics import StaticShape, static_shape
from models.tow import refuse_sections_and_thrust
from reports.files import write_json, write_parameters, write_scores, write_traces
from reports.run_page import write_run_page

#: Significant digits of the traces in a run's folder.
_TRACE_DIGITS = 9


@dataclass(frozen=True, kw_only=True)
class RunResult:
    """Where the report is, and its summary for the terminal."""

    folder: Path
    table: list[dict[str, str]]


def run(
    configuration: Configuration, *, out: Path, seed: int, models: Sequence[str] | None, progress: Progress
) -> RunResult:
    """Make truth, fit, verify and report; the folder appears when all of it is complete.

    Raises
    ------
    InvalidInput
        The place cannot be written, the cable has sections or the vehicle a thrust, or the configuration leaves too
        little to score.
    NumericalFailure
        The truth cannot be simulated.
    """
    refuse_sections_and_thrust(configuration.tow, "The study of reduced models")
    names = tuple(models) if models is not None else configuration.identification.models
    configuration = replace(configuration, identification=replace(configuration.identification, models=names))
    with new_folder(out) as folder:
        began = time.perf_counter()
        progress("simulating the truth", 0.02)
        records = prepare_records(configuration, seed)
        shape = static_shape(configuration.tow)
        fits = _fits(configuration, names, shape, records, seed, progress)
        progress("scoring", 0.72)
        responses = _responses(fits, records)
        scores = _scores(fits, records, responses)
        progress("frequency responses", 0.78)
        frequencies = _bode(configuration, fits)
        progress("drawing the report", 0.85)
        material = run_material(configuration, seed, shape, records, fits, responses, scores, frequencies)
        write_run_page(folder, material)
        kept = scores[scores["record"] != CURRENT]
        write_scores(folder / "scores.csv", kept)
        write_scores(folder / "scores-current.csv", scores[scores["record"] == CURRENT])
        write_parameters(folder / "parameters.csv", material.parameters)
        check = records.check
        traces = folder / "traces"
        write_traces(traces, {f"{series.record}-responses": response_table(series) for series in material.records})
        for name, ship, vehicle in (
            (IDENTIFICATION, records.ship, records.run.vehicle),
            (TRUTH, check.ship, check.truth),
            (MEASURED, check.ship, records.fixes),
            (CURRENT, check.ship, check.in_current),
        ):
            write_record(join(name, ship, vehicle), traces / f"{name}.csv", digits=_TRACE_DIGITS)
        write_json(folder / "manifest.json", {**material.manifest, "seconds": round(time.perf_counter() - began, 2)})
        progress("done", 1.0)
    return RunResult(folder=out, table=summary(kept))


def summary(scores: pd.DataFrame) -> list[dict[str, str]]:
    """The terminal's table: a row a model, the errors of every record."""
    rows: list[dict[str, str]] = []
    records = list(dict.fromkeys(scores["record"]))
    for model, part in scores.groupby("model", sort=False):
        row = {"model": str(model)}
        for record in records:
            found = part.loc[part["record"] == record, "rms_velocity_m_s"]
            row[f"{record}, m/s"] = f"{float(found.iloc[0]):.4f}" if len(found) else ""
        cost = float(part["simulation_s_per_hour"].iloc[0])
        row["ms an hour"] = f"{1e3 * cost:.2f}" if math.isfinite(cost) else ""
        row["outcome"] = str(part["outcome"].iloc[0])
        rows.append(row)
    return rows


def identification_jobs(
    configuration: Configuration, names: Sequence[str], shape: StaticShape, case: Case, seed: int
) -> list[Job]:
    """The fits of a run as its configuration asks for them, in the order of the names."""
    settings = configuration.identification
    search_seed = int(stream(seed, SEARCH).integers(2**31))
    return [
        Job(
            model=model,
            cases=(case,),
            fixed=held_delay(model, settings.delay == "fixed"),
            budget=settings.budget,
            starts=settings.starts,
            seed=search_seed,
        )
        for model in (reduced.section(name, configuration.tow, shape) for name in names)
    ]


def _fits(
    configuration: Configuration,
    names: Sequence[str],
    shape: StaticShape,
    records: Records,
    seed: int,
    progress: Progress,
) -> tuple[Fit, ...]:
    jobs = identification_jobs(configuration, names, shape, records.cases[IDENTIFICATION], seed)
    finished: list[str] = []

    def done(place: int, fit: Fit) -> None:
        finished.append(names[place])
        share = len(finished) / len(names)
        progress(f"fitted {names[place]}: {fit.rms:.4f} m/s, {fit.outcome}", 0.1 + 0.6 * share)

    progress("fitting the reduced models", 0.1)
    # The costliest searches first, so that two threads end together; the report keeps the asked order.
    order = sorted(range(len(jobs)), key=lambda i: -len(reduced.parameters(jobs[i].model)))
    fits = fit_many([jobs[i] for i in order], done=lambda place, fit: done(order[place], fit))
    return tuple(fit for _, fit in sorted(zip(order, fits, strict=True), key=lambda pair: pair[0]))


def _responses(fits: Sequence[Fit], records: Records) -> dict[str, dict[str, Response]]:
    """Record to model to response; a model that cannot follow a record is left out there."""
    found: dict[str, dict[str, Response]] = {name: {} for name in records.cases}
    for record, case in records.cases.items():
        for fit in fits:
            try:
                found[record][reduced.info(fit.model).model] = reduced.respond(fit.model, case.drive)
            except NumericalFailure:
                continue
    return found


def _scores(fits: Sequence[Fit], records: Records, responses: dict[str, dict[str, Response]]) -> pd.DataFrame:
    rows = []
    drive = records.cases[IDENTIFICATION].drive
    costs = {id(fit): simulation_seconds_per_hour(fit.model, drive) for fit in fits if fit.outcome != "failed"}
    for record, case in records.cases.items():
        rows.append(baseline_row(RIGID, case, rigid(case.drive)))
        rows += [
            model_row(fit, case, simulation_s_per_hour=costs.get(id(fit), math.nan))
            for fit in fits
            if reduced.info(fit.model).model in responses[record]
        ]
    return scores_table(rows)


def _bode(configuration: Configuration, fits: Sequence[Fit]) -> tuple[pd.DataFrame, list[str], pd.DataFrame]:
    settings = configuration.bode
    points, missing = bode.reference_points(configuration.tow, settings.amplitudes, settings.omegas)
    curves = bode.reduced_curves(
        [fit.model for fit in fits if fit.outcome != "failed"], settings.amplitudes, settings.omegas
    )
    return points, missing, curves
