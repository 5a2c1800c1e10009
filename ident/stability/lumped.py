"""A plain lumped-mass chain in the plane, written apart from the simulators, with two steppers that have a limit.

n equal lengths of cable, each a spring of stiffness EA/l that only pulls, half of each on the node at either end; the
last node is the ship. Drag by components on the mean of the two directions at a node, on the stretched area. Used to
show that what the catalogue asks for tells a step within the limit from one beyond it.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.quantity import NumericalFailure
from models.towed_system import TowedSystem

Floats = NDArray[np.float64]

#: Nodes that move faster than this [m/s] have left all bounds.
_WILD = 1e3


class Lumped:
    """The chain of a one-part system; node 0 is the body, node n the ship."""

    def __init__(self, system: TowedSystem, nodes: int) -> None:
        cable, body, rho = system.parts[0].cable, system.parts[0].body, system.water_density
        assert body is not None
        self.n, self.size = nodes, cable.length / nodes
        self.stiffness, self.poisson = cable.axial_stiffness, cable.poisson_ratio
        share = np.full(nodes, self.size)
        share[0] *= 0.5
        self.weight = cable.weight_in_water * share
        self.weight[0] += body.weight_in_water
        self.mass, self.added = cable.mass * share, cable.added_mass * share
        self.mass[0] += body.mass + body.added_mass_surge
        self.k_n, self.k_t = cable.normal_drag(rho) * share, cable.tangential_drag(rho) * share
        self.k_b = 0.5 * rho * body.drag_coefficient * body.area_surge

    def hanging(self) -> Floats:
        """(n + 1, 2) places at rest below the ship [m]."""
        T = np.cumsum(self.weight)
        z = np.concatenate([-np.cumsum((self.size * (1.0 + T / self.stiffness))[::-1])[::-1], [0.0]])
        return np.column_stack([0.0 * z, z])

    def links(self, x: Floats) -> tuple[Floats, Floats]:
        """Directions toward the ship (n, 2) and tensions (n,) [N]."""
        r = np.diff(x, axis=0)
        length = np.hypot(r[:, 0], r[:, 1])
        return r / length[:, None], self.stiffness * np.maximum(0.0, length / self.size - 1.0)

    def forces(self, x: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """Forces (n, 2) on the moving nodes and the directions of the cable there, and of the links."""
        t, T = self.links(x)
        pull = T[:, None] * t
        F = pull.copy()
        F[1:] -= pull[:-1]
        F[:, 1] -= self.weight
        at = t.copy()
        at[1:] += t[:-1]
        at /= np.hypot(at[:, 0], at[:, 1])[:, None]
        v = v[:-1]
        along = np.sum(v * at, axis=1)
        across = v - along[:, None] * at
        e = T / self.stiffness
        swell = (1.0 + e) * (1.0 - self.poisson * e)
        swell[1:] = 0.5 * (swell[1:] + swell[:-1])
        F -= (self.k_n * swell * np.hypot(across[:, 0], across[:, 1]))[:, None] * across
        F -= (self.k_t * swell * np.abs(along) * along)[:, None] * at
        F[0] -= self.k_b * math.hypot(*v[0]) * v[0]
        return F, at, t

    def accelerations(self, x: Floats, v: Floats) -> Floats:
        """(n, 2) [m/s2], the cable's added mass across it alone."""
        F, at, _ = self.forces(x, v)
        along = np.sum(F * at, axis=1)[:, None] * at
        return np.asarray(along / self.mass[:, None] + (F - along) / (self.mass + self.added)[:, None])


def _ship(t: float, speed: float, rise: float) -> tuple[float, float]:
    """Place and speed of a ship that starts within `rise` along half a cosine."""
    s = min(t, rise)
    moved = 0.5 * (s - rise / math.pi * math.sin(math.pi * s / rise)) + max(0.0, t - rise)
    return speed * moved, speed * 0.5 * (1.0 - math.cos(math.pi * s / rise))


def march(chain: Lumped, speed: float, duration: float, step: float, *, implicit: bool = False) -> tuple[Floats, float]:
    """Place of the body from the ship (2,) [m] and top tension [N] after `duration`.

    Fourth-order Runge-Kutta; or, `implicit`, one linear solve a step in which a link's stiffness along itself is
    implicit and its direction stays as it was: no limit from the stretching, but still one from the swinging.

    Raises
    ------
    NumericalFailure
        A node leaves all bounds.
    """
    x = chain.hanging()
    v = np.zeros_like(x)
    top = chain.n
    steps = round(duration / step)

    def place(x: Floats, v: Floats, t: float) -> tuple[Floats, Floats]:
        x[top, 0], v[top, 0] = _ship(t, speed, 60.0)
        return x, v

    for k in range(steps):
        t = k * step
        if implicit:
            x, v = _implicit(chain, x, v, step, _ship(t + step, speed, 60.0))
        else:
            X, V = x[:top], v[:top]
            a1 = chain.accelerations(x, v)
            x2, v2 = place(_with(X + 0.5 * step * V), _with(V + 0.5 * step * a1), t + 0.5 * step)
            a2 = chain.accelerations(x2, v2)
            x3, v3 = place(_with(X + 0.5 * step * v2[:top]), _with(V + 0.5 * step * a2), t + 0.5 * step)
            a3 = chain.accelerations(x3, v3)
            x4, v4 = place(_with(X + step * v3[:top]), _with(V + step * a3), t + step)
            a4 = chain.accelerations(x4, v4)
            new = X + step / 6.0 * (V + 2.0 * v2[:top] + 2.0 * v3[:top] + v4[:top])
            x, v = place(_with(new), _with(V + step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)), t + step)
        if not np.abs(v).max() < _WILD:
            raise NumericalFailure(f"The plain chain leaves all bounds at t = {t + step:g} s with steps of {step:g} s.")
    directions, T = chain.links(x)
    # A link's tension is that of its middle; half its weight more is at the ship.
    return x[0] - x[top], float(T[-1] + 0.5 * chain.weight[-1] * directions[-1, 1])


def _with(inner: Floats) -> Floats:
    """The moving nodes with a row for the ship."""
    return np.vstack([inner, np.zeros((1, 2))])


def _implicit(c: Lumped, x: Floats, v: Floats, h: float, ship: tuple[float, float]) -> tuple[Floats, Floats]:
    """One step: (M + h^2 K) v' = M v + h (F + drag made linear), K of the links' stretching alone."""
    n = c.n
    F, at, t = c.forces(x, v)
    A, b = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
    taut = c.links(x)[1] > 0.0
    for i in range(n):
        here = slice(2 * i, 2 * i + 2)
        along = np.outer(at[i], at[i])
        mass = (c.mass[i] + c.added[i]) * (np.eye(2) - along) + c.mass[i] * along
        A[here, here] += mass
        b[here] += mass @ v[i] + h * F[i]
        spring = h * h * c.stiffness / c.size * float(taut[i]) * np.outer(t[i], t[i])
        A[here, here] += spring
        if i + 1 < n:
            above = slice(2 * i + 2, 2 * i + 4)
            A[above, above] += spring
            A[here, above] -= spring
            A[above, here] -= spring
        else:
            b[here] += spring @ np.array([(ship[0] - x[n, 0]) / h, 0.0])
    new = np.linalg.solve(A, b).reshape(n, 2)
    x, v = x.copy(), v.copy()
    v[:n], v[n] = new, [ship[1], 0.0]
    x[:n] += h * new
    x[n, 0] = ship[0]
    return x, v
