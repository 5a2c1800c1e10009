"""Winch settings of the spectral model: cable through the sheave, at most 5 % of its length."""

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from models.kernels import kernel
from models.payout import Payout, freeze_table
from models.quantity import InvalidInput, check_quantities, non_negative, positive
from models.spectral.workspace import PAID, PAID_CHANGE, PAID_RATE

Floats = NDArray[np.float64]

#: Largest payout or haul as a share of the cable, where the sines about one static shape still hold.
LARGEST_SHARE = 0.05


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DepthWinch:
    """Closed loop: a PI regulator of the vehicle's depth with a rate limit, sampled at `period`.

    The depth asked for is that at the start plus `change` [m] from each of the times `t` [s] on;
    rate = K_p (wanted - depth) + K_i int (wanted - depth) dt, and the integral waits while the drum is limited.
    """

    t: Floats
    change: Floats
    proportional: Annotated[float, non_negative("K_p", "1/s")] = 0.05
    integral: Annotated[float, non_negative("K_i", "1/s2")] = 0.0005
    rate_limit: Annotated[float, positive("rate", "m/s")] = 0.5
    acceleration_limit: Annotated[float, positive("a", "m/s2")] = 0.05
    period: Annotated[float, positive("period", "s")] = 1.0

    def __post_init__(self) -> None:
        check_quantities(self)
        freeze_table(self, "change")


Winch = Payout | DepthWinch


def control_arrays(winch: Winch | None, cable_length: float) -> tuple[Floats, Floats, Floats]:
    """The winch as the kernels read it: control (8,), and times and values of its table."""
    control, most = np.zeros(8), LARGEST_SHARE * cable_length
    control[6], control[7] = -most, most
    if winch is None:
        return control, np.zeros(2), np.zeros(2)
    if isinstance(winch, Payout):
        largest = float(np.abs(winch.length).max())
        if largest > most:
            raise InvalidInput(
                f"The spectral model pays out at most {LARGEST_SHARE:.0%} of the cable ({most:g} m of "
                f"{cable_length:g} m), but the payout reaches {largest:g} m; use a shorter payout."
            )
        control[:3] = 1.0, min(1.0, float(np.diff(winch.t).min())), np.inf
        return control, np.ascontiguousarray(winch.t), np.ascontiguousarray(winch.length)
    control[:6] = 2.0, winch.period, winch.acceleration_limit, winch.proportional, winch.integral, winch.rate_limit
    return control, np.ascontiguousarray(winch.t), np.ascontiguousarray(winch.change)


@kernel
def steer(control: Floats, times: Floats, values: Floats, t: float, depth: float, memory: Floats) -> None:
    """Begin a control period: the drum's speed changes evenly over it, so that the cable feels no jump.

    `control` is (mode, period, acceleration limit, K_p, K_i, rate limit, least, greatest payout). Mode 1 follows the
    slope of the table; mode 2 is PI on the change of depth since the start, the table its steps. `memory` is (payout
    and rate at the period's start, rate at its end, its start, integral).
    """
    period = control[1]
    if memory[3] < t:
        memory[0] += 0.5 * (memory[1] + memory[2]) * (t - memory[3])
        memory[1] = memory[2]
    memory[3] = t
    payout, rate = memory[0], memory[1]
    if control[0] == 1.0:
        middle = t + 0.5 * period
        wanted = (_table(times, values, middle + period) - _table(times, values, middle)) / period
    else:
        change = 0.0
        for k in range(times.size):
            if times[k] <= t + 1e-9:
                change = values[k]
        error = change - depth
        asked = control[3] * error + control[4] * (memory[4] + error * period)
        wanted = min(max(asked, -control[5]), control[5])
        wanted = min(max(wanted, rate - control[2] * period), rate + control[2] * period)
        if wanted == asked:
            memory[4] += error * period
        # The drum brakes in time to stop at the share of the cable that the model allows.
        wanted = min(wanted, _braking(control[7] - payout, rate, period, control[2]))
        wanted = max(wanted, -_braking(payout - control[6], -rate, period, control[2]))
    memory[2] = wanted


@kernel
def _braking(room: float, rate: float, period: float, limit: float) -> float:
    """Greatest rate at the end of a period that can still be braked to rest within the room left."""
    half = 0.5 * period
    return limit * (math.sqrt(max(half * half + 2.0 * (room - rate * half) / limit, 0.0)) - half)


@kernel
def pay_out(control: Floats, memory: Floats, t: float, end: Floats) -> None:
    """Fill `end` with payout, rate and its change at a time in the control period."""
    since = t - memory[3]
    bend = (memory[2] - memory[1]) / control[1]
    end[PAID] = memory[0] + (memory[1] + 0.5 * bend * since) * since
    end[PAID_RATE], end[PAID_CHANGE] = memory[1] + bend * since, bend


@kernel
def _table(times: Floats, values: Floats, t: float) -> float:
    """The table at t: straight lines between its points, constant outside."""
    k = 0
    while k < times.size - 2 and times[k + 1] < t:
        k += 1
    share = min(max((t - times[k]) / (times[k + 1] - times[k]), 0.0), 1.0)
    value: float = values[k] + share * (values[k + 1] - values[k])
    return value
