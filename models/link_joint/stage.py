"""One implicit stage of the chain: Newton's method with an elimination from the free ends up to the ship, O(N).

With X = xh + g V and A = (V - vh)/g a stage solves, at every node and link,

    M_i(X) A_i = loads_i(X, V) - T_i t_i + sum over the links c below T_c t_c,
    |r_i| - l_i (1 - p + T_i/EA) + tau t_i.(V_i - V_p) = 0   or   T_i = 0 where that would push,

for the velocities V (m, d) and the tensions T (m,) together, d = 2 in a vertical plane and 3 in space, p the small
strain by water pressure. The tensions are the multipliers of Gauss's principle; a rigid link has 1/EA = 0. Both
the geometric stiffness T (1 - t t')/|r| and the change of the drag with the link's own direction are in the
derivative, so neither the transverse wave nor the tow speed bounds the step. What the derivative leaves out, the
neighbours' share in the tangent at a third of a link, the shear of the current and the heading of a body, costs an
iteration at the most.
"""

import math

import numpy as np

from models.kernels import inline_kernel, inner_kernel
from models.link_joint.chain import Chain
from models.link_joint.columns import Work, columns_of
from models.link_joint.elimination import eliminate, substitute
from models.link_joint.forces import FAR, NEAR, body_axes, current_at, directions, end_drag, water_at
from models.link_joint.vectors import (
    Axes,
    Floats,
    Matrix,
    Vector,
    across,
    add,
    applied,
    combined,
    dot,
    matrix,
    minus,
    nought,
    outer,
    plus,
    put,
    raised,
    times,
    vector,
    with_diagonal,
)

#: Newton iterations of one stage before the step is given up.
BUDGET = 25
#: Largest turn of a link in one iteration [rad].
_LARGEST_TURN = 0.7
#: A link's stretch error that Newton's method may leave, over its length.
_CLOSED = 2e-9


@inner_kernel
def assemble(
    c: Chain, n: int, g: float, vh: Floats, X: Floats, V: Floats, T: Floats, w: Work
) -> tuple[float, int, int]:
    """Residuals and derivative at (X, V, T), ship in row n, and the elimination of every node as it is complete.

    `vh` (m, d) is what the stage's acceleration counts from; w.F and w.M keep the force on each node and its mass.
    Returns the largest closure error of a taut link over its length, how many links are slack, and how many are
    otherwise than at the assembly before.
    """
    W, reel, axes = w.W, w.reel[0], w.axes
    col, d = columns_of(axes), len(axes)
    up = d - 1
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
    directions(part, parent, lengths, n, X, W, axes)
    for i in range(n):
        p = parent[i]
        l0, size = lengths[i], W[i, col.SIZE]
        t = vector(axes, W, i, col.TANGENT)
        rate = dot(t, minus(vector(axes, V, i, 0), vector(axes, V, p, 0)))
        if p == n:
            rate -= reel
        pressure = 0.0
        if compliance[i] > 0.0:
            depth = -0.5 * (X[i, up] + X[p, up])
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
        weight = weights[i] * half
        Q = with_diagonal(across(added[i] * half, t), inertia)
        P = across(g * (T[i] if T[i] > 0.0 else 0.0) * (1.0 / size), t)
        for end in range(1 if p == n else 2):
            q, o, at, to, sign = (i, p, col.LOWER, col.L, -1.0) if end == 0 else (p, i, col.UPPER, col.B, 1.0)
            v_q = vector(axes, V, q, 0)
            u = combined(NEAR, v_q, FAR, vector(axes, V, o, 0))
            if not still:
                u = minus(u, water_at(axes, depths, current_x, current_y, X[q, up], X[o, up]))
            drag, D, S = end_drag(law, kn, kt, u, vector(axes, W, i, at), size)
            a = times(over_g, minus(v_q, vector(axes, vh, q, 0)))
            load = plus(minus(drag, applied(Q, a)), times(sign * T[i], t))
            add(W, axes, q, col.F, raised(load, -weight))
            _add_stiffness(q, i, over_g, sign * W[i, at + d] * g, D, S, Q, P, W, axes, to)
        if has_body[i]:
            water = nought(axes) if still else current_at(axes, depths, current_x, current_y, X[i, up])
            _add_body(i, over_g, water, c.body_mass, c.body_weight, c.body_added_mass, c.body_drag, vh, V, W, axes)
        eliminate(i, p, gap, slip, g + damping[i], taut, held[i], p == n, T[i], W, axes)
    return worst, slack, switched


@inline_kernel
def _add_stiffness(
    q: int,
    i: int,
    over_g: float,
    turn: float,
    D: Matrix,
    S: Matrix,
    Q: Matrix,
    P: Matrix,
    W: Floats,
    axes: Axes,
    to: int,
) -> None:
    """Mass and stiffness of node q from half of link i, and in the columns from `to` what couples it to the other end.

    Q and P are the half link's mass and geometric stiffness.
    """
    col = columns_of(axes)
    bend = plus(P, times(turn, S))
    put(W, q, col.M, plus(matrix(axes, W, q, col.M), Q))
    put(W, q, col.K, plus(matrix(axes, W, q, col.K), plus(combined(over_g, Q, NEAR, D), bend)))
    put(W, i, to, minus(bend, times(FAR, D)))


@inner_kernel
def _add_body(
    i: int,
    over_g: float,
    water: Vector,
    masses: Floats,
    weights: Floats,
    added: Floats,
    drags: Floats,
    vh: Floats,
    V: Floats,
    W: Floats,
    axes: Axes,
) -> None:
    """The body at node i: weight, drag |u| (A_surge, A_sway, A_heave) u and added mass, in its own axes."""
    col = columns_of(axes)
    t, v = vector(axes, W, i, col.TANGENT), vector(axes, V, i, 0)
    u, a = minus(v, water), times(over_g, minus(v, vector(axes, vh, i, 0)))
    M = with_diagonal(body_axes(added[i, 0], added[i, 1], added[i, 2], t), masses[i])
    D = body_axes(drags[i, 0], drags[i, 1], drags[i, 2], t)
    speed, by_speed = math.sqrt(dot(u, u)), applied(D, u)
    load = plus(times(speed, by_speed), applied(M, a))
    add(W, axes, i, col.F, times(-1.0, raised(load, weights[i])))
    put(W, i, col.M, plus(matrix(axes, W, i, col.M), M))
    K = plus(combined(over_g, M, speed, D), outer(times(1.0 / (speed + 1e-12), by_speed), u))
    put(W, i, col.K, plus(matrix(axes, W, i, col.K), K))


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
    d = len(w.axes)
    for i in range(n):
        for j in range(d):
            X[i, j] = xh[i, j] + g * V[i, j]
    left = np.inf
    for iteration in range(1, BUDGET + 1):
        worst, slack, switched = assemble(c, n, g, vh, X, V, T, w)
        if iteration > 1 and left <= accuracy and worst <= _CLOSED and switched == 0:
            return iteration - 1, 0, worst
        substitute(c, n, w, dV, dT)
        largest, where, bend, pushing = 0.0, 0, 0.0, False
        for i in range(n):
            move = 0.0
            for j in range(d):
                move += abs(dV[i, j])
            if not move <= largest:
                largest, where = move, i
            bend = max(bend, g * move / c.length[i])
        if not largest < 1e6:
            return -iteration, where, largest
        # Far from the solution a link turns by no more than this at a time.
        share = min(1.0, _LARGEST_TURN / bend) if bend > 0.0 else 1.0
        for i in range(n):
            for j in range(d):
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
