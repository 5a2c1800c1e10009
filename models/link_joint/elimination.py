"""Elimination of a chain's nodes from the free ends up to the ship, and substitution back down, O(N).

Node i and its link leave, in terms of the parent's change dV_p,

    dV_i = v + G dV_p,   dT_i = tau0 + k.dV_p,

and hand their stiffness on to the parent: a tree needs no fill, and its branches cost what a chain costs.
"""

from models.kernels import inline_kernel, inner_kernel
from models.link_joint.chain import Chain
from models.link_joint.columns import Work, columns_of
from models.link_joint.vectors import (
    Axes,
    Floats,
    add,
    applied,
    dot,
    from_left,
    inverse,
    matrix,
    minus,
    nought,
    outer,
    plus,
    product,
    put,
    times,
    vector,
)


@inline_kernel
def eliminate(
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
    axes: Axes,
) -> None:
    """Solve node i and its link for the parent's change, and hand what is left on to the parent."""
    col = columns_of(axes)
    J, t = inverse(matrix(axes, W, i, col.K), held), vector(axes, W, i, col.TANGENT)
    e = applied(J, t)
    scale = 1.0 / (dot(t, e) + slip / sigma) if taut else 0.0
    W[i, col.SCALE] = scale
    W[i, col.RHO] = gap / sigma
    put(W, i, col.INVERSE, J)
    put(W, i, col.E, e)
    H = product(J, matrix(axes, W, i, col.L))
    k = times(scale, minus(from_left(t, H), t))
    put(W, i, col.KAPPA, k)
    G = minus(H, outer(e, k))
    put(W, i, col.G, G)
    reduce(i, p, last, tension, W, axes)
    if not last:
        handed = plus(product(matrix(axes, W, i, col.B), G), outer(t, k))
        put(W, p, col.K, minus(matrix(axes, W, p, col.K), handed))


@inline_kernel
def reduce(i: int, p: int, last: bool, tension: float, W: Floats, axes: Axes) -> None:
    """The right-hand side's part of the elimination of node i."""
    col = columns_of(axes)
    load = plus(vector(axes, W, i, col.F), vector(axes, W, i, col.R))
    y, t = applied(matrix(axes, W, i, col.INVERSE), load), vector(axes, W, i, col.TANGENT)
    tau = W[i, col.SCALE] * (W[i, col.RHO] + dot(t, y)) if W[i, col.SCALE] > 0.0 else -tension
    W[i, col.TAU] = tau
    v = minus(y, times(tau, vector(axes, W, i, col.E)))
    put(W, i, col.V, v)
    if not last:
        add(W, axes, p, col.R, plus(applied(matrix(axes, W, i, col.B), v), times(tau, t)))


@inner_kernel
def substitute(c: Chain, n: int, w: Work, dV: Floats, dT: Floats) -> None:
    """Changes of velocity dV (m + 1, d) and tension dT (m,), from the ship down."""
    parent, W, axes = c.parent, w.W, w.axes
    col = columns_of(axes)
    put(dV, n, 0, nought(axes))
    for j in range(n):
        i = n - 1 - j
        above = vector(axes, dV, parent[i], 0)
        dT[i] = W[i, col.TAU] + dot(vector(axes, W, i, col.KAPPA), above)
        put(dV, i, 0, plus(vector(axes, W, i, col.V), applied(matrix(axes, W, i, col.G), above)))
