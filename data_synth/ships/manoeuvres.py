"""Recorded-style manoeuvres: what T 6.2 says of the three tows at sea, in numbers.

The records themselves are not published. Each manoeuvre is built from closed forms: speed changes eased by
half a cosine, and whole periods of ``A (1 - cos om t)``, which start and end at rest.
"""

from dataclasses import dataclass
from itertools import cycle
from typing import Annotated

import numpy as np

from data_synth.settings import check_increasing, check_same_length
from data_synth.ships.forcing import Duration, Sample, Speeds, Times
from data_synth.ships.motion import eased, planar_motion, sample_times
from models.quantity import InvalidInput, Quantity, check_quantities, non_negative, positive
from models.trace import Floats, Trace

# Time [s] and speed [m/s] of each order.
# fmt: off
_SHARP_ORDERS = (
    (20.0, 0.5), (520.0, 0.05), (590.0, 0.5), (640.0, 0.25), (690.0, 0.5), (980.0, -0.2), (1040.0, -0.5),
    (1520.0, -0.1), (1580.0, -0.5), (1660.0, -0.3), (1710.0, -0.5), (1760.0, -0.4), (1990.0, 0.3), (2050.0, 0.5),
    (2450.0, 0.0), (2520.0, 0.45), (2560.0, 0.2), (2640.0, 0.5), (2690.0, 0.4), (3100.0, -0.25), (3160.0, -0.5),
)
# fmt: on

Intervals = tuple[Annotated[float, positive("T_i", "s")], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class StartsAndStops:
    """The 740 m tow: starts and stops in one direction, mean speed about 0.25 m/s.

    The ship runs at each of `speeds` for `runs`, then stops for `pauses`; each list starts again at its end.
    A change of speed takes `rise`.
    """

    duration: Duration = 3600.0
    sample: Sample = 1.0
    speeds: tuple[Annotated[float, non_negative("v", "m/s")], ...] = (0.45, 0.3, 0.5, 0.35)
    runs: Intervals = (330.0, 420.0, 270.0)
    pauses: Intervals = (150.0, 210.0)
    rise: Annotated[float, positive("T_r", "s")] = 60.0

    def __post_init__(self) -> None:
        check_quantities(self)
        if not (self.speeds and self.runs and self.pauses):
            raise InvalidInput("StartsAndStops needs at least one speed, one run and one pause.")
        if min(*self.runs, *self.pauses) < self.rise:
            raise InvalidInput(
                f"StartsAndStops.rise is {self.rise:g} s, longer than a run or a pause of "
                f"{min(*self.runs, *self.pauses):g} s; make it shorter."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class SharpTransients:
    """The 1200 m tow: sharp transients and stretches of steady speed; speeds ordered at `times`, each in `rise`."""

    duration: Duration = 3600.0
    sample: Sample = 1.0
    times: Times = tuple(time for time, _ in _SHARP_ORDERS)
    speeds: Speeds = tuple(speed for _, speed in _SHARP_ORDERS)
    rise: Annotated[float, positive("T_r", "s")] = 20.0

    def __post_init__(self) -> None:
        check_quantities(self)
        check_same_length(self, "times", "speeds")
        check_increasing(self, "times")
        if len(self.times) > 1 and min(np.diff(self.times)) < self.rise:
            raise InvalidInput(
                f"SharpTransients.rise is {self.rise:g} s, longer than the shortest interval of "
                f"{min(np.diff(self.times)):g} s between two orders; make it shorter."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class FewSinusoids:
    """The 2500 m tow: a small transient at the start, then a few distinct frequencies and amplitudes.

    The transient is one pulse of velocity up to `transient_speed` over `transient_duration`. After it the
    ship makes `cycles` whole periods of each amplitude, to alternate sides, and the list starts again at its end.
    """

    duration: Duration = 3600.0
    sample: Sample = 1.0
    transient_speed: Annotated[float, Quantity("v", "m/s")] = 0.2
    transient_duration: Annotated[float, positive("T_0", "s")] = 240.0
    amplitudes: tuple[Annotated[float, non_negative("A", "m")], ...] = (25.0, 50.0, 25.0, 50.0)
    periods: Intervals = (360.0, 720.0, 480.0, 660.0)
    cycles: tuple[Annotated[int, Quantity("N", "1", lower=1)], ...] = (2, 1, 2, 1)

    def __post_init__(self) -> None:
        check_quantities(self)
        check_same_length(self, "amplitudes", "periods", "cycles")
        if not self.periods:
            raise InvalidInput("FewSinusoids needs at least one amplitude and period.")


def starts_and_stops(settings: StartsAndStops) -> Trace:
    """Starts and stops in one direction, T 6.2 (740 m)."""
    orders, levels, now = [], [], 0.0
    for speed, run, pause in zip(cycle(settings.speeds), cycle(settings.runs), cycle(settings.pauses), strict=False):
        if now >= settings.duration:
            break
        orders += [now, now + run]
        levels += [speed, 0.0]
        now += run + pause
    t = sample_times(settings.duration, settings.sample)
    return planar_motion(t, *eased(t, orders, levels, settings.rise))


def sharp_transients(settings: SharpTransients) -> Trace:
    """Sharp transients and steady stretches, T 6.2 (1200 m)."""
    t = sample_times(settings.duration, settings.sample)
    return planar_motion(t, *eased(t, settings.times, settings.speeds, settings.rise))


def few_sinusoids(settings: FewSinusoids) -> Trace:
    """A small transient, then a few sinusoids one after another, T 6.2 (2500 m)."""
    t = sample_times(settings.duration, settings.sample)
    x, v = _pulse(t, settings.transient_speed, settings.transient_duration)
    now, side = settings.transient_duration, 1.0
    for amplitude, period, count in cycle(zip(settings.amplitudes, settings.periods, settings.cycles, strict=True)):
        if now >= t[-1]:
            break
        omega = 2.0 * np.pi / period
        since = np.clip(t - now, 0.0, count * period)
        x += side * amplitude * (1.0 - np.cos(omega * since))
        v += side * amplitude * omega * np.sin(omega * since)
        now, side = now + count * period, -side
    return planar_motion(t, x, v)


def _pulse(t: Floats, speed: float, length: float) -> tuple[Floats, Floats]:
    """Position and velocity of one pulse ``v/2 (1 - cos 2 pi t/length)``."""
    within = np.minimum(t, length)
    turn = 2.0 * np.pi * within / length
    return 0.5 * speed * (within - length / (2.0 * np.pi) * np.sin(turn)), 0.5 * speed * (1.0 - np.cos(turn))
