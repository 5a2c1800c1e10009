"""A tow: the cable, the body at its lower end, the water, and the steady state that motions are counted from."""

from dataclasses import dataclass
from typing import Annotated

from models.cable import Cable
from models.current import Current
from models.quantity import InvalidInput, Quantity, check_quantities, positive
from models.vehicle import Towfish, Vehicle, refuse_thrust


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tow:
    """Everything a simulator needs to know of the system; `speed` is the ship's steady speed toward +X.

    `sections` are further lengths of cable between `cable`, which begins at the ship, and the vehicle: from the top
    down, the last one at the vehicle.
    """

    cable: Cable
    vehicle: Vehicle | Towfish
    sections: tuple[Cable, ...] = ()
    water_density: Annotated[float, positive("rho", "kg/m3")] = 1025.0
    speed: Annotated[float, Quantity("U", "m/s")] = 0.0
    current: Current | None = None

    def __post_init__(self) -> None:
        check_quantities(self)

    @property
    def cables(self) -> tuple[Cable, ...]:
        """All lengths of cable from the vehicle up; the last is `cable`."""
        return (*reversed(self.sections), self.cable)

    @property
    def length(self) -> float:
        """Unstretched length from the vehicle to the ship [m]."""
        return sum(cable.length for cable in self.cables)

    def single_cable(self, what: str) -> Cable:
        """The cable, for `what` (the beginning of a sentence), which knows one uniform cable only.

        Raises
        ------
        InvalidInput
            The tow has sections.
        """
        if self.sections:
            raise InvalidInput(
                f"{what} needs one uniform cable, but this one has {len(self.sections)} further "
                f"section{'s' if len(self.sections) > 1 else ''} between the cable and the vehicle. Leave the sections "
                "out, or simulate with link-joint."
            )
        return self.cable


def refuse_sections_and_thrust(tow: Tow, what: str) -> None:
    """Raise `InvalidInput` for a tow of several sections or with a thrust, which `what` does not know."""
    tow.single_cable(what)
    refuse_thrust(tow.vehicle, what)
