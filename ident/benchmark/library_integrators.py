"""SciPy's integrators on a reduced chain: the baselines that the chains' own steppers are measured against.

The chain of n nodes below the ship is written in the positions x and, with mass, the velocities v of its nodes:

    x_i' = v_i,   m_i v_i' = F_i - r_i v_i|v_i|,   F_i = k_i (x_{i-1} - x_i) - k_{i+1} (x_i - x_{i+1})
    massless: v_i = sign(F_i) sqrt(|F_i|/r_i)

with r_i v_i instead of r_i v_i|v_i| where the drag is linear. Right-hand side and derivatives are compiled.
"""

import time
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from scipy.integrate import solve_ivp

from models.chain import Chain, steady_shape
from models.drive import Drive
from models.kernels import kernel
from models.parameter import Drag
from models.quantity import InvalidInput, NumericalFailure
from models.trace import Floats

Method = Literal["RK45", "LSODA", "BDF", "Radau"]
METHODS: tuple[Method, ...] = get_args(Method)
#: Those that take the derivatives of the right-hand side.
IMPLICIT: tuple[Method, ...] = ("LSODA", "BDF", "Radau")
#: Evaluations between two looks at the clock, and the velocity below which the root's slope is held [m/s].
_LOOK, _SLOW = 256, 1e-4


class TookTooLong(NumericalFailure):
    """An integrator was stopped at its limit of time."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Problem:
    """A chain behind a ship's cubic spline, as a library integrator takes it.

    Parameters
    ----------
    values
        (3, n) stiffness, drag and mass of the nodes.
    quadratic
        Whether the drag is quadratic.
    ship
        (k, 4) coefficients of the ship's position in every sampling interval, the constant first.
    begin, interval
        First time and sampling interval [s].
    t, start
        Times of the output [s], and the state at the first of them.
    """

    values: Floats
    quadratic: bool
    ship: Floats
    begin: float
    interval: float
    t: Floats
    start: Floats


def problem(chain: Chain, drag: Drag, drive: Drive) -> Problem:
    """The problem of a chain behind a prepared ship.

    Raises
    ------
    InvalidInput
        The ship is not sampled evenly.
    """
    intervals, _ = drive.intervals
    if intervals.size > 1:
        raise InvalidInput(
            f"A library integrator needs an evenly sampled ship, but its intervals are {intervals.min():g} to "
            f"{intervals.max():g} s; sample the record anew."
        )
    n, speed = chain.k.size, drive.start_speed
    if drag == "quadratic":
        x, v = steady_shape(chain, speed)
    else:
        x, v = -np.cumsum(np.cumsum(chain.r[::-1])[::-1] * speed / chain.k), np.full(n, speed)
    return Problem(
        values=np.stack([np.asarray(each, dtype=float) for each in chain]),
        quadratic=drag == "quadratic",
        ship=np.column_stack([drive.u[:-1], drive.rates[:-1] / np.array([1.0, 2.0, 6.0])]),
        begin=float(drive.t[0]),
        interval=float(intervals[0]),
        t=drive.t,
        start=np.concatenate([x, v]) if chain.m.any() else x,
    )


def velocity(
    given: Problem, method: Method, tolerance: float, *, jacobian: bool = False, limit: float = 60.0
) -> Floats:
    """(n,) velocity of the vehicle [m/s] at the output times by `scipy.integrate.solve_ivp`.

    Parameters
    ----------
    tolerance
        Both the relative one and the absolute one [m and m/s].
    jacobian
        Hand over compiled derivatives, not leave them to differences.
    limit
        Longest CPU time [s].

    Raises
    ------
    TookTooLong
        The limit was reached.
    NumericalFailure
        The integrator gave up.
    """
    values, quadratic, ship, begin, interval = given.values, given.quadratic, given.ship, given.begin, given.interval
    calls, ends = 0, time.thread_time() + limit

    def rates(t: float, y: Floats) -> Floats:
        nonlocal calls
        calls += 1
        if calls % _LOOK == 0 and time.thread_time() > ends:
            raise TookTooLong(
                f"{method} at a tolerance of {tolerance:g} was stopped after {limit:g} s of CPU time, at t = {t:g} s; "
                "allow more time or a larger tolerance."
            )
        return _rates(t, y, values, quadratic, ship, begin, interval)

    def slopes(t: float, y: Floats) -> Floats:
        return _slopes(t, y, values, quadratic, ship, begin, interval)

    options: dict[str, Any] = {"jac": slopes} if jacobian and method in IMPLICIT else {}
    span = (float(given.t[0]), float(given.t[-1]))
    found = solve_ivp(rates, span, given.start, method, given.t, rtol=tolerance, atol=tolerance, **options)
    if not found.success:
        raise NumericalFailure(f"{method} at a tolerance of {tolerance:g} gave up: {found.message}")
    if given.start.size > values.shape[1]:
        return np.array(found.y[-1])
    return _last_rates(given.t, np.ascontiguousarray(found.y.T), values, quadratic, ship, begin, interval)


@kernel
def _rates(t: float, y: Floats, values: Floats, quadratic: bool, ship: Floats, begin: float, interval: float) -> Floats:
    """y' of a chain: of positions, or of positions and velocities."""
    n = values.shape[1]
    inertial = y.size > n
    rates = np.empty(y.size)
    i = min(max(int((t - begin) / interval), 0), ship.shape[0] - 1)
    s = t - begin - i * interval
    above = ship[i, 0] + s * (ship[i, 1] + s * (ship[i, 2] + s * ship[i, 3]))
    pull = values[0, 0] * (above - y[0])
    for j in range(n):
        hold = values[0, j + 1] * (y[j] - y[j + 1]) if j + 1 < n else 0.0
        F, r = pull - hold, values[1, j]
        pull = hold
        if inertial:
            v = y[n + j]
            rates[j] = v
            rates[n + j] = (F - r * (v * abs(v) if quadratic else v)) / values[2, j]
        elif quadratic:
            v = np.sqrt(abs(F) / r)
            rates[j] = v if F > 0.0 else -v
        else:
            rates[j] = F / r
    return rates


@kernel
def _last_rates(
    t: Floats, y: Floats, values: Floats, quadratic: bool, ship: Floats, begin: float, interval: float
) -> Floats:
    """(k,) velocity of the last node of a massless chain at states (k, n)."""
    found = np.empty(t.size)
    for i in range(t.size):
        found[i] = _rates(t[i], y[i], values, quadratic, ship, begin, interval)[-1]
    return found


@kernel
def _slopes(
    t: float, y: Floats, values: Floats, quadratic: bool, ship: Floats, begin: float, interval: float
) -> Floats:
    """Derivatives of `_rates` by the state; the root's slope is held below a velocity of 0.1 mm/s."""
    n = values.shape[1]
    inertial = y.size > n
    slopes = np.zeros((y.size, y.size))
    speeds = y[n:] if inertial else _rates(t, y, values, quadratic, ship, begin, interval)
    for j in range(n):
        below = values[0, j + 1] if j + 1 < n else 0.0
        r, at = values[1, j], j
        if inertial:
            slopes[j, n + j] = 1.0
            slopes[n + j, n + j] = -r * (2.0 * abs(speeds[j]) if quadratic else 1.0) / values[2, j]
            scale, at = 1.0 / values[2, j], n + j
        else:
            scale = 1.0 / (r * (2.0 * max(abs(speeds[j]), _SLOW) if quadratic else 1.0))
        slopes[at, j] = -scale * (values[0, j] + below)
        if j > 0:
            slopes[at, j - 1] = scale * values[0, j]
        if j + 1 < n:
            slopes[at, j + 1] = scale * below
    return slopes
