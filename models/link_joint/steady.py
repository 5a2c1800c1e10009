"""The chain's own equilibrium: a straight steady tow, in a current that changes with depth or with its end held.

In the frame that moves with the tow the chain settles by implicit steps of growing size: the first ones let it swing
into place, the last ones are Newton's method for the equilibrium itself.
"""

import math
from dataclasses import dataclass

import numpy as np

from models.kernels import kernel
from models.link_joint.chain import Chain, Layout, build, current_of
from models.link_joint.columns import Work, columns_of, work_for
from models.link_joint.forces import current_at, end_force
from models.link_joint.plane import Plane, plane_of
from models.link_joint.stage import assemble, solve_stage
from models.link_joint.vectors import (
    Axes,
    Floats,
    Vector,
    add,
    axes_of,
    combined,
    dot,
    minus,
    nought,
    plus,
    put,
    raised,
    times,
    vector,
)
from models.quantity import NumericalFailure
from models.towed_system import TowedSystem

#: Force out of balance, over the largest tension, that an equilibrium may keep.
_BALANCED = 1e-9
_ROUNDS = 400
#: Least compliance of a link to a held node [1/N].
_HELD = 1e-10
#: Repetitions of a link's direction in the first guess.
_TURNS = 4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SteadyTow:
    """Positions (m + 1, 3) [m] with the ship's node last at the origin, tensions (m,) [N] and what is out of balance.

    `residual` is the largest force out of balance over the largest tension. Row `layout.lower_end[k]` is the lower
    end of part k.
    """

    position: Floats
    tension: Floats
    residual: float
    layout: Layout


def steady_tow(
    system: TowedSystem,
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    links: int = 50,
    anchor: tuple[float, float, float] | None = None,
) -> SteadyTow:
    """The discrete chain's equilibrium under a ship with a steady velocity [m/s].

    Parameters
    ----------
    anchor
        Where the lower end of the first part is held [m] from the ship; then the ship must be at rest.

    Raises
    ------
    InvalidInput
        A number of links that a chain cannot have.
    NumericalFailure
        No equilibrium is found; says what is out of balance and where.
    """
    from models.link_joint.grading import Grading

    if anchor is None:
        layout = Grading(system, velocity, plane_of(current_of(system)[1], velocity)).build(links)
        x, T, residual = equilibrium(layout, velocity)
    else:
        layout = build(system, links)
        end = layout.lower_end[0]
        layout.chain.held[end] = True
        # The link to a held node must give a little, or its tension would not be determined.
        layout.chain.compliance[end] = max(layout.chain.compliance[end], _HELD)
        x = _hung_between(layout, np.asarray(anchor, dtype=float))
        T = np.full(layout.count, max(1.0, float(np.sum(layout.chain.weight * layout.chain.length))))
        residual = settle(layout.chain, layout.count, x, np.zeros_like(x), T)
    return SteadyTow(position=x, tension=T, residual=residual, layout=layout)


def equilibrium(layout: Layout, velocity: tuple[float, float, float]) -> tuple[Floats, Floats, float]:
    """Positions from the ship (m + 1, 3), tensions (m,) and what is out of balance, in a steady tow.

    Raises
    ------
    NumericalFailure
        The chain does not come to rest in the frame of the tow.
    """
    chain = layout.chain
    plane = plane_of(np.column_stack([chain.current_x, chain.current_y]), velocity)
    x, T, residual = at_rest(layout, velocity, plane)
    return x if plane is None else plane.in_space(x), T, residual


def at_rest(layout: Layout, velocity: tuple[float, float, float], plane: Plane | None) -> tuple[Floats, Floats, float]:
    """The same along the axes of a plane, (m + 1, 2), or of space."""
    chain, n = layout.chain if plane is None else plane.chain(layout.chain), layout.count
    towed = np.array(velocity) if plane is None else plane.along(np.array(velocity))
    d = towed.size
    x, T = np.zeros((n + 1, d)), np.zeros(n)
    _trail(chain, n, tuple(towed.tolist()), x, T, axes_of(d))
    residual = settle(chain, n, x, np.tile(towed, (n + 1, 1)), T)
    return x, T, residual


def _hung_between(layout: Layout, anchor: Floats) -> Floats:
    """A first guess between the ship and a held end: two straight lines of the cable's length."""
    n = layout.count
    total = float(layout.chain.length.sum())
    share = np.linspace(1.0, 0.0, n + 1)[:, None]
    x = share * anchor
    slack = math.sqrt(max(0.0, total**2 - float(anchor @ anchor))) * 0.5
    x[:, 2] -= slack * (1.0 - np.abs(2.0 * share[:, 0] - 1.0)) + 1e-3 * total * share[:, 0] * (1.0 - share[:, 0])
    return x


@kernel
def _trail(c: Chain, n: int, velocity: Vector, x: Floats, T: Floats, axes: Axes) -> None:
    """Positions (n + 1, d) [m] and tensions (n,) [N] where the search for a steady tow starts.

    From the free ends up each link points where the load below it and half its own pull it; the current is taken as if
    the chain hung straight down.
    """
    d = len(axes)
    pull, towards = np.zeros((n + 1, d)), np.zeros((n, d))
    for j in range(n):
        i = n - 1 - j
        x[i, d - 1] = x[c.parent[i], d - 1] - c.length[i]
    for i in range(n):
        half = 0.5 * c.length[i]
        u = minus(velocity, current_at(axes, c.current_depth, c.current_x, c.current_y, x[i, d - 1]))
        below = vector(axes, pull, i, 0)
        if c.has_body[i]:
            speed = math.sqrt(dot(u, u))
            for k in range(d):
                # The body heads into the flow; upwards is the last axis.
                pull[i, k] -= c.body_drag[i, 2 if k == d - 1 else 0] * speed * u[k]
            pull[i, d - 1] -= c.body_weight[i]
            below = vector(axes, pull, i, 0)
        size = math.sqrt(dot(below, below))
        # A free end has nothing but its own load to go by.
        t = times(1.0 / size, below) if size > 0.0 else raised(nought(axes), -1.0)
        own = nought(axes)
        for _ in range(_TURNS):
            drag = end_force(c.law, c.normal_drag[i], c.tangential_drag[i], u, t)
            own = times(half, raised(drag, -c.weight[i]))
            whole = plus(below, own)
            T[i] = math.sqrt(dot(whole, whole))
            t = plus(t, times(1.0 / (T[i] + 1e-300), whole))
            t = times(1.0 / (math.sqrt(dot(t, t)) + 1e-300), t)
        put(towards, i, 0, t)
        add(pull, axes, c.parent[i], 0, combined(1.0, below, 2.0, own))
    for j in range(n):
        i = n - 1 - j
        stretched = c.length[i] * (1.0 + c.compliance[i] * T[i])
        put(x, i, 0, combined(1.0, vector(axes, x, c.parent[i], 0), stretched, vector(axes, towards, i, 0)))


def settle(chain: Chain, n: int, x: Floats, v: Floats, T: Floats) -> float:
    """Bring (x, T) to equilibrium at the steady velocities v, all changed in place but the ship's row of x.

    Returns the largest force out of balance over the largest tension.

    Raises
    ------
    NumericalFailure
        The steps do not come to rest; says the node and what is out of balance.
    """
    place = x.copy()
    residual, node, rounds = _settle(chain, n, x, v, T, work_for(n + 1, x.shape[1]), _ROUNDS)
    if not residual <= _BALANCED:
        raise NumericalFailure(
            f"The chain of {n} links finds no steady shape: after {rounds} rounds node {node} is out of balance by "
            f"{residual:.3g} of the largest tension. The tow may have no steady state; start at rest or at lower speed."
        )
    x[n] = place[n]
    return residual


@kernel
def _settle(c: Chain, n: int, x: Floats, v: Floats, T: Floats, w: Work, rounds: int) -> tuple[float, int, int]:
    m = n + 1
    axes = w.axes
    col, d = columns_of(axes), len(axes)
    xh, X, V, dV = np.zeros((m, d)), np.zeros((m, d)), np.zeros((m, d)), np.zeros((m, d))
    now, dT = np.zeros(n), np.zeros(n)
    g = 10.0
    residual, node = np.inf, 0
    for done in range(1, rounds + 1):
        for i in range(n):
            now[i] = T[i]
            for j in range(d):
                xh[i, j] = x[i, j] - g * v[i, j]
                V[i, j] = v[i, j]
        for j in range(d):
            X[n, j], V[n, j] = x[n, j], v[n, j]
        used, _, _ = solve_stage(c, n, g, xh, v, X, V, now, w, dV, dT, 1e-13)
        if used < 0:
            g *= 0.2
            if g < 1e-6:
                return residual, node, done
            continue
        moved = 0.0
        for i in range(n):
            for j in range(d):
                moved = max(moved, abs(X[i, j] - x[i, j]))
                x[i, j] = X[i, j]
            T[i] = now[i]
        if g > 1e5 or moved < 1e-9:
            assemble(c, n, 1.0, v, x, v, T, w)
            largest, residual = 1e-300, 0.0
            for i in range(n):
                largest = max(largest, T[i])
                if c.held[i]:
                    continue
                for j in range(d):
                    if abs(w.W[i, col.F + j]) > residual:
                        residual, node = abs(w.W[i, col.F + j]), i
            residual /= largest
            if residual <= _BALANCED:
                return residual, node, done
        g = min(1e7, g * (10.0 if used < 8 else 2.0))
    return residual, node, rounds
