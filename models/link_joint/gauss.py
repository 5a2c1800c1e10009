"""Gauss's principle itself: accelerations and multipliers of the chain in a given state, O(N).

W's x'' = a + M^-1/2 (A M^-1/2)^+ (b - A a) with full row rank is x'' = a + M^-1 A'(A M^-1 A')^-1 (b - A a). The matrix
A M^-1 A' couples a link with its neighbours only, also when the added mass makes M a d x d block a node, so that node
by node elimination from the free ends solves it. The multipliers are the tensions of the rigid links; an elastic link
has the tension of its stretch instead.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inner_kernel, kernel
from models.link_joint.chain import Chain
from models.link_joint.columns import Work, columns_of, work_for
from models.link_joint.elimination import eliminate, substitute
from models.link_joint.stage import assemble
from models.link_joint.vectors import Axes, Floats, add, dot, minus, nought, put, vector

Flags = NDArray[np.bool_]


def accelerations(
    chain: Chain, x: Floats, v: Floats, tension: Floats, ship_acceleration: Floats
) -> tuple[Floats, Floats]:
    """Accelerations (m + 1, 3) [m/s2], the ship's given one last, and tensions (m,) [N].

    Parameters
    ----------
    x, v
        (m + 1, 3) [m], [m/s], the ship's node last; (m + 1, 2) of a chain in its plane.
    tension
        (m,) [N], used for elastic links.
    ship_acceleration
        (3,) or (2,) [m/s2].
    """
    nodes, d = x.shape
    a, T, work = np.zeros((nodes, d)), np.array(tension), work_for(nodes, d)
    a[-1] = ship_acceleration
    accelerate(chain, nodes - 1, np.array(x), np.array(v), T, a, 0.0, np.zeros(0, np.bool_), work)
    return a, T


@kernel
def accelerate(
    c: Chain, n: int, x: Floats, v: Floats, T: Floats, a: Floats, lengthening: float, slack: Flags, w: Work
) -> None:
    """Accelerations a (m + 1, d), the ship's given in row n, and tensions T (m,) of rigid links, both in place.

    `lengthening` is the payout's second derivative [m/s2]; `slack` (m,) are links that stay so while no other pushes,
    empty where rigid links hold whether they pull or push.
    """
    W, axes, one_sided = w.W, w.axes, slack.size > 0
    given, dV, dT = np.zeros(n), np.zeros((n + 1, len(axes))), np.zeros(n)
    for i in range(n):
        if c.compliance[i] > 0.0:
            T[i] = max(0.0, T[i])
            given[i] = T[i]
    # Counted from the velocities themselves a stage has no acceleration: what is out of balance is all force.
    assemble(c, n, 1.0, v, x, v, given, w)
    _bare(n, W, axes)
    for i in range(n):
        p = c.parent[i]
        r = minus(vector(axes, x, i, 0), vector(axes, x, p, 0))
        size, change = math.sqrt(dot(r, r)), minus(vector(axes, v, i, 0), vector(axes, v, p, 0))
        along = dot(r, change) / size
        # The first row of b: the ship's acceleration has a plus sign.
        closing = (dot(change, change) - along * along) / size
        if p == n:
            closing -= dot(r, vector(axes, a, n, 0)) / size + lengthening
        rigid = c.compliance[i] == 0.0 and not (one_sided and slack[i])
        _free_of_others(i, p, closing, rigid, c.held[i], p == n, W, axes)
    substitute(c, n, w, dV, dT)
    for i in range(n):
        put(a, i, 0, vector(axes, dV, i, 0))
        if c.compliance[i] == 0.0:
            T[i] = max(0.0, dT[i]) if one_sided else dT[i]


@kernel
def make_consistent(
    c: Chain, n: int, x: Floats, v: Floats, a: Floats, T: Floats, lengthening: float, w: Work, dV: Floats, dT: Floats
) -> None:
    """Velocities under which rigid links keep their lengths, and the accelerations and tensions that go with them.

    A step closes the positions; what it leaves of velocity along a link is of second order, but the next, shorter step
    would divide it by its size and make a spike of the tension. The change is the smallest in the masses' measure; W
    holds the masses and tangents of the last assembly at this state.
    """
    W, axes = w.W, w.axes
    col, slack = columns_of(axes), np.zeros(n, np.bool_)
    _bare(n, W, axes)
    for i in range(n):
        p, slack[i] = c.parent[i], T[i] <= 0.0
        rate = dot(vector(axes, W, i, col.TANGENT), minus(vector(axes, v, i, 0), vector(axes, v, p, 0)))
        if p == n:
            rate -= w.reel[0]
        put(W, i, col.F, nought(axes))
        _free_of_others(i, p, rate, c.compliance[i] == 0.0 and not slack[i], c.held[i], p == n, W, axes)
    substitute(c, n, w, dV, dT)
    for i in range(n):
        add(v, axes, i, 0, vector(axes, dV, i, 0))
    accelerate(c, n, x, v, T, a, lengthening, slack, w)


@inner_kernel
def _free_of_others(i: int, p: int, gap: float, rigid: bool, held: bool, last: bool, W: Floats, axes: Axes) -> None:
    """The elimination of node i where a link has no stiffness, only its length."""
    eliminate(i, p, gap, 0.0, 1.0, rigid, held, last, 0.0, W, axes)


@inner_kernel
def _bare(n: int, W: Floats, axes: Axes) -> None:
    """The masses alone as stiffness, nothing coupled, nothing handed on."""
    col = columns_of(axes)
    for i in range(n + 1):
        for j in range(col.M - col.K):
            W[i, col.K + j], W[i, col.L + j], W[i, col.B + j] = W[i, col.M + j], 0.0, 0.0
        put(W, i, col.R, nought(axes))
