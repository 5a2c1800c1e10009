"""The equations of the spectral simulator for library integrators: the same compiled forces, in a state of their own.

The state is (u, s), u the body's place and the sines' amplitudes [m] and s = M^-1 pi [m/s], the momentum over the
mass of rest: s' = M^-1 F(u, w, t), u' = w = s - M^-1 pi_0(u, t), pi_0 being the momentum that the ship's motion alone
gives. It needs no acceleration of the ship, and all of it is of the size of a velocity or a place, so that one
tolerance serves. M is constant for a point body.
"""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ident.timing import Timing
from models.kernels import kernel
from models.quantity import InvalidInput
from models.spectral.basis import Fields, prepare
from models.spectral.system import evaluate, factor, ship_at, stage_matrix, substitute
from models.spectral.workspace import CABLE_ROWS, END_ROWS, SUM_ROWS, WORK_ROWS
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Vehicle

Floats = NDArray[np.float64]

METHODS = ("RK45", "LSODA", "BDF", "Radau")
#: Those that can use a Jacobian.
IMPLICIT = ("LSODA", "BDF", "Radau")
#: Tolerances tried: the first, the loosest and the tightest; share by which one that misses the error is tightened.
_FIRST, _LOOSEST, _TIGHTEST, _TIGHTER = 1e-4, 1e-1, 1e-11, 0.7
#: CPU time after which a run of the library is given up [s].
PATIENCE = 4.0
#: Step of the differences in the Jacobian, over the size of a coordinate or 1.
_DIFFERENCE = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True)
class LibraryRun:
    """One integrator with one tolerance: RMS error of the vehicle's velocity [m/s], and CPU time a simulated second."""

    method: str
    jacobian: bool
    tolerance: float
    error: float
    evaluations: int
    timing: Timing


class Equations:
    """The right-hand side of one tow under one ship, its Jacobian by differences, and the velocity of the vehicle."""

    def __init__(self, tow: Tow, ship: Trace, harmonics: int) -> None:
        if not isinstance(tow.vehicle, Vehicle):
            raise InvalidInput("The library integrators run a point body, but the tow has a towfish.")
        self.t, self._speed = ship.t, tow.speed
        self._f = prepare(tow, harmonics=harmonics)
        knots = np.ascontiguousarray(ship.spline.x)
        # The ship's splines in the steadily towed frame, from its first position.
        c = np.array(ship.spline.c[:, :, [0, 2]], order="C")
        c = np.concatenate([np.zeros((4 - c.shape[0], *c.shape[1:])), c])
        c[3] -= ship.position[0, [0, 2]]
        c[3, :, 0] -= tow.speed * (knots[:-1] - knots[0])
        c[2, :, 0] -= tow.speed
        n = 2 + harmonics
        self._ship, self._place = (knots, c), np.zeros(1, dtype=np.int64)
        self._mass, self._pivot = _mass(self._f, n)
        self._work = (
            np.zeros((4, n)),
            np.zeros((CABLE_ROWS, n)),
            np.zeros((WORK_ROWS, self._f.station.shape[1])),
            np.zeros(END_ROWS),
        )
        self.size = 2 * n
        self._until = math.inf

    def __call__(self, t: float, y: Floats) -> Floats:
        """dy/dt."""
        if time.thread_time() > self._until:
            raise TimeoutError
        slope = np.empty(self.size)
        slopes(self._f, self._mass, self._pivot, *self._ship, self._place, *self._work, t, y, slope)
        return slope

    def jacobian(self, t: float, y: Floats) -> Floats:
        """d(dy/dt)/dy by forward differences, compiled."""
        J = np.empty((self.size, self.size))
        jacobian(self._f, self._mass, self._pivot, *self._ship, self._place, *self._work, t, y, J)
        return J

    def velocity(self, y: Floats) -> Floats:
        """(n, 2) [m/s] of the vehicle, surge and heave, from the states (2 (2 + N), n) at the ship's times."""
        found = np.array([self(float(t), np.ascontiguousarray(each))[:2] for t, each in zip(self.t, y.T, strict=True)])
        found[:, 0] += self._speed
        return found

    def solve(self, method: str, tolerance: float, jacobian: bool) -> tuple[Floats, int, float]:
        """The vehicle's velocity, evaluations and CPU time [s] of a run from rest; NaN where it fails."""
        options = {"jac": self.jacobian} if jacobian else {}
        self._place[0] = 0
        began = time.thread_time()
        self._until = began + PATIENCE
        try:
            run = solve_ivp(
                self,
                (float(self.t[0]), float(self.t[-1])),
                np.zeros(self.size),
                method=method,
                t_eval=self.t,
                rtol=tolerance,
                atol=tolerance,
                **options,
            )
        except TimeoutError:
            return np.full((self.t.size, 2), np.nan), 0, time.thread_time() - began
        finally:
            self._until = math.inf
        taken = time.thread_time() - began
        if not run.success:
            return np.full((self.t.size, 2), np.nan), int(run.nfev), taken
        return self.velocity(run.y), int(run.nfev), taken


def at_error(equations: Equations, method: str, exact: Floats, error: float) -> list[LibraryRun]:
    """Every run, timed once, on the way to the loosest tolerance whose error is as asked for: the last is that one.

    Parameters
    ----------
    exact
        (n, 2) the vehicle's velocity, surge and heave [m/s].
    error
        RMS [m/s]; the last run errs by less, but for the case that no tolerance is tight enough.
    """
    tried: list[LibraryRun] = []

    def run(tolerance: float, jacobian: bool) -> LibraryRun:
        velocity, evaluations, taken = equations.solve(method, tolerance, jacobian)
        duration = float(equations.t[-1] - equations.t[0])
        missed = float(np.sqrt(np.mean(np.sum((velocity - exact) ** 2, axis=1))))
        tried.append(
            LibraryRun(
                method=method,
                jacobian=jacobian,
                tolerance=tolerance,
                error=missed if math.isfinite(missed) else math.inf,
                evaluations=evaluations,
                timing=Timing(taken / duration, 0.0, 1),
            )
        )
        return tried[-1]

    given = method in IMPLICIT
    found = _loosest(lambda tolerance: run(tolerance, given), error)
    if given:
        other = run(found.tolerance, False)
        if other.error <= error and other.timing.seconds < found.timing.seconds:
            found = other
    tried.remove(found)
    return [*tried, found]


def _loosest(run: Callable[[float], LibraryRun], error: float) -> LibraryRun:
    """The run of the loosest tolerance that meets an error: decades, then between the last two by their power law."""
    tolerance = _FIRST
    now = run(tolerance)
    factor = 10.0 if now.error <= error else 0.1
    while _TIGHTEST < tolerance < _LOOSEST:
        before, tolerance = now, tolerance * factor
        now = run(tolerance)
        if (now.error <= error) != (before.error <= error):
            break
    else:
        return now
    met, missed = (now, before) if now.error <= error else (before, now)
    if not math.isfinite(missed.error):
        return met
    power = math.log(missed.error / met.error) / math.log(missed.tolerance / met.tolerance)
    tolerance = met.tolerance * (error / met.error) ** (1.0 / power) if power > 0.0 else met.tolerance
    while tolerance > met.tolerance / _TIGHTER:
        now = run(tolerance)
        if now.error <= error:
            return now
        tolerance *= _TIGHTER
    return met


def _mass(f: Fields, n: int) -> tuple[Floats, NDArray[np.int64]]:
    """Factors of M = d(pi)/dw and their row exchanges."""
    A, Y, pivot = np.zeros((n, n)), np.zeros((n + SUM_ROWS, 2 * n)), np.zeros(n, dtype=np.int64)
    u, w, end, cable = np.zeros(n), np.zeros(n), np.zeros(END_ROWS), np.zeros((CABLE_ROWS, n))
    station = np.zeros((WORK_ROWS, f.station.shape[1]))
    evaluate(f, u, w, end, np.zeros(n), np.zeros(n), cable, station)
    stage_matrix(f, u, w, end, 0.0, cable, station, A, Y)
    factor(A, pivot)
    return A, pivot


@kernel
def slopes(
    f: Fields,
    mass: Floats,
    pivot: NDArray[np.int64],
    knots: Floats,
    ship: Floats,
    place: NDArray[np.int64],
    work: Floats,
    cable: Floats,
    station: Floats,
    end: Floats,
    t: float,
    y: Floats,
    slope: Floats,
) -> None:
    """Fill `slope` with dy/dt; `work` (4, 2 + N), `cable`, `station` and `end` are workspaces."""
    n = y.size // 2
    u, w, pi, F = work[0], work[1], work[2], work[3]
    place[0] = ship_at(f, t, knots, ship, place[0], end)
    for i in range(n):
        u[i], w[i] = y[i], 0.0
    evaluate(f, u, w, end, pi, F, cable, station)
    substitute(mass, pivot, pi)
    for i in range(n):
        w[i] = y[n + i] - pi[i]
        slope[i] = w[i]
    evaluate(f, u, w, end, pi, F, cable, station)
    substitute(mass, pivot, F)
    for i in range(n):
        slope[n + i] = F[i]


@kernel
def jacobian(
    f: Fields,
    mass: Floats,
    pivot: NDArray[np.int64],
    knots: Floats,
    ship: Floats,
    place: NDArray[np.int64],
    work: Floats,
    cable: Floats,
    station: Floats,
    end: Floats,
    t: float,
    y: Floats,
    J: Floats,
) -> None:
    """Fill `J` with the derivative of `slopes`, a column at a time."""
    moved, slope, base = y.copy(), np.empty(y.size), np.empty(y.size)
    slopes(f, mass, pivot, knots, ship, place, work, cable, station, end, t, y, base)
    for k in range(y.size):
        d = _DIFFERENCE * max(1.0, abs(y[k]))
        moved[k] = y[k] + d
        slopes(f, mass, pivot, knots, ship, place, work, cable, station, end, t, moved, slope)
        for i in range(y.size):
            J[i, k] = (slope[i] - base[i]) / d
        moved[k] = y[k]
