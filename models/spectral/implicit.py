"""Implicit steppers of the spectral model: TR-BDF2 with error control, and Newmark with corrector.

Both advance u (positions) and pi (momenta), u' = w, pi' = F(u, w, t), with the velocity w as the unknown of a
stage: pi(w) - pi_hat - g h F(u_hat + g h w, w) = 0, so neither the ship's acceleration nor a division by a
small step appears. TR-BDF2 is L-stable, of order 2, and carries an embedded third-order solution (Hosea and
Shampine 1996) for its step. Newmark's average acceleration (beta 1/4, gamma 1/2) is the same stage with g = 1/2
over the whole step, corrected until the velocity settles.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.spectral.basis import LENGTH, PITCH, Fields
from models.spectral.body import end_motion
from models.spectral.forces import TENSION, WORK_ROWS
from models.spectral.system import (
    BUDGET,
    DONE,
    NO_CONVERGENCE,
    NOT_FINITE,
    SLACK,
    evaluate,
    factor,
    momentum,
    ship_at,
    stage_matrix,
    substitute,
)
from models.spectral.winch import pay_out, steer

Floats = NDArray[np.float64]

_GAMMA = 1.0 - 1.0 / math.sqrt(2.0)
_W = math.sqrt(2.0) / 4.0
#: Weights of the embedded error: (b - b_hat) of TR-BDF2.
_E1, _E2, _E3 = _W - (1.0 - _W) / 3.0, _W - (3.0 * _W + 1.0) / 3.0, _GAMMA - _GAMMA / 3.0
_NEWTON_ITERATIONS = 10
_RENEWAL = 4
#: Step control: safety, and the weight of the sines' error beside the vehicle's.
_SAFETY = 0.9
_WAVE_WEIGHT = 0.1


@kernel
def solve_stage(
    f: Fields,
    u_hat: Floats,
    pi_hat: Floats,
    end: Floats,
    gh: float,
    tolerance: float,
    fresh: bool,
    w: Floats,
    u: Floats,
    pi: Floats,
    F: Floats,
    cable: Floats,
    station: Floats,
    A: Floats,
    Y: Floats,
    pivot: NDArray[np.int64],
    counts: NDArray[np.int64],
) -> bool:
    """Newton's iteration for the stage velocity w, with the factors kept while they converge."""
    n = u.size
    r = np.empty(n)
    previous = math.inf
    for iteration in range(_NEWTON_ITERATIONS):
        for i in range(n):
            u[i] = u_hat[i] + gh * w[i]
        evaluate(f, u, w, end, pi, F, cable, station)
        counts[0] += 1
        for i in range(n):
            r[i] = pi[i] - pi_hat[i] - gh * F[i]
        if fresh:
            stage_matrix(f, u, w, end, gh, cable, station, A, Y)
            counts[1] += 1
            if not factor(A, pivot):
                return False
        substitute(A, pivot, r)
        size = 0.0
        for i in range(n):
            w[i] -= r[i]
            size = max(size, abs(r[i]))
        if not size < 1e12:
            return False
        rate = size / previous if iteration > 0 else 1.0
        if size <= 0.1 * tolerance or (iteration > 0 and rate < 0.9 and size * rate / (1.0 - rate) <= tolerance):
            # The momentum is linear in the velocity, so the stage equation itself gives the force of the last
            # correction without another sweep over the stations.
            for i in range(n):
                u[i] = u_hat[i] + gh * w[i]
            momentum(f, u, w, end, pi, cable)
            if gh > 0.0:
                for i in range(n):
                    F[i] = (pi[i] - pi_hat[i]) / gh
            return True
        # Factors that converge slowly are renewed, and those that need many iterations once.
        fresh = iteration > 0 and (rate > 0.25 or iteration == _RENEWAL)
        previous = size
    return False


@kernel
def march(
    f: Fields,
    knots: Floats,
    ship: Floats,
    times: Floats,
    stepper: int,
    h: float,
    tolerance: float,
    budget: int,
    control: Floats,
    winch_t: Floats,
    winch_value: Floats,
    out: Floats,
    shapes: Floats,
    counts: NDArray[np.int64],
    where: Floats,
) -> int:
    """March from times[0] to times[-1] and fill the results at the times.

    `out` (n, 2 nb + 3): the body's coordinates and velocity, tension at the top and at the vehicle, payout;
    `shapes` (n, 2 + N): the cable's coordinates. `stepper` 0 is TR-BDF2 with error control from the first step h,
    1 is Newmark with the fixed step h. `counts` are evaluations, factorisations, steps and rejections; `where`
    (2,) is the time and the station of a failure.
    """
    N, J = f.sines.shape[1], f.station.shape[1]
    nb = 3 if f.body.size > 3 else 2
    n = nb + N
    stages = 3 if stepper == 0 else 2
    u, pi = np.zeros((3, n)), np.zeros((3, n))
    w, F, tension = np.zeros((3, n)), np.zeros((3, n)), np.zeros((3, 2))
    u_hat, pi_hat, e = np.zeros(n), np.zeros(n), np.zeros(n)
    w_old, w_mid = np.zeros(n), np.zeros(n)
    cable, station = np.zeros((7, 2 + N)), np.zeros((WORK_ROWS, J))
    A, Y, pivot = np.zeros((n, n)), np.zeros((2 + N, 2 + N)), np.zeros(n, dtype=np.int64)
    end, memory = np.zeros(7), np.zeros(5)
    t, stop, h_old = times[0], times[-1], h
    winch, control_time = control[0] > 0.0, t
    error_old, rejected = 1.0, False
    c = 2.0 * _GAMMA
    if nb == 3:
        u_hat[2] = f.scalar[PITCH]
    place = ship_at(f, t, knots, ship, 0, end)
    # A jump of the ship's speed at the start is an impulse: the momentum stays at rest.
    if not solve_stage(
        f, u_hat, pi_hat, end, 0.0, 1e-12, True, w[0], u[0], pi[0], F[0], cable, station, A, Y, pivot, counts
    ):
        return NOT_FINITE
    for i in range(n):
        w_old[i] = w_mid[i] = w[0, i]
    for i in range(nb):
        out[0, i], out[0, nb + i] = u[0, i], w[0, i]
    tension[0, 0], tension[0, 1] = end[6], cable[3, 0]
    out[0, 2 * nb], out[0, 2 * nb + 1] = end[6], cable[3, 0]
    for i in range(2 + N):
        shapes[0, i] = cable[0, i]
    row = 1
    sliver = 1e-9 * (stop - times[0])
    while stop - t > sliver:
        where[0] = t
        if counts[2] + counts[3] >= budget:
            return BUDGET
        limit = stop
        if winch:
            if t >= control_time - 1e-9:
                steer(control, winch_t, winch_value, t, -u[0, 1], memory)
                control_time += control[1]
            limit = min(stop, control_time)
        # Land on the limit without a sliver of a last step.
        remaining = limit - t
        step = remaining if h >= 0.999 * remaining else (0.5 * remaining if h > 0.5 * remaining else h)
        if stepper == 1:
            step = min(h, remaining)
        gh = (_GAMMA if stepper == 0 else 0.5) * step
        ratio = step / h_old
        error = math.inf
        ok = True
        for k in range(1, stages):
            ahead = c * step if stages - k == 2 else step
            if winch:
                pay_out(control, memory, t + ahead, end)
            place = ship_at(f, t + ahead, knots, ship, place, end)
            for i in range(n):
                if k == 1:
                    u_hat[i] = u[0, i] + gh * w[0, i]
                    pi_hat[i] = pi[0, i] + gh * F[0, i]
                    w[1, i] = w[0, i]
                    if stepper == 0 and ratio <= 2.0:
                        # The quadratic through the last step's three velocities, continued.
                        a = 1.0 + c * ratio
                        w[1, i] *= a * (a - c) / (1.0 - c)
                        w[1, i] += w_old[i] * (a - c) * (a - 1.0) / c + w_mid[i] * a * (a - 1.0) / (c * (c - 1.0))
                else:
                    u_hat[i] = u[0, i] + step * _W * (w[0, i] + w[1, i])
                    pi_hat[i] = pi[0, i] + step * _W * (F[0, i] + F[1, i])
                    w[2, i] = w[0, i] + (w[1, i] - w[0, i]) / c
            ok = solve_stage(
                f, u_hat, pi_hat, end, gh, 0.3 * tolerance, k == 1, w[k], u[k], pi[k], F[k], cable, station, A, Y,
                pivot, counts,
            )  # fmt: skip
            if not ok:
                break
            tension[k, 0], tension[k, 1] = end[6], cable[3, 0]
        last = stages - 1
        if ok and stepper == 1:
            error = 0.0
        elif ok:
            for i in range(n):
                e[i] = step * (_E1 * F[0, i] + _E2 * F[1, i] + _E3 * F[2, i])
            substitute(A, pivot, e)
            wave, error = 0.0, 0.0
            for i in range(nb):
                # A pitching body's rate counts at one metre from its centre.
                error = max(error, abs(e[i]))
            for i in range(nb, n):
                wave += 0.5 * e[i] * e[i]
            error = max(error, _WAVE_WEIGHT * math.sqrt(wave)) / tolerance
        if not error <= 1.0:
            counts[3] += 1
            rejected = True
            if stepper == 1:
                return NO_CONVERGENCE
            h = step * (max(0.2, 0.8 * error ** (-1.0 / 3.0)) if error < 1e6 else 0.25)
            if h < 1e-10 * (stop - times[0]):
                return NO_CONVERGENCE
            continue
        # Accepted. A cable pushes nothing: stop where it would.
        least, spot = cable[3, 0], 0.0
        for j in range(J):
            if not station[TENSION, j] >= least:
                least, spot = station[TENSION, j], f.station[0, j] * f.scalar[LENGTH]
        if not least > 0.0:
            where[0], where[1] = t + step, spot
            return SLACK if math.isfinite(least) else NOT_FINITE
        while row < times.size and times[row] <= t + step + sliver:
            s = min((times[row] - t) / step, 1.0)
            # Velocities and tensions: quadratic through the three stages of TR-BDF2, linear over a Newmark step.
            bow = s * (s - 1.0)
            at_0, at_1, at_2 = 1.0 - s + bow / c, bow / (c * (c - 1.0)), s + bow / (1.0 - c)
            if stepper == 1:
                at_0, at_1, at_2 = 1.0 - s, s, 0.0
            for i in range(n):
                position = (
                    (1.0 + 2.0 * s) * (1.0 - s) ** 2 * u[0, i]
                    + s * (1.0 - s) ** 2 * step * w[0, i]
                    + s * s * (3.0 - 2.0 * s) * u[last, i]
                    + s * s * (s - 1.0) * step * w[last, i]
                )
                if i < nb:
                    out[row, i], out[row, nb + i] = position, at_0 * w[0, i] + at_1 * w[1, i] + at_2 * w[2, i]
                else:
                    shapes[row, 2 + i - nb] = position
            for i in range(2):
                out[row, 2 * nb + i] = at_0 * tension[0, i] + at_1 * tension[1, i] + at_2 * tension[2, i]
            if winch:
                pay_out(control, memory, times[row], end)
                out[row, 2 * nb + 2] = end[4]
            end_motion(f, out[row, :nb], out[row, nb : 2 * nb], shapes[row], cable[1], cable[5, :2], cable[6, :2])
            row += 1
        tension[0, 0], tension[0, 1] = tension[last, 0], tension[last, 1]
        for i in range(n):
            w_old[i], w_mid[i] = w[0, i], w[1, i]
            u[0, i], w[0, i], pi[0, i], F[0, i] = u[last, i], w[last, i], pi[last, i], F[last, i]
        t += step
        counts[2] += 1
        h_old = step
        if stepper == 0:
            error = max(error, 1e-3)
            grow = _SAFETY * error ** (-0.7 / 3.0) * error_old ** (0.4 / 3.0)
            h = step * min(1.0 if rejected else 2.0, max(0.3, grow))
            error_old, rejected = error, False
    return DONE if row == times.size else NO_CONVERGENCE
