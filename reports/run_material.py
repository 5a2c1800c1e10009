"""Everything that the page of a run shows, as plain tables and arrays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from reports.figures.residuals import ResidualCurves
from reports.files import PARAMETER_COLUMNS, SCORE_COLUMNS
from reports.series import Floats, RecordSeries, require_columns


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RunMaterial:
    """Everything that the page of a run shows; what is left empty is left out of the page.

    Parameters
    ----------
    title
        Heading of the page, such as the configuration's name.
    description
        The system in a sentence or two.
    configuration
        Columns part, setting, value, unit, guess (flag), and note where there is one; a row a setting.
    configuration_text
        The TOML text as used.
    left_out
        (term, why) of each effect that the scene does without.
    unused
        (setting, why) of each setting that the scene does not use.
    needless
        (setting, why) of each setting that makes no measurable difference.
    input_note
        How the ship's motion for the identification was made, with its seed.
    step_note
        What the steps of the reduced models err by, in a sentence.
    truth_note
        What stands for the truth at verification, said plainly.
    records
        The identification record first, then those of the verification.
    scores
        As scores.csv (`reports.files.SCORE_COLUMNS`).
    parameters
        As parameters.csv (`reports.files.PARAMETER_COLUMNS`).
    ends
        Columns model, outcome, reason: why each search stopped.
    thesis
        Columns model, record, rms_velocity_m_s, rms_position_m as printed in T tables 6-I and 6-II, records named
        as in `scores`; NaN where nothing is printed.
    floors
        Columns record, rms_velocity_m_s, rms_position_m: what the sensors and the differentiator make of a motion
        known exactly.
    drag_over_spring
        Columns model, predicted, identified, thesis_predicted, thesis_identified: b/k of T 6.7 [s2/m].
    total_drag
        Columns model, cable, vehicle, total, mapped_total, low, high [N s2/m2]: drag of the whole system, cable
        nodes and vehicle; low and high bound the total.
    histories
        Model to (k,) RMS velocity error [m/s] of each simulation of its search.
    starts
        Columns model, start, rms_velocity_m_s, outcome: one row a start point, where there were several.
    correlations
        Model to a square table of the estimates' correlations, symbols as index and columns.
    twins
        (model, sentence) of each model with other parameters and the same response.
    bode_points
        Columns amplitude_m, omega_rad_s, gain_db, phase_deg of the reference simulator.
    bode_curves
        Columns model, amplitude_m, omega_rad_s, gain_db, phase_deg of the reduced models; NaN amplitude_m where the
        response does not depend on it.
    bode_note
        What the curves were linearised about.
    static_shape
        (x (n,) [m], z (n,) [m]), or nothing.
    snapshots
        (time [s], x (k,) [m], z (k,) [m]) of the cable in motion.
    snapshots_note
        What the snapshots show, in a sentence.
    combinations
        (model, sentence) of the combinations of parameters that a record determines better than each alone.
    residual_tests
        Correlations of the residuals, for the models worth showing.
    residual_numbers
        Columns model, record, memory_s, cross_peak, cross_lag_s, cross_band, cross_outside: the largest correlation
        of the residuals with the ship's velocity, where it lies, its 95 % band, and the share of lags outside it.
    manifest
        Versions, seeds and machine, nested where that helps.

    Raises
    ------
    InvalidInput
        A table lacks a column.
    """

    title: str
    configuration: pd.DataFrame
    records: Sequence[RecordSeries]
    scores: pd.DataFrame
    parameters: pd.DataFrame
    ends: pd.DataFrame
    description: str = ""
    configuration_text: str = ""
    left_out: Sequence[tuple[str, str]] = ()
    unused: Sequence[tuple[str, str]] = ()
    needless: Sequence[tuple[str, str]] = ()
    input_note: str = ""
    truth_note: str = ""
    step_note: str = ""
    thesis: pd.DataFrame = field(default_factory=pd.DataFrame)
    floors: pd.DataFrame = field(default_factory=pd.DataFrame)
    drag_over_spring: pd.DataFrame = field(default_factory=pd.DataFrame)
    total_drag: pd.DataFrame = field(default_factory=pd.DataFrame)
    histories: Mapping[str, Floats] = field(default_factory=dict)
    starts: pd.DataFrame = field(default_factory=pd.DataFrame)
    correlations: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    twins: Sequence[tuple[str, str]] = ()
    bode_points: pd.DataFrame = field(default_factory=pd.DataFrame)
    bode_curves: pd.DataFrame = field(default_factory=pd.DataFrame)
    bode_note: str = ""
    static_shape: tuple[Floats, Floats] | None = None
    snapshots: Sequence[tuple[float, Floats, Floats]] = ()
    snapshots_note: str = ""
    combinations: Sequence[tuple[str, str]] = ()
    residual_tests: Sequence[ResidualCurves] = ()
    residual_numbers: pd.DataFrame = field(default_factory=pd.DataFrame)
    manifest: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        response = ("amplitude_m", "omega_rad_s", "gain_db", "phase_deg")
        for what, table, columns in (
            ("RunMaterial.configuration", self.configuration, ("setting", "value", "unit")),
            ("RunMaterial.scores", self.scores, SCORE_COLUMNS),
            ("RunMaterial.parameters", self.parameters, PARAMETER_COLUMNS),
            ("RunMaterial.ends", self.ends, ("model", "outcome", "reason")),
            ("RunMaterial.thesis", self.thesis, ("model", "record", "rms_velocity_m_s")),
            ("RunMaterial.floors", self.floors, ("record", "rms_velocity_m_s", "rms_position_m")),
            ("RunMaterial.drag_over_spring", self.drag_over_spring, ("model", "predicted", "identified")),
            ("RunMaterial.total_drag", self.total_drag, ("model", "total", "mapped_total")),
            ("RunMaterial.starts", self.starts, ("model", "start", "rms_velocity_m_s")),
            ("RunMaterial.residual_numbers", self.residual_numbers, ("model", "memory_s", "cross_peak", "cross_band")),
            ("RunMaterial.bode_points", self.bode_points, response),
            ("RunMaterial.bode_curves", self.bode_curves, ("model", *response)),
        ):
            require_columns(table, columns, what)
