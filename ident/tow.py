"""The tow of a configuration file: its cable by one of two groups of keys, its vehicle, water, current and tails."""

from dataclasses import fields

from ident.reading import ConfigurationFile
from ident.sections import BY_LENGTH, BY_MATERIAL, SECTIONS
from ident.settings import Material
from models.body import Body
from models.cable import Cable
from models.current import Current
from models.quantity import InvalidInput
from models.tow import Tow
from models.towed_system import FIRST_PART, Part
from models.vehicle import Towfish, Vehicle

_DEFAULTS = {field.name: field.default for field in fields(Tow)}


def read_tow(file: ConfigurationFile) -> Tow:
    """The tow, from the sections [water], [cable], [vehicle] or [towfish], [tow] and [current]."""
    bodies = [name for name in ("vehicle", "towfish") if name in file]
    if len(bodies) != 1:
        found = "has both" if bodies else "has neither"
        raise InvalidInput(f"{file.source} needs one of the sections [vehicle] and [towfish], but {found}.")
    current = file.build("current", Current.from_profile, file.values("current")) if "current" in file else None
    vehicle = file.fill("vehicle", Vehicle) if "vehicle" in file else file.fill("towfish", Towfish)
    given = {**file.values("water"), **file.values("tow")}
    cable = _cable(file, "cable", given.get("water_density", _DEFAULTS["water_density"]))
    return Tow(cable=cable, vehicle=vehicle, current=current, **given)


def read_tails(file: ConfigurationFile, water_density: float) -> tuple[Part, ...]:
    """The parts after the vehicle, from the sections [[tail]]; each is after the part before it unless it says."""
    tails: list[Part] = []
    for section in file.tails:
        body = file.fill(f"{section}.body", Body) if f"{section}.body" in file else None
        given = {"after": tails[-1].name if tails else FIRST_PART, **file.values(section)}
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
    missing = [key for key in SECTIONS["cable"] if key.field in groups[0] and key.field not in values]
    if missing:
        raise InvalidInput(f"{file.place(section)} lacks the key {missing[0].label}; give {missing[0].wanted}.")
    if groups == [BY_LENGTH]:
        return file.build(section, Cable, values)
    material = Material(**{field: values.pop(field) for field in BY_MATERIAL})
    values |= {"density": material.density, "young_modulus": material.young_modulus, "water_density": water_density}
    return file.build(section, Cable.from_material, values)
