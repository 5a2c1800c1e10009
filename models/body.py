"""A body in three dimensions: a joint with three degrees of freedom, at the lower end of a cable (W section 2)."""

from dataclasses import dataclass
from typing import Annotated, Self

from models.quantity import GRAVITY, InvalidInput, check_quantities, non_negative, positive
from models.vehicle import Towfish, Vehicle, refuse_thrust


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A point body whose drag and added mass differ by axis.

    Surge is the horizontal direction in which the body's own cable pulls it, sway across it, heave vertical. With
    the water's speed u over the body, components u_f, u_s, u_v, the drag is
    F = 1/2 rho C_d |u| (A_f u_f, A_s u_s, A_v u_v). No area may be zero: motion along that axis would never die out.
    """

    weight: Annotated[float, non_negative("W", "N")]
    buoyancy: Annotated[float, non_negative("B", "N")]
    mass: Annotated[float, non_negative("M", "kg")]
    added_mass_surge: Annotated[float, non_negative("M_af", "kg")]
    added_mass_sway: Annotated[float, non_negative("M_as", "kg")]
    added_mass_heave: Annotated[float, non_negative("M_av", "kg")]
    area_surge: Annotated[float, positive("A_f", "m2")]
    area_sway: Annotated[float, positive("A_s", "m2")]
    area_heave: Annotated[float, positive("A_v", "m2")]
    drag_coefficient: Annotated[float, non_negative("C_d", "-")]

    def __post_init__(self) -> None:
        check_quantities(self)

    @property
    def weight_in_water(self) -> float:
        """W - B [N]."""
        return self.weight - self.buoyancy

    @classmethod
    def from_vehicle(cls, vehicle: Vehicle | Towfish) -> Self:
        """The joint that stands for a planar body.

        A point vehicle is the same along every axis. A towfish keeps its zero pitch: P is surge, Q heave, and sway,
        which it does not state, is taken as Q.

        Raises
        ------
        InvalidInput
            The vehicle has no area, or a thrust.
        """
        refuse_thrust(vehicle, "The link-joint chain")
        if isinstance(vehicle, Vehicle):
            if vehicle.area == 0.0:
                raise InvalidInput(
                    "Vehicle.area (A) must be above 0 m2 in the link-joint chain, but it is 0 m2: without drag its "
                    "heave would never die out; give the area, and a drag coefficient of 0 if there is to be no drag."
                )
            # The weight in air is that of the mass, or that in water where the mass is too small for it.
            weight = max(vehicle.mass * GRAVITY, vehicle.weight_in_water)
            buoyancy = weight - vehicle.weight_in_water
            added_p = added_q = vehicle.added_mass
            area_p = area_q = vehicle.area
        else:
            weight, buoyancy = vehicle.weight, vehicle.buoyancy
            added_p, added_q = vehicle.added_mass_p, vehicle.added_mass_q
            area_p, area_q = vehicle.area_p, vehicle.area_q
        return cls(
            weight=weight,
            buoyancy=buoyancy,
            mass=vehicle.mass,
            added_mass_surge=added_p,
            added_mass_sway=added_q,
            added_mass_heave=added_q,
            area_surge=area_p,
            area_sway=area_q,
            area_heave=area_q,
            drag_coefficient=vehicle.drag_coefficient,
        )
