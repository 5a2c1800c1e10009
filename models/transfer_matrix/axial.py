"""A straight elastic cable with a body at its lower end, moved along itself at the top: closed forms (H (28)-(34)).

Symbols: p(s) motion along the cable, s from the body up [m]; p_1, p_n at its ends; T_1, T_n dynamic tension there [N];
gamma, Gamma^2 [1/m] of the cable and of the body; b_p axial damping per length [N s/m2]; M, B mass with added mass
[kg] and damping [N s/m] of the body; c cable and compensator as a dynamic stiffness [N/m].

    EA p'' = m p_tt + b_p p_t,   EA p'(0) = M p_tt + B p_t,   p(L) = p_n

gives p(s) = p_1 (cosh gamma s + Gamma^2/gamma sinh gamma s) with gamma^2 = (-m omega^2 + i omega b_p)/EA and
Gamma^2 = (-M omega^2 + i omega B)/EA. Of the print, (28) lacks the time derivative in its damping, the square of
Gamma is lost and the labels of (32) and (33) are exchanged. With Re gamma >= 0 all of it is written in
e = exp(-gamma L), so that a long, heavily damped cable gives zero and no overflow.
"""

from dataclasses import dataclass
from typing import Annotated, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models import compensator
from models.equivalent_drag import DESCRIBING_FACTOR
from models.quantity import InvalidInput, NumericalFailure, Quantity, check_quantities, non_negative, positive
from models.tow import Tow
from models.vehicle import Towfish

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, kw_only=True)
class AxialString:
    """The cable and the body in linear axial motion; `loss_time` is the cable's `axial_damping`."""

    length: Annotated[float, positive("L", "m")]
    mass: Annotated[float, positive("m", "kg/m")]
    axial_stiffness: Annotated[float, positive("EA", "N")]
    damping: Annotated[float, non_negative("b_p", "N s/m2")] = 0.0
    end_mass: Annotated[float, non_negative("M", "kg")] = 0.0
    end_damping: Annotated[float, non_negative("B", "N s/m")] = 0.0
    loss_time: Annotated[float, Quantity("tau_a", "s", lower=0.0, upper=1.0)] = 0.0

    def __post_init__(self) -> None:
        check_quantities(self)

    @classmethod
    def from_tow(cls, tow: Tow, velocity: float) -> Self:
        """The tow as it hangs, its drag linearised everywhere at one velocity amplitude [m/s] in still water (H IV-B).

        The body moves across its length, as a towfish with its tow point above its centre does.

        Raises
        ------
        InvalidInput
            The velocity is negative or not finite, or the cable has several sections.
        """
        if not 0.0 <= velocity < np.inf:
            raise InvalidInput(f"The drag is linearised at a velocity of at least 0 m/s, but it is {velocity:g} m/s.")
        cable, body, rho = tow.single_cable("The closed form of the axial motion"), tow.vehicle, tow.water_density
        if isinstance(body, Towfish):
            added, drag = body.added_mass_q, 0.5 * rho * body.drag_coefficient * body.area_q
        else:
            added, drag = body.added_mass, body.drag(rho)
        return cls(
            length=cable.length,
            mass=cable.mass,
            axial_stiffness=cable.axial_stiffness,
            damping=DESCRIBING_FACTOR * cable.tangential_drag(rho) * velocity,
            end_mass=body.mass + added,
            end_damping=DESCRIBING_FACTOR * drag * velocity,
            loss_time=cable.axial_damping,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AxialResponse:
    """Complex amplitudes for one metre of motion of the cable's top.

    Parameters
    ----------
    omega
        (k,) [rad/s].
    bottom
        (k,) p_1/p_n [-].
    tension_bottom, tension_top
        (k,) T_1/p_n and T_n/p_n [N/m].
    """

    omega: Floats
    bottom: Complexes
    tension_bottom: Complexes
    tension_top: Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CompensatedResponse:
    """Complex amplitudes for one metre of motion of the vessel: p_n, R, p_1 [-] and T_1, T_n [N/m], all over D."""

    top: Complexes
    relative: Complexes
    bottom: Complexes
    tension_bottom: Complexes
    tension_top: Complexes


def axial_response(string: AxialString, omega: ArrayLike) -> AxialResponse:
    """The response to a moving top, (31)-(33) with their labels in order.

    Raises
    ------
    InvalidInput
        A frequency is not above zero, or there is none.
    NumericalFailure
        A resonance without damping.
    """
    om = np.atleast_1d(np.asarray(omega, dtype=float))
    wrong = np.flatnonzero(~(np.isfinite(om) & (om > 0.0)))
    if om.ndim != 1 or om.size == 0 or wrong.size:
        where = f"omega[{wrong[0]}] = {om[wrong[0]]:g} rad/s" if om.ndim == 1 and wrong.size else f"shape {om.shape}"
        raise InvalidInput(f"The axial response needs a row of frequencies above 0 rad/s, but it has {where}.")
    EA = string.axial_stiffness * (1.0 + 1j * om * string.loss_time)
    gamma = np.sqrt((-string.mass * om**2 + 1j * om * string.damping) / EA)
    square = (-string.end_mass * om**2 + 1j * om * string.end_damping) / EA
    e = np.exp(-gamma * string.length)
    less, more = -np.expm1(-2.0 * gamma * string.length), 1.0 + e**2
    denominator = gamma * more + square * less
    bad = np.flatnonzero(np.abs(denominator) <= 8.0 * np.finfo(float).eps * (np.abs(gamma) + np.abs(square)))
    if bad.size:
        raise NumericalFailure(f"The cable resonates without any damping at omega = {om[bad[0]]:g} rad/s.")
    bottom = 2.0 * gamma * e / denominator
    return AxialResponse(
        omega=om,
        bottom=bottom,
        tension_bottom=EA * square * bottom,
        tension_top=EA * gamma * (gamma * less + square * more) / denominator,
    )


def compensated_response(
    response: AxialResponse, mass: float, stiffness: ArrayLike, damping: ArrayLike
) -> CompensatedResponse:
    """The response to the vessel with a compensator at the top (H (27), (34)).

    Parameters
    ----------
    response
        At k frequencies.
    mass
        The compensator's apparent mass [kg].
    stiffness, damping
        [N/m], [N s/m]; they broadcast against each other and against the (k,) frequencies as last axis.

    Returns
    -------
    CompensatedResponse
        Of the broadcast shape: (n, m, k) of stiffnesses (n, 1, 1) and dampings (m, 1).
    """
    c = compensator.dynamic_stiffness(response.tension_top, response.omega, mass)
    Z = compensator.motion_ratio(c, response.omega, stiffness, damping)
    return CompensatedResponse(
        top=Z,
        relative=compensator.relative_ratio(c, response.omega, stiffness, damping),
        bottom=response.bottom * Z,
        tension_bottom=response.tension_bottom * Z,
        tension_top=response.tension_top * Z,
    )
