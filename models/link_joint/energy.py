"""The account of energy: what the chain holds, and the power of all that works on it.

Over all moving nodes and links, the ship's own half link left out,

    d/dt [ sum m v^2/2 + sum w z + sum l T^2/(2 EA) ] = ship's power + drag's power + added mass' power - internal loss.
"""

import math

from models.kernels import inner_kernel, kernel
from models.link_joint.chain import Chain
from models.link_joint.columns import Work, columns_of
from models.link_joint.forces import FAR, NEAR, body_axes, current_at, directions, end_force, water_at
from models.link_joint.vectors import Axes, Floats, applied, combined, dot, minus, times, vector


@kernel
def energy_of(c: Chain, n: int, X: Floats, V: Floats, T: Floats, w: Work) -> float:
    """Kinetic, potential and elastic energy of the moving nodes [J]; the ship's half link does not count."""
    total, axes = 0.0, w.axes
    up = len(axes) - 1
    for i in range(n):
        p = c.parent[i]
        half = 0.5 * c.length[i]
        for end in range(2):
            q = i if end == 0 else p
            if q < n:
                v = vector(axes, V, q, 0)
                total += half * (0.5 * c.mass[i] * dot(v, v) + c.weight[i] * X[q, up])
        stretch = T[i] if c.damping[i] == 0.0 else _elastic_part(c, i, p, X, axes)
        total += half * c.compliance[i] * stretch * stretch
        if c.has_body[i]:
            v = vector(axes, V, i, 0)
            total += 0.5 * c.body_mass[i] * dot(v, v) + c.body_weight[i] * X[i, up]
    return total


@inner_kernel
def _elastic_part(c: Chain, i: int, p: int, X: Floats, axes: Axes) -> float:
    """Tension of the stretch alone, without the internal loss [N]; none where the link is shorter than unstretched."""
    up = len(axes) - 1
    r = minus(vector(axes, X, i, 0), vector(axes, X, p, 0))
    depth = -0.5 * (X[i, up] + X[p, up])
    pressure = (1.0 - 2.0 * c.poisson[i]) * c.specific_weight * depth * c.area[i]
    tension: float = (math.sqrt(dot(r, r)) / c.length[i] - 1.0) / c.compliance[i] + pressure
    return max(0.0, tension)


@kernel
def power_of(c: Chain, n: int, X: Floats, V: Floats, A: Floats, T: Floats, w: Work) -> tuple[float, float]:
    """Power of all that works on the chain, and of it the drag's, both [W]; the ship's velocity in row n of V."""
    drag, other = 0.0, 0.0
    parent, part, lengths, compliance, damping = c.parent, c.part, c.length, c.compliance, c.damping
    poisson, added, has_body, held, law = c.poisson, c.added_mass, c.has_body, c.held, c.law
    normal_drag, tangential_drag = c.normal_drag, c.tangential_drag
    depths, current_x, current_y, W, reel = c.current_depth, c.current_x, c.current_y, w.W, w.reel[0]
    axes, still = w.axes, depths.size == 0
    col, up = columns_of(axes), len(axes) - 1
    directions(part, parent, lengths, n, X, W, axes)
    for i in range(n):
        p = parent[i]
        half = 0.5 * lengths[i]
        t = vector(axes, W, i, col.TANGENT)
        e = W[i, col.SIZE] / lengths[i] - 1.0
        swell = 1.0 if compliance[i] == 0.0 or e < 0.0 else (1.0 + e) * (1.0 - poisson[i] * e)
        kn, kt = normal_drag[i] * half * swell, tangential_drag[i] * half * swell
        ma = added[i] * half
        for end in range(2):
            q, o, at = (i, p, col.LOWER) if end == 0 else (p, i, col.UPPER)
            if q == n or held[q]:
                continue
            v, a = vector(axes, V, q, 0), vector(axes, A, q, 0)
            u = combined(NEAR, v, FAR, vector(axes, V, o, 0))
            if not still:
                u = minus(u, water_at(axes, depths, current_x, current_y, X[q, up], X[o, up]))
            drag += dot(end_force(law, kn, kt, u, vector(axes, W, i, at)), v)
            other -= ma * dot(minus(a, times(dot(a, t), t)), v)
        if has_body[i]:
            v = vector(axes, V, i, 0)
            u = minus(v, current_at(axes, depths, current_x, current_y, X[i, up]))
            D = body_axes(c.body_drag[i, 0], c.body_drag[i, 1], c.body_drag[i, 2], t)
            M = body_axes(c.body_added_mass[i, 0], c.body_added_mass[i, 1], c.body_added_mass[i, 2], t)
            drag -= math.sqrt(dot(u, u)) * dot(applied(D, u), v)
            other -= dot(applied(M, vector(axes, A, i, 0)), v)
        if damping[i] > 0.0:
            rate = dot(t, minus(vector(axes, V, i, 0), vector(axes, V, p, 0)))
            if p == n:
                rate -= reel
            other -= (T[i] - _elastic_part(c, i, p, X, axes)) * rate
        if p == n:
            # The ship pulls its own end, and lets out cable under tension.
            other -= T[i] * dot(t, vector(axes, V, n, 0))
            if reel != 0.0:
                v = vector(axes, V, i, 0)
                entered = 0.5 * (0.5 * c.mass[i] * dot(v, v) + c.weight[i] * X[i, up])
                other += reel * (entered - T[i] * (1.0 + 0.5 * compliance[i] * T[i]))
    return drag + other, drag
