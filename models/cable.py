"""The cable: independent fields, and the constructor from material density and modulus."""

import math
from dataclasses import dataclass
from typing import Annotated, Literal, Self

from models.quantity import GRAVITY, Quantity, check_quantities, non_negative, positive

TangentialArea = Literal["diameter", "circumference"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cable:
    """A uniform cable. Lengths are unstretched; drag areas are per unstretched length.

    `tangential_area` states the reference of the tangential drag coefficient: ``diameter`` as
    T and H print it (1/2 rho d C_t u|u|), ``circumference`` for pi d. `axial_damping` is the time tau_a of the
    material's internal loss, T = EA (e + tau_a e'): a share omega tau_a/2 of critical at omega.
    """

    length: Annotated[float, positive("L", "m")]
    diameter: Annotated[float, positive("d", "m")]
    mass: Annotated[float, positive("m", "kg/m")]
    weight_in_water: Annotated[float, Quantity("w", "N/m")]
    added_mass: Annotated[float, non_negative("m_a", "kg/m")]
    axial_stiffness: Annotated[float, positive("EA", "N")]
    poisson_ratio: Annotated[float, Quantity("nu", "-", lower=0.0, upper=0.5)] = 0.5
    normal_drag_coefficient: Annotated[float, non_negative("C_n", "-")]
    tangential_drag_coefficient: Annotated[float, non_negative("C_t", "-")]
    tangential_area: TangentialArea = "diameter"
    axial_damping: Annotated[float, Quantity("tau_a", "s", lower=0.0, upper=1.0)] = 0.0

    def __post_init__(self) -> None:
        check_quantities(self)

    @classmethod
    def from_material(
        cls,
        *,
        length: float,
        diameter: float,
        density: float,
        young_modulus: float,
        water_density: float,
        added_mass: float,
        normal_drag_coefficient: float,
        tangential_drag_coefficient: float,
        poisson_ratio: float = 0.5,
        tangential_area: TangentialArea = "diameter",
        axial_damping: float = 0.0,
    ) -> Self:
        """Mass, weight and stiffness from density [kg/m3] and modulus [Pa]: m = rho_c A, w = (rho_c - rho) A g."""
        area = 0.25 * math.pi * diameter**2
        return cls(
            length=length,
            diameter=diameter,
            mass=density * area,
            weight_in_water=(density - water_density) * area * GRAVITY,
            added_mass=added_mass,
            axial_stiffness=young_modulus * area,
            poisson_ratio=poisson_ratio,
            normal_drag_coefficient=normal_drag_coefficient,
            tangential_drag_coefficient=tangential_drag_coefficient,
            tangential_area=tangential_area,
            axial_damping=axial_damping,
        )

    @property
    def cross_section(self) -> float:
        """Cross-sectional area A [m2]."""
        return 0.25 * math.pi * self.diameter**2

    def normal_drag(self, water_density: float) -> float:
        """Quadratic normal drag per length 1/2 rho d C_n [N s2/m3]."""
        return 0.5 * water_density * self.diameter * self.normal_drag_coefficient

    def tangential_drag(self, water_density: float) -> float:
        """Quadratic tangential drag per length, on the stated reference area [N s2/m3]."""
        width = self.diameter * (math.pi if self.tangential_area == "circumference" else 1.0)
        return 0.5 * water_density * width * self.tangential_drag_coefficient
