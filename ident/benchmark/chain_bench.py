"""What the link-joint simulator costs: work and precision, growth, the turn of W 3.2, and the dense form."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from data_synth.ships import FullTurn, full_turn
from ident.benchmark import dense_chain
from ident.timing import Timing, exponent, interleaved
from models import link_joint
from models.link_joint import LinkJointResult
from models.towed_system import TowedSystem
from models.trace import Floats, Trace

#: Step of the runs of fixed step [s], how long those of many links last [s], and the links of those of many steps.
STEP, DURATION, LENGTHS_LINKS = 1.0, 300.0, 44
#: The converged run: so many times the links, so small a share of the tolerance.
FINER, TIGHTER = 4, 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is run: `scale` shortens the tows, `segments` are MoorDyn's, of which the converged run has twice."""

    scale: float = 1.0
    links: tuple[int, ...] = (4, 6, 8, 12, 16, 24, 32, 44)
    tolerances: tuple[float, ...] = (3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
    growth_links: tuple[int, ...] = (16, 32, 64, 128, 256, 512)
    growth_lengths: tuple[float, ...] = (600.0, 1200.0, 2400.0, 4800.0)
    dense_links: tuple[int, ...] = (16, 64, 256)
    turn_links: int = 44
    turn_duration: float = 3000.0
    turn_tolerances: tuple[float, ...] = (1e-2, 3e-3, 1e-3)
    segments: tuple[int, ...] = (6, 12, 25, 44)
    repetitions: int = 5


FULL = Effort()
#: Enough to see that everything still runs.
REDUCED = Effort(
    scale=0.15,
    links=(4, 8),
    tolerances=(1e-2, 1e-3),
    growth_links=(8, 16, 32),
    growth_lengths=(100.0, 200.0, 400.0),
    dense_links=(8, 16),
    turn_links=8,
    turn_duration=300.0,
    turn_tolerances=(1e-2,),
    segments=(4, 8),
    repetitions=1,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainPoint:
    """One setting on one tow: RMS velocity error [m/s] of the worst body, and CPU time a simulated second."""

    tow: str
    links: int
    tolerance: float
    error: float
    timing: Timing


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ChainTow:
    """Every setting on one tow, the converged run and its own error, estimated with half its links [m/s].

    `start` is the longest time to the start shape [s], which the points leave out.
    """

    points: list[ChainPoint]
    start: float
    converged: Trace
    uncertainty: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Growth:
    """Time of a run against a size."""

    what: str
    sizes: Sequence[float]
    seconds: Sequence[float]
    iterations: Sequence[float]  # Newton's, a step
    spread: Sequence[float]
    repetitions: int

    @property
    def exponent(self) -> float:
        """Fitted exponent over the larger half of the sizes, where the fixed cost of a call is past."""
        larger = slice(-max(2, len(self.sizes) // 2), None)
        return exponent(self.sizes[larger], self.seconds[larger])

    @property
    def doubling(self) -> float:
        """Largest ratio of the times of neighbouring sizes, brought to a doubling."""
        sizes, seconds = np.log(np.array(self.sizes)), np.log(np.array(self.seconds))
        return float(2.0 ** (np.diff(seconds) / np.diff(sizes)).max())


@dataclass(frozen=True, slots=True, kw_only=True)
class Turn:
    """The largest errors of any body at any time against the finer run: depth as a share, track on the map [m].

    `uncertainty` is the finer run's own RMS velocity error, estimated with half its links [m/s].
    """

    parts: int
    links: int
    tolerance: float
    timing: Timing
    steps: int
    depth_error: float
    track_error: float
    uncertainty: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Dense:
    """One evaluation of the dense form beside one step of the chain, both [s]."""

    links: int
    evaluation: float
    step: float


def first_call(system: TowedSystem) -> float:
    """Wall time of the first call less that of the second [s]: what is left of compiling, nothing once it is kept."""
    ship = full_turn(FullTurn(turns=0.25, approach=0.0, exit=0.0))
    taken = []
    for _ in range(2):
        began = time.perf_counter()
        link_joint.simulate(system, ship, links=8, companion=False)
        taken.append(time.perf_counter() - began)
    return taken[0] - taken[1]


def work_precision(system: TowedSystem, name: str, ship: Trace, effort: Effort = FULL) -> ChainTow:
    """Error and time of every pair of links and tolerance on one tow.

    Raises
    ------
    NumericalFailure
        A run fails.
    """
    duration = float(ship.t[-1] - ship.t[0])
    finest, tight = FINER * max(effort.links), TIGHTER * min(effort.tolerances)
    converged, half = (_run(system, ship, count, tight) for count in (finest, finest // 2))
    settings = [(count, tolerance) for count in effort.links for tolerance in effort.tolerances]
    errors = [worst_error(_run(system, ship, *setting), converged) for setting in settings]
    timings = interleaved([partial(_run, system, ship, *setting) for setting in settings], effort.repetitions)
    # The way to the start shape is the same for a record of two samples.
    begin = Trace(t=ship.t[:2], position=ship.position[:2])
    starts = interleaved([partial(_run, system, begin, count) for count in effort.links], effort.repetitions)
    start = {count: timing.seconds for count, timing in zip(effort.links, starts, strict=True)}
    points = [
        ChainPoint(
            tow=name,
            links=count,
            tolerance=tolerance,
            error=error,
            timing=replace(timing, seconds=timing.seconds - start[count]).over(duration),
        )
        for (count, tolerance), error, timing in zip(settings, errors, timings, strict=True)
    ]
    return ChainTow(
        points=points,
        start=max(start.values()),
        converged=converged.vehicle,
        uncertainty=worst_error(converged, half) / 3.0,
    )


def growth_by_links(system: TowedSystem, ship: Trace, effort: Effort = FULL) -> Growth:
    """Time against links at a fixed step."""
    ship = until(ship, DURATION)
    works = [partial(_run, system, ship, count, step=STEP) for count in effort.growth_links]
    return _growth("links", effort.growth_links, works, effort)


def growth_by_length(system: TowedSystem, speed: float, radius: float, effort: Effort = FULL) -> Growth:
    """Time against the length of the record at a fixed step, on circles."""
    longest = circles(speed, radius, max(effort.growth_lengths))
    works = [partial(_run, system, until(longest, end), LENGTHS_LINKS, step=STEP) for end in effort.growth_lengths]
    return _growth("record length, s", effort.growth_lengths, works, effort)


def turn(system: TowedSystem, speed: float, radius: float, effort: Effort = FULL) -> list[Turn]:
    """Circles from the steady tow, against a run with four times the links.

    Raises
    ------
    NumericalFailure
        A run fails.
    """
    ship, links = circles(speed, radius, effort.turn_duration), effort.turn_links
    tight = 0.1 * min(effort.turn_tolerances)
    fine, half = (_run(system, ship, count, tight) for count in (FINER * links, FINER * links // 2))
    works = [partial(_run, system, ship, links, tolerance) for tolerance in effort.turn_tolerances]
    found = []
    for tolerance, work, timing in zip(
        effort.turn_tolerances, works, interleaved(works, effort.repetitions), strict=True
    ):
        run = work()
        pairs = list(zip(run.bodies, fine.bodies, strict=True))
        depth = np.array([_depth_error(*pair) for pair in pairs])
        track = np.array([_track_error(*pair) for pair in pairs])
        found.append(
            Turn(
                parts=len(system.parts),
                links=links,
                tolerance=tolerance,
                timing=timing,
                steps=run.steps,
                depth_error=float(depth.max()),
                track_error=float(track.max()),
                uncertainty=worst_error(fine, half) / 3.0,
            )
        )
    return found


def dense_form(system: TowedSystem, ship: Trace, effort: Effort = FULL) -> list[Dense]:
    """The dense form's evaluation and the chain's step, of a system's first part, with as many links each."""
    part, ship = system.parts[0], until(ship, DURATION)
    found = []
    for count in effort.dense_links:
        x = link_joint.steady_tow(system, (1.0, 0.0, 0.0), links=count).position[::-1]
        v = np.zeros_like(x)
        v[:, 0] = 1.0
        M, weight, C = dense_chain.lumps(part, system.water_density, x, v)
        force = weight - C @ v[1:].ravel()
        run = partial(_run, system, ship, count, step=STEP)
        evaluate = partial(dense_chain.accelerations, M, force, x, v, np.zeros(3))
        dense, chain = interleaved([evaluate, run], effort.repetitions)
        found.append(Dense(links=count, evaluation=dense.seconds, step=chain.seconds / run().steps))
    return found


def worst_error(run: LinkJointResult, converged: LinkJointResult) -> float:
    """RMS velocity error of the worst body [m/s]."""
    pairs = zip(run.bodies, converged.bodies, strict=True)
    return max(float(np.sqrt(np.mean(np.sum((a.rates() - b.rates()) ** 2, axis=1)))) for a, b in pairs)


def _run(
    system: TowedSystem, ship: Trace, links: int, tolerance: float = 1e-3, step: float | None = None
) -> LinkJointResult:
    return link_joint.simulate(system, ship, links=links, tolerance=tolerance, step=step, companion=False)


def _growth(what: str, sizes: Sequence[float], works: Sequence[partial[LinkJointResult]], effort: Effort) -> Growth:
    timings = interleaved(works, effort.repetitions)
    return Growth(
        what=what,
        sizes=sizes,
        seconds=[timing.seconds for timing in timings],
        iterations=[run.iterations / run.steps for run in (work() for work in works)],
        spread=[timing.spread for timing in timings],
        repetitions=effort.repetitions,
    )


def circles(speed: float, radius: float, duration: float) -> Trace:
    """Circles after half a minute straight ahead."""
    turns = speed * duration / (2.0 * math.pi * radius)
    return until(full_turn(FullTurn(speed=speed, radius=radius, turns=turns, approach=30.0, exit=0.0)), duration)


def until(ship: Trace, end: float) -> Trace:
    """The ship's motion up to a time [s]."""
    kept = ship.t <= end + 1e-9
    return Trace(t=ship.t[kept], position=ship.position[kept])


def _depth_error(one: Trace, other: Trace) -> Floats:
    """As a share of the depth."""
    return np.asarray(np.abs(one.position[:, 2] / other.position[:, 2] - 1.0), dtype=float)


def _track_error(one: Trace, other: Trace) -> Floats:
    """On the map [m]."""
    return np.asarray(np.linalg.norm((one.position - other.position)[:, :2], axis=1), dtype=float)
