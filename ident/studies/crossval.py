"""Recorded tows: fit the first part of each, score the rest, beside predictors without any physics (part of T 5.1)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ident import scene
from ident.baselines import CONSTANT_VELOCITY, RIGID_OFFSET, constant_velocity, rigid_offset
from ident.cases import Case
from ident.configuration import Configuration
from ident.learning import Fit, Job, fit_many
from ident.manifest import manifest
from ident.places import new_folder
from ident.recorded import RecordedCase, distinct, recorded_case
from ident.scores import Row, baseline_row, model_row, parameters_table, score, scores_table
from ident.series import measured_series
from ident.studies.fit import held_delay
from ident.terminal import Progress
from models import reduced
from models.drive import Start
from models.reduced import Response
from models.statics import static_shape
from models.tow import refuse_sections_and_thrust
from reports.files import write_json, write_parameters, write_scores
from reports.tow_page import TowMaterial, TowRecord, write_tow_page

#: Parameters are searched within this factor of the description's. Velocity alone cannot tell a vehicle that lags
#: from one that drifts away, and on these records it prefers the latter: farther out lies no cable at all.
_WITHIN = 10.0

_USED = ("", "water", "cable", "vehicle", "towfish", "tow", "current", "identification")


@dataclass(frozen=True, kw_only=True)
class CrossvalResult:
    """Where the page is, and the scores for the terminal."""

    folder: Path
    table: list[dict[str, str]]


@dataclass(frozen=True, kw_only=True, eq=False)
class _Tow:
    """A tow split in time: the part that is fitted, the part that is scored, and where one becomes the other."""

    recorded: RecordedCase
    fitted: Case
    scored: Case
    split: float


def crossval(
    configuration: Configuration,
    *,
    records: Sequence[Path],
    out: Path,
    fraction: float,
    start: Start,
    seed: int,
    progress: Progress,
) -> CrossvalResult:
    """Fit every model on the first part of every tow and score it on the rest; no tow, window or model is left out.

    Raises
    ------
    InvalidInput
        A record cannot be read, two have one name, a part has fewer than 20 scored samples, or the cable has sections.
    """
    refuse_sections_and_thrust(configuration.tow, "The cross-validation of reduced models")
    names = configuration.identification.models
    distinct(records)
    with new_folder(out) as folder:
        progress("reading the records", 0.0)
        tows = [_split(configuration, path, fraction, start) for path in records]
        labels = [tow.scored.name for tow in tows]
        shape = static_shape(configuration.tow)
        settings = configuration.identification
        jobs = [
            Job(
                model=model,
                cases=(tow.fitted,),
                fixed=held_delay(model, settings.delay == "fixed"),
                budget=settings.budget,
                starts=settings.starts,
                seed=seed,
                within=_WITHIN,
            )
            for tow in tows
            for model in (reduced.section(name, configuration.tow, shape) for name in names)
        ]
        finished = 0

        def done(place: int, found: Fit) -> None:
            nonlocal finished
            finished += 1
            label, name = labels[place // len(names)], names[place % len(names)]
            progress(f"{label}: fitted {name}, {found.outcome}", 0.05 + 0.8 * finished / len(jobs))

        fits = fit_many(jobs, done=done)
        by_tow = [fits[i * len(names) : (i + 1) * len(names)] for i in range(len(tows))]
        progress("scoring and drawing", 0.86)
        scores = scores_table([row for tow, found in zip(tows, by_tow, strict=True) for row in _rows(tow, found)])
        parameters = pd.concat(
            [parameters_table(found).assign(record=label) for label, found in zip(labels, by_tow, strict=True)],
            ignore_index=True,
        )
        about = manifest("crossval", configuration, seed, records=labels, fraction=fraction, start=start)
        write_tow_page(
            folder,
            TowMaterial(
                title=f"{configuration.name}: recorded tows",
                description=_description(configuration, fraction, start),
                tows=[_record(tow, found) for tow, found in zip(tows, by_tow, strict=True)],
                scores=scores,
                ends=pd.DataFrame(
                    [
                        (label, reduced.info(fit.model).model, fit.outcome, fit.reason)
                        for label, found in zip(labels, by_tow, strict=True)
                        for fit in found
                    ],
                    columns=["record", "model", "outcome", "reason"],
                ),
                parameters=parameters,
                limits=_limits(tows),
                configuration=scene.configuration_table(configuration),
                configuration_text=configuration.text,
                unused=scene.unused(configuration, _unused(configuration, start)),
                manifest=about,
            ),
        )
        write_scores(folder / "scores.csv", scores)
        for label, found in zip(labels, by_tow, strict=True):
            write_parameters(folder / f"parameters-{Path(label).stem}.csv", parameters_table(found))
        write_json(folder / "manifest.json", about)
        progress("done", 1.0)
    return CrossvalResult(folder=out, table=_summary(scores))


#: What the models leave out of any tow, and of those whose format tells how they were made.
_LIMITS = (
    "A current that the configuration does not give moves the vehicle, and the models answer with an offset.",
    "Turns leave the plane that the models live in; the motion across the axis is reported, not modelled.",
)
_DEEP_TOW_LIMITS = (
    (
        "The cable's length is not in the records and changes under the winch by hundreds of metres; the models keep "
        "one guessed length and the springs that follow from it."
    ),
    (
        "The published track went through a smoother that took the ship's velocity for the vehicle's. The models' "
        "output goes through the same operator, so the velocities compare, but what the smoother removed cannot be "
        "tested."
    ),
)


def _unused(configuration: Configuration, start: Start) -> tuple[str, ...]:
    """The given keys that this study does not read.

    Of the sensor's it reads the differentiator, and the settling time only where models start at rest.
    """
    read = {"sensor.differentiator_s", *(("input.settle_s",) if start == "rest" else ())}
    return tuple(key for key in configuration.unused_beside(_USED) if key not in read)


def _limits(tows: Sequence[_Tow]) -> tuple[str, ...]:
    deep = any(tow.recorded.planar.record.source == "deep-tow" for tow in tows)
    return (*_LIMITS, *(_DEEP_TOW_LIMITS if deep else ()))


def _split(configuration: Configuration, path: Path, fraction: float, start: Start) -> _Tow:
    recorded = recorded_case(
        path,
        settle=0.0,
        window=configuration.sensor.window,
        start=start,
    )
    case = recorded.case
    split = fraction * float(case.drive.t[-1] - case.drive.t[0])
    settle = configuration.scoring.settle if start == "rest" else 0.0
    return _Tow(
        recorded=recorded,
        fitted=case.between(settle, split),
        scored=case.between(split, math.inf),
        split=split,
    )


def _baselines(tow: _Tow, fits: Sequence[Fit]) -> dict[str, Response]:
    """Two predictors without physics, and one without a fit: the first guess of the last model that starts well."""
    whole = tow.recorded.case
    found = {
        CONSTANT_VELOCITY: constant_velocity(whole, tow.split),
        RIGID_OFFSET: rigid_offset(whole, tow.split),
    }
    guesses = [fit.start for fit in fits if fit.model.drag == "quadratic" and fit.outcome != "failed"]
    if guesses:
        response = reduced.respond(guesses[-1], whole.drive)
        found[f"baseline-unfitted-{reduced.info(guesses[-1]).model}"] = _placed(tow, response)
    return found


def _rows(tow: _Tow, fits: Sequence[Fit]) -> list[Row]:
    rows = [baseline_row(name, tow.scored, response) for name, response in _baselines(tow, fits).items()]
    for fit in fits:
        if fit.outcome != "failed":
            placed = _placed(tow, reduced.respond(fit.model, tow.scored.drive))
            found = score(tow.scored, placed)
            rows.append(model_row(fit, tow.scored) | {"rms_position_m": found.rms_position})
    return rows


def _record(tow: _Tow, fits: Sequence[Fit]) -> TowRecord:
    plane, case = tow.recorded.planar, tow.recorded.case
    record = plane.record
    responses = _baselines(tow, fits) | {
        reduced.info(fit.model).model: _placed(tow, reduced.respond(fit.model, case.drive))
        for fit in fits
        if fit.outcome != "failed"
    }
    series = measured_series(
        case,
        record.ship,
        responses,
        scored_from=float(case.drive.t[0]) + tow.split,
        description=f"Fitted up to {tow.split:.0f} s, scored from there.",
        label="vehicle, recorded",
    )
    ship, vehicle = (plane.on_map(trace) if trace is not None else None for trace in (record.ship, record.vehicle))
    assert vehicle is not None
    places = np.searchsorted(record.ship.t, series.t)
    depth = record.depth[places] if record.depth is not None else None
    gap = series.ship_position - series.vehicle_position
    return TowRecord(
        name=case.name,
        series=series,
        ship_track=ship.position[places, :2] - plane.origin[:2] if ship is not None else np.empty((0, 2)),
        vehicle_track=vehicle.position[places, :2] - plane.origin[:2],
        axis_rms_m=plane.ship_axis_rms,
        off_axis_rms_m=plane.ship_off_axis_rms,
        axis_degrees=(90.0 - math.degrees(plane.angle)) % 360.0,
        depth=depth,
        slant_range=None if depth is None else np.hypot(gap, depth),
        notes=record.notes,
        warnings=_doubts(tow),
    )


def _placed(tow: _Tow, response: Response) -> Response:
    """A response moved by its mean offset over the fitted part, which neither trail nor sheave would explain."""
    offset = float((tow.fitted.model_position(response) - tow.fitted.position).mean())
    return Response(position=response.position - offset, velocity=response.velocity)


def _doubts(tow: _Tow) -> list[str]:
    """What a reader should doubt: motion across the axis, and motion that no drag explains."""
    plane, case = tow.recorded.planar, tow.fitted
    ship, vehicle = plane.record.ship, case.velocity.mean()
    began, ended = case.time[0], case.time[-1]
    place = ship.at([began, ended])[:, 0]
    gap = float(vehicle) - float(place[1] - place[0]) / float(ended - began)
    doubts = [] if plane.warning is None else [plane.warning]
    text = (
        f"Over the fitted part the vehicle's mean velocity along the axis differs from the ship's by {gap:+.3f} m/s, "
        f"which moves it {gap * (ended - began):+.0f} m against the ship"
    )
    if plane.record.depth is not None:
        depth = np.interp([began, ended], ship.t, plane.record.depth)
        text += f" while its depth goes from {depth[0]:.0f} to {depth[1]:.0f} m: the winch, which no model here follows"
    return [*doubts, text + "."]


def _description(configuration: Configuration, fraction: float, start: Start) -> str:
    begin = "in their own steady shape at the ship's mean speed of the first minute" if start == "steady" else "at rest"
    return (
        f"{configuration.description}. Every model is fitted on the first {100.0 * fraction:g} % of each tow and "
        f"scored on the rest, starting {begin}. Parameters stay within a factor of {_WITHIN:g} of "
        f"the description's. Velocity is read from the fixes and from the models' positions by "
        f"the same operators, a differentiator over {configuration.sensor.window:g} s last. Position is not fitted: as "
        "the rigid offset does, every model starts from its mean offset over the fitted part; the constant velocity is "
        "the line through the last 300 s of that part."
    )


def _summary(scores: pd.DataFrame) -> list[dict[str, str]]:
    rows = []
    for model, part in scores.groupby("model", sort=False):
        row = {"model": str(model)}
        for found in part.to_dict("records"):
            row[f"{found['record']}, m/s"] = f"{found['rms_velocity_m_s']:.4f}"
            row[f"{found['record']}, m"] = f"{found['rms_position_m']:.1f}"
        rows.append(row)
    return rows
