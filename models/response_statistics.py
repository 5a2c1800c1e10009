"""What a Gaussian response of narrow band comes to: heights, crossing periods, slack and extremes.

Symbols: sigma standard deviation of the response, sigma' that of its time derivative, N number of cycles,
T static tension [N]. Peaks are Rayleigh distributed, ``P(peak > x) = exp(-x^2/(2 sigma^2))``, and a height is twice a
peak. Everything works on numbers and arrays alike.

H's Table IV mixes two statistics of heights: its significant values are the average of the highest third,
``4.004 sigma``, but its 1/1000 values are the height that one in a thousand exceeds, ``7.43 sigma``; the average of
the highest thousandth would be ``7.94 sigma``. Of tensions it prints amplitudes, half as much.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput

Floats = NDArray[np.float64]

#: Fewest cycles that an extreme value is told of: the asymptotic law is within 2 % of the exact mean from here on.
FEWEST_CYCLES = 10.0


def highest_average(sigma: ArrayLike, n: float) -> Floats:
    """Average of the highest 1/n of the heights: ``2 sqrt2 sigma [sqrt(ln n) + n sqrt(pi)/2 erfc(sqrt(ln n))]``.

    Raises
    ------
    InvalidInput
        `n` is below 1, or a sigma is negative or not finite.
    """
    from scipy.special import erfc

    root = np.sqrt(np.log(_at_least_one(n)))
    factor = 2.0 * np.sqrt(2.0) * (root + 0.5 * n * np.sqrt(np.pi) * erfc(root))
    return np.asarray(factor * _checked("sigma", sigma), dtype=float)


def significant(sigma: ArrayLike) -> Floats:
    """Average of the highest third of the heights, ``4.004 sigma``."""
    return highest_average(sigma, 3.0)


def exceeded_by_one_in(sigma: ArrayLike, n: float) -> Floats:
    """The height that one in n exceeds, ``2 sigma sqrt(2 ln n)``: H's 1/1000 values.

    Raises
    ------
    InvalidInput
        `n` is below 1, or a sigma is negative or not finite.
    """
    return np.asarray(2.0 * np.sqrt(2.0 * np.log(_at_least_one(n))) * _checked("sigma", sigma), dtype=float)


def zero_crossing_period(sigma: ArrayLike, rate: ArrayLike) -> Floats:
    """Mean time between upward crossings of the mean, ``2 pi sigma/sigma'`` [s]; NaN of a response that stands still.

    Raises
    ------
    InvalidInput
        A standard deviation is negative or not finite.
    """
    size, speed = np.broadcast_arrays(_checked("sigma", sigma), _checked("rate", rate))
    period = np.full(size.shape, np.nan)
    np.divide(2.0 * np.pi * size, speed, out=period, where=(speed > 0.0) & (size > 0.0))
    return period


def slack_probability(tension: ArrayLike, sigma: ArrayLike) -> Floats:
    """Chance that a cycle's dynamic tension exceeds the static one, ``exp(-T^2/(2 sigma^2))``.

    Parameters
    ----------
    tension
        Static tension [N]; a cable without any is slack always.
    sigma
        Of the dynamic tension [N]; 0 for none.

    Raises
    ------
    InvalidInput
        A sigma is negative or not finite.
    """
    pull, size = np.broadcast_arrays(np.asarray(tension, dtype=float), _checked("sigma", sigma))
    ratio = np.full(pull.shape, np.inf)
    np.divide(pull, size, out=ratio, where=size > 0.0)
    return np.where(pull <= 0.0, 1.0, np.exp(-0.5 * ratio**2))


@dataclass(frozen=True, slots=True, kw_only=True)
class Extreme:
    """The largest of a response's peaks over a duration.

    Parameters
    ----------
    sigma
        Standard deviation of the response.
    cycles
        Its zero up-crossings in the duration.

    Raises
    ------
    InvalidInput
        There are fewer cycles than the asymptotic law holds for, or sigma is negative.

    Notes
    -----
    Independent Rayleigh peaks, of which the largest of N has the chance ``exp(-N exp(-x^2/(2 sigma^2)))`` to stay
    below x: a Gumbel law about the most probable value with the scale ``sigma/sqrt(2 ln N)``.
    """

    sigma: float
    cycles: float

    def __post_init__(self) -> None:
        _checked("sigma", self.sigma)
        if not FEWEST_CYCLES <= self.cycles < np.inf:
            raise InvalidInput(
                f"The extreme of a response is told of at least {FEWEST_CYCLES:g} cycles, but the duration holds "
                f"{self.cycles:.3g}; take a longer one."
            )

    @classmethod
    def over(cls, duration: float, *, sigma: float, rate: float) -> "Extreme":
        """The extreme over a duration [s] of a response and its rate of change, both as standard deviations.

        Raises
        ------
        InvalidInput
            The duration is not above zero or too short, or the response stands still.
        """
        if not 0.0 < duration < np.inf:
            raise InvalidInput(f"The duration of an extreme must be above 0 s, but it is {duration:g} s.")
        period = float(zero_crossing_period(sigma, rate))
        if not np.isfinite(period):
            raise InvalidInput("A response that stands still has no extreme; give it a sea that moves it.")
        return cls(sigma=sigma, cycles=duration / period)

    @property
    def most_probable(self) -> float:
        """``sigma sqrt(2 ln N)``: the peak that one in N exceeds."""
        return float(self.sigma * np.sqrt(2.0 * np.log(self.cycles)))

    @property
    def expected(self) -> float:
        """``sigma (sqrt(2 ln N) + 0.5772/sqrt(2 ln N))``: the mean of the Gumbel law."""
        return float(self.most_probable + np.euler_gamma * self.sigma / np.sqrt(2.0 * np.log(self.cycles)))

    def exceeded_with(self, chance: float) -> float:
        """The value that the largest peak exceeds with the given chance in the duration.

        Raises
        ------
        InvalidInput
            The chance is not between 0 and 1, or so near to 1 that there may be no peak above zero.
        """
        if not 0.0 < chance < 1.0 or -np.log1p(-chance) >= self.cycles:
            raise InvalidInput(f"A chance above 0 and below 1 is needed, but it is {chance:g}.")
        return float(self.sigma * np.sqrt(2.0 * np.log(self.cycles / -np.log1p(-chance))))

    def chance_above(self, level: float) -> float:
        """Chance that some peak in the duration exceeds a level, ``1 - exp(-N exp(-x^2/(2 sigma^2)))``."""
        return float(-np.expm1(-self.cycles * slack_probability(level, self.sigma)))


def _checked(name: str, value: ArrayLike) -> Floats:
    """A standard deviation as an array, at least zero and finite."""
    values = np.asarray(value, dtype=float)
    if not np.all((values >= 0.0) & (values < np.inf)):
        raise InvalidInput(f"The standard deviation {name} must be finite and at least 0, but it is {values}.")
    return values


def _at_least_one(n: float) -> float:
    if not 1.0 <= n < np.inf:
        raise InvalidInput(f"The statistics of one in n need n of at least 1, but it is {n:g}.")
    return n
