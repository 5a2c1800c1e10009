"""Linear models for controllers: `control.StateSpace` with Pade's delay, and exact frequency responses."""

from typing import NamedTuple

import control
import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.linear_model import LinearModel
from models.quantity import InvalidInput

Floats = NDArray[np.float64]

#: Order of Pade's approximant unless given: phase within 0.1 degree up to 4 rad of delay.
PADE_ORDER = 4


class FrequencyResponse(NamedTuple):
    """Frequencies [rad/s], magnitude [1] and phase [rad], continuous from the lowest frequency, each (p,)."""

    omega: Floats
    magnitude: Floats
    phase: Floats


def to_state_space(model: LinearModel, *, pade_order: int = PADE_ORDER) -> control.StateSpace:
    """The model from ship velocity to vehicle velocity, its delay by Pade's approximant.

    Parameters
    ----------
    pade_order
        Order of numerator and denominator; 0 leaves the delay out.

    Raises
    ------
    InvalidInput
        The order is negative.
    """
    if pade_order < 0:
        raise InvalidInput(f"The order of the Pade approximant must be at least 0, but it is {pade_order}.")
    system = control.ss(model.A, model.B, model.C, model.D)
    if model.delay > 0.0 and pade_order > 0:
        numerator, denominator = control.pade(model.delay, pade_order)
        system = control.series(_companion(np.asarray(numerator), np.asarray(denominator)), system)
    return system


def frequency_response(model: LinearModel, omega: ArrayLike) -> FrequencyResponse:
    """Magnitude and phase with the exact delay exp(-i omega tau).

    Parameters
    ----------
    omega
        (p,) frequencies [rad/s], increasing.
    """
    omega = np.asarray(omega, dtype=float)
    undelayed = LinearModel(A=model.A, B=model.B, C=model.C, D=model.D).response(omega)
    # Unwrapped without the delay, whose phase between two frequencies may exceed a half turn.
    phase = np.unwrap(np.angle(undelayed)) - omega * model.delay
    return FrequencyResponse(omega=omega, magnitude=np.abs(undelayed), phase=phase)


def _companion(numerator: Floats, denominator: Floats) -> control.StateSpace:
    """Controllable canonical form of a proper transfer function, coefficients from the highest power down."""
    b, a = numerator / denominator[0], denominator / denominator[0]
    order = a.size - 1
    A = np.eye(order, k=1)
    A[-1] = -a[:0:-1]
    B = np.zeros((order, 1))
    B[-1] = 1.0
    C = (b[1:] - b[0] * a[1:])[::-1][None, :]
    return control.ss(A, B, C, b[0])
