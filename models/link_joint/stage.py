"""One implicit stage of the chain: Newton's method with an elimination from the free ends up to the ship, O(N).

With X = xh + g V and A = (V - vh)/g a stage solves, at every node and link,

    M_i(X) A_i = loads_i(X, V) - T_i t_i + sum over the links c below T_c t_c,
    |r_i| - l_i (1 - p + T_i/EA) + tau t_i.(V_i - V_p) = 0   or   T_i = 0 where that would push,

for the velocities V (m, 3) and the tensions T (m,) together, p the small strain by water pressure. The tensions are
the multipliers of Gauss's principle; a rigid link has 1/EA = 0. Both the geometric stiffness T (1 - t t')/|r| and the
change of the drag with the link's own direction are in the derivative, so neither the transverse wave nor the tow
speed bounds the step. What the derivative leaves out, the neighbours' share in the tangent at a third of a link, the
shear of the current and the heading of a body, costs an iteration at the most.

Node i and its link leave, in terms of the parent's change dV_p,

    dV_i = v + G dV_p,   dT_i = tau0 + k.dV_p,

and hand their stiffness on to the parent: a tree needs no fill, and its branches cost what a chain costs.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, inner_kernel
from models.link_joint import columns as col
from models.link_joint.chain import Chain
from models.link_joint.forces import FAR, NEAR, Nine, body_axes, current_at, directions, end_drag, water_at

Floats = NDArray[np.float64]
Six = tuple[float, float, float, float, float, float]

#: Newton iterations of one stage before the step is given up.
BUDGET = 25
#: Largest turn of a link in one iteration [rad].
_LARGEST_TURN = 0.7
#: A link's stretch error that Newton's method may leave, over its length.
_CLOSED = 2e-9


class Work(NamedTuple):
    """What a stage knows, (m + 1, WIDTH) in the columns of `models.link_joint.columns`."""

    W: Floats
    reel: Floats  # (1,) rate at which the ship's link grows by payout [m/s]


def work_for(nodes: int) -> Work:
    """Arrays for a chain of `nodes` nodes, the ship's included."""
    return Work(W=np.zeros((nodes, col.WIDTH)), reel=np.zeros(1))


@inner_kernel
def assemble(
    c: Chain, n: int, g: float, vh: Floats, X: Floats, V: Floats, T: Floats, w: Work
) -> tuple[float, int, int]:
    """Residuals and derivative at (X, V, T), ship in row n, and the elimination of every node as it is complete.

    `vh` (m, 3) is what the stage's acceleration counts from; w.F and w.M keep the force on each node and its mass.
    Returns the largest closure error of a taut link over its length, how many links are slack, and how many are
    otherwise than at the assembly before.
    """
    W, reel = w.W, w.reel[0]
    parent, part, lengths, compliance, damping = c.parent, c.part, c.length, c.compliance, c.damping
    poisson, area, masses, added, weights = c.poisson, c.area, c.mass, c.added_mass, c.weight
    normal_drag, tangential_drag, has_body, held = c.normal_drag, c.tangential_drag, c.has_body, c.held
    depths, current_x, current_y, law, heavy = c.current_depth, c.current_x, c.current_y, c.law, c.specific_weight
    still = depths.size == 0
    for i in range(n + 1):
        for j in range(col.INVERSE):
            W[i, j] = 0.0
    worst, slack, switched = 0.0, 0, 0
    over_g = 1.0 / g
    directions(part, parent, lengths, n, X, W)
    for i in range(n):
        p = parent[i]
        l0, size = lengths[i], W[i, col.SIZE]
        tx, ty, tz = W[i, col.TANGENT], W[i, col.TANGENT + 1], W[i, col.TANGENT + 2]
        rate = tx * (V[i, 0] - V[p, 0]) + ty * (V[i, 1] - V[p, 1]) + tz * (V[i, 2] - V[p, 2])
        if p == n:
            rate -= reel
        pressure = 0.0
        if compliance[i] > 0.0:
            depth = -0.5 * (X[i, 2] + X[p, 2])
            pressure = (1.0 - 2.0 * poisson[i]) * heavy * depth * area[i] * compliance[i]
        slip = compliance[i] * l0
        gap = size - l0 * (1.0 - pressure) + damping[i] * rate - slip * T[i]
        half = 0.5 * l0
        inertia = masses[i] * half
        taut = T[i] + 0.2 * (inertia * over_g * over_g) * gap > 0.0
        if taut and abs(gap) > worst * l0:
            worst = abs(gap) / l0
        if not taut:
            slack += 1
        if taut != (W[i, col.SCALE] > 0.0):
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
        for end in range(1 if p == n else 2):
            q, o, at, to, sign = (i, p, col.LOWER, col.L, -1.0) if end == 0 else (p, i, col.UPPER, col.B, 1.0)
            ux = NEAR * V[q, 0] + FAR * V[o, 0]
            uy = NEAR * V[q, 1] + FAR * V[o, 1]
            uz = NEAR * V[q, 2] + FAR * V[o, 2]
            if not still:
                cx, cy = water_at(depths, current_x, current_y, X[q, 2], X[o, 2])
                ux -= cx
                uy -= cy
            drag, D, S = end_drag(law, kn, kt, ux, uy, uz, W[i, at], W[i, at + 1], W[i, at + 2], size)
            ax, ay, az = (V[q, 0] - vh[q, 0]) * over_g, (V[q, 1] - vh[q, 1]) * over_g, (V[q, 2] - vh[q, 2]) * over_g
            pull = sign * T[i]
            W[q, col.F] += drag[0] - (Q[0] * ax + Q[1] * ay + Q[2] * az) + pull * tx
            W[q, col.F + 1] += drag[1] - (Q[1] * ax + Q[3] * ay + Q[4] * az) + pull * ty
            W[q, col.F + 2] += drag[2] - (Q[2] * ax + Q[4] * ay + Q[5] * az) + pull * tz - weight
            _add_stiffness(q, i, over_g, sign * W[i, at + 3] * g, D, S, Q, P, W, to)
        if has_body[i]:
            cx, cy = (0.0, 0.0) if still else current_at(depths, current_x, current_y, X[i, 2])
            _add_body(i, over_g, cx, cy, c.body_mass, c.body_weight, c.body_added_mass, c.body_drag, vh, V, W)
        _eliminate(i, p, gap, slip, g + damping[i], taut, held[i], p == n, T[i], W)
    return worst, slack, switched


@inline_kernel
def _add_stiffness(
    q: int, i: int, over_g: float, turn: float, D: Nine, S: Nine, Q: Six, P: Six, W: Floats, to: int
) -> None:
    """Mass and stiffness of node q from half of link i, and in the columns from `to` what couples it to the other end.

    Q and P are the half link's mass and geometric stiffness, both (xx, xy, xz, yy, yz, zz).
    """
    W[q, col.M] += Q[0]
    W[q, col.M + 1] += Q[1]
    W[q, col.M + 2] += Q[2]
    W[q, col.M + 3] += Q[1]
    W[q, col.M + 4] += Q[3]
    W[q, col.M + 5] += Q[4]
    W[q, col.M + 6] += Q[2]
    W[q, col.M + 7] += Q[4]
    W[q, col.M + 8] += Q[5]
    b0, b1, b2 = P[0] + turn * S[0], P[1] + turn * S[1], P[2] + turn * S[2]
    b3, b4, b5 = P[1] + turn * S[3], P[3] + turn * S[4], P[4] + turn * S[5]
    b6, b7, b8 = P[2] + turn * S[6], P[4] + turn * S[7], P[5] + turn * S[8]
    W[q, col.K] += Q[0] * over_g + NEAR * D[0] + b0
    W[q, col.K + 1] += Q[1] * over_g + NEAR * D[1] + b1
    W[q, col.K + 2] += Q[2] * over_g + NEAR * D[2] + b2
    W[q, col.K + 3] += Q[1] * over_g + NEAR * D[3] + b3
    W[q, col.K + 4] += Q[3] * over_g + NEAR * D[4] + b4
    W[q, col.K + 5] += Q[4] * over_g + NEAR * D[5] + b5
    W[q, col.K + 6] += Q[2] * over_g + NEAR * D[6] + b6
    W[q, col.K + 7] += Q[4] * over_g + NEAR * D[7] + b7
    W[q, col.K + 8] += Q[5] * over_g + NEAR * D[8] + b8
    W[i, to], W[i, to + 1], W[i, to + 2] = b0 - FAR * D[0], b1 - FAR * D[1], b2 - FAR * D[2]
    W[i, to + 3], W[i, to + 4], W[i, to + 5] = b3 - FAR * D[3], b4 - FAR * D[4], b5 - FAR * D[5]
    W[i, to + 6], W[i, to + 7], W[i, to + 8] = b6 - FAR * D[6], b7 - FAR * D[7], b8 - FAR * D[8]


@inner_kernel
def _add_body(
    i: int,
    over_g: float,
    cx: float,
    cy: float,
    masses: Floats,
    weights: Floats,
    added: Floats,
    drags: Floats,
    vh: Floats,
    V: Floats,
    W: Floats,
) -> None:
    """The body at node i: weight, drag |u| (A_surge, A_sway, A_heave) u and added mass, in its own axes."""
    tx, ty = W[i, col.TANGENT], W[i, col.TANGENT + 1]
    ux, uy, uz = V[i, 0] - cx, V[i, 1] - cy, V[i, 2]
    ax, ay, az = (V[i, 0] - vh[i, 0]) * over_g, (V[i, 1] - vh[i, 1]) * over_g, (V[i, 2] - vh[i, 2]) * over_g
    m = masses[i]
    mxx, mxy, myy = body_axes(added[i, 0], added[i, 1], tx, ty)
    mzz = m + added[i, 2]
    dxx, dxy, dyy = body_axes(drags[i, 0], drags[i, 1], tx, ty)
    dzz = drags[i, 2]
    speed = math.sqrt(ux * ux + uy * uy + uz * uz)
    wx, wy, wz = dxx * ux + dxy * uy, dxy * ux + dyy * uy, dzz * uz
    W[i, col.F] -= speed * wx + (m + mxx) * ax + mxy * ay
    W[i, col.F + 1] -= speed * wy + mxy * ax + (m + myy) * ay
    W[i, col.F + 2] -= speed * wz + mzz * az + weights[i]
    over = 1.0 / (speed + 1e-12)
    W[i, col.M] += m + mxx
    W[i, col.M + 1] += mxy
    W[i, col.M + 3] += mxy
    W[i, col.M + 4] += m + myy
    W[i, col.M + 8] += mzz
    W[i, col.K] += (m + mxx) * over_g + speed * dxx + over * wx * ux
    W[i, col.K + 1] += mxy * over_g + speed * dxy + over * wx * uy
    W[i, col.K + 2] += over * wx * uz
    W[i, col.K + 3] += mxy * over_g + speed * dxy + over * wy * ux
    W[i, col.K + 4] += (m + myy) * over_g + speed * dyy + over * wy * uy
    W[i, col.K + 5] += over * wy * uz
    W[i, col.K + 6] += over * wz * ux
    W[i, col.K + 7] += over * wz * uy
    W[i, col.K + 8] += mzz * over_g + speed * dzz + over * wz * uz


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
    W: Floats,
) -> None:
    """Solve node i and its link for the parent's change, and hand what is left on to the parent."""
    a, b, c = W[i, col.K], W[i, col.K + 1], W[i, col.K + 2]
    d, f, g = W[i, col.K + 3], W[i, col.K + 4], W[i, col.K + 5]
    h, m, o = W[i, col.K + 6], W[i, col.K + 7], W[i, col.K + 8]
    c1, c2, c3 = f * o - g * m, g * h - d * o, d * m - f * h
    over = 0.0 if held else 1.0 / (a * c1 + b * c2 + c * c3)
    J = (
        c1 * over, (c * m - b * o) * over, (b * g - c * f) * over,
        c2 * over, (a * o - c * h) * over, (c * d - a * g) * over,
        c3 * over, (b * h - a * m) * over, (a * f - b * d) * over,
    )  # fmt: skip
    tx, ty, tz = W[i, col.TANGENT], W[i, col.TANGENT + 1], W[i, col.TANGENT + 2]
    ex, ey, ez = J[0] * tx + J[1] * ty + J[2] * tz, J[3] * tx + J[4] * ty + J[5] * tz, J[6] * tx + J[7] * ty + J[8] * tz
    s = tx * ex + ty * ey + tz * ez
    scale = 1.0 / (s + slip / sigma) if taut else 0.0
    W[i, col.SCALE] = scale
    W[i, col.RHO] = gap / sigma
    W[i, col.INVERSE], W[i, col.INVERSE + 1], W[i, col.INVERSE + 2] = J[0], J[1], J[2]
    W[i, col.INVERSE + 3], W[i, col.INVERSE + 4], W[i, col.INVERSE + 5] = J[3], J[4], J[5]
    W[i, col.INVERSE + 6], W[i, col.INVERSE + 7], W[i, col.INVERSE + 8] = J[6], J[7], J[8]
    W[i, col.E], W[i, col.E + 1], W[i, col.E + 2] = ex, ey, ez
    # t' K^-1 B_lower, and K^-1 B_lower
    U = (
        W[i, col.L],
        W[i, col.L + 1],
        W[i, col.L + 2],
        W[i, col.L + 3],
        W[i, col.L + 4],
        W[i, col.L + 5],
        W[i, col.L + 6],
        W[i, col.L + 7],
        W[i, col.L + 8],
    )
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
    W[i, col.KAPPA], W[i, col.KAPPA + 1], W[i, col.KAPPA + 2] = kx, ky, kz
    g1, g2, g3 = h1 - ex * kx, h2 - ex * ky, h3 - ex * kz
    g4, g5, g6 = h4 - ey * kx, h5 - ey * ky, h6 - ey * kz
    g7, g8, g9 = h7 - ez * kx, h8 - ez * ky, h9 - ez * kz
    (
        W[i, col.G],
        W[i, col.G + 1],
        W[i, col.G + 2],
        W[i, col.G + 3],
        W[i, col.G + 4],
        W[i, col.G + 5],
        W[i, col.G + 6],
        W[i, col.G + 7],
        W[i, col.G + 8],
    ) = g1, g2, g3, g4, g5, g6, g7, g8, g9
    reduce(i, p, last, tension, W)
    if not last:
        U = (
            W[i, col.B],
            W[i, col.B + 1],
            W[i, col.B + 2],
            W[i, col.B + 3],
            W[i, col.B + 4],
            W[i, col.B + 5],
            W[i, col.B + 6],
            W[i, col.B + 7],
            W[i, col.B + 8],
        )
        W[p, col.K] -= U[0] * g1 + U[1] * g4 + U[2] * g7 + tx * kx
        W[p, col.K + 1] -= U[0] * g2 + U[1] * g5 + U[2] * g8 + tx * ky
        W[p, col.K + 2] -= U[0] * g3 + U[1] * g6 + U[2] * g9 + tx * kz
        W[p, col.K + 3] -= U[3] * g1 + U[4] * g4 + U[5] * g7 + ty * kx
        W[p, col.K + 4] -= U[3] * g2 + U[4] * g5 + U[5] * g8 + ty * ky
        W[p, col.K + 5] -= U[3] * g3 + U[4] * g6 + U[5] * g9 + ty * kz
        W[p, col.K + 6] -= U[6] * g1 + U[7] * g4 + U[8] * g7 + tz * kx
        W[p, col.K + 7] -= U[6] * g2 + U[7] * g5 + U[8] * g8 + tz * ky
        W[p, col.K + 8] -= U[6] * g3 + U[7] * g6 + U[8] * g9 + tz * kz


@inline_kernel
def reduce(i: int, p: int, last: bool, tension: float, W: Floats) -> None:
    """The right-hand side's part of the elimination of node i."""
    x, y, z = W[i, col.F] + W[i, col.R], W[i, col.F + 1] + W[i, col.R + 1], W[i, col.F + 2] + W[i, col.R + 2]
    yx = W[i, col.INVERSE] * x + W[i, col.INVERSE + 1] * y + W[i, col.INVERSE + 2] * z
    yy = W[i, col.INVERSE + 3] * x + W[i, col.INVERSE + 4] * y + W[i, col.INVERSE + 5] * z
    yz = W[i, col.INVERSE + 6] * x + W[i, col.INVERSE + 7] * y + W[i, col.INVERSE + 8] * z
    tx, ty, tz = W[i, col.TANGENT], W[i, col.TANGENT + 1], W[i, col.TANGENT + 2]
    tau = W[i, col.SCALE] * (W[i, col.RHO] + tx * yx + ty * yy + tz * yz) if W[i, col.SCALE] > 0.0 else -tension
    W[i, col.TAU] = tau
    vx, vy, vz = yx - W[i, col.E] * tau, yy - W[i, col.E + 1] * tau, yz - W[i, col.E + 2] * tau
    W[i, col.V], W[i, col.V + 1], W[i, col.V + 2] = vx, vy, vz
    if not last:
        W[p, col.R] += W[i, col.B] * vx + W[i, col.B + 1] * vy + W[i, col.B + 2] * vz + tx * tau
        W[p, col.R + 1] += W[i, col.B + 3] * vx + W[i, col.B + 4] * vy + W[i, col.B + 5] * vz + ty * tau
        W[p, col.R + 2] += W[i, col.B + 6] * vx + W[i, col.B + 7] * vy + W[i, col.B + 8] * vz + tz * tau


@inner_kernel
def substitute(c: Chain, n: int, w: Work, dV: Floats, dT: Floats) -> None:
    """Changes of velocity dV (m + 1, 3) and tension dT (m,), from the ship down."""
    parent, W = c.parent, w.W
    dV[n, 0], dV[n, 1], dV[n, 2] = 0.0, 0.0, 0.0
    for j in range(n):
        i = n - 1 - j
        p = parent[i]
        x, y, z = dV[p, 0], dV[p, 1], dV[p, 2]
        dT[i] = W[i, col.TAU] + W[i, col.KAPPA] * x + W[i, col.KAPPA + 1] * y + W[i, col.KAPPA + 2] * z
        dV[i, 0] = W[i, col.V] + W[i, col.G] * x + W[i, col.G + 1] * y + W[i, col.G + 2] * z
        dV[i, 1] = W[i, col.V + 1] + W[i, col.G + 3] * x + W[i, col.G + 4] * y + W[i, col.G + 5] * z
        dV[i, 2] = W[i, col.V + 2] + W[i, col.G + 6] * x + W[i, col.G + 7] * y + W[i, col.G + 8] * z


@inner_kernel
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
