"""The forcing functions of T 2.6.3 as motions of the ship, each integrated in closed form."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from data_synth.settings import check_increasing, check_same_length
from data_synth.ships.motion import planar_motion, sample_times
from models.quantity import InvalidInput, Quantity, check_quantities, non_negative, positive
from models.trace import Floats, Trace

Duration = Annotated[float, positive("T", "s")]
Sample = Annotated[float, positive("dt", "s")]
Amplitudes = tuple[Annotated[float, non_negative("A", "m")], ...]
Omegas = tuple[Annotated[float, positive("om", "rad/s")], ...]
Phases = tuple[Annotated[float, Quantity("theta", "rad")], ...]
Times = tuple[Annotated[float, non_negative("t", "s")], ...]
Speeds = tuple[Annotated[float, Quantity("v", "m/s")], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sinusoids:
    """Superimposed, phase-shifted sinusoids ``A sin(om t + theta)`` in surge and heave; no phases means zero."""

    duration: Duration = 3600.0
    sample: Sample = 1.0
    surge_amplitudes: Amplitudes = (25.0,)
    surge_omegas: Omegas = (0.015,)
    surge_phases: Phases = ()
    heave_amplitudes: Amplitudes = ()
    heave_omegas: Omegas = ()
    heave_phases: Phases = ()

    def __post_init__(self) -> None:
        check_quantities(self)
        for way in ("surge", "heave"):
            given = [f"{way}_amplitudes", f"{way}_omegas"]
            if getattr(self, f"{way}_phases"):
                given.append(f"{way}_phases")
            check_same_length(self, *given)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ramps:
    """Piecewise linear velocity through (`times`, `speeds`), constant before the first and after the last."""

    duration: Duration = 3600.0
    sample: Sample = 1.0
    times: Times = (0.0, 300.0, 900.0, 1200.0, 2100.0, 2400.0)
    speeds: Speeds = (0.0, 0.4, 0.4, -0.2, -0.2, 0.0)

    def __post_init__(self) -> None:
        check_quantities(self)
        check_same_length(self, "times", "speeds")
        check_increasing(self, "times")
        if not self.times:
            raise InvalidInput("Ramps needs at least one time and speed, but the lists are empty.")


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstOrder:
    """The velocity is ordered to `speeds` at `times` and follows each change through a first-order lag."""

    duration: Duration = 3600.0
    sample: Sample = 1.0
    times: Times = (0.0, 900.0, 1800.0)
    speeds: Speeds = (0.4, 0.1, 0.3)
    time_constants: tuple[Annotated[float, positive("T_1", "s")], ...] = (60.0, 60.0, 60.0)

    def __post_init__(self) -> None:
        check_quantities(self)
        check_same_length(self, "times", "speeds", "time_constants")
        check_increasing(self, "times")


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """At rest until `start`, then at `speed`."""

    duration: Duration = 3600.0
    sample: Sample = 1.0
    speed: Annotated[float, Quantity("v", "m/s")] = 0.5
    start: Annotated[float, non_negative("t_0", "s")] = 0.0

    def __post_init__(self) -> None:
        check_quantities(self)


def sinusoids(settings: Sinusoids) -> Trace:
    """The sum of sinusoids in surge and in heave, T 2.6.3 (1)."""
    t = sample_times(settings.duration, settings.sample)
    surge = _tones(t, settings.surge_amplitudes, settings.surge_omegas, settings.surge_phases)
    heave = _tones(t, settings.heave_amplitudes, settings.heave_omegas, settings.heave_phases)
    return planar_motion(t, *surge, *heave)


def ramps(settings: Ramps) -> Trace:
    """Ramped velocities, T 2.6.3 (3): positions are piecewise quadratic."""
    t = sample_times(settings.duration, settings.sample)
    times = np.array([min(0.0, settings.times[0] - 1.0), *settings.times])
    speeds = np.array([settings.speeds[0], *settings.speeds])
    slopes = np.append(np.diff(speeds) / np.diff(times), 0.0)
    reached = np.append(0.0, np.cumsum(0.5 * (speeds[1:] + speeds[:-1]) * np.diff(times)))
    part = np.searchsorted(times, t, side="right") - 1
    since = t - times[part]
    x = reached[part] + (speeds[part] + 0.5 * slopes[part] * since) * since
    return planar_motion(t, x - x[0], speeds[part] + slopes[part] * since)


def first_order(settings: FirstOrder) -> Trace:
    """First-order velocities, T 2.6.3 (4): each change ``dv (1 - exp(-s/T_1))``, s the time since its order."""
    t = sample_times(settings.duration, settings.sample)
    x, v = np.zeros_like(t), np.zeros_like(t)
    changes = np.diff(settings.speeds, prepend=0.0)
    for order, change, lag in zip(settings.times, changes, settings.time_constants, strict=True):
        since = np.maximum(t - order, 0.0)
        arrived = -np.expm1(-since / lag)
        v += change * arrived
        x += change * (since - lag * arrived)
    return planar_motion(t, x, v)


def step(settings: Step) -> Trace:
    """A step of velocity, T 4.1; at the step itself the velocity is the new one."""
    t = sample_times(settings.duration, settings.sample)
    since = t - settings.start
    moving = since >= 0.0
    x = np.where(moving, settings.speed * since, 0.0)
    return planar_motion(t, x, np.where(moving, settings.speed, 0.0))


def _tones(t: Floats, amplitudes: Amplitudes, omegas: Omegas, phases: Phases) -> tuple[Floats, Floats]:
    """Position and velocity of a sum of sinusoids."""
    x, v = np.zeros_like(t), np.zeros_like(t)
    for amplitude, omega, phase in zip(amplitudes, omegas, phases or (0.0,) * len(omegas), strict=True):
        x += amplitude * np.sin(omega * t + phase)
        v += amplitude * omega * np.cos(omega * t + phase)
    return x, v
