"""The steady shape of a towed cable in a current: the state that motions are counted from.

Symbols: s unstretched length from the vehicle up [m]; phi angle of the cable from the horizontal [rad];
T effective tension [N]; e strain; u = current - tow speed, the water's speed relative to the frame of
the shape [m/s], positive toward +X; k_n, k_t quadratic drag per length [N s2/m3].

    T phi' = w cos phi + k_n c u_n |u_n|,   T' = w sin phi - k_t c u_t |u_t|,
    x' = (1 + e) cos phi,                   z' = (1 + e) sin phi,

with u_n = u sin phi, u_t = u cos phi, e = (T - (1 - 2 nu) p A)/EA and c = (1 + e)(1 - nu e), the change of
the drag area by elongation (H (5)-(6) for nu = 1/2). T (2.8)-(2.9) are the still-tow case without the
tangential drag. In-water weight makes T the effective tension, so no pressure term is added to it.

Integrated as a force, F = T (cos phi, sin phi), which stays smooth where a slack arc turns sharply.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.balance import end_force, towfish_steady_force
from models.current import Current
from models.quantity import InvalidInput, NumericalFailure
from models.rise import Rise, SlackCable, rise
from models.tow import Tow

__all__ = [
    "SlackCable",
    "StaticShape",
    "end_force",
    "flow_at",
    "length_for_depth",
    "midpoint_travel_time",
    "static_shape",
    "towfish_steady_force",
    "travel_time",
]

Floats = NDArray[np.float64]

#: Depth iterations of a shape in a sheared current, and the closure they must reach [m].
_DEPTH_ITERATIONS = 60
_DEPTH_CLOSURE = 1e-9
#: Slack is believed when a step of this share of the length from another depth does not take it away.
_NEARER = 1e-3
#: A cable that stands out of the water by this share of its length has no shape here.
_OUT_OF_WATER = 1e-6
#: The longest cable that a depth is reached with, in depths.
_LONGEST = 100.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StaticShape:
    """The steady shape at n + 1 stations, vehicle first.

    `s`, `x`, `z` [m] with x and z counted from the tow point, z up; `phi` [rad], without jumps; `T` [N] effective;
    `strain` [-], where two sections meet that of the lower one; `flow` [m/s] the water's speed relative to the frame;
    `pitch` [rad] of a towfish, else 0.
    """

    s: Floats
    phi: Floats
    T: Floats
    x: Floats
    z: Floats
    strain: Floats
    flow: Floats
    pitch: float = 0.0

    def tension_at(self, s: ArrayLike) -> Floats:
        """Effective tension [N] at the unstretched lengths s [m] from the vehicle."""
        tension: Floats = np.interp(np.asarray(s, dtype=float), self.s, self.T)
        return tension

    @property
    def depth(self) -> float:
        """Depth of the cable's lower end [m]."""
        return -float(self.z[0])

    @property
    def trail(self) -> float:
        """Horizontal distance of the lower end behind the tow point, positive toward -X [m]."""
        return -float(self.x[0])


def static_shape(tow: Tow, *, stations: int = 240, nodes: ArrayLike | None = None) -> StaticShape:
    """Integrate the steady shape up from the vehicle's own force and moment balance.

    Parameters
    ----------
    stations
        Number of equal segments between the places that the shape is told at, at least 2. They do not steer the
        integration, which keeps a relative error of 1e-11 a step.
    nodes
        (n + 1,) [m] those places themselves, unstretched lengths from the vehicle: 0 to `tow.length`, increasing.

    Raises
    ------
    InvalidInput
        Fewer than 2 segments, nodes out of order, a current across X, a towfish without a stable pitch angle, or a
        cable that comes out of the water.
    SlackCable
        The tension falls to zero below the tow point.
    NumericalFailure
        The depth of the vehicle in a sheared current does not settle.

    Notes
    -----
    T (2.8)-(2.9) with the tangential drag kept; see the module docstring.
    """
    s = _equal(tow.length, stations) if nodes is None else _checked(nodes, tow.length)
    return _told(tow, steady_way(tow), s)


def shape_on(tow: Tow, way: Rise, nodes: ArrayLike) -> StaticShape:
    """`static_shape` at `nodes`, from its `steady_way` that is there already."""
    return _told(tow, way, _checked(nodes, tow.length))


def steady_way(tow: Tow) -> Rise:
    """The way up from the vehicle in the steady shape, from the depth where it ends at the surface.

    Raises
    ------
    InvalidInput, SlackCable, NumericalFailure
        As of `static_shape`, but for what concerns stations.
    """
    if tow.current is not None:
        _check_in_plane(tow.current)
    depth, miss = tow.length, math.inf
    previous: tuple[float, float] | None = None
    for _ in range(_DEPTH_ITERATIONS):
        try:
            way = rise(tow, depth)
        except SlackCable:
            # Slack at a depth that is only tried need not be slack where the vehicle is.
            nearer = 0.5 * (depth + (0.0 if previous is None else previous[0]))
            if not _depends_on_depth(tow) or abs(depth - nearer) < _NEARER * tow.length:
                raise
            depth = nearer
            continue
        miss = way.height
        if abs(miss) <= _DEPTH_CLOSURE * tow.length or not _depends_on_depth(tow):
            return way
        # Secant on the closure of the depth; the first step is the plain correction.
        step = -miss
        if previous is not None and previous[1] != miss:
            step = -miss * (depth - previous[0]) / (miss - previous[1])
        previous = (depth, miss)
        depth += float(np.clip(step, -0.5 * tow.length, 0.5 * tow.length))
    raise NumericalFailure(
        f"The static shape does not settle: after {_DEPTH_ITERATIONS} iterations the vehicle's depth of "
        f"{depth:.3f} m still misses its own shape by {miss:.3g} m. The current may allow more than one shape."
    )


def length_for_depth(tow: Tow, depth: float) -> Tow:
    """The tow with the shortest upper cable that puts the cable's lower end at `depth` [m]: the two-point form.

    Its own `cable.length` does not matter. The reverse, the depth that a length gives, is `static_shape`.

    Raises
    ------
    InvalidInput
        No length does; says which depths there are.
    SlackCable
        The tension falls to zero on the way up.
    """
    if not (depth > 0.0 and math.isfinite(depth)):
        raise InvalidInput(f"The depth must be above 0 m, but it is {depth:g} m.")
    if tow.current is not None:
        _check_in_plane(tow.current)
    lower = tow.length - tow.cable.length
    way = rise(replace(tow, cable=replace(tow.cable, length=_LONGEST * depth)), depth, to_surface=True)
    least = depth + float(way.level[way.steps <= lower].max())
    most = depth + float(way.level.max())
    length = float(way.steps[-1]) - lower
    if least > depth or not length > 0.0 or length >= _LONGEST * depth:
        reach = f"at least {least:.4g} m" if least > depth else f"at most {most:.4g} m"
        raise InvalidInput(
            f"No length of the upper cable puts its lower end at {depth:g} m: in the flow at that depth the cable "
            f"rises {reach} above it. Ask for another depth, or change the weight of the cable or of the vehicle."
        )
    return replace(tow, cable=replace(tow.cable, length=length))


def travel_time(tow: Tow, shape: StaticShape) -> float:
    """Time of a transverse wave front down the cable, int ds / sqrt(T/(m + m_a)) [s]."""
    cable = tow.single_cable("The travel time of a wave")
    slowness = np.sqrt((cable.mass + cable.added_mass) / shape.T)
    return float(np.trapezoid(slowness, shape.s))


def midpoint_travel_time(tow: Tow, shape: StaticShape) -> float:
    """The estimate of T section 4.1: L / sqrt(T_mid/m), midpoint tension and no added mass [s]."""
    cable = tow.single_cable("The travel time of a wave")
    middle = float(shape.tension_at(0.5 * cable.length))
    return cable.length * math.sqrt(cable.mass / middle)


def flow_at(tow: Tow, z: ArrayLike) -> Floats:
    """The water's speed relative to the steadily towed frame at height z (negative below the surface) [m/s]."""
    height = np.asarray(z, dtype=float)
    ambient = tow.current.at(-height) if tow.current is not None else np.zeros(height.shape)
    return ambient - tow.speed


def _depends_on_depth(tow: Tow) -> bool:
    sheared = tow.current is not None and tow.current.speed.size > 1
    return sheared or any(cable.poisson_ratio < 0.5 for cable in tow.cables)


def _check_in_plane(current: Current) -> None:
    if not current.planar:
        i = int(np.abs(current.velocity[:, 1]).argmax())
        raise InvalidInput(
            f"The tow stays in the plane of X and Z, but at {current.depth[i]:g} m the current has "
            f"{current.velocity[i, 1]:.3g} m/s across it. Give directions of 0 or pi, or simulate with link-joint."
        )


def _equal(length: float, stations: int) -> Floats:
    if stations < 2:
        raise InvalidInput(f"A static shape needs at least 2 segments, but {stations} was given.")
    return np.linspace(0.0, length, stations + 1)


def _checked(nodes: ArrayLike, length: float) -> Floats:
    s = np.array(nodes, dtype=float)
    if s.ndim != 1 or s.size < 3:
        raise InvalidInput(f"A static shape needs at least 3 nodes on one axis, but they have the shape {s.shape}.")
    if not np.isfinite(s).all():
        raise InvalidInput(f"A static shape needs finite nodes, but nodes[{int(np.argmin(np.isfinite(s)))}] is not.")
    if np.any(np.diff(s) <= 0.0):
        i = int(np.argmax(np.diff(s) <= 0.0))
        raise InvalidInput(
            f"A static shape needs increasing nodes, but nodes[{i}] = {s[i]:g} m and nodes[{i + 1}] = {s[i + 1]:g} m."
        )
    if s[0] != 0.0 or not math.isclose(s[-1], length, rel_tol=1e-9):
        raise InvalidInput(
            f"A static shape needs nodes from 0 m to the cable's {length:g} m, but they run from {s[0]:g} m to "
            f"{s[-1]:g} m."
        )
    return s


def _told(tow: Tow, way: Rise, s: Floats) -> StaticShape:
    """The shape at the places s, x and z counted from the tow point."""
    phi, T, x, level, strain = way.at(s)
    top = float(way.level.max())
    if top - way.height > _OUT_OF_WATER * tow.length:
        place = float(way.steps[int(np.argmax(way.level))])
        raise InvalidInput(
            f"The cable comes out of the water: at s = {place:.1f} m of {tow.length:g} m from the vehicle it is "
            f"{top - way.height:.3g} m above the tow point. Give it more length or weight above that place, or less "
            "buoyancy below it."
        )
    return StaticShape(
        s=s,
        phi=phi,
        T=T,
        x=x - x[-1],
        z=level - level[-1],
        strain=strain,
        flow=np.broadcast_to(flow_at(tow, level), level.shape).copy(),
        pitch=way.pitch,
    )
