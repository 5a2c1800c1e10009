"""The link-joint chain through one periodic record: what is compared, what it cost, and how many links it needs."""

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ident.sea_drawing import Drawing, between, ship_trace
from models import link_joint
from models.tow import Tow
from models.towed_system import TowedSystem
from models.trace import Floats, Trace

#: What both methods tell of: the cable's top along the cable, and against the deck above a compensator; the vehicle in
#: earth axes; the tension at both ends.
QUANTITIES = {
    "top": "m",
    "relative": "m",
    "horizontal": "m",
    "vertical": "m",
    "tension_bottom": "N",
    "tension_top": "N",
}
#: What moves by less than this share of the motion of the cable's top, or of the tension at rest, is not compared.
_STILL = 3e-3
#: Record that links are chosen on and what is dropped before it [s]; the coarsest links of the first part, and the
#: coarsest tolerance over the RMS speed of the cable's top.
_TRIAL, _TRIAL_RUN_IN, _LINKS, _SHARE = 600.0, 300.0, 12, 0.04
#: Links times steps that a run may take, half a minute, and how many times more it takes with twice the links and steps
#: an eighth as coarse.
BUDGET, _LONGER = 40_000_000, 10
#: Samples that a run is warmed up with.
_WARMING = 20


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ChainRecord:
    """One record of the chain's periodic state.

    Parameters
    ----------
    series
        (n,) of those of `QUANTITIES` that there are, less the value at rest.
    rest
        The values of the tensions at rest [N].
    links, tolerance
        Of each part, and of the steps [m/s].
    steps, slack
        Steps of the march, and times that a part fell slack in it.
    cpu
        CPU time of the whole run, with what sets in before the record [s].
    imposed
        RMS motion of the cable's top [m].
    """

    series: Mapping[str, Floats]
    rest: Mapping[str, float]
    links: tuple[int, ...]
    tolerance: float
    steps: int
    slack: int
    cpu: float
    imposed: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainSetting:
    """Links of the first part, tolerance of the steps over the RMS speed of the top, and the errors of RMS values."""

    links: int
    share: float
    error: Mapping[str, float]


def chain_record(
    tow: Tow, drawing: Drawing, position: Floats, angle: float, *, links: int, share: float, run_in: float
) -> ChainRecord:
    """Simulate the chain under a periodic motion of its top, from rest, and keep one record after the run-in.

    Parameters
    ----------
    position
        (n, 2) [m] horizontal and vertical motion of the cable's top over one record.
    angle
        Of the cable at its top, at rest [rad].
    links, share
        Of the first part, and the tolerance of the steps over the RMS speed of the top.
    run_in
        Time before the record, over the first half of which the motion sets in [s].

    Raises
    ------
    InvalidInput, NumericalFailure
        As of `models.link_joint.simulate`.
    """
    system, ship = TowedSystem.from_tow(tow), ship_trace(drawing, position, tow.speed, run_in)
    tolerance = share * _size(np.gradient(position, drawing.sample, axis=0))

    def run(track: Trace) -> link_joint.LinkJointResult:
        return link_joint.simulate(system, track, links=links, tolerance=tolerance, start="rest", companion=False)

    run(Trace(t=ship.t[:_WARMING], position=ship.position[:_WARMING]))
    began = time.thread_time()
    made = run(ship)
    cpu = time.thread_time() - began
    lower, upper = made.vehicle, made.bodies[0]
    assert lower.tension is not None
    assert upper.tension is not None
    raw = {
        "horizontal": lower.position[:, 0] - tow.speed * lower.t,
        "vertical": lower.position[:, 2],
        "tension_bottom": lower.tension[:, 1],
        "tension_top": upper.tension[:, 0],
    }
    kept = slice(-drawing.t.size, None)
    along = position @ np.array([math.cos(angle), math.sin(angle)])
    return ChainRecord(
        series={"top": along} | {name: values[kept] - values[0] for name, values in raw.items()},
        rest={name: float(raw[name][0]) for name in ("tension_bottom", "tension_top")},
        links=made.links,
        tolerance=tolerance,
        steps=made.steps,
        slack=len(made.slack),
        cpu=cpu,
        imposed=_size(position),
    )


def resolved(
    record: Callable[[Drawing, int, float, float], ChainRecord],
    draw: Callable[[float], Drawing],
    slowest: float,
    duration: float,
    accurate: float,
    budget: float = BUDGET,
) -> ChainSetting:
    """Links and steps whose errors are below a share of each RMS value, or the last that the run can afford.

    Parameters
    ----------
    record
        The chain's record in a drawing, of links, share and run-in [s].
    draw
        A sea that repeats after a time [s].
    slowest
        Frequency from which on RMS values are taken [rad/s].
    duration, budget
        Of the run [s], and the links times steps that it may take.
    """
    trial = draw(_TRIAL)
    times = duration / (trial.period + _TRIAL_RUN_IN)

    def sizes(made: ChainRecord) -> dict[str, float]:
        return {name: float(np.std(between(series, trial.sample, slowest))) for name, series in made.series.items()}

    links, share = _LINKS, _SHARE
    coarse = record(trial, links, share, _TRIAL_RUN_IN)
    while True:
        links, share = 2 * links, share / 8.0
        fine = record(trial, links, share, _TRIAL_RUN_IN)
        before, now = sizes(coarse), sizes(fine)
        # Links and steps converge at second order, a third of the difference is left; with slack links at first, and
        # then the next run has to cut its steps further too.
        left, longer = (1.0, 2 * _LONGER) if fine.slack else (1.0 / 3.0, _LONGER)
        error = {name: left * abs(now[name] / before[name] - 1.0) for name in now if moves(name, now[name], fine)}
        if max(error.values()) <= accurate or longer * times * fine.steps * sum(fine.links) > budget:
            return ChainSetting(links=links, share=share, error=error)
        coarse = fine


def moves(name: str, size: float, chain: ChainRecord) -> bool:
    """Whether an RMS value is large enough to be compared."""
    return size > _STILL * chain.rest.get(name, chain.imposed)


def _size(values: Floats) -> float:
    """RMS of the lengths of vectors (n, 2)."""
    return float(np.sqrt(np.mean(np.sum(values**2, axis=1))))
