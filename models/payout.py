"""Cable through the sheave against time, for every simulator that has a winch."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

Floats = NDArray[np.float64]

#: Time over which a drum changes from one rate to the next [s].
CORNER = 1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Payout:
    """Open loop: cable paid out [m] against time [s], linear between the points, positive out.

    The drum follows the table with its corners rounded over a second, and starts from rest: a table that rises at its
    very start loses a part of its first rate.
    """

    t: Floats
    length: Floats

    def __post_init__(self) -> None:
        freeze_table(self, "length")
        if self.t.size < 2:
            raise InvalidInput("A payout needs at least 2 times, but has 1.")


def freeze_table(winch: Any, name: str) -> None:
    """Check the times of a winch's table against its values, and make both read-only.

    Raises
    ------
    InvalidInput
        Not one value a time, times that do not increase, or a value that is not finite.
    """
    t, value = np.array(winch.t, dtype=float), np.array(getattr(winch, name), dtype=float)
    if t.ndim != 1 or t.shape != value.shape or t.size < 1:
        raise InvalidInput(f"A winch needs one {name} for each time, but got {value.size} for {t.size} times.")
    if not (np.isfinite(t).all() and np.isfinite(value).all()) or np.any(np.diff(t) <= 0.0):
        raise InvalidInput(f"A winch needs finite, strictly increasing times and finite values of {name}.")
    for field, array in (("t", t), (name, value)):
        array.setflags(write=False)
        object.__setattr__(winch, field, array)


def rounded(payout: Payout, begin: float, end: float) -> "PPoly":
    """The length paid out since `begin`, a piecewise parabola that is constant before the table and after it."""
    from scipy.interpolate import PPoly

    corner = min(CORNER, 0.5 * float(np.diff(payout.t).min()))
    # A box over the rate: each corner becomes a parabola of the corner's duration, the table's ends included.
    knots = np.concatenate([payout.t - 0.5 * corner, payout.t + 0.5 * corner, [begin, end + 1.0]])
    knots = np.unique(knots[(knots >= begin) & (knots <= end + 1.0)])
    rates = np.concatenate([[0.0], np.diff(payout.length) / np.diff(payout.t), [0.0]])

    def rate(t: Floats) -> Floats:
        """The box's mean of the rate, exact."""
        edges = np.concatenate([[-np.inf], payout.t, [np.inf]])
        low, high = t[:, None] - 0.5 * corner, t[:, None] + 0.5 * corner
        overlap = np.clip(np.minimum(high, edges[None, 1:]) - np.maximum(low, edges[None, :-1]), 0.0, None)
        mean: Floats = overlap @ rates / corner
        return mean

    values = rate(knots)
    widths = np.diff(knots)
    lengths = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * widths)])
    zero = np.zeros(widths.size)
    coefficients = np.array([zero, 0.5 * np.diff(values) / widths, values[:-1], lengths[:-1]])
    return PPoly(coefficients[:, :, None], knots)
