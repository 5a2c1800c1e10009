"""A compensator's strategies in a random sea: the rows of H Table IV, sweeps, and the damping that fills the stroke."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from data_synth.rao import Rao
from data_synth.spectra import Spectrum
from ident.configuration import Configuration
from models.compensator import Setting
from models.response_statistics import exceeded_by_one_in, significant, slack_probability, zero_crossing_period
from models.transfer_matrix import Compensator, SeaResponse, sea_response

#: Of a strategy's sweep: how many values, and up to which factor above the tuned one.
_SWEPT, _ABOVE = 9, 10.0
#: The damping that fills the stroke is sought up to this factor above the tuned one, to this share of the stroke.
_SOUGHT, _FILLED = 100.0, 1e-4
#: A motion below this share of that of the cable's top is rounding.
_ROUNDING = 1e-9
LOCKED = Setting(stiffness=math.inf, damping=math.inf)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Seaway:
    """The sea and the vessel of a study.

    Parameters
    ----------
    configuration
        The tow and the compensator's mass.
    height
        Significant height of the waves [m].
    spectrum, rao
        The waves, and the vessel's motion for a metre of them; its heave acts along the cable.
    segments
        Of the cable; None leaves them to the method.
    """

    configuration: Configuration
    height: float
    spectrum: Spectrum
    rao: Rao
    segments: int | None = None

    @property
    def heave_density(self) -> np.ndarray:
        """(k,) spectrum of the vessel's heave [m2 s/rad]."""
        return np.asarray(self.spectrum.density * np.abs(self.rao.motion(self.spectrum.omega)[:, 1]) ** 2)

    @property
    def sigma(self) -> float:
        """Standard deviation of the vessel's heave [m]."""
        return math.sqrt(float(np.sum(self.spectrum.weights * self.heave_density)))

    @property
    def peak(self) -> float:
        """Frequency at which the vessel heaves most [rad/s]."""
        return float(self.spectrum.omega[self.heave_density.argmax()])

    def response(self, setting: Setting, *, companion: bool = True) -> SeaResponse:
        """The tow with the compensator at a setting; an infinite stiffness or damping locks it."""
        locked = math.isinf(setting.stiffness) or math.isinf(setting.damping)
        device = Compensator(
            mass=self.configuration.compensator.mass,
            stiffness=0.0 if locked else setting.stiffness,
            damping=0.0 if locked else setting.damping,
        )
        return sea_response(
            self.configuration.tow,
            self.spectrum.omega,
            self.spectrum.density,
            motion=self.rao.motion(self.spectrum.omega),
            segments=self.segments,
            compensator=None if locked else device,
            companion=companion,
        )


def table_row(sea: Seaway, made: SeaResponse) -> dict[str, float]:
    """The quantities of H Table IV: significant heights, heights and tensions that one in a thousand exceeds."""
    sigma = {name: size if size > _ROUNDING * made.sigma["top"] else 0.0 for name, size in made.sigma.items()}
    third = {name: float(significant(size)) for name, size in sigma.items()}
    thousandth = {name: float(exceeded_by_one_in(size, 1000.0)) for name, size in sigma.items()}
    tension = made.response.shape.T
    return {
        "H_third_m": sea.height,
        "D_third_m": float(significant(sea.sigma)),
        "p_n_third_m": third["top"],
        "R_third_m": third["relative"],
        "Q_third_m": third["heave"],
        "R_thousandth_m": thousandth["relative"],
        "T_1_thousandth_N": 0.5 * thousandth["tension_bottom"],
        "T_1_N": float(tension[0]),
        "T_n_thousandth_N": 0.5 * thousandth["tension_top"],
        "T_n_N": float(tension[-1]),
    }


def details_row(made: SeaResponse) -> dict[str, float]:
    """What else there is to say of a strategy: periods, slack at the ends, and how well the drag has converged."""
    tension, sigma = made.response.shape.T, made.sigma_tension
    moves = {name: made.sigma[name] for name in ("heave", "tension_bottom", "tension_top") if made.sigma[name] > 0.0}
    return {
        "heave_crossing_s": float(zero_crossing_period(made.sigma["heave"], made.rate["heave"])),
        "slack_probability_bottom": float(slack_probability(tension[0], sigma[0])),
        "slack_probability_top": float(slack_probability(tension[-1], sigma[-1])),
        "slack_probability_worst": float(slack_probability(tension, sigma).max()),
        "iterations": float(made.iterations),
        "change": made.change,
        "mesh_error_share": max(
            (made.error[name] / size for name, size in moves.items() if name in made.error), default=math.nan
        ),
    }


def spectra_table(sea: Seaway, runs: Iterable[tuple[str, SeaResponse]]) -> pd.DataFrame:
    """Spectra of waves, vessel and of each strategy's cable top, compensator, body and top tension."""
    columns = {
        "omega_rad_s": sea.spectrum.omega,
        "wave_m2_s": sea.spectrum.density,
        "vessel_m2_s": sea.heave_density,
    }
    for name, made in runs:
        for quantity, ending in (
            ("top", "top_m2_s"),
            ("relative", "relative_m2_s"),
            ("heave", "heave_m2_s"),
            ("tension_top", "tension_top_N2_s"),
        ):
            columns[f"{name}_{ending}"] = made.density * np.abs(made.amplitudes(quantity)) ** 2
    return pd.DataFrame(columns)


def filling_damping(sea: Seaway, setting: Setting, stroke: float) -> float:
    """The damping [N s/m] at which one relative height in a thousand fills the stroke in this sea, and not sooner.

    The stiffness is that of `setting`, whose damping the search starts from; NaN where no damping up to 100 times as
    large does, or the least that was tried keeps inside.
    """
    from scipy.optimize import brentq

    def excess(logarithm: float) -> float:
        made = sea.response(Setting(stiffness=setting.stiffness, damping=math.exp(logarithm)), companion=False)
        return float(exceeded_by_one_in(made.sigma["relative"], 1000.0)) / stroke - 1.0

    low, high = math.log(setting.damping / _SOUGHT), math.log(setting.damping * _SOUGHT)
    middle, at = math.log(setting.damping), excess(math.log(setting.damping))
    low, high = (middle, high) if at > 0.0 else (low, middle)
    if excess(low) < 0.0 or excess(high) > 0.0:
        return math.nan
    return math.exp(float(brentq(excess, low, high, xtol=_FILLED)))


def sweep(sea: Seaway, softest: Setting, tuned: Setting, swept: str) -> list[dict[str, object]]:
    """Rows of H Table IV over damping or stiffness, from the softest to above the tuned setting."""
    low, high = getattr(softest, swept), _ABOVE * getattr(tuned, swept)
    rows: list[dict[str, object]] = []
    for value in np.geomspace(low, high, _SWEPT).tolist():
        own = {"stiffness": softest.stiffness, "damping": softest.damping} | {swept: value}
        made = sea.response(Setting(**own), companion=False)
        rows.append({"swept": swept, "value": value, **table_row(sea, made)})
    return rows
