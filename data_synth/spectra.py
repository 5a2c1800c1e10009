"""A wave spectrum as numbers, its moments, and spectra made from a formula or a sea state.

Densities are one-sided in angular frequency: ``int S d om = sigma^2`` (H's factor 1/2pi dropped), and the height of a
spectrum is ``4 sigma``.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike

from data_synth.seas import bretschneider, jonswap
from models.quantity import InvalidInput, Quantity, check_quantities, positive
from models.trace import Floats

Form = Literal["bretschneider", "jonswap"]
FORMS: tuple[Form, ...] = ("bretschneider", "jonswap")

#: Frequencies of a made or resampled spectrum unless given.
POINTS = 200
#: Fewest that a spectrum can be made of.
FEWEST_POINTS = 8
#: Lowest and highest frequency of a made spectrum over its peak: all but 0.05 % of a Bretschneider sea's variance, and
#: all but 2 % of its second moment, which has a long tail.
BAND = (0.6, 7.5)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Spectrum:
    """A one-sided spectrum of surface elevation.

    Parameters
    ----------
    omega
        (n,) [rad/s], increasing, above 0, n at least 2.
    density
        (n,) [m2 s/rad], none of it negative and not all of it zero.
    width
        (n,) [rad/s] where the densities are averages over bins, as instruments give them; left out, they are
        values at points with straight lines between.

    Raises
    ------
    InvalidInput
        One of these does not hold; says the first place.
    """

    omega: Floats
    density: Floats
    width: Floats | None = None

    def __post_init__(self) -> None:
        omega = np.array(self.omega, dtype=float)
        if omega.ndim != 1 or omega.size < 2:
            raise InvalidInput(f"A spectrum needs at least 2 frequencies, but omega has the shape {omega.shape}.")
        for name in ("omega", "density", "width"):
            if (given := getattr(self, name)) is None:
                continue
            values = np.array(given, dtype=float)
            if values.shape != omega.shape:
                raise InvalidInput(
                    f"A spectrum needs one {name} for each of its {omega.size} frequencies, but has {values.size}."
                )
            if not np.isfinite(values).all():
                i = int(np.argmin(np.isfinite(values)))
                raise InvalidInput(f"A spectrum needs finite numbers, but {name}[{i}] is {values[i]}.")
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        self._check_signs()

    def _check_signs(self) -> None:
        omega, density = self.omega, self.density
        if omega[0] <= 0.0:
            raise InvalidInput(
                f"A spectrum needs frequencies above zero, but its first is {omega[0]:g} rad/s; drop the mean level."
            )
        if np.any(np.diff(omega) <= 0.0):
            i = int(np.argmax(np.diff(omega) <= 0.0))
            raise InvalidInput(
                f"A spectrum needs increasing frequencies, but omega[{i}] = {omega[i]:g} rad/s and "
                f"omega[{i + 1}] = {omega[i + 1]:g} rad/s; sort them and drop the repeats."
            )
        if np.any(density < 0.0):
            i = int(np.argmax(density < 0.0))
            raise InvalidInput(
                f"A spectrum has no negative density, but at {omega[i]:g} rad/s it is {density[i]:g} m2 s/rad; "
                "a fill value must be taken out before."
            )
        if self.width is not None and np.any(self.width <= 0.0):
            i = int(np.argmax(self.width <= 0.0))
            raise InvalidInput(f"The bins of a spectrum need a width above zero, but width[{i}] = {self.width[i]:g}.")
        if not density.any():
            raise InvalidInput(f"The spectrum has no energy: all of its {density.size} densities are zero.")

    @property
    def weights(self) -> Floats:
        """(n,) [rad/s] what the densities count for in an integral: the bins' widths, else the trapezoidal rule's."""
        if self.width is not None:
            return self.width
        half = 0.5 * np.diff(self.omega)
        return np.asarray(np.append(half, 0.0) + np.append(0.0, half), dtype=float)

    def moment(self, n: float) -> float:
        """``int om^n S d om`` [m2 (rad/s)^n]."""
        return float(np.sum(self.weights * self.omega**n * self.density))

    @property
    def sigma(self) -> float:
        """Standard deviation of the surface [m]."""
        return float(np.sqrt(self.moment(0)))

    @property
    def significant_height(self) -> float:
        """``4 sigma`` [m]."""
        return 4.0 * self.sigma

    @property
    def peak(self) -> float:
        """Frequency of the largest density [rad/s]."""
        return float(self.omega[self.density.argmax()])

    @property
    def zero_crossing_period(self) -> float:
        """``2 pi sqrt(m_0/m_2)`` [s]."""
        return float(2.0 * np.pi * np.sqrt(self.moment(0) / self.moment(2)))

    @property
    def energy_period(self) -> float:
        """``2 pi m_-1/m_0`` [s]."""
        return 2.0 * np.pi * self.moment(-1) / self.moment(0)

    def at(self, omega: ArrayLike) -> Floats:
        """Density [m2 s/rad] at other frequencies [rad/s]: linear between, zero outside."""
        at = np.asarray(omega, dtype=float)
        return np.asarray(np.interp(at, self.omega, self.density, left=0.0, right=0.0), dtype=float)

    def share(self, low: float, high: float) -> float:
        """Part of the variance between two frequencies [rad/s], both counted in."""
        inside = (self.omega >= low) & (self.omega <= high)
        return float(np.sum((self.weights * self.density)[inside]) / self.moment(0))

    def resampled(self, points: int = POINTS) -> "Spectrum":
        """The spectrum at so many frequencies of one ratio to the next and at its own, straight lines between them.

        Of bins, the whole is scaled to keep the variance, which their widths count a little differently from lines.

        Raises
        ------
        InvalidInput
            There are too few points.
        """
        omega = np.union1d(_spaced(self.omega[0], self.omega[-1], points), self.omega)
        return _of_variance(Spectrum(omega=omega, density=self.at(omega)), self.moment(0))


@dataclass(frozen=True, slots=True, kw_only=True)
class SeaState:
    """A sea given by its significant height and the period of its peak."""

    height: Annotated[float, positive("H_1/3", "m")]
    peak_period: Annotated[float, positive("T_p", "s")]

    def __post_init__(self) -> None:
        check_quantities(self)

    @property
    def peak(self) -> float:
        """Frequency of the largest density [rad/s]."""
        return 2.0 * np.pi / self.peak_period

    def spectrum(self, form: Form = "bretschneider", *, points: int = POINTS, gamma: float = 3.3) -> Spectrum:
        """The sea's spectrum by a formula; the variance outside its `BAND` is put back by scaling.

        Parameters
        ----------
        form
            One of `FORMS`.
        points
            Frequencies, of one ratio to the next.
        gamma
            Peak enhancement of jonswap.

        Raises
        ------
        InvalidInput
            The form is unknown, or there are too few points.
        """
        if form not in FORMS:
            raise InvalidInput(f"A sea's form must be one of {', '.join(FORMS)}, but it is {form!r}.")
        omega = _spaced(BAND[0] * self.peak, BAND[1] * self.peak, points)
        if form == "jonswap":
            if not _GAMMA.holds(gamma):
                raise InvalidInput(f"The peak enhancement gamma must be {_GAMMA.bound_text}, but it is {gamma:g}.")
            density = jonswap(omega, self.height, self.peak, gamma)
        else:
            density = bretschneider(omega, self.height, self.peak)
        return _of_variance(Spectrum(omega=omega, density=density), self.height**2 / 16.0)


_GAMMA = Quantity("gamma", "1", lower=1.0, upper=20.0)

#: Sea states of H's Table IV. The heights are printed; the peak periods are ours, chosen with the vessel of
#: ``ident/vessels/swath.csv`` so that its heave has the heights that H prints and peaks where its Table III points to.
SEA_STATES: Mapping[int, SeaState] = MappingProxyType(
    {5: SeaState(height=3.23, peak_period=9.7), 6: SeaState(height=4.99, peak_period=11.3)}
)


def sea_state(number: int) -> SeaState:
    """A sea state by its number.

    Raises
    ------
    InvalidInput
        There is none of that number.
    """
    if number not in SEA_STATES:
        raise InvalidInput(
            f"Sea states are known of the numbers {', '.join(map(str, SEA_STATES))}, but {number} was given."
        )
    return SEA_STATES[number]


def total(*spectra: Spectrum, points: int = POINTS) -> Spectrum:
    """The spectrum of independent seas together, at so many frequencies from the lowest to the highest of them."""
    omega = _spaced(min(s.omega[0] for s in spectra), max(s.omega[-1] for s in spectra), points)
    density = np.sum([spectrum.at(omega) for spectrum in spectra], axis=0)
    return _of_variance(Spectrum(omega=omega, density=density), sum(s.moment(0) for s in spectra))


def _spaced(low: float, high: float, points: int) -> Floats:
    if points < FEWEST_POINTS:
        raise InvalidInput(f"A spectrum is made of at least {FEWEST_POINTS} frequencies, but {points} were asked for.")
    return np.geomspace(low, high, points)


def _of_variance(spectrum: Spectrum, variance: float) -> Spectrum:
    return Spectrum(omega=spectrum.omega, density=spectrum.density * (variance / spectrum.moment(0)))
