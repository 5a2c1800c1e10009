"""Winch settings of the spectral model: cable through the sheave, at most 5 % of its length."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput, check_quantities, non_negative, positive

Floats = NDArray[np.float64]

#: Largest payout or haul as a share of the cable, where the sines about one static shape still hold.
LARGEST_SHARE = 0.05


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Payout:
    """Open loop: cable paid out [m] against time [s], linear between the points, positive out."""

    t: Floats
    length: Floats

    def __post_init__(self) -> None:
        t, length = np.array(self.t, dtype=float), np.array(self.length, dtype=float)
        if t.ndim != 1 or t.shape != length.shape or t.size < 2:
            raise InvalidInput(f"A payout needs one length for each of at least 2 times, but got {t.size} and {length.size}.")
        if not (np.isfinite(t).all() and np.isfinite(length).all()) or np.any(np.diff(t) <= 0.0):
            raise InvalidInput("A payout needs finite, strictly increasing times and finite lengths.")
        for name, value in (("t", t), ("length", length)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)


@dataclass(frozen=True, slots=True, kw_only=True)
class DepthWinch:
    """Closed loop: a PI regulator of the vehicle's depth [m] with a rate limit, sampled at `period`.

    rate = K_p (reference - depth) + K_i int (reference - depth) dt; the integral waits while the rate is limited.
    """

    reference_depth: Annotated[float, positive("depth", "m")]
    proportional: Annotated[float, non_negative("K_p", "1/s")] = 0.02
    integral: Annotated[float, non_negative("K_i", "1/s2")] = 0.0
    rate_limit: Annotated[float, positive("rate", "m/s")] = 0.5
    period: Annotated[float, positive("period", "s")] = 1.0

    def __post_init__(self) -> None:
        check_quantities(self)


Winch = Payout | DepthWinch


def control_arrays(winch: Winch | None, cable_length: float) -> tuple[Floats, Floats, Floats]:
    """The winch as the kernels read it: control (8,), and times and lengths of an open-loop payout."""
    control, most = np.zeros(8), LARGEST_SHARE * cable_length
    control[6], control[7] = -most, most
    if winch is None:
        return control, np.zeros(2), np.zeros(2)
    if isinstance(winch, Payout):
        largest = float(np.abs(winch.length).max())
        if largest > most:
            raise InvalidInput(
                f"The spectral model pays out at most {LARGEST_SHARE:.0%} of the cable ({most:g} m of {cable_length:g} m), "
                f"but the payout reaches {largest:g} m; use a shorter payout."
            )
        control[0], control[1] = 1.0, min(1.0, float(np.diff(winch.t).min()))
        return control, np.ascontiguousarray(winch.t), np.ascontiguousarray(winch.length)
    control[:6] = (
        2.0,
        winch.period,
        winch.reference_depth,
        winch.proportional,
        winch.integral,
        winch.rate_limit,
    )
    return control, np.zeros(2), np.zeros(2)
