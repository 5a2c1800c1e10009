"""The steady balance of the vehicle at the cable's lower end: what it pulls with, and a towfish's pitch angle.

Weight, buoyancy, drag and thrust are balanced by the cable's tension; of a towfish their moments too (H (15)-(17)).
"""

import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput
from models.tow import Tow
from models.vehicle import Towfish, Vehicle

#: How far past a quarter turn a towfish may rest [rad].
_BEYOND = 1e-3

_Number = TypeVar("_Number", float, NDArray[np.float64])


def end_force(tow: Tow, flow: float) -> tuple[float, float, float]:
    """Steady pull of the vehicle on the cable's end: force toward +X and up [N], and the pitch [rad].

    `flow` [m/s] is the water's speed relative to the vehicle. The cable pulls back with the opposite force:
    T (cos phi, sin phi) = -(F_x, F_z).

    Raises
    ------
    InvalidInput
        A towfish without a stable pitch angle.
    """
    vehicle = tow.vehicle
    if isinstance(vehicle, Vehicle):
        drag = vehicle.drag(tow.water_density) * flow * abs(flow)
        return drag + vehicle.thrust, -vehicle.weight_in_water, 0.0
    pitch = _pitch_equilibrium(vehicle, tow.water_density, flow)
    p, q = towfish_steady_force(vehicle, tow.water_density, flow, pitch)
    return p * math.cos(pitch) - q * math.sin(pitch), p * math.sin(pitch) + q * math.cos(pitch), pitch


def towfish_steady_force(body: Towfish, density: float, flow: float, pitch: float) -> tuple[float, float]:
    """Weight, buoyancy, thrust and drag on a still towfish in body axes (P, Q) [N]: H (15)-(16) without the tension."""
    p, q, _ = _loads(body, density, flow, math.sin(pitch), math.cos(pitch))
    return p, q


def _loads(
    body: Towfish, density: float, flow: float, sine: _Number, cosine: _Number
) -> tuple[_Number, _Number, _Number]:
    """Force along P and Q [N], and moment with the cable's force that balances them [N m]: H (15)-(17) at rest."""
    u, v = -flow * cosine, flow * sine
    c = 0.5 * density * body.drag_coefficient * (body.area_p * abs(u) + body.area_q * abs(v))
    net = body.buoyancy - body.weight
    p = net * sine + body.thrust * cosine - c * u
    q = net * cosine - body.thrust * sine - c * v
    moment = (
        body.buoyancy * (body.buoyancy_centre_p * cosine - body.buoyancy_centre_q * sine)
        - body.tow_point_p * q
        + body.tow_point_q * p
        - c * (body.drag_centre_p * v - body.drag_centre_q * u)
    )
    return p, q, moment


def _pitch_equilibrium(body: Towfish, density: float, flow: float) -> float:
    """The stable pitch angle nearest to zero [rad]."""
    from scipy.optimize import brentq

    def moment_at(pitch: float) -> float:
        return _loads(body, density, flow, math.sin(pitch), math.cos(pitch))[2]

    grid = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 721)
    # A towfish that hangs by its nose rests at the end itself, where rounding decides.
    grid = np.concatenate([grid[:1] - _BEYOND, grid, grid[-1:] + _BEYOND])
    moment = _loads(body, density, flow, np.sin(grid), np.cos(grid))[2]
    falls = np.flatnonzero((moment[:-1] > 0.0) & (moment[1:] <= 0.0))
    if falls.size == 0 and body.buoyancy > body.weight:
        raise InvalidInput(
            f"The towfish floats up: its buoyancy of {body.buoyancy:g} N is more than its weight of {body.weight:g} N, "
            "so that the cable cannot hold it level below the ship. Give it less buoyancy."
        )
    if falls.size == 0:
        raise InvalidInput(
            f"The towfish has no stable pitch angle between -90 and 90 degrees in a flow of {flow + 0.0:g} m/s; the "
            f"moment runs from {moment.max():.3g} to {moment.min():.3g} N m. Move its tow point or its buoyancy "
            "centre up."
        )
    roots = [brentq(moment_at, grid[i], grid[i + 1], xtol=1e-14) for i in falls]
    return float(min(roots, key=abs))
