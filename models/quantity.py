"""Symbol, unit and bounds of a physical quantity, stated once beside its type.

A field annotated ``Annotated[float, Quantity("L", "m", lower=0.0)]`` carries all that the checks of a
configuration file, the table headings, the axis labels and the optimiser's bounds need.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, get_args, get_type_hints

#: Standard gravity [m/s2], the one value used everywhere.
GRAVITY = 9.80665


class InvalidInput(ValueError):
    """Input that the program cannot work with; the message says what is needed, given and to be done."""


class NumericalFailure(ArithmeticError):
    """A computation that left the finite range or its own error bound; says time, place and quantity."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A symbol, a unit and the bounds a value must keep.

    ``lower`` and ``upper`` are inclusive unless ``open_lower`` or ``open_upper`` is set.
    """

    symbol: str
    unit: str
    lower: float = -math.inf
    upper: float = math.inf
    open_lower: bool = False
    open_upper: bool = False

    def holds(self, value: float) -> bool:
        """Whether a finite value lies inside the bounds."""
        if not math.isfinite(value) or value < self.lower or value > self.upper:
            return False
        return not ((self.open_lower and value == self.lower) or (self.open_upper and value == self.upper))

    @property
    def bound_text(self) -> str:
        """The bounds in words, such as ``above 0`` or ``from 0 to 0.5``."""
        low = f"{'above' if self.open_lower else 'at least'} {self.lower:g}"
        high = f"{'below' if self.open_upper else 'at most'} {self.upper:g}"
        has_low, has_high = math.isfinite(self.lower), math.isfinite(self.upper)
        if has_low and has_high:
            return f"{low} and {high}"
        return low if has_low else high if has_high else "finite"


def positive(symbol: str, unit: str) -> Quantity:
    """Bounds of a quantity that must be above zero."""
    return Quantity(symbol, unit, lower=0.0, open_lower=True)


def non_negative(symbol: str, unit: str) -> Quantity:
    """Bounds of a quantity that may be zero."""
    return Quantity(symbol, unit, lower=0.0)


def quantities(cls: type) -> Mapping[str, Quantity]:
    """Field name to its `Quantity`, for every annotated field of a class, in order."""
    found = {}
    for name, hint in get_type_hints(cls, include_extras=True).items():
        for part in (hint, *get_args(hint)):
            for mark in getattr(part, "__metadata__", ()):
                if isinstance(mark, Quantity):
                    found[name] = mark
    return found


def check_quantities(instance: Any) -> None:
    """Raise `InvalidInput` for the first annotated field outside its bounds, of a tuple for its first such value.

    ``None`` is left alone.
    """
    for name, quantity in quantities(type(instance)).items():
        value = getattr(instance, name)
        if value is None:
            continue
        several = isinstance(value, tuple)
        for i, one in enumerate(value if several else (value,)):
            if not quantity.holds(one):
                raise InvalidInput(
                    f"{type(instance).__name__}.{name}{f'[{i}]' if several else ''} ({quantity.symbol}) must be "
                    f"{quantity.bound_text} {quantity.unit}, but it is {one:g} {quantity.unit}."
                )
