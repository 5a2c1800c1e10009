"""The page that sets the spectral simulator beside the link-joint chain."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from reports import sections
from reports.figures import compare
from reports.figures.compare import Ladder
from reports.markdown import Page, significant
from reports.style import Album


@dataclass(frozen=True, slots=True, kw_only=True)
class Threshold:
    """Where the difference passes a limit: speed [m/s], angle [rad], difference [m/s]; NaN with a note if nowhere."""

    name: str
    speed: float
    angle: float
    difference: float
    note: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Series:
    """One configuration from one speed.

    Parameters
    ----------
    tow_speed
        The ship's speed before the change [m/s].
    duration
        Of the record [s].
    stated
        The error that the spectral simulator was asked for [m/s].
    table
        One row a speed: ``speed_m_s, angle_rad, travel_angle_rad, followed_share, difference_rms_velocity_m_s,
        difference_rms_position_m, difference_share, spectral_error_m_s, chain_error_m_s, chain_links, spectral_s,
        chain_s, note``.
    thresholds
        The limits and where they are passed.
    """

    configuration: str
    tow_speed: float
    duration: float
    stated: float
    table: pd.DataFrame
    thresholds: Sequence[Threshold]

    @property
    def label(self) -> str:
        """The configuration, and the speed it starts from unless at rest."""
        return self.configuration + (f" from {self.tow_speed:.3g} m/s" if self.tow_speed else "")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CompareMaterial:
    """Everything that the page shows.

    Parameters
    ----------
    rise
        Time that a change of speed takes [s].
    followed
        The share of the change that the vehicle should have at the end.
    share
        The share of the speed that is one of the thresholds.
    left_out
        What configurations have that the comparison does without.
    """

    series: Sequence[Series]
    rise: float
    followed: float
    share: float
    left_out: Sequence[str] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)


_THRESHOLDS = {
    "label": "configuration",
    "threshold": "difference passes",
    "speed": "at a change of speed of, m/s",
    "angle": "cable's largest angle, degrees",
    "note": " ",
}
_ROWS = {
    "speed_m_s": "change of speed, m/s",
    "angle_deg": "steady angle, degrees",
    "travel_angle_deg": "on the way, degrees",
    "followed_percent": "vehicle follows, %",
    "difference_rms_velocity_m_s": "difference, m/s",
    "difference_percent": "of the speed, %",
    "difference_rms_position_m": "difference, m",
    "spectral_error_m_s": "spectral's own error, m/s",
    "chain_error_m_s": "chain's own error, m/s",
    "chain_links": "links",
    "spectral_s": "spectral, s",
    "chain_s": "chain, s",
}
_FORMATS = {
    "followed_percent": ".0f",
    "chain_links": ".0f",
} | dict.fromkeys(("difference_rms_velocity_m_s", "spectral_error_m_s", "chain_error_m_s"), ".1e")


def write_compare_page(folder: Path, material: CompareMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page("Spectral simulator against link-joint chain"), Album(folder)
    page.paragraph(
        f"The ship changes its speed within {material.rise:g} s, and both simulators follow the first part until its "
        f"vehicle has {100.0 * material.followed:g} % of the change at every speed. The spectral simulator counts "
        "small deflections from the shape at the start; the chain has no such limit, and is refined until its own "
        "error is a tenth of the difference. Differences are the RMS over the record of the vehicle's velocity and "
        "position. The angle is the largest by which any link turns from where it was at the start: from rest in still "
        "water, its angle from the vertical."
    )
    page.bullets(_finding(each) for each in material.series)
    page.paragraph(*_behaviour(material))
    rows = [
        (each.label, one.name, one.speed, math.degrees(one.angle), one.note)
        for each in material.series
        for one in each.thresholds
    ]
    thresholds = pd.DataFrame(rows, columns=list(_THRESHOLDS))
    if not thresholds["note"].any():
        thresholds = thresholds.drop(columns="note")
    page.table(thresholds, _THRESHOLDS)
    page.figure(
        album.draw(
            "difference",
            compare.differences,
            [_ladder(each) for each in material.series],
            sorted({each.stated for each in material.series}),
            material.share,
        ),
        "Difference of the vehicle's velocity between the simulators. Small dots are the error that the spectral "
        "simulator estimates for itself; the dotted line is the error it was asked for; circles are where a threshold "
        "is passed, between the runs by a power law.",
    )
    for each in material.series:
        page.heading(each.label, 3)
        page.paragraph(f"Followed for {each.duration:g} s.")
        shown = each.table.assign(
            angle_deg=np.degrees(each.table["angle_rad"]),
            travel_angle_deg=np.degrees(each.table["travel_angle_rad"]),
            followed_percent=100.0 * each.table["followed_share"],
            difference_percent=100.0 * each.table["difference_share"],
        )
        page.table(shown, _ROWS, _FORMATS, exactly=["speed_m_s"])
        failed = each.table[each.table["note"] != ""]
        page.bullets(f"{v:g} m/s: {note}" for v, note in zip(failed["speed_m_s"], failed["note"], strict=True))
    page.paragraph("Run times are CPU time of one run with the companion runs that estimate its error.")
    if material.left_out:
        page.heading("Left out")
        page.bullets(material.left_out)
    sections.manifest(page, material.manifest, "")
    page.paragraph("`manifest.json` holds the configurations as used.")
    page.write(folder / "report.md")


def _finding(series: Series) -> str:
    """Where a configuration's thresholds are passed, in words."""
    told = [f"{one.name}: {one.note or _passed(one)}" for one in series.thresholds]
    return f"{series.label}. {'; '.join(told)}."


def _passed(threshold: Threshold) -> str:
    degrees, radians = significant(math.degrees(threshold.angle)), significant(threshold.angle)
    return f"passed at {significant(threshold.speed)} m/s, the cable at {degrees} degrees ({radians} rad)"


def _behaviour(material: CompareMaterial) -> list[str]:
    """Whether the spectral simulator says itself that it is out of its range, and who does not catch up."""
    table = pd.concat([each.table.assign(label=each.label, stated=each.stated) for each in material.series])
    compared = table[table["difference_rms_velocity_m_s"].notna()]
    sentences = []
    told = compared[compared["spectral_error_m_s"].notna()]
    if len(told):
        worst = told.sort_values("difference_rms_velocity_m_s").iloc[-1]
        sentences.append(
            f"The spectral simulator's own error is that of its numerics alone: at {worst['speed_m_s']:g} m/s on "
            f"{worst['label']} it states {worst['spectral_error_m_s']:.1e} m/s, and is "
            f"{significant(worst['difference_rms_velocity_m_s'])} m/s from the chain."
        )
    small = told[told["difference_rms_velocity_m_s"] <= told["stated"]]
    if len(small):
        ratio = (small["difference_rms_velocity_m_s"] / small["spectral_error_m_s"]).max()
        sentences.append(
            "Where the difference is within the error it was asked for, it is at most "
            f"{significant(ratio, 2)} times the error that it states."
        )
    if len(compared):
        spectral, chain = (
            f"{significant(compared[name].min(), 2)} to {significant(compared[name].max(), 2)} s"
            for name in ("spectral_s", "chain_s")
        )
        sentences.append(f"One run of it takes {spectral}, of the chain {chain}.")
    missing = len(table) - len(compared)
    sentences.append(
        f"{missing} of {len(table)} runs could not be compared; the reasons stand below the tables."
        if missing
        else "It refuses none of these runs."
    )
    behind = table[table["followed_share"] < material.followed]
    if len(behind):
        sentences.append(
            f"In {len(behind)} of {len(table)} runs the vehicle has not yet {100.0 * material.followed:g} % of the "
            "change of speed at the end."
        )
    return sentences


def _ladder(series: Series) -> Ladder:
    table = series.table
    return Ladder(
        label=series.label,
        speed=table["speed_m_s"].tolist(),
        angle=np.degrees(table["angle_rad"]).tolist(),
        difference=table["difference_rms_velocity_m_s"].tolist(),
        stated=table["spectral_error_m_s"].tolist(),
        marks=[
            (one.speed, math.degrees(one.angle), one.difference)
            for one in series.thresholds
            if math.isfinite(one.speed)
        ],
    )
