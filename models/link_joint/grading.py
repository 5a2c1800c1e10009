"""Where the links are: short ones where the cable bends in a steady tow, long ones where it is straight.

A heavy body on a fast tow bends the cable over the length T/(k_n U^2) above it, a few links of an even chain; there
lies most of an even chain's error. The lengths share out the square root of the curvature evenly over the links, so
that the error still falls at second order as links are added.
"""

from dataclasses import replace

import numpy as np

from models.link_joint.chain import Layout, build
from models.link_joint.plane import Plane
from models.link_joint.steady import at_rest
from models.link_joint.vectors import Floats
from models.quantity import NumericalFailure
from models.towed_system import TowedSystem

#: Links of the first part that curvature is read from.
_READ = 60
#: Curvature that counts as none, as a turn over the whole part [rad], and the even share in what is shared out.
_STRAIGHT, _EVEN = 0.05, 1.0


class Grading:
    """The shape of the steady tow at one velocity [m/s], and chains of any number of links that follow it.

    The velocity and the current lie in the `plane`, where one is given.
    """

    def __init__(self, system: TowedSystem, velocity: tuple[float, float, float], plane: Plane | None) -> None:
        self._system = system
        self._shares: list[tuple[Floats, Floats]] = []
        even = build(system, _READ)
        try:
            x, _, _ = at_rest(even, velocity, plane)
        except NumericalFailure:
            return
        self._shares = [_share(even, x, part) for part in range(len(even.links))]

    def build(self, links: int) -> Layout:
        """The chain with `links` on its first part."""
        layout = build(self._system, links)
        if not self._shares:
            return layout
        length = layout.chain.length.copy()
        for (s, share), end, count in zip(self._shares, layout.lower_end, layout.links, strict=True):
            length[end : end + count] = np.diff(np.interp(np.linspace(0.0, 1.0, count + 1), share, s))
        return replace(layout, chain=layout.chain._replace(length=length))


def _share(layout: Layout, x: Floats, part: int) -> tuple[Floats, Floats]:
    """Unstretched length s from a part's lower end, and the share of its links below s, from 0 to 1."""
    first, count = layout.lower_end[part], layout.links[part]
    links = slice(first, first + count)
    r = x[links] - x[layout.chain.parent[links]]
    t = r / np.linalg.norm(r, axis=1)[:, None]
    length = layout.chain.length[links]
    total = float(length.sum())
    turn = np.linalg.norm(np.diff(t, axis=0), axis=1) / (0.5 * (length[1:] + length[:-1]))
    curvature = np.concatenate([turn[:1], turn, turn[-1:]])
    mean = float(np.sum(turn * 0.5 * (length[1:] + length[:-1]))) / total
    density = np.sqrt(curvature + _EVEN * mean + _STRAIGHT / total)
    s = np.concatenate([[0.0], np.cumsum(length)])
    share = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * length)])
    return s, share / share[-1]
