"""What a scene is made of, and what it does without: the tables at the head of every report."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from ident.configuration import Configuration
from ident.reading import tables
from ident.schema import shown
from ident.sections import BY_LENGTH, SECTIONS, keys_for, without_number
from models.vehicle import Towfish

_COLUMNS = ["part", "setting", "value", "unit", "guess", "note"]
_Row = tuple[str, str, object, str, bool, str]
#: Sections that say what is towed, not how a study is made; those of the tails come after them.
_SYSTEM = ("water", "cable", "section", "vehicle", "towfish", "tow", "current", "compensator")


def configuration_table(configuration: Configuration) -> pd.DataFrame:
    """The settings of the towed system as given, and what follows from them; one row a value."""
    found = tables(configuration.text, configuration.source)
    rows: list[_Row] = []
    for kind in _SYSTEM:
        for section, table in found.items():
            if without_number(section) == kind:
                rows += _rows(section, table, configuration)
    for section, table in found.items():
        # A guess counts wherever it stands.
        if without_number(section) not in _SYSTEM:
            towed = section.startswith("tail.")
            rows += [row for row in _rows(section, table, configuration) if towed or row[4]]
    return pd.DataFrame(rows + _from_material(configuration, found), columns=_COLUMNS)


def _from_material(configuration: Configuration, found: Mapping[str, Mapping[str, Any]]) -> list[_Row]:
    """What follows from the material: of the cable, and of each section that it makes another cable."""
    tow, keys = configuration.tow, [key for key in SECTIONS["cable"] if key.field in BY_LENGTH]
    sections = {f"section.{number}": cable for number, cable in enumerate(tow.sections, start=1)}
    rows: list[_Row] = []
    for section, cable in {"cable": tow.cable, **sections}.items():
        material = {**found["cable"], **found[section]}
        if "density_kg_m3" not in material or any(key.name in found[section] for key in keys):
            continue
        for key in keys:
            value = getattr(cable, key.field)
            if section == "cable" or value != getattr(tow.cable, key.field):
                name = key.field.replace("_", " ")
                rows.append((section, name, value, key.unit, False, "from density, diameter and modulus"))
    return rows


def _rows(section: str, table: Mapping[str, Any], configuration: Configuration) -> list[_Row]:
    keys = {key.name: key for key in keys_for(section, table)}
    rows: list[_Row] = []
    for name, value in table.items():
        key = keys[name]
        plain = isinstance(value, int | float) and not isinstance(value, bool)
        guess = f"{section}.{name}" in configuration.guesses
        label = key.name.removesuffix("_" + key.unit.replace("/", "_").replace(" ", "_")) if key.unit else key.name
        shown_value = value if plain else (value if isinstance(value, str) else shown(value))
        rows.append((section, label.replace("_", " "), shown_value, key.unit, guess, ""))
    return rows


def left_out(
    configuration: Configuration, *, winch: bool = False, sea: bool = False, chain: bool = False
) -> list[tuple[str, str]]:
    """The effects that the scene does without, each with why.

    `chain` says that beside the spectral simulator a link-joint chain makes the truth of a verification.
    """
    tow = configuration.tow
    missing = [
        ("third dimension", "the ship's input lies in one vertical plane"),
        ("axial waves of the cable", "the tension is quasi-static (T 2.2): their modes are far above the input's band"),
        ("bending and torsion of the cable", "small beside the tension (T 2.2)"),
        ("compensator", "the cable's top moves with the ship; see the compensator study"),
        ("strumming", "no drag amplification is asked for"),
    ]
    if configuration.link_joint.strumming:
        missing[-1] = ("strumming", f"only {'the verification truth' if chain else 'the link-joint simulator'} has it")
    if configuration.tails:
        names = ", ".join(part.name for part in configuration.tails)
        why = f"the models are identified without {names}, which the verification truth tows"
        alone = f"this study tows the first part alone, without {names}"
        missing.append(("parts behind the vehicle", why if chain else alone))
    if tow.current is None:
        missing.append(("current", "the configuration has no [current]"))
    if tow.speed == 0.0:
        missing.append(("steady tow", "the configuration has no [tow] speed: motions are counted from a hanging cable"))
    if not isinstance(tow.vehicle, Towfish):
        missing.append(("pitch of the vehicle", "the configuration has a point [vehicle], no [towfish]"))
    elif chain:
        why = "in the chain every body is a joint with three degrees of freedom (W section 2)"
        missing.append(("pitch of the vehicle in the verification truth", why))
    if not winch:
        missing.append(("winch", "the cable keeps its length"))
    if not sea:
        missing.append(("sea state", "the ship's input has no heave"))
    if all(cable.poisson_ratio == 0.5 for cable in tow.cables):
        why = "Poisson's ratio is 0.5: it adds nothing to the effective tension"
        missing.append(("stretch by water pressure", why))
    if all(cable.tangential_drag_coefficient == 0.0 for cable in tow.cables):
        missing.append(("tangential drag", "its coefficient is zero"))
    if all(cable.axial_damping == 0.0 for cable in tow.cables):
        missing.append(("internal loss of the cable", "no axial damping is given"))
    return missing


def unused(configuration: Configuration, keys: tuple[str, ...]) -> list[tuple[str, str]]:
    """Given keys that a study does not use, with the reason."""
    return [(key, "no part of this study reads it") for key in keys]
