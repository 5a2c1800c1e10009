"""A chain of lumped nodes below the ship: the one stepper of every quadratic reduced model.

Node i = 1..n counts from the ship, the vehicle is node n, node 0 is the ship:

    m_i v_i' = k_i (x_{i-1} - x_i) - k_{i+1} (x_i - x_{i+1}) - r_i v_i|v_i|,   x_i' = v_i

T (6.2), (6.4)-(6.7) in positions instead of spring forces; m = 0 is the massless chain.

| symbol | meaning | unit |
| --- | --- | --- |
| k, r, m | stiffness of the link above the node, quadratic drag, mass | N/m, N s2/m2, kg |
| u | ship position in the local origin | m |
| h, g | step, and gamma h | s |
| xh, vh | what a stage starts from | m, m/s |

The stepper is Alexander's SDIRK2 with the velocity as unknown: a stage solves

    (m/g) (v - vh) = F(xh + g v) - r v|v|,

the gradient of a strictly convex function of v, with a tridiagonal positive definite derivative. Nothing is
divided by v, so a chain at rest or in reversal is no special case. Newton's method leaves a residual of at most
r dv^2, which gives a strict stopping rule: the error is below the largest r dv^2 / (m/g + 2 r|v|).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.drive import GAMMA, Drive
from models.kernels import kernel
from models.quantity import NumericalFailure

Floats = NDArray[np.float64]

#: Bound of the error that Newton's method leaves in a stage velocity [m/s].
TOLERANCE = 1e-9

#: Newton iterations of one stage before the step counts as failed.
BUDGET = 80


class Chain(NamedTuple):
    """Stiffness k [N/m], drag r [N s2/m2, or N s/m in a linear model] and mass m [kg], each (n,), ship first."""

    k: Floats
    r: Floats
    m: Floats


class Motion(NamedTuple):
    """Position x from the local origin (n,) [m] and velocity v (n,) [m/s] of the vehicle at the ship's times."""

    x: Floats
    v: Floats


def quadratic_motion(chain: Chain, drive: Drive) -> Motion:
    """The vehicle of a chain with quadratic drag.

    Raises
    ------
    NumericalFailure
        A stage is not solved within the iteration budget, or leaves the finite range.
    """
    x_out, v_out = np.empty(drive.t.size), np.empty(drive.t.size)
    x, v = steady_shape(chain, drive.start_speed)
    # Mass makes the links swing: half the step keeps lightly damped swings as exact as a massless chain.
    grid = drive.fine if chain.m.any() else drive.coarse
    k, r, m = (np.array(values) for values in chain)
    interval, node, residual = _march(k, r, m, x, v, *grid, TOLERANCE, BUDGET, x_out, v_out)
    if interval >= 0:
        raise NumericalFailure(
            f"The chain of {chain.k.size} links found no velocity after t = {drive.t[interval]:g} s: node {node} "
            f"keeps a change of {residual:g} m/s after {BUDGET} Newton iterations; its parameters are too extreme."
        )
    return Motion(x_out, v_out)


def steady_shape(chain: Chain, speed: float) -> tuple[Floats, Floats]:
    """Node positions [m] behind the ship and velocities [m/s], each (n,), of a steady tow with quadratic drag."""
    force = np.cumsum(chain.r[::-1])[::-1] * speed * abs(speed)
    return -np.cumsum(force / chain.k), np.full(chain.k.size, float(speed))


@kernel
def _march(
    k: Floats,
    r: Floats,
    m: Floats,
    x: Floats,
    v: Floats,
    step: Floats,
    substeps: NDArray[np.int64],
    stage: Floats,
    tolerance: float,
    budget: int,
    x_out: Floats,
    v_out: Floats,
) -> tuple[int, int, float]:
    """March through all intervals; (-1, 0, 0), or the failed interval, its node and the last change of velocity."""
    n = k.size
    below = np.append(k[1:], 0.0)
    base, mass, diagonal, coupling = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    ratio, load, vh, xh, v1, guess = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    slope = np.zeros(n)
    x_out[0], v_out[0] = x[n - 1], v[n - 1]
    at = 0
    last = 0.0
    for interval in range(step.size):
        h = step[interval]
        g = GAMMA * h
        if h != last:
            for i in range(n):
                mass[i] = m[i] / g
                diagonal[i] = mass[i] + g * (k[i] + below[i])
                coupling[i] = g * k[i]
            last = h
        for _ in range(substeps[interval]):
            for s in range(2):
                if s == 0:
                    for i in range(n):
                        xh[i], vh[i] = x[i], v[i]
                        guess[i] = v[i] + slope[i] * g
                else:
                    for i in range(n):
                        change = v1[i] - v[i]
                        xh[i] = x[i] + (h - g) * v1[i]
                        vh[i] = v[i] + change * ((1.0 - GAMMA) / GAMMA)
                        guess[i] = v[i] + change / GAMMA
                above = stage[at, s]
                pull = k[0] * (above - xh[0])
                for i in range(n):
                    hold = below[i] * (xh[i] - xh[i + 1]) if i + 1 < n else 0.0
                    base[i] = pull - hold + mass[i] * vh[i]
                    pull = hold
                solved = False
                node = 0
                worst = 0.0
                for _iteration in range(budget):
                    # One Newton step, written for the new velocity: J v_new = base + r v|v|.
                    for i in range(n):
                        drag = r[i] * abs(guess[i])
                        d = diagonal[i] + 2.0 * drag
                        b = base[i] + drag * guess[i]
                        if i > 0:
                            c = coupling[i] * ratio[i - 1]
                            d -= coupling[i] * c
                            b += c * load[i - 1]
                        ratio[i] = 1.0 / d
                        load[i] = b
                    solved = True
                    worst = 0.0
                    new = 0.0
                    for j in range(n):
                        i = n - 1 - j
                        new = (load[i] + (coupling[i + 1] * new if j > 0 else 0.0)) * ratio[i]
                        change = abs(new - guess[i])
                        guess[i] = new
                        if not (
                            r[i] * change * change <= tolerance * (mass[i] + 2.0 * r[i] * abs(new))
                            or change <= tolerance
                        ):
                            solved = False
                        if not change <= worst:
                            worst, node = change, i + 1
                    if solved or not np.isfinite(worst):
                        break
                if not solved:
                    return interval, node, worst
                if s == 0:
                    for i in range(n):
                        v1[i] = guess[i]
            for i in range(n):
                x[i] = xh[i] + g * guess[i]
                slope[i] = (guess[i] - v1[i]) / (h - g)
                v[i] = guess[i]
            at += 1
        x_out[interval + 1], v_out[interval + 1] = x[n - 1], v[n - 1]
    return -1, 0, 0.0
