"""The delayed one-link models, T (6.1)-(6.2) and (6.5)-(6.6).

    second order: x'' = -a (x - x_ship(t - tau)) - b x'        or  - b x'|x'|
    first order:  x'  = -(a/b) (x - x_ship(t - tau))           or  x'|x'| = ...

They are chains of one link, of mass 1, stiffness a, drag b, and massless, of stiffness a/b, drag 1. They do not
depend on time, so the delay shifts the undelayed response: y(t) = y_0(t - tau).
"""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from models.chain import Chain, Motion
from models.drive import Drive
from models.parameter import Drag, Free, check_free

Floats = NDArray[np.float64]

#: Velocity [m/s] below which an interval counts as rest, where a root of the drag would only raise rounding.
CALM = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class SecondOrder:
    """Delayed second order; with `delay_fixed` the delay is not a parameter."""

    drag: Drag
    spring: Annotated[float, Free("a", "1/s2", "1/s2", 1e-8, 1e4)]
    damping: Annotated[float, Free("b", "1/m", "1/s", 1e-8, 1e6)]
    delay: Annotated[float, Free("tau", "s", "s", 1e-2, 600.0, zero=True)]
    delay_fixed: bool = False

    def __post_init__(self) -> None:
        check_free(self)

    @property
    def held(self) -> tuple[str, ...]:
        """Parameters that are not free."""
        return ("delay",) if self.delay_fixed else ()

    def chain(self) -> Chain:
        """Node values for the solvers."""
        return Chain(np.array([self.spring]), np.array([self.damping]), np.ones(1))


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstOrder:
    """Delayed first order; `spring` is a/b, the inverse of the b/k of T section 6.7.

    With `delay_fixed` the delay is not a parameter.
    """

    drag: Drag
    spring: Annotated[float, Free("a/b", "m/s2", "1/s", 1e-8, 1e4)]
    delay: Annotated[float, Free("tau", "s", "s", 1e-2, 600.0, zero=True)]
    delay_fixed: bool = False

    def __post_init__(self) -> None:
        check_free(self)

    @property
    def held(self) -> tuple[str, ...]:
        """Parameters that are not free."""
        return ("delay",) if self.delay_fixed else ()

    def chain(self) -> Chain:
        """Node values for the solvers."""
        return Chain(np.array([self.spring]), np.ones(1), np.zeros(1))


def shifted(motion: Motion, chain: Chain, drag: Drag, drive: Drive, delay: float) -> Motion:
    """The motion of a one-link chain `delay` [s] later, smooth in the delay.

    Cubic Hermite in the position; in the velocity with mass, whose rate is the acceleration; without mass in
    the drag force over r, whose rate is that of the spring: there the velocity itself has infinite slope in
    reversal. At rest the root of that force would only magnify rounding, so an interval with both ends below
    `CALM` is linear in the velocity. Before the record stands the start assumption: rest, or the straight steady
    tow.
    """
    if delay == 0.0:
        return motion
    x, v = motion
    k, r, m = (float(values[0]) for values in chain)
    quadratic = drag == "quadratic"
    carried = v * np.abs(v) if quadratic else v
    if m > 0.0:
        flow, rate = v, (k * (drive.u - x) - r * carried) / m
    else:
        flow, rate = carried, (k / r) * (drive.rates[:, 0] - v)
    when = drive.t - delay
    before = when < drive.t[0]
    i = np.clip(np.searchsorted(drive.t, when, side="right") - 1, 0, drive.t.size - 2)
    x_then = _hermite(drive.t, x, v, i, when)
    flow_then = _hermite(drive.t, flow, rate, i, when)
    v_then = flow_then
    if quadratic and m == 0.0:
        root = np.sign(flow_then) * np.sqrt(np.abs(flow_then))
        calm = np.maximum(np.abs(v[i]), np.abs(v[i + 1])) < CALM
        v_then = np.where(calm, np.interp(when, drive.t, v), root)
    x_then[before] = x[0] + drive.start_speed * (when[before] - drive.t[0])
    v_then[before] = drive.start_speed
    return Motion(x_then, v_then)


def _hermite(t: Floats, y: Floats, rate: Floats, i: NDArray[np.intp], when: Floats) -> Floats:
    """Cubic Hermite in the intervals i at the times `when`."""
    h = t[i + 1] - t[i]
    s = (when - t[i]) / h
    rise = y[i + 1] - y[i]
    first, second = h * rate[i] - rise, rise - h * rate[i + 1]
    return np.asarray(y[i] + s * (rise + (1.0 - s) * (first * (1.0 - s) + second * s)))
