"""The ship input for identification: a seeded, band-limited random velocity with biases, T 6.1."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from data_synth.ships.motion import planar_motion, sample_times
from models.quantity import InvalidInput, Quantity, check_quantities, non_negative, positive
from models.trace import Trace


@dataclass(frozen=True, slots=True, kw_only=True)
class StandardInput:
    """A normal sequence plus one bias a segment, filtered, and scaled to a maximum speed.

    Each segment's bias is drawn from `biases` and multiplied by `bias_scale`; `cutoff` is the half-power
    frequency of the second-order Butterworth filter.
    """

    duration: Annotated[float, positive("T", "s")] = 3600.0
    sample: Annotated[float, positive("dt", "s")] = 1.0
    noise_sigma: Annotated[float, non_negative("sigma", "m/s")] = 1.0 / 3.0
    biases: tuple[Annotated[float, Quantity("b", "m/s")], ...] = (0.0, 0.12, -0.12, 0.2)
    bias_scale: Annotated[float, non_negative("s_b", "1")] = 1.5
    segment: Annotated[float, positive("T_b", "s")] = 600.0
    cutoff: Annotated[float, positive("om_c", "rad/s")] = 0.06
    max_speed: Annotated[float, positive("v_max", "m/s")] = 0.5

    def __post_init__(self) -> None:
        check_quantities(self)
        if not self.biases:
            raise InvalidInput("StandardInput.biases needs at least one value; give [0.0] for none.")
        nyquist = np.pi / self.sample
        if self.cutoff >= nyquist:
            raise InvalidInput(
                f"StandardInput.cutoff (om_c) must be below pi/sample = {nyquist:g} rad/s, but it is "
                f"{self.cutoff:g} rad/s; make the sample shorter."
            )


def standard_input(settings: StandardInput, rng: np.random.Generator) -> Trace:
    """Draw the ship's velocity and integrate it.

    Returns
    -------
    Trace
        Surge from x = 0, with the velocity at the samples; its largest magnitude is `max_speed` exactly.

    Raises
    ------
    InvalidInput
        The sequence is zero throughout, so that no scale brings it to `max_speed`.

    Notes
    -----
    T 6.1. The filter is causal and starts from rest; the positions are the integral of the cubic spline
    through the velocities, so that the trace's own spline gives the velocities back.
    """
    from scipy.interpolate import CubicSpline
    from scipy.signal import butter, sosfilt

    t = sample_times(settings.duration, settings.sample)
    segments = max(1, int(np.ceil(settings.duration / settings.segment - 1e-9)))
    noise = settings.noise_sigma * rng.standard_normal(t.size)
    bias = settings.bias_scale * rng.choice(np.array(settings.biases), size=segments)
    part = np.minimum((t / settings.segment + 1e-9).astype(int), segments - 1)
    sections = butter(2, settings.cutoff, fs=2.0 * np.pi / settings.sample, output="sos")
    v = np.asarray(sosfilt(sections, noise + bias[part]), dtype=float)
    largest = float(np.abs(v).max())
    if largest == 0.0:
        raise InvalidInput("StandardInput is zero throughout; give a noise_sigma or a bias above zero.")
    v = v / largest * settings.max_speed
    return planar_motion(t, CubicSpline(t, v).antiderivative()(t), v)
