"""Stations, sine tables and static fields of the spectral model, gathered once for its kernels.

The normal deflection is T (2.32), q = eta_1 (1 - x) + eta_2 x + sum Q_n sin(n pi x), x = s/L. Integrals over
the cable are Gauss-Legendre sums, so products of two sines are exact once the stations outnumber the
harmonics by about pi/2; with fewer the projection aliases (T 2.6.2) and is refused.
"""

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput
from models.statics import StaticShape, flow_at, static_shape
from models.tow import Tow, refuse_sections_and_thrust
from models.vehicle import Vehicle

Floats = NDArray[np.float64]

#: Legendre degree of the running integrals of the axial quantities (tension, axial deflection).
_AXIAL_DEGREE = 8
#: Lateral drag angle: ``moved`` sees phi_s + phi_d; ``as-printed`` freezes it at phi_s.
DRAG_ANGLES = ("moved", "as-printed")
END_CONDITIONS = ("weak", "pointwise")


#: Names of the scalars in `Fields.scalar`.
(
    LENGTH,  # L [m]
    AXIAL_STIFFNESS,  # EA [N]
    WEIGHT,  # w [N/m]
    LATERAL_MASS,  # m + m_a [kg/m]
    TANGENTIAL_DRAG,  # k_t [N s2/m3]
    TANGENT_X,  # static tangent at the vehicle
    TANGENT_Z,
    TOP_X,  # static tangent at the tow point
    TOP_Z,
    TENSION_0,  # static tension at the vehicle [N]
    FLOW_0,  # water's speed relative to the frame at the vehicle [m/s]
    BEND_0,  # phi_s' at the vehicle [rad/m]
    STRETCH_0,  # 1/(1 + e) at the vehicle
    PITCH,  # static pitch of the body [rad]
    MOVED,  # 1 where the drag sees the moved angle
    FLOWING,  # 1 where water moves relative to the static shape
    CURVED,  # 1 where the static shape is not a vertical line
    WEAK,  # 1 for the weak end condition, 0 for the printed pointwise one
    TENSION_TOP,  # static tension at the tow point [N]
    SHEAR_0,  # du/dz at the vehicle [1/s]
    MEAN_STRAIN,  # mean static strain
    AXIAL_LOSS,  # tau_a, time of the cable's internal loss [s]
    AXIAL_MASS,  # m [kg/m]
) = range(23)
#: Names of the station rows in `Fields.station`.
(
    X,  # s/L
    QUADRATURE,  # Gauss weight times L [m]
    STATIC_TENSION,  # T_s [N]
    BEND,  # phi_s' [rad/m]
    SINE,  # sin phi_s
    COSINE,  # cos phi_s
    FLOW,  # u [m/s]
    NORMAL_DRAG,  # k_n with the change of area by elongation [N s2/m3]
    STATIC_NORMAL,  # f_n0 [N/m]
    STATIC_TANGENTIAL,  # f_t0 [N/m]
    STRETCH,  # 1/(1 + e)
    SHEAR,  # du/dz [1/s]
) = range(12)


class Fields(NamedTuple):
    """What the kernels read, in few arrays: J stations, N harmonics, SI units.

    `scalar` (23,) and `station` (12, J) are named above. `sines` (2, N, J) = sin(n pi x) and its derivative in s;
    `moments` (2, 2N + 1, J) = cos, sin(k pi x); `axial` (2, K, J): the
    integral of g from the vehicle to station j is sum_k axial[1, k, j] c_k with c = axial[0] @ g, and c_0 is the
    integral over the whole cable. `body` are the parameters of `body_array`.
    """

    scalar: Floats
    station: Floats
    sines: Floats
    moments: Floats
    axial: Floats
    body: Floats


def default_stations(harmonics: int) -> int:
    """Stations that carry the products of the given sines and the kinks of the drag."""
    return 2 * harmonics + 10


def smallest_stations(harmonics: int) -> int:
    """Fewest Gauss stations that project the harmonics without aliasing."""
    return math.ceil(0.5 * math.pi * harmonics) + 4


def body_array(tow: Tow) -> Floats:
    """Parameters of the body as the kernels read them: 3 for a point, 17 for a towfish."""
    vehicle = tow.vehicle
    if isinstance(vehicle, Vehicle):
        return np.array([vehicle.mass + vehicle.added_mass, vehicle.drag(tow.water_density), vehicle.weight_in_water])
    scale = 0.5 * tow.water_density * vehicle.drag_coefficient
    return np.array(
        [
            vehicle.mass,
            vehicle.added_mass_p,
            vehicle.added_mass_q,
            vehicle.inertia,
            vehicle.weight,
            vehicle.buoyancy,
            scale * vehicle.area_p,
            scale * vehicle.area_q,
            scale * max(vehicle.area_p, vehicle.area_q) * vehicle.length**3 / 32.0,
            vehicle.added_mass_centre_p,
            vehicle.added_mass_centre_q,
            vehicle.buoyancy_centre_p,
            vehicle.buoyancy_centre_q,
            vehicle.tow_point_p,
            vehicle.tow_point_q,
            vehicle.drag_centre_p,
            vehicle.drag_centre_q,
        ]
    )


def prepare(
    tow: Tow,
    *,
    harmonics: int,
    stations: int | None = None,
    drag_angle: str = "moved",
    end_condition: str = "weak",
    allow_aliasing: bool = False,
    shape: StaticShape | None = None,
) -> Fields:
    """Static shape and tables for a given resolution.

    Raises
    ------
    InvalidInput
        No harmonic, too few stations for the harmonics (aliasing, T 2.6.2), an unknown option, sections or a thrust.
    SlackCable
        The static tension falls to zero along the cable.
    """
    if drag_angle not in DRAG_ANGLES:
        raise InvalidInput(f"drag_angle must be one of {', '.join(DRAG_ANGLES)}, but {drag_angle!r} was given.")
    if end_condition not in END_CONDITIONS:
        known = ", ".join(END_CONDITIONS)
        raise InvalidInput(f"end_condition must be one of {known}, but {end_condition!r} was given.")
    if harmonics < 1:
        raise InvalidInput(f"The sine series needs at least 1 harmonic, but {harmonics} was given.")
    J = default_stations(harmonics) if stations is None else stations
    if smallest_stations(harmonics) > J and not allow_aliasing:
        raise InvalidInput(
            f"{harmonics} harmonics need at least {smallest_stations(harmonics)} stations along the cable, but {J} "
            "were given: fewer project the drag wrongly (aliasing). Raise the stations or lower the harmonics."
        )
    refuse_sections_and_thrust(tow, "The spectral simulator")
    shape = static_shape(tow) if shape is None else shape
    cable = tow.cable
    L = cable.length
    node, weight = _gauss(J)
    x = 0.5 * (node + 1.0)
    phi, T_s, e = _between(shape, x * L)
    flow = np.interp(x * L, shape.s, shape.flow)
    area = (1.0 + e) * (1.0 - cable.poisson_ratio * e)
    k_n, k_t = cable.normal_drag(tow.water_density) * area, cable.tangential_drag(tow.water_density)
    u_n, u_t = flow * np.sin(phi), flow * np.cos(phi)
    # Exactly vertical and still: cos(pi/2) is rounding, not a slope.
    flowing = bool(np.any(flow != 0.0))
    vertical = not flowing and bool(np.all(np.abs(shape.phi - 0.5 * math.pi) < 1e-12))
    cosine = np.zeros(J) if vertical else np.cos(phi)
    n = np.arange(1, harmonics + 1)[:, None]
    k = np.arange(2 * harmonics + 1)[:, None]
    K = min(_AXIAL_DEGREE, J)
    V = np.polynomial.legendre.legvander(node, K)
    degree = np.arange(K)
    A = (V[:, :K] * (0.5 * (2.0 * degree + 1.0) * weight[:, None])).T * L
    integral = np.empty((J, K))
    integral[:, 0] = x
    integral[:, 1:] = 0.5 * (V[:, 2 : K + 1] - V[:, : K - 1]) / (2.0 * degree[1:] + 1.0)
    bottom, upper = (0.5 * math.pi, 0.5 * math.pi) if vertical else (float(shape.phi[0]), float(shape.phi[-1]))
    scalar = np.zeros(23)
    scalar[LENGTH], scalar[AXIAL_STIFFNESS] = L, cable.axial_stiffness
    scalar[WEIGHT], scalar[LATERAL_MASS] = cable.weight_in_water, cable.mass + cable.added_mass
    scalar[TANGENTIAL_DRAG] = k_t
    scalar[TANGENT_X], scalar[TANGENT_Z] = 0.0 if vertical else math.cos(bottom), math.sin(bottom)
    scalar[TOP_X], scalar[TOP_Z] = 0.0 if vertical else math.cos(upper), math.sin(upper)
    scalar[TENSION_0], scalar[FLOW_0] = shape.T[0], shape.flow[0]
    scalar[MEAN_STRAIN] = 0.5 * (weight @ e)
    scalar[AXIAL_LOSS] = cable.axial_damping
    scalar[AXIAL_MASS] = cable.mass
    scalar[TENSION_TOP] = shape.T[-1]
    scalar[BEND_0] = 0.0 if vertical else _end_slope(shape)
    scalar[STRETCH_0] = 1.0 / (1.0 + shape.strain[0])
    scalar[PITCH] = shape.pitch
    scalar[MOVED], scalar[FLOWING] = drag_angle == "moved", flowing
    scalar[CURVED], scalar[WEAK] = not vertical, end_condition == "weak"
    station = np.zeros((12, J))
    station[X], station[QUADRATURE], station[STATIC_TENSION] = x, 0.5 * L * weight, T_s
    if not vertical:
        station[BEND] = (cable.weight_in_water * cosine + k_n * u_n * np.abs(u_n)) / T_s
    station[SINE], station[COSINE], station[FLOW] = np.ones(J) if vertical else np.sin(phi), cosine, flow
    station[NORMAL_DRAG], station[STATIC_NORMAL] = k_n, -k_n * u_n * np.abs(u_n)
    station[STATIC_TANGENTIAL], station[STRETCH] = k_t * u_t * np.abs(u_t), 1.0 / (1.0 + e)
    if drag_angle == "moved":
        # The drag that sees the moved angle sees the moved depth as well.
        scalar[SHEAR_0] = _shear(tow, shape.z[:1])[0]
        station[SHEAR] = _shear(tow, np.interp(x * L, shape.s, shape.z))
    sines = np.array([np.sin(n * math.pi * x), n * math.pi / L * np.cos(n * math.pi * x)])
    return Fields(
        scalar=scalar,
        station=station,
        sines=sines,
        moments=np.array([np.cos(k * math.pi * x), np.sin(k * math.pi * x)]),
        axial=np.array([A, integral.T]),
        body=body_array(tow),
    )


@cache
def _gauss(stations: int) -> tuple[Floats, Floats]:
    """Gauss-Legendre nodes and weights on (-1, 1)."""
    return np.polynomial.legendre.leggauss(stations)


def _between(shape: StaticShape, s: Floats) -> Floats:
    """phi, T and strain (3, J) of the shape at the places s: the cubic through the four nodes around each."""
    last = shape.s.size - 1
    width = min(4, last + 1)
    first = np.clip(np.searchsorted(shape.s, s) - 2, 0, last + 1 - width)
    near = first + np.arange(width)[:, None]
    node = shape.s[near]
    weight = np.ones((width, s.size))
    for i in range(width):
        for k in range(width):
            if k != i:
                weight[i] *= (s - node[k]) / (node[i] - node[k])
    return np.array([(weight * of[near]).sum(axis=0) for of in (shape.phi, shape.T, shape.strain)])


def _shear(tow: Tow, z: Floats) -> Floats:
    """du/dz of the flow at heights z [1/s], over a thousandth of the cable."""
    reach = 5e-4 * tow.cable.length
    return (flow_at(tow, z + reach) - flow_at(tow, z - reach)) / (2.0 * reach)


def _end_slope(shape: StaticShape) -> float:
    """phi_s' at the vehicle [rad/m], second-order one-sided difference."""
    h = float(shape.s[1])
    return float(-1.5 * shape.phi[0] + 2.0 * shape.phi[1] - 0.5 * shape.phi[2]) / h
