"""MoorDyn on the tows of the benchmark: its cheapest settings, their CPU time and error against its converged run."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ident.benchmark import peers
from ident.benchmark.peers import Setting, velocity_error
from ident.timing import Timing, front
from models.quantity import NumericalFailure
from models.towed_system import TowedSystem
from models.trace import Trace

#: The longest steps are looked for up to so many segments; with more they scale with the fastest rate.
SEARCHED = 12
#: Share of the longest step that is used, time between two positions of the ship [s], and what a run past its limit
#: is shortened by.
_SAFE, _COUPLING, _SHORTER = 0.95, 0.5, 0.8


@dataclass(frozen=True, slots=True, kw_only=True)
class PeerPoint:
    """One setting on one tow: RMS velocity error [m/s], and CPU time over simulated time."""

    tow: str
    setting: Setting
    error: float
    timing: Timing


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PeerTow:
    """One tow: the cheapest settings, those that no other beats in both error and time, and the converged run.

    `uncertainty` is the converged run's own error, estimated with half its segments [m/s].
    """

    points: list[PeerPoint]
    converged: Trace
    uncertainty: float


def run_tow(system: TowedSystem, name: str, ship: Trace, segments: Sequence[int], repetitions: int = 3) -> PeerTow:
    """All candidates on one tow with each number of segments, the cheapest of them timed again.

    Raises
    ------
    NumericalFailure
        The converged run fails.
    """
    duration = float(ship.t[-1] - ship.t[0])
    converged, uncertainty = _converged(system, ship, 2 * max(segments))
    reaches: dict[int, dict[str, float]] = {}
    for count in segments:
        if count <= SEARCHED or not reaches:
            reaches[count] = peers.largest_steps(system, ship, converged, count)
        else:
            reaches[count] = reaches[max(reaches)]
    tried: list[PeerPoint] = []
    for scheme, (damping, _, _) in peers.CANDIDATES.items():
        before = np.inf
        for count in segments:
            if scheme not in reaches[count]:
                continue
            step = _SAFE * reaches[count][scheme] / peers.fastest_rate(system, ship, count)
            setting = Setting(segments=count, scheme=scheme, step=step, coupling=_COUPLING, damping=damping)
            point = _settled(system, ship, converged, setting, before)
            if point is not None:
                before = point[1]
                timing = Timing(point[2] / duration, 0.0, 1)
                tried.append(PeerPoint(tow=name, setting=point[0], error=point[1], timing=timing))
    best = front(tried, lambda point: (point.error, point.timing.seconds))
    again = [[_seconds(system, ship, point.setting) for point in best] for _ in range(repetitions)]
    taken = np.array(again) / duration
    median, spread = np.median(taken, axis=0), np.ptp(taken, axis=0)
    points = [
        replace(point, timing=Timing(float(m), float(s / m), repetitions))
        for point, m, s in zip(best, median, spread, strict=True)
    ]
    return PeerTow(points=points, converged=converged, uncertainty=uncertainty)


def ratios(points: list[PeerPoint], chain: list[tuple[float, float]]) -> list[float]:
    """MoorDyn's time over the chain's at each point's error, the chain's by log-log interpolation.

    `chain` holds (error, seconds) of its front. Where the chain has no error so large, its cheapest run counts; where
    it has none so small, NaN.
    """
    errors, seconds = np.log(np.array(chain)[::-1].T)
    found = []
    for point in points:
        at = np.interp(np.log(point.error), errors, seconds, left=np.nan)
        found.append(point.timing.seconds / float(np.exp(at)))
    return found


def _converged(system: TowedSystem, ship: Trace, segments: int) -> tuple[Trace, float]:
    """Extrapolated from two runs at second order, and a third of what they differ by [m/s]."""

    def run(count: int) -> Trace:
        step = 1.8 / peers.fastest_rate(system, ship, count)
        setting = Setting(segments=count, scheme="RK2", step=step, coupling=0.5 * _COUPLING, damping=0.6)
        return peers.simulate(system, ship, setting).body

    fine, coarse = run(segments), run(segments // 2)

    def better(one: str) -> Any:
        return getattr(fine, one) + (getattr(fine, one) - getattr(coarse, one)) / 3.0

    trace = Trace(t=fine.t, position=better("position"), velocity=better("velocity"), tension=fine.tension)
    return trace, velocity_error(fine, coarse) / 3.0


def _settled(
    system: TowedSystem, ship: Trace, converged: Trace, setting: Setting, before: float
) -> tuple[Setting, float, float] | None:
    """The setting with a step that holds, its error [m/s] and its CPU time [s]; None where shorter steps do not help.

    A run whose error is not below that of fewer segments is past its limit.
    """
    for _ in range(4):
        try:
            run = peers.simulate(system, ship, setting)
        except NumericalFailure:
            error = np.inf
        else:
            error = velocity_error(run.body, converged)
            if error < before:
                return setting, error, run.seconds
        setting = replace(setting, step=_SHORTER * setting.step)
    return None


def _seconds(system: TowedSystem, ship: Trace, setting: Setting) -> float:
    return peers.simulate(system, ship, setting).seconds
