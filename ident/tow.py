"""The tow of a configuration file: its cable by one of two groups of keys, its vehicle, water, current and tails."""

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

from ident.reading import ConfigurationFile
from ident.sections import BY_LENGTH, BY_MATERIAL, SECTIONS
from models.body import Body
from models.cable import Cable
from models.current import Current
from models.quantity import InvalidInput
from models.tow import Tow
from models.towed_system import VEHICLE_PART, Part
from models.vehicle import Towfish, Vehicle

_DEFAULTS = {field.name: field.default for field in fields(Tow)}


def read_tow(file: ConfigurationFile) -> Tow:
    """The tow, from the sections [water], [cable], [[section]], [vehicle] or [towfish], [tow] and [current]."""
    bodies = [name for name in ("vehicle", "towfish") if name in file]
    if len(bodies) != 1:
        found = "has both" if bodies else "has neither"
        raise InvalidInput(f"{file.source} needs one of the sections [vehicle] and [towfish], but {found}.")
    current = file.build("current", Current.from_profile, file.values("current")) if "current" in file else None
    vehicle = file.fill("vehicle", Vehicle) if "vehicle" in file else file.fill("towfish", Towfish)
    given = {**file.values("water"), **file.values("tow")}
    water_density = given.get("water_density", _DEFAULTS["water_density"])
    cable = _cable(file, "cable", water_density)
    sections = tuple(_section(file, name, cable, water_density) for name in file.sections)
    return Tow(cable=cable, sections=sections, vehicle=vehicle, current=current, **given)


def read_tails(file: ConfigurationFile, water_density: float) -> tuple[Part, ...]:
    """The parts after the vehicle, from the sections [[tail]]; each is after the part before it unless it says."""
    tails: list[Part] = []
    for section in file.tails:
        body = file.fill(f"{section}.body", Body) if f"{section}.body" in file else None
        given = {"after": tails[-1].name if tails else VEHICLE_PART, **file.values(section)}
        cable = _cable(file, f"{section}.cable", water_density)
        tails.append(file.build(section, Part, {**given, "cable": cable, "body": body}))
    return tuple(tails)


def _cable(file: ConfigurationFile, section: str, water_density: float) -> Cable:
    """The cable by its material or by its length; both or neither is an error."""
    values = dict(file.values(section))
    groups = [group for group in (BY_MATERIAL, BY_LENGTH) if any(field in values for field in group)]
    names = {key.field: key.name for key in SECTIONS["cable"]}
    if len(groups) != 1:
        choice = " or ".join(
            "(" + ", ".join(names[field] for field in group) + ")" for group in (BY_MATERIAL, BY_LENGTH)
        )
        found = "keys of both" if groups else "none of them"
        raise InvalidInput(f"{file.place(section)} needs {choice}, one of the two, but it has {found}.")
    if groups == [BY_MATERIAL]:
        return _of_material(file, section, values, water_density)
    _check_complete(file, section, values, BY_LENGTH)
    return file.build(section, Cable, values)


def _section(file: ConfigurationFile, section: str, cable: Cable, water_density: float) -> Cable:
    """A further length of cable: what it does not say is the cable's, or follows from the cable's material."""
    own, above = file.values(section), file.values("cable")
    by_material, by_length = (any(field in own for field in group) for group in (BY_MATERIAL, BY_LENGTH))
    if by_material and by_length:
        names = ", ".join(key.name for key in SECTIONS["cable"] if key.field in own and key.field in BY_LENGTH)
        raise InvalidInput(f"{file.place(section)} has {names} beside keys of the material; give one or the other.")
    if by_material or (BY_MATERIAL[0] in above and not by_length):
        values = {field: value for field, value in above.items() if field not in BY_LENGTH} | dict(own)
        return _of_material(file, section, values, water_density)
    return file.build(section, lambda **values: replace(cable, **values), own)


def _of_material(file: ConfigurationFile, section: str, values: Mapping[str, Any], water_density: float) -> Cable:
    _check_complete(file, section, values, BY_MATERIAL)
    return file.build(section, Cable.from_material, {**values, "water_density": water_density})


def _check_complete(file: ConfigurationFile, section: str, values: Mapping[str, Any], group: tuple[str, ...]) -> None:
    missing = [key for key in SECTIONS["cable"] if key.field in group and key.field not in values]
    if missing:
        raise InvalidInput(f"{file.place(section)} lacks the key {missing[0].label}; give {missing[0].wanted}.")
