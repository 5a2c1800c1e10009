"""What the spectral simulator costs: error against run time of its steppers, and how it grows."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from data_synth.ships import StandardInput, standard_input
from ident.benchmark import spectral_library
from ident.benchmark.chain_bench import Growth, until
from ident.benchmark.spectral_library import Equations, LibraryRun
from ident.timing import Timing, interleaved
from models.quantity import NumericalFailure
from models.spectral import SpectralResult, simulate
from models.spectral.basis import Fields, default_stations, prepare, smallest_stations
from models.spectral.simulation import Stepper, advance, local_error
from models.statics import StaticShape
from models.tow import Tow
from models.trace import Floats, Trace

#: The curve of runs that choose their own resolution and check it by a second run, beside those of the steppers.
CHOSEN = "implicit, all chosen"
#: Newmark's step of the runs for growth [s], their harmonics but where these grow, and how closely Newton solves [m/s].
STEP, HARMONICS, CLOSELY = 1.0, 10, 1e-5
#: Tolerance of the run that the steps of others are compared with [m/s], by another stepper.
EXACT = 1e-8
#: Tolerance of the default [m/s].
_DEFAULT = 1e-4
#: Library runs longer than this are timed once [s].
LONG = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is run: records of `duration`, of the baselines and of the chain `library`, for growth [s]."""

    duration: float = 900.0
    library: float = 900.0
    harmonics: tuple[int, ...] = (5, 10, 20)
    tolerances: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5)
    steps: tuple[float, ...] = (4.0, 2.0, 1.0, 0.5)
    explicit_tolerances: tuple[float, ...] = (1e-4,)
    finest: tuple[int, float] = (40, 3e-7)
    growth_harmonics: tuple[int, ...] = (5, 10, 20, 40, 80)
    growth_stations: tuple[int, ...] = (20, 40, 80, 160, 320)
    growth_lengths: tuple[float, ...] = (600.0, 1200.0, 2400.0, 4800.0)
    methods: tuple[str, ...] = spectral_library.METHODS
    growth_record: float = 900.0
    repetitions: int = 3


FULL = Effort()
#: Enough to see that everything still runs.
REDUCED = Effort(
    duration=200.0,
    library=100.0,
    harmonics=(4, 8),
    tolerances=(1e-2, 1e-4),
    steps=(2.0, 1.0),
    explicit_tolerances=(1e-4,),
    finest=(24, 1e-6),
    growth_harmonics=(4, 8, 16),
    growth_stations=(20, 40, 80),
    growth_lengths=(100.0, 200.0, 400.0),
    methods=("LSODA", "Radau"),
    growth_record=100.0,
    repetitions=1,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """One way to run: `accuracy` is the tolerance [m/s], of Newmark's method the step [s]."""

    stepper: str
    harmonics: int
    stations: int
    accuracy: float

    @property
    def words(self) -> str:
        """For the tables."""
        unit = "s" if self.stepper == "newmark" else "m/s"
        size = f"{self.harmonics} harmonics, {self.stations} stations, " if self.harmonics else ""
        return f"{self.stepper}: {size}{self.accuracy:g} {unit}"

    def run(self, tow: Tow, ship: Trace) -> SpectralResult:
        """Simulate."""
        if self.stepper == CHOSEN:
            return simulate(tow, ship, tolerance=self.accuracy)
        size: dict[str, Any] = {"harmonics": self.harmonics, "stations": self.stations, "companion": False}
        if self.stepper == "newmark":
            return simulate(tow, ship, stepper="newmark", step=self.accuracy, tolerance=CLOSELY, **size)
        size["stepper"] = self.stepper
        return simulate(tow, ship, tolerance=self.accuracy, **size)

    def steps(self, tow: Tow, ship: Trace, shape: StaticShape, fields: Fields) -> SpectralResult:
        """Run with tables that are ready."""
        if self.stepper == "newmark":
            local = local_error("newmark", CLOSELY)
            return advance(tow, ship, shape, fields, stepper="newmark", local=local, newmark_step=self.accuracy)
        stepper: Stepper = "runge-kutta" if self.stepper == "runge-kutta" else "implicit"
        return advance(tow, ship, shape, fields, stepper=stepper, local=local_error(stepper, self.accuracy))


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """One setting: RMS error of the vehicle's velocity [m/s], and CPU time a simulated second."""

    setting: Setting
    error: float
    timing: Timing


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Precision:
    """Every setting on one tow, those of other stations, and the converged run with its own error [m/s].

    `failed` are the settings that ended in an error, with its words.
    """

    points: list[Point]
    stations: list[Point]
    failed: list[tuple[Setting, str]]
    converged: SpectralResult
    uncertainty: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Libraries:
    """Errors of the steps alone [m/s] and CPU time a simulated second, all with the same harmonics.

    `ours` are the steps of the default, `whole` the default's whole run with its companion, `error`
    that of both; `own` the other steppers and tolerances; `runs` those of the library, by method in `best`.
    """

    harmonics: int
    error: float
    uncertainty: float
    ours: Timing
    whole: Timing
    own: list[Point]
    runs: list[LibraryRun]
    best: dict[str, LibraryRun]

    @property
    def ratio(self) -> float:
        """CPU time of the fastest library run that is as exact, over that of the stepper."""
        return min((run.timing.seconds for run in self.best.values()), default=float("nan")) / self.ours.seconds


def ship_of(settings: StandardInput, duration: float) -> Trace:
    """The standard input of a configuration, of any length [s]."""
    longer = replace(settings, duration=max(duration, settings.duration))
    return until(standard_input(longer, np.random.default_rng(0)), duration)


def settings_of(effort: Effort) -> list[Setting]:
    """Every setting of the diagram."""
    by_stepper = {
        "implicit": effort.tolerances,
        "newmark": effort.steps,
        "runge-kutta": effort.explicit_tolerances,
    }
    found = [
        Setting(stepper=stepper, harmonics=count, stations=default_stations(count), accuracy=accuracy)
        for stepper, accuracies in by_stepper.items()
        for count in effort.harmonics
        for accuracy in accuracies
    ]
    return found + [Setting(stepper=CHOSEN, harmonics=0, stations=0, accuracy=each) for each in effort.tolerances]


def work_precision(tow: Tow, ship: Trace, effort: Effort = FULL) -> Precision:
    """Error and time of every setting on one tow."""
    count, tight = effort.finest
    converged = simulate(tow, ship, harmonics=count, tolerance=tight, companion=False)
    half = simulate(tow, ship, harmonics=count // 2, tolerance=4.0 * tight, companion=False)
    middle = effort.harmonics[len(effort.harmonics) // 2]
    few = smallest_stations(middle)
    stations = [
        Setting(stepper="implicit", harmonics=middle, stations=each, accuracy=min(effort.tolerances))
        for each in (few, default_stations(middle), 2 * default_stations(middle), 4 * default_stations(middle))
    ]
    failed: list[tuple[Setting, str]] = []
    points = _measured(tow, ship, settings_of(effort), converged, effort, failed)
    return Precision(
        points=points,
        stations=_measured(tow, ship, stations, converged, effort, failed),
        failed=failed,
        converged=converged,
        uncertainty=error_of(half, converged),
    )


def libraries(tow: Tow, ship: Trace, effort: Effort = FULL) -> Libraries:
    """The library's integrators at the error that the default's steps leave, on the same equations."""
    duration = float(ship.t[-1] - ship.t[0])
    whole = simulate(tow, ship, tolerance=_DEFAULT)
    count = whole.harmonics
    exact = simulate(tow, ship, harmonics=count, tolerance=EXACT, stepper="runge-kutta", companion=False)
    check = simulate(tow, ship, harmonics=count, tolerance=10.0 * EXACT, companion=False)
    fields = prepare(tow, harmonics=count, shape=whole.shape)
    local = local_error("implicit", _DEFAULT)
    ours = partial(advance, tow, ship, whole.shape, fields, stepper="implicit", local=local)
    error = error_of(ours(), exact)
    own = [replace(each, harmonics=count, stations=default_stations(count)) for each in settings_of(effort)]
    own = [each for each in dict.fromkeys(own) if each.stepper != CHOSEN]
    equations, reference = Equations(tow, ship, count), velocity_of(exact)
    runs: list[LibraryRun] = []
    best: dict[str, LibraryRun] = {}
    for method in effort.methods:
        tried = spectral_library.at_error(equations, method, reference, error)
        runs += tried
        if tried[-1].error <= error:
            best[method] = tried[-1]
    short = [run for run in best.values() if run.timing.seconds * duration < LONG]
    works = [partial(equations.solve, run.method, run.tolerance, run.jacobian) for run in short]
    times = interleaved([ours, partial(simulate, tow, ship), *works], effort.repetitions)
    for run, timing in zip(short, times[2:], strict=True):
        best[run.method] = replace(run, timing=timing.over(duration))
    return Libraries(
        harmonics=count,
        error=error,
        uncertainty=error_of(check, exact),
        ours=times[0].over(duration),
        whole=times[1].over(duration),
        own=_measured(tow, ship, own, exact, effort, [], (whole.shape, fields)),
        runs=runs,
        best=best,
    )


def growth(tow: Tow, settings: StandardInput, effort: Effort = FULL) -> list[Growth]:
    """Time at a fixed step against harmonics, stations and the length of the record."""
    ship, longest = (ship_of(settings, end) for end in (effort.growth_record, max(effort.growth_lengths)))

    def setting(harmonics: int, stations: int) -> Setting:
        return Setting(stepper="newmark", harmonics=harmonics, stations=stations, accuracy=STEP)

    usual = setting(HARMONICS, default_stations(HARMONICS))
    return [
        _growth(
            "harmonics",
            effort.growth_harmonics,
            [partial(setting(each, default_stations(each)).run, tow, ship) for each in effort.growth_harmonics],
            effort,
        ),
        _growth(
            "stations",
            effort.growth_stations,
            [partial(setting(HARMONICS, each).run, tow, ship) for each in effort.growth_stations],
            effort,
        ),
        _growth(
            "record length, s",
            effort.growth_lengths,
            [partial(usual.run, tow, until(longest, each)) for each in effort.growth_lengths],
            effort,
        ),
    ]


def velocity_of(run: SpectralResult) -> Floats:
    """(n, 2) of the vehicle, surge and heave [m/s]."""
    velocity = run.vehicle.velocity
    assert velocity is not None
    return np.asarray(velocity[:, [0, 2]], dtype=float)


def error_of(run: SpectralResult, converged: SpectralResult) -> float:
    """RMS difference of the vehicle's velocity [m/s]."""
    return float(np.sqrt(np.mean(np.sum((velocity_of(run) - velocity_of(converged)) ** 2, axis=1))))


def _measured(
    tow: Tow,
    ship: Trace,
    settings: Sequence[Setting],
    converged: SpectralResult,
    effort: Effort,
    failed: list[tuple[Setting, str]],
    ready: tuple[StaticShape, Fields] | None = None,
) -> list[Point]:
    """Error and time of settings; those that end in an error go to `failed`. With `ready` tables the steps alone."""

    def work(setting: Setting) -> SpectralResult:
        return setting.run(tow, ship) if ready is None else setting.steps(tow, ship, *ready)

    done: list[tuple[Setting, float]] = []
    for setting in settings:
        try:
            done.append((setting, error_of(work(setting), converged)))
        except NumericalFailure as error:
            failed.append((setting, str(error)))
    duration = float(ship.t[-1] - ship.t[0])
    timings = interleaved([partial(work, setting) for setting, _ in done], effort.repetitions)
    return [
        Point(setting=setting, error=error, timing=timing.over(duration))
        for (setting, error), timing in zip(done, timings, strict=True)
    ]


def _growth(what: str, sizes: Sequence[float], works: Sequence[partial[SpectralResult]], effort: Effort) -> Growth:
    timings = interleaved(works, effort.repetitions)
    return Growth(
        what=what,
        sizes=sizes,
        seconds=[timing.seconds for timing in timings],
        iterations=[run.evaluations / run.steps for run in (work() for work in works)],
        spread=[timing.spread for timing in timings],
        repetitions=effort.repetitions,
    )
