"""Tuning of a configuration's heave compensator by the linear analysis at one frequency (H IV-B), and its maps."""

import math

import numpy as np
import pandas as pd

from ident.configuration import Configuration
from ident.printed_compensators import TABLE_THREE, TableThree
from models.compensator import Setting, Tuning, dynamic_stiffness, relative_limit, tune
from models.response_statistics import significant
from models.transfer_matrix import frequency_response
from models.transfer_matrix.axial import AxialResponse, AxialString, axial_response, compensated_response
from reports.figures.compensators import MAPPED, ResponseMap

#: Values to a decade of a map, and how far it goes beyond the cable's own stiffness, as a factor.
_TO_A_DECADE, _BEYOND = 12, 20.0
#: Frequencies among which the peak of a printed sea is inferred [rad/s].
_SEARCHED = np.arange(0.40, 0.8001, 0.001)


def axial_at(configuration: Configuration, omega: float, sigma: float) -> AxialResponse:
    """The response at one frequency, its drag linearised at half the significant height times it.

    The closed form for one uniform cable that hangs straight; the matrix solve for a cable of sections.

    Parameters
    ----------
    omega
        [rad/s]
    sigma
        Standard deviation of the vessel's motion along the cable [m].

    Notes
    -----
    H writes the velocity as D_1/3 omega_0; with the height in place of the amplitude its Table III does not come out,
    with half of it, it does.
    """
    amplitude = 0.5 * float(significant(sigma))
    if configuration.tow.sections:
        found = frequency_response(configuration.tow, [omega], amplitude=amplitude)
        return AxialResponse(
            omega=found.omega,
            bottom=found.axial[:, 0] / found.top,
            tension_bottom=found.tension_bottom / found.top,
            tension_top=found.tension_top / found.top,
        )
    velocity = amplitude * omega
    return axial_response(AxialString.from_tow(configuration.tow, velocity), omega)


def tuned(configuration: Configuration, omega: float, sigma: float, stroke: float) -> Tuning:
    """The tuning at one frequency for one relative height in a thousand above the stroke [m]."""
    device = configuration.compensator
    response = axial_at(configuration, omega, sigma)
    return tune(
        complex(dynamic_stiffness(response.tension_top, omega, device.mass)[0]),
        omega,
        relative_limit(stroke, sigma),
        least_stiffness=device.least_stiffness,
        least_damping=device.least_damping,
    )


def response_map(configuration: Configuration, tuning: Tuning, sigma: float) -> ResponseMap:
    """Amplitudes over stiffness and damping at the frequency of the tuning, both tuned settings marked."""
    device, response = configuration.compensator, axial_at(configuration, tuning.omega, sigma)
    size = abs(tuning.c)
    stiffness = _decades(min(device.least_stiffness, 0.01 * size), _BEYOND * size)
    damping = _decades(min(device.least_damping, 0.01 * size / tuning.omega), _BEYOND * size / tuning.omega)
    made = compensated_response(response, device.mass, stiffness[:, None, None], damping[:, None])
    locked = {name: float(np.abs(getattr(response, name))[0]) for name in MAPPED if name != "relative"}
    return ResponseMap(
        stiffness=stiffness,
        damping=damping,
        amplitudes={name: np.abs(getattr(made, name)[..., 0]) for name in MAPPED},
        locked=locked | {"relative": 0.0},
        limit=tuning.limit,
        critical=tuning.critical,
        marks={
            name: (setting.stiffness, setting.damping)
            for name, setting in (("tuned stiffness", tuning.by_stiffness), ("tuned damping", tuning.by_damping))
        },
    )


def map_table(shown: ResponseMap) -> pd.DataFrame:
    """The map as rows: ``stiffness_N_m, damping_N_s_m, p_1, R, T_1_N_m, T_n_N_m``, all for a metre of the vessel."""
    k, b = np.meshgrid(shown.stiffness, shown.damping, indexing="ij")
    columns = {"bottom": "p_1", "relative": "R", "tension_bottom": "T_1_N_m", "tension_top": "T_n_N_m"}
    values = {columns[name]: shown.amplitudes[name].ravel() for name in columns}
    return pd.DataFrame({"stiffness_N_m": k.ravel(), "damping_N_s_m": b.ravel(), **values})


def of_table_three(tuning: Tuning) -> TableThree:
    """The three numbers of a column of H Table III."""
    return TableThree(tuning.by_damping.damping, tuning.by_stiffness.stiffness, tuning.critical)


def inferred(configuration: Configuration, sea_state: int, sigma: float, stroke: float) -> Tuning:
    """The tuning at the frequency at which Table III comes out best: where its largest deviation is least."""
    found = [tuned(configuration, float(omega), sigma, stroke) for omega in _SEARCHED]
    printed = np.log(TABLE_THREE[sea_state])
    return min(found, key=lambda tuning: float(np.abs(np.log(of_table_three(tuning)) - printed).max()))


def settings_table(tuning: Tuning) -> pd.DataFrame:
    """What the linear analysis expects of each setting: ``setting, stiffness_N_m, damping_N_s_m, relative, top``."""
    settings = {
        "locked": Setting(stiffness=math.inf, damping=math.inf),
        "softest": tuning.softest,
        "tuned-stiffness": tuning.by_stiffness,
        "tuned-damping": tuning.by_damping,
    }
    rows = [
        (name, setting.stiffness, setting.damping, tuning.relative(setting), tuning.top(setting))
        for name, setting in settings.items()
    ]
    return pd.DataFrame(rows, columns=["setting", "stiffness_N_m", "damping_N_s_m", "relative", "top"])


def _decades(low: float, high: float) -> np.ndarray:
    """Whole decades about two values, `_TO_A_DECADE` values to each."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    return np.logspace(first, last, _TO_A_DECADE * (last - first) + 1)
