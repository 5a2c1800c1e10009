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

Two steppers solve it. A chain with mass is marched by the explicit scheme of `models.explicit_chain` wherever that
is stable, and within its error, in at most twice the steps of the implicit one, each of which costs two explicit ones.
Where it is not, as with next to no mass or great drag, and always without mass, the implicit stepper takes over:
Alexander's SDIRK2 with the velocity as unknown. A stage solves

    (m/g) (v - vh) = F(xh + g v) - r v|v|,

the gradient of a strictly convex function of v, with a tridiagonal positive definite derivative. Nothing is
divided by v, so a chain at rest or in reversal is no special case. Newton's method leaves a residual of at most
r dv^2, which gives a strict stopping rule: the error is below the largest r dv^2 / (m/g + 2 r|v|). The tridiagonal
system is eliminated from both ends at once: two short rows of divisions that wait for each other, not a long one.
"""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.drive import GAMMA, Drive, Grid
from models.explicit_chain import RADIUS, STEP_ERROR, largest_frequency, march_explicit
from models.kernels import fast_kernel
from models.quantity import NumericalFailure

Floats = NDArray[np.float64]

#: Bound of the error that Newton's method leaves in a stage velocity [m/s].
TOLERANCE = 1e-9

#: Newton iterations of one stage before the step counts as failed.
BUDGET = 80

#: Explicit steps that are taken in place of one implicit step, at most: they cost the same.
AFFORDED = 2

#: Sampling intervals that the implicit stepper marches where the explicit one has given up, before that is tried
#: again; twice as many every time.
STRETCH = 64

Path = Literal["either", "explicit", "implicit"]


class Chain(NamedTuple):
    """Stiffness k [N/m], drag r [N s2/m2, or N s/m in a linear model] and mass m [kg], each (n,), ship first."""

    k: Floats
    r: Floats
    m: Floats


class Motion(NamedTuple):
    """Position x from the local origin (n,) [m] and velocity v (n,) [m/s] of the vehicle at the ship's times."""

    x: Floats
    v: Floats


def quadratic_motion(chain: Chain, drive: Drive, *, path: Path = "either") -> Motion:
    """The vehicle of a chain with quadratic drag.

    Parameters
    ----------
    path
        ``either`` leaves the choice of the stepper to its cost; ``explicit`` and ``implicit`` hold to one.

    Raises
    ------
    NumericalFailure
        A stage is not solved within the iteration budget, or leaves the finite range; or the explicit stepper is
        asked for where it takes more steps than it may.
    """
    x_out, v_out = np.empty(drive.t.size), np.empty(drive.t.size)
    x, v = steady_shape(chain, drive.start_speed)
    k, r, m = (np.array(values) for values in chain)
    chain = Chain(k, r, m)
    # Mass makes the links swing: half the step keeps lightly damped swings as exact as a massless chain.
    grid = drive.fine if m.any() else drive.coarse
    intervals = drive.t.size - 1
    if path == "implicit" or (path == "either" and not m.all()):
        _implicit(chain, drive, grid, 0, intervals, x, v, x_out, v_out)
        return Motion(x_out, v_out)
    omega = largest_frequency(k, m)
    if path == "either" and not omega * grid.step.min() <= AFFORDED * RADIUS:
        # No interval could be marched explicitly, however slow the motion.
        _implicit(chain, drive, grid, 0, intervals, x, v, x_out, v_out)
        return Motion(x_out, v_out)
    few, most = drive.coarse, AFFORDED * grid.substeps
    at, stretch = 0, STRETCH
    while at < intervals:
        at, needed = march_explicit(
            k, r, m, x, v, omega, at, few.step, few.substeps, most, STEP_ERROR, drive.u, drive.rates, x_out, v_out
        )
        if at < intervals and path == "explicit":
            raise NumericalFailure(
                f"The explicit stepper would need {needed:g} steps for the {drive.t[at + 1] - drive.t[at]:g} s after "
                f"t = {drive.t[at]:g} s, but may take {most[at]}; give a shorter max_step, or allow the implicit one."
            )
        end = min(at + stretch, intervals)
        if at < end:
            _implicit(chain, drive, grid, at, end, x, v, x_out, v_out)
        at, stretch = end, 2 * stretch
    return Motion(x_out, v_out)


def _implicit(
    chain: Chain, drive: Drive, grid: Grid, begin: int, end: int, x: Floats, v: Floats, x_out: Floats, v_out: Floats
) -> None:
    """March the state x, v (n,) by the implicit stepper from one sample to another.

    Raises
    ------
    NumericalFailure
        A stage is not solved within the iteration budget, or leaves the finite range.
    """
    first = int(grid.substeps[:begin].sum())
    part = (grid.step[begin:end], grid.substeps[begin:end], grid.stage[first:])
    interval, node, residual = _march(
        *chain, x, v, *part, TOLERANCE, BUDGET, x_out[begin : end + 1], v_out[begin : end + 1]
    )
    if interval >= 0:
        raise NumericalFailure(
            f"The chain of {chain.k.size} links found no velocity after t = {drive.t[begin + interval]:g} s: "
            f"node {node} keeps a change of {residual:g} m/s after {BUDGET} Newton iterations; "
            "its parameters are too extreme."
        )


def steady_shape(chain: Chain, speed: float) -> tuple[Floats, Floats]:
    """Node positions [m] behind the ship and velocities [m/s], each (n,), of a steady tow with quadratic drag."""
    force = np.cumsum(chain.r[::-1])[::-1] * speed * abs(speed)
    return -np.cumsum(force / chain.k), np.full(chain.k.size, float(speed))


@fast_kernel
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
    # Nodes are eliminated in pairs from both ends, p from above and p from below; one or two are left in the middle.
    p = (n - 1) // 2
    q = n - 1 - p
    ratio, load, vh, xh, v1, guess = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    slope = np.zeros(n)
    x_out[0], v_out[0] = x[n - 1], v[n - 1]
    at = 0
    last = 0.0
    for interval in range(step.size):
        h = step[interval]
        g = GAMMA * h
        per_rest = 1.0 / (h - g)
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
                        guess[i] = v[i] + change * (1.0 / GAMMA)
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
                    for i in range(p + 1):
                        drag = r[i] * abs(guess[i])
                        d = diagonal[i] + 2.0 * drag
                        b = base[i] + drag * guess[i]
                        if i > 0:
                            c = coupling[i] * ratio[i - 1]
                            d -= coupling[i] * c
                            b += c * load[i - 1]
                        j = n - 1 - i
                        drag = r[j] * abs(guess[j])
                        D = diagonal[j] + 2.0 * drag
                        B = base[j] + drag * guess[j]
                        if i > 0:
                            c = coupling[j + 1] * ratio[j + 1]
                            D -= coupling[j + 1] * c
                            B += c * load[j + 1]
                        if i < p:
                            ratio[i], load[i] = 1.0 / d, b
                            ratio[j], load[j] = 1.0 / D, B
                        elif i < j:
                            c = coupling[j]
                            scale = 1.0 / (d * D - c * c)
                            load[i], load[j] = (D * b + c * B) * scale, (d * B + c * b) * scale
                        elif i > 0:
                            # One node is left, and has been eliminated with from both sides.
                            c = coupling[i] * ratio[i - 1]
                            load[i] = (B + c * load[i - 1]) / (D - coupling[i] * c)
                        else:
                            load[i] = b / d
                    up, down = load[p], load[q]
                    for i in range(p):
                        up = (load[p - 1 - i] + coupling[p - i] * up) * ratio[p - 1 - i]
                        down = (load[q + 1 + i] + coupling[q + 1 + i] * down) * ratio[q + 1 + i]
                        load[p - 1 - i], load[q + 1 + i] = up, down
                    solved = True
                    worst = 0.0
                    for i in range(n):
                        new = load[i]
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
                slope[i] = (guess[i] - v1[i]) * per_rest
                v[i] = guess[i]
            at += 1
        x_out[interval + 1], v_out[interval + 1] = x[n - 1], v[n - 1]
    return -1, 0, 0.0
