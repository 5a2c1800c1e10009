"""The whole system at the level that is stepped: body and sines, their momentum, force and stage matrix.

u = (body coordinates, Q_1 ... Q_N), w = u', pi the generalised momentum and F the generalised force, pi' = F. The
cable's end follows the body (`body.end_motion`); its force and momentum come back through the transposed Jacobian.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import fast_kernel, inline_kernel, kernel
from models.spectral.basis import FLOW_0, MEAN_STRAIN, SHEAR_0, TANGENT_X, TANGENT_Z, TOP_X, TOP_Z, Fields
from models.spectral.body import bear, body_balance, couple, end_motion
from models.spectral.forces import cable_forces
from models.spectral.matrix import cable_matrix, cable_momentum
from models.spectral.workspace import (
    CABLE_ROWS,
    ETA_2,
    ETA_2_RATE,
    FORCE,
    LEVER,
    MOMENTUM,
    P_TOP,
    P_TOP_CHANGE,
    P_TOP_RATE,
    PAID,
    PAID_CHANGE,
    PAID_RATE,
    SPIN,
    V,
    Y,
)

Floats = NDArray[np.float64]

#: How a run ended: status codes of the steppers.
DONE, SLACK, NO_CONVERGENCE, BUDGET, NOT_FINITE, STEEP = range(6)
#: Largest deflection from the static shape that counts as small [rad].
LARGEST_ANGLE = 1.2


@kernel
def ship_at(f: Fields, t: float, knots: Floats, ship: Floats, place: int, end: Floats) -> int:
    """Fill `end` with the tow point's deflection, its rate and its acceleration along the cable there.

    `ship` (4, m, 2) are the coefficients of the cubic splines of the ship's x and z, counted from the steadily
    towed frame; returns the knot interval, where the next search starts.
    """
    last = knots.size - 2
    while place < last and t >= knots[place + 1]:
        place += 1
    while place > 0 and t < knots[place]:
        place -= 1
    d = t - knots[place]
    x = ((ship[0, place, 0] * d + ship[1, place, 0]) * d + ship[2, place, 0]) * d + ship[3, place, 0]
    z = ((ship[0, place, 1] * d + ship[1, place, 1]) * d + ship[2, place, 1]) * d + ship[3, place, 1]
    vx = (3.0 * ship[0, place, 0] * d + 2.0 * ship[1, place, 0]) * d + ship[2, place, 0]
    vz = (3.0 * ship[0, place, 1] * d + 2.0 * ship[1, place, 1]) * d + ship[2, place, 1]
    ax = 6.0 * ship[0, place, 0] * d + 2.0 * ship[1, place, 0]
    az = 6.0 * ship[0, place, 1] * d + 2.0 * ship[1, place, 1]
    top_x, top_z = f.scalar[TOP_X], f.scalar[TOP_Z]
    stretched = 1.0 + f.scalar[MEAN_STRAIN]
    end[P_TOP] = top_x * x + top_z * z - stretched * end[PAID]
    end[P_TOP_RATE] = top_x * vx + top_z * vz - stretched * end[PAID_RATE]
    end[P_TOP_CHANGE] = top_x * ax + top_z * az - stretched * end[PAID_CHANGE]
    end[ETA_2] = -top_z * x + top_x * z
    end[ETA_2_RATE] = -top_z * vx + top_x * vz
    return place


@inline_kernel
def evaluate(
    f: Fields, u: Floats, w: Floats, end: Floats, pi: Floats, F: Floats, cable: Floats, station: Floats
) -> None:
    """Fill momentum and force at the level of the body and the sines; `cable` (CABLE_ROWS, 2 + N) is a workspace."""
    N = f.sines.shape[1]
    nb = u.size - N
    end_motion(f, u, w, cable)
    for i in range(N):
        cable[Y, 2 + i], cable[V, 2 + i] = u[nb + i], w[nb + i]
    body_balance(f, u, w, pi, F)
    bear(f, u, w, F, cable, end)
    cable_forces(f, cable[Y], cable[V], end, cable[FORCE], station)
    cable_momentum(f, cable[V], end, cable[MOMENTUM])
    couple(f, cable, pi, F)
    for i in range(N):
        pi[nb + i], F[nb + i] = cable[MOMENTUM, 2 + i], cable[FORCE, 2 + i]


@inline_kernel
def momentum(f: Fields, u: Floats, w: Floats, end: Floats, pi: Floats, F: Floats, cable: Floats) -> None:
    """The momentum of `evaluate` alone; keeps the cable's coordinates, and leaves nothing of use in F[:3]."""
    N = f.sines.shape[1]
    nb = u.size - N
    end_motion(f, u, w, cable)
    for i in range(N):
        cable[Y, 2 + i], cable[V, 2 + i] = u[nb + i], w[nb + i]
    cable_momentum(f, cable[V], end, cable[MOMENTUM])
    body_balance(f, u, w, pi, F)
    couple(f, cable, pi, F)
    for i in range(N):
        pi[nb + i] = cable[MOMENTUM, 2 + i]


@kernel
def stage_matrix(
    f: Fields, u: Floats, w: Floats, end: Floats, gh: float, cable: Floats, station: Floats, A: Floats, Y: Floats
) -> None:
    """Fill A with d(pi - gh F)/dw at a state that `evaluate` has just visited.

    Y (2 + N + SUM_ROWS, 2 N + 1) is workspace: the matrix of the cable, and the sums of `cable_matrix`.
    """
    N = f.sines.shape[1]
    nb = u.size - N
    cable_matrix(f, end, gh, station, Y[2 + N :], Y)
    t_x, t_z = f.scalar[TANGENT_X], f.scalar[TANGENT_Z]
    for i in range(nb):
        # d(p_b, eta_1) over the body's coordinate i.
        a, b = (t_x, -t_z) if i == 0 else ((t_z, t_x) if i == 1 else (cable[LEVER, 0], cable[LEVER, 1]))
        for k in range(nb):
            c, d = (t_x, -t_z) if k == 0 else ((t_z, t_x) if k == 1 else (cable[LEVER, 0], cable[LEVER, 1]))
            A[i, k] = a * (Y[0, 0] * c + Y[0, 1] * d) + b * (Y[1, 0] * c + Y[1, 1] * d)
        for n in range(N):
            A[i, nb + n] = a * Y[0, 2 + n] + b * Y[1, 2 + n]
            A[nb + n, i] = Y[2 + n, 0] * a + Y[2 + n, 1] * b
    for m in range(N):
        for n in range(N):
            A[nb + m, nb + n] = Y[2 + m, 2 + n]
    if nb == 2:
        # Point: d/dw of m w + gh k |r| r, r the velocity through the water, which the depth changes in a shear.
        x, z = w[0] - f.scalar[FLOW_0] - f.scalar[SHEAR_0] * u[1], w[1]
        speed = math.sqrt(x * x + z * z)
        over = 1.0 / speed if speed > 0.0 else 0.0
        drag, sheared = gh * f.body[1], gh * f.scalar[SHEAR_0]
        xx, xz, zz = drag * (speed + x * x * over), drag * x * z * over, drag * (speed + z * z * over)
        A[0, 0] += f.body[0] + xx
        A[0, 1] += xz - sheared * xx
        A[1, 0] += xz
        A[1, 1] += f.body[0] + zz - sheared * xz
        return
    _add_towfish(f, u, w, gh, cable, A)


@kernel
def _add_towfish(f: Fields, u: Floats, w: Floats, gh: float, cable: Floats, A: Floats) -> None:
    """The towfish's own part of `stage_matrix` by differences, with the cable's end force and momentum held."""
    nb, d = 3, 1e-6
    pi0, F0, pi1, F1 = np.zeros(nb), np.zeros(nb), np.zeros(nb), np.zeros(nb)
    b, s, held = u[:nb].copy(), w[:nb].copy(), np.zeros((CABLE_ROWS, 3))
    for i in range(2):
        held[FORCE, i], held[LEVER, i], held[SPIN, i] = cable[FORCE, i], cable[LEVER, i], cable[SPIN, i]
    body_balance(f, b, s, pi0, F0)
    couple(f, held, pi0, F0)
    for k in range(nb):
        s[k] += d
        b[k] += gh * d
        end_motion(f, b, s, held)
        body_balance(f, b, s, pi1, F1)
        couple(f, held, pi1, F1)
        for i in range(nb):
            A[i, k] += ((pi1[i] - pi0[i]) - gh * (F1[i] - F0[i])) / d
        s[k] -= d
        b[k] -= gh * d


@fast_kernel
def factor(A: Floats, pivot: NDArray[np.int64]) -> bool:
    """LU factors of A in place with row exchanges; False where A is singular."""
    n = A.shape[0]
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[best, k]):
                best = i
        pivot[k] = best
        if not abs(A[best, k]) > 0.0:
            return False
        if best != k:
            for j in range(n):
                A[k, j], A[best, j] = A[best, j], A[k, j]
        inverse = 1.0 / A[k, k]
        for i in range(k + 1, n):
            A[i, k] *= inverse
            m = A[i, k]
            if m != 0.0:
                for j in range(k + 1, n):
                    A[i, j] -= m * A[k, j]
    return True


@fast_kernel
def substitute(A: Floats, pivot: NDArray[np.int64], r: Floats) -> None:
    """Solve with the factors of `factor`, r in place."""
    n = A.shape[0]
    for k in range(n):
        p = pivot[k]
        r[k], r[p] = r[p], r[k]
    for i in range(n):
        total = r[i]
        for j in range(i):
            total -= A[i, j] * r[j]
        r[i] = total
    for i in range(n - 1, -1, -1):
        total = r[i]
        for j in range(i + 1, n):
            total -= A[i, j] * r[j]
        r[i] = total / A[i, i]
