"""Fits of reduced models to records from files."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ident.configuration import Configuration
from ident.fit_files import write_fits
from ident.learning import Fit, Job, fit_many
from ident.places import new_file
from ident.recorded import distinct, recorded_case
from ident.terminal import Progress
from models import reduced
from models.drive import Start
from models.reduced import ReducedModel
from models.statics import static_shape
from models.tow import refuse_sections_and_thrust


@dataclass(frozen=True, kw_only=True)
class FitResult:
    """The fits for the terminal: a row a parameter, and what there is to say of the records."""

    notes: tuple[str, ...]
    table: list[dict[str, str]]


def fit(
    configuration: Configuration,
    *,
    records: Sequence[Path],
    models: Sequence[str],
    out: Path,
    start: Start,
    budget: int | None,
    starts: int | None,
    fixed_delay: bool,
    seed: int,
    window: float | None,
    progress: Progress,
) -> FitResult:
    """Fit every model to all records together and write FIT.json.

    Parameters
    ----------
    budget, starts, window
        As configured where ``None``; a `window` of 0 is for records without noise.

    Raises
    ------
    InvalidInput
        A record cannot be read or scored, the place cannot be written, or the cable has sections.
    """
    refuse_sections_and_thrust(configuration.tow, "The fit of reduced models")
    settings = configuration.identification
    distinct(records)
    with new_file(out) as temporary:
        progress("reading the records", 0.0)
        window = configuration.sensor.window if window is None else window
        recorded = [
            recorded_case(path, settle=configuration.scoring.settle, window=window, start=start) for path in records
        ]
        cases = tuple(record.case for record in recorded)
        shape = static_shape(configuration.tow)
        jobs = [
            Job(
                model=model,
                cases=cases,
                fixed=held_delay(model, fixed_delay or settings.delay == "fixed"),
                budget=settings.budget if budget is None else budget,
                starts=settings.starts if starts is None else starts,
                seed=seed,
            )
            for model in (reduced.section(name, configuration.tow, shape) for name in models)
        ]
        finished = 0

        def done(place: int, found: Fit) -> None:
            nonlocal finished
            finished += 1
            progress(f"fitted {models[place]}: {found.rms:.4f} m/s, {found.outcome}", finished / len(jobs))

        progress("fitting", 0.05)
        fits = fit_many(jobs, done=done)
        write_fits(
            temporary,
            fits,
            configuration_name=configuration.name,
            configuration_text=configuration.text,
            start=start,
            window=window,
        )
    notes = tuple(note for record in recorded for note in record.notes)
    return FitResult(notes=notes, table=[row for found in fits for row in _rows(found)])


def held_delay(model: ReducedModel, hold: bool) -> tuple[str, ...]:
    """The names to hold where the delay is not fitted and the model has one."""
    has = any(parameter.name == "delay" for parameter in reduced.parameters(model))
    return ("delay",) if hold and has else ()


def _rows(found: Fit) -> list[dict[str, str]]:
    intervals = {} if found.identifiability is None else {p.name: p for p in found.identifiability.intervals}
    rows = []
    for parameter in reduced.parameters(found.model):
        interval = intervals.get(parameter.name)
        rows.append(
            {
                "model": reduced.info(found.model).model,
                "parameter": parameter.name,
                "value": f"{parameter.value:.6g}",
                "unit": parameter.unit,
                "95 %": "" if interval is None else f"{interval.low:.4g} to {interval.high:.4g}",
                "determined": "fixed" if interval is None else interval.verdict,
                "rms m/s": f"{found.rms:.4f}",
                "outcome": found.outcome,
            }
        )
    return rows
