"""Where the nodes go: close together where the cable bends and where lateral waves die out."""

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput
from models.rise import Rise
from models.statics import StaticShape, shape_on, steady_way
from models.tow import Tow

Floats = NDArray[np.float64]

#: Nodes that a radian of bend, and a radian of damped lateral wave near an end, ask for beside one a length of cable;
#: how many of its own lengths such a wave reaches.
_BEND, _LAYER, _REACH = 1.0, 0.35, 3.0
_ROUNDS, _FINE = 3, 400


def joints_of(tow: Tow, way: Rise | None = None) -> Floats:
    """Lengths [m] where coefficients may jump: ends, joints of sections and, with a `way`, kinks of the current."""
    ends = np.concatenate([[0.0], np.cumsum([cable.length for cable in tow.cables])])
    ends[-1] = tow.length
    if way is None or tow.current is None or tow.current.speed.size < 2:
        return ends
    shape, kinks = shape_on(tow, way, _even(ends)), []
    for depth in tow.current.depth.tolist():
        above = shape.z + depth > 0.0
        for i in np.flatnonzero(above[1:] != above[:-1]).tolist():
            kinks.append(_where(way, shape, i, -depth))
    inside = [s for s in kinks if np.min(np.abs(ends - s)) > 1e-6 * tow.length]
    return np.sort(np.concatenate([ends, inside]))


def _where(way: Rise, shape: StaticShape, i: int, z: float) -> float:
    """The length at which the cable passes the height z, between the stations i and i + 1."""
    low, high = float(shape.s[i]), float(shape.s[i + 1])
    s = low + (high - low) * (z - float(shape.z[i])) / float(shape.z[i + 1] - shape.z[i])
    for _ in range(3):
        phi, _, _, level, strain = (float(values[0]) for values in way.at(np.array([s])))
        slope = (1.0 + strain) * math.sin(phi)
        s = min(max(s - (level - way.height - z) / slope, low), high) if slope != 0.0 else s
    return s


def _even(ends: Floats) -> Floats:
    """A fine mesh with equal segments between neighbouring ends."""
    return np.unique(np.concatenate([np.linspace(a, b, _FINE + 1) for a, b in pairwise(ends.tolist())]))


def graded_nodes(
    tow: Tow, segments: int, omega: float, speed: float, *, halvings: int = 1, way: Rise | None = None
) -> Floats:
    """The nodes (n+1,) [m] of a mesh of about so many segments, graded by the steady shape.

    Parameters
    ----------
    segments
        At least two between neighbouring joints, see `joints_of`.
    omega, speed
        Highest frequency [rad/s] and usual lateral speed of the cable [m/s], for the reach of lateral waves.
    halvings
        How often every second node may be dropped and leave a mesh with all joints.
    way
        The steady way up, where it is known already.

    Raises
    ------
    InvalidInput
        Fewer segments than the joints need.

    Notes
    -----
    The density of nodes is 1/L + |phi'| + the damped wave number of the lateral motion near both ends of every
    section, where it decays as exp(-|gamma| s).
    """
    ends = joints_of(tow)
    fine, way = _even(ends), steady_way(tow) if way is None else way
    for _ in range(_ROUNDS):
        # Spread a fine mesh first, so that a tight arc is seen as it is.
        shape = shape_on(tow, way, fine)
        count = _cumulated(tow, shape, ends, omega, speed)
        fine = _spread(shape.s, count, ends, _FINE * (ends.size - 1), 2)
    joints = joints_of(tow, way)
    unit = 2**halvings
    if segments < unit * (joints.size - 1):
        raise InvalidInput(
            f"The cable has {joints.size - 1} stretches between its ends, joints and kinks of the current and needs at "
            f"least {unit * (joints.size - 1)} segments, but {segments} were given."
        )
    return _spread(shape.s, count, joints, segments, unit)


def _cumulated(tow: Tow, shape: StaticShape, ends: Floats, omega: float, speed: float) -> Floats:
    """The integral of the density of nodes from the vehicle up."""
    s = shape.s
    mass = max(cable.mass + cable.added_mass for cable in tow.cables)
    drag = max(cable.normal_drag(tow.water_density) for cable in tow.cables)
    flow = np.abs(shape.flow * np.sin(shape.phi))
    wave = np.sqrt(np.hypot(mass * omega**2, omega * drag * 2.0 * np.maximum(flow, speed)) / shape.T)
    near = np.min(np.abs(s[:, None] - ends[None, :]), axis=1)
    bend = np.abs(np.gradient(np.unwrap(shape.phi), s))
    density = 1.0 / tow.length + _BEND * bend + _LAYER * wave * np.exp(-np.minimum(wave * near / _REACH, 50.0))
    return np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(s))])


def _spread(s: Floats, count: Floats, joints: Floats, segments: int, unit: int) -> Floats:
    """Nodes with an even share of `count` between them, a multiple of `unit` segments between joints."""
    marks = np.interp(joints, s, count)
    shares = np.diff(marks) / marks[-1]
    numbers = [max(unit, unit * round(segments * share / unit)) for share in shares.tolist()]
    largest = int(np.argmax(numbers))
    numbers[largest] = max(unit, numbers[largest] + unit * ((segments - sum(numbers)) // unit))
    parts = [[0.0]]
    for i, number in enumerate(numbers):
        inner = np.interp(np.linspace(marks[i], marks[i + 1], number + 1)[1:-1], count, s)
        parts += [inner.tolist(), [float(joints[i + 1])]]
    return np.concatenate(parts)
