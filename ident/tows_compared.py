"""The tows on which two codes are compared: from rest, so that both begin with the cable hanging."""

import numpy as np

from data_synth.ships import KNOT, SpeedChanges, speed_changes
from models.trace import Trace

#: Radius [m] and speed [m/s] of the circle.
RADIUS, SPEED = 250.0, 6.0 * KNOT
_SAMPLE, _BEGINS = 1.0, 10.0
WORDS = (
    "Three tows from rest, with the cable hanging: straight ahead to 2 m/s within 60 s, a step to 0.5 m/s within 5 s, "
    f"and a circle of {RADIUS:g} m to 6 knots within 60 s."
)


def tows(scale: float = 1.0) -> dict[str, Trace]:
    """By name: 900 s, 600 s and 1200 s, times `scale`."""
    return {
        "straight": _from_rest(2.0, 60.0, 900.0 * scale),
        "step": _from_rest(0.5, 5.0, 600.0 * scale),
        "circle": on_circle(_from_rest(SPEED, 60.0, 1200.0 * scale), RADIUS),
    }


def on_circle(straight: Trace, radius: float) -> Trace:
    """The same speeds, on a circle to the left [m]."""
    angle = straight.position[:, 0] / radius
    speed = straight.rates()[:, 0]
    zero = np.zeros_like(angle)
    return Trace(
        t=straight.t,
        position=np.stack([radius * np.sin(angle), radius * (1.0 - np.cos(angle)), zero], axis=1),
        velocity=np.stack([speed * np.cos(angle), speed * np.sin(angle), zero], axis=1),
    )


def _from_rest(speed: float, rise: float, duration: float) -> Trace:
    orders = SpeedChanges(duration=duration, sample=_SAMPLE, times=(_BEGINS,), speeds=(0.0, speed), rise=rise)
    return speed_changes(orders)
