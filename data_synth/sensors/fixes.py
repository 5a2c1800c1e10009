"""Acoustic fixes of the vehicle: at intervals, noisy, offset, and missing in runs."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from models.quantity import InvalidInput, Quantity, check_quantities, non_negative, positive
from models.trace import Floats, Trace

_SAME_TIME = 1e-6  # s; multiples of a step differ in their last digit


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorModel:
    """Fixes every `fix_interval` with noise, a constant offset along x, and dropouts.

    `dropout_fraction` of the fixes are missing, in runs of `dropout_run` fixes on average. `window` is the
    length over which velocity is read from the fixes (see `differentiator`).
    """

    fix_interval: Annotated[float, positive("dt_fix", "s")] = 10.0
    fix_sigma: Annotated[float, non_negative("sigma", "m")] = 1.5
    dropout_fraction: Annotated[float, Quantity("f", "1", lower=0.0, upper=0.5)] = 0.05
    dropout_run: Annotated[float, Quantity("N_run", "fixes", lower=1.0)] = 3.0
    offset: Annotated[float, Quantity("x_off", "m")] = 40.0
    window: Annotated[float, positive("T_w", "s")] = 90.0

    def __post_init__(self) -> None:
        check_quantities(self)


def measure(vehicle: Trace, model: SensorModel, rng: np.random.Generator) -> Trace:
    """The fixes of a vehicle's track.

    Returns
    -------
    Trace
        On the fix times, from the track's first; noise is independent on x, y and z; dropouts are NaN rows.

    Raises
    ------
    InvalidInput
        The track is shorter than one fix interval.
    """
    last = int(np.floor((vehicle.t[-1] - vehicle.t[0]) / model.fix_interval + 1e-9))
    if last < 1:
        raise InvalidInput(
            f"A track to measure must last at least one fix interval of {model.fix_interval:g} s, but it lasts "
            f"{vehicle.t[-1] - vehicle.t[0]:g} s."
        )
    t = vehicle.t[0] + model.fix_interval * np.arange(last + 1)
    position = _at_samples(vehicle, t) + model.fix_sigma * rng.standard_normal((t.size, 3))
    position[:, 0] += model.offset
    position[_dropouts(t.size, model.dropout_fraction, model.dropout_run, rng)] = np.nan
    return Trace(t=t, position=position)


def _at_samples(track: Trace, t: Floats) -> Floats:
    """The track at the fix times: its own samples where the times are its own, else its spline."""
    place = np.minimum(np.searchsorted(track.t, t - _SAME_TIME), track.t.size - 1)
    own = np.abs(track.t[place] - t) <= _SAME_TIME
    return np.array(track.position[place]) if own.all() else track.at(t)


def _dropouts(count: int, fraction: float, run: float, rng: np.random.Generator) -> NDArray[np.bool_]:
    """(count,) which fixes are missing: a two-state Markov chain in its long-run balance."""
    draws = rng.random(count)
    recover = 1.0 / run
    lose = recover * fraction / (1.0 - fraction)
    missing = np.empty(count, dtype=bool)
    state = bool(draws[0] < fraction)
    for i, draw in enumerate(draws):
        if i:
            state = bool(draw >= recover) if state else bool(draw < lose)
        missing[i] = state
    return missing
