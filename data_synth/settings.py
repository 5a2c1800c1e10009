"""Checks between the values of an input's settings; each value against its bounds is `models.quantity`'s."""

from typing import Any

from models.quantity import InvalidInput


def check_same_length(instance: Any, *names: str) -> None:
    """Raise `InvalidInput` unless the named tuples have one length."""
    lengths = [len(getattr(instance, name)) for name in names]
    if len(set(lengths)) > 1:
        given = ", ".join(f"{name} has {n}" for name, n in zip(names, lengths, strict=True))
        raise InvalidInput(f"{type(instance).__name__} needs lists of one length, but {given} values.")


def check_increasing(instance: Any, name: str) -> None:
    """Raise `InvalidInput` unless the named tuple of times increases strictly."""
    values = getattr(instance, name)
    for i in range(1, len(values)):
        if values[i] <= values[i - 1]:
            raise InvalidInput(
                f"{type(instance).__name__}.{name} must increase, but value {i} is {values[i - 1]:g} s "
                f"and value {i + 1} is {values[i]:g} s."
            )
