"""A ship's track through waypoints: straights between them, each corner rounded by a turn inside it."""

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from data_synth.settings import check_same_length
from data_synth.ships.forcing import Sample
from data_synth.ships.path import corner, sail, straight, turn
from data_synth.ships.turning import KNOT, Ease, Radius, Speed
from models.quantity import InvalidInput, Quantity, check_quantities
from models.trace import Floats, Trace

_FITS = 1e-9  # share of a leg by which its turns may overlap in rounding


@dataclass(frozen=True, slots=True, kw_only=True)
class Waypoints:
    """From the first to the last of the points on the map at one speed, turning at `radius` before the others.

    The curvature comes and goes within the time `ease`; a turn too small to reach `radius` within it is wider.
    """

    sample: Sample = 1.0
    speed: Speed = 6.0 * KNOT
    points_x: tuple[Annotated[float, Quantity("x", "m")], ...] = (0.0, 3000.0, 3000.0, 0.0)
    points_y: tuple[Annotated[float, Quantity("y", "m")], ...] = (0.0, 0.0, 2000.0, 2000.0)
    radius: Radius = 250.0
    ease: Ease = 10.0

    def __post_init__(self) -> None:
        check_quantities(self)
        check_same_length(self, "points_x", "points_y")
        if len(self.points_x) < 2:
            raise InvalidInput(f"Waypoints needs at least 2 points, but has {len(self.points_x)}.")
        lengths, changes = _legs(self)
        if not lengths.all():
            k = int(np.argmin(lengths)) + 1
            raise InvalidInput(f"Waypoints has points {k} and {k + 1} in one place; drop one.")
        if (np.abs(changes) > math.pi - 1e-9).any():
            k = int(np.argmax(np.abs(changes) > math.pi - 1e-9)) + 2
            raise InvalidInput(f"Waypoints turns straight back at point {k}; put another point beside it.")
        needed = _needed(self, changes)
        short = needed[:-1] + needed[1:] - lengths * (1.0 + _FITS)
        if (short > 0.0).any():
            k = int(np.argmax(short))
            raise InvalidInput(
                f"Waypoints needs {needed[k] + needed[k + 1]:.4g} m for the turns at both ends of the leg from point "
                f"{k + 1} to {k + 2}, but it has {lengths[k]:.4g} m; make the radius smaller or the leg longer."
            )


def waypoints(settings: Waypoints) -> Trace:
    """Straights and turns through the points; corners are passed inside, at the turn's own distance."""
    lengths, changes = _legs(settings)
    needed = _needed(settings, changes)
    pieces = []
    for k, length in enumerate(lengths):
        pieces += straight(float(length - needed[k] - needed[k + 1]))
        if k < changes.size:
            pieces += turn(float(changes[k]), settings.radius, settings.speed * settings.ease)
    x, y = settings.points_x, settings.points_y
    heading = math.atan2(y[1] - y[0], x[1] - x[0])
    return sail(pieces, settings.speed, settings.sample, heading=heading, start=(x[0], y[0]))


def _legs(settings: Waypoints) -> tuple[Floats, Floats]:
    """Length [m] of every leg, and change of heading [rad] between each two."""
    dx, dy = np.diff(settings.points_x), np.diff(settings.points_y)
    turned = np.diff(np.arctan2(dy, dx))
    return np.hypot(dx, dy), np.asarray(np.remainder(turned + np.pi, 2.0 * np.pi) - np.pi, dtype=float)


def _needed(settings: Waypoints, changes: Floats) -> Floats:
    """Length [m] that the turn at every point, the first and last included, takes of each leg beside it."""
    ease = settings.speed * settings.ease
    return np.array([0.0, *(corner(float(change), settings.radius, ease) for change in changes), 0.0])
