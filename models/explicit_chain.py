"""Runge and Kutta's scheme of order 4 for a chain with mass and quadratic drag (`models.chain`), where it is stable.

| symbol | meaning | unit |
| --- | --- | --- |
| k, m, u, x, v | as in `models.chain` | |
| c | drag over mass, r/m, and the rate 2 c |v| at which drag alone slows a node | 1/m, 1/s |
| omega | largest undamped frequency of the chain | rad/s |
| H, h | sampling interval, and the step within it | s |
| a1 ... a4, a5 | accelerations of the four stages, and at the end of the step, where the next begins | m/s2 |

Stability. Small motions about a state follow M y'' + 2 diag(r|v|) y' + K y = 0. With y = e^(lambda t) z and z of unit
mass, lambda^2 + d lambda + w = 0 with 0 <= d <= max 2 c|v| and 0 <= w <= omega^2: a complex lambda has |lambda|^2 = w,
a real one |lambda| <= d. So every |lambda| <= max(omega, max 2 c|v|), in the left half plane, and a step is stable
with h times that below the radius of the largest half disc there in which |1 + z + z^2/2 + z^3/6 + z^4/24| <= 1.

Error. The weights 1/6, 1/3, 1/3, 0, 1/6 of a1, a2, a3, a4, a5 are of order 3 (Hairer, Norsett & Wanner, II.4), so
h (a5 - a4)/6 estimates the error of a step in the velocity, one order too large. a5 costs nothing.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, kernel

Floats = NDArray[np.float64]

#: Radius of the largest half disc of stable h lambda, 2.616 at 122 degrees, less a little.
RADIUS = 2.6

#: A velocity may grow by this factor within a sampling interval before the interval is begun again with more steps.
GROWTH = 1.1

#: Bound of the error estimate of one step [m/s].
STEP_ERROR = 1e-5

#: Relative width to which the largest frequency is bracketed.
SHARP = 1e-3


@kernel
def largest_frequency(k: Floats, m: Floats) -> float:
    """Upper bound of the largest undamped frequency [rad/s] of a chain, sharp to a thousandth; infinite without mass.

    Bisection between the largest diagonal entry of M^-1/2 K M^-1/2 and Gershgorin's bound, by Sturm's count of the
    pivots: none of K - w M is positive exactly where no eigenvalue is above w.
    """
    n = k.size
    low = high = 0.0
    for i in range(n):
        below = k[i + 1] if i + 1 < n else 0.0
        middle = (k[i] + below) / m[i]
        beside = k[i] / np.sqrt(m[i] * m[i - 1]) if i > 0 else 0.0
        beside += below / np.sqrt(m[i] * m[i + 1]) if i + 1 < n else 0.0
        if not middle + beside < np.inf:
            return math.inf
        low, high = max(low, middle), max(high, middle + beside)
    while high - low > SHARP * high:
        w = 0.5 * (low + high)
        above = False
        pivot = -1.0
        for i in range(n):
            d = k[i] + (k[i + 1] if i + 1 < n else 0.0) - w * m[i]
            pivot = d - k[i] * k[i] / pivot if i > 0 else d
            if not pivot < 0.0:
                above = True
                break
        if above:
            low = w
        else:
            high = w
    frequency: float = np.sqrt(high)
    return frequency


@inline_kernel
def _node(
    i: int, pull: float, here: float, under: float, speed: float, k: Floats, c: Floats, per_mass: Floats, a: Floats
) -> float:
    """Acceleration of node i into `a`, between the link above that pulls with `pull` and the node `under`; the pull
    of the link below [N] comes back."""
    hold: float = k[i + 1] * (here - under)
    a[i] = (pull - hold) * per_mass[i] - c[i] * speed * abs(speed)
    return hold


@kernel
def march_explicit(
    k: Floats,
    r: Floats,
    m: Floats,
    x: Floats,
    v: Floats,
    omega: float,
    begin: int,
    step: Floats,
    fewest: NDArray[np.int64],
    most: NDArray[np.int64],
    tolerance: float,
    u: Floats,
    rates: Floats,
    x_out: Floats,
    v_out: Floats,
) -> tuple[int, float]:
    """March on from the interval `begin`, each in `fewest` steps of `step` [s], or in more, but `most`.

    The state x, v (n,) is that at the end. Returned are the interval that needs more steps, and how many; or the
    number of intervals, and 0.
    """
    n = k.size
    springs, c, per_mass = np.zeros(n + 1), r / m, 1.0 / m
    springs[:n] = k
    x0, v0, a0 = np.empty(n), np.empty(n), np.empty(n)
    # One entry more than nodes: the vehicle has no link below, and what is read there is multiplied by zero.
    X, V, a1, a2, a3 = np.zeros(n + 1), np.zeros(n + 1), np.zeros(n + 1), np.zeros(n + 1), np.zeros(n + 1)
    a4 = np.zeros(n + 1)
    X[:n], V[:n] = x, v
    x_out[begin], v_out[begin] = x[n - 1], v[n - 1]
    damping = 0.0
    pull = springs[0] * (u[begin] - X[0])
    for i in range(n):
        pull = _node(i, pull, X[i], X[i + 1], V[i], springs, c, per_mass, a1)
        rate = 2.0 * c[i] * abs(V[i])
        if not rate <= damping:
            damping = rate
    for at in range(begin, step.size):
        H = step[at] * fewest[at]
        for i in range(n):
            x0[i], v0[i], a0[i] = X[i], V[i], a1[i]
        needed = max(float(fewest[at]), np.ceil(H * max(omega, GROWTH * damping) / RADIUS))
        while True:
            # Also what is not a number ends here.
            if not needed <= most[at]:
                for i in range(n):
                    x[i], v[i] = x0[i], v0[i]
                return at, needed
            count = int(needed)
            h = H / count
            half = 0.5 * h
            allowed = RADIUS / h
            stable = exact = True
            for part in range(count):
                s = part * h
                middle = u[at] + (s + half) * (
                    rates[at, 0] + (s + half) * (rates[at, 1] / 2.0 + (s + half) * rates[at, 2] / 6.0)
                )
                s += h
                above = u[at] + s * (rates[at, 0] + s * (rates[at, 1] / 2.0 + s * rates[at, 2] / 6.0))
                here = X[0] + half * V[0]
                pull = springs[0] * (middle - here)
                for i in range(n):
                    under = X[i + 1] + half * V[i + 1]
                    pull = _node(i, pull, here, under, V[i] + half * a1[i], springs, c, per_mass, a2)
                    here = under
                here = X[0] + half * (V[0] + half * a1[0])
                pull = springs[0] * (middle - here)
                for i in range(n):
                    under = X[i + 1] + half * (V[i + 1] + half * a1[i + 1])
                    pull = _node(i, pull, here, under, V[i] + half * a2[i], springs, c, per_mass, a3)
                    here = under
                here = X[0] + h * (V[0] + half * a2[0])
                pull = springs[0] * (above - here)
                for i in range(n):
                    under = X[i + 1] + h * (V[i + 1] + half * a2[i + 1])
                    pull = _node(i, pull, here, under, V[i] + h * a3[i], springs, c, per_mass, a4)
                    here = under
                for i in range(n):
                    X[i] += h * (V[i] + h / 6.0 * (a1[i] + a2[i] + a3[i]))
                    V[i] += h / 6.0 * (a1[i] + 2.0 * (a2[i] + a3[i]) + a4[i])
                pull = springs[0] * (above - X[0])
                off = damping = 0.0
                for i in range(n):
                    pull = _node(i, pull, X[i], X[i + 1], V[i], springs, c, per_mass, a1)
                    change = abs(a1[i] - a4[i])
                    if not change <= off:
                        off = change
                    rate = 2.0 * c[i] * abs(V[i])
                    if not rate <= damping:
                        damping = rate
                if not damping <= allowed:
                    stable = False
                    break
                if not h / 6.0 * off <= tolerance:
                    exact = False
                    break
            if stable and exact:
                break
            # What became of the state past the limit says little about the velocities that occur.
            needed = max(needed + 1.0, np.ceil(GROWTH * needed)) if not stable else 2.0 * needed
            for i in range(n):
                X[i], V[i], a1[i] = x0[i], v0[i], a0[i]
        x_out[at + 1], v_out[at + 1] = X[n - 1], V[n - 1]
    for i in range(n):
        x[i], v[i] = X[i], V[i]
    return step.size, 0.0
