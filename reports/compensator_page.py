"""The page of a compensator study: how to tune a passive heave compensator, and what the strategies come to at sea."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from reports import compensator_tables, sections, time_domain
from reports.figures import compensators
from reports.figures.compensators import ResponseMap
from reports.markdown import Page, listed, significant
from reports.style import Album
from reports.time_domain import TimeDomain


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CompensatorMaterial:
    """Everything that the page of a compensator study shows; what is left empty is left out of the page.

    Parameters
    ----------
    title, description
        Heading of the page, and the system in a sentence or two.
    sea_state, height, peak_period
        Number, significant height [m] and peak period [s] of the waves.
    heave, peak
        Of the vessel: significant height [m] and the frequency of its peak [rad/s].
    vessel, assumed
        The file of its RAO, and whether that is the assumed one.
    stroke, mass
        Of the compensator [m], [kg].
    advice, why
        ``soft``, ``damp`` or ``lock``, and the reason in a sentence.
    limit, critical
        |R/D| that the stroke allows, and k_crit [N/m], infinite for none.
    top_tuned
        |p_n/D| with the tuned damping where the rule locks although that would spare the cable's top; else NaN.
    free_heave
        Significant heave up to which the softest compensator keeps inside the stroke [m].
    settings
        As `ident.compensator_tuning.settings_table`.
    details
        A row a strategy, the columns of ``tuning-details.csv``.
    table_three, table_four
        The paper's tables beside ours where it prints them, as ``table-3.csv`` and ``table-4.csv``.
    check
        The strategies in the time domain.
    spectra
        As ``spectra.csv``.
    shown
        The response map at the peak.
    swept
        As ``sweeps.csv``.
    tuned
        ``damping`` and ``stiffness`` to their tuned values.
    configuration, configuration_text, left_out, unused, manifest
        As on the page of a run.
    """

    title: str
    sea_state: int
    height: float
    peak_period: float
    heave: float
    peak: float
    vessel: str
    assumed: bool
    stroke: float
    mass: float
    advice: str
    why: str
    limit: float
    critical: float
    top_tuned: float
    free_heave: float
    settings: pd.DataFrame
    details: pd.DataFrame
    spectra: pd.DataFrame
    shown: ResponseMap
    swept: pd.DataFrame
    tuned: Mapping[str, float]
    table_three: pd.DataFrame = field(default_factory=pd.DataFrame)
    table_four: pd.DataFrame = field(default_factory=pd.DataFrame)
    check: TimeDomain | None = None
    description: str = ""
    configuration: pd.DataFrame = field(default_factory=pd.DataFrame)
    configuration_text: str = ""
    left_out: Sequence[tuple[str, str]] = ()
    unused: Sequence[tuple[str, str]] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)


_VERDICTS = {
    "soft": "Leave it soft",
    "damp": "Raise the damping",
    "lock": "Lock it",
}


def write_compensator_page(folder: Path, material: CompensatorMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page(material.title), Album(folder)
    page.paragraph(material.description)
    page.paragraph(*_result(material))
    _sea(page, album, material)
    _tuning(page, material)
    _maps(page, album, material)
    _strategies(page, album, material)
    if _row(material, "tuned-damping") is not None:
        _stroke(page, album, material)
    if material.check is not None:
        time_domain.section(page, material.check)
    if len(material.configuration):
        sections.configuration(page, material.configuration, material.left_out, material.unused)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


def _result(material: CompensatorMaterial) -> list[str]:
    """What to do and what it brings, in words made from the numbers."""
    sentences = [f"**{_VERDICTS[material.advice]}**: {material.why}."]
    if not math.isnan(material.top_tuned):
        sentences.append(
            "This rule of the paper is stricter than need be: it looks at no damping at all, and with the tuned one "
            f"the cable's top would move by {material.top_tuned:.2f} of the vessel's motion at the peak."
        )
    locked = _row(material, "locked")
    for name, words in (
        ("tuned-damping", "the tuned damping" if material.advice != "soft" else "the softest compensator"),
        ("tuned-stiffness", "the tuned stiffness"),
    ):
        own = _row(material, name)
        if own is None or locked is None or (name == "tuned-stiffness" and material.advice == "soft"):
            continue
        changes = listed(
            [_change(own, locked, *each) for each in (("Q_third_m", "towed body"), ("T_n_thousandth_N", "top tension"))]
        )
        sentences.append(f"In the random sea {words} changes, against the locked compensator, {changes}.")
    loose = [
        f"{100.0 * float(row['slack_probability_worst']):.2g} % ({row['strategy']})"
        for row in material.details.to_dict("records")
        if float(row["slack_probability_worst"]) >= 1e-3
    ]
    if loose:
        sentences.append(
            f"The cable goes slack somewhere in {listed(loose)} of its cycles, and the linear figures of those "
            "strategies are then those of a cable that could push."
        )
    return sentences


def _row(material: CompensatorMaterial, strategy: str) -> "pd.Series[Any] | None":
    found = material.details[material.details["strategy"] == strategy]
    return None if found.empty else found.iloc[0]


def _change(own: "pd.Series[Any]", locked: "pd.Series[Any]", column: str, words: str) -> str:
    scale, unit = (1e-3, "kN") if column.endswith("_N") else (1.0, "m")
    before, after = scale * float(locked[column]), scale * float(own[column])
    change = 100.0 * (after / before - 1.0)
    return f"the {words} from {before:.2f} to {after:.2f} {unit} ({round(change):+d} %)"


def _sea(page: Page, album: Album, material: CompensatorMaterial) -> None:
    """Waves and vessel."""
    page.heading("Sea and vessel")
    page.paragraph(
        f"Waves of Bretschneider's form with a significant height of {material.height:g} m and a peak period of "
        f"{material.peak_period:g} s; the vessel of `{material.vessel}` heaves by {material.heave:.2f} m, most at "
        f"{material.peak:.3f} rad/s."
    )
    if material.assumed:
        page.paragraph(
            "**The vessel is assumed.** The paper has the RAO of a real SWATH vessel only as a figure of the heave it "
            "leads to; the shape here is ours and made to give the printed significant heave. Nothing below is known "
            "of the real vessel beyond that number."
        )
    page.figure(
        album.draw("sea-and-vessel", compensators.sea_and_vessel, material.spectra, material.peak),
        "Spectra of the waves and of the vessel's heave.",
    )


def _tuning(page: Page, material: CompensatorMaterial) -> None:
    """The linear analysis at the peak, beside the paper's Table III."""
    page.heading("Tuning")
    critical = (
        "no stiffness makes the cable's top move more than the vessel"
        if math.isinf(material.critical)
        else f"below k_crit = {material.critical:.0f} N/m no damping makes the cable's top move more than the vessel"
    )
    page.paragraph(
        f"At the peak of the heave, with drag linearised at half the significant heave, {critical}. The stroke of "
        f"{material.stroke:g} m is to be exceeded by one motion in a thousand: |R/D| is to be at most "
        f"{material.limit:.3f}. The softest compensator keeps inside the stroke up to a significant heave of "
        f"{material.free_heave:.2f} m at this frequency."
    )
    compensator_tables.settings(page, material.settings)
    if len(material.table_three):
        compensator_tables.table_three(page, material.table_three, material.peak)


def _maps(page: Page, album: Album, material: CompensatorMaterial) -> None:
    """Amplitudes over stiffness and damping."""
    page.heading("Response over stiffness and damping")
    page.paragraph(
        "Amplitudes at the peak of the heave for one metre of the vessel's. Body and tensions follow the motion of the "
        "cable's top, so that their maps differ by a factor alone. The colour says how much of the locked "
        "compensator's amplitude is left, white to red where it is exceeded; of the compensator's own motion, how much "
        "of what the stroke allows. Settings below the thick line exceed the stroke."
    )
    page.figure(
        album.draw("maps-motion", compensators.maps, material.shown, ("bottom", "relative")),
        "Motion of the towed body and of the compensator over that of the vessel.",
    )
    page.figure(
        album.draw("maps-tension", compensators.maps, material.shown, ("tension_bottom", "tension_top")),
        "Dynamic tension at both ends of the cable for a metre of the vessel's motion.",
    )


def _strategies(page: Page, album: Album, material: CompensatorMaterial) -> None:
    """The random sea, beside the paper's Table IV."""
    page.heading("Strategies in the random sea")
    page.paragraph(
        "Drag linearised for the whole spectrum. Significant heights are 4.004 sigma, 1/1000 heights those that one in "
        "a thousand exceeds, 7.43 sigma; tensions are amplitudes, half of that."
    )
    columns = {
        "softest": "least stiffness and damping, whatever the stroke",
        "filled-stroke": "damping that fills the stroke in this sea",
    }
    told = [f"`{name}`: {words}" for name, words in columns.items() if _row(material, name) is not None]
    if told:
        page.paragraph(f"Beside the strategies of the paper: {listed(told)}.")
    compensator_tables.strategies(page, material.details)
    strategies = [name for name in ("locked", "tuned-stiffness", "tuned-damping") if _row(material, name) is not None]
    page.figure(
        album.draw("strategies", compensators.strategy_spectra, material.spectra, strategies, material.peak),
        "Response spectra of the strategies; the dotted line is the frequency of the tuning.",
    )
    compensator_tables.trust(page, material.details)
    if len(material.table_four):
        compensator_tables.table_four(page, material.table_four, assumed=material.assumed)


def _stroke(page: Page, album: Album, material: CompensatorMaterial) -> None:
    """How far the rule at one frequency holds over the whole spectrum."""
    page.heading("The stroke in the random sea")
    tuned, filled = _row(material, "tuned-damping"), _row(material, "filled-stroke")
    sentences = ["The rule looks at one frequency; the sea has all of them."]
    if tuned is not None:
        reached = float(tuned["R_thousandth_m"])
        off = 100.0 * (reached / material.stroke - 1.0)
        who = "softest compensator" if material.advice == "soft" else "tuned damping"
        sentences.append(
            f"With the {who} one motion in a thousand exceeds {reached:.2f} m, {abs(off):.0f} % "
            f"{'more' if off > 0.0 else 'less'} than the stroke."
        )
    if filled is not None:
        sentences.append(
            f"A damping of {float(filled['damping_N_s_m']):.0f} N s/m fills the stroke, and the towed body then moves "
            f"by {float(filled['Q_third_m']):.2f} m."
        )
    if material.swept.empty:
        page.paragraph(*sentences)
        return
    stiff = material.swept[material.swept["swept"] == "stiffness"]
    locked = material.swept[material.swept["swept"] == "locked"]
    worst = stiff.iloc[int(stiff["Q_third_m"].to_numpy().argmax())]
    share = 100.0 * (float(worst["Q_third_m"]) / float(locked["Q_third_m"].iloc[0]) - 1.0)
    if share > 0.0:
        sentences.append(
            f"A stiffness of {significant(float(worst['value']))} N/m is the worst tried: the towed body moves "
            f"{share:.0f} % more than with the compensator locked."
        )
    page.paragraph(*sentences)
    page.figure(
        album.draw("sweeps", compensators.sweeps, material.swept, material.stroke, material.tuned),
        "Damping at the least stiffness, left, and stiffness at the least damping, right, in the random sea. 1/1000 "
        "height of the compensator, significant height of the towed body and 1/1000 amplitude of the top tension.",
    )
