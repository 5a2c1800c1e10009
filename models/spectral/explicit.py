"""Classical Runge-Kutta with adaptive step for the spectral model (T 2.6.2), kept beside the implicit default.

The step is doubled against two halves, as in the reference of T section 5.2.1: the difference over 15 is the error
of the halves, which are then extrapolated. Steps end on every sample.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.spectral.basis import LENGTH, PITCH, Fields
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
    ship_at,
    stage_matrix,
    substitute,
)
from models.spectral.winch import pay_out, steer
from models.spectral.workspace import CABLE_ROWS, END_ROWS, PAID, PHI, SUM_ROWS, T_BOTTOM, T_TOP, TENSION, WORK_ROWS, Y

Floats = NDArray[np.float64]


@kernel
def march_explicit(
    f: Fields,
    knots: Floats,
    ship: Floats,
    times: Floats,
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
    """As `implicit.march`, in the state (u, pi); `tolerance` bounds the local error of the velocities [m/s]."""
    N, J = f.sines.shape[1], f.station.shape[1]
    nb = 3 if f.body.size > 3 else 2
    n = nb + N
    # Each state is u then pi: at the start, after a whole step, after two halves.
    state, whole, halves = np.zeros(2 * n), np.zeros(2 * n), np.zeros(2 * n)
    k1, slope, trial, total = np.zeros(2 * n), np.zeros(2 * n), np.zeros(2 * n), np.zeros(2 * n)
    w, pi, F, error_w = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    cable, station = np.zeros((CABLE_ROWS, 2 + N)), np.zeros((WORK_ROWS, J))
    A, W, pivot = np.zeros((n, n)), np.zeros((2 + N + SUM_ROWS, 2 * N + 1)), np.zeros(n, dtype=np.int64)
    end, memory = np.zeros(END_ROWS), np.zeros(5)
    winch, control_time, t, place = control[0] > 0.0, times[0], times[0], 0
    if nb == 3:
        state[2] = f.scalar[PITCH]
    factored = False
    row = 0
    while True:
        # Slope at the state reached: velocity, force and tensions there.
        if winch:
            pay_out(control, memory, t, end)
        place = ship_at(f, t, knots, ship, place, end)
        for i in range(2 * n):
            trial[i] = state[i]
        for phase in range(11):
            # Phase 0: slope at the start; 1-3 the rest of a whole step; 4-6 and 7-10 of the two halves.
            for i in range(n):
                w[i] = 0.0
            evaluate(f, trial[:n], w, end, pi, F, cable, station)
            if not factored or nb == 3 or winch:
                stage_matrix(f, trial[:n], w, end, 0.0, cable, station, A, W)
                if not factor(A, pivot):
                    return NOT_FINITE
                factored = True
            for i in range(n):
                w[i] = trial[n + i] - pi[i]
            substitute(A, pivot, w)
            evaluate(f, trial[:n], w, end, pi, F, cable, station)
            counts[0] += 2
            for i in range(n):
                slope[i], slope[n + i] = w[i], F[i]
            if phase == 0:
                least, spot = end[T_BOTTOM], 0.0
                for j in range(J):
                    if not abs(station[PHI, j]) <= LARGEST_ANGLE:
                        where[0], where[1] = t, f.station[0, j] * f.scalar[LENGTH]
                        return STEEP if math.isfinite(station[PHI, j]) else NOT_FINITE
                    if not station[TENSION, j] >= least:
                        least, spot = station[TENSION, j], f.station[0, j] * f.scalar[LENGTH]
                where[0], where[1] = t, spot
                if not least > 0.0:
                    return SLACK if math.isfinite(least) else NOT_FINITE
                if abs(t - times[row]) <= 1e-9 * max(1.0, abs(t)):
                    for i in range(nb):
                        out[row, i], out[row, nb + i] = state[i], w[i]
                    out[row, 2 * nb], out[row, 2 * nb + 1], out[row, 2 * nb + 2] = end[T_TOP], end[T_BOTTOM], end[PAID]
                    for i in range(2 + N):
                        shapes[row, i] = cable[Y, i]
                    row += 1
                if row == times.size:
                    return DONE
                if counts[2] + counts[3] >= budget:
                    return BUDGET
                if winch and t >= control_time - 1e-9:
                    steer(control, winch_t, winch_value, t, -state[1], memory)
                    control_time += control[1]
                limit = min(times[row], control_time) if winch else times[row]
                step = limit - t if h >= 0.999 * (limit - t) else h
                for i in range(2 * n):
                    k1[i] = slope[i]
            # One classical step is four slopes; the first of the whole step and of the first half are shared.
            if phase <= 3:
                stage, size, t_0 = phase, step, t
            elif phase <= 6:
                stage, size, t_0 = phase - 3, 0.5 * step, t
            else:
                stage, size, t_0 = phase - 7, 0.5 * step, t + 0.5 * step
            weight = 1.0 if stage == 0 or stage == 3 else 2.0
            for i in range(2 * n):
                total[i] = (0.0 if stage == 0 else total[i]) + weight * slope[i]
            advance, finished = (0.5 if stage < 2 else 1.0) * size, stage == 3
            if finished:
                target_t = t_0
                for i in range(2 * n):
                    base = halves[i] if phase > 6 else state[i]
                    result = base + size / 6.0 * total[i]
                    if phase == 3:
                        whole[i] = result
                    else:
                        halves[i] = result
                if phase == 10:
                    break
                if phase == 3:
                    # The first half starts with the shared slope.
                    advance, target_t = 0.25 * step, t + 0.25 * step
                    for i in range(2 * n):
                        total[i] = k1[i]
                        trial[i] = state[i] + advance * k1[i]
                else:
                    target_t = t + 0.5 * step
                    for i in range(2 * n):
                        trial[i] = halves[i]
            else:
                target_t = t_0 + advance
                for i in range(2 * n):
                    trial[i] = (halves[i] if phase > 6 else state[i]) + advance * slope[i]
            if winch:
                pay_out(control, memory, target_t, end)
            place = ship_at(f, target_t, knots, ship, place, end)
        error = 0.0
        for i in range(n):
            error_w[i] = (halves[n + i] - whole[n + i]) / 15.0
        substitute(A, pivot, error_w)
        for i in range(n):
            error = max(error, abs(error_w[i]))
        error /= tolerance
        if not error <= 1.0:
            counts[3] += 1
            h = step * (max(0.2, 0.9 * error**-0.2) if error < 1e6 else 0.2)
            if h < 1e-10 * (times[-1] - times[0]):
                return NO_CONVERGENCE
            continue
        for i in range(2 * n):
            state[i] = halves[i] + (halves[i] - whole[i]) / 15.0
        t += step
        counts[2] += 1
        h = step * min(4.0, 0.9 * max(error, 1e-4) ** -0.2)
        if abs(t - times[row]) <= 1e-9 * max(1.0, abs(t)):
            t = times[row]
