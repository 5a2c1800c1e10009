"""A vessel's response amplitude operator (RAO): how the cable's top moves a metre of wave.

Per metre of a wave ``cos(omega t)`` at the vessel, heave is ``heave cos(omega t + heave_phase)``, and surge likewise,
up and forward being positive.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from data_synth.records.text import read_columns, read_text
from data_synth.spectra import Spectrum
from models.quantity import InvalidInput
from models.trace import Floats

#: Part of a sea's variance that may lie outside a table, where the vessel is taken not to move.
OUTSIDE = 1e-3
_REQUIRED = ("omega_rad_s", "heave_m_m")
#: Phases beyond two turns are taken for degrees [rad].
_MOST_PHASE = 4.0 * np.pi
_OPTIONAL = ("heave_phase_rad", "surge_m_m", "surge_phase_rad")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rao:
    """Motion of a vessel at the cable's top, a metre of wave.

    Parameters
    ----------
    omega
        (n,) [rad/s], increasing, above 0, n at least 2.
    heave, surge
        (n,) amplitudes [m/m], at least 0; surge is one for all frequencies or left out, for none.
    heave_phase, surge_phase
        (n,) [rad] ahead of the wave, or one for all; zero when left out.

    Raises
    ------
    InvalidInput
        One of these does not hold; says the first place.
    """

    omega: Floats
    heave: Floats
    heave_phase: Floats = field(default_factory=lambda: np.zeros(1))
    surge: Floats = field(default_factory=lambda: np.zeros(1))
    surge_phase: Floats = field(default_factory=lambda: np.zeros(1))

    def __post_init__(self) -> None:
        omega = np.array(self.omega, dtype=float)
        if omega.ndim != 1 or omega.size < 2:
            raise InvalidInput(f"An RAO needs at least 2 frequencies, but omega has the shape {omega.shape}.")
        for name in ("omega", "heave", "heave_phase", "surge", "surge_phase"):
            values = np.array(getattr(self, name), dtype=float)
            if values.shape == (1,) and name not in ("omega", "heave"):
                values = np.resize(values, omega.shape)
            if values.shape != omega.shape:
                raise InvalidInput(
                    f"An RAO needs one {name} for each of its {omega.size} frequencies, but has {values.size}."
                )
            bad = ~np.isfinite(values) if name.endswith("phase") else ~(np.isfinite(values) & (values >= 0.0))
            if np.any(bad):
                i = int(np.argmax(bad))
                raise InvalidInput(
                    f"An RAO needs finite values, amplitudes from 0 on, but {name}[{i}] is {values[i]:g}."
                )
            if name.endswith("phase") and np.any(np.abs(values) > _MOST_PHASE):
                i = int(np.argmax(np.abs(values) > _MOST_PHASE))
                raise InvalidInput(
                    f"An RAO needs phases in radians, at most two turns, but {name}[{i}] is {values[i]:g}; degrees "
                    "times pi/180 are radians."
                )
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        if omega[0] <= 0.0:
            raise InvalidInput(f"An RAO needs frequencies above zero, but the first is {omega[0]:g} rad/s.")
        if np.any(np.diff(omega) <= 0.0):
            i = int(np.argmax(np.diff(omega) <= 0.0))
            raise InvalidInput(
                f"An RAO needs increasing frequencies, but omega[{i}] = {omega[i]:g} rad/s and "
                f"omega[{i + 1}] = {omega[i + 1]:g} rad/s."
            )
        if not (np.any(self.heave) or np.any(self.surge)):
            raise InvalidInput("The vessel of this RAO never moves: all amplitudes are zero.")

    @property
    def surges(self) -> bool:
        """Whether the vessel has any surge."""
        return bool(np.any(self.surge))

    def motion(self, omega: ArrayLike) -> NDArray[np.complex128]:
        """(k, 2) horizontal and vertical motion [m/m] at frequencies (k,) [rad/s].

        Amplitude and phase are linear between the table's frequencies, a phase taking the shorter way round; outside
        the table the vessel does not move, see `check`.
        """
        om = np.atleast_1d(np.asarray(omega, dtype=float))
        found = np.zeros((om.size, 2), dtype=complex)
        for column, (size, phase) in enumerate(((self.surge, self.surge_phase), (self.heave, self.heave_phase))):
            amplitude = np.interp(om, self.omega, size, left=0.0, right=0.0)
            found[:, column] = amplitude * np.exp(1j * np.interp(om, self.omega, np.unwrap(phase)))
        return found

    def check(self, spectrum: Spectrum) -> None:
        """Refuse a sea of which the table leaves out more than `OUTSIDE`.

        Raises
        ------
        InvalidInput
            Too much of the spectrum's variance lies outside the table.
        """
        outside = 1.0 - spectrum.share(self.omega[0], self.omega[-1])
        if outside > OUTSIDE:
            raise InvalidInput(
                f"The RAO goes from {self.omega[0]:g} to {self.omega[-1]:g} rad/s, but {100.0 * outside:.2g} % of the "
                f"sea's variance lies outside (its peak is at {spectrum.peak:.3g} rad/s); carry the table on until at "
                f"most {100.0 * OUTSIDE:g} % does."
            )


def read_rao(path: str | Path) -> Rao:
    """Read an RAO from a table with the columns ``omega_rad_s, heave_m_m`` and, where they are known,
    ``heave_phase_rad, surge_m_m, surge_phase_rad``; lines that begin with ``#`` are comments.

    Raises
    ------
    InvalidInput
        The file cannot be read or is no such table; says file and line or place.
    """
    path = Path(path)
    columns = read_columns(path, read_text(path), _REQUIRED, _OPTIONAL)
    if "surge_phase_rad" in columns and "surge_m_m" not in columns:
        raise InvalidInput(f"{path}: a phase of surge is given, but no surge; add the column surge_m_m.")
    try:
        return Rao(
            **{
                name.removesuffix("_m_m").removesuffix("_rad").replace("omega_rad_s", "omega"): values
                for name, values in columns.items()
            }
        )
    except InvalidInput as error:
        raise InvalidInput(f"{path}: {error}") from None
