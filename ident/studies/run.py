"""The main study: truth, fits of every reduced model, verification, and the report."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from ident import scene, thesis
from ident.baselines import RIGID, rigid
from ident.cases import Case, case_from_fixes, case_from_truth
from ident.configuration import Configuration
from ident.drag_tables import drag_over_spring_table, total_drag_table
from ident.learning import Fit, Job, fit_many
from ident.manifest import manifest
from ident.places import new_folder
from ident.scores import baseline_row, model_row, parameters_table, scores_table, simulation_seconds_per_hour
from ident.series import measured_series, response_table, trace_table, truth_series
from ident.studies import bode
from ident.studies.fit import held_delay
from ident.truth import (
    SEARCH,
    Verification,
    fixes,
    identification_ship,
    reference_run,
    start_of,
    stream,
    verification,
)
from models import reduced
from models.quantity import NumericalFailure
from models.reduced import Response
from models.spectral import SpectralResult
from models.statics import StaticShape, static_shape
from models.trace import Trace
from reports.figures.residuals import ResidualCurves
from reports.files import write_json, write_parameters, write_scores, write_traces
from reports.run_material import RunMaterial
from reports.run_page import write_run_page
from reports.series import RecordSeries

Progress = Callable[[str, float], None]

IDENTIFICATION, TRUTH, MEASURED, CURRENT = (
    "identification",
    "verification-truth",
    "verification-measured",
    "verification-current",
)
#: Snapshots of the cable on the page.
_SNAPSHOTS = 6


@dataclass(frozen=True, kw_only=True)
class RunResult:
    """Where the report is, and its summary for the terminal."""

    folder: Path
    table: list[dict[str, str]]


@dataclass(frozen=True, kw_only=True, eq=False)
class Records:
    """The four records of a run, each prepared for scoring, with the traces they came from."""

    run: SpectralResult
    ship: Trace
    check: Verification
    fixes: Trace
    cases: dict[str, Case]


def run(
    configuration: Configuration, *, out: Path, seed: int, models: Sequence[str] | None, progress: Progress
) -> RunResult:
    """Make truth, fit, verify and report; the folder appears when all of it is complete.

    Raises
    ------
    InvalidInput
        The place cannot be written, or the configuration leaves too little to score.
    NumericalFailure
        The truth cannot be simulated.
    """
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
        material = _material(configuration, seed, shape, records, fits, responses, scores, frequencies)
        write_run_page(folder, material)
        kept = scores[scores["record"] != CURRENT]
        write_scores(folder / "scores.csv", kept)
        write_scores(folder / "scores-current.csv", scores[scores["record"] == CURRENT])
        write_parameters(folder / "parameters.csv", material.parameters)
        check = records.check
        write_traces(
            folder / "traces",
            {
                IDENTIFICATION: trace_table(records.ship, records.run.vehicle),
                TRUTH: trace_table(check.ship, check.truth),
                MEASURED: trace_table(check.ship, records.fixes),
                CURRENT: trace_table(check.ship, check.in_current),
                **{f"{series.record}-responses": response_table(series) for series in material.records},
            },
        )
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


def prepare_records(configuration: Configuration, seed: int) -> Records:
    ship = identification_ship(configuration, seed)
    result = reference_run(configuration, ship)
    check = verification(configuration, seed)
    seen = fixes(configuration, check.truth, seed)
    settle, start = configuration.scoring.settle, start_of(configuration.tow)
    cases = {
        IDENTIFICATION: case_from_truth(IDENTIFICATION, ship, result.vehicle, settle, start=start),
        TRUTH: case_from_truth(TRUTH, check.ship, check.truth, settle, start=start),
        MEASURED: case_from_fixes(MEASURED, check.ship, seen, settle, window=configuration.sensor.window, start=start),
        CURRENT: case_from_truth(CURRENT, check.ship, check.in_current, settle, start=start),
    }
    return Records(run=result, ship=ship, check=check, fixes=seen, cases=cases)


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


def _material(
    configuration: Configuration,
    seed: int,
    shape: StaticShape,
    records: Records,
    fits: Sequence[Fit],
    responses: dict[str, dict[str, Response]],
    scores: pd.DataFrame,
    frequencies: tuple[pd.DataFrame, list[str], pd.DataFrame],
) -> RunMaterial:
    result, check = records.run, records.check
    named = {reduced.info(fit.model).model: fit for fit in fits}
    examined = {name: fit.identifiability for name, fit in named.items() if fit.identifiability is not None}
    parameters = parameters_table(fits)
    symbols = {(row["model"], row["parameter"]): row["symbol"] for row in parameters.to_dict("records")}
    moments = np.linspace(0, len(records.ship) - 1, _SNAPSHOTS + 1).astype(int)[1:]
    x, z = shape.x + records.ship.position[0, 0], shape.z + records.ship.position[0, 2]
    noise = configuration.sensor.fix_sigma
    return RunMaterial(
        title=configuration.name,
        description=_sentence(configuration),
        configuration=scene.configuration_table(configuration),
        configuration_text=configuration.text,
        left_out=scene.left_out(configuration),
        unused=scene.unused(configuration, configuration.unused),
        input_note=_input_note(configuration, result, seed),
        truth_note=_truth_note(configuration, check),
        records=_series(configuration, records, responses),
        scores=scores,
        parameters=parameters,
        ends=pd.DataFrame(
            [(name, fit.outcome, fit.reason) for name, fit in named.items()], columns=["model", "outcome", "reason"]
        ),
        thesis=thesis.printed_errors(configuration.name, IDENTIFICATION, TRUTH),
        floors=pd.DataFrame(
            [(MEASURED, _floor(records, configuration), noise)],
            columns=["record", "rms_velocity_m_s", "rms_position_m"],
        ),
        drag_over_spring=thesis.with_printed_drag_over_spring(
            configuration.name, drag_over_spring_table(configuration.tow, shape, fits)
        ),
        total_drag=total_drag_table(fits),
        histories={name: fit.costs for name, fit in named.items()},
        starts=_starts(named),
        correlations={
            name: pd.DataFrame(
                found.correlation,
                index=[symbols[name, each] for each in found.names],
                columns=[symbols[name, each] for each in found.names],
            )
            for name, found in examined.items()
        },
        combinations=[
            (name, f"best {found.directions[0].text}, worst {found.directions[-1].text}")
            for name, found in examined.items()
            if len(found.directions) > 1
        ],
        twins=[
            (
                name,
                "the same response to within "
                f"{twin.difference:.1e} m/s with "
                + ", ".join(f"{each} = {value:.4g}" for each, value in zip(twin.names, twin.values, strict=True)),
            )
            for name, found in examined.items()
            for twin in found.twins
        ],
        bode_points=frequencies[0],
        bode_curves=frequencies[2],
        bode_note="Quadratic models are linearised anew at every amplitude and frequency: 8/(3 pi) r V at each node, "
        "V the node's own velocity amplitude, iterated until it agrees with itself. " + " ".join(frequencies[1]),
        static_shape=(x, z),
        snapshots=[(float(records.ship.t[i]), *result.cable_at(int(i))) for i in moments],
        snapshots_note="At rest and at moments of the identification record.",
        residual_tests=[
            ResidualCurves(
                model=name,
                lag=test.lag,
                autocorrelation=test.autocorrelation,
                cross_lag=test.cross_lag,
                cross_correlation=test.cross_correlation,
                band=test.band,
                cross_band=test.cross_band,
            )
            for name, found in examined.items()
            for test in found.residuals[:1]
            if named[name].model.drag == "quadratic"
        ],
        residual_numbers=pd.DataFrame(
            [
                (name, test.record, test.memory, *test.cross_peak, test.cross_band, test.cross_outside)
                for name, found in examined.items()
                for test in found.residuals
            ],
            columns=["model", "record", "memory_s", "cross_peak", "cross_lag_s", "cross_band", "cross_outside"],
        ),
        manifest=manifest(
            "run",
            configuration,
            seed,
            models=list(named),
            reference={
                "simulator": "spectral",
                "tolerance_m_s": configuration.spectral.tolerance,
                "error_m_s": result.error,
                "harmonics": result.harmonics,
                "stations": result.stations,
                "steps": result.steps,
            },
            verification={
                "simulator": "spectral" if check.links is None else "fine inertial chain",
                "links": check.links,
                "error_m_s": check.error,
                "coefficients": check.changes,
            },
        ),
    )


def _series(
    configuration: Configuration, records: Records, responses: dict[str, dict[str, Response]]
) -> list[RecordSeries]:
    check, cases = records.check, records.cases
    kind = configuration.verification.kind
    return [
        truth_series(
            cases[IDENTIFICATION],
            records.ship,
            records.run.vehicle,
            responses[IDENTIFICATION],
            description="The standard input of the identification (T 6.1) and the spectral simulator's response.",
            label="vehicle, spectral simulator",
        ),
        truth_series(
            cases[TRUTH],
            check.ship,
            check.truth,
            responses[TRUTH],
            description=f"A recorded-style manoeuvre ({kind}, T 6.2), the vehicle as the truth has it, without noise.",
            label="vehicle, fine chain",
        ),
        measured_series(
            cases[MEASURED],
            check.ship,
            responses[MEASURED],
            description="The same tow as its sensors see it; the velocity is that of the differentiator, which goes "
            "over the models' positions too.",
            label="vehicle, from fixes",
        ),
        truth_series(
            cases[CURRENT],
            check.ship,
            check.in_current,
            responses[CURRENT],
            description=f"The same tow in a current of {configuration.verification.current_speed:g} m/s, which no "
            "reduced model knows of; beside the others, without a bar.",
            label="vehicle, fine chain in a current",
        ),
    ]


def _floor(records: Records, configuration: Configuration) -> float:
    """RMS of what the differentiator makes of the fixes' noise alone, on the scored samples [m/s]."""
    reading = records.cases[MEASURED].velocity_reading
    assert reading is not None
    matrix = reading.matrix.tocsr()
    power = float(matrix.multiply(matrix).sum()) / matrix.shape[0]
    return configuration.sensor.fix_sigma * math.sqrt(power)


def _starts(named: dict[str, Fit]) -> pd.DataFrame:
    rows = [
        (name, start.number, start.rms, "settled" if start.settled else "budget")
        for name, fit in named.items()
        if len(fit.waterfall) > 1
        for start in fit.waterfall
    ]
    return pd.DataFrame(rows, columns=["model", "start", "rms_velocity_m_s", "outcome"])


def _sentence(configuration: Configuration) -> str:
    cable, vehicle = configuration.tow.cable, configuration.tow.vehicle
    text = (
        f"{cable.length:g} m of cable of {1e3 * cable.diameter:g} mm, {cable.weight_in_water:.3g} N/m in water, with "
        f"{vehicle.weight_in_water:g} N at its end."
    )
    if configuration.description:
        text = f"{configuration.description[0].upper()}{configuration.description[1:].rstrip('.')}: {text}"
    return text


def _input_note(configuration: Configuration, result: SpectralResult, seed: int) -> str:
    given = configuration.input
    error = (
        f"estimated error {result.error:.1e} m/s RMS, tolerance {configuration.spectral.tolerance:.0e}"
        if result.error is not None
        else "resolution as configured, no error estimate"
    )
    return (
        f"A normal sequence (sigma {given.noise_sigma:.3g} m/s) with a bias on every {given.segment:g} s, through a "
        f"second-order Butterworth filter at {given.cutoff:g} rad/s, scaled to at most {given.max_speed:g} m/s "
        f"(T 6.1), seed {seed}. Scored from {configuration.scoring.settle:g} s. The spectral simulator answers with "
        f"{result.harmonics} harmonics at {result.stations} stations in {result.steps} steps: {error}."
    )


def _truth_note(configuration: Configuration, check: Verification) -> str:
    changes = ", ".join(f"{name} {100.0 * (factor - 1.0):+.0f} %" for name, factor in check.changes.items())
    slant = f"{math.degrees(check.slant):.0f} degrees"
    if check.links is not None:
        maker = f"a fine inertial chain of {check.links} links with a kernel of its own"
        doubt = f"its angles are taken as small (the static cable leans by at most {slant})"
    else:
        maker = "the spectral simulator, because the cable leans too far for the fine chain or its body pitches"
        doubt = f"so the simulator itself is not put to the test (the static cable leans by up to {slant})"
    error = "no error estimate" if check.error is None else f"estimated error {check.error:.1e} m/s RMS"
    return (
        f"Interim truth: {maker} ({error}), not an independent three-dimensional simulator and no record from the "
        f"sea; {doubt}, the motion is planar. Its coefficients differ from those that the models were fitted with: "
        f"{changes}. Sensors: a fix every "
        f"{configuration.sensor.fix_interval:g} s with {configuration.sensor.fix_sigma:g} m of noise, "
        f"{100.0 * configuration.sensor.dropout_fraction:g} % dropouts in runs, an offset of "
        f"{configuration.sensor.offset:g} m; velocity by a Savitzky-Golay differentiator over "
        f"{configuration.sensor.window:g} s."
    )
