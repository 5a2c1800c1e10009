"""The tables of a sea study: statistics, spectra, extremes and slack, made from what the matrix method gives."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from data_synth.rao import Rao
from models import response_statistics as statistics
from models.response_statistics import Extreme
from models.transfer_matrix import SeaResponse

Floats = NDArray[np.float64]

COLUMNS = (
    "quantity",
    "unit",
    "sigma",
    "significant",
    "one_in_10",
    "one_in_1000",
    "zero_crossing_s",
    "static",
    "slack_probability",
)
#: Chance with which a design value of the extremes is exceeded.
CHANCE = 0.01
#: Durations that the extreme tension is followed over [s].
DURATIONS = tuple(np.geomspace(600.0, 86400.0, 25).tolist())
_UNITS = {"top": "m", "surge": "m", "heave": "m", "pitch": "rad", "tension_bottom": "N", "tension_top": "N"}
_TENSIONS = ("tension_bottom", "tension_top")
#: A response below this share of the motion of the cable's top is rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Row:
    """A quantity with its spectrum (k,) and, of the towed system's, the estimated error of its mesh [-]."""

    name: str
    unit: str
    omega: Floats
    density: Floats
    static: float = np.nan
    mesh_error: float = np.nan

    @property
    def tension(self) -> bool:
        """Whether it is counted in amplitudes, as H does tensions, and not in heights."""
        return self.name in _TENSIONS

    @property
    def sigma(self) -> float:
        """Standard deviation."""
        return float(np.sqrt(np.trapezoid(self.density, self.omega)))

    @property
    def rate(self) -> float:
        """Standard deviation of the time derivative."""
        return float(np.sqrt(np.trapezoid(self.omega**2 * self.density, self.omega)))

    @property
    def tail(self) -> float:
        """Part of the variance in the last tenth of the frequencies, of the size of what lies beyond their end."""
        if self.sigma == 0.0:
            return 0.0
        last = self.omega >= 0.9 * self.omega[-1]
        return float(np.trapezoid(self.density[last], self.omega[last])) / self.sigma**2

    @property
    def frequency_error(self) -> float:
        """Estimated error of the sum over frequencies as a share of sigma, from leaving out every second one."""
        if self.sigma == 0.0:
            return 0.0
        coarse = float(np.sqrt(np.trapezoid(self.density[::2], self.omega[::2])))
        return abs(coarse / self.sigma - 1.0) / 3.0


def rows(sea: SeaResponse, rao: Rao | None, *, pitching: bool) -> list[Row]:
    """The wave, the vessel where there is one, the cable's top, the vehicle and the tensions, in this order."""
    omega, density, shape = sea.omega, sea.density, sea.response.shape
    found = [Row(name="wave", unit="m", omega=omega, density=density)]
    if rao is not None:
        motion = np.abs(rao.motion(omega)) ** 2 * density[:, None]
        found.append(Row(name="vessel_heave", unit="m", omega=omega, density=motion[:, 1]))
        if rao.surges:
            found.append(Row(name="vessel_surge", unit="m", omega=omega, density=motion[:, 0]))
    statics = {"pitch": shape.pitch, "tension_bottom": float(shape.T[0]), "tension_top": float(shape.T[-1])}
    for name, unit in _UNITS.items():
        if name == "pitch" and not pitching:
            continue
        response = np.abs(sea.amplitudes(name)) ** 2 * density
        still = unit != "N" and sea.sigma[name] <= _ROUNDING * sea.sigma["top"]
        found.append(
            Row(
                name=name,
                unit=unit,
                omega=omega,
                density=np.zeros(omega.size) if still else response,
                static=statics.get(name, np.nan),
                mesh_error=0.0 if still else sea.shares.get(name, np.nan),
            )
        )
    return found


def sea_table(found: Sequence[Row]) -> pd.DataFrame:
    """One row a quantity: `COLUMNS`, what is ``counted``, the two errors and the tail in percent."""
    lines: list[dict[str, object]] = []
    for row in found:
        share = 0.5 if row.tension else 1.0
        slack = float(statistics.slack_probability(row.static, row.sigma)) if row.tension else np.nan
        lines.append(
            {
                "quantity": row.name,
                "unit": row.unit,
                "sigma": row.sigma,
                "significant": share * float(statistics.significant(row.sigma)),
                "one_in_10": share * float(statistics.highest_average(row.sigma, 10.0)),
                "one_in_1000": share * float(statistics.exceeded_by_one_in(row.sigma, 1000.0)),
                "zero_crossing_s": float(statistics.zero_crossing_period(row.sigma, row.rate)),
                "static": row.static,
                "slack_probability": slack,
                "counted": "amplitude" if row.tension else "height",
                "mesh_error_percent": 100.0 * row.mesh_error,
                "frequency_error_percent": 100.0 * row.frequency_error,
                "tail_percent": 100.0 * row.tail,
            }
        )
    return pd.DataFrame(lines)


def spectra_table(found: Sequence[Row]) -> pd.DataFrame:
    """Spectral densities over frequency, a column a quantity."""
    columns: dict[str, Floats] = {"omega_rad_s": found[0].omega}
    for row in found:
        unit = "m2_s" if row.unit == "m" else f"{row.unit}2_s"
        columns[f"{row.name}_{unit}"] = row.density
    return pd.DataFrame(columns)


def extremes_table(found: Sequence[Row], duration: float) -> pd.DataFrame:
    """The largest amplitude of every quantity that moves in a duration [s], alone and about the static value.

    Raises
    ------
    InvalidInput
        The duration is not above zero or holds too few cycles.
    """
    lines: list[dict[str, object]] = []
    for row in found:
        if row.sigma == 0.0:
            continue
        extreme = Extreme.over(duration, sigma=row.sigma, rate=row.rate)
        lines.append(
            {
                "quantity": row.name,
                "unit": row.unit,
                "duration_s": duration,
                "cycles": extreme.cycles,
                "most_probable": extreme.most_probable,
                "expected": extreme.expected,
                "one_in_100": extreme.exceeded_with(CHANCE),
                "static": row.static,
                "largest": row.static + extreme.expected,
                "least": row.static - extreme.expected,
                "slack_in_duration": extreme.chance_above(row.static) if row.tension else np.nan,
            }
        )
    return pd.DataFrame(lines)


def durations_table(found: Sequence[Row]) -> pd.DataFrame:
    """Extreme dynamic tension over the `DURATIONS` that hold enough cycles."""
    lines = []
    for row in found:
        if not row.tension:
            continue
        period = float(statistics.zero_crossing_period(row.sigma, row.rate))
        for duration in DURATIONS:
            if duration < statistics.FEWEST_CYCLES * period:
                continue
            extreme = Extreme.over(duration, sigma=row.sigma, rate=row.rate)
            lines.append(
                {
                    "quantity": row.name,
                    "duration_s": duration,
                    "most_probable_N": extreme.most_probable,
                    "expected_N": extreme.expected,
                    "one_in_100_N": extreme.exceeded_with(CHANCE),
                    "static_N": row.static,
                }
            )
    return pd.DataFrame(lines)


def cable_table(sea: SeaResponse) -> pd.DataFrame:
    """Static and dynamic tension along the cable, and the chance of slack a cycle, from the vehicle up."""
    shape, sigma = sea.response.shape, sea.sigma_tension
    columns: Mapping[str, Floats] = {
        "s_m": shape.s,
        "static_N": shape.T,
        "sigma_N": sigma,
        "one_in_1000_N": 0.5 * statistics.exceeded_by_one_in(sigma, 1000.0),
        "slack_probability": statistics.slack_probability(shape.T, sigma),
    }
    return pd.DataFrame(columns)
