"""Water forces on one end of a link and on a body, with their derivatives.

| symbol | meaning | unit |
| --- | --- | --- |
| t | unit tangent of the link, from its upper to its lower end | - |
| r | the link's vector, upper to lower end | m |
| u | velocity through the water | m/s |
| u_t, n, u_n | u along t, u - u_t t, its size | m/s |
| a, b | drag per length F = -(a n + b t) | N s/m2, N/m |
| D, S | -dF/du, dF/dr | N s/m, N/m |

Matrices are tuples of nine numbers, row by row: the compiler keeps them in registers.

A link's drag is shared out between its ends as a linear element's is: each end gets half the length at a third of the
link, with the velocity there and the tangent there, which turns linearly from one link's middle to the next one's.
With the tangent of the chord alone the half link at a free end would cost most of the error.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, inner_kernel, kernel
from models.link_joint import columns as col
from models.link_joint.chain import INCIDENCE

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Three = tuple[float, float, float]
Nine = tuple[float, float, float, float, float, float, float, float, float]

#: Where W's two ranges of incidence meet [rad].
_STEEP = math.radians(30.0)
#: Horizontal share of a tow link's direction below which a body has no heading.
_VERTICAL = 0.02
_SMALL = 1e-12
#: Share of the nearer node's velocity at a third of a link.
NEAR = 2.0 / 3.0
FAR = 1.0 - NEAR
_TINY = 1e-30


@kernel
def current_at(depths: Floats, x: Floats, y: Floats, z: float) -> tuple[float, float]:
    """The water's velocity [m/s] at height z: straight lines between the given depths, constant outside."""
    k = depths.size
    if k == 0:
        return 0.0, 0.0
    depth = -z
    if depth <= depths[0]:
        return x[0], y[0]
    for i in range(1, k):
        if depth <= depths[i]:
            share = (depth - depths[i - 1]) / (depths[i] - depths[i - 1])
            return x[i - 1] + share * (x[i] - x[i - 1]), y[i - 1] + share * (y[i] - y[i - 1])
    return x[k - 1], y[k - 1]


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
def end_force(
    law: int, kn: float, kt: float, ux: float, uy: float, uz: float, tx: float, ty: float, tz: float
) -> tuple[float, float, float]:
    """Drag per length F [N/m]."""
    ut = ux * tx + uy * ty + uz * tz
    nx, ny, nz = ux - ut * tx, uy - ut * ty, uz - ut * tz
    un = math.sqrt(nx * nx + ny * ny + nz * nz)
    a, b, _, _, _, _ = drag_law(law, kn, kt, un, ut)
    return -(a * nx + b * tx), -(a * ny + b * ty), -(a * nz + b * tz)


@inline_kernel
def end_drag(
    law: int, kn: float, kt: float, ux: float, uy: float, uz: float, tx: float, ty: float, tz: float, size: float
) -> tuple[Three, Nine, Nine]:
    """Drag per length F (3), D (9) and S (9) of a link of length `size` [m]."""
    ut = ux * tx + uy * ty + uz * tz
    nx, ny, nz = ux - ut * tx, uy - ut * ty, uz - ut * tz
    un = math.sqrt(nx * nx + ny * ny + nz * nz)
    a, b, an, at, bn, bt = drag_law(law, kn, kt, un, ut)
    over = 1.0 / (un + _SMALL)
    F = (-(a * nx + b * tx), -(a * ny + b * ty), -(a * nz + b * tz))
    # D = a (1 - t t') + (a_n/u_n) n n' + a_t n t' + (b_n/u_n) t n' + b_t t t'
    px, py, pz = an * over * nx + (bn * over) * tx, an * over * ny + (bn * over) * ty, an * over * nz + (bn * over) * tz
    along = bt - a
    qx, qy, qz = at * nx + along * tx, at * ny + along * ty, at * nz + along * tz
    D = (
        a + px * nx + qx * tx,
        px * ny + qx * ty,
        px * nz + qx * tz,
        py * nx + qy * tx,
        a + py * ny + qy * ty,
        py * nz + qy * tz,
        pz * nx + qz * tx,
        pz * ny + qz * ty,
        a + pz * nz + qz * tz,
    )
    # S = -[(b - a u_t)(1 - t t') + ((b_t - a - b_n u_t/u_n) t + (a_t - a_n u_t/u_n) n) n'] / |r|
    c = (a * ut - b) / size
    d = -(bt - a - bn * ut * over) / size
    e = -(at - an * ut * over) / size
    sx, sy, sz = d * tx + e * nx, d * ty + e * ny, d * tz + e * nz
    S = (
        c * (1.0 - tx * tx) + sx * nx,
        -c * tx * ty + sx * ny,
        -c * tx * tz + sx * nz,
        -c * ty * tx + sy * nx,
        c * (1.0 - ty * ty) + sy * ny,
        -c * ty * tz + sy * nz,
        -c * tz * tx + sz * nx,
        -c * tz * ty + sz * ny,
        c * (1.0 - tz * tz) + sz * nz,
    )
    return F, D, S


@kernel
def body_axes(surge: float, sway: float, tx: float, ty: float) -> tuple[float, float, float]:
    """The horizontal tensor (xx, xy, yy) of a body with values along and across its heading.

    It heads where its cable pulls it, the horizontal part of t; under a vertical cable it has no heading and both
    directions share the mean.
    """
    flat = tx * tx + ty * ty
    share = (surge - sway) / (flat + _VERTICAL * _VERTICAL)
    mean = 0.5 * (surge + sway) - 0.5 * share * flat
    return mean + share * tx * tx, share * tx * ty, mean + share * ty * ty


@inner_kernel
def directions(part: Indices, parent: Indices, length: Floats, n: int, X: Floats, W: Floats) -> None:
    """Tangent and length of every link, and the tangents at a third of it from its lower and its upper end.

    Into the columns TANGENT, SIZE, LOWER and UPPER of W; the fourth number of an end is the share of the link's own
    tangent in it.
    """
    for i in range(n):
        p = parent[i]
        rx, ry, rz = X[i, 0] - X[p, 0], X[i, 1] - X[p, 1], X[i, 2] - X[p, 2]
        size = math.sqrt(rx * rx + ry * ry + rz * rz) + _TINY
        W[i, col.SIZE] = size
        W[i, col.TANGENT], W[i, col.TANGENT + 1], W[i, col.TANGENT + 2] = rx / size, ry / size, rz / size
    for i in range(n):
        below = i > 0 and part[i - 1] == part[i]
        above = i + 1 < n and part[i + 1] == part[i]
        to_below = length[i] / (3.0 * (length[i] + length[i - 1])) if below else 0.0
        to_above = length[i] / (3.0 * (length[i] + length[i + 1])) if above else 0.0
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
            x = own * W[i, col.TANGENT] + share * W[beside, col.TANGENT]
            y = own * W[i, col.TANGENT + 1] + share * W[beside, col.TANGENT + 1]
            z = own * W[i, col.TANGENT + 2] + share * W[beside, col.TANGENT + 2]
            over = 1.0 / (math.sqrt(x * x + y * y + z * z) + _TINY)
            at = col.LOWER if lower else col.UPPER
            W[i, at], W[i, at + 1], W[i, at + 2], W[i, at + 3] = x * over, y * over, z * over, own


@inner_kernel
def water_at(depths: Floats, x: Floats, y: Floats, near: float, far: float) -> tuple[float, float]:
    """The water's velocity [m/s] at a third of a link whose ends are at the heights `near` and `far` [m]."""
    return current_at(depths, x, y, NEAR * near + FAR * far)
