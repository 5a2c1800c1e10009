"""The step study of T 4.1: how delay and response depend on cable length and vehicle weight."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from data_synth.ships import Step, standard_input
from data_synth.ships import step as step_track
from ident import scene, thesis
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.places import new_folder
from ident.terminal import Progress
from ident.truth import INPUT, reference_run, stream
from models.quantity import InvalidInput
from models.statics import midpoint_travel_time, static_shape, travel_time
from models.tow import Tow, refuse_sections_and_thrust
from models.trace import Trace
from models.vehicle import Towfish
from reports.figures.steps import StepResponse
from reports.files import write_json, write_table
from reports.step_page import StepMaterial, write_step_page

#: How long a response is followed, how finely, and what counts as arrived.
_DURATION, _SAMPLE, _ARRIVED = 200.0, 0.5, 0.02
#: Sections that the study reads; what else the file gives is listed as unused.
_USED = ("", "water", "cable", "vehicle", "towfish", "tow", "current", "spectral", "input", "step")


@dataclass(frozen=True, kw_only=True)
class StepResult:
    """Where the page is, and the delays for the terminal."""

    folder: Path
    table: list[dict[str, str]]


def step(configuration: Configuration, *, out: Path, progress: Progress) -> StepResult:
    """Simulate steps of ship speed for every length and weight and write the page.

    Raises
    ------
    InvalidInput
        The place cannot be written, the cable does not hang or has sections, the vehicle has a thrust, or it is a
        towfish, whose weight is not one number.
    NumericalFailure
        A simulation fails.
    """
    refuse_sections_and_thrust(configuration.tow, "The step study")
    if isinstance(configuration.tow.vehicle, Towfish):
        raise InvalidInput(
            "The step study compares weights of a point vehicle, but the configuration has a [towfish]; "
            "give a [vehicle] instead."
        )
    settings, own = configuration.step, configuration.tow
    if own.speed != 0.0 or own.current is not None:
        raise InvalidInput(
            "The step study times a wave down a hanging cable, but the configuration has a [tow] or a [current], in "
            "which an inclined cable hands motion on along itself at once; leave both out."
        )
    with new_folder(out) as folder:
        runs = len(settings.lengths) + len(settings.weights)
        by_length, by_weight = [], []
        for i, length in enumerate(settings.lengths):
            progress(f"step on {length:g} m", 0.7 * i / runs)
            changed = replace(configuration, tow=_changed(own, length=length))
            by_length.append(_response(changed, f"{length:g} m"))
        for i, weight in enumerate(settings.weights):
            progress(f"step with {weight:g} N", 0.7 * (len(settings.lengths) + i) / runs)
            changed = replace(configuration, tow=_changed(own, weight=weight))
            by_weight.append(_response(changed, f"{weight:g} N"))
        ship = standard_input(configuration.input, stream(0, INPUT))
        random = {}
        for i, length in enumerate(settings.lengths):
            progress(f"random input on {length:g} m", 0.7 + 0.2 * i / len(settings.lengths))
            run = reference_run(replace(configuration, tow=_changed(own, length=length)), ship)
            assert run.vehicle.velocity is not None
            random[f"{length:g} m"] = run.vehicle.velocity[:, 0]
        progress("drawing the page", 0.9)
        unused = configuration.unused_beside(_USED)
        write_step_page(
            folder,
            StepMaterial(
                title=f"{configuration.name}: step study",
                description=configuration.description,
                step=settings.speed,
                by_length=by_length,
                by_weight=by_weight,
                delay_definition=f"the time at which the vehicle reaches {100.0 * _ARRIVED:g} % of the step",
                random_t=ship.t,
                random_ship_velocity=ship.spline(ship.t, 1)[:, 0],
                random_vehicle_velocity=random,
                random_note="The standard input of the identification (T 6.1), seed 0.",
                configuration=scene.configuration_table(configuration),
                configuration_text=configuration.text,
                left_out=scene.left_out(configuration),
                unused=scene.unused(configuration, unused),
                manifest=manifest("step", configuration, 0),
            ),
        )
        delays = _table(by_length + by_weight)
        write_table(folder / "step.csv", delays)
        responses = {"time_s": by_length[0].t}
        responses |= {f"{r.label}_m_s": r.velocity for r in by_length + by_weight}
        write_table(folder / "responses.csv", pd.DataFrame(responses))
        write_json(folder / "manifest.json", manifest("step", configuration, 0))
        progress("done", 1.0)
    texts = delays.drop(columns=["length_m", "weight_N"]).map(_text)
    rows = [{str(name): str(value) for name, value in row.items()} for row in texts.to_dict("records")]
    return StepResult(folder=out, table=rows)


def _text(value: object) -> str:
    return value if isinstance(value, str) else "" if value != value else f"{value:.1f}"


def _changed(tow: Tow, *, length: float | None = None, weight: float | None = None) -> Tow:
    """The tow with another length of cable or another weight; the mass stays (T figure 4-3)."""
    if length is not None:
        return replace(tow, cable=replace(tow.cable, length=length))
    assert not isinstance(tow.vehicle, Towfish)
    assert weight is not None
    return replace(tow, vehicle=replace(tow.vehicle, weight_in_water=weight))


def _response(configuration: Configuration, label: str) -> StepResponse:
    tow, speed = configuration.tow, configuration.step.speed
    track: Trace = step_track(Step(duration=_DURATION, sample=_SAMPLE, speed=speed, start=0.0))
    run = reference_run(configuration, track)
    assert run.vehicle.velocity is not None
    velocity = run.vehicle.velocity[:, 0]
    shape = static_shape(tow)
    return StepResponse(
        label=label,
        length=tow.cable.length,
        weight=tow.vehicle.weight_in_water,
        t=track.t,
        velocity=velocity,
        delay_measured=_arrival(track.t, velocity / speed) if speed else float("nan"),
        delay_midpoint=midpoint_travel_time(tow, shape),
        delay_front=travel_time(tow, shape),
        delay_thesis=thesis.DELAYS.get((tow.cable.length, tow.vehicle.weight_in_water), float("nan")),
    )


def _arrival(t: np.ndarray, share: np.ndarray) -> float:
    """When the response first reaches `_ARRIVED` of the step, between samples [s]."""
    above = np.flatnonzero(share >= _ARRIVED)
    if above.size == 0 or above[0] == 0:
        return float("nan") if above.size == 0 else float(t[0])
    i = int(above[0])
    return float(np.interp(_ARRIVED, share[i - 1 : i + 1], t[i - 1 : i + 1]))


def _table(responses: list[StepResponse]) -> pd.DataFrame:
    return pd.DataFrame(
        [
            (r.label, r.length, r.weight, r.delay_measured, r.delay_midpoint, r.delay_front, r.delay_thesis)
            for r in responses
        ],
        columns=["response", "length_m", "weight_N", "measured_s", "midpoint_s", "front_s", "thesis_s"],
    )
