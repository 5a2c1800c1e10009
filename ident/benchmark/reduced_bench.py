"""What the reduced models cost: error against run time over the step, and growth with the links and with the record."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np

from ident.benchmark.chain_bench import Growth
from ident.benchmark.library_integrators import METHODS, Method
from ident.configuration import Configuration
from ident.timing import Timing, interleaved
from ident.truth import identification_ship, start_of
from models import reduced
from models.drive import MAX_STEP, Drive
from models.quantity import InvalidInput
from models.reduced import ReducedModel
from models.statics import static_shape
from models.trace import Floats

#: The number of links that libraries solve.
LINKS = 4
#: The converged run has so many samples and steps to each of the ship's; its own error is told by half as many.
FINER = 64
#: Seed of the input, what a first call runs [s], and how long a timing lasts at least [s].
_SEED, _SOON, _LEAST = 0, 60.0, 0.005


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is run: `hours` of the standard input, steps [s], sizes, and the parts that take longest.

    `methods` are the libraries' integrators, `searched` the models that are fitted with `budget` simulations.
    """

    hours: float = 1.0
    links: tuple[int, ...] = (1, 2, 4, 8, 16)
    steps: tuple[float, ...] = (1.0, 0.5, 0.25, 0.125)
    methods: tuple[Method, ...] = METHODS
    growth_links: tuple[int, ...] = (1, 2, 4, 8, 16, 32, 64)
    growth_hours: tuple[float, ...] = (0.25, 0.5, 1.0, 2.0, 4.0)
    searched: tuple[str, ...] = reduced.MODEL_NAMES
    budget: int = 3000
    repetitions: int = 3


FULL = Effort()
#: Enough to see that everything still runs.
REDUCED = Effort(
    hours=0.1,
    links=(1, 4),
    steps=(1.0, 0.5, 0.25),
    methods=("RK45", "LSODA"),
    growth_links=(2, 4, 8),
    growth_hours=(0.05, 0.1),
    searched=("massless-4-quadratic",),
    budget=60,
    repetitions=1,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """Longest step [s] (nan: exact for the ship's spline), RMS velocity error [m/s], CPU time of the whole record."""

    step: float
    usual: bool  # the step that the model takes unless told otherwise
    error: float
    timing: Timing


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Precision:
    """Every step of one model, its converged velocity (n,) [m/s], and that run's own error [m/s]."""

    name: str
    model: ReducedModel
    points: list[Point]
    converged: Floats
    uncertainty: float

    @property
    def usual(self) -> Point:
        """The model as it comes."""
        return next(point for point in self.points if point.usual)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ModelGrowth:
    """Time of one model against a size."""

    name: str
    growth: Growth


def names(links: Sequence[int]) -> tuple[str, ...]:
    """Every reduced model, those of links with each of these numbers."""
    kinds = ["second-order", "first-order"]
    kinds += [f"{kind}-{count}" for kind in ("massless", "inertial") for count in links]
    return tuple(f"{kind}-{law}" for kind in kinds for law in ("linear", "quadratic"))


def standard_drive(configuration: Configuration, hours: float = 1.0) -> Drive:
    """The ship of the standard input, cut to so many hours.

    Raises
    ------
    InvalidInput
        The configuration's input is shorter.
    """
    drive = Drive.from_trace(identification_ship(configuration, _SEED), start=start_of(configuration.tow))
    return cut(drive, 3600.0 * hours)


def cut(drive: Drive, duration: float) -> Drive:
    """The beginning of a record, `duration` [s] long.

    Raises
    ------
    InvalidInput
        The record is shorter.
    """
    keep = drive.t <= drive.t[0] + duration
    if keep.all() and drive.t[-1] < drive.t[0] + duration - 1e-6:
        raise InvalidInput(
            f"The benchmark needs {duration:g} s of the standard input, but it has {drive.t[-1] - drive.t[0]:g} s; "
            "give the input of the configuration a longer duration."
        )
    return _drive(drive, drive.t[keep], drive.u[keep], drive.rates[keep], drive.max_step)


def stepped(drive: Drive, step: float) -> Drive:
    """The same ship for quadratic models that march with steps up to this one [s]."""
    return _drive(drive, drive.t, drive.u, drive.rates, step)


def refined(drive: Drive, parts: int) -> Drive:
    """The same cubic spline with every sampling interval cut into `parts`: the ship's motion is unchanged."""
    interval = np.diff(drive.t)
    s = interval[:, None] * np.arange(parts) / parts
    u1, u2, u3 = (drive.rates[:-1, i, None] for i in range(3))
    u = drive.u[:-1, None] + s * (u1 + s * (u2 / 2.0 + s * u3 / 6.0))
    rates = np.stack([u1 + s * (u2 + s * u3 / 2.0), u2 + s * u3, u3 + 0.0 * s], axis=2).reshape(-1, 3)
    t = np.append((drive.t[:-1, None] + s).ravel(), drive.t[-1])
    return _drive(drive, t, np.append(u.ravel(), drive.u[-1]), np.vstack([rates, drive.rates[-1:]]), drive.max_step)


def repeated(drive: Drive, times: int) -> Drive:
    """The same motion over and over, each time from where it ended: a longer record of the same kind."""
    t, u = drive.t - drive.t[0], drive.u
    every = [drive.t[0] + k * t[-1] + t[:-1] for k in range(times)]
    place = [k * u[-1] + u[:-1] for k in range(times)]
    return _drive(
        drive,
        np.append(np.concatenate(every), drive.t[0] + times * t[-1]),
        np.append(np.concatenate(place), times * u[-1]),
        np.vstack([np.tile(drive.rates[:-1], (times, 1)), drive.rates[-1:]]),
        drive.max_step,
    )


def rms(values: Floats) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def models(configuration: Configuration, wanted: Sequence[str]) -> dict[str, ReducedModel]:
    """The first guesses of models by name."""
    shape = static_shape(configuration.tow)
    return {name: reduced.section(name, configuration.tow, shape) for name in wanted}


def first_call(model: ReducedModel, drive: Drive) -> float:
    """Wall time of the first call less that of the second [s]: what is left of compiling, nothing once it is kept."""
    taken = []
    for _ in range(2):
        began = time.perf_counter()
        reduced.respond(model, cut(drive, _SOON))
        taken.append(time.perf_counter() - began)
    return max(0.0, taken[0] - taken[1])


def precision(name: str, model: ReducedModel, drive: Drive, effort: Effort) -> Precision:
    """Error against run time of one model over its longest steps; preparing the ship is not in the times."""

    def converged(parts: int) -> Floats:
        fine = refined(drive, parts)
        step = float(np.diff(fine.t).max())
        return reduced.respond(model, stepped(fine, step)).velocity[::parts]

    best, coarser = converged(FINER), converged(FINER // 2)
    longest, usual = float(np.diff(drive.t).max()), MAX_STEP
    # The sampling interval is the longest step that can be taken.
    steps = sorted({min(step, longest) for step in (*effort.steps, usual)}, reverse=True)
    if model.drag == "linear":
        steps = [float("nan")]
    drives = [drive if model.drag == "linear" else stepped(drive, step) for step in steps]
    timings = interleaved([partial(reduced.respond, model, each) for each in drives], effort.repetitions, _LEAST)
    points = [
        Point(
            step=step,
            usual=model.drag == "linear" or step == min(usual, longest),
            error=rms(reduced.respond(model, each).velocity - best),
            timing=timing,
        )
        for step, each, timing in zip(steps, drives, timings, strict=True)
    ]
    return Precision(name=name, model=model, points=points, converged=best, uncertainty=rms(best - coarser))


def growth_by_links(configuration: Configuration, drive: Drive, effort: Effort) -> list[ModelGrowth]:
    """Time of one record against the number of links, a model at a time."""
    found = []
    for kind, law in _KINDS:
        every = models(configuration, [f"{kind}-{count}-{law}" for count in effort.growth_links])
        works = [partial(reduced.respond, model, drive) for model in every.values()]
        timings = interleaved(works, effort.repetitions)
        found.append(_growth(f"{kind}-N-{law}", "links", [float(each) for each in effort.growth_links], timings))
    return found


def growth_by_length(configuration: Configuration, drive: Drive, effort: Effort) -> list[ModelGrowth]:
    """Time of the models of `LINKS` links against the length of the record [h]."""
    shortest = cut(drive, 3600.0 * effort.growth_hours[0])
    drives = [repeated(shortest, round(hours / effort.growth_hours[0])) for hours in effort.growth_hours]
    found = []
    for kind, law in _KINDS:
        name = f"{kind}-{LINKS}-{law}"
        model = models(configuration, [name])[name]
        timings = interleaved([partial(reduced.respond, model, each) for each in drives], effort.repetitions)
        found.append(_growth(name, "hours of record", list(effort.growth_hours), timings))
    return found


_KINDS = tuple((kind, law) for kind in ("massless", "inertial") for law in ("quadratic", "linear"))


def observed_order(points: Sequence[Point]) -> list[float]:
    """Order of the error between neighbouring steps, from the longest down."""
    pairs = pairwise(sorted(points, key=lambda point: -point.step))
    return [float(np.log(one.error / two.error) / np.log(one.step / two.step)) for one, two in pairs]


def _growth(name: str, what: str, sizes: Sequence[float], timings: Sequence[Timing]) -> ModelGrowth:
    growth = Growth(
        what=what,
        sizes=sizes,
        seconds=[timing.seconds for timing in timings],
        iterations=[],
        spread=[timing.spread for timing in timings],
        repetitions=timings[0].repetitions,
    )
    return ModelGrowth(name=name, growth=growth)


def _drive(like: Drive, t: Floats, u: Floats, rates: Floats, max_step: float) -> Drive:
    """Another ship with the same origin and start."""
    arrays = [np.ascontiguousarray(each) for each in (t, u, rates)]
    for each in arrays:
        each.setflags(write=False)
    return Drive(t=arrays[0], x0=like.x0, start_speed=like.start_speed, max_step=max_step, u=arrays[1], rates=arrays[2])
