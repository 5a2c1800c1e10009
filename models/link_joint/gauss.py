"""Gauss's principle itself: accelerations and multipliers of the chain in a given state, O(N).

W's x'' = a + M^-1/2 (A M^-1/2)^+ (b - A a) with full row rank is x'' = a + M^-1 A'(A M^-1 A')^-1 (b - A a). The matrix
A M^-1 A' couples a link with its neighbours only, also when the added mass makes M a 3 x 3 block a node, so that node
by node elimination from the free ends solves it. The multipliers are the tensions of the rigid links; an elastic link
has the tension of its stretch instead.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.link_joint import columns as col
from models.link_joint.chain import Chain
from models.link_joint.stage import Work, _eliminate, assemble, substitute, work_for

Floats = NDArray[np.float64]


def accelerations(
    chain: Chain, x: Floats, v: Floats, tension: Floats, ship_acceleration: Floats
) -> tuple[Floats, Floats]:
    """Accelerations (m + 1, 3) [m/s2], the ship's given one last, and tensions (m,) [N].

    Parameters
    ----------
    x, v
        (m + 1, 3) [m], [m/s], the ship's node last.
    tension
        (m,) [N], used for elastic links.
    ship_acceleration
        (3,) [m/s2].
    """
    nodes = x.shape[0]
    a, T, work = np.zeros((nodes, 3)), np.array(tension), work_for(nodes)
    a[-1] = ship_acceleration
    accelerate(chain, nodes - 1, np.array(x), np.array(v), T, a, 0.0, False, work)
    return a, T


@kernel
def accelerate(
    c: Chain, n: int, x: Floats, v: Floats, T: Floats, a: Floats, lengthening: float, slack_stays: bool, w: Work
) -> None:
    """Accelerations a (m + 1, 3), the ship's given in row n, and tensions T (m,) of rigid links, both in place.

    `lengthening` is the payout's second derivative [m/s2]; with `slack_stays` a rigid link without tension is slack.
    """
    W, given, dV, dT = w.W, np.zeros(n), np.zeros((n + 1, 3)), np.zeros(n)
    for i in range(n):
        if c.compliance[i] > 0.0:
            T[i] = max(0.0, T[i])
            given[i] = T[i]
    # Counted from the velocities themselves a stage has no acceleration: what is out of balance is all force.
    assemble(c, n, 1.0, v, x, v, given, w)
    _bare(n, W)
    for i in range(n):
        p = c.parent[i]
        rx, ry, rz = x[i, 0] - x[p, 0], x[i, 1] - x[p, 1], x[i, 2] - x[p, 2]
        size = math.sqrt(rx * rx + ry * ry + rz * rz)
        dx, dy, dz = v[i, 0] - v[p, 0], v[i, 1] - v[p, 1], v[i, 2] - v[p, 2]
        along = (rx * dx + ry * dy + rz * dz) / size
        # The first row of b: the ship's acceleration has a plus sign.
        closing = (dx * dx + dy * dy + dz * dz - along * along) / size
        if p == n:
            closing -= (rx * a[n, 0] + ry * a[n, 1] + rz * a[n, 2]) / size + lengthening
        rigid = c.compliance[i] == 0.0 and not (slack_stays and T[i] <= 0.0)
        _eliminate(i, p, closing, 0.0, 1.0, rigid, c.held[i], p == n, 0.0, W)
    substitute(c, n, w, dV, dT)
    for i in range(n):
        for j in range(3):
            a[i, j] = dV[i, j]
        if c.compliance[i] == 0.0:
            T[i] = max(0.0, dT[i]) if slack_stays else dT[i]


@kernel
def make_consistent(
    c: Chain, n: int, x: Floats, v: Floats, a: Floats, T: Floats, lengthening: float, w: Work, dV: Floats, dT: Floats
) -> None:
    """Velocities under which rigid links keep their lengths, and the accelerations and tensions that go with them.

    A step closes the positions; what it leaves of velocity along a link is of second order, but the next, shorter step
    would divide it by its size and make a spike of the tension. The change is the smallest in the masses' measure; W
    holds the masses and tangents of the last assembly at this state.
    """
    W = w.W
    _bare(n, W)
    for i in range(n):
        p = c.parent[i]
        rate = W[i, col.TANGENT] * (v[i, 0] - v[p, 0])
        rate += W[i, col.TANGENT + 1] * (v[i, 1] - v[p, 1]) + W[i, col.TANGENT + 2] * (v[i, 2] - v[p, 2])
        if p == n:
            rate -= w.reel[0]
        for j in range(3):
            W[i, col.F + j] = 0.0
        _eliminate(i, p, rate, 0.0, 1.0, c.compliance[i] == 0.0 and T[i] > 0.0, c.held[i], p == n, 0.0, W)
    substitute(c, n, w, dV, dT)
    for i in range(n):
        for j in range(3):
            v[i, j] += dV[i, j]
    accelerate(c, n, x, v, T, a, lengthening, True, w)


@kernel
def _bare(n: int, W: Floats) -> None:
    """The masses alone as stiffness, nothing coupled, nothing handed on."""
    for i in range(n + 1):
        for j in range(9):
            W[i, col.K + j], W[i, col.L + j], W[i, col.B + j] = W[i, col.M + j], 0.0, 0.0
        for j in range(3):
            W[i, col.R + j] = 0.0
