"""The committed sample pages: runs of built-in configurations, the studies, and the spread over seeds."""

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd

from data_synth.spectra import SEA_STATES
from ident import thesis
from ident.configuration import Configuration, load
from ident.costs import cost_summary, costs
from ident.learning import fit_many
from ident.manifest import versions
from ident.options import BENCHED, COMPARED
from ident.places import MANIFEST, new_folder
from ident.run_records import IDENTIFICATION, TRUTH, prepare_records
from ident.scores import model_row, scores_table
from ident.studies import run as study
from ident.studies.bench import bench
from ident.studies.compare import compare
from ident.studies.compensator import VESSEL, compensator
from ident.studies.response import response
from ident.studies.sea import sea
from ident.studies.stability import stability
from ident.studies.step import step
from ident.studies.turn import answer_claims
from ident.terminal import Progress
from models.statics import static_shape
from reports.files import write_json, write_table
from reports.markdown import Page

NAMES = COMPARED
STEP_NAME = "mangus-2500"
TURN_NAME = "multipart-2200"
#: Frequencies of the responses [rad/s], those of H Example 2.
RESPONSE_BAND = (0.05, 1.5)
#: Folder of each study, and how many shares of the time are left when it begins.
_STUDIES = {
    "simulators-compared": 2.2,
    "step-study": 2.0,
    "turning-study": 1.9,
    "response-swath-4000": 0.9,
    "response-s-shape-205": 0.85,
    "response-s-shape-205-thrust": 0.8,
    "sea-swath-4000": 0.75,
    "compensator-swath-4000-state-5": 0.7,
    "compensator-swath-4000-state-6": 0.65,
    "stability": 0.62,
    "benchmark": 0.55,
}
SEEDS = (0, 1, 2, 3, 4)

_HEADINGS = {
    "configuration": "configuration",
    "model": "model",
    "record": "record",
    "median": "median, m/s",
    "worst": "worst seed, m/s",
    "thesis": "thesis, m/s",
    "met": "median at or below",
}
_COST_HEADINGS = {
    "configuration": "configuration",
    "simulator": "simulator",
    "ms_an_hour": "one hour, ms",
    "error": "error, m/s",
    "worst_error": "worst, m/s",
}


def gallery(*, out: Path, progress: Progress, names: Sequence[str] = NAMES, seeds: Sequence[int] = SEEDS) -> None:
    """Make the pages of the built-in configurations, the studies, and the table of errors over the seeds."""
    with new_folder(out) as folder:
        tables = []
        share = 1.0 / (len(names) + 2)
        for i, name in enumerate(names):
            began = i * share

            def inside(stage: str, done: float, name: str = name, began: float = began) -> None:
                progress(f"{name}: {stage}", began + 0.5 * share * done)

            configuration = load(name)
            study.run(configuration, out=folder / name, seed=0, models=None, progress=inside)
            tables.append(errors_over_seeds(configuration, seeds, inside).assign(configuration=name))
        spent = pd.concat([costs(load(name), seeds) for name in names], ignore_index=True)
        write_table(folder / "costs.csv", spent, digits=4)
        for place, begun in _STUDIES.items():
            progress(place.replace("-", " "), 1.0 - begun * share)
            _study(place, names, folder / place)
        errors = pd.concat(tables, ignore_index=True)
        write_table(folder / "errors-over-seeds.csv", errors, digits=6)
        _page(folder, names, seeds, summary(errors), cost_summary(spent))
        write_json(folder / MANIFEST, {"program": "cable-ident", "command": "gallery", "versions": versions()})
        progress("done", 1.0)


def _study(place: str, names: Sequence[str], out: Path) -> None:
    """One of the studies."""
    if place == "simulators-compared":
        compare([load(name) for name in names], out=out, progress=_silent)
    elif place == "step-study":
        step(load(STEP_NAME), out=out, progress=_silent)
    elif place == "turning-study":
        answer_claims(load(TURN_NAME), out=out, progress=_silent)
    elif place == "stability":
        stability(out=out, progress=_silent)
    elif place == "benchmark":
        bench([load(name) for name in BENCHED], out=out, progress=_silent)
    elif place.startswith("response-"):
        low, high = RESPONSE_BAND
        named = load(place.removeprefix("response-"))
        response(named, amplitude=1.0, low=low, high=high, points=200, out=out, progress=_silent)
    elif place.startswith("sea-"):
        state = SEA_STATES[6]
        sea(
            load(place.removeprefix("sea-")),
            spectrum="bretschneider",
            height=state.height,
            peak_period=state.peak_period,
            rao=VESSEL,
            time_domain=True,
            out=out,
            progress=_silent,
        )
    else:
        name, state_number = place.removeprefix("compensator-").rsplit("-state-", 1)
        compensator(load(name), sea_state=int(state_number), time_domain=True, out=out, progress=_silent)


def _silent(stage: str, done: float) -> None:
    """No progress of a study inside another."""


def errors_over_seeds(configuration: Configuration, seeds: Sequence[int], progress: Progress) -> pd.DataFrame:
    """Scores of every model on every record for several seeds of the input, columns as scores.csv and seed."""
    parts = []
    for seed in seeds:
        progress(f"seed {seed}", 0.0)
        records = prepare_records(configuration, seed)
        case = records.cases[IDENTIFICATION]
        names = configuration.identification.models
        jobs = [
            replace(job, profile=False)
            for job in study.identification_jobs(configuration, names, static_shape(configuration.tow), case, seed)
        ]
        rows = [
            model_row(replace(fit, seconds=0.0), each, simulation_s_per_hour=0.0)
            for fit in fit_many(jobs)
            for each in records.cases.values()
        ]
        parts.append(scores_table(rows).assign(seed=seed))
    table = pd.concat(parts, ignore_index=True)
    return table[["seed", "model", "record", "rms_velocity_m_s", "rms_position_m", "fit_percent", "outcome"]]


def summary(errors: pd.DataFrame) -> pd.DataFrame:
    """Median and worst error over the seeds beside what the thesis prints, columns as the page's table."""
    rows = []
    for (name, model, record), part in errors.groupby(["configuration", "model", "record"], sort=False):
        printed = thesis.printed_errors(str(name), IDENTIFICATION, TRUTH)
        here = printed[(printed["model"] == model) & (printed["record"] == record)]["rms_velocity_m_s"]
        median, worst = part["rms_velocity_m_s"].median(), part["rms_velocity_m_s"].max()
        bar = float(here.iloc[0]) if len(here) else float("nan")
        met = "" if bar != bar else ("yes" if median <= bar else "no")
        rows.append((name, model, record, median, worst, bar, met))
    return pd.DataFrame(rows, columns=list(_HEADINGS))


def _page(folder: Path, names: Sequence[str], seeds: Sequence[int], table: pd.DataFrame, spent: pd.DataFrame) -> None:
    page = Page("Gallery")
    page.paragraph(
        f"Made by `cable-ident gallery` on {time.strftime('%Y-%m-%d', time.gmtime())}: one page a built-in "
        "configuration with seed 0, the step study, the turning study of a tow of three parts, the two reference "
        "simulators compared, responses, a sea and tuned heave compensators by the matrix method, stiff and extreme "
        "cases, the benchmark, and below the velocity errors over the seeds "
        f"{', '.join(map(str, seeds))} of the standard input, each with its own verification truth."
    )
    places = [*names, *_STUDIES]
    page.bullets([f"[{place}]({place}/report.md)" for place in places])
    page.heading("Velocity errors over seeds")
    page.table(table, _HEADINGS, {"median": ".4f", "worst": ".4f", "thesis": ".4f"})
    page.heading("Run time and accuracy of the simulators")
    page.paragraph(
        "Wall time for an hour of record at 1 s, warm kernels, one thread, and the RMS velocity error against a "
        "solution with a hundredth of the tolerance (spectral) or a sixteenth of the step (quadratic models, with "
        "their first guess of parameters). Linear models are solved exactly. Medians over the seeds; the last column "
        "is the worst."
    )
    page.table(spent, _COST_HEADINGS, {"ms_an_hour": ".2f", "error": ".1e", "worst_error": ".1e"})
    page.write(folder / "README.md")
