"""The sections of a configuration file, checked against their keys, and the dataclasses they fill."""

import tomllib
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from ident.schema import did_you_mean, keys_of, read, shown
from ident.sections import SECTIONS, keys_for, without_number
from models.quantity import InvalidInput

S = TypeVar("S")

_HEADING = tuple(key.name for key in SECTIONS[""])


class ConfigurationFile:
    """The sections of a parsed file, checked against their keys."""

    def __init__(self, text: str, source: str) -> None:
        self.source = source
        found = tables(text, source)
        self.given = tuple(f"{section}.{key}".lstrip(".") for section, table in found.items() for key in table)
        self._values = {name: read(table, keys_for(name, table), self.place(name)) for name, table in found.items()}
        self.tails = tuple(name for name in found if without_number(name) == "tail")
        self.sections = tuple(name for name in found if without_number(name) == "section")

    def __contains__(self, section: str) -> bool:
        return section in self._values

    def place(self, section: str) -> str:
        """File and section, for a message."""
        if without_number(section) != section:
            kind, number, *_ = section.split(".")
            return f"{self.source}: [{without_number(section)}] ({kind} {number})"
        return f"{self.source}: [{section}]" if section else f"{self.source}:"

    def values(self, section: str) -> Mapping[str, Any]:
        """Field name to value, as given."""
        return self._values.get(section, {})

    def fill(self, section: str, make: type[S]) -> S:
        """The dataclass of a section, from those of the section's values that are its fields."""
        names = {key.field for key in keys_of(make)}
        return self.build(section, make, {k: v for k, v in self.values(section).items() if k in names})

    def build(self, section: str, make: Callable[..., S], values: Mapping[str, Any]) -> S:
        """Call `make`; what it says against the values together is told with file and section."""
        try:
            return make(**values)
        except InvalidInput as error:
            raise InvalidInput(f"{self.place(section)} {error}") from error

    def checked_guesses(self, guesses: tuple[str, ...]) -> tuple[str, ...]:
        """The guesses, each a key of the file, none twice."""
        for i, guess in enumerate(guesses):
            if guess not in self.given:
                hint = did_you_mean(guess, self.given)
                raise InvalidInput(f'{self.source}: guesses[{i}] = "{guess}" is not a key of the file{hint}')
            if guess in guesses[:i]:
                raise InvalidInput(f'{self.source}: guesses[{i}] = "{guess}" is there twice; drop one.')
        return guesses


def _parsed(text: str, source: str) -> Mapping[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InvalidInput(f"{source} is not valid TOML: {error}.") from error
    except (ValueError, RecursionError) as error:  # thousands of digits, or of brackets
        raise InvalidInput(f"{source} is not usable TOML: {error}.") from error


def tables(text: str, source: str) -> dict[str, Mapping[str, Any]]:
    """Section name to table, as given.

    Keys above the first section are under the empty name, ``[inputs.KIND]`` is there by its full name, and the second
    ``[[tail]]`` is ``tail.2`` with ``tail.2.cable`` and ``tail.2.body``, the second ``[[section]]`` is ``section.2``.

    Raises
    ------
    InvalidInput
        Malformed TOML, or an unknown section.
    """
    document = _parsed(text, source)
    found: dict[str, Mapping[str, Any]] = {"": {k: v for k, v in document.items() if k in _HEADING}}
    named = {k: v for k, v in document.items() if k not in _HEADING}
    tails = _tails(named.pop("tail", []), source)
    sections = _numbered(named.pop("section", []), "section", source)
    kinds = named.pop("inputs", {})
    if not isinstance(kinds, Mapping):
        raise InvalidInput(f"{source}: inputs = {shown(kinds)} must be sections such as [inputs.ramps].")
    named |= {f"inputs.{kind}": table for kind, table in kinds.items()}
    for name, table in named.items():
        if name not in SECTIONS or name.startswith("tail."):
            what = f"section [{name}]" if isinstance(table, Mapping) else f"key {name} = {shown(table)}"
            hint = did_you_mean(name, [*(each for each in SECTIONS if each), *_HEADING])
            raise InvalidInput(f"{source} has the unknown {what}{hint}")
        if not isinstance(table, Mapping):
            raise InvalidInput(f"{source}: {name} = {shown(table)} must be a section [{name}] with keys of its own.")
        found[name] = table
    found.setdefault("cable", {})
    return found | sections | tails


def _numbered(given: Any, name: str, source: str) -> dict[str, Mapping[str, Any]]:
    """The sections ``[[name]]`` by their names with a number."""
    if not (isinstance(given, list) and all(isinstance(each, Mapping) for each in given)):
        raise InvalidInput(f"{source}: {name} = {shown(given)} must be sections [[{name}]], with two brackets.")
    return {f"{name}.{number}": table for number, table in enumerate(given, start=1)}


def _tails(given: Any, source: str) -> dict[str, Mapping[str, Any]]:
    """The numbered sections of every ``[[tail]]``; the cable's is there even if left out."""
    found: dict[str, Mapping[str, Any]] = {}
    for tail, own in _numbered(given, "tail", source).items():
        parts = {"cable": {}} | {name: own[name] for name in ("cable", "body") if name in own}
        found[tail] = {name: value for name, value in own.items() if name not in parts}
        for name, table in parts.items():
            if not isinstance(table, Mapping):
                place = f"{source}: {name} = {shown(table)} of {tail.replace('.', ' ')}"
                raise InvalidInput(f"{place} must be a section [tail.{name}] with keys of its own.")
            found[f"{tail}.{name}"] = table
    return found
