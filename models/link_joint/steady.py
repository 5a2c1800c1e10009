"""The chain's own equilibrium: a straight steady tow, in a current that changes with depth or with its end held.

In the frame that moves with the tow the chain settles by implicit steps of growing size: the first ones let it swing
into place, the last ones are Newton's method for the equilibrium itself.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.link_joint.chain import Chain, Layout, build
from models.link_joint.forces import current_at, end_force
from models.link_joint.stage import Work, assemble, solve_stage, work_for
from models.quantity import NumericalFailure
from models.towed_system import TowedSystem

Floats = NDArray[np.float64]

#: Force out of balance, over the largest tension, that an equilibrium may keep.
_BALANCED = 1e-9
_ROUNDS = 400
#: Least compliance of a link to a held node [1/N].
_HELD = 1e-13
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
        layout = Grading(system, velocity).build(links)
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
    x, T = trailing(layout.chain, layout.count, velocity)
    residual = settle(layout.chain, layout.count, x, np.tile(np.asarray(velocity, dtype=float), (x.shape[0], 1)), T)
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


def trailing(chain: Chain, n: int, velocity: tuple[float, float, float]) -> tuple[Floats, Floats]:
    """Positions and tensions where the search for a steady tow starts, (n + 1, 3) [m] and (n,) [N].

    From the free ends up each link points where the load below it and half its own pull it; the current is taken as if
    the chain hung straight down.
    """
    x, T = np.zeros((n + 1, 3)), np.zeros(n)
    for i in reversed(range(n)):
        x[i, 2] = x[chain.parent[i], 2] - chain.length[i]
    flow = np.tile(velocity, (n + 1, 1))
    for i in range(n if chain.current_depth.size else 0):
        flow[i, :2] -= current_at(chain.current_depth, chain.current_x, chain.current_y, x[i, 2])
    pull, towards = np.zeros((n + 1, 3)), np.zeros((n, 3))
    down = np.array([0.0, 0.0, -1.0])
    for i in range(n):
        u, p = flow[i], int(chain.parent[i])
        if chain.has_body[i]:
            pull[i] += chain.body_weight[i] * down - chain.body_drag[i] * u * math.sqrt(float(u @ u))
        kn, kt, half = chain.normal_drag[i], chain.tangential_drag[i], 0.5 * chain.length[i]
        # A free end has nothing but its own load to go by.
        t = pull[i] / (np.linalg.norm(pull[i]) or 1.0) if pull[i].any() else down
        for _ in range(_TURNS):
            own = half * (np.array(end_force(chain.law, kn, kt, *u, *t)) + chain.weight[i] * down)
            total = pull[i] + own
            size = float(np.linalg.norm(total)) or 1.0
            t = t + total / size
            t /= float(np.linalg.norm(t)) or 1.0
        towards[i], T[i] = t, size
        pull[p] += pull[i] + 2.0 * own
    for i in reversed(range(n)):
        x[i] = x[chain.parent[i]] + chain.length[i] * (1.0 + chain.compliance[i] * T[i]) * towards[i]
    return x, T


def settle(chain: Chain, n: int, x: Floats, v: Floats, T: Floats) -> float:
    """Bring (x, T) to equilibrium at the steady velocities v, all changed in place but the ship's row of x.

    Returns the largest force out of balance over the largest tension.

    Raises
    ------
    NumericalFailure
        The steps do not come to rest; says the node and what is out of balance.
    """
    place = x.copy()
    residual, node, rounds = _settle(chain, n, x, v, T, work_for(n + 1), _ROUNDS)
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
    xh, X, V, dV = np.zeros((m, 3)), np.zeros((m, 3)), np.zeros((m, 3)), np.zeros((m, 3))
    now, dT = np.zeros(n), np.zeros(n)
    g = 5.0
    residual, node = np.inf, 0
    for done in range(1, rounds + 1):
        for i in range(n):
            now[i] = T[i]
            for j in range(3):
                xh[i, j] = x[i, j] - g * v[i, j]
                V[i, j] = v[i, j]
        for j in range(3):
            X[n, j], V[n, j] = x[n, j], v[n, j]
        used, _, _ = solve_stage(c, n, g, xh, v, X, V, now, w, dV, dT, 1e-13)
        if used < 0:
            g *= 0.2
            if g < 1e-6:
                return residual, node, done
            continue
        moved = 0.0
        for i in range(n):
            for j in range(3):
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
                for j in range(3):
                    if abs(w.F[i, j]) > residual:
                        residual, node = abs(w.F[i, j]), i
            residual /= largest
            if residual <= _BALANCED:
                return residual, node, done
        g = min(1e7, g * (3.0 if used < 12 else 1.5))
    return residual, node, rounds
