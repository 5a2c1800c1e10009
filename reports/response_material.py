"""What the page of a response study is made from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from reports.figures.cable_motion import CableMotion, Towed
from reports.series import Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ResponseMaterial:
    """Everything that the page of a response study shows; what is left empty is left out of the page.

    Parameters
    ----------
    title, description
        Heading of the page, and the system in a sentence or two.
    amplitude, direction
        Of the motion of the cable's top [m], and which way it goes, in words.
    statics
        ``s_m, x_m, z_m, tension_N, angle_rad`` from the vehicle up.
    state
        ``quantity, value, unit`` of the static state.
    towed, parts
        What hangs on the cable, and (name, from, to) of each section [m].
    curves
        (label, table) of the response asked for and of those drawn beside it, as ``response-details.csv``.
    peaks
        ``peaks.csv`` of the first curve.
    conventions
        A row a run: ``run``, peaks of each quantity, ``iterations``.
    conventions_words
        What the runs are.
    printed, printed_marks, printed_words
        What the paper prints beside what is found, where the figures mark it, and what explains the differences.
    at_peaks
        The cable at the peaks.
    modes, still_modes
        The cable at the peaks of the almost undamped cable, as asked for and almost undamped.
    slack_omega, slack_s, slack_ratio
        (k,), (n + 1,), (k, n + 1): dynamic over static tension along the cable.
    bends, errors, refinement
        As the three panels of `reports.figures.responses.segments`; `refinement` with the ``order``.
    kept, agreement, lengths_of
        As of `reports.figures.responses.digits`.
    map_segments
        Of every cable on the map.
    slow
        Columns ``flow_m_s, consistent, printed``: errors of the limit of slow motion; empty for none.
    flow
        The current that these are in instead of still water [m/s]; 0 for the tow as configured.
    left_out, unused, configuration, configuration_text, manifest
        As on the page of a run.
    """

    title: str
    amplitude: float
    direction: str
    statics: pd.DataFrame
    state: pd.DataFrame
    towed: Towed
    parts: Sequence[tuple[str, float, float]]
    curves: Sequence[tuple[str, pd.DataFrame]]
    peaks: pd.DataFrame
    conventions: pd.DataFrame
    conventions_words: str
    printed: pd.DataFrame
    printed_marks: pd.DataFrame
    printed_words: str
    at_peaks: Sequence[CableMotion]
    modes: Sequence[CableMotion]
    still_modes: Sequence[CableMotion]
    slack_omega: Floats
    slack_s: Floats
    slack_ratio: Floats
    bends: pd.DataFrame
    errors: pd.DataFrame
    refinement: pd.DataFrame
    kept: pd.DataFrame
    agreement: pd.DataFrame
    lengths_of: str
    map_segments: int
    flow: float = 0.0
    slow: pd.DataFrame = field(default_factory=pd.DataFrame)
    description: str = ""
    configuration: pd.DataFrame = field(default_factory=pd.DataFrame)
    configuration_text: str = ""
    left_out: Sequence[tuple[str, str]] = ()
    unused: Sequence[tuple[str, str]] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)
