"""Predictors without any physics, which a model must beat to be worth its parameters."""

import numpy as np

from ident.cases import Case
from models.drive import Drive
from models.quantity import InvalidInput
from models.reduced import Response

CONSTANT_VELOCITY = "baseline-constant-velocity"
RIGID_OFFSET = "baseline-rigid-offset"
RIGID = "baseline-rigid"

#: The vehicle's last stretch of the fitting part whose mean velocity it keeps [s].
STRETCH = 300.0


def constant_velocity(case: Case, until: float) -> Response:
    """The vehicle keeps its mean velocity over the last five minutes before `until`.

    Parameters
    ----------
    until
        End of the fitting part [s after the record's start].

    Raises
    ------
    InvalidInput
        The stretch holds fewer than two positions of the vehicle.
    """
    since = case.drive.t[case.position_index] - case.drive.t[0]
    used = (since < until) & (since >= until - STRETCH)
    if int(used.sum()) < 2:
        raise InvalidInput(
            f"The constant-velocity baseline needs 2 positions of {case.name} from {max(until - STRETCH, 0.0):g} to "
            f"{until:g} s, but there are {int(used.sum())}; its case must hold the fitting part too."
        )
    middle = float(since[used].mean())
    lag, place = since[used] - middle, case.position[used]
    speed = float(lag @ place) / float(lag @ lag)
    position = float(place.mean()) + speed * (case.drive.t - case.drive.t[0] - middle)
    return Response(position=position, velocity=np.full(position.size, speed))


def rigid_offset(case: Case, until: float) -> Response:
    """The ship's motion at the mean offset of the fitting part, which ends at `until` [s after the start].

    Raises
    ------
    InvalidInput
        The fitting part holds no position of the vehicle.
    """
    since = case.drive.t[case.position_index] - case.drive.t[0]
    used = since < until
    if not used.any():
        raise InvalidInput(
            f"The rigid-offset baseline needs a position of {case.name} before {until:g} s, but there is none; its "
            "case must hold the fitting part too."
        )
    ship = rigid(case.drive)
    offset = float((case.position - ship.position[case.position_index])[used].mean())
    return Response(position=ship.position + offset, velocity=ship.velocity)


def rigid(drive: Drive) -> Response:
    """The vehicle moves as the ship, right below it."""
    return Response(position=drive.x0 + drive.u, velocity=np.ascontiguousarray(drive.rates[:, 0]))
