"""The page of a turning study: periods, damping, depth and tension of a tow in turns, and what W claims of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from reports import findings, sections
from reports.figures import turns
from reports.figures.turns import TurnHistory
from reports.markdown import Page, listed, significant
from reports.style import Album

#: Most runs of a group that have panels and lines of their own.
SHOWN = 6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TurnGroup:
    """Runs that are shown together.

    Parameters
    ----------
    title
        Heading of its section; its figures are named after it.
    turns, peaks
        The rows of ``turn.csv`` and ``peaks.csv`` of its runs, with a column ``run`` that tells them apart.
    histories
        The runs, labelled as in ``run``.
    over
        What it sweeps over, among `reports.figures.turns.SWEPT`; empty for none.
    """

    title: str
    turns: pd.DataFrame
    peaks: pd.DataFrame
    histories: Sequence[TurnHistory]
    over: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TurnMaterial:
    """Everything that the page of a turning study shows; what is left empty is left out of the page.

    Parameters
    ----------
    title
        Heading of the page.
    description
        The system in a sentence or two.
    groups
        The runs, in the order of the page.
    claims
        A row a claim: ``about``, ``paper``, ``ours``, ``verdict``, ``why``.
    ship_heave
        A row a tow, period and body: ``parts``, ``period_s``, ``body``, ``heave_m``, ``of_ship``, ``of_above``.
    left_out, unused
        (term, why), (setting, why) as on the page of a run.
    configuration, configuration_text, manifest
        As on the page of a run.
    """

    title: str
    groups: Sequence[TurnGroup]
    description: str = ""
    claims: pd.DataFrame = field(default_factory=pd.DataFrame)
    ship_heave: pd.DataFrame = field(default_factory=pd.DataFrame)
    configuration: pd.DataFrame = field(default_factory=pd.DataFrame)
    configuration_text: str = ""
    left_out: Sequence[tuple[str, str]] = ()
    unused: Sequence[tuple[str, str]] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)


_RUNS = {
    "run": "run",
    "body": "body",
    "circle_s": "circle, s",
    "peak_gap_s": "second gap, s",
    "period_s": "period, s",
    "damping_ratio": "damping ratio",
    "amplitude_m": "amplitude, m",
    "fit_percent": "fit, %",
    "depth_m": "depth, m",
    "tow_radius_m": "tow radius, m",
    "tension_max_N": "largest tension, N",
    "slack_events": "slack events",
}
_U_TURNS = {
    "run": "run",
    "body": "body",
    "start_depth_m": "depth before, m",
    "deepest_m": "deepest, m",
    "dips": "dips",
    "dip_s": "below half of the dip, s",
    "tension_max_N": "largest tension, N",
    "slack_events": "slack events",
}
_FORMATS = {
    "circle_s": ".0f",
    "peak_gap_s": ".0f",
    "period_s": ".0f",
    "damping_ratio": ".3f",
    "amplitude_m": ".0f",
    "fit_percent": ".0f",
    "depth_m": ".0f",
    "tow_radius_m": ".0f",
    "tension_max_N": ".0f",
    "slack_events": ".0f",
    "start_depth_m": ".0f",
    "deepest_m": ".0f",
    "dip_s": ".0f",
    "dips": ".0f",
}
_CLAIMS = {"about": "about", "paper": "W", "ours": "found here", "verdict": "verdict", "why": "why"}
_SHIP_HEAVE = {
    "parts": "parts",
    "period_s": "period, s",
    "body": "body",
    "heave_m": "heave, m",
    "of_ship": "of the ship's",
    "of_above": "of the one above",
}


def write_turn_page(folder: Path, material: TurnMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page(material.title), Album(folder)
    page.paragraph(material.description)
    page.paragraph(*_result(material))
    page.paragraph(
        "A gap is the time between two upper turning points of a body's heave in the turn, the first of which is where "
        "it begins to fall. Period, damping ratio and amplitude are those of "
        "`z'' + 2 zeta om z' + om^2 (z - z_e) = 0` about a depth that sinks, `z_e = z_end + D exp(-t/tau)`, fitted to "
        "the heave velocity from the first peak on by the search of the learning model; fit is the share of the "
        "velocity that it explains, and the period is the damped one. A dash means that there is no such oscillation. "
        "Depth and tow radius are means over the last circle."
    )
    if len(material.claims):
        page.heading("What the paper claims")
        page.table(material.claims, _CLAIMS)
    for group in material.groups:
        _group(page, album, group)
    if len(material.ship_heave):
        _ship_heave(page, album, material.ship_heave)
    if len(material.configuration):
        sections.configuration(page, material.configuration, material.left_out, material.unused)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


def _result(material: TurnMaterial) -> list[str]:
    """What the runs and the claims come to, in words made from the numbers."""
    table = pd.concat([group.turns for group in material.groups], ignore_index=True)
    runs = sum(len(group.turns.drop_duplicates("run")) for group in material.groups)
    sentences = [f"{findings.count(runs, 'run').capitalize()}."]
    full = table[table["manoeuvre"] == "full-turn"]
    ratio = (full["peak_gap_s"] / full["circle_s"]).dropna()
    if len(ratio):
        low, high = f"{ratio.min():.2f}", f"{ratio.max():.2f}"
        spread = low if low == high else f"{low} to {high}"
        sentences.append(f"In full turns the second gap between peaks of heave is {spread} times the ship's circle.")
    if "error_m_s" in table and table["error_m_s"].notna().any():
        sentences.append(
            f"The simulation's own estimate of its velocity error is at most "
            f"{significant(float(table['error_m_s'].max()))} m/s RMS."
        )
    if len(material.claims):
        counts = material.claims["verdict"].value_counts()
        told = [f"{findings.in_words(int(number))} {verdict!r}" for verdict, number in counts.items()]
        sentences.append(f"The verdicts on {len(material.claims)} claims of the paper are {listed(told)}.")
    return sentences


def _group(page: Page, album: Album, group: TurnGroup) -> None:
    """Tables and figures of some runs."""
    page.heading(group.title)
    name = group.title.lower().replace(",", "").replace(" ", "-")
    u_turn = group.turns["manoeuvre"] == "u-turn"
    for rows, headings in ((group.turns[~u_turn], _RUNS), (group.turns[u_turn], _U_TURNS)):
        if len(rows):
            page.table(rows.reindex(columns=[*headings]), headings, _FORMATS)
    page.bullets(
        f"{row['run']}, {row['body']}: {row['note']}"
        for row in group.turns[~u_turn].to_dict("records")
        if isinstance(row.get("note"), str) and row["note"]
    )
    gaps = _gaps(group.peaks[group.peaks["manoeuvre"] == "full-turn"] if len(group.peaks) else group.peaks)
    if len(gaps):
        page.paragraph("All gaps between peaks, and the height of each peak over that of the one before:")
        page.table(gaps)
    if not group.histories:
        return
    chosen = [group.histories[i] for i in _spread(len(group.histories))]
    some = "" if len(chosen) == len(group.histories) else f" {findings.in_words(len(chosen)).capitalize()} of the runs."
    page.figure(album.draw(f"{name}-plan", turns.plan_views, chosen), f"Ship and bodies from above.{some}")
    page.figure(album.draw(f"{name}-heave", turns.heave_histories, chosen), f"Heave of all bodies.{some}")
    body = next(iter(chosen[0].bodies))
    page.figure(
        album.draw(f"{name}-tension", turns.tension_histories, chosen, body),
        f"Tension at both ends of the main cable.{some}",
    )
    if group.over:
        page.figure(
            album.draw(f"{name}-sweep", turns.sweep, _sweep(group), group.over),
            f"Period, damping and decay against {listed([_spoken(each) for each in group.over])}.",
        )


def _spread(count: int) -> list[int]:
    """Places of at most `SHOWN` of so many runs, the first and the last among them."""
    return sorted({round(i) for i in np.linspace(0, count - 1, min(count, SHOWN)).tolist()})


def _spoken(quantity: str) -> str:
    return {"ratio": "R/L", "speed_m_s": "speed", "length_m": "length", "sigma": "sigma"}[quantity]


def _gaps(peaks: pd.DataFrame) -> pd.DataFrame:
    """One row a run and body with two peaks or more."""
    rows = []
    for (run, body), own in peaks.groupby(["run", "body"], sort=False) if len(peaks) else ():
        gaps, decay = own["gap_s"].dropna(), own["decay"].dropna()
        if len(gaps):
            told = ", ".join(f"{gap:.0f}" for gap in gaps)
            kept = ", ".join(f"{value:.2f}" for value in decay)
            rows.append({"run": run, "body": body, "gaps, s": told, "height over the one before": kept})
    return pd.DataFrame(rows)


def _sweep(group: TurnGroup) -> pd.DataFrame:
    """The rows of a sweep with what its figure shows; a series for each body and number of parts."""
    rows = group.turns[group.turns["manoeuvre"] == "full-turn"].copy()
    rows["ratio"] = rows["radius_m"] / rows["length_m"]
    rows["gap_over_circle"] = rows["peak_gap_s"] / rows["circle_s"]
    rows["period_over_circle"] = rows["period_s"] / rows["circle_s"]
    rows["series"] = rows["body"]
    if rows["parts"].nunique() > 1:
        rows["series"] += [f", {findings.count(int(n), 'part')}" for n in rows["parts"]]
    return rows


def _ship_heave(page: Page, album: Album, table: pd.DataFrame) -> None:
    """Heave under a heaving ship, from body to body."""
    page.heading("Straight tow under ship heave")
    size, speed = float(table["ship_heave_m"].iloc[0]), float(table["speed_m_s"].iloc[0])
    page.paragraph(f"The ship tows straight at {significant(speed)} m/s and heaves by {size:g} m.")
    page.table(table, _SHIP_HEAVE, {"heave_m": ".3f", "of_ship": ".3f", "of_above": ".3f", "period_s": ".0f"})
    page.figure(album.draw("ship-heave", turns.ship_heave, table), "Heave of each body over that of the ship.")
