"""The tables of a response study, made from what the matrix method gives."""

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ident.response_peaks import Peak, decibels, peaks
from models.statics import StaticShape
from models.transfer_matrix import Response

#: Quantity to its unit, in the order of the tables; tensions have no decibels.
UNITS = {"surge": "m", "heave": "m", "pitch": "rad", "tension_bottom": "N", "tension_top": "N"}
PEAK_COLUMNS = ("quantity", "omega_rad_s", "level", "unit", "level_db", "prominence_db")
#: Amplitudes below this share of the input are rounding, not a response.
_ROUNDING = 1e-9


def top_motion(response: Response) -> float:
    """Amplitude of the motion of the cable's top [m], the same at every frequency."""
    return float(np.max(response.amplitude))


def statics_table(shape: StaticShape) -> pd.DataFrame:
    """The static shape from the vehicle up; x and z counted from the cable's top."""
    columns = {"s_m": shape.s, "x_m": shape.x, "z_m": shape.z, "tension_N": shape.T, "angle_rad": shape.phi}
    return pd.DataFrame(columns)


def response_table(response: Response) -> pd.DataFrame:
    """Amplitudes of the main quantities, one row a frequency."""
    columns = {"omega_rad_s": response.omega}
    columns |= {f"{name}_{unit}": np.abs(getattr(response, name)) for name, unit in UNITS.items()}
    return pd.DataFrame({**columns, "iterations": response.iterations})


def details_table(response: Response) -> pd.DataFrame:
    """All that there is at each frequency: decibels, phases behind the input, slack, convergence, errors."""
    table = response_table(response)
    for name in ("surge", "heave", "pitch"):
        table[f"{name}_db"] = level_db(response, name)
    for name in UNITS:
        table[f"{name}_phase_rad"] = np.angle(getattr(response, name))
    for name in ("horizontal", "vertical"):
        table[f"{name}_m"] = np.abs(getattr(response, name))
        table[f"{name}_phase_rad"] = np.angle(getattr(response, name))
    table["top_m"] = np.abs(response.top)
    ratio = slack_ratio(response)
    nearest = ratio.argmax(axis=1)
    table["static_tension_bottom_N"], table["static_tension_top_N"] = response.shape.T[0], response.shape.T[-1]
    table["slack_ratio"] = ratio.max(axis=1)
    table["slack_s_m"] = response.shape.s[nearest]
    table["change"], table["converged"] = response.change, response.converged
    table["digits"] = response.digits
    for name, unit in UNITS.items():
        if name in response.error:
            table[f"{name}_error_{unit}"] = response.error[name]
    return table


def level_db(response: Response, name: str) -> NDArray[np.float64]:
    """A motion over the amplitude of the input [dB; of a pitch over 1 rad/m]; NaN where there is none but rounding."""
    if not answers(response, name):
        return np.full(response.omega.size, np.nan)
    return decibels(getattr(response, name), top_motion(response))


def peaks_table(response: Response) -> pd.DataFrame:
    """Every peak of every quantity, motions in dB of the amplitude of the input."""
    rows: list[tuple[str, float, float, str, float, float]] = []
    for name, unit in UNITS.items():
        for peak in peaks_of(response, name):
            level = float("nan") if unit == "N" else peak.decibels
            rows.append((name, peak.omega, peak.level, unit, level, peak.prominence))
    return pd.DataFrame(rows, columns=list(PEAK_COLUMNS))


def answers(response: Response, name: str) -> bool:
    """Whether a quantity is more than rounding."""
    size = top_motion(response) if UNITS[name] != "N" else float(response.shape.T.max())
    return float(np.abs(getattr(response, name)).max()) > _ROUNDING * size


def peaks_of(response: Response, name: str) -> tuple[Peak, ...]:
    """The peaks of a quantity, in dB over the motion of the top; none of a quantity that is but rounding."""
    if not answers(response, name):
        return ()
    return peaks(response.omega, getattr(response, name), reference=top_motion(response))


def slack_ratio(response: Response) -> NDArray[np.float64]:
    """(k, n + 1) amplitude of the dynamic tension over the static tension: from 1 on the cable goes slack."""
    ratio: NDArray[np.float64] = np.abs(response.tension) / response.shape.T
    return ratio


def bends_table(shape: StaticShape) -> pd.DataFrame:
    """Length of every segment and the angle that the cable turns by along it."""
    return pd.DataFrame(
        {
            "s_m": 0.5 * (shape.s[1:] + shape.s[:-1]),
            "segment_m": np.diff(shape.s),
            "turn_deg": np.degrees(np.abs(np.diff(shape.phi))),
        }
    )
