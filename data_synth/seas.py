"""Wave spectra, one plain function each, and a random sea drawn from them.

Spectral densities are one-sided in angular frequency: ``int S d om = sigma^2``, significant height ``4 sigma``.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from data_synth.ships.motion import planar_motion, sample_times
from models.quantity import InvalidInput, Quantity, check_quantities, non_negative, positive
from models.trace import Floats, Trace

_BAND = (0.25, 5.0)  # of the peak frequency: all but 0.2 % of a Bretschneider sea's variance
_FEWEST_BINS = 64


def bretschneider(omega: ArrayLike, height: float, peak: float) -> Floats:
    """Bretschneider's spectrum, H: ``S = 5/16 H^2 om_m^4/om^5 exp(-1.25 (om_m/om)^4)``.

    Parameters
    ----------
    omega
        (n,) [rad/s], above 0.
    height
        Significant height [m].
    peak
        Frequency of the largest density, om_m [rad/s].

    Returns
    -------
    Floats
        (n,) [m2 s/rad].
    """
    u = np.asarray(omega, dtype=float) / peak
    return np.asarray(5.0 / 16.0 * height**2 / peak * u**-5.0 * np.exp(-1.25 * u**-4.0), dtype=float)


def jonswap(omega: ArrayLike, height: float, peak: float, gamma: float = 3.3) -> Floats:
    """JONSWAP spectrum (Hasselmann and others 1973), scaled to the significant height.

    Parameters as of `bretschneider`; `gamma` is the peak enhancement, 1 gives Bretschneider's spectrum.
    """
    u = np.asarray(omega, dtype=float) / peak
    return bretschneider(omega, height, peak) * _enhancement(u, gamma) / _enhanced_area(gamma)


class Sea(NamedTuple):
    """Surface motion at a fixed point: (n,) [m] and [m/s]; surge is the orbital motion along the waves."""

    heave: Floats
    heave_rate: Floats
    surge: Floats
    surge_rate: Floats


def realise(
    spectrum: Callable[[Floats], Floats], band: tuple[float, float], t: Floats, rng: np.random.Generator
) -> Sea:
    """A random sea with the variance that the spectrum has on a band.

    Parameters
    ----------
    spectrum
        Density [m2 s/rad] of angular frequencies [rad/s].
    band
        Lowest and highest frequency [rad/s]. It is cut in bins so narrow that the sea does not repeat in `t`;
        each bin gives one sinusoid of the bin's variance (Simpson's rule) and a phase drawn evenly.
    t
        (n,) [s], uniform.

    Raises
    ------
    InvalidInput
        The times are not uniform, or too coarse for the highest frequency.

    Notes
    -----
    Deep water: surge lags heave by a quarter period and has its amplitude, so that it is forward at the crest.
    The sinusoids have the frequencies of one Fourier transform, which sums them.
    """
    low, high = band
    dt = float(t[1] - t[0])
    if not np.allclose(np.diff(t), dt, rtol=1e-6) or high * dt >= np.pi:
        raise InvalidInput(
            f"A random sea up to {high:g} rad/s needs uniform times with steps below {np.pi / high:g} s, but the "
            f"steps go from {np.diff(t).min():g} to {np.diff(t).max():g} s."
        )
    size = max(t.size, int(np.ceil(_FEWEST_BINS * 2.0 * np.pi / ((high - low) * dt))))
    spacing = 2.0 * np.pi / (size * dt)
    bins = np.arange(int(np.floor(low / spacing + 0.5)), int(np.floor(high / spacing + 0.5)) + 1)
    start, end = (np.clip((bins + side) * spacing, low, high) for side in (-0.5, 0.5))
    area = (spectrum(start) + 4.0 * spectrum(0.5 * (start + end)) + spectrum(end)) * (end - start) / 6.0
    vectors = np.zeros(size, dtype=complex)
    vectors[bins] = np.sqrt(2.0 * area) * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, bins.size))
    motion = size * np.fft.ifft(vectors)[: t.size]
    rate = size * np.fft.ifft(1j * spacing * np.arange(size) * vectors)[: t.size]
    return Sea(motion.real, rate.real, motion.imag, rate.imag)


@dataclass(frozen=True, slots=True, kw_only=True)
class RandomSea:
    """A tow point that follows a random sea, heave and surge (T 2.6.3 asks for it; the vessel's own response is 1).

    `surge_ratio` is the surge amplitude by the heave amplitude; `gamma` belongs to JONSWAP alone, 3.3 if not given.
    """

    duration: Annotated[float, positive("T", "s")] = 3600.0
    sample: Annotated[float, positive("dt", "s")] = 0.5
    spectrum: Literal["bretschneider", "jonswap"] = "bretschneider"
    significant_height: Annotated[float, non_negative("H_s", "m")] = 2.0
    peak_period: Annotated[float, positive("T_p", "s")] = 10.0
    gamma: Annotated[float, Quantity("gamma", "1", lower=1.0, upper=20.0)] | None = None
    surge_ratio: Annotated[float, non_negative("r_s", "1")] = 1.0

    def __post_init__(self) -> None:
        check_quantities(self)
        if self.spectrum not in ("bretschneider", "jonswap"):
            raise InvalidInput(
                f"RandomSea.spectrum must be one of bretschneider, jonswap, but it is {self.spectrum!r}."
            )
        if self.gamma is not None and self.spectrum != "jonswap":
            raise InvalidInput(f"RandomSea.gamma is used by jonswap only, not by {self.spectrum}; leave it out.")
        if self.sample > 0.1 * self.peak_period:
            raise InvalidInput(
                f"RandomSea needs at least ten samples a peak period of {self.peak_period:g} s, but sample is "
                f"{self.sample:g} s; make it {0.1 * self.peak_period:g} s or shorter."
            )


def random_sea(settings: RandomSea, rng: np.random.Generator) -> Trace:
    """Draw the motion of the tow point; the variance outside the band drawn from is put back by scaling."""
    t = sample_times(settings.duration, settings.sample)
    peak = 2.0 * np.pi / settings.peak_period
    band = (_BAND[0] * peak, _BAND[1] * peak)
    gamma = (settings.gamma or 3.3) if settings.spectrum == "jonswap" else 1.0
    height = settings.significant_height / np.sqrt(_enhanced_area(gamma, *_BAND) / _enhanced_area(gamma))
    sea = realise(lambda omega: jonswap(omega, height, peak, gamma), band, t, rng)
    ratio = settings.surge_ratio
    return planar_motion(t, ratio * sea.surge, ratio * sea.surge_rate, sea.heave, sea.heave_rate)


def _enhancement(u: Floats, gamma: float) -> Floats:
    """Peak enhancement ``gamma^exp(-(u - 1)^2/(2 width^2))``, width 0.07 below the peak and 0.09 above."""
    width = np.where(u <= 1.0, 0.07, 0.09)
    return np.asarray(gamma ** np.exp(-0.5 * ((u - 1.0) / width) ** 2), dtype=float)


@lru_cache(maxsize=64)
def _enhanced_area(gamma: float, low: float = 0.0, high: float = np.inf) -> float:
    """``int 5 u^-5 exp(-1.25 u^-4) gamma^r du``: the variance by that of Bretschneider's whole spectrum."""
    from scipy.integrate import quad

    def density(u: float) -> float:
        return float(5.0 * u**-5.0 * np.exp(-1.25 * u**-4.0) * _enhancement(np.array(u), gamma)) if u > 0.05 else 0.0

    cuts = np.unique(np.clip([low, 0.8, 1.0, 1.3, high], low, high))
    return float(sum(quad(density, a, b, epsabs=1e-13, epsrel=1e-11)[0] for a, b in pairwise(cuts)))
