"""One implicit stage of the chain: Newton's method with an elimination from the free ends up to the ship, O(N).

With X = xh + g V and A = (V - vh)/g a stage solves, at every node and link,

    M_i(X) A_i = loads_i(X, V) - T_i t_i + sum over the links c below T_c t_c,
    |r_i| (1 + p) + tau t_i.(V_i - V_p) - l_i (1 + T_i/EA) = 0   or   T_i = 0 where that would push,

for the velocities V (m, 3) and the tensions T (m,) together, p the small strain by water pressure. The tensions are
the multipliers of Gauss's principle; a rigid link has 1/EA = 0. Both the geometric stiffness T (1 - t t')/|r| and the
change of the drag with the link's direction are in the derivative, so neither the transverse wave nor the tow speed
bounds the step.

Node i and its link leave, in terms of the parent's change dV_p,

    dV_i = v + G dV_p,   dT_i = tau0 + k.dV_p,

and hand their stiffness on to the parent: a tree needs no fill, and its branches cost what a chain costs.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, kernel
from models.link_joint.chain import Chain
from models.link_joint.forces import (
    NEAR,
    Nine,
    Three,
    body_axes,
    current_at,
    directions,
    end_direction,
    end_drag,
    end_velocity,
)

Floats = NDArray[np.float64]
Six = tuple[float, float, float, float, float, float]

#: Newton iterations of one stage before the step is given up.
BUDGET = 25
#: Largest turn of a link in one iteration [rad].
_LARGEST_TURN = 0.7
#: A link's stretch error that Newton's method may leave, over its length.
_CLOSED = 2e-9


class Work(NamedTuple):
    """What the elimination keeps for back-substitution: arrays over nodes (m + 1, ...) and links (m, ...)."""

    K: Floats  # (m + 1, 9) stiffness against dV
    M: Floats  # (m + 1, 9) mass
    F: Floats  # (m + 1, 3) force out of balance
    R: Floats  # (m + 1, 3) what the eliminated nodes below add to it
    inverse: Floats  # (m, 9)
    e: Floats  # (m, 3) K^-1 t
    k: Floats  # (m, 3)
    G: Floats  # (m, 9)
    L: Floats  # (m, 9) node i's stiffness against dV_p
    B: Floats  # (m, 9) the parent's stiffness against dV_i
    t: Floats  # (m, 3)
    size: Floats  # (m,) |r|
    v: Floats  # (m, 3)
    tau0: Floats  # (m,)
    reel: Floats  # (1,) rate at which the ship's link grows by payout [m/s]
    scale: Floats  # (m,) 1/(s + c/sigma), 0 of a slack link
    rho: Floats  # (m,) closure error over sigma


def work_for(nodes: int) -> Work:
    """Arrays for a chain of `nodes` nodes, the ship's included."""
    shapes = {"K": 9, "M": 9, "F": 3, "R": 3, "inverse": 9, "e": 3, "k": 3, "G": 9, "L": 9, "B": 9, "t": 3, "v": 3}
    vectors = {name: np.zeros((nodes, width)) for name, width in shapes.items()}
    numbers = {name: np.zeros(nodes) for name in ("size", "tau0", "scale", "rho")}
    return Work(**vectors, **numbers, reel=np.zeros(1))


@kernel
def assemble(
    c: Chain, n: int, g: float, vh: Floats, X: Floats, V: Floats, T: Floats, w: Work
) -> tuple[float, int, int]:
    """Residuals and derivative at (X, V, T), ship in row n, and the elimination of every node as it is complete.

    `vh` (m, 3) is what the stage's acceleration counts from; w.F and w.M keep the force on each node and its mass.
    Returns the largest closure error of a taut link over its length, how many links are slack, and how many are
    otherwise than at the assembly before.
    """
    K, M, F, R, L, B, t, sizes = w.K, w.M, w.F, w.R, w.L, w.B, w.t, w.size
    parent, part, lengths, compliance, damping = c.parent, c.part, c.length, c.compliance, c.damping
    poisson, area, masses, added, weights = c.poisson, c.area, c.mass, c.added_mass, c.weight
    normal_drag, tangential_drag, has_body, held = c.normal_drag, c.tangential_drag, c.has_body, c.held
    depths, current_x, current_y, law, scales = c.current_depth, c.current_x, c.current_y, c.law, w.scale
    for i in range(n + 1):
        for j in range(9):
            K[i, j] = 0.0
            M[i, j] = 0.0
        for j in range(3):
            F[i, j] = 0.0
            R[i, j] = 0.0
    worst, slack, switched = 0.0, 0, 0
    over_g = 1.0 / g
    directions(parent, n, X, t, sizes)
    for i in range(n):
        p = parent[i]
        l0, size = lengths[i], sizes[i]
        tx, ty, tz = t[i, 0], t[i, 1], t[i, 2]
        rate = tx * (V[i, 0] - V[p, 0]) + ty * (V[i, 1] - V[p, 1]) + tz * (V[i, 2] - V[p, 2])
        if p == n:
            rate -= w.reel[0]
        pressure = 0.0
        if compliance[i] > 0.0:
            depth = -0.5 * (X[i, 2] + X[p, 2])
            pressure = (1.0 - 2.0 * poisson[i]) * c.specific_weight * depth * area[i] * compliance[i]
        slip = compliance[i] * l0
        gap = size - l0 * (1.0 - pressure) + damping[i] * rate - slip * T[i]
        half = 0.5 * l0
        inertia = masses[i] * half
        taut = T[i] + 0.2 * (inertia * over_g * over_g) * gap > 0.0
        if taut and abs(gap) > worst * l0:
            worst = abs(gap) / l0
        if not taut:
            slack += 1
        if taut != (scales[i] > 0.0):
            switched += 1
        # Drag follows the stretched area, (1 + e)(1 - nu e).
        e = size / l0 - 1.0
        swell = 1.0 if compliance[i] == 0.0 or e < 0.0 else (1.0 + e) * (1.0 - poisson[i] * e)
        kn, kt = normal_drag[i] * half * swell, tangential_drag[i] * half * swell
        ma = added[i] * half
        weight = weights[i] * half
        Q = (
            inertia + ma * (1.0 - tx * tx), -ma * tx * ty, -ma * tx * tz,
            inertia + ma * (1.0 - ty * ty), -ma * ty * tz, inertia + ma * (1.0 - tz * tz),
        )  # fmt: skip
        stiff = g * (T[i] if T[i] > 0.0 else 0.0) / size
        P = (
            stiff * (1.0 - tx * tx), -stiff * tx * ty, -stiff * tx * tz,
            stiff * (1.0 - ty * ty), -stiff * ty * tz, stiff * (1.0 - tz * tz),
        )  # fmt: skip
        ex, ey, ez, own = end_direction(part, lengths, n, i, 0, t)
        ux, uy, uz = end_velocity(depths, current_x, current_y, i, p, X, V)
        drag, D, S = end_drag(law, kn, kt, ux, uy, uz, ex, ey, ez, size)
        _add_load(i, i, -T[i], weight, over_g, drag, Q, t, vh, V, F)
        _add_stiffness(i, i, over_g, -own * g, D, S, Q, P, M, K, L)
        if p < n:
            ex, ey, ez, own = end_direction(part, lengths, n, i, 1, t)
            ux, uy, uz = end_velocity(depths, current_x, current_y, p, i, X, V)
            drag, D, S = end_drag(law, kn, kt, ux, uy, uz, ex, ey, ez, size)
            _add_load(p, i, T[i], weight, over_g, drag, Q, t, vh, V, F)
            _add_stiffness(p, i, over_g, own * g, D, S, Q, P, M, K, B)
        if has_body[i]:
            _add_body(
                i, over_g, tx, ty, c.body_mass, c.body_weight, c.body_added_mass, c.body_drag,
                depths, current_x, current_y, vh, X, V, F, M, K,
            )  # fmt: skip
        _eliminate(
            i, p, gap, slip, g + damping[i], taut, held[i], p == n, T[i],
            K, F, R, w.inverse, w.e, w.k, w.G, L, B, t, w.v, w.tau0, scales, w.rho,
        )  # fmt: skip
    return worst, slack, switched


@inline_kernel
def _add_load(
    q: int,
    i: int,
    pull: float,
    weight: float,
    over_g: float,
    drag: Three,
    Q: Six,
    t: Floats,
    vh: Floats,
    V: Floats,
    F: Floats,
) -> None:
    """Force on node q from half of link i: drag, pull, weight, and its mass Q against the acceleration."""
    ax, ay, az = (V[q, 0] - vh[q, 0]) * over_g, (V[q, 1] - vh[q, 1]) * over_g, (V[q, 2] - vh[q, 2]) * over_g
    F[q, 0] += drag[0] - (Q[0] * ax + Q[1] * ay + Q[2] * az) + pull * t[i, 0]
    F[q, 1] += drag[1] - (Q[1] * ax + Q[3] * ay + Q[4] * az) + pull * t[i, 1]
    F[q, 2] += drag[2] - (Q[2] * ax + Q[4] * ay + Q[5] * az) + pull * t[i, 2] - weight


@inline_kernel
def _add_stiffness(
    q: int, i: int, over_g: float, turn: float, D: Nine, S: Nine, Q: Six, P: Six, M: Floats, K: Floats, coupling: Floats
) -> None:
    """Mass and stiffness of node q from half of link i; `coupling` gets what couples it to the other end.

    Q and P are the half link's mass and geometric stiffness, both (xx, xy, xz, yy, yz, zz).
    """
    M[q, 0] += Q[0]
    M[q, 1] += Q[1]
    M[q, 2] += Q[2]
    M[q, 3] += Q[1]
    M[q, 4] += Q[3]
    M[q, 5] += Q[4]
    M[q, 6] += Q[2]
    M[q, 7] += Q[4]
    M[q, 8] += Q[5]
    b0, b1, b2 = P[0] + turn * S[0], P[1] + turn * S[1], P[2] + turn * S[2]
    b3, b4, b5 = P[1] + turn * S[3], P[3] + turn * S[4], P[4] + turn * S[5]
    b6, b7, b8 = P[2] + turn * S[6], P[4] + turn * S[7], P[5] + turn * S[8]
    K[q, 0] += Q[0] * over_g + NEAR * D[0] + b0
    K[q, 1] += Q[1] * over_g + NEAR * D[1] + b1
    K[q, 2] += Q[2] * over_g + NEAR * D[2] + b2
    K[q, 3] += Q[1] * over_g + NEAR * D[3] + b3
    K[q, 4] += Q[3] * over_g + NEAR * D[4] + b4
    K[q, 5] += Q[4] * over_g + NEAR * D[5] + b5
    K[q, 6] += Q[2] * over_g + NEAR * D[6] + b6
    K[q, 7] += Q[4] * over_g + NEAR * D[7] + b7
    K[q, 8] += Q[5] * over_g + NEAR * D[8] + b8
    far = 1.0 - NEAR
    coupling[i, 0], coupling[i, 1], coupling[i, 2] = b0 - far * D[0], b1 - far * D[1], b2 - far * D[2]
    coupling[i, 3], coupling[i, 4], coupling[i, 5] = b3 - far * D[3], b4 - far * D[4], b5 - far * D[5]
    coupling[i, 6], coupling[i, 7], coupling[i, 8] = b6 - far * D[6], b7 - far * D[7], b8 - far * D[8]


@kernel
def _add_body(
    i: int,
    over_g: float,
    tx: float,
    ty: float,
    masses: Floats,
    weights: Floats,
    added: Floats,
    drags: Floats,
    depths: Floats,
    current_x: Floats,
    current_y: Floats,
    vh: Floats,
    X: Floats,
    V: Floats,
    F: Floats,
    M: Floats,
    K: Floats,
) -> None:
    """The body at node i: weight, drag |u| (A_surge, A_sway, A_heave) u and added mass, in its own axes."""
    cx, cy = current_at(depths, current_x, current_y, X[i, 2])
    ux, uy, uz = V[i, 0] - cx, V[i, 1] - cy, V[i, 2]
    ax, ay, az = (V[i, 0] - vh[i, 0]) * over_g, (V[i, 1] - vh[i, 1]) * over_g, (V[i, 2] - vh[i, 2]) * over_g
    m = masses[i]
    mxx, mxy, myy = body_axes(added[i, 0], added[i, 1], tx, ty)
    mzz = m + added[i, 2]
    dxx, dxy, dyy = body_axes(drags[i, 0], drags[i, 1], tx, ty)
    dzz = drags[i, 2]
    speed = math.sqrt(ux * ux + uy * uy + uz * uz)
    wx, wy, wz = dxx * ux + dxy * uy, dxy * ux + dyy * uy, dzz * uz
    F[i, 0] -= speed * wx + (m + mxx) * ax + mxy * ay
    F[i, 1] -= speed * wy + mxy * ax + (m + myy) * ay
    F[i, 2] -= speed * wz + mzz * az + weights[i]
    over = 1.0 / (speed + 1e-12)
    M[i, 0] += m + mxx
    M[i, 1] += mxy
    M[i, 3] += mxy
    M[i, 4] += m + myy
    M[i, 8] += mzz
    K[i, 0] += (m + mxx) * over_g + speed * dxx + over * wx * ux
    K[i, 1] += mxy * over_g + speed * dxy + over * wx * uy
    K[i, 2] += over * wx * uz
    K[i, 3] += mxy * over_g + speed * dxy + over * wy * ux
    K[i, 4] += (m + myy) * over_g + speed * dyy + over * wy * uy
    K[i, 5] += over * wy * uz
    K[i, 6] += over * wz * ux
    K[i, 7] += over * wz * uy
    K[i, 8] += mzz * over_g + speed * dzz + over * wz * uz


@inline_kernel
def _eliminate(
    i: int,
    p: int,
    gap: float,
    slip: float,
    sigma: float,
    taut: bool,
    held: bool,
    last: bool,
    tension: float,
    K: Floats,
    F: Floats,
    R: Floats,
    inverse: Floats,
    e: Floats,
    k: Floats,
    G: Floats,
    L: Floats,
    B: Floats,
    t: Floats,
    v: Floats,
    tau0: Floats,
    scales: Floats,
    rho: Floats,
) -> None:
    """Solve node i and its link for the parent's change, and hand what is left on to the parent."""
    a, b, c, d, f, g, h, m, o = (
        K[i, 0], K[i, 1], K[i, 2], K[i, 3], K[i, 4], K[i, 5], K[i, 6], K[i, 7], K[i, 8],
    )  # fmt: skip
    c1, c2, c3 = f * o - g * m, g * h - d * o, d * m - f * h
    over = 0.0 if held else 1.0 / (a * c1 + b * c2 + c * c3)
    J = (
        c1 * over, (c * m - b * o) * over, (b * g - c * f) * over,
        c2 * over, (a * o - c * h) * over, (c * d - a * g) * over,
        c3 * over, (b * h - a * m) * over, (a * f - b * d) * over,
    )  # fmt: skip
    tx, ty, tz = t[i, 0], t[i, 1], t[i, 2]
    ex, ey, ez = J[0] * tx + J[1] * ty + J[2] * tz, J[3] * tx + J[4] * ty + J[5] * tz, J[6] * tx + J[7] * ty + J[8] * tz
    s = tx * ex + ty * ey + tz * ez
    scale = 1.0 / (s + slip / sigma) if taut else 0.0
    scales[i] = scale
    rho[i] = gap / sigma
    inverse[i, 0], inverse[i, 1], inverse[i, 2] = J[0], J[1], J[2]
    inverse[i, 3], inverse[i, 4], inverse[i, 5] = J[3], J[4], J[5]
    inverse[i, 6], inverse[i, 7], inverse[i, 8] = J[6], J[7], J[8]
    e[i, 0], e[i, 1], e[i, 2] = ex, ey, ez
    # t' K^-1 B_lower, and K^-1 B_lower
    U = (L[i, 0], L[i, 1], L[i, 2], L[i, 3], L[i, 4], L[i, 5], L[i, 6], L[i, 7], L[i, 8])
    h1 = J[0] * U[0] + J[1] * U[3] + J[2] * U[6]
    h2 = J[0] * U[1] + J[1] * U[4] + J[2] * U[7]
    h3 = J[0] * U[2] + J[1] * U[5] + J[2] * U[8]
    h4 = J[3] * U[0] + J[4] * U[3] + J[5] * U[6]
    h5 = J[3] * U[1] + J[4] * U[4] + J[5] * U[7]
    h6 = J[3] * U[2] + J[4] * U[5] + J[5] * U[8]
    h7 = J[6] * U[0] + J[7] * U[3] + J[8] * U[6]
    h8 = J[6] * U[1] + J[7] * U[4] + J[8] * U[7]
    h9 = J[6] * U[2] + J[7] * U[5] + J[8] * U[8]
    kx = scale * (tx * h1 + ty * h4 + tz * h7 - tx)
    ky = scale * (tx * h2 + ty * h5 + tz * h8 - ty)
    kz = scale * (tx * h3 + ty * h6 + tz * h9 - tz)
    k[i, 0], k[i, 1], k[i, 2] = kx, ky, kz
    g1, g2, g3 = h1 - ex * kx, h2 - ex * ky, h3 - ex * kz
    g4, g5, g6 = h4 - ey * kx, h5 - ey * ky, h6 - ey * kz
    g7, g8, g9 = h7 - ez * kx, h8 - ez * ky, h9 - ez * kz
    G[i, 0], G[i, 1], G[i, 2], G[i, 3], G[i, 4], G[i, 5], G[i, 6], G[i, 7], G[i, 8] = g1, g2, g3, g4, g5, g6, g7, g8, g9
    reduce(i, p, last, tension, F, R, inverse, e, B, t, v, tau0, scales, rho)
    if not last:
        U = (B[i, 0], B[i, 1], B[i, 2], B[i, 3], B[i, 4], B[i, 5], B[i, 6], B[i, 7], B[i, 8])
        K[p, 0] -= U[0] * g1 + U[1] * g4 + U[2] * g7 + tx * kx
        K[p, 1] -= U[0] * g2 + U[1] * g5 + U[2] * g8 + tx * ky
        K[p, 2] -= U[0] * g3 + U[1] * g6 + U[2] * g9 + tx * kz
        K[p, 3] -= U[3] * g1 + U[4] * g4 + U[5] * g7 + ty * kx
        K[p, 4] -= U[3] * g2 + U[4] * g5 + U[5] * g8 + ty * ky
        K[p, 5] -= U[3] * g3 + U[4] * g6 + U[5] * g9 + ty * kz
        K[p, 6] -= U[6] * g1 + U[7] * g4 + U[8] * g7 + tz * kx
        K[p, 7] -= U[6] * g2 + U[7] * g5 + U[8] * g8 + tz * ky
        K[p, 8] -= U[6] * g3 + U[7] * g6 + U[8] * g9 + tz * kz


@inline_kernel
def reduce(
    i: int,
    p: int,
    last: bool,
    tension: float,
    F: Floats,
    R: Floats,
    inverse: Floats,
    e: Floats,
    B: Floats,
    t: Floats,
    v: Floats,
    tau0: Floats,
    scales: Floats,
    rho: Floats,
) -> None:
    """The right-hand side's part of the elimination of node i."""
    J = inverse
    x, y, z = F[i, 0] + R[i, 0], F[i, 1] + R[i, 1], F[i, 2] + R[i, 2]
    yx = J[i, 0] * x + J[i, 1] * y + J[i, 2] * z
    yy = J[i, 3] * x + J[i, 4] * y + J[i, 5] * z
    yz = J[i, 6] * x + J[i, 7] * y + J[i, 8] * z
    tx, ty, tz = t[i, 0], t[i, 1], t[i, 2]
    tau = scales[i] * (rho[i] + tx * yx + ty * yy + tz * yz) if scales[i] > 0.0 else -tension
    tau0[i] = tau
    vx, vy, vz = yx - e[i, 0] * tau, yy - e[i, 1] * tau, yz - e[i, 2] * tau
    v[i, 0], v[i, 1], v[i, 2] = vx, vy, vz
    if not last:
        R[p, 0] += B[i, 0] * vx + B[i, 1] * vy + B[i, 2] * vz + tx * tau
        R[p, 1] += B[i, 3] * vx + B[i, 4] * vy + B[i, 5] * vz + ty * tau
        R[p, 2] += B[i, 6] * vx + B[i, 7] * vy + B[i, 8] * vz + tz * tau


@kernel
def substitute(c: Chain, n: int, w: Work, dV: Floats, dT: Floats) -> None:
    """Changes of velocity dV (m + 1, 3) and tension dT (m,), from the ship down."""
    parent, v, G, k, tau0 = c.parent, w.v, w.G, w.k, w.tau0
    dV[n, 0], dV[n, 1], dV[n, 2] = 0.0, 0.0, 0.0
    for j in range(n):
        i = n - 1 - j
        p = parent[i]
        x, y, z = dV[p, 0], dV[p, 1], dV[p, 2]
        dT[i] = tau0[i] + k[i, 0] * x + k[i, 1] * y + k[i, 2] * z
        dV[i, 0] = v[i, 0] + G[i, 0] * x + G[i, 1] * y + G[i, 2] * z
        dV[i, 1] = v[i, 1] + G[i, 3] * x + G[i, 4] * y + G[i, 5] * z
        dV[i, 2] = v[i, 2] + G[i, 6] * x + G[i, 7] * y + G[i, 8] * z


@kernel
def solve_stage(
    c: Chain,
    n: int,
    g: float,
    xh: Floats,
    vh: Floats,
    X: Floats,
    V: Floats,
    T: Floats,
    w: Work,
    dV: Floats,
    dT: Floats,
    accuracy: float,
) -> tuple[int, int, float]:
    """Newton's method from the guess in V and T, ship's place and velocity in row n of X and V.

    Returns iterations (negative where they ended without a solution), the link that is worst off and its closure
    error over its length. `accuracy` [m/s] bounds what is left in the velocities.
    """
    for i in range(n):
        for j in range(3):
            X[i, j] = xh[i, j] + g * V[i, j]
    left = np.inf
    for iteration in range(1, BUDGET + 1):
        worst, slack, switched = assemble(c, n, g, vh, X, V, T, w)
        if iteration > 1 and left <= accuracy and worst <= _CLOSED and switched == 0:
            return iteration - 1, 0, worst
        substitute(c, n, w, dV, dT)
        largest, where, bend, pushing = 0.0, 0, 0.0, False
        for i in range(n):
            move = abs(dV[i, 0]) + abs(dV[i, 1]) + abs(dV[i, 2])
            if not move <= largest:
                largest, where = move, i
            bend = max(bend, g * move / c.length[i])
        if not largest < 1e6:
            return -iteration, where, largest
        # Far from the solution a link turns by no more than this at a time.
        share = min(1.0, _LARGEST_TURN / bend) if bend > 0.0 else 1.0
        for i in range(n):
            for j in range(3):
                V[i, j] += share * dV[i, j]
                X[i, j] = xh[i, j] + g * V[i, j]
            T[i] += share * dT[i]
            pushing = pushing or T[i] < 0.0
        # Newton's error after this change is its square: the turn of a link, and its closure half that squared.
        left = 2.0 * largest * bend
        # With a link slack, or about to be, who is slack is looked at once more.
        if left <= accuracy and bend * bend <= _CLOSED and slack == 0 and not pushing:
            return iteration, 0, bend * bend
    return -BUDGET, where, worst
