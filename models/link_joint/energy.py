"""The account of energy: what the chain holds, and the power of all that works on it.

Over all moving nodes and links, the ship's own half link left out,

    d/dt [ sum m v^2/2 + sum w z + sum l T^2/(2 EA) ] = ship's power + drag's power + added mass' power - internal loss.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.link_joint import columns as col
from models.link_joint.chain import Chain
from models.link_joint.forces import FAR, NEAR, body_axes, current_at, directions, end_force, water_at
from models.link_joint.stage import Work

Floats = NDArray[np.float64]


@kernel
def energy_of(c: Chain, n: int, X: Floats, V: Floats, T: Floats) -> float:
    """Kinetic, potential and elastic energy of the moving nodes [J]; the ship's half link does not count."""
    total = 0.0
    for i in range(n):
        p = c.parent[i]
        half = 0.5 * c.length[i]
        for end in range(2):
            q = i if end == 0 else p
            if q < n:
                speed = V[q, 0] * V[q, 0] + V[q, 1] * V[q, 1] + V[q, 2] * V[q, 2]
                total += half * (0.5 * c.mass[i] * speed + c.weight[i] * X[q, 2])
        stretch = T[i] if c.damping[i] == 0.0 else _elastic_part(c, i, p, X)
        total += half * c.compliance[i] * stretch * stretch
        if c.has_body[i]:
            speed = V[i, 0] * V[i, 0] + V[i, 1] * V[i, 1] + V[i, 2] * V[i, 2]
            total += 0.5 * c.body_mass[i] * speed + c.body_weight[i] * X[i, 2]
    return total


@kernel
def _elastic_part(c: Chain, i: int, p: int, X: Floats) -> float:
    """Tension of the stretch alone, without the internal loss [N]; none where the link is shorter than unstretched."""
    rx, ry, rz = X[i, 0] - X[p, 0], X[i, 1] - X[p, 1], X[i, 2] - X[p, 2]
    size = math.sqrt(rx * rx + ry * ry + rz * rz)
    depth = -0.5 * (X[i, 2] + X[p, 2])
    pressure = (1.0 - 2.0 * c.poisson[i]) * c.specific_weight * depth * c.area[i]
    tension: float = (size / c.length[i] - 1.0) / c.compliance[i] + pressure
    return max(0.0, tension)


@kernel
def power_of(c: Chain, n: int, X: Floats, V: Floats, A: Floats, T: Floats, w: Work) -> tuple[float, float]:
    """Power of all that works on the chain, and of it the drag's, both [W]; the ship's velocity in row n of V."""
    drag, other = 0.0, 0.0
    parent, part, lengths, compliance, damping = c.parent, c.part, c.length, c.compliance, c.damping
    poisson, added, has_body, held, law = c.poisson, c.added_mass, c.has_body, c.held, c.law
    normal_drag, tangential_drag = c.normal_drag, c.tangential_drag
    depths, current_x, current_y, W, reel = c.current_depth, c.current_x, c.current_y, w.W, w.reel[0]
    still = depths.size == 0
    directions(part, parent, lengths, n, X, W)
    for i in range(n):
        p = parent[i]
        half = 0.5 * lengths[i]
        tx, ty, tz = W[i, col.TANGENT], W[i, col.TANGENT + 1], W[i, col.TANGENT + 2]
        e = W[i, col.SIZE] / lengths[i] - 1.0
        swell = 1.0 if compliance[i] == 0.0 or e < 0.0 else (1.0 + e) * (1.0 - poisson[i] * e)
        kn, kt = normal_drag[i] * half * swell, tangential_drag[i] * half * swell
        ma = added[i] * half
        for end in range(2):
            q, o, at = (i, p, col.LOWER) if end == 0 else (p, i, col.UPPER)
            if q == n or held[q]:
                continue
            ux, uy, uz = NEAR * V[q, 0] + FAR * V[o, 0], NEAR * V[q, 1] + FAR * V[o, 1], NEAR * V[q, 2] + FAR * V[o, 2]
            if not still:
                cx, cy = water_at(depths, current_x, current_y, X[q, 2], X[o, 2])
                ux -= cx
                uy -= cy
            fx, fy, fz = end_force(law, kn, kt, ux, uy, uz, W[i, at], W[i, at + 1], W[i, at + 2])
            vx, vy, vz = V[q, 0], V[q, 1], V[q, 2]
            drag += fx * vx + fy * vy + fz * vz
            along = A[q, 0] * tx + A[q, 1] * ty + A[q, 2] * tz
            other -= ma * ((A[q, 0] - along * tx) * vx + (A[q, 1] - along * ty) * vy + (A[q, 2] - along * tz) * vz)
        if has_body[i]:
            vx, vy, vz = V[i, 0], V[i, 1], V[i, 2]
            cx, cy = current_at(depths, current_x, current_y, X[i, 2])
            ux, uy = vx - cx, vy - cy
            speed = math.sqrt(ux * ux + uy * uy + vz * vz)
            dxx, dxy, dyy = body_axes(c.body_drag[i, 0], c.body_drag[i, 1], tx, ty)
            drag -= speed * ((dxx * ux + dxy * uy) * vx + (dxy * ux + dyy * uy) * vy + c.body_drag[i, 2] * vz * vz)
            mxx, mxy, myy = body_axes(c.body_added_mass[i, 0], c.body_added_mass[i, 1], tx, ty)
            ax, ay, az = A[i, 0], A[i, 1], A[i, 2]
            other -= (mxx * ax + mxy * ay) * vx + (mxy * ax + myy * ay) * vy + c.body_added_mass[i, 2] * az * vz
        if damping[i] > 0.0:
            rate = tx * (V[i, 0] - V[p, 0]) + ty * (V[i, 1] - V[p, 1]) + tz * (V[i, 2] - V[p, 2])
            if p == n:
                rate -= reel
            other -= (T[i] - _elastic_part(c, i, p, X)) * rate
        if p == n:
            # The ship pulls its own end, and lets out cable under tension.
            other -= T[i] * (tx * V[n, 0] + ty * V[n, 1] + tz * V[n, 2])
            if reel != 0.0:
                speed = V[i, 0] * V[i, 0] + V[i, 1] * V[i, 1] + V[i, 2] * V[i, 2]
                entered = 0.5 * (0.5 * c.mass[i] * speed + c.weight[i] * X[i, 2])
                other += reel * (entered - T[i] * (1.0 + 0.5 * compliance[i] * T[i]))
    return drag + other, drag
