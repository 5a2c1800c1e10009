"""The steady shape of a towed cable in a current: the state that motions are counted from.

Symbols: s unstretched length from the vehicle up [m]; phi angle of the cable from the horizontal [rad];
T effective tension [N]; e strain; u = current - tow speed, the water's speed relative to the frame of
the shape [m/s], positive toward +X; k_n, k_t quadratic drag per length [N s2/m3].

    T phi' = w cos phi + k_n c u_n |u_n|,   T' = w sin phi - k_t c u_t |u_t|,
    x' = (1 + e) cos phi,                   z' = (1 + e) sin phi,

with u_n = u sin phi, u_t = u cos phi, e = (T - (1 - 2 nu) p A)/EA and c = (1 + e)(1 - nu e), the change of
the drag area by elongation (H (5)-(6) for nu = 1/2). T (2.8)-(2.9) are the still-tow case without the
tangential drag. In-water weight makes T the effective tension, so no pressure term is added to it.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.current import Current
from models.quantity import GRAVITY, InvalidInput, NumericalFailure
from models.tow import Tow
from models.vehicle import Towfish, Vehicle

Floats = NDArray[np.float64]

#: Depth iterations of a shape in a sheared current, and the closure they must reach [m].
_DEPTH_ITERATIONS = 60
_DEPTH_CLOSURE = 1e-9


class SlackCable(NumericalFailure):
    """The tension falls to zero somewhere along the cable."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StaticShape:
    """The steady shape at n + 1 equally spaced stations, vehicle first.

    `s`, `x`, `z` [m] with x and z counted from the tow point, z up; `phi` [rad]; `T` [N] effective; `strain`
    [-]; `flow` [m/s] the water's speed relative to the frame; `pitch` [rad] of a towfish, else 0.
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


def static_shape(tow: Tow, *, stations: int = 240) -> StaticShape:
    """Integrate the steady shape up from the vehicle's own force and moment balance.

    Parameters
    ----------
    stations
        Number of equal segments, at least 2; classical Runge-Kutta, fourth order.

    Raises
    ------
    InvalidInput
        Fewer than 2 segments, a current across X, or a towfish without a stable pitch angle.
    SlackCable
        The tension falls to zero below the tow point.
    NumericalFailure
        The depth of the vehicle in a sheared current does not settle.

    Notes
    -----
    T (2.8)-(2.9) with the tangential drag kept; see the module docstring.
    """
    if stations < 2:
        raise InvalidInput(f"A static shape needs at least 2 segments, but {stations} was given.")
    if tow.current is not None:
        _check_in_plane(tow.current)
    depth = tow.cable.length
    previous: tuple[float, float] | None = None
    for _ in range(_DEPTH_ITERATIONS):
        shape = _integrate_up(tow, depth, stations)
        miss = depth + float(shape.z[0] - shape.z[-1])
        if abs(miss) <= _DEPTH_CLOSURE * tow.cable.length or not _depends_on_depth(tow):
            return shape
        # Secant on the closure of the depth; the first step is the plain correction.
        step = -miss
        if previous is not None and previous[1] != miss:
            step = -miss * (depth - previous[0]) / (miss - previous[1])
        previous = (depth, miss)
        depth += float(np.clip(step, -0.5 * tow.cable.length, 0.5 * tow.cable.length))
    raise NumericalFailure(
        f"The static shape does not settle: after {_DEPTH_ITERATIONS} iterations the vehicle's depth of "
        f"{depth:.3f} m still misses its own shape by {miss:.3g} m. The current may allow more than one shape."
    )


def _check_in_plane(current: Current) -> None:
    if not current.planar:
        i = int(np.abs(current.velocity[:, 1]).argmax())
        raise InvalidInput(
            f"The tow stays in the plane of X and Z, but at {current.depth[i]:g} m the current has "
            f"{current.velocity[i, 1]:.3g} m/s across it. Give directions of 0 or pi, or simulate with link-joint."
        )


def travel_time(tow: Tow, shape: StaticShape) -> float:
    """Time of a transverse wave front down the cable, int ds / sqrt(T/(m + m_a)) [s]."""
    slowness = np.sqrt((tow.cable.mass + tow.cable.added_mass) / shape.T)
    return float(np.trapezoid(slowness, shape.s))


def midpoint_travel_time(tow: Tow, shape: StaticShape) -> float:
    """The estimate of T section 4.1: L / sqrt(T_mid/m), midpoint tension and no added mass [s]."""
    middle = float(shape.tension_at(0.5 * tow.cable.length))
    return tow.cable.length * math.sqrt(tow.cable.mass / middle)


def flow_at(tow: Tow, z: ArrayLike) -> Floats:
    """The water's speed relative to the steadily towed frame at height z (negative below the surface) [m/s]."""
    height = np.asarray(z, dtype=float)
    ambient = tow.current.at(-height) if tow.current is not None else np.zeros(height.shape)
    return ambient - tow.speed


def end_force(tow: Tow, flow: float) -> tuple[float, float, float]:
    """Steady pull of the vehicle on the cable's end: force toward +X and up [N], and the pitch [rad].

    The cable pulls back with the opposite force: T (cos phi, sin phi) = -(F_x, F_z).
    """
    vehicle = tow.vehicle
    if isinstance(vehicle, Vehicle):
        return vehicle.drag(tow.water_density) * flow * abs(flow), -vehicle.weight_in_water, 0.0
    pitch = _pitch_equilibrium(vehicle, tow.water_density, flow)
    p, q = towfish_steady_force(vehicle, tow.water_density, flow, pitch)
    return p * math.cos(pitch) - q * math.sin(pitch), p * math.sin(pitch) + q * math.cos(pitch), pitch


def towfish_steady_force(body: Towfish, density: float, flow: float, pitch: float) -> tuple[float, float]:
    """Weight, buoyancy and drag on a still towfish in body axes (P, Q) [N]: H (15)-(16) without the tension."""
    u, v = -flow * math.cos(pitch), flow * math.sin(pitch)
    c = 0.5 * density * body.drag_coefficient * (body.area_p * abs(u) + body.area_q * abs(v))
    net = body.buoyancy - body.weight
    return net * math.sin(pitch) - c * u, net * math.cos(pitch) - c * v


def _pitch_moment(body: Towfish, density: float, flow: float, pitch: float) -> float:
    """H (17) at rest, the cable's force being what balances the others [N m]."""
    p, q = towfish_steady_force(body, density, flow, pitch)
    u, v = -flow * math.cos(pitch), flow * math.sin(pitch)
    c = 0.5 * density * body.drag_coefficient * (body.area_p * abs(u) + body.area_q * abs(v))
    return (
        body.buoyancy * (body.buoyancy_centre_p * math.cos(pitch) - body.buoyancy_centre_q * math.sin(pitch))
        - body.tow_point_p * q
        + body.tow_point_q * p
        - c * (body.drag_centre_p * v - body.drag_centre_q * u)
    )


def _pitch_equilibrium(body: Towfish, density: float, flow: float) -> float:
    """The stable pitch angle nearest to zero [rad]."""
    from scipy.optimize import brentq

    grid = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 721)
    moment = np.array([_pitch_moment(body, density, flow, a) for a in grid])
    falls = np.flatnonzero((moment[:-1] > 0.0) & (moment[1:] <= 0.0))
    if falls.size == 0:
        raise InvalidInput(
            f"The towfish has no stable pitch angle between -90 and 90 degrees in a flow of {flow:g} m/s; the moment "
            f"runs from {moment.max():.3g} to {moment.min():.3g} N m. Move its tow point or its buoyancy centre up."
        )
    roots = [brentq(lambda a: _pitch_moment(body, density, flow, a), grid[i], grid[i + 1], xtol=1e-14) for i in falls]
    return float(min(roots, key=abs))


def _depends_on_depth(tow: Tow) -> bool:
    sheared = tow.current is not None and tow.current.speed.size > 1
    return sheared or tow.cable.poisson_ratio < 0.5


def _integrate_up(tow: Tow, depth: float, stations: int) -> StaticShape:
    """Classical Runge-Kutta from a vehicle at the given depth; x and z end relative to the tow point."""
    cable = tow.cable
    w, nu, EA = cable.weight_in_water, cable.poisson_ratio, cable.axial_stiffness
    k_n, k_t = cable.normal_drag(tow.water_density), cable.tangential_drag(tow.water_density)
    squeeze = (1.0 - 2.0 * nu) * tow.water_density * GRAVITY * cable.cross_section / EA
    h = cable.length / stations
    constant_flow = None if tow.current is not None and tow.current.speed.size > 1 else float(flow_at(tow, 0.0))

    def flow(z: float) -> float:
        return constant_flow if constant_flow is not None else float(flow_at(tow, z))

    def slope(s: float, y: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
        phi, T, _, z = y
        if not T > 0.0:
            raise SlackCable(
                f"The cable goes slack: its static tension falls to {T:.3g} N at s = {s:.1f} m of {cable.length:g} m "
                "from the vehicle. The weight below that place does not stretch it; add weight or shorten the cable."
            )
        sine, cosine, u = math.sin(phi), math.cos(phi), flow(z)
        e = T / EA + squeeze * min(z, 0.0)
        c = (1.0 + e) * (1.0 - nu * e)
        return (
            (w * cosine + k_n * c * u * sine * abs(u * sine)) / T,
            w * sine - k_t * c * u * cosine * abs(u * cosine),
            (1.0 + e) * cosine,
            (1.0 + e) * sine,
        )

    force_x, force_z, pitch = end_force(tow, flow(-depth))
    T_0 = math.hypot(force_x, force_z)
    y = (math.atan2(-force_z, -force_x), T_0, 0.0, -depth)
    rows = [y]
    for i in range(stations):
        s = i * h
        a = slope(s, y)
        b = slope(s + 0.5 * h, _moved(y, a, 0.5 * h))
        c = slope(s + 0.5 * h, _moved(y, b, 0.5 * h))
        d = slope(s + h, _moved(y, c, h))
        y = (
            y[0] + h / 6.0 * (a[0] + 2.0 * b[0] + 2.0 * c[0] + d[0]),
            y[1] + h / 6.0 * (a[1] + 2.0 * b[1] + 2.0 * c[1] + d[1]),
            y[2] + h / 6.0 * (a[2] + 2.0 * b[2] + 2.0 * c[2] + d[2]),
            y[3] + h / 6.0 * (a[3] + 2.0 * b[3] + 2.0 * c[3] + d[3]),
        )
        rows.append(y)
    phi, T, x, z = np.array(rows).T
    return StaticShape(
        s=np.linspace(0.0, cable.length, stations + 1),
        phi=phi,
        T=T,
        x=x - x[-1],
        z=z - z[-1],
        strain=T / EA + squeeze * np.minimum(z, 0.0),
        flow=np.broadcast_to(flow_at(tow, z), z.shape).copy(),
        pitch=pitch,
    )


def _moved(
    y: tuple[float, float, float, float], k: tuple[float, float, float, float], h: float
) -> tuple[float, float, float, float]:
    return y[0] + h * k[0], y[1] + h * k[1], y[2] + h * k[2], y[3] + h * k[3]
