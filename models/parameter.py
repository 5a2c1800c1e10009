"""Free parameters of a reduced model: symbol, unit and search range, stated once beside the field.

A field annotated ``Annotated[float, Free("beta", "N s2/m3", "N s/m2", 1e-3, 1e5)]`` is a quantity that a fit may
move. The model itself takes every value above zero (or from zero on, where `zero` says so).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Literal, NamedTuple, TypeVar, get_type_hints

from models.quantity import InvalidInput, NumericalFailure, Quantity

Drag = Literal["linear", "quadratic"]
Model = TypeVar("Model")


@dataclass(frozen=True, slots=True)
class Free:
    """Symbol, unit with quadratic and with linear drag, search range, and whether zero is a value."""

    symbol: str
    quadratic_unit: str
    linear_unit: str
    lower: float
    upper: float
    zero: bool = False

    def unit(self, drag: Drag) -> str:
        """The unit under the given drag law."""
        return self.quadratic_unit if drag == "quadratic" else self.linear_unit

    def quantity(self, drag: Drag) -> Quantity:
        """The values that the model itself accepts."""
        return Quantity(self.symbol, self.unit(drag), lower=0.0, open_lower=not self.zero)


class Parameter(NamedTuple):
    """A free parameter with its present value; `lower` and `upper` bound a search for it."""

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    value: float


@cache
def free_fields(cls: type) -> Mapping[str, Free]:
    """Field name to its `Free` mark, in order."""
    return {
        name: mark
        for name, hint in get_type_hints(cls, include_extras=True).items()
        for mark in getattr(hint, "__metadata__", ())
        if isinstance(mark, Free)
    }


def check_free(model: Any, unused: Sequence[str] = ()) -> None:
    """Raise `InvalidInput` for an unknown drag law, a field outside its values, or an unused field that is not 0."""
    if model.drag not in ("linear", "quadratic"):
        raise InvalidInput(f"{type(model).__name__}.drag must be 'linear' or 'quadratic', but it is {model.drag!r}.")
    for name, free in free_fields(model.__class__).items():
        value, quantity = getattr(model, name), free.quantity(model.drag)
        if name in unused:
            if value != 0.0:
                raise InvalidInput(f"{type(model).__name__}.{name} has no effect with one link: leave it 0.")
        elif not quantity.holds(value):
            raise InvalidInput(
                f"{type(model).__name__}.{name} ({quantity.symbol}) must be {quantity.bound_text} {quantity.unit}, "
                f"but it is {value:g} {quantity.unit}."
            )


def free_parameters(model: Any, unused: Sequence[str] = ()) -> tuple[Parameter, ...]:
    """The free parameters of a model in the order of its fields, without the unused ones."""
    return tuple(
        Parameter(name, free.symbol, free.unit(model.drag), free.lower, free.upper, float(getattr(model, name)))
        for name, free in free_fields(model.__class__).items()
        if name not in unused
    )


def with_free(model: Model, names: Sequence[str], values: Sequence[float]) -> Model:
    """The same model with other values of the named parameters.

    Raises
    ------
    InvalidInput
        The number of values is wrong, or one of them is negative.
    NumericalFailure
        A value is not finite: a search has left the range of numbers.
    """
    if len(values) != len(names):
        raise InvalidInput(
            f"{type(model).__name__} needs {len(names)} values ({', '.join(names)}), but {len(values)} were given."
        )
    for name, value in zip(names, values, strict=True):
        if not abs(value) < float("inf"):
            raise NumericalFailure(f"{type(model).__name__}.{name} is {value}: not a finite value.")
    return replace(model, **{name: float(value) for name, value in zip(names, values, strict=True)})  # type: ignore[type-var]
