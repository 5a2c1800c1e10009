"""Speeds as given on the command line: metres a second, or knots with their unit."""

import math
import re

from data_synth.ships import KNOT
from models.quantity import InvalidInput

_UNITS = {"": 1.0, "m/s": 1.0, "kn": KNOT, "kt": KNOT, "kts": KNOT, "knot": KNOT, "knots": KNOT}
_SPEED = re.compile(r"\s*([0-9.]+(?:e[+-]?[0-9]+)?)\s*([a-z/]*)\s*", re.IGNORECASE)


def parse_speed(text: str) -> float:
    """The speed [m/s] that a text such as ``6 kn``, ``3 m/s`` or ``3`` stands for.

    Raises
    ------
    InvalidInput
        It is no number above zero, or has another unit.
    """
    found = _SPEED.fullmatch(text)
    try:
        speed = float(found[1]) * _UNITS[found[2].lower()] if found else math.nan
    except (ValueError, KeyError):
        speed = math.nan
    if not (math.isfinite(speed) and speed > 0.0):
        raise InvalidInput(f"A speed above zero is needed, such as '6 kn', '3 m/s' or '3' in m/s, but it is {text!r}.")
    return speed


def parse_speeds(text: str) -> tuple[float, ...]:
    """The speeds [m/s] of a list such as ``2 kn,4 kn,6 kn``, each with its own unit."""
    return tuple(parse_speed(part) for part in text.split(","))
