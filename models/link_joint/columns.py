"""Columns of the work array: a row holds what a stage knows of node i and of the link above it.

One array for all of it, because every array that is handed to a kernel inside a loop costs as much as the sums there.
Vectors are d columns wide and matrices, row by row, d x d: d is 2 in a plane and 3 in space.

| column | holds | width |
| --- | --- | --- |
| K, M | stiffness against dV, mass of the node | d x d |
| F, R | force out of balance, and what the eliminated nodes below add to it | d |
| INVERSE | K^-1 | d x d |
| E | K^-1 t | d |
| KAPPA | k of dT = tau0 + k.dV_p | d |
| G | G of dV_i = v + G dV_p | d x d |
| L, B | the node's stiffness against dV_p, the parent's against dV_i | d x d |
| TANGENT, SIZE | t from the upper to the lower end, and length of the link | d, 1 |
| V, TAU | v and tau0 | d, 1 |
| SCALE | 1/(t.K^-1 t + c/sigma), 0 of a slack link | 1 |
| RHO | closure error over sigma | 1 |
| LOWER, UPPER | tangent at a third of the link from that end, and the share of the link's own in it | d + 1 |
"""

from itertools import accumulate
from typing import NamedTuple

import numpy as np

from models.kernels import inline_kernel
from models.link_joint.vectors import Axes, Floats, axes_of


class Columns(NamedTuple):
    """Where each of them begins, and the width of a row."""

    K: int
    M: int
    F: int
    R: int
    INVERSE: int
    E: int
    KAPPA: int
    G: int
    L: int
    B: int
    TANGENT: int
    SIZE: int
    V: int
    TAU: int
    SCALE: int
    RHO: int
    LOWER: int
    UPPER: int
    WIDTH: int


def _laid_out(d: int) -> Columns:
    m, end = d * d, d + 1
    return Columns(*accumulate((0, m, m, d, d, m, d, d, m, m, m, d, 1, d, 1, 1, 1, end, end)))


_PLANE, _SPACE = _laid_out(2), _laid_out(3)


@inline_kernel
def columns_of(axes: Axes) -> Columns:
    """The columns of a chain that moves along so many axes."""
    if len(axes) == 2:
        return _PLANE
    return _SPACE


class Work(NamedTuple):
    """What a stage knows, (m + 1, WIDTH).

    The kernels are compiled once for every length of `axes`, and what they are given has as many numbers a node.
    """

    W: Floats
    reel: Floats  # (1,) rate at which the ship's link grows by payout [m/s]
    axes: Axes


def work_for(nodes: int, d: int = 3) -> Work:
    """Arrays for a chain of `nodes` nodes, the ship's included, that moves along `d` axes."""
    axes = axes_of(d)
    return Work(W=np.zeros((nodes, columns_of(axes).WIDTH)), reel=np.zeros(1), axes=axes)
