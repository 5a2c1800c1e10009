"""Links that enter and leave below the ship as cable is paid out or hauled in, without a jump of the tension."""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inner_kernel
from models.link_joint.chain import Chain
from models.link_joint.forces import current_at, end_force

Floats = NDArray[np.float64]


@inner_kernel
def change_of_links(c: Chain, n: int, room: int, nominal: float) -> int:
    """Whether the top link is long enough to be parted (1) or so short that it joins the next (-1)."""
    if c.length[n - 1] > 1.5 * nominal and n + 1 < room:
        return 1
    if c.length[n - 1] < 0.5 * nominal and not c.has_body[n - 1] and n >= 3 and c.part[n - 2] == c.part[n - 1]:
        return -1
    return 0


@inner_kernel
def _fitted(c: Chain, i: int, p: int, x: Floats, v: Floats, tension: float, reel: float) -> float:
    """Unstretched length of a link that has the given tension where it is, so that the cable feels no jump [m]."""
    rx, ry, rz = x[i, 0] - x[p, 0], x[i, 1] - x[p, 1], x[i, 2] - x[p, 2]
    size = math.sqrt(rx * rx + ry * ry + rz * rz)
    dx, dy, dz = v[i, 0] - v[p, 0], v[i, 1] - v[p, 1], v[i, 2] - v[p, 2]
    depth = -0.5 * (x[i, 2] + x[p, 2])
    pressure = (1.0 - 2.0 * c.poisson[i]) * c.specific_weight * depth * c.area[i]
    rate = (rx * dx + ry * dy + rz * dz) / size - reel
    length: float = (size + c.damping[i] * rate) / (1.0 + c.compliance[i] * (tension - pressure))
    return length


@inner_kernel
def split(c: Chain, n: int, x: Floats, v: Floats, a: Floats, T: Floats, nominal: float, reel: float) -> None:
    """Part the top link: a new node n between node n - 1 and the ship, which moves to row n + 1.

    It is placed off the straight line by the sag of its own load, so that the new links pull as the old one did.
    """
    share = nominal / c.length[n - 1]
    tx, ty, tz = x[n - 1, 0] - x[n, 0], x[n - 1, 1] - x[n, 1], x[n - 1, 2] - x[n, 2]
    size = math.sqrt(tx * tx + ty * ty + tz * tz)
    tx, ty, tz = tx / size, ty / size, tz / size
    lower, upper = nominal, c.length[n - 1] - nominal
    load, t = np.zeros(3), (tx, ty, tz)
    for j in range(3):
        x[n + 1, j], v[n + 1, j], a[n + 1, j] = x[n, j], v[n, j], a[n, j]
        x[n, j] = x[n - 1, j] + share * (x[n, j] - x[n - 1, j])
        # At the ship the cable itself moves on with the rate it is paid out at.
        v[n, j] = v[n - 1, j] + share * (v[n, j] + reel * t[j] - v[n - 1, j])
        a[n, j] = a[n - 1, j] + share * (a[n, j] - a[n - 1, j])
    cx, cy = current_at(c.current_depth, c.current_x, c.current_y, x[n, 2])
    kn, kt = c.normal_drag[n - 1], c.tangential_drag[n - 1]
    fx, fy, fz = end_force(c.law, kn, kt, v[n, 0] - cx, v[n, 1] - cy, v[n, 2], tx, ty, tz)
    load[0] = fx - c.mass[n - 1] * a[n, 0]
    load[1] = fy - c.mass[n - 1] * a[n, 1]
    load[2] = fz - c.mass[n - 1] * a[n, 2] - c.weight[n - 1]
    along = load[0] * tx + load[1] * ty + load[2] * tz
    tension = T[n - 1]
    sag = 0.5 * lower * upper / tension if tension > 0.0 else 0.0
    for j in range(3):
        x[n, j] += sag * (load[j] - along * t[j])
    T[n - 1] = max(0.0, tension - 0.5 * along * upper)
    T[n] = max(0.0, tension + 0.5 * along * lower)
    c.length[n - 1], c.length[n] = lower, upper
    if tension > 0.0:
        c.length[n - 1] = _fitted(c, n - 1, n, x, v, T[n - 1], 0.0)
        c.length[n] = _fitted(c, n, n + 1, x, v, T[n], reel)


@inner_kernel
def merge(c: Chain, n: int, x: Floats, v: Floats, a: Floats, T: Floats, reel: float) -> None:
    """Take node n - 1 out: the link of node n - 2 reaches to the ship, which moves to row n - 1."""
    length = c.length[n - 2] + c.length[n - 1]
    T[n - 2] = (c.length[n - 2] * T[n - 2] + c.length[n - 1] * T[n - 1]) / length
    for j in range(3):
        x[n - 1, j], v[n - 1, j], a[n - 1, j] = x[n, j], v[n, j], a[n, j]
    c.length[n - 2] = length
    if T[n - 2] > 0.0:
        c.length[n - 2] = _fitted(c, n - 2, n - 1, x, v, T[n - 2], reel)
