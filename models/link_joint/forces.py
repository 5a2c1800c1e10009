"""Water forces on one end of a link and on a body, with their derivatives.

| symbol | meaning | unit |
| --- | --- | --- |
| t | unit tangent of the link, from its upper to its lower end | - |
| r | the link's vector, upper to lower end | m |
| u | velocity through the water | m/s |
| u_t, n, u_n | u along t, u - u_t t, its size | m/s |
| a, b | drag per length F = -(a n + b t) | N s/m2, N/m |
| D, S | -dF/du, dF/dr | N s/m, N/m |

A link's drag is shared out between its ends as a linear element's is: each end gets half the length at a third of the
link, with the velocity there and the tangent there, which turns linearly from one link's middle to the next one's.
With the tangent of the chord alone the half link at a free end would cost most of the error.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, inner_kernel
from models.link_joint.chain import INCIDENCE
from models.link_joint.columns import columns_of
from models.link_joint.vectors import (
    Axes,
    Floats,
    Matrix,
    Vector,
    across,
    combined,
    dot,
    minus,
    nought,
    outer,
    plus,
    put,
    times,
    vector,
    with_diagonal,
)

Indices = NDArray[np.int64]

#: Where W's two ranges of incidence meet [rad].
_STEEP = math.radians(30.0)
#: Horizontal share of a tow link's direction below which a body has no heading.
_VERTICAL = 0.02
_SMALL = 1e-12
#: Share of the nearer node's velocity at a third of a link.
NEAR = 2.0 / 3.0
FAR = 1.0 - NEAR
_TINY = 1e-30


@inline_kernel
def current_at(axes: Axes, depths: Floats, x: Floats, y: Floats, z: float) -> Vector:
    """The water's velocity [m/s] at height z: straight lines between the given depths, constant outside."""
    last, depth = depths.size - 1, -z
    if last < 0:
        return nought(axes)
    above, below, share = last, last, 0.0
    if depth <= depths[0]:
        above, below = 0, 0
    else:
        for i in range(1, last + 1):
            if depth <= depths[i]:
                above, below, share = i - 1, i, (depth - depths[i - 1]) / (depths[i] - depths[i - 1])
                break
    along = x[above] + share * (x[below] - x[above])
    if len(axes) == 2:
        return along, 0.0
    return along, y[above] + share * (y[below] - y[above]), 0.0


@inline_kernel
def drag_law(law: int, kn: float, kt: float, un: float, ut: float) -> tuple[float, float, float, float, float, float]:
    """a, b and their derivatives by u_n and u_t, in the order (a, b, a_n, a_t, b_n, b_t).

    Quadratic: a = k_n u_n, b = k_t |u_t| u_t. Incidence (W, with |V|^2 as its coefficients belong to it): the drag
    lies along the flow, F = -k_n q(alpha) |V| u with q = 0.273 + 0.827 alpha^2 below 30 degrees, else sin(alpha).
    """
    if law != INCIDENCE:
        return kn * un, kt * abs(ut) * ut, kn, 0.0, 0.0, 2.0 * kt * abs(ut)
    alpha = math.atan2(un, abs(ut))
    if alpha >= _STEEP:
        return kn * un, kn * un * ut, kn, 0.0, kn * ut, kn * un
    V = math.sqrt(un * un + ut * ut) + _SMALL
    q = 0.273 + 0.827 * alpha * alpha
    slope = 1.654 * alpha / V
    by_n = q * un / V + slope * abs(ut)
    by_t = q * ut / V - slope * un * (1.0 if ut >= 0.0 else -1.0)
    return kn * q * V, kn * q * V * ut, kn * by_n, kn * by_t, kn * ut * by_n, kn * (q * V + ut * by_t)


@inline_kernel
def end_force(law: int, kn: float, kt: float, u: Vector, t: Vector) -> Vector:
    """Drag per length F [N/m]."""
    ut = dot(u, t)
    n = minus(u, times(ut, t))
    a, b, _, _, _, _ = drag_law(law, kn, kt, math.sqrt(dot(n, n)), ut)
    return combined(-a, n, -b, t)


@inline_kernel
def end_drag(law: int, kn: float, kt: float, u: Vector, t: Vector, size: float) -> tuple[Vector, Matrix, Matrix]:
    """Drag per length F, and D and S of a link of length `size` [m]."""
    ut = dot(u, t)
    n = minus(u, times(ut, t))
    un = math.sqrt(dot(n, n))
    a, b, an, at, bn, bt = drag_law(law, kn, kt, un, ut)
    over = 1.0 / (un + _SMALL)
    # D = a (1 - t t') + (a_n/u_n) n n' + a_t n t' + (b_n/u_n) t n' + b_t t t'
    by_n, by_t = combined(an * over, n, bn * over, t), combined(at, n, bt - a, t)
    D = with_diagonal(plus(outer(by_n, n), outer(by_t, t)), a)
    # S = -[(b - a u_t)(1 - t t') + ((b_t - a - b_n u_t/u_n) t + (a_t - a_n u_t/u_n) n) n'] / |r|
    shorter = 1.0 / size
    c = (a * ut - b) * shorter
    d = -(bt - a - bn * ut * over) * shorter
    e = -(at - an * ut * over) * shorter
    S = plus(across(c, t), outer(combined(d, t, e, n), n))
    return combined(-a, n, -b, t), D, S


@inner_kernel
def body_axes(surge: float, sway: float, heave: float, t: Vector) -> Matrix:
    """The tensor of a body with values along and across its heading and upwards.

    It heads where its cable pulls it, the horizontal part of t; under a vertical cable it has no heading and both
    directions share the mean.
    """
    flat = t[0] * t[0]
    if len(t) == 3:
        flat += t[1] * t[1]
    share = (surge - sway) / (flat + _VERTICAL * _VERTICAL)
    mean = 0.5 * (surge + sway) - 0.5 * share * flat
    xx = mean + share * t[0] * t[0]
    if len(t) == 2:
        return xx, 0.0, 0.0, heave
    xy = share * t[0] * t[1]
    return xx, xy, 0.0, xy, mean + share * t[1] * t[1], 0.0, 0.0, 0.0, heave


@inner_kernel
def directions(part: Indices, parent: Indices, length: Floats, n: int, X: Floats, W: Floats, axes: Axes) -> None:
    """Tangent and length of every link, and the tangents at a third of it from its lower and its upper end.

    Into the columns TANGENT, SIZE, LOWER and UPPER of W; the last number of an end is the share of the link's own
    tangent in it.
    """
    col, d = columns_of(axes), len(axes)
    for i in range(n):
        r = minus(vector(axes, X, i, 0), vector(axes, X, parent[i], 0))
        size = math.sqrt(dot(r, r)) + _TINY
        W[i, col.SIZE] = size
        put(W, i, col.TANGENT, times(1.0 / size, r))
    above, over_above = False, 0.0
    for i in range(n):
        below, over_below = above, over_above
        above = i + 1 < n and part[i + 1] == part[i]
        over_above = (1.0 / 3.0) / (length[i] + length[i + 1]) if above else 0.0
        to_below, to_above = length[i] * over_below, length[i] * over_above
        for end in range(2):
            # Where a part ends the turn goes on as it does at the link's other end.
            lower = end == 0
            if below if lower else above:
                beside, share = (i - 1, to_below) if lower else (i + 1, to_above)
            elif above if lower else below:
                beside, share = (i + 1, -to_above) if lower else (i - 1, -to_below)
            else:
                beside, share = i, 0.0
            own = 1.0 - share
            t = combined(own, vector(axes, W, i, col.TANGENT), share, vector(axes, W, beside, col.TANGENT))
            at = col.LOWER if lower else col.UPPER
            put(W, i, at, times(1.0 / (math.sqrt(dot(t, t)) + _TINY), t))
            W[i, at + d] = own


@inline_kernel
def water_at(axes: Axes, depths: Floats, x: Floats, y: Floats, near: float, far: float) -> Vector:
    """The water's velocity [m/s] at a third of a link whose ends are at the heights `near` and `far` [m]."""
    return current_at(axes, depths, x, y, NEAR * near + FAR * far)
