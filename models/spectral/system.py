"""The whole system at the level that is stepped: body and sines, their momentum, force and stage matrix.

u = (body coordinates, Q_1 ... Q_N), w = u', pi the generalised momentum and F the generalised force, pi' = F. The
cable's end follows the body (`body.end_motion`); its force and momentum come back through the transposed Jacobian.
"""

import numpy as np
from numpy.typing import NDArray

from models.kernels import fast_kernel, kernel
from models.spectral.basis import MEAN_STRAIN, TANGENT_X, TANGENT_Z, TOP_X, TOP_Z, Fields
from models.spectral.body import body_balance, couple, end_motion
from models.spectral.forces import cable_forces, cable_matrix, cable_momentum

Floats = NDArray[np.float64]

#: How a run ended: status codes of the steppers.
DONE, SLACK, NO_CONVERGENCE, BUDGET, NOT_FINITE = range(5)


@kernel
def ship_at(f: Fields, t: float, knots: Floats, ship: Floats, place: int, end: Floats) -> int:
    """Fill end[:4] with the tow point's deflection and its rate in the static frame there.

    `ship` (4, m, 2) are the coefficients of the cubic splines of the ship's x and z, counted from the steadily
    towed frame; returns the knot interval, where the next search starts.
    """
    last = knots.size - 2
    while place < last and t >= knots[place + 1]:
        place += 1
    while place > 0 and t < knots[place]:
        place -= 1
    d = t - knots[place]
    a, b, c, e = ship[0, place], ship[1, place], ship[2, place], ship[3, place]
    x = ((a[0] * d + b[0]) * d + c[0]) * d + e[0]
    z = ((a[1] * d + b[1]) * d + c[1]) * d + e[1]
    vx = (3.0 * a[0] * d + 2.0 * b[0]) * d + c[0]
    vz = (3.0 * a[1] * d + 2.0 * b[1]) * d + c[1]
    top_x, top_z = f.scalar[TOP_X], f.scalar[TOP_Z]
    stretched = 1.0 + f.scalar[MEAN_STRAIN]
    end[0] = top_x * x + top_z * z - stretched * end[4]
    end[1] = top_x * vx + top_z * vz - stretched * end[5]
    end[2] = -top_z * x + top_x * z
    end[3] = -top_z * vx + top_x * vz
    return place


@kernel
def evaluate(
    f: Fields, u: Floats, w: Floats, end: Floats, pi: Floats, F: Floats, cable: Floats, station: Floats
) -> None:
    """Fill momentum and force at the level of the body and the sines.

    `cable` (7, 2 + N) is a workspace: y, v, momentum, force, gradient of the stretch, lever, spin.
    """
    nb = u.size - f.sines.shape[1]
    y, v, cable_pi, cable_F, grad = cable[0], cable[1], cable[2], cable[3], cable[4]
    lever, spin = cable[5, :2], cable[6, :2]
    end_motion(f, u[:nb], w[:nb], y, v, lever, spin)
    for i in range(nb, u.size):
        y[2 + i - nb], v[2 + i - nb] = u[i], w[i]
    cable_forces(f, y, v, end, cable_F, station, grad)
    cable_momentum(f, v, end, cable_pi)
    body_balance(f, u[:nb], w[:nb], pi[:nb], F[:nb])
    couple(f, lever, spin, cable_pi, cable_F, pi[:nb], F[:nb])
    for i in range(nb, u.size):
        pi[i], F[i] = cable_pi[2 + i - nb], cable_F[2 + i - nb]


@kernel
def momentum(f: Fields, u: Floats, w: Floats, end: Floats, pi: Floats, cable: Floats) -> None:
    """The momentum of `evaluate` alone; keeps cable[0] at the new coordinates."""
    nb = u.size - f.sines.shape[1]
    y, v, cable_pi = cable[0], cable[1], cable[2]
    lever, spin, none = cable[5, :2], cable[6, :2], np.zeros(2)
    end_motion(f, u[:nb], w[:nb], y, v, lever, spin)
    for i in range(nb, u.size):
        y[2 + i - nb], v[2 + i - nb] = u[i], w[i]
    cable_momentum(f, v, end, cable_pi)
    unused = np.zeros(nb)
    body_balance(f, u[:nb], w[:nb], pi[:nb], unused)
    couple(f, lever, spin, cable_pi, none, pi[:nb], unused)
    for i in range(nb, u.size):
        pi[i] = cable_pi[2 + i - nb]


@kernel
def stage_matrix(
    f: Fields, u: Floats, w: Floats, end: Floats, gh: float, cable: Floats, station: Floats, A: Floats, Y: Floats
) -> None:
    """Fill A with d(pi - gh F)/dw at a state that `evaluate` has just visited; Y (2 + N, 2 + N) is workspace."""
    N = f.sines.shape[1]
    nb = u.size - N
    cable_matrix(f, end, gh, station, cable[4], Y)
    J = np.zeros((2, nb))
    J[0, 0], J[0, 1] = f.scalar[TANGENT_X], f.scalar[TANGENT_Z]
    J[1, 0], J[1, 1] = -f.scalar[TANGENT_Z], f.scalar[TANGENT_X]
    if nb == 3:
        J[0, 2], J[1, 2] = cable[5, 0], cable[5, 1]
    for i in range(nb):
        for k in range(nb):
            total = 0.0
            for a in range(2):
                for c in range(2):
                    total += J[a, i] * Y[a, c] * J[c, k]
            A[i, k] = total
        for n in range(N):
            A[i, nb + n] = J[0, i] * Y[0, 2 + n] + J[1, i] * Y[1, 2 + n]
            A[nb + n, i] = Y[2 + n, 0] * J[0, i] + Y[2 + n, 1] * J[1, i]
    for m in range(N):
        for n in range(N):
            A[nb + m, nb + n] = Y[2 + m, 2 + n]
    # The body's own part by differences, with the cable's end force and momentum held: 2 or 3 columns.
    pi0, F0, pi1, F1 = np.zeros(nb), np.zeros(nb), np.zeros(nb), np.zeros(nb)
    b, s = u[:nb].copy(), w[:nb].copy()
    y, v, lever, spin = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2)
    held_pi, held_F = np.zeros(2), cable[3, :2].copy()
    body_balance(f, b, s, pi0, F0)
    couple(f, cable[5, :2], cable[6, :2], held_pi, held_F, pi0, F0)
    for k in range(nb):
        d = 1e-6
        s[k] += d
        b[k] += gh * d
        end_motion(f, b, s, y, v, lever, spin)
        body_balance(f, b, s, pi1, F1)
        couple(f, lever, spin, held_pi, held_F, pi1, F1)
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
