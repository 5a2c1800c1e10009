"""What the benchmark records of the reduced models: rows, targets and the material of the page."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import pandas as pd

from ident.benchmark import library_bench, reduced_bench, search_bench
from ident.benchmark.bench_record import HOUR, Record
from ident.benchmark.library_bench import FLOOR, Comparison
from ident.benchmark.reduced_bench import FINER, Effort, Precision
from ident.benchmark.search_bench import PLAIN, RESTARTED, Descent
from ident.configuration import Configuration
from ident.learning import BUDGET
from ident.timing import Timing, front
from models.drive import Drive
from models.quantity import InvalidInput, NumericalFailure
from reports.figures.bench import Curve
from reports.figures.reduced_bench import Found, Grown
from reports.markdown import significant
from reports.reduced_bench import ReducedMaterial

#: Ratios to reach, of the fastest library's time to the model's at equal error.
TIMES = dict.fromkeys(("massless-4-linear", "inertial-4-linear", "inertial-4-quadratic"), 100.0)
TIMES |= {"massless-4-quadratic": 30.0}
#: What is expected to take so long [s]: all models of a tow, one beside the libraries, growth, one search.
_TOW_TAKES, _ONE_TAKES, _GROWTH_TAKES, _SEARCH_TAKES = 6.0, 5.0, 5.0, 1.5
#: The tow of the growth and of the searches, and how far off their parameters start.
_TOW, _OFF = "autec-1200", (1.0, 10.0)


@dataclass(kw_only=True)
class _Tow:
    """A tow, its ship, and what was measured on it."""

    configuration: Configuration
    drive: Drive
    found: list[Precision] = field(default_factory=list)
    compared: list[Comparison] = field(default_factory=list)


def measure(run: Record, effort: Effort, configurations: Sequence[Configuration]) -> ReducedMaterial:
    """Measure the reduced models on every configuration; growth, and the search, on one of them."""
    tows = [_Tow(configuration=each, drive=reduced_bench.standard_drive(each, effort.hours)) for each in configurations]
    for tow in tows:
        _precision(run, effort, tow)
    for tow in tows:
        _compare(run, effort, tow)
    _targets(run, tows)
    chosen = next((tow for tow in tows if tow.configuration.name == _TOW), tows[0])
    material = ReducedMaterial(
        words=f"The standard input, {effort.hours:g} h of it, and the first guesses of every model. Errors are of the "
        f"vehicle's velocity against the same equations with {FINER} samples and steps to each of the ship's, whose "
        "own error is what it differs by from a run with half as many. The step is the longest that a model may take: "
        "a chain with mass takes shorter ones where stability asks for them, and half of it where those would be so "
        "short that the implicit stepper is cheaper. Preparing the ship is not in the times.",
        curves=[_curve(tow, found) for tow in tows for found in tow.found if len(found.points) > 1],
        precision=_summary(pd.DataFrame([_line(tow, found) for tow in tows for found in tow.found])),
        libraries=pd.DataFrame([row for tow in tows for each in tow.compared for row in _beside(tow, each)]),
        library_words="The equations of a chain of four links, compiled, are handed to `solve_ivp` with output at the "
        "ship's samples; implicit methods get compiled derivatives where that is faster. The tolerance is the loosest "
        "found that meets the model's error at its usual step, by decades and then between two; where a linear "
        f"model's error is that of rounding, {FLOOR:g} m/s is asked for. A method that has become several times slower "
        f"than the fastest is cut off there, and its ratio is of what it had reached.{_apart(tows)}",
        ratios=pd.DataFrame([row for tow in tows for each in tow.compared for row in _every_step(tow, each)]),
        library_curves=[curve for each in chosen.compared for curve in _library_curves(each)],
        library_tow=chosen.configuration.name,
    )
    return _searched(run, effort, chosen, _grown(run, effort, chosen, material))


def _precision(run: Record, effort: Effort, tow: _Tow) -> None:
    """Error against run time of every model on one tow; rows of bench.csv."""
    name = tow.configuration.name
    if not run.has_time(f"{name}: the reduced models", _TOW_TAKES * effort.hours):
        return
    kind = f"against steps of 1/{FINER} of the sampling interval"
    duration = float(tow.drive.t[-1] - tow.drive.t[0])
    for model_name, model in reduced_bench.models(tow.configuration, reduced_bench.names(effort.links)).items():
        if model_name not in run.compile_s:
            run.compiled(model_name, reduced_bench.first_call(model, tow.drive))
        found = reduced_bench.precision(model_name, model, tow.drive, effort)
        tow.found.append(found)
        for point in found.points:
            setting = "exact for the ship's spline" if math.isnan(point.step) else f"step of {point.step:g} s"
            setting += " (usual)" if point.usual and len(found.points) > 1 else ""
            run.row(name, model_name, setting, kind, point.error, point.timing.over(duration))


def _compare(run: Record, effort: Effort, tow: _Tow) -> None:
    """The chains of four links beside the integrators of a library; rows of bench.csv."""
    name = tow.configuration.name
    duration = float(tow.drive.t[-1] - tow.drive.t[0])
    for found in tow.found:
        what = f"{name}: {found.name} by SciPy's integrators"
        if found.name not in TIMES or not run.has_time(what, _ONE_TAKES * effort.hours):
            continue
        try:
            compared = library_bench.compare(found, tow.drive, effort.methods, repetitions=min(3, effort.repetitions))
        except (InvalidInput, NumericalFailure) as error:
            run.cut.append((what, str(error)))
            continue
        tow.compared.append(compared)
        for each in compared.met:
            point = each.point
            if not each.reached:
                run.cut.append((what, each.why))
            setting = f"tolerance {point.tolerance:.2g}" + (", derivatives given" if point.jacobian else "")
            kind = f"{found.name}, against its converged run"
            run.row(name, f"solve_ivp {point.method}", setting, kind, point.error, point.timing.over(duration))


def _targets(run: Record, tows: Sequence[_Tow]) -> None:
    for name, asked in TIMES.items():
        compared = [each for tow in tows for each in tow.compared if each.precision.name == name]
        done = [each for each in compared if any(met.reached for met in each.met)]
        if not done:
            continue
        ratios = [each.ratio for each in done]
        methods, errors = ", ".join(dict.fromkeys(each.fastest.method for each in done)), [each.wanted for each in done]
        run.target(
            f"{name}: the fastest library integrator's CPU time over the model's at equal error",
            f"{asked:g}",
            f"{significant(min(ratios), 2)} to {significant(max(ratios), 2)} ({methods}), at {min(errors):.1e} to "
            f"{max(errors):.1e} m/s",
            min(ratios) >= asked,
        )


def _apart(tows: Sequence[_Tow]) -> str:
    """How far the converged runs are from those of a library, in a sentence."""
    if not (apart := [each.apart for tow in tows for each in tow.compared]):
        return ""
    return f" The models' converged runs and LSODA's at its tightest are at most {max(apart):.1e} m/s apart."


def _line(tow: _Tow, found: Precision) -> dict[str, Any]:
    usual = found.usual
    steps = [point for point in found.points if point.step >= usual.step]
    return {
        "model": found.name,
        "step_s": usual.step,
        "error_m_s": usual.error,
        "uncertainty_m_s": found.uncertainty,
        "order": _order(steps),
        "milliseconds": 1e3 * usual.timing.seconds * HOUR / float(tow.drive.t[-1] - tow.drive.t[0]),
        "spread": usual.timing.spread,
    }


def _summary(table: pd.DataFrame) -> pd.DataFrame:
    """A row a model: its worst errors and its median time and order."""
    if not len(table):
        return table
    every = table.groupby("model", sort=False)
    return every.agg(
        step_s=("step_s", "first"),
        error_m_s=("error_m_s", "max"),
        uncertainty_m_s=("uncertainty_m_s", "max"),
        order=("order", "median"),
        milliseconds=("milliseconds", "median"),
        spread=("spread", "max"),
    ).reset_index()


def _order(points: Sequence[reduced_bench.Point]) -> float:
    """Of the error, from the longest step to the usual one."""
    if len(points) < 2:
        return math.nan
    return math.log(points[0].error / points[-1].error) / math.log(points[0].step / points[-1].step)


def _curve(tow: _Tow, found: Precision) -> Curve:
    hours = float(tow.drive.t[-1] - tow.drive.t[0]) / HOUR
    every = [(point.error, point.timing.seconds / hours) for point in found.points]
    usual = [(found.usual.error, found.usual.timing.seconds / hours)]
    return Curve(tow=tow.configuration.name, label=found.name.removesuffix("-quadratic"), every=every, best=usual)


def _beside(tow: _Tow, compared: Comparison) -> list[dict[str, Any]]:
    return [
        {
            "configuration": tow.configuration.name,
            "model": compared.precision.name,
            "model_error_m_s": compared.precision.usual.error,
            "model_milliseconds": 1e3 * compared.own.seconds,
            "method": each.point.method,
            "derivatives": "given" if each.point.jacobian else "",
            "tolerance": each.point.tolerance,
            "error_m_s": each.point.error,
            "milliseconds": 1e3 * each.point.timing.seconds,
            "ratio": each.point.timing.seconds / compared.own.seconds,
            "note": "" if each.reached else "cut off",
        }
        for each in compared.met
    ]


def _every_step(tow: _Tow, compared: Comparison) -> list[dict[str, Any]]:
    points = compared.precision.points
    if len(points) < 2:
        return []
    return [
        {
            "configuration": tow.configuration.name,
            "model": compared.precision.name,
            "step_s": point.step,
            "error_m_s": point.error,
            "ratio": ratio,
        }
        for point, ratio in zip(points, compared.ratios(), strict=True)
    ]


def _library_curves(compared: Comparison) -> list[Curve]:
    name = compared.precision.name
    own = [(point.error, point.timing.seconds) for point in compared.precision.points]
    curves = [Curve(tow=name, label="the model", every=own, best=own)]
    for method in dict.fromkeys(run.method for run in compared.runs):
        every = [(run.error, run.timing.seconds) for run in compared.runs if run.method == method]
        curves.append(Curve(tow=name, label=method, every=every, best=front(every, lambda point: point)))
    return curves


def _grown(run: Record, effort: Effort, tow: _Tow, material: ReducedMaterial) -> ReducedMaterial:
    """The material with growth; rows of bench.csv without an error."""
    name = tow.configuration.name
    if not run.has_time(f"{name}: growth of the reduced models", _GROWTH_TAKES * effort.hours):
        return material
    by_links = reduced_bench.growth_by_links(tow.configuration, tow.drive, effort)
    by_length = reduced_bench.growth_by_length(tow.configuration, tow.drive, effort)
    for each in (*by_links, *by_length):
        growth = each.growth
        for size, seconds, spread in zip(growth.sizes, growth.seconds, growth.spread, strict=True):
            duration = float(tow.drive.t[-1] - tow.drive.t[0]) if each in by_links else HOUR * size
            timing = Timing(seconds / duration, spread, growth.repetitions)
            run.row(name, each.name, f"{size:g} {growth.what}", "growth, no error", math.nan, timing)
    grown = [
        Grown(
            model=each.name,
            what=each.growth.what,
            sizes=each.growth.sizes,
            seconds=each.growth.seconds,
            exponent=each.growth.exponent,
        )
        for each in (*by_links, *by_length)
    ]
    return replace(material, grown=grown, grown_tow=name)


def _searched(run: Record, effort: Effort, tow: _Tow, material: ReducedMaterial) -> ReducedMaterial:
    """The material with the searches."""
    name, rows, found = tow.configuration.name, list[dict[str, Any]](), list[Found]()
    models = reduced_bench.models(tow.configuration, effort.searched)
    if not run.has_time(f"{name}: the record to identify", _SEARCH_TAKES):
        return material
    cases = [search_bench.record_of(tow.configuration)]
    for off in _OFF:
        start = "first guess" if off == 1.0 else f"off by {off:g}"
        for model_name, model in models.items():
            what = f"{name}: identification of {model_name} from {start}"
            if not run.has_time(what, _SEARCH_TAKES * effort.budget / BUDGET):
                continue
            descents = search_bench.descents(model_name, model, cases, budget=effort.budget, off=off)
            rows += [_search_row(name, start, each) for each in descents]
            found += [
                Found(model=model_name, label=f"{each.how}, {start}", best=each.best.tolist(), starts=each.starts)
                for each in descents
                if each.how in (RESTARTED, PLAIN) and off != 1.0
            ]
    return replace(
        material,
        found=found,
        searches=pd.DataFrame(rows),
        search_words=f"The noise-free record of {name}: the standard input and the reference simulator's answer. A "
        "search starts from the first guess, and from every second parameter ten times as large and the others a "
        "tenth. Without restart it ends with its first simplex, and is the beginning of the search with restarts. "
        "SciPy's Nelder-Mead as it comes spreads its own first simplex and ends by its own rule. The command `fit` "
        "looks around the first guess before, and starts linear chains, and others whose guess is far off, from more "
        "than one place.",
    )


def _search_row(name: str, start: str, each: Descent) -> dict[str, Any]:
    return {
        "configuration": name,
        "model": each.model,
        "start": start,
        "search": each.how,
        "start_m_s": float(each.best[0]),
        "found_m_s": each.found,
        "simulations": each.best.size,
        "restarts": len(each.starts) - 1,
        "seconds": float(each.seconds[-1]),
        "ended": each.ended,
    }
