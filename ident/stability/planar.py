"""What the cases of the spectral simulator and of the reduced models share: the tow, its ships, and how they are read.

The tow is mangus-740, changed where a case says so: 740 m of cable of 7.78 N/m in water under a sled of 6000 N.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from ident.configuration import load
from models.spectral import SpectralResult
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Vehicle

Floats = NDArray[np.float64]

TEN_KNOTS = 10.0 * 1852.0 / 3600.0
#: Time constant of a gentle change of speed [s].
GENTLE = 150.0


def mangus(*, name: str = "mangus-740", vehicle: dict[str, float] | None = None, **cable: Any) -> Tow:
    """The tow with other values of its cable and of its vehicle."""
    tow = load(name).tow
    assert isinstance(tow.vehicle, Vehicle)
    return replace(tow, cable=replace(tow.cable, **cable), vehicle=replace(tow.vehicle, **(vehicle or {})))


def heavier_drag(factor: float, **cable: Any) -> Tow:
    """The tow with all its drag times `factor`."""
    tow = mangus()
    assert isinstance(tow.vehicle, Vehicle)
    return mangus(
        vehicle={"drag_coefficient": factor * tow.vehicle.drag_coefficient},
        normal_drag_coefficient=factor * tow.cable.normal_drag_coefficient,
        tangential_drag_coefficient=factor * tow.cable.tangential_drag_coefficient,
        **cable,
    )


def gentle(t: Floats, speed: float, change: float, *, origin: float = 0.0) -> Trace:
    """From `speed` to `speed` + `change` [m/s], at the rate of `GENTLE`."""
    return Trace.along_x(t, origin + speed * t + change * (t + GENTLE * np.expm1(-t / GENTLE)))


def at_once(t: Floats, speed: float, *, origin: float = 0.0) -> Trace:
    """At `speed` [m/s] from the first sample on."""
    return Trace.along_x(t, origin + speed * t)


def lag(ship: Trace, vehicle: Trace) -> float:
    """How far the vehicle is behind the ship at the end [m]."""
    return float(ship.position[-1, 0] - vehicle.position[-1, 0])


def hanging(result: SpectralResult) -> float:
    """The vehicle's depth at the end [m]."""
    return float(result.ship.position[-1, 2] - result.vehicle.position[-1, 2])


def transfer(t: Floats, ship: Floats, vehicle: Floats, omega: float) -> complex:
    """The vehicle's motion over the ship's at omega [rad/s], over the second half of the record."""
    late = t >= 0.5 * (t[0] + t[-1])
    basis = np.column_stack([np.ones(late.sum()), np.cos(omega * t[late]), np.sin(omega * t[late])])
    both = np.linalg.lstsq(basis, np.column_stack([ship[late], vehicle[late]]), rcond=None)[0]
    amplitude = both[1] - 1j * both[2]
    return complex(amplitude[1] / amplitude[0])


def frequency(t: Floats, signal: Floats, low: float, high: float) -> float:
    """The frequency of the strongest line between `low` and `high` [rad/s], under a Hann window."""
    window = (signal - signal.mean()) * np.hanning(t.size)

    def power(omega: float) -> float:
        return -float(abs(np.sum(window * np.exp(-1j * omega * t))))

    width = math.pi / float(t[-1] - t[0])
    grid = np.arange(low, high, width)
    best = float(grid[int(np.argmin([power(omega) for omega in grid]))])
    found = minimize_scalar(power, bounds=(best - width, best + width), method="bounded", options={"xatol": 1e-9})
    return float(found.x)


def rms(values: Floats) -> float:
    """Root of the mean square."""
    return math.sqrt(float(np.mean(values**2)))
