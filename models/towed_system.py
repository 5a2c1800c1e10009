"""A towed system of one or more parts in three dimensions: each a cable with a body at its lower end (W section 3)."""

import re
from dataclasses import dataclass
from typing import Annotated, Literal, Self

from models.body import Body
from models.cable import Cable
from models.current import Current
from models.quantity import InvalidInput, Quantity, check_quantities, positive
from models.tow import Tow

#: How the drag of a link follows from its angle to the flow: by components, or by W's law of the incidence angle.
DragLaw = Literal["quadratic", "incidence"]

#: What the part of a planar tow is called that ends at its vehicle.
VEHICLE_PART = "vehicle"

#: Structural damping ratio of a cable that strums.
StrummingDamping = Annotated[float, Quantity("zeta", "-", lower=0.0, upper=1.0)]


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A cable and the body at its lower end; without a body, a bare end or a plain joint.

    `after` names the part at whose lower end the cable begins; without it the cable begins at the ship.
    """

    name: str
    cable: Cable
    body: Body | None
    after: str | None = None

    def __post_init__(self) -> None:
        if not re.fullmatch(r"[\w-]+", self.name):
            raise InvalidInput(f"The name of a part must be of letters, digits, - and _, but it is {self.name!r}.")

    @property
    def weight_in_water(self) -> float:
        """Weight in water of the cable and the body [N]."""
        own = self.cable.weight_in_water * self.cable.length
        return own if self.body is None else own + self.body.weight_in_water


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TowedSystem:
    """The parts from the ship down, the water, and the ship's steady speed toward +X.

    Several parts may begin at the same lower end. `strumming_damping` is the structural damping ratio of the
    cables, used when `strumming` asks for the amplified drag of `models.strumming`.
    """

    parts: tuple[Part, ...]
    water_density: Annotated[float, positive("rho", "kg/m3")] = 1025.0
    current: Current | None = None
    speed: Annotated[float, Quantity("U", "m/s")] = 0.0
    drag_law: DragLaw = "quadratic"
    strumming: bool = False
    strumming_damping: StrummingDamping = 0.005

    def __post_init__(self) -> None:
        check_quantities(self)
        if not self.parts:
            raise InvalidInput("A towed system needs at least one part, but it has none.")
        for i, part in enumerate(self.parts):
            _check_place(part, [each.name for each in self.parts[:i]])
        total = sum(part.weight_in_water for part in self.parts)
        if not total > 0.0:
            raise InvalidInput(
                f"The whole system floats up: its weight in water is {total:.4g} N, which must be above 0 N. "
                "Give a body less buoyancy, or a cable more weight in water."
            )

    @classmethod
    def from_tow(cls, tow: Tow, tails: tuple[Part, ...] = ()) -> Self:
        """The system of a planar tow, whose vehicle is the body of the part `VEHICLE_PART`; `tails` are after it.

        With sections, the lengths of cable above the last are parts without a body, ``cable`` and ``section-1`` on.

        Raises
        ------
        InvalidInput
            The vehicle has no area or a thrust, or the parts do not make a system.
        """
        *above, last = reversed(tow.cables)
        joints: list[Part] = []
        for i, cable in enumerate(above):
            name = f"section-{i}" if i else "cable"
            joints.append(Part(name=name, cable=cable, body=None, after=joints[-1].name if joints else None))
        body = Body.from_vehicle(tow.vehicle)
        part = Part(name=VEHICLE_PART, cable=last, body=body, after=joints[-1].name if joints else None)
        return cls(parts=(*joints, part, *tails), water_density=tow.water_density, current=tow.current, speed=tow.speed)


def _check_place(part: Part, before: list[str]) -> None:
    """A name of its own, and an upper end that is already there."""
    if part.name in before:
        raise InvalidInput(f'Two parts are called "{part.name}"; give each part a name of its own.')
    if not before and part.after is not None:
        raise InvalidInput(f'The first part, "{part.name}", begins at the ship, but it is after "{part.after}".')
    if before and part.after not in before:
        names = ", ".join(f'"{name}"' for name in before)
        given = "nothing" if part.after is None else f'"{part.after}"'
        raise InvalidInput(
            f'Part "{part.name}" must be after one of the parts before it, {names}, but it is after {given}.'
        )
