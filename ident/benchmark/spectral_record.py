"""What the benchmark records of the spectral simulator: rows, targets and the material of the page."""

import math
import time
from collections.abc import Sequence
from typing import Any

import pandas as pd

from ident.benchmark import spectral_bench
from ident.benchmark.bench_record import HOUR, Record
from ident.benchmark.chain_bench import until
from ident.benchmark.simulator_defaults import FREQUENCIES, kept
from ident.benchmark.spectral_bench import CHOSEN, EXACT, STEP, Effort, Libraries, Point, Precision
from ident.benchmark.spectral_library import IMPLICIT, LibraryRun
from ident.configuration import Configuration
from ident.timing import Timing, front
from models.quantity import InvalidInput, NumericalFailure
from models.spectral import STEPPERS, simulate
from models.trace import Trace
from reports.figures.bench import Curve, Sizes
from reports.spectral_bench import SpectralMaterial

METHOD = "spectral"
#: Figure to reach: CPU time of the fastest library integrator over the stepper's.
_TIMES = 10.0
#: What is expected to take so long [s]: one configuration, its baselines, what the defaults keep, growth.
_ONE_TAKES, _LIBRARIES_TAKE, _DEFAULTS_TAKE, _GROWTH_TAKES = 8.0, 10.0, 2.0, 8.0


def first_call(configuration: Configuration) -> float:
    """Wall time of the first calls less that of the second ones [s]: what is left of compiling."""
    ship = spectral_bench.ship_of(configuration.input, 10.0)
    taken = []
    for _ in range(2):
        began = time.perf_counter()
        for stepper in STEPPERS:
            simulate(configuration.tow, ship, harmonics=4, stepper=stepper, step=STEP)
        taken.append(time.perf_counter() - began)
    return taken[0] - taken[1]


def measure(run: Record, effort: Effort, configurations: Sequence[Configuration]) -> SpectralMaterial:
    """Error against time, the library's integrators and the defaults on every configuration; growth on the first."""
    run.compiled(METHOD, first_call(configurations[0]))
    share = effort.duration / spectral_bench.FULL.duration
    parts: dict[str, list[Any]] = {
        name: [] for name in ("curves", "converged", "stations", "equal", "libraries", "kept")
    }
    for each in configurations:
        what = f"{each.name} by the spectral simulator"
        if not run.has_time(what, _ONE_TAKES * share):
            continue
        ship = spectral_bench.ship_of(each.input, effort.duration)
        short = until(ship, effort.library)
        try:
            precision = spectral_bench.work_precision(each.tow, ship, effort)
            _precision(run, each.name, precision, parts)
            if run.has_time(f"{each.name}: what the defaults keep", _DEFAULTS_TAKE * share):
                _kept(run, each, ship, precision, short, parts)
            if run.has_time(f"{each.name}: library integrators on the spectral equations", _LIBRARIES_TAKE * share):
                _libraries(run, each.name, spectral_bench.libraries(each.tow, short, effort), parts)
        except (InvalidInput, NumericalFailure) as error:
            run.cut.append((what, str(error)))
    return SpectralMaterial(
        words=f"{effort.duration:g} s of each configuration's standard input. The steppers are given their harmonics, "
        f"with the usual stations; `{CHOSEN}` finds all of it for a tolerance and checks it by a second run, which is "
        f"in its time. Errors are against {effort.finest[0]} harmonics at {effort.finest[1]:g} m/s, whose own error is "
        "the whole difference to half the harmonics at four times the tolerance.",
        library_words=f"{effort.library:g} s, all with the harmonics that the default chooses, so that the error is "
        f"that of the steps alone: against Runge-Kutta's at {EXACT:g} m/s, whose own error is its difference to the "
        "implicit stepper at ten times that. The integrators of `scipy.integrate.solve_ivp` call the simulator's "
        "compiled forces, in a state that needs no acceleration of the ship, and take a compiled Jacobian where that "
        "makes them faster. Their tolerance is the loosest that errs no more than the default's steps. All "
        "times are those of the steps alone, but for the default's whole run.",
        kept_words=f"The spectral simulator on {effort.duration:g} s of the standard input, the chain on "
        f"{effort.library:g} s of it, the matrix method at {FREQUENCIES} frequencies with 1 m of motion along the top; "
        "against runs with four times the links or segments.",
        curves=parts["curves"],
        converged=pd.DataFrame(parts["converged"]),
        stations=pd.DataFrame(parts["stations"]),
        equal=parts["equal"],
        libraries=pd.DataFrame(parts["libraries"]),
        kept=pd.DataFrame(parts["kept"]),
        sizes=_growth(run, effort, configurations[0], share),
        sized=configurations[0].name,
    )


def _precision(run: Record, name: str, found: Precision, parts: dict[str, list[Any]]) -> None:
    kind = "vehicle's velocity, against a converged run"
    for point in (*found.points, *found.stations):
        run.row(name, METHOD, point.setting.words, kind, point.error, point.timing)
    for stepper in (*STEPPERS, CHOSEN):
        parts["curves"] += _curve(name, stepper, [each for each in found.points if each.setting.stepper == stepper])
    parts["converged"].append(
        {
            "configuration": name,
            "harmonics": found.converged.harmonics,
            "steps": found.converged.steps,
            "uncertainty_m_s": found.uncertainty,
        }
    )
    parts["stations"] += [
        {
            "configuration": name,
            "harmonics": point.setting.harmonics,
            "stations": point.setting.stations,
            "error_m_s": point.error,
            "seconds_per_hour": HOUR * point.timing.seconds,
        }
        for point in found.stations
    ]
    run.cut += [(f"{name}: {setting.words}", why) for setting, why in found.failed]


def _libraries(run: Record, name: str, found: Libraries, parts: dict[str, list[Any]]) -> None:
    kind = f"steps alone, {found.harmonics} harmonics"
    for each in found.runs:
        given = ", Jacobian given" if each.jacobian else ""
        setting = f"spectral equations, {found.harmonics} harmonics, tolerance {each.tolerance:.2g}{given}"
        run.row(name, f"solve_ivp {each.method}", setting, kind, each.error, each.timing)
    for stepper in STEPPERS:
        parts["equal"] += _curve(name, stepper, [each for each in found.own if each.setting.stepper == stepper])
    for method in dict.fromkeys(each.method for each in found.runs):
        every = [
            (each.error, HOUR * each.timing.seconds)
            for each in found.runs
            if each.method == method and math.isfinite(each.error)
        ]
        if every:
            parts["equal"].append(Curve(tow=name, label=method, every=every, best=front(every, lambda point: point)))
    parts["libraries"] += [
        _library(name, "implicit, the steps of the default", "", found.error, found.ours, found),
        _library(name, "the default's whole run, with a companion", "", found.error, found.whole, found),
        *(
            _library(name, method, _jacobian(each), each.error, each.timing, found)
            for method, each in found.best.items()
        ),
    ]
    if found.best:
        fastest = min(found.best.values(), key=lambda each: each.timing.seconds)
        run.target(
            f"{name}: {fastest.method}'s CPU time over the spectral stepper's at equal error",
            f"{_TIMES:g}",
            f"{found.ratio:.1f}",
            found.ratio >= _TIMES,
        )


def _jacobian(run: LibraryRun) -> str:
    if run.method not in IMPLICIT:
        return "none"
    return "given" if run.jacobian else "by differences"


def _library(name: str, method: str, jacobian: str, error: float, timing: Timing, found: Libraries) -> dict[str, Any]:
    return {
        "configuration": name,
        "method": method,
        "jacobian": jacobian,
        "error_m_s": error,
        "seconds_per_hour": HOUR * timing.seconds,
        "ratio": timing.seconds / found.ours.seconds,
    }


def _kept(
    run: Record,
    configuration: Configuration,
    ship: Trace,
    precision: Precision,
    short: Trace,
    parts: dict[str, list[Any]],
) -> None:
    rows = kept(configuration, ship, precision.converged, short)
    parts["kept"] += [
        {
            "configuration": configuration.name,
            "simulator": each.simulator,
            "unit": each.unit,
            "asked": each.asked,
            "estimated": each.estimated,
            "found": each.found,
            "met": each.met,
        }
        for each in rows
    ]
    told = ", ".join(f"{each.simulator} {each.found / each.asked:.2f}" for each in rows)
    run.target(
        f"{configuration.name}: the defaults' errors over what they ask for",
        "at most 1",
        told,
        all(each.met for each in rows),
    )


def _curve(name: str, stepper: str, points: Sequence[Point]) -> list[Curve]:
    every = [(point.error, HOUR * point.timing.seconds) for point in points]
    return [Curve(tow=name, label=stepper, every=every, best=front(every, lambda point: point))] if every else []


def _growth(run: Record, effort: Effort, configuration: Configuration, share: float) -> list[Sizes]:
    """Time against harmonics, stations and the record; rows of bench.csv without an error."""
    if not run.has_time("growth of the spectral simulator", _GROWTH_TAKES * share):
        return []
    found = []
    for growth in spectral_bench.growth(configuration.tow, configuration.input, effort):
        for size, seconds, spread in zip(growth.sizes, growth.seconds, growth.spread, strict=True):
            duration = size if growth.what.startswith("record") else effort.growth_record
            timing = Timing(seconds / duration, spread, growth.repetitions)
            setting = f"newmark, fixed step of {STEP:g} s, {growth.what} {size:g}"
            run.row(configuration.name, METHOD, setting, "growth, no error", math.nan, timing)
        found.append(
            Sizes(
                what=growth.what,
                sizes=growth.sizes,
                seconds=growth.seconds,
                iterations=growth.iterations,
                exponent=growth.exponent,
            )
        )
    return found
