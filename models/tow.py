"""A tow: the cable, the body at its lower end, the water, and the steady state that motions are counted from."""

from dataclasses import dataclass
from typing import Annotated

from models.cable import Cable
from models.current import Current
from models.quantity import Quantity, check_quantities, positive
from models.vehicle import Towfish, Vehicle


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tow:
    """Everything a simulator needs to know of the system; `speed` is the ship's steady speed toward +X."""

    cable: Cable
    vehicle: Vehicle | Towfish
    water_density: Annotated[float, positive("rho", "kg/m3")] = 1025.0
    speed: Annotated[float, Quantity("U", "m/s")] = 0.0
    current: Current | None = None

    def __post_init__(self) -> None:
        check_quantities(self)
