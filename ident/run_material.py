"""What the page of a run shows, gathered from its records, fits and scores."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from ident import scene, thesis
from ident.configuration import Configuration
from ident.drag_tables import drag_over_spring_table, total_drag_table
from ident.learning import Fit
from ident.leaving_out.needless import needless
from ident.manifest import manifest
from ident.run_records import CURRENT, IDENTIFICATION, MEASURED, TRUTH, Records
from ident.scores import parameters_table
from ident.series import measured_series, truth_series
from ident.simulators import describe_chain
from ident.truth import Verification
from models import reduced
from models.reduced import Response
from models.spectral import SpectralResult
from models.statics import StaticShape
from reports.figures.residuals import ResidualCurves
from reports.markdown import significant
from reports.run_material import RunMaterial
from reports.series import RecordSeries

#: Snapshots of the cable on the page.
_SNAPSHOTS = 6


def run_material(
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
        left_out=scene.left_out(configuration, chain=True),
        unused=scene.unused(configuration, configuration.unused),
        needless=[(each.key, each.words) for each in needless(configuration, records.ship, result.harmonics)],
        input_note=_input_note(configuration, result, seed),
        truth_note=_truth_note(configuration, check),
        step_note=_step_note(named),
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
                "simulator": "link-joint",
                "links": check.chain.links,
                "steps": check.chain.steps,
                "error_m_s": check.chain.error,
                "energy_imbalance": check.chain.imbalance,
                "slack_events": len(check.chain.slack),
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
            label="vehicle, link-joint chain",
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
            label="vehicle, link-joint chain in a current",
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


def _step_note(fits: Mapping[str, Fit]) -> str:
    errors = {name: fit.step_error for name, fit in fits.items() if math.isfinite(fit.step_error)}
    if not errors:
        return ""
    worst = max(errors, key=lambda name: errors[name])
    return (
        f"Their steps err by at most {significant(errors[worst], 2)} m/s RMS ({worst}), estimated by finer ones "
        "on the identification record."
    )


def _truth_note(configuration: Configuration, check: Verification) -> str:
    stiffness = f"EA {configuration.tow.cable.axial_stiffness:.3g} N"
    names = ", ".join(part.name for part in configuration.tails)
    tails = (
        f" The truth tows {names} as well, which the models do not know of: what they do to the vehicle is part of "
        "the errors."
        if names
        else ""
    )
    return (
        "The truth is a run of the link-joint simulator, a nonlinear three-dimensional chain of elastic links "
        f"({stiffness}) that holds at any angle of the cable: {describe_chain(check.chain)} It shares the description "
        "of the system with the spectral simulator that the models were fitted to, but neither its equations nor its "
        f"stepper; it is no record from the sea.{tails} Its coefficients differ from those that the models were "
        f"fitted with: {check.changed}. Sensors: a fix every "
        f"{configuration.sensor.fix_interval:g} s with {configuration.sensor.fix_sigma:g} m of noise, "
        f"{100.0 * configuration.sensor.dropout_fraction:g} % dropouts in runs, an offset of "
        f"{configuration.sensor.offset:g} m; velocity by a Savitzky-Golay differentiator over "
        f"{configuration.sensor.window:g} s."
    )
