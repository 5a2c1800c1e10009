"""Links that enter and leave below the ship as cable is paid out or hauled in, without a jump of the tension."""

import math

from models.kernels import inner_kernel
from models.link_joint.chain import Chain
from models.link_joint.forces import current_at, end_force
from models.link_joint.vectors import Axes, Floats, add, combined, dot, minus, put, raised, times, vector


@inner_kernel
def change_of_links(c: Chain, n: int, room: int, nominal: float) -> int:
    """Whether the top link is long enough to be parted (1) or so short that it joins the next (-1)."""
    if c.length[n - 1] > 1.5 * nominal and n + 1 < room:
        return 1
    if c.length[n - 1] < 0.5 * nominal and not c.has_body[n - 1] and n >= 3 and c.part[n - 2] == c.part[n - 1]:
        return -1
    return 0


@inner_kernel
def _fitted(c: Chain, i: int, p: int, x: Floats, v: Floats, tension: float, reel: float, axes: Axes) -> float:
    """Unstretched length of a link that has the given tension where it is, so that the cable feels no jump [m]."""
    up = len(axes) - 1
    r, change = minus(vector(axes, x, i, 0), vector(axes, x, p, 0)), minus(vector(axes, v, i, 0), vector(axes, v, p, 0))
    size = math.sqrt(dot(r, r))
    depth = -0.5 * (x[i, up] + x[p, up])
    pressure = (1.0 - 2.0 * c.poisson[i]) * c.specific_weight * depth * c.area[i]
    rate = dot(r, change) / size - reel
    length: float = (size + c.damping[i] * rate) / (1.0 + c.compliance[i] * (tension - pressure))
    return length


@inner_kernel
def split(
    c: Chain, n: int, x: Floats, v: Floats, a: Floats, T: Floats, nominal: float, reel: float, axes: Axes
) -> None:
    """Part the top link: a new node n between node n - 1 and the ship, which moves to row n + 1.

    It is placed off the straight line by the sag of its own load, so that the new links pull as the old one did.
    """
    share = nominal / c.length[n - 1]
    r = minus(vector(axes, x, n - 1, 0), vector(axes, x, n, 0))
    t = times(1.0 / math.sqrt(dot(r, r)), r)
    lower, upper = nominal, c.length[n - 1] - nominal
    for of in (x, v, a):
        put(of, n + 1, 0, vector(axes, of, n, 0))
    # At the ship the cable itself moves on with the rate it is paid out at.
    add(v, axes, n, 0, times(reel, t))
    for of in (x, v, a):
        put(of, n, 0, combined(share, vector(axes, of, n, 0), 1.0 - share, vector(axes, of, n - 1, 0)))
    water = current_at(axes, c.current_depth, c.current_x, c.current_y, x[n, len(axes) - 1])
    kn, kt = c.normal_drag[n - 1], c.tangential_drag[n - 1]
    drag = end_force(c.law, kn, kt, minus(vector(axes, v, n, 0), water), t)
    load = raised(minus(drag, times(c.mass[n - 1], vector(axes, a, n, 0))), -c.weight[n - 1])
    along = dot(load, t)
    tension = T[n - 1]
    sag = 0.5 * lower * upper / tension if tension > 0.0 else 0.0
    add(x, axes, n, 0, times(sag, minus(load, times(along, t))))
    T[n - 1] = max(0.0, tension - 0.5 * along * upper)
    T[n] = max(0.0, tension + 0.5 * along * lower)
    c.length[n - 1], c.length[n] = lower, upper
    if tension > 0.0:
        c.length[n - 1] = _fitted(c, n - 1, n, x, v, T[n - 1], 0.0, axes)
        c.length[n] = _fitted(c, n, n + 1, x, v, T[n], reel, axes)


@inner_kernel
def merge(c: Chain, n: int, x: Floats, v: Floats, a: Floats, T: Floats, reel: float, axes: Axes) -> None:
    """Take node n - 1 out: the link of node n - 2 reaches to the ship, which moves to row n - 1."""
    length = c.length[n - 2] + c.length[n - 1]
    T[n - 2] = (c.length[n - 2] * T[n - 2] + c.length[n - 1] * T[n - 1]) / length
    for of in (x, v, a):
        put(of, n - 1, 0, vector(axes, of, n, 0))
    c.length[n - 2] = length
    if T[n - 2] > 0.0:
        c.length[n - 2] = _fitted(c, n - 2, n - 1, x, v, T[n - 2], reel, axes)
