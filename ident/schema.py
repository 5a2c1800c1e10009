"""The keys of a configuration section, derived from the dataclass they fill, and the reader that checks a section.

A field ``length: Annotated[float, Quantity("L", "m", ...)]`` becomes the key ``length_m``: the name and the unit once,
the bounds from the annotation, required unless the field has a default. Nothing about a key is written twice.
"""

import difflib
import math
import types
from collections.abc import Collection, Iterable, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from models.quantity import InvalidInput, Quantity

_WORDS = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}


_FINITE = Quantity("", "-")


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """One accepted key: its name in the file, the field it fills, and what its value may be."""

    name: str
    field: str
    kind: type
    quantity: Quantity | None = None
    choices: tuple[str, ...] = ()
    listed: bool = False
    required: bool = False
    may_be_empty: bool = False

    @property
    def label(self) -> str:
        """The key with its symbol, such as ``length_m (L)``."""
        return f"{self.name} ({self.quantity.symbol})" if self.quantity else self.name

    @property
    def unit(self) -> str:
        """The unit, empty where there is none."""
        return self.quantity.unit if self.quantity and self.quantity.unit not in ("-", "1") else ""

    @property
    def wanted(self) -> str:
        """What the value must be, in words with bound and unit."""
        if self.choices:
            return "one of " + ", ".join(f'"{choice}"' for choice in self.choices)
        words = _WORDS[self.kind]
        if self.quantity and math.isfinite(self.quantity.lower) | math.isfinite(self.quantity.upper):
            words += f" {self.quantity.bound_text}"
        return f"{words} {self.unit}".rstrip()


def keys_of(
    cls: type, *, only: Collection[str] | None = None, renamed: Mapping[str, str] | None = None
) -> tuple[Key, ...]:
    """The keys that fill a dataclass, in the order of its fields.

    Parameters
    ----------
    only
        The fields that the section fills, where it does not fill them all.
    renamed
        Field name to the name in the file, before the unit, where they differ.
    """
    hints = get_type_hints(cls, include_extras=True)
    keys = []
    for field in fields(cls):
        if only is not None and field.name not in only:
            continue
        kind, quantity, choices, listed = _parts(hints[field.name])
        key = Key(
            name=(renamed or {}).get(field.name, field.name),
            field=field.name,
            kind=kind,
            quantity=quantity,
            choices=choices,
            listed=listed,
            required=field.default is MISSING and field.default_factory is MISSING,
            may_be_empty=field.default == (),
        )
        keys.append(replace(key, name=f"{key.name}_{_suffix(key.unit)}") if key.unit else key)
    return tuple(keys)


def _suffix(unit: str) -> str:
    """A unit as the end of a key: ``kg/m3`` gives ``kg_m3``, ``1/s`` gives ``per_s``."""
    return unit.replace("1/", "per_").replace("/", "_").replace(" ", "_")


def _parts(hint: Any) -> tuple[type, Quantity | None, tuple[str, ...], bool]:
    """Kind, quantity, choices and whether it is a list, from an annotation."""
    origin, arguments = get_origin(hint), get_args(hint)
    if origin is Annotated:
        kind, quantity, choices, listed = _parts(arguments[0])
        return kind, next((mark for mark in arguments[1:] if isinstance(mark, Quantity)), quantity), choices, listed
    if origin in (Union, types.UnionType):
        (inner,) = (part for part in arguments if part is not types.NoneType)
        return _parts(inner)
    if origin is tuple:
        kind, quantity, choices, _ = _parts(arguments[0])
        return kind, quantity, choices, True
    if origin is Literal:
        return str, None, arguments, False
    return hint, None, (), False


def read(table: Mapping[str, object], keys: Iterable[Key], place: str) -> dict[str, Any]:
    """Check a table of a configuration file against its keys.

    Parameters
    ----------
    place
        File and section, the beginning of every message.

    Returns
    -------
    dict
        Field name to value, for the keys that the table has.

    Raises
    ------
    InvalidInput
        Unknown or missing key, wrong type, not finite, or out of bounds.
    """
    known = {key.name: key for key in keys}
    values = {}
    for name, value in table.items():
        if name not in known:
            hint = did_you_mean(name, known)
            raise InvalidInput(f"{place} has the unknown key {name} = {shown(value)}{hint}")
        values[known[name].field] = _value(value, known[name], place)
    for key in known.values():
        if key.required and key.name not in table:
            raise InvalidInput(f"{place} lacks the key {key.label}; give {'a list, each ' * key.listed}{key.wanted}.")
    return values


def _value(value: object, key: Key, place: str) -> Any:
    if not key.listed:
        return _item(value, key, f"{place} {key.label}")
    if not isinstance(value, list):
        raise InvalidInput(f"{place} {key.label} must be a list, each {key.wanted}, but it is {shown(value)}.")
    if not value and not key.may_be_empty:
        raise InvalidInput(
            f"{place} {key.label} must be a list of at least one value, each {key.wanted}, but it is []."
        )
    return tuple(_item(item, key, f"{place} {key.label}[{index}]") for index, item in enumerate(value))


def _item(value: object, key: Key, label: str) -> Any:
    """A single value of the key's kind inside its bounds; a whole number is fine where a number is needed."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    result = _float(value) if number and key.kind is float else value
    fits = type(result) is key.kind and (not key.choices or result in key.choices)
    if fits and number:
        fits = (key.quantity or _FINITE).holds(_float(result))
    if not fits:
        unit = f" {key.unit}" if number and key.unit else ""
        raise InvalidInput(f"{label} must be {key.wanted}, but it is {shown(value)}{unit}.")
    return result


def _float(value: Any) -> float:
    try:
        return float(value)
    except OverflowError:  # a whole number of more than 308 digits
        return math.inf if value > 0 else -math.inf


def shown(value: object) -> str:
    """A value as the file writes it, cut to a readable length."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        text = f'"{value}"'
    elif isinstance(value, Mapping):
        text = "a table"
    elif isinstance(value, list):
        text = "[" + ", ".join(shown(item) for item in value[:5]) + (", ...]" if len(value) > 5 else "]")
    elif isinstance(value, int):
        text = str(value) if abs(value) < 10**30 else f"a whole number of {value.bit_length() * 3 // 10} digits"
    else:
        text = str(value)
    return text if len(text) <= 80 else text[:77] + "..."


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The end of a message about an unknown name: the nearest known one, or all of them."""
    known = list(known)
    spelt = {each.casefold(): each for each in known}
    near = difflib.get_close_matches(name.casefold(), spelt, n=1)
    if near:
        return f"; did you mean {spelt[near[0]]}?"
    return f"; known are {', '.join(known)}." if known else "; nothing is known here."
