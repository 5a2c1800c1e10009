"""The linearised cable and body about their steady shape: the numbers of H (11) and (18)-(23), without frequency.

With X along the flow, s up from the body, t = (cos phi, sin phi), n = (-sin phi, cos phi), deflection p t + q n, and
the drag 1/2 rho d C c |v|v with c the stretch of the drag area, the first-order change of the statics
`models.statics` plus inertia is

    T~'   = w cos phi phi~ - m om^2 p + k_t c b_t v_t - k_t u_t|u_t| dc
    phi~' = -(phi'/T) T~ - (w sin phi/T) phi~ + [-(m + m_a) om^2 q + k_n c b_n v_n + k_n u_n|u_n| dc]/T
    p'    = e~ + phi' q,      q' = (1 + e) phi~ - phi' p
    v_t   = i om p + U sin phi phi~ - U' cos phi z~,     u_t = U cos phi
    v_n   = i om q + U cos phi phi~ + U' sin phi z~,     u_n = U sin phi
    z~    = p sin phi + q cos phi,   e~ = T~/(EA (1 + i om tau_a)) + (de/dz) z~,   dc = (dc/de) e~

where b v stands for the linearised drag. The terms of v_t and v_n beside i om p and i om q are the moved angle and
the moved depth: H leaves them out, and dc as well (``drag="printed"``), and with them the limit of slow motion is
the derivative of the statics. For the body the relative velocity changes with pitch in the same way.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.cable import Cable
from models.quantity import GRAVITY
from models.statics import StaticShape, flow_at
from models.tow import Tow
from models.transfer_matrix import columns as c
from models.vehicle import Towfish

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Line:
    """The work arrays of a linearised tow: `ends` (2n, 20), `nodes` (n+1, 11), `body` (28,), `h` (n,) [m]."""

    shape: StaticShape
    h: Floats
    ends: Floats
    nodes: Floats
    body: Floats


def linearise(tow: Tow, shape: StaticShape, *, printed: bool = False, stretch_drag: bool = True) -> Line:
    """The work arrays about a steady shape, whose stations are the nodes.

    Parameters
    ----------
    printed
        Without moved angle, moved depth, coupled body drag and change of the drag with strain, as H prints it.
    stretch_drag
        Whether the drag area stretches with the cable, H (5)-(6).
    """
    h = np.diff(shape.s)
    slope = _shear(tow, 0.5 * (shape.z[1:] + shape.z[:-1]))
    ends = np.zeros((2 * h.size, c.END_COLUMNS))
    nodes = np.zeros((h.size + 1, c.NODE_COLUMNS))
    moved = 0.0 if printed else 1.0
    begin = 0.0
    for cable in tow.cables:
        end = begin + cable.length
        middle = 0.5 * (shape.s[1:] + shape.s[:-1])
        inside = np.flatnonzero((middle > begin) & (middle < end))
        for side in (0, 1):
            at = inside + side
            values = _of_cable(tow, cable, shape, slope[inside], at, moved, stretch_drag)
            ends[2 * inside + side] = values
            nodes[at, c.NODE_FORCE_T] += 0.5 * h[inside] * values[:, c.DRAG_T]
            nodes[at, c.NODE_FORCE_A] += 0.5 * h[inside] * values[:, c.DRAG_A] * shape.T[at]
            nodes[at, c.NODE_LENGTH] += 0.5 * h[inside]
        begin = end
    sine, cosine = np.sin(shape.phi), np.cos(shape.phi)
    nodes[:, c.NODE_ANGLE_T], nodes[:, c.NODE_ANGLE_A] = moved * shape.flow * sine, moved * shape.flow * cosine
    beside = 0.5 * (np.append(slope, slope[-1]) + np.insert(slope, 0, slope[0]))
    nodes[:, c.NODE_SHEAR_T], nodes[:, c.NODE_SHEAR_A] = -moved * beside * cosine, moved * beside * sine
    nodes[:, c.NODE_SINE], nodes[:, c.NODE_COSINE] = sine, cosine
    nodes[:, c.NODE_FLOW_T], nodes[:, c.NODE_FLOW_A] = abs(shape.flow * cosine), abs(shape.flow * sine)
    return Line(shape=shape, h=h, ends=ends, nodes=nodes, body=_body(tow, shape, float(slope[0]), printed))


def _shear(tow: Tow, z: Floats) -> Floats:
    """dU/dz [1/s] at heights z, those of the middles of segments: a profile is straight between its kinks."""
    if tow.current is None or tow.current.speed.size == 1:
        return np.zeros(z.shape)
    step = 1e-6 * max(float(np.ptp(tow.current.depth)), 1.0)
    slope: Floats = (flow_at(tow, z + step) - flow_at(tow, z - step)) / (2.0 * step)
    return slope


def _of_cable(
    tow: Tow, cable: Cable, shape: StaticShape, slope: Floats, at: NDArray[np.intp], moved: float, stretch: bool
) -> Floats:
    """Rows of `ends` for one section's properties at the nodes `at`."""
    rho, nu, EA = tow.water_density, cable.poisson_ratio, cable.axial_stiffness
    T, U, e = shape.T[at], shape.flow[at], _strain(tow, cable, shape, at)
    sine, cosine = np.sin(shape.phi[at]), np.cos(shape.phi[at])
    grown = (1.0 + e) * (1.0 - nu * e) if stretch else np.ones_like(e)
    change = moved * ((1.0 - nu * e) - nu * (1.0 + e)) if stretch else np.zeros_like(e)
    k_t, k_n = cable.tangential_drag(rho), cable.normal_drag(rho)
    u_t, u_n = U * cosine, U * sine
    # The statics themselves stretch the drag area, whatever the dynamics do.
    curvature = (cable.weight_in_water * cosine + k_n * (1.0 + e) * (1.0 - nu * e) * u_n * np.abs(u_n)) / T
    squeeze = (1.0 - 2.0 * nu) * rho * GRAVITY * cable.cross_section / EA
    values = np.zeros((at.size, c.END_COLUMNS))
    values[:, c.COMPLIANCE], values[:, c.LOSS] = 1.0 / EA, cable.axial_damping
    values[:, c.SQUEEZE] = moved * squeeze
    values[:, c.STRETCH], values[:, c.CURVATURE], values[:, c.CURVATURE_T] = 1.0 + e, curvature, curvature / T
    values[:, c.WEIGHT_T] = cable.weight_in_water * cosine
    values[:, c.WEIGHT_A] = cable.weight_in_water * sine / T
    values[:, c.MASS], values[:, c.MASS_A] = cable.mass, (cable.mass + cable.added_mass) / T
    values[:, c.DRAG_T], values[:, c.DRAG_A] = k_t * grown, k_n * grown / T
    values[:, c.STRAIN_T] = -k_t * change * u_t * np.abs(u_t)
    values[:, c.STRAIN_A] = k_n * change * u_n * np.abs(u_n) / T
    values[:, c.ANGLE_T], values[:, c.ANGLE_A] = moved * U * sine, moved * U * cosine
    values[:, c.SHEAR_T], values[:, c.SHEAR_A] = -moved * slope * cosine, moved * slope * sine
    values[:, c.SINE], values[:, c.COSINE] = sine, cosine
    return values


def _strain(tow: Tow, cable: Cable, shape: StaticShape, at: NDArray[np.intp]) -> Floats:
    """Static strain of one section at the nodes `at`, also where another section begins there."""
    squeeze = (1.0 - 2.0 * cable.poisson_ratio) * tow.water_density * GRAVITY * cable.cross_section
    strain: Floats = (shape.T[at] + squeeze * np.minimum(shape.z[at], 0.0)) / cable.axial_stiffness
    return strain


def _body(tow: Tow, shape: StaticShape, slope: float, printed: bool) -> Floats:
    """The numbers of the body at the lower end."""
    vehicle, rho = tow.vehicle, tow.water_density
    phi, T, U = float(shape.phi[0]), float(shape.T[0]), float(shape.flow[0])
    moved = 0.0 if printed else 1.0
    body = np.zeros(c.BODY_COLUMNS)
    body[c.BODY_TENSION], body[c.BODY_SLOPE_SIN], body[c.BODY_SLOPE_COS] = T, np.sin(phi), np.cos(phi)
    body[c.BODY_COUPLED] = moved
    if not isinstance(vehicle, Towfish):
        body[c.BODY_SIN], body[c.BODY_COS] = np.sin(phi), np.cos(phi)
        body[c.BODY_MASS_P] = body[c.BODY_MASS_Q] = vehicle.mass + vehicle.added_mass
        body[c.BODY_K_P] = body[c.BODY_K_Q] = vehicle.drag(rho)
        body[c.BODY_FLOW_P], body[c.BODY_SHEAR_P] = -U, -moved * slope
        return body
    pitch = shape.pitch
    psi, sine, cosine = phi - pitch, np.sin(pitch), np.cos(pitch)
    net = vehicle.buoyancy - vehicle.weight
    k = 0.5 * rho * vehicle.drag_coefficient
    body[c.BODY_SIN], body[c.BODY_COS], body[c.BODY_PITCHES] = np.sin(psi), np.cos(psi), 1.0
    body[c.BODY_MASS_P], body[c.BODY_MASS_Q] = (
        vehicle.mass + vehicle.added_mass_p,
        vehicle.mass + vehicle.added_mass_q,
    )
    body[c.BODY_INERTIA] = vehicle.inertia
    body[c.BODY_CROSS_P] = vehicle.added_mass_centre_q * vehicle.added_mass_p
    body[c.BODY_CROSS_Q] = -vehicle.added_mass_centre_p * vehicle.added_mass_q
    body[c.BODY_STIFF_P] = -T * np.sin(psi) - net * cosine + vehicle.thrust * sine
    body[c.BODY_STIFF_Q] = T * np.cos(psi) + net * sine + vehicle.thrust * cosine
    body[c.BODY_STIFF_M] = vehicle.buoyancy * (vehicle.buoyancy_centre_p * sine + vehicle.buoyancy_centre_q * cosine)
    body[c.BODY_STIFF_M] += T * (vehicle.tow_point_p * np.cos(psi) + vehicle.tow_point_q * np.sin(psi))
    body[c.BODY_TOW_P], body[c.BODY_TOW_Q] = vehicle.tow_point_p, vehicle.tow_point_q
    body[c.BODY_DRAG_P], body[c.BODY_DRAG_Q] = vehicle.drag_centre_p, vehicle.drag_centre_q
    body[c.BODY_K_P], body[c.BODY_K_Q] = k * vehicle.area_p, k * vehicle.area_q
    body[c.BODY_K_TURN] = k * max(vehicle.area_p, vehicle.area_q) * vehicle.length**3 / 32.0
    body[c.BODY_FLOW_P], body[c.BODY_FLOW_Q] = -U * cosine, U * sine
    body[c.BODY_ANGLE_P], body[c.BODY_ANGLE_Q] = moved * U * sine, moved * U * cosine
    body[c.BODY_SHEAR_P], body[c.BODY_SHEAR_Q] = -moved * slope * cosine, moved * slope * sine
    return body
