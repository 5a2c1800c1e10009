"""Manoeuvres of a ship under way: steady tow, turns, changes of speed and zig-zag, on the map at z = 0.

The ship begins along +X from the origin. It turns at one speed; the curvature of an arc comes and goes over the time
`ease`, so that a turn by ``psi`` at radius R takes ``R psi/v + ease`` and its arc is R exactly.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from data_synth.settings import check_increasing
from data_synth.ships.forcing import Duration, Sample, Speeds, Times
from data_synth.ships.motion import eased, sample_times
from data_synth.ships.path import level, sail, straight, turn
from models.quantity import InvalidInput, Quantity, check_quantities, non_negative, positive
from models.trace import Trace

#: One international knot [m/s].
KNOT = 1852.0 / 3600.0

Speed = Annotated[float, positive("V", "m/s")]
Radius = Annotated[float, positive("R", "m")]
Ease = Annotated[float, positive("T_e", "s")]
Stretch = Annotated[float, non_negative("T", "s")]
Side = Literal["left", "right"]


@dataclass(frozen=True, slots=True, kw_only=True)
class StraightTow:
    """Straight along +X at one speed from the first instant."""

    duration: Duration = 3600.0
    sample: Sample = 1.0
    speed: Speed = 6.0 * KNOT

    def __post_init__(self) -> None:
        check_quantities(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class FullTurn:
    """Circles: straight for the time `approach`, `turns` times round at `radius`, straight for the time `exit`."""

    sample: Sample = 1.0
    speed: Speed = 6.0 * KNOT
    radius: Radius = 250.0
    turns: Annotated[float, positive("N", "1")] = 4.0
    approach: Stretch = 600.0
    exit: Stretch = 600.0
    ease: Ease = 10.0
    side: Side = "left"

    def __post_init__(self) -> None:
        check_quantities(self)
        _check_ease(self, 2.0 * math.pi * self.turns)


@dataclass(frozen=True, slots=True, kw_only=True)
class UTurn:
    """Half a circle and back: straight for the time `approach`, 180 degrees at `radius`, straight for `exit`."""

    sample: Sample = 1.0
    speed: Speed = 6.0 * KNOT
    radius: Radius = 250.0
    approach: Stretch = 600.0
    exit: Stretch = 1800.0
    ease: Ease = 10.0
    side: Side = "left"

    def __post_init__(self) -> None:
        check_quantities(self)
        _check_ease(self, math.pi)


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedChanges:
    """Straight along `heading` at the first of `speeds`; at each of `times` a change to the next within `rise`."""

    duration: Duration = 3600.0
    sample: Sample = 1.0
    times: Times = (600.0, 2100.0)
    speeds: Speeds = (6.0 * KNOT, 4.0 * KNOT, 6.0 * KNOT)
    rise: Annotated[float, positive("T_r", "s")] = 60.0
    heading: Annotated[float, Quantity("psi", "rad")] = 0.0

    def __post_init__(self) -> None:
        check_quantities(self)
        check_increasing(self, "times")
        if len(self.speeds) != len(self.times) + 1:
            raise InvalidInput(
                f"SpeedChanges needs the first speed and one for each time, but has {len(self.speeds)} speeds "
                f"for {len(self.times)} times."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class ZigZag:
    """Legs at headings of plus and minus half of `heading_change` in turn, each straight for the time `leg`.

    One more leg along +X comes before them, and one after.
    """

    sample: Sample = 1.0
    speed: Speed = 6.0 * KNOT
    heading_change: Annotated[float, Quantity("psi", "rad", 0.0, math.pi, True, True)] = math.radians(60.0)
    leg: Annotated[float, positive("T", "s")] = 300.0
    radius: Radius = 250.0
    legs: Annotated[int, Quantity("N", "1", lower=1)] = 6
    ease: Ease = 10.0

    def __post_init__(self) -> None:
        check_quantities(self)
        _check_ease(self, 0.5 * self.heading_change)


def straight_tow(settings: StraightTow) -> Trace:
    """The steady tow."""
    return sail(straight(settings.speed * settings.duration), settings.speed, settings.sample)


def full_turn(settings: FullTurn) -> Trace:
    """Straight, circles, straight; the heading changes by ``2 pi turns`` in all."""
    return _turned(settings, 2.0 * math.pi * settings.turns)


def u_turn(settings: UTurn) -> Trace:
    """Straight, half a circle, straight back."""
    return _turned(settings, math.pi)


def speed_changes(settings: SpeedChanges) -> Trace:
    """Changes of speed on a straight course, each along half a cosine."""
    t = sample_times(settings.duration, settings.sample)
    x, v = eased(t, settings.times, settings.speeds[1:], settings.rise, settings.speeds[0])
    course = np.array([math.cos(settings.heading), math.sin(settings.heading)])
    return level(t, x[:, None] * course, v[:, None] * course)


def zig_zag(settings: ZigZag) -> Trace:
    """Legs to both sides of +X in turn, from and back to it."""
    leg, ease = settings.speed * settings.leg, settings.speed * settings.ease
    headings = [0.0, *(0.5 * settings.heading_change * (-1.0) ** k for k in range(settings.legs)), 0.0]
    pieces = straight(leg)
    for change in np.diff(headings):
        pieces += [*turn(float(change), settings.radius, ease), *straight(leg)]
    return sail(pieces, settings.speed, settings.sample)


def _turned(settings: FullTurn | UTurn, angle: float) -> Trace:
    v = settings.speed
    signed = angle if settings.side == "left" else -angle
    pieces = [
        *straight(v * settings.approach),
        *turn(signed, settings.radius, v * settings.ease),
        *straight(v * settings.exit),
    ]
    return sail(pieces, v, settings.sample)


def _check_ease(settings: FullTurn | UTurn | ZigZag, angle: float) -> None:
    """Raise `InvalidInput` where the smallest turn is over before it has its radius."""
    longest = settings.radius * angle / settings.speed
    if settings.ease > longest:
        raise InvalidInput(
            f"{type(settings).__name__}.ease must be at most {longest:g} s for a turn of {angle:.3g} rad at "
            f"{settings.radius:g} m and {settings.speed:g} m/s, but it is {settings.ease:g} s; make it shorter."
        )
