"""The page of recorded tows: every model and two trivial predictors, scored on the last part of every tow."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from reports import findings, sections
from reports.figures import records, residuals
from reports.figures.residuals import ResidualCurves
from reports.files import SCORE_COLUMNS
from reports.markdown import Page, significant
from reports.series import Floats, RecordSeries, require_columns
from reports.style import Album, is_baseline

_OFF_AXIS_WARNING = 0.20


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TowRecord:
    """One recorded tow.

    Parameters
    ----------
    name
        As in the score table's column ``record``.
    series
        Motion along the axis; `scored_from` is where the fitted part ends. Models hold the baselines too, named
        ``baseline-...``, with a position and, where that means something, a velocity.
    ship_track, vehicle_track
        (n, 2) east and north [m] in a local origin, n as in `series`.
    axis_rms_m, off_axis_rms_m
        Ship's motion along its principal direction and across it, RMS about the mean [m].
    axis_degrees
        Heading of the axis, clockwise from north [degrees].
    depth, slant_range
        (n,) [m], where known.
    notes
        What the reader did, a sentence each, with counts.
    warnings
        What to doubt, a sentence each.
    residual_tests
        Correlations of the residuals, where wanted.
    """

    name: str
    series: RecordSeries
    ship_track: Floats
    vehicle_track: Floats
    axis_rms_m: float
    off_axis_rms_m: float
    axis_degrees: float = float("nan")
    depth: Floats | None = None
    slant_range: Floats | None = None
    notes: Sequence[str] = ()
    warnings: Sequence[str] = ()
    residual_tests: Sequence[ResidualCurves] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TowMaterial:
    """Everything that the page of recorded tows shows; what is left empty is left out of the page.

    Parameters
    ----------
    title
        Heading of the page.
    description
        Where the records come from and what was done, in a sentence or two.
    tows
        In the order of the page.
    scores
        As scores.csv, record = the tow's name, baselines included.
    parameters
        As parameters.csv with a column record, or without it where one fit served every tow.
    ends
        Columns record, model, outcome, reason: why each search stopped.
    limits
        What the models leave out that the records hold, a sentence each.
    configuration, left_out, unused, configuration_text, manifest
        As on the page of a run.

    Raises
    ------
    InvalidInput
        A table lacks a column.
    """

    title: str
    tows: Sequence[TowRecord]
    scores: pd.DataFrame
    ends: pd.DataFrame
    parameters: pd.DataFrame = field(default_factory=pd.DataFrame)
    description: str = ""
    limits: Sequence[str] = ()
    configuration: pd.DataFrame = field(default_factory=pd.DataFrame)
    configuration_text: str = ""
    left_out: Sequence[tuple[str, str]] = ()
    unused: Sequence[tuple[str, str]] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        require_columns(self.scores, SCORE_COLUMNS, "TowMaterial.scores")
        require_columns(self.ends, ("model", "outcome", "reason"), "TowMaterial.ends")


def write_tow_page(folder: Path, material: TowMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page(material.title), Album(folder)
    page.paragraph(material.description)
    names = [tow.name for tow in material.tows]
    page.paragraph(*findings.tows_in_words(material.scores, names))
    page.bullets(
        f"{findings.against_baselines(material.scores, name)} "
        f"{findings.against_baselines_in_velocity(material.scores, name)}".rstrip()
        for name in names
    )
    if material.limits:
        page.paragraph("What these models leave out, and these records hold:")
        page.bullets(material.limits)
    for tow in material.tows:
        _tow(page, album, tow, material.scores)
    if len(material.ends):
        sections.endings(page, material.ends)
    if len(material.parameters):
        page.heading("Parameters")
        sections.parameters(page, material.parameters)
    if len(material.configuration):
        sections.configuration(page, material.configuration, material.left_out, material.unused)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


def _tow(page: Page, album: Album, tow: TowRecord, scores: pd.DataFrame) -> None:
    """One tow: what was read, how straight it is, the scores, and the pictures."""
    page.heading(f"Tow {tow.name}")
    page.paragraph(tow.series.description)
    page.bullets(tow.notes)
    share = tow.off_axis_rms_m / tow.axis_rms_m if tow.axis_rms_m > 0.0 else float("inf")
    heading = f" Its axis points to {tow.axis_degrees:.0f} degrees." if tow.axis_degrees == tow.axis_degrees else ""
    page.paragraph(
        f"The ship moves {significant(tow.axis_rms_m)} m RMS along its principal direction and "
        f"{significant(tow.off_axis_rms_m)} m across it ({significant(100.0 * share)} %).{heading}"
    )
    cautions = list(tow.warnings)
    if share > _OFF_AXIS_WARNING:
        cautions.insert(
            0,
            f"the motion across the axis is above {100 * _OFF_AXIS_WARNING:.0f} % of that along it: "
            "a planar model sees only part of this tow.",
        )
    page.bullets(f"**Warning**: {words}" for words in cautions)
    _table(page, tow.name, scores)
    link = album.draw(
        f"tow-{Path(tow.name).stem}-track",
        records.tracks,
        tow.series,
        tow.ship_track,
        tow.vehicle_track,
        depth=tow.depth,
        slant_range=tow.slant_range,
    )
    page.figure(
        link, f"Tow {tow.name}: plan view from the dots on, and motion against time. Grey: the part that is scored."
    )
    link = album.draw(f"tow-{Path(tow.name).stem}-velocity", records.velocities, tow.series)
    page.figure(link, f"Tow {tow.name}: vehicle velocity along the axis, observed and predicted, over the scored part.")
    link = album.draw(f"tow-{Path(tow.name).stem}-errors", records.errors, tow.series, scored_only=True)
    page.figure(
        link, f"Tow {tow.name}: errors over the scored part, baselines beside the models. RMS above each panel."
    )
    if tow.residual_tests:
        link = album.draw(f"tow-{Path(tow.name).stem}-residuals", residuals.residual_tests, tow.residual_tests)
        page.figure(link, f"Tow {tow.name}: correlations of the residuals, 95 % bands grey.")


def _table(page: Page, name: str, scores: pd.DataFrame) -> None:
    """The tow's scores, baselines first, models in their order."""
    rows = scores[scores["record"] == name]
    trivial = rows["model"].map(is_baseline).astype(bool)
    headings = {
        "model": "model",
        "rms_position_m": "position, m",
        "rms_position_offset_removed_m": "offset removed, m",
        "rms_velocity_m_s": "velocity, m/s",
        "fit_percent": "fit, %",
        "vehicle_rms_velocity_m_s": "vehicle's own, m/s",
        "simulation_ms": "one hour, ms",
        "outcome": "outcome",
    }
    table = pd.concat([rows[trivial], rows[~trivial]])
    table = table.assign(simulation_ms=1e3 * table["simulation_s_per_hour"])
    formats = {
        "rms_position_m": ".1f",
        "rms_position_offset_removed_m": ".1f",
        "rms_velocity_m_s": ".4f",
        "fit_percent": ".1f",
        "vehicle_rms_velocity_m_s": ".3f",
    }
    page.table(table, headings, formats)
