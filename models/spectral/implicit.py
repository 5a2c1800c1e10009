"""Implicit steppers of the spectral model: diagonally implicit Runge-Kutta with error control, and Newmark.

Both advance u (positions) and pi (momenta), u' = w, pi' = F(u, w, t), with the velocity w as the unknown of a
stage: pi(w) - pi_hat - g h F(u_hat + g h w, w) = 0, so neither the ship's acceleration nor a division by a
small step appears. Newmark's average acceleration (beta 1/4, gamma 1/2) is one such stage over the whole step,
corrected until the velocity settles.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.spectral.basis import AXIAL_STIFFNESS, LENGTH, PITCH, Fields
from models.spectral.body import end_motion
from models.spectral.dense import MOST_NODES, at_sample, local_error, predict
from models.spectral.system import (
    BUDGET,
    DONE,
    LARGEST_ANGLE,
    NO_CONVERGENCE,
    NOT_FINITE,
    SLACK,
    STEEP,
    evaluate,
    factor,
    momentum,
    ship_at,
    stage_matrix,
    substitute,
)
from models.spectral.tableau import AVERAGE, DEFECT, ENDS, NODES, ORDER, STAGES
from models.spectral.winch import pay_out, steer
from models.spectral.workspace import (
    CABLE_ROWS,
    END_ROWS,
    PAID,
    PHI,
    SUM_ROWS,
    T_BOTTOM,
    T_TOP,
    TENSION,
    WORK_ROWS,
    Y,
)

Floats = NDArray[np.float64]

_NEWTON_ITERATIONS = 10
_RENEWAL = 4
#: How closely Newton's iteration finds a stage, over the local tolerance: what it leaves is in the error's estimate.
_CLOSELY = 3.0
#: Step control: safety.
_SAFETY = 0.9
#: Share of a step that has found a tension of zero, down to which shorter ones are tried before it is believed.
_DOUBT = 1.0 / 256.0
#: The fastest that Newton's iteration is believed to converge before it has been seen to.
_PACE = 0.02
#: Least growth that a step is changed for, and the rate of Newton's iteration that its factors are kept at.
_GROW, _SLOW = 1.2, 0.1
#: Share of the tension that Newton's last correction may change it by, at most and over its tolerance [s/m].
_TENSION_SHARE, _TENSION_SHARE_BY = 1e-3, 100.0


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
    W: Floats,
    pivot: NDArray[np.int64],
    pace: Floats,
    r: Floats,
    counts: NDArray[np.int64],
) -> bool:
    """Newton's iteration for the stage velocity w, with the factors kept while they converge.

    `pace` is the rate that the present factors converged at and the axial stiffness EA/L [N/m]; `r` (n,) is workspace.
    """
    n = u.size
    previous = math.inf
    for iteration in range(_NEWTON_ITERATIONS):
        for i in range(n):
            u[i] = u_hat[i] + gh * w[i]
        evaluate(f, u, w, end, pi, F, cable, station)
        counts[0] += 1
        for i in range(n):
            r[i] = pi[i] - pi_hat[i] - gh * F[i]
        if fresh:
            stage_matrix(f, u, w, end, gh, cable, station, A, W)
            counts[1] += 1
            # How fast new factors converge is not known: the last rate is trusted less and less until one is measured.
            pace[0] **= 0.9
            if not factor(A, pivot):
                return False
        substitute(A, pivot, r)
        size = 0.0
        for i in range(n):
            w[i] -= r[i]
            size = max(size, abs(r[i]))
        if not size < 1e12:
            return False
        # Along a stiff cable a small correction of the velocity is a large one of the tension.
        share = min(_TENSION_SHARE, _TENSION_SHARE_BY * tolerance)
        pull = gh * pace[1] * (abs(r[0]) + abs(r[1])) / (share * abs(end[T_BOTTOM]) + 1e-30)
        size = max(size, 0.1 * tolerance * min(pull, 1e6))
        if iteration > 0:
            pace[0] = max(size / previous, _PACE)
        rate = pace[0]
        if size <= 0.1 * tolerance or (rate < 0.9 and size * rate / (1.0 - rate) <= tolerance):
            # The momentum is linear in the velocity, so the stage equation itself gives the force of the last
            # correction without another sweep over the stations.
            for i in range(n):
                u[i] = u_hat[i] + gh * w[i]
            if gh > 0.0:
                momentum(f, u, w, end, pi, F, cable)
                for i in range(n):
                    F[i] = (pi[i] - pi_hat[i]) / gh
            else:
                evaluate(f, u, w, end, pi, F, cable, station)
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
    `shapes` (n, 2 + N): the cable's coordinates. `stepper` 0 is the default of `tableau`, with error control
    from the first step h, 1 is Newmark with the fixed step h. `counts` are evaluations, factorisations, steps and
    rejections; `where` (2,) is the time and the station of a failure.
    """
    N, J = f.sines.shape[1], f.station.shape[1]
    nb = 3 if f.body.size > 3 else 2
    n = nb + N
    if stepper == 0:
        a, c, d = STAGES, NODES, DEFECT
    else:
        a, c, d = AVERAGE, ENDS, ENDS
    last = c.size - 1
    gamma, order = a[last, last], ORDER
    u, pi, F = np.zeros((last + 1, n)), np.zeros((last + 1, n)), np.zeros((last + 1, n))
    w, tension = np.zeros((2, last + 1, n)), np.zeros((last + 1, 2))
    u_hat, pi_hat, e, r = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    cable, spare, station = np.zeros((CABLE_ROWS, 2 + N)), np.zeros((CABLE_ROWS, 2 + N)), np.zeros((WORK_ROWS, J))
    A, W, pivot = np.zeros((n, n)), np.zeros((2 + N + SUM_ROWS, 2 * N + 1)), np.zeros(n, dtype=np.int64)
    end, memory, pace = np.zeros(END_ROWS), np.zeros(5), np.ones(2)
    nodes, weights = np.zeros(MOST_NODES), np.zeros(MOST_NODES)
    pace[1] = f.scalar[AXIAL_STIFFNESS] / f.scalar[LENGTH] if f.scalar[LENGTH] > 0.0 else 0.0
    t, stop, h_old = times[0], times[-1], 0.0
    winch, control_time = control[0] > 0.0, t
    error_old, rejected, floor, now, factored = 1.0, False, 0.0, 0, 0.0
    if nb == 3:
        u_hat[2] = f.scalar[PITCH]
    place = ship_at(f, t, knots, ship, 0, end)
    # A jump of the ship's speed at the start is an impulse: the momentum stays at rest.
    if not solve_stage(
        f, u_hat, pi_hat, end, 0.0, 1e-12, True, w[0, 0], u[0], pi[0], F[0], cable, station, A, W, pivot, pace, r,
        counts,
    ):  # fmt: skip
        return NOT_FINITE
    for i in range(nb):
        out[0, i], out[0, nb + i] = u[0, i], w[0, 0, i]
    tension[0, 0], tension[0, 1] = end[T_TOP], end[T_BOTTOM]
    out[0, 2 * nb], out[0, 2 * nb + 1] = end[T_TOP], end[T_BOTTOM]
    for i in range(2 + N):
        shapes[0, i] = cable[Y, i]
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
            step, pace[0] = min(h, remaining), 1.0
        gh = gamma * step
        renew = stepper == 1 or gh != factored or pace[0] > _SLOW
        factored = gh
        error = math.inf
        ok = True
        for k in range(1, last + 1):
            if winch:
                pay_out(control, memory, t + c[k] * step, end)
            place = ship_at(f, t + c[k] * step, knots, ship, place, end)
            ratio = h_old / step if stepper == 0 and step <= 2.0 * h_old else 0.0
            predict(c, k, ratio, w[now], w[1 - now], nodes, weights, w[now, k])
            for i in range(n):
                u_hat[i], pi_hat[i] = u[0, i], pi[0, i]
            for j in range(k):
                share = step * a[k, j]
                for i in range(n):
                    u_hat[i] += share * w[now, j, i]
                    pi_hat[i] += share * F[j, i]
            ok = solve_stage(
                f, u_hat, pi_hat, end, gh, _CLOSELY * tolerance, renew and k == 1, w[now, k], u[k], pi[k], F[k],
                cable, station, A, W, pivot, pace, r, counts,
            )  # fmt: skip
            if not ok:
                break
            tension[k, 0], tension[k, 1] = end[T_TOP], end[T_BOTTOM]
        if ok and stepper == 1:
            error = 0.0
        elif ok:
            error = local_error(f.scalar, d, step, gh, nb, w[now], F, A, pivot, end, pace[1], e) / tolerance
        if not error <= 1.0:
            counts[3] += 1
            rejected = True
            if stepper == 1:
                return NO_CONVERGENCE
            h = step * (max(0.2, 0.8 * error ** (-1.0 / order)) if error < 1e6 else 0.25)
            if h < 1e-10 * (stop - times[0]):
                return NO_CONVERGENCE
            continue
        # Accepted. A cable pushes nothing: stop where it would.
        least, spot = end[T_BOTTOM], 0.0
        for j in range(J):
            if not abs(station[PHI, j]) <= LARGEST_ANGLE:
                where[0], where[1] = t + step, f.station[0, j] * f.scalar[LENGTH]
                return STEEP if math.isfinite(station[PHI, j]) else NOT_FINITE
            if not station[TENSION, j] >= least:
                least, spot = station[TENSION, j], f.station[0, j] * f.scalar[LENGTH]
        if not least > 0.0:
            # Along a stiff cable a long step errs in tension more than in velocity: believed of a short one only.
            if stepper == 0 and math.isfinite(least) and (floor == 0.0 or step > floor):
                floor = step * _DOUBT if floor == 0.0 else floor
                counts[3] += 1
                rejected = True
                h = 0.25 * step
                continue
            where[0], where[1] = t + step, spot
            return SLACK if math.isfinite(least) else NOT_FINITE
        if step * _DOUBT >= floor:
            floor = 0.0
        while row < times.size and times[row] <= t + step + sliver:
            s = min((times[row] - t) / step, 1.0)
            at_sample(c, s, step, nb, u, w[now], tension, weights, out[row], shapes[row])
            if winch:
                pay_out(control, memory, times[row], end)
                out[row, 2 * nb + 2] = end[PAID]
            end_motion(f, out[row, :nb], out[row, nb : 2 * nb], spare)
            shapes[row, 0], shapes[row, 1] = spare[Y, 0], spare[Y, 1]
            row += 1
        tension[0, 0], tension[0, 1] = tension[last, 0], tension[last, 1]
        now = 1 - now
        for i in range(n):
            w[now, 0, i] = w[1 - now, last, i]
            u[0, i], pi[0, i], F[0, i] = u[last, i], pi[last, i], F[last, i]
        t += step
        counts[2] += 1
        h_old = step
        if stepper == 0:
            error = max(error, 1e-3)
            grow = _SAFETY * error ** (-0.7 / order) * error_old ** (0.4 / order)
            # A step that could grow but little is kept, and its factors with it.
            h = step if 1.0 <= grow < _GROW else step * min(1.0 if rejected else 2.0, max(0.3, grow))
            error_old, rejected = error, False
    return DONE if row == times.size else NO_CONVERGENCE
