"""A look around the first guess: is it off by orders of magnitude, and where does the search better begin.

A record tells the scales of drag, mass and delay, but not from everywhere: far above and far below, the cost hardly
changes along some directions, or falls into a valley with the wrong split of the drag, and a simplex ends there. So
the cost is looked at far above and far below the guess, along every parameter and along the few directions that set
the scales of a model and split its drag. Where nothing is much better, as about a guess made from physics, that is all.
Where something is, the guess is far off, and shorter and shorter steps along these directions follow the fall of the
cost before the simplex does.
"""

import math
from collections.abc import Sequence

import numpy as np

from ident.cases import Floats
from ident.objective import Objective, rms
from ident.search_space import SearchSpace

#: Factor of the look, of the first steps after it, and how often those are halved in their logarithm.
LOOK, STEP, HALVINGS = 60.0, 8.0, 2

#: A guess whose cost is below this share of the RMS velocity is not far off, and not looked around.
SMALL = 1e-3

#: A place is much better than the guess if its cost is below this share of the guess's.
MUCH = 0.6

#: Shares of a move that parameters take together: the scales, and the split of the drag.
TOGETHER = (
    {"spring": 1.0, "damping": 1.0},
    {"cable_drag": 1.0, "vehicle_drag": 1.0},
    {"cable_drag": 0.6, "vehicle_drag": -0.6},
    {"cable_mass": 1.0, "vehicle_mass": 1.0},
)

#: Share of a move that a delay takes, whose coordinate spans less.
DELAY = 0.6


def scout(objective: Objective, guess: Floats) -> Floats:
    """(p,) where the search begins: the guess, whose cost the objective has seen, or a place of much lower cost.

    Raises
    ------
    BudgetSpent
        No simulation is left.
    """
    cost = objective.best
    if cost < SMALL * rms(np.concatenate([case.velocity for case in objective.cases])):
        return guess
    lowest, _ = _lowest(objective, guess, _moves(objective.space, first=True), math.log(LOOK))
    if not lowest < MUCH * cost:
        return guess
    moves = _moves(objective.space)
    place, lowest, step = guess, cost, math.log(STEP)
    for _ in range(HALVINGS + 1):
        found, there = _lowest(objective, place, moves, step)
        while found < lowest:
            place, lowest = there, found
            found, there = _lowest(objective, place, moves, step)
        step *= 0.5
    return place


def _moves(space: SearchSpace, *, first: bool = False) -> list[Floats]:
    """(p,) moves of several parameters together, and of each alone, either way; not one drag alone away at first."""
    together = [np.array([shares.get(name, 0.0) for name in space.names]) for shares in TOGETHER]
    moves = [side * row for row in together if np.count_nonzero(row) > 1 for side in (-1.0, 1.0)]
    drags = {"cable_drag", "vehicle_drag"}
    for j, name in enumerate(space.names):
        alone = np.zeros(space.size)
        alone[j] = DELAY if space.shift[j] > 0.0 else 1.0
        moves.append(alone)
        # The smaller of two drags taken away would mend a total that is a little too large, and look like a find.
        if not (first and name in drags <= set(space.names)):
            moves.append(-alone)
    return moves


def _lowest(objective: Objective, place: Floats, moves: Sequence[Floats], step: float) -> tuple[float, Floats]:
    """The lowest cost after one of the moves of this length, and where."""
    space = objective.space
    places = [np.clip(place + step * move, space.lower, space.upper) for move in moves]
    costs = [objective(there) for there in places]
    best = int(np.argmin(costs))
    return costs[best], places[best]
