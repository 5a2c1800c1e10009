"""One tow through one turn: the ship's track, the simulation, and the row of `turn.csv` for every body."""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import count
from typing import Any

import numpy as np

from data_synth import ships
from ident.configuration import Configuration
from ident.heave import Floats, Oscillation, Peaks, find_heave_peaks, fit_heave
from ident.places import interruption
from ident.terminal import Progress
from models import link_joint
from models.quantity import InvalidInput, NumericalFailure, positive
from models.towed_system import TowedSystem
from models.trace import Trace
from reports.figures.turns import TurnHistory

#: Straight tow before the turn, sampling, least straight tow after a U-turn, time to put the rudder over [s].
APPROACH, SAMPLE, EXIT, EASE = 60.0, 1.0, 1800.0, 10.0
#: A U-turn is followed until the ship has gone so many lengths of all cables.
FOLLOWED = 2.5
#: Length of a link where the configuration gives no number of links [m], and the fewest links of the main cable.
LINK, LEAST_LINKS = 50.0, 20
#: Runs that are simulated at the same time.
WORKERS = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning:
    """A turn: how many parts are towed on how long a main cable [m], at what radius [m] and speed [m/s].

    `turns` is the number of circles; 0.5 is a U-turn, with straight tow before and after.
    """

    parts: int
    length: float
    radius: float
    speed: float
    turns: float

    def __post_init__(self) -> None:
        for name, quantity in (
            ("length", positive("L", "m")),
            ("radius", positive("R", "m")),
            ("speed", positive("V", "m/s")),
            ("turns", positive("N", "circles")),
        ):
            value = getattr(self, name)
            if not quantity.holds(value):
                raise InvalidInput(f"The {name} of a turn must be finite, above 0 {quantity.unit}; it is {value:g}.")

    @property
    def u_turn(self) -> bool:
        """Half a circle."""
        return self.turns == 0.5

    @property
    def circle(self) -> float:
        """Time of the ship's own circle [s]."""
        return 2.0 * math.pi * self.radius / self.speed

    @property
    def knots(self) -> float:
        """Speed in knots."""
        return self.speed / ships.KNOT

    def system(self, configuration: Configuration) -> TowedSystem:
        """The parts that are towed, on this length of main cable."""
        system = configuration.system_of(self.parts)
        first, *others = system.parts
        first = replace(first, cable=replace(first.cable, length=self.length))
        return replace(system, parts=(first, *others), speed=self.speed)

    def ship(self, total: float) -> Trace:
        """The ship's track; `total` [m] is the length of all cables."""
        # The rudder goes over within the turn, also in a short one.
        ease = min(EASE, 0.5 * self.turns * self.circle)
        if self.u_turn:
            after = max(EXIT, FOLLOWED * total / self.speed)
            return ships.u_turn(
                ships.UTurn(
                    speed=self.speed, radius=self.radius, approach=APPROACH, exit=after, sample=SAMPLE, ease=ease
                )
            )
        return ships.full_turn(
            ships.FullTurn(
                speed=self.speed,
                radius=self.radius,
                turns=self.turns,
                approach=APPROACH,
                exit=0.0,
                sample=SAMPLE,
                ease=ease,
            )
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TurnRun:
    """A turn and what came of it: a row of `turn.csv` for each body, rows of `peaks.csv`, and the histories.

    A simulation that failed has one row, whose note says so, and no history.
    """

    turning: Turning
    rows: list[dict[str, Any]]
    peaks: list[dict[str, Any]]
    history: TurnHistory | None


def simulate(configuration: Configuration, system: TowedSystem, ship: Trace, length: float) -> Any:
    """The chain behind a ship, from a steady tow, with links as long on any `length` [m] of main cable."""
    settings = configuration.link_joint
    link = configuration.tow.cable.length / settings.links if settings.links else LINK
    links = max(LEAST_LINKS, round(length / link))
    return link_joint.simulate(
        system, ship, links=links, tolerance=settings.tolerance, step=settings.step, start="steady"
    )


def run(configuration: Configuration, turning: Turning) -> TurnRun:
    """Simulate one turn.

    Raises
    ------
    InvalidInput
        The configuration has not as many parts, or the turn is too tight.
    """
    system = turning.system(configuration)
    ship = turning.ship(sum(part.cable.length for part in system.parts))
    common = _common(turning, system)
    try:
        result = simulate(configuration, system, ship, turning.length)
    except NumericalFailure as failure:
        row = {"body": system.parts[0].name} | common | {"note": str(failure)}
        return TurnRun(turning=turning, rows=[row], peaks=[], history=None)
    begun = ship.t >= APPROACH
    common |= {"error_m_s": result.error, "position_error_m": result.position_error}
    rows, peak_rows = [], []
    for i, (name, trace) in enumerate(zip(result.names, result.bodies, strict=True)):
        t, z = ship.t[begun] - APPROACH, trace.position[begun, 2]
        peaks = find_heave_peaks(t, z)
        if turning.u_turn:
            heave = Oscillation(note="no oscillation: one dip and back" if peaks.dips == 1 else "no fit to a U-turn")
        else:
            heave = fit_heave(t, trace.rates()[begun, 2], peaks)
        slack = [event.peak for event in result.slack if event.part == name]
        rows.append(
            {"body": name}
            | common
            | _measures(peaks, heave)
            | _places(ship, trace, turning)
            | _pull(trace, begun)
            | {"tension_max_N": float(result.tension_max[i]), "slack_events": len(slack)}
            | {"snap_peak_N": max(slack, default=math.nan)}
        )
        peak_rows += [{"body": name} | common | row for row in _peak_rows(peaks)]
    first = result.bodies[0].tension
    history = TurnHistory(
        label="",
        t=ship.t - APPROACH,
        circle=math.nan if turning.u_turn else turning.circle,
        ship=ship.position,
        bodies=dict(zip(result.names, (trace.position for trace in result.bodies), strict=True)),
        tension_ship=first[:, 0],
        tension_body=first[:, 1],
    )
    return TurnRun(turning=turning, rows=rows, peaks=peak_rows, history=history)


def _common(turning: Turning, system: TowedSystem) -> dict[str, Any]:
    """What all rows of a run share."""
    body = system.parts[0].body
    return {
        "parts": turning.parts,
        "length_m": turning.length,
        "radius_m": turning.radius,
        "speed_m_s": turning.speed,
        "sigma": system.parts[0].cable.mass * turning.length / body.mass if body and body.mass else math.nan,
        "circle_s": turning.circle,
        "manoeuvre": "u-turn" if turning.u_turn else "full-turn",
        "turns": turning.turns,
    }


def _measures(peaks: Peaks, heave: Oscillation) -> dict[str, Any]:
    decay = peaks.decay[np.isfinite(peaks.decay)]
    return {
        "peak_gap_s": float(peaks.gaps[1]) if peaks.gaps.size > 1 else math.nan,
        "decay_per_turn": float(np.exp(np.log(decay).mean())) if decay.size else math.nan,
        "dips": peaks.dips,
        "rise_m": peaks.rise,
        "period_s": heave.period,
        "damping_ratio": heave.damping_ratio,
        "amplitude_m": heave.amplitude,
        "drop_m": heave.drop,
        "relaxation_s": heave.relaxation,
        "fit_percent": heave.fit_percent,
        "plain_fit_percent": heave.plain_fit_percent,
        "note": heave.note,
    }


def _peak_rows(peaks: Peaks) -> list[dict[str, Any]]:
    gaps = [math.nan, *peaks.gaps]
    return [
        {
            "peak": i,
            "t_s": float(peaks.t[i]),
            "depth_m": -float(peaks.z[i]),
            "gap_s": float(gaps[i]),
            "height_m": float(peaks.height[i]),
            "decay": float(peaks.decay[i]),
        }
        for i in range(peaks.t.size)
    ]


def _places(ship: Trace, trace: Trace, turning: Turning) -> dict[str, float]:
    """Depth [m] and distance from the turn's centre [m], means over the last circle, and the depths on the way."""
    z = trace.position[:, 2]
    last = ship.t > ship.t[-1] - turning.circle
    whole = turning.turns >= 1.0
    centre = ship.position[last, :2].mean(axis=0)
    away = np.linalg.norm(trace.position[last, :2] - centre, axis=1)
    begun = ship.t >= APPROACH
    return {
        "depth_m": -float(z[last].mean()) if whole else math.nan,
        "tow_radius_m": float(away.mean()) if whole else math.nan,
        "start_depth_m": -float(z[0]),
        "deepest_m": -float(z.min()),
        "dip_s": _dip(ship.t[begun], z[begun]) if turning.u_turn else math.nan,
    }


def _dip(t: Floats, z: Floats) -> float:
    """How long a body stays below half of its dip [s]; NaN where it does not come back from it."""
    below = np.flatnonzero(z < 0.5 * (z[0] + z.min()))
    return float(t[below[-1]] - t[below[0]]) if below.size and below[-1] < z.size - 1 else math.nan


def _pull(trace: Trace, begun: Any) -> dict[str, float]:
    """Tension at the upper end of a body's cable: over that of the straight tow, and its fastest rise [N/s]."""
    assert trace.tension is not None
    top = trace.tension[:, 0]
    rate = np.diff(top[begun]) / np.diff(trace.t[begun])
    return {
        "tension_start_N": float(top[0]),
        "tension_least_N": float(trace.tension[begun].min()),
        "tension_rate_N_s": float(rate.max()),
    }


def run_all(
    configuration: Configuration, turnings: Sequence[Turning], progress: Progress, begin: float, end: float
) -> list[TurnRun]:
    """Run several turns, `WORKERS` at a time; progress goes from `begin` to `end`."""
    finished = count(1)

    def one(turning: Turning) -> TurnRun:
        if interruption.is_set():
            raise KeyboardInterrupt
        result = run(configuration, turning)
        done = next(finished)
        progress(f"turn {done} of {len(turnings)}", begin + (end - begin) * done / len(turnings))
        return result

    with ThreadPoolExecutor(max_workers=WORKERS) as pool:
        futures = [pool.submit(one, turning) for turning in turnings]
        try:
            return [future.result() for future in futures]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def ship_heave(
    configuration: Configuration, *, parts: int, speed: float, amplitude: float, period: float
) -> list[dict[str, Any]]:
    """Heave of every body on the straight tow while the ship heaves: a row of `ship-heave.csv` each.

    The size is that of the fundamental over whole periods, after the transient of the ship's eased start.
    """
    turning = Turning(parts=parts, length=configuration.tow.cable.length, radius=1.0, speed=speed, turns=1.0)
    system = turning.system(configuration)
    om = 2.0 * math.pi / period
    settle, read = max(5.0 * period, 300.0), 3.0 * period
    t = np.arange(0.0, settle + read, period / 40.0)
    ease = np.where(t < 2.0 * period, 0.5 - 0.5 * np.cos(0.5 * math.pi * t / period), 1.0)
    ship = Trace.along_x(t, speed * t, amplitude * ease * np.sin(om * t))
    result = simulate(configuration, system, ship, turning.length)
    late = t >= t[-1] - read
    basis = np.stack([np.sin(om * t[late]), np.cos(om * t[late]), np.ones(late.sum()), t[late]], axis=1)
    rows, above = [], amplitude
    for name, trace in zip(result.names, result.bodies, strict=True):
        s, c = np.linalg.lstsq(basis, trace.position[late, 2], rcond=None)[0][:2]
        size = math.hypot(s, c)
        rows.append(
            {
                "parts": parts,
                "body": name,
                "speed_m_s": speed,
                "period_s": period,
                "ship_heave_m": amplitude,
                "heave_m": size,
                "of_ship": size / amplitude,
                "of_above": size / above,
            }
        )
        above = size
    return rows
