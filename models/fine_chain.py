"""A fine inertial chain: an independent lateral model that fitted models are verified against.

Nodes hang under static tension and carry mass, added mass and quadratic drag; the ship moves the top one:

    M_i x_i'' = k_i (x_{i-1} - x_i) - k_{i+1} (x_i - x_{i+1}) - R_i (x_i' - u_i)|x_i' - u_i|,   k_i = T_i/ds,

links numbered from the ship, T_i the static tension at the middle of link i, ds each of cable at the inner
nodes and half a link with the vehicle. Stepped by Newmark's average acceleration with the displacement increment
as unknown and a tridiagonal Newton corrector: neither the equations' unknowns nor the stepper are those of the
reduced link models. Small angles: the offset in a current or a tow is that of the linear string.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.quantity import InvalidInput, NumericalFailure
from models.statics import flow_at, static_shape
from models.tow import Tow
from models.trace import Trace

Floats = NDArray[np.float64]

#: Fewest links that count as fine.
FEWEST_LINKS = 60
_NEWTON_ITERATIONS = 30
_NEWTON_TOLERANCE = 1e-11


@dataclass(frozen=True, kw_only=True, eq=False)
class FineChainResult:
    """`vehicle` at the ship's own times, x only; `error` [m/s] RMS velocity against half the links and steps."""

    vehicle: Trace
    links: int
    step: float
    error: float


def simulate(tow: Tow, ship: Trace, *, links: int = FEWEST_LINKS, step: float = 0.25) -> FineChainResult:
    """Simulate the lateral motion along x under the ship's motion, from the steady shape in the current.

    Parameters
    ----------
    links
        Number of links, at least 60.
    step
        Longest step [s]; steps end on the ship's samples.

    Raises
    ------
    InvalidInput
        Too few links, or a step that is not above zero.
    NumericalFailure
        The corrector does not settle; says time, node and residual.
    """
    if links < FEWEST_LINKS:
        raise InvalidInput(f"The fine chain needs at least {FEWEST_LINKS} links, but {links} were given.")
    if not (step > 0.0 and math.isfinite(step)):
        raise InvalidInput(f"The fine chain needs a step above 0 s, but {step:g} s was given.")
    coarse = _run(tow, ship, links // 2, 2.0 * step)
    fine = _run(tow, ship, links, step)
    # Both the links and the steps converge at second order: a third of the difference is left.
    error = float(np.sqrt(np.mean((fine[:, 1] - coarse[:, 1]) ** 2))) / 3.0
    position, velocity = np.zeros((len(ship), 3)), np.zeros((len(ship), 3))
    position[:, 0], velocity[:, 0] = fine[:, 0] + ship.position[0, 0], fine[:, 1]
    position[:, 1] = ship.position[:, 1]
    position[:, 2] = ship.position[0, 2] - static_shape(tow).depth
    return FineChainResult(
        vehicle=Trace(t=ship.t, position=position, velocity=velocity), links=links, step=step, error=error
    )


def _run(tow: Tow, ship: Trace, links: int, step: float) -> Floats:
    """(n, 2) position from the ship's first place and velocity of the vehicle at the ship's times."""
    cable = tow.cable
    ds = cable.length / links
    shape = static_shape(tow)
    # Link 1 at the ship: its middle lies L - ds/2 from the vehicle.
    middle = cable.length - ds * (np.arange(links) + 0.5)
    spring = shape.tension_at(middle) / ds
    mass = np.full(links, (cable.mass + cable.added_mass) * ds)
    drag = np.full(links, cable.normal_drag(tow.water_density) * ds)
    mass[-1] = tow.vehicle.mass + tow.vehicle.added_mass + 0.5 * (cable.mass + cable.added_mass) * ds
    drag[-1] = tow.vehicle.drag(tow.water_density) + 0.5 * cable.normal_drag(tow.water_density) * ds
    node_z = -ds * np.arange(1, links + 1)
    water = flow_at(tow, node_z) + tow.speed
    # Steps end on the samples; the ship's place is the trace's own spline at every step.
    counts = np.maximum(1, np.ceil(np.diff(ship.t) / step - 1e-9)).astype(np.int64)
    fractions = [ship.t[i] + (ship.t[i + 1] - ship.t[i]) * np.arange(1, c + 1) / c for i, c in enumerate(counts)]
    times = np.concatenate([ship.t[:1], *fractions])
    origin = ship.position[0, 0]
    place = ship.spline(times)[:, 0] - origin
    # At the start the chain moves steadily with the tow: its offset balances the drag of the flow past it.
    slip = tow.speed - water
    load = np.cumsum((drag * slip * np.abs(slip))[::-1])[::-1]
    x = -np.cumsum(load / spring)
    v = np.full(links, tow.speed)
    out = np.zeros((len(ship), 2))
    where = np.zeros(3)
    if not _march(times, place, counts, spring, mass, drag, water, x, v, out, where):
        raise NumericalFailure(
            f"The fine chain's corrector does not settle at t = {where[0]:.2f} s, node {int(where[1])} of {links} "
            f"(residual {where[2]:.3g} N); use a smaller step."
        )
    return out


@kernel
def _march(
    times: Floats,
    place: Floats,
    counts: NDArray[np.int64],
    k: Floats,
    M: Floats,
    R: Floats,
    water: Floats,
    x: Floats,
    v: Floats,
    out: Floats,
    where: Floats,
) -> bool:
    """Newmark's average acceleration over the given times; x and v (n,) start state, changed in place."""
    n = k.size
    a, lower, diagonal, upper, r, move = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    for i in range(n):
        below = k[i + 1] * (x[i] - x[i + 1]) if i < n - 1 else 0.0
        above = place[0] if i == 0 else x[i - 1]
        slip = v[i] - water[i]
        a[i] = (k[i] * (above - x[i]) - below - R[i] * slip * abs(slip)) / M[i]
    out[0, 0], out[0, 1] = x[n - 1], v[n - 1]
    row, left = 1, counts[0]
    for step in range(1, times.size):
        h = times[step] - times[step - 1]
        for i in range(n):
            move[i] = h * v[i] + 0.5 * h * h * a[i]
        settled = False
        for _ in range(_NEWTON_ITERATIONS):
            worst = 0.0
            for i in range(n):
                # Average acceleration: v1 = 2 move/h - v, a1 = 4 (move - h v)/h^2 - a.
                v1 = 2.0 * move[i] / h - v[i]
                a1 = 4.0 * (move[i] - h * v[i]) / (h * h) - a[i]
                slip = v1 - water[i]
                above = place[step] if i == 0 else x[i - 1] + move[i - 1]
                here = x[i] + move[i]
                below = k[i + 1] * (here - x[i + 1] - move[i + 1]) if i < n - 1 else 0.0
                r[i] = k[i] * (above - here) - below - R[i] * slip * abs(slip) - M[i] * a1
                diagonal[i] = 4.0 * M[i] / (h * h) + 4.0 * R[i] * abs(slip) / h + k[i]
                lower[i] = -k[i]
                if i < n - 1:
                    diagonal[i] += k[i + 1]
                    upper[i] = -k[i + 1]
                if abs(r[i]) > worst:
                    worst = abs(r[i])
                    where[1] = i + 1
            for i in range(1, n):
                m = lower[i] / diagonal[i - 1]
                diagonal[i] -= m * upper[i - 1]
                r[i] -= m * r[i - 1]
            size = 0.0
            for i in range(n - 1, -1, -1):
                if i < n - 1:
                    r[i] -= upper[i] * r[i + 1]
                r[i] /= diagonal[i]
                move[i] += r[i]
                size = max(size, abs(r[i]))
            where[0], where[2] = times[step], worst
            if size <= _NEWTON_TOLERANCE:
                settled = True
                break
            if not size < 1e12:
                return False
        if not settled:
            return False
        for i in range(n):
            v1 = 2.0 * move[i] / h - v[i]
            a[i] = 4.0 * (move[i] - h * v[i]) / (h * h) - a[i]
            v[i] = v1
            x[i] += move[i]
        left -= 1
        if left == 0:
            out[row, 0], out[row, 1] = x[n - 1], v[n - 1]
            left = counts[row] if row < counts.size else 0
            row += 1
    return True
