"""Paths of a ship on the map at one speed: straights and turns, the curvature running linearly between.

A turn is an arc of its exact radius between two clothoids, so that the acceleration across the path is continuous
and the jerk bounded. Headings follow in closed form, positions by Gauss quadrature to the last digits.

==========  ====================================================
symbol      meaning
==========  ====================================================
s           distance along the path [m]
kappa       curvature, positive to port [1/m]
psi         heading from +X, counterclockwise seen from above [rad]
==========  ====================================================
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from data_synth.ships.motion import sample_times
from models.trace import Floats, Trace

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_LARGEST_ARC = 0.5  # rad within one quadrature interval: its error is then below 1e-15 of the interval


class Piece(NamedTuple):
    """A stretch of path: its length [m], and its curvature [1/m] at both ends."""

    length: float
    begin: float
    end: float


def straight(length: float) -> list[Piece]:
    """A straight [m]; nothing where it has no length."""
    return [Piece(length, 0.0, 0.0)] if length > 0.0 else []


def turn(angle: float, radius: float, ease: float) -> list[Piece]:
    """A change of heading by `angle` [rad] on an arc of `radius` [m], entered and left over `ease` [m].

    A turn too small to reach that radius keeps `ease` and peaks at the smaller curvature ``angle/ease``.
    """
    if angle == 0.0:
        return []
    kappa = math.copysign(min(1.0 / radius, abs(angle) / ease), angle)
    arc = max(angle / kappa - ease, 0.0)
    return [Piece(ease, 0.0, kappa), *([Piece(arc, kappa, kappa)] if arc else []), Piece(ease, kappa, 0.0)]


def sail(
    pieces: Iterable[Piece],
    speed: float,
    sample: float,
    *,
    heading: float = 0.0,
    start: tuple[float, float] = (0.0, 0.0),
) -> Trace:
    """The ship along a path at `speed` [m/s], seen every `sample` [s], with its exact velocity."""
    pieces = list(pieces)
    t = sample_times(sum(piece.length for piece in pieces) / speed, sample)
    xy, psi = _followed(pieces, speed * t, heading)
    return level(t, xy + np.array(start), speed * np.column_stack([np.cos(psi), np.sin(psi)]))


def level(t: Floats, xy: Floats, velocity: Floats) -> Trace:
    """A trace at z = 0 from positions [m] and velocities [m/s] on the map, each (n, 2)."""
    nothing = np.zeros(t.size)
    return Trace(t=t, position=np.column_stack([xy, nothing]), velocity=np.column_stack([velocity, nothing]))


def corner(angle: float, radius: float, ease: float) -> float:
    """Distance [m] from the corner of two straights at which a turn from one into the other begins, and ends."""
    pieces = turn(angle, radius, ease)
    if not pieces:
        return 0.0
    xy, _ = _followed(pieces, np.array([sum(piece.length for piece in pieces)]), 0.0)
    return float(xy[0, 0]) / (1.0 + math.cos(angle))


def _followed(pieces: list[Piece], s: Floats, heading: float) -> tuple[Floats, Floats]:
    """Positions (n, 2) from the path's begin and headings (n,) at increasing distances (n,)."""
    length, begin, end = np.array(pieces).T
    first = np.concatenate([[0.0], np.cumsum(length)])
    turned = heading + np.concatenate([[0.0], np.cumsum(0.5 * (begin + end) * length)])

    def psi(at: Floats, part: np.ndarray) -> Floats:
        u = at - first[part]
        return np.asarray(turned[part] + (begin[part] + 0.5 * (end - begin)[part] / length[part] * u) * u)

    def part_of(at: Floats) -> np.ndarray:
        return np.clip(np.searchsorted(first, at, side="right") - 1, 0, length.size - 1)

    knots = np.union1d(np.concatenate([[0.0], s]), first[first < s[-1]])
    kappa = max(np.abs(begin).max(), np.abs(end).max())
    split = math.ceil(max(kappa * np.diff(knots).max() / _LARGEST_ARC, 1.0))
    fine = np.append((knots[:-1, None] + np.diff(knots)[:, None] * np.arange(split) / split).ravel(), knots[-1])
    half, middle = 0.5 * np.diff(fine), 0.5 * (fine[1:] + fine[:-1])
    at = psi(middle[:, None] + half[:, None] * _NODES, part_of(middle)[:, None])
    steps = half[:, None] * np.column_stack([np.cos(at) @ _WEIGHTS, np.sin(at) @ _WEIGHTS])
    xy = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])[::split]
    return xy[np.searchsorted(knots, s)], psi(s, part_of(s))
