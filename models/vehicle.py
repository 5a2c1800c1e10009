"""The body at the lower end: a point vehicle, or a towfish that pitches in the plane (H section II-B)."""

import math
from dataclasses import dataclass
from typing import Annotated

from models.quantity import GRAVITY, InvalidInput, Quantity, check_quantities, non_negative, positive


@dataclass(frozen=True, slots=True, kw_only=True)
class Vehicle:
    """A point body with the same drag and added mass in every direction.

    `thrust` is constant and horizontal, toward +X: of a vehicle that holds itself.
    """

    weight_in_water: Annotated[float, Quantity("W", "N")]
    mass: Annotated[float, non_negative("M", "kg")]
    added_mass: Annotated[float, non_negative("M_a", "kg")]
    area: Annotated[float, non_negative("A", "m2")]
    drag_coefficient: Annotated[float, non_negative("C_d", "-")]
    thrust: Annotated[float, Quantity("F_x", "N")] = 0.0

    def __post_init__(self) -> None:
        check_quantities(self)

    def drag(self, water_density: float) -> float:
        """Quadratic drag 1/2 rho C_d A [N s2/m2]."""
        return 0.5 * water_density * self.drag_coefficient * self.area


@dataclass(frozen=True, slots=True, kw_only=True)
class Towfish:
    """A body with pitch angle Phi; P along its length, Q across it, up when Phi = 0 (H Table I).

    `inertia` holds solid and added fluid inertia; the centre of mass is the origin of the body axes.
    Positions are (P, Q) in body axes. `thrust` is constant, horizontal toward +X, and acts at the centre of mass.
    """

    weight: Annotated[float, positive("W", "N")]
    buoyancy: Annotated[float, non_negative("B", "N")]
    mass: Annotated[float, positive("M", "kg")]
    added_mass_p: Annotated[float, non_negative("M_aP", "kg")]
    added_mass_q: Annotated[float, non_negative("M_aQ", "kg")]
    inertia: Annotated[float, positive("J", "kg m2")]
    drag_coefficient: Annotated[float, non_negative("C_d,t", "-")]
    area_p: Annotated[float, non_negative("A_P", "m2")]
    area_q: Annotated[float, non_negative("A_Q", "m2")]
    length: Annotated[float, positive("l", "m")]
    added_mass_centre_p: Annotated[float, Quantity("r_aP", "m")] = 0.0
    added_mass_centre_q: Annotated[float, Quantity("r_aQ", "m")] = 0.0
    buoyancy_centre_p: Annotated[float, Quantity("r_bP", "m")] = 0.0
    buoyancy_centre_q: Annotated[float, Quantity("r_bQ", "m")] = 0.0
    tow_point_p: Annotated[float, Quantity("r_cP", "m")] = 0.0
    tow_point_q: Annotated[float, Quantity("r_cQ", "m")] = 0.0
    drag_centre_p: Annotated[float, Quantity("r_dP", "m")] = 0.0
    drag_centre_q: Annotated[float, Quantity("r_dQ", "m")] = 0.0
    thrust: Annotated[float, Quantity("F_x", "N")] = 0.0

    def __post_init__(self) -> None:
        check_quantities(self)
        if not math.isclose(self.weight, self.mass * GRAVITY, rel_tol=0.02):
            raise InvalidInput(
                f"Towfish.weight is the weight in air and must be mass times gravity within 2 %, but weight is "
                f"{self.weight:g} N and mass times gravity is {self.mass * GRAVITY:g} N."
            )

    @property
    def weight_in_water(self) -> float:
        """W - B [N]."""
        return self.weight - self.buoyancy

    @property
    def added_mass(self) -> float:
        """Added mass in horizontal motion at zero pitch [kg]."""
        return self.added_mass_p

    def drag(self, water_density: float) -> float:
        """Quadratic drag in horizontal motion at zero pitch, 1/2 rho C_d,t A_P [N s2/m2]."""
        return 0.5 * water_density * self.drag_coefficient * self.area_p


def refuse_thrust(vehicle: Vehicle | Towfish, what: str) -> None:
    """Raise `InvalidInput` if the vehicle has a thrust, for `what` (the beginning of a sentence) that knows none."""
    if vehicle.thrust != 0.0:
        raise InvalidInput(
            f"{what} knows no thrust, but {type(vehicle).__name__}.thrust (F_x) is {vehicle.thrust:g} N. Leave it out, "
            "or take a model that has it: the statics and the frequency-domain method."
        )
