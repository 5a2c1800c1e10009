"""A random sea that repeats after its record, the ship's motion in it, and what such a record cannot tell.

The sea has the spectrum's own amplitudes and drawn phases at the multiples of 2 pi over the record: over one whole
record a linear answer then has the standard deviation of the spectrum itself, whatever the phases.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from data_synth.rao import Rao
from data_synth.seas import realise
from data_synth.spectra import Spectrum
from models.quantity import InvalidInput
from models.trace import Floats, Trace
from models.transfer_matrix import Direction, SeaResponse

Complexes = NDArray[np.complex128]

#: Fewest components of a drawn sea, and samples for each radian of its highest frequency.
_FEWEST, _SAMPLES = 64, 1.25


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Drawing:
    """A periodic sea: the surface is the real part of ``sum wave_j e^{i omega_j t}``.

    Parameters
    ----------
    t
        (n,) [s] of one record, from 0 in equal steps.
    omega
        (n,) [rad/s] of the components, those of an FFT of the record; below zero in its second half.
    wave
        (n,) complex amplitudes [m], zero where there is no wave.
    """

    t: Floats
    omega: Floats
    wave: Complexes

    @property
    def sample(self) -> float:
        """Step between samples [s]."""
        return float(self.t[1])

    @property
    def period(self) -> float:
        """Time after which the sea repeats [s]."""
        return self.t.size * self.sample

    @property
    def active(self) -> NDArray[np.bool_]:
        """(n,) which components there are."""
        present: NDArray[np.bool_] = self.wave != 0.0
        return present

    def series(self, response: Complexes) -> Floats:
        """(n, ...) [s] what has the response (n, ...) to a metre of each component."""
        weighted = self.wave.reshape(-1, *[1] * (response.ndim - 1)) * response
        return np.asarray(self.t.size * np.fft.ifft(weighted, axis=0).real, dtype=float)


def draw(spectrum: Spectrum, period: float, rng: np.random.Generator) -> Drawing:
    """Draw the phases of a sea that repeats after about `period` [s].

    Raises
    ------
    InvalidInput
        The record is too short for the spectrum.
    """
    from scipy.fft import next_fast_len

    low, high = float(spectrum.omega[0]), float(spectrum.omega[-1])
    shortest = _FEWEST * 2.0 * math.pi / (high - low)
    if not shortest <= period < math.inf:
        raise InvalidInput(
            f"A random sea from {low:.3g} to {high:.3g} rad/s needs a record of at least {math.ceil(shortest)} s, but "
            f"it is {period:g} s."
        )
    sample = 1.0 / (_SAMPLES * high)
    t = sample * np.arange(next_fast_len(math.ceil(period / sample), real=False))
    sea = realise(spectrum.at, (low, high), t, rng)
    wave = np.fft.fft(sea.heave + 1j * sea.surge) / t.size
    wave[np.abs(wave) < 1e-9 * np.abs(wave).max()] = 0.0
    omega = np.asarray(2.0 * math.pi * np.fft.fftfreq(t.size, sample), dtype=float)
    return Drawing(t=t, omega=omega, wave=wave)


def imposed_motion(omega: Floats, direction: Direction, rao: Rao | None, angle: float) -> Complexes:
    """(k, 2) horizontal and vertical motion of the cable's top a metre of wave, as `sea_response` takes it.

    `angle` [rad] is that of the cable at its top; without an `rao` the top moves by the wave itself in `direction`.
    """
    along = np.array([math.cos(angle), math.sin(angle)])
    if rao is None:
        unit = {"axial": along, "heave": np.array([0.0, 1.0]), "surge": np.array([1.0, 0.0])}[direction]
        return np.tile(unit.astype(complex), (omega.size, 1))
    motion = rao.motion(omega)
    return motion[:, 1:] * along if direction == "axial" else motion


def ship_trace(drawing: Drawing, position: Floats, speed: float, run_in: float) -> Trace:
    """The ship through the last `run_in` [s] of the record, in which the motion sets in, and the whole of the next.

    `position` (n, 2) [m] is the motion of the cable's top over one record, horizontal and vertical, about a steady tow.
    """
    before = math.ceil(run_in / drawing.sample)
    index = np.arange(-before, drawing.t.size)
    t = np.asarray(drawing.sample * (index + before), dtype=float)
    rise = np.clip(2.0 * t / (before * drawing.sample), 0.0, 1.0)
    moved = position[index % drawing.t.size] * (0.5 - 0.5 * np.cos(math.pi * rise))[:, None]
    track = np.zeros((t.size, 3))
    track[:, 0], track[:, 2] = speed * t + moved[:, 0], moved[:, 1]
    return Trace(t=t, position=track)


def between(series: Floats, sample: float, low: float, high: float = math.inf) -> Floats:
    """What a periodic series does from `low` to below `high` [rad/s], without its mean."""
    omega = 2.0 * math.pi * np.fft.rfftfreq(series.size, sample)
    kept = np.where((omega >= low) & (omega < high) & (omega > 0.0), np.fft.rfft(series), 0.0)
    return np.asarray(np.fft.irfft(kept, series.size), dtype=float)


def sampling_error(response: SeaResponse, quantity: str, duration: float) -> float:
    """Standard deviation of a record's RMS as a share of it, for a normal process: sqrt(pi/(2 T) int S^2/sigma^4).

    NaN of a quantity that does not move.
    """
    density = response.density * np.abs(response.amplitudes(quantity)) ** 2
    variance = float(np.trapezoid(density, response.omega))
    if not variance > 0.0:
        return math.nan
    square = float(np.trapezoid(density**2, response.omega))
    return math.sqrt(0.5 * math.pi / duration * square) / variance
