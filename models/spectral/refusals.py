"""What the spectral simulator refuses, and what it says of a run that failed."""

import math
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput, NumericalFailure
from models.spectral.system import BUDGET, LARGEST_ANGLE, NOT_FINITE, SLACK, STEEP
from models.statics import SlackCable, StaticShape
from models.tow import Tow
from models.trace import Trace

Floats = NDArray[np.float64]

#: Longest reach omega L/sqrt(EA/m) of the ship's motion along the cable, of which a linear axial motion is within 5 %.
_AXIAL_REACH = 1.0


def check(
    ship: Trace, tolerance: float, stepper: str, steppers: tuple[str, ...], start: str, step: float | None
) -> None:
    """Raise `InvalidInput` for an option that does not exist or a track that is not complete and planar."""
    if stepper not in steppers:
        raise InvalidInput(f"The stepper must be one of {', '.join(steppers)}, but {stepper!r} was given.")
    if start not in ("rest", "steady"):
        raise InvalidInput(f"The start must be rest or steady, but {start!r} was given.")
    if not (tolerance > 0.0 and math.isfinite(tolerance)):
        raise InvalidInput(f"The tolerance must be above 0 m/s, but {tolerance:g} m/s was given.")
    if step is not None and not (step > 0.0 and math.isfinite(step)):
        raise InvalidInput(f"The step must be above 0 s, but {step:g} s was given.")
    if not ship.valid.all():
        i = int(np.argmin(ship.valid))
        raise InvalidInput(f"The ship's trace must be complete, but its sample {i} at t = {ship.t[i]:g} s is missing.")
    off = float(np.ptp(ship.position[:, 1]))
    if off > 1e-6:
        raise InvalidInput(
            f"The spectral simulator is planar, but the ship leaves the plane by {off:.3g} m across its track; "
            "project the track on one direction, or use the three-dimensional simulator."
        )


def refuse_axial_waves(tow: Tow, ship: Trace, shape: StaticShape, tolerance: float) -> None:
    """Raise `InvalidInput` where the ship moves the cable along itself too fast to be followed all along at once."""
    top, cable = float(shape.phi[-1]), tow.cable
    c, s = math.cos(top), math.sin(top)
    # The spline's own coefficients: rates at its knots are the last but one, half the accelerations the one before.
    rates, halves = ship.spline.c[-2], ship.spline.c[-3]
    rate = c * (rates[:, 0] - tow.speed) + s * rates[:, 2]
    change = 2.0 * (c * halves[:, 0] + s * halves[:, 2])
    size = float(np.sqrt(np.mean(rate**2)))
    if size <= tolerance:
        return
    omega = float(np.sqrt(np.mean(change**2))) / size
    reach = omega * cable.length * math.sqrt(cable.mass / cable.axial_stiffness)
    if reach > _AXIAL_REACH:
        raise InvalidInput(
            f"The ship moves the cable's top along it at about {omega:.2g} rad/s, and in {cable.length:g} m of this "
            f"cable that makes axial waves (omega L/sqrt(EA/m) = {reach:.2g}, at most {_AXIAL_REACH:g}), which the "
            "spectral simulator leaves out. Simulate with link-joint, or take the frequency-domain method."
        )


def fail(status: int, where: Floats, counts: NDArray[np.int64], tow: Tow, budget: int) -> NoReturn:
    """Raise what a stepper's status says, with its place in time and along the cable."""
    time, spot = float(where[0]), float(where[1])
    if status == SLACK:
        raise SlackCable(
            f"The cable goes slack at t = {time:.2f} s, s = {spot:.1f} m of {tow.cable.length:g} m from the vehicle: "
            "its tension falls to zero, where the sine series about one shape no longer holds."
        )
    if status == STEEP:
        raise NumericalFailure(
            f"The cable is turned by more than {LARGEST_ANGLE:g} rad from its static shape at t = {time:.2f} s, "
            f"s = {spot:.1f} m of {tow.cable.length:g} m from the vehicle: no small deflection, which the sine series "
            "is for. Give the tow a steady speed near the ship's, or simulate with link-joint."
        )
    if status == NOT_FINITE:
        raise NumericalFailure(
            f"The spectral simulator left the finite range at t = {time:.2f} s, s = {spot:.1f} m (tension)."
        )
    if status == BUDGET:
        raise NumericalFailure(
            f"The spectral simulator used its budget of {budget} steps by t = {time:.2f} s "
            f"({int(counts[3])} rejected); allow a larger tolerance or a shorter record."
        )
    raise NumericalFailure(
        f"The spectral simulator's step does not converge at t = {time:.2f} s (vehicle velocity); a smaller step, a "
        "smoother ship record or the implicit stepper may help."
    )
