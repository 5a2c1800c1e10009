"""The vertical plane of a scene whose ship, current and start lie in one: the chain then moves along two axes.

Where nothing pushes across that plane nothing leaves it, so that the chain without its third axis is the whole one.
"""

from dataclasses import dataclass, replace

import numpy as np

from models.link_joint.chain import Chain
from models.link_joint.vectors import Floats
from models.trace import Trace

#: What is across the plane by no more than this share of the largest is rounding.
_ROUNDING = 8.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True, kw_only=True)
class Plane:
    """All points o + s (x, y, 0) + z (0, 0, 1), with the unit vector (x, y) and o = `offset` (-y, x, 0) [m]."""

    x: float
    y: float
    offset: float = 0.0

    def along(self, vectors: Floats) -> Floats:
        """Components (..., 2) of vectors (..., 3) along the plane and up."""
        made = np.empty((*vectors.shape[:-1], 2))
        np.multiply(self.x, vectors[..., 0], out=made[..., 0])
        if self.y != 0.0:
            made[..., 0] += self.y * vectors[..., 1]
        made[..., 1] = vectors[..., 2]
        return made

    def in_space(self, vectors: Floats) -> Floats:
        """Vectors (..., 3) from their components (..., 2)."""
        made = np.empty((*vectors.shape[:-1], 3))
        np.multiply(self.x, vectors[..., 0], out=made[..., 0])
        np.multiply(self.y, vectors[..., 0], out=made[..., 1])
        made[..., 2] = vectors[..., 1]
        return made

    def places_in_space(self, places: Floats) -> Floats:
        """Positions (..., 3) from their components (..., 2)."""
        made = self.in_space(places)
        if self.offset != 0.0:
            made += np.array([-self.offset * self.y, self.offset * self.x, 0.0])
        return made

    def chain(self, chain: Chain) -> Chain:
        """The chain with the current along the plane, and none across."""
        current = self.x * chain.current_x + self.y * chain.current_y
        return chain._replace(current_x=np.ascontiguousarray(current), current_y=np.zeros(0))


def plane_of(current: Floats, velocity: tuple[float, float, float], ship: Trace | None = None) -> Plane | None:
    """The plane of a ship's track, a current (k, 2) and a velocity; ``None`` where they do not share one."""
    flows = np.concatenate([[velocity[:2]], current])
    if ship is None:
        return _through(flows)
    # The spline between the samples is a sum of them and leaves no plane that they are in.
    places = ship.position[:, :2]
    moved, smallest = places - places[0], _ROUNDING * float(np.abs(places).max())
    plane = _through(moved, smallest) if np.abs(moved).max() > smallest else _through(flows)
    if plane is None or _largest_across(plane, flows) > _ROUNDING * float(np.abs(flows).max()):
        return None
    return replace(plane, offset=plane.x * float(places[0, 1]) - plane.y * float(places[0, 0]))


def _through(vectors: Floats, smallest: float = 0.0) -> Plane | None:
    """The plane along all horizontal vectors (k, 2), that of x where all are zero; what is `smallest` is rounding."""
    sizes = np.hypot(vectors[:, 0], vectors[:, 1])
    largest = int(sizes.argmax())
    if sizes[largest] == 0.0:
        return Plane(x=1.0, y=0.0)
    x, y = vectors[largest] / sizes[largest]
    plane = Plane(x=float(x), y=float(y))
    across = _largest_across(plane, vectors)
    return plane if across <= max(smallest, _ROUNDING * float(sizes[largest])) else None


def _largest_across(plane: Plane, vectors: Floats) -> float:
    """Largest component of horizontal vectors (..., 2) across the plane."""
    return float(np.abs(plane.x * vectors[..., 1] - plane.y * vectors[..., 0]).max(initial=0.0))
