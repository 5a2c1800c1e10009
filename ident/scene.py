"""What a scene is made of, and what it does without: the tables at the head of every report."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from ident.configuration import Configuration
from ident.reading import tables
from ident.schema import shown
from ident.sections import keys_for
from models.quantity import quantities
from models.vehicle import Towfish

_COLUMNS = ["part", "setting", "value", "unit", "guess", "note"]
#: Sections that say how a study is made, not what is towed.
_SYSTEM = ("water", "cable", "vehicle", "towfish", "tow", "current")


def configuration_table(configuration: Configuration) -> pd.DataFrame:
    """The settings of the towed system as given, and what follows from them; one row a value."""
    found = tables(configuration.text, configuration.source)
    rows: list[tuple[str, str, object, str, bool, str]] = []
    for section in _SYSTEM:
        rows += _rows(section, found.get(section, {}), configuration)
    for section, table in found.items():
        # A guess counts wherever it stands.
        if section not in _SYSTEM:
            towed = section.startswith("tail.")
            rows += [row for row in _rows(section, table, configuration) if towed or row[4]]
    given = {(part, name) for part, name, *_ in rows}
    cable = configuration.tow.cable
    for name in ("mass", "weight_in_water", "axial_stiffness"):
        quantity = quantities(type(cable))[name]
        if ("cable", "density") in given:
            note = "from density, diameter and modulus"
            rows.append(("cable", name.replace("_", " "), getattr(cable, name), quantity.unit, False, note))
    return pd.DataFrame(rows, columns=_COLUMNS)


def _rows(
    section: str, table: Mapping[str, Any], configuration: Configuration
) -> list[tuple[str, str, object, str, bool, str]]:
    keys = {key.name: key for key in keys_for(section, table)}
    rows: list[tuple[str, str, object, str, bool, str]] = []
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
    if tow.cable.poisson_ratio == 0.5:
        why = "Poisson's ratio is 0.5: it adds nothing to the effective tension"
        missing.append(("stretch by water pressure", why))
    if tow.cable.tangential_drag_coefficient == 0.0:
        missing.append(("tangential drag", "its coefficient is zero"))
    return missing


def unused(configuration: Configuration, keys: tuple[str, ...]) -> list[tuple[str, str]]:
    """Given keys that a study does not use, with the reason."""
    return [(key, "no part of this study reads it") for key in keys]
