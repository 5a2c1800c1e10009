"""The page of a sea study: motions and tensions in a random sea, their extremes, slack, and how far to trust them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from reports import findings, sections, time_domain
from reports.figures import seas
from reports.markdown import Page, significant
from reports.style import Album
from reports.time_domain import TimeDomain


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SeaMaterial:
    """Everything that the page of a sea study shows; what is left empty is left out of the page.

    Parameters
    ----------
    title, description
        Heading of the page, and the system in a sentence or two.
    sea, sea_notes, top
        What sea it is, what there is to say of it, and how the cable's top moves in it.
    state
        ``quantity, value, unit`` of the sea.
    table
        As ``sea-details.csv``.
    spectra, cable, extremes, durations
        As the files of these names.
    rao
        The vessel's response at the frequencies of `spectra`.
    check
        The same case in the time domain.
    iterations, change, segments
        How the damping settled, and into how many segments the cable was cut.
    left_out, unused, configuration, configuration_text, manifest
        As on the page of a run.
    """

    title: str
    sea: str
    top: str
    state: pd.DataFrame
    table: pd.DataFrame
    spectra: pd.DataFrame
    cable: pd.DataFrame
    extremes: pd.DataFrame
    durations: pd.DataFrame
    iterations: int
    change: float
    segments: int
    description: str = ""
    sea_notes: Sequence[str] = ()
    rao: pd.DataFrame = field(default_factory=pd.DataFrame)
    check: TimeDomain | None = None
    configuration: pd.DataFrame = field(default_factory=pd.DataFrame)
    configuration_text: str = ""
    left_out: Sequence[tuple[str, str]] = ()
    unused: Sequence[tuple[str, str]] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)


_NAMES = {
    "wave": "wave",
    "vessel_heave": "vessel, heave",
    "vessel_surge": "vessel, surge",
    "top": "cable's top, along it",
    "surge": "vehicle, surge",
    "heave": "vehicle, heave",
    "pitch": "vehicle, pitch",
    "tension_bottom": "tension at the vehicle",
    "tension_top": "tension at the top",
}
_TABLE = {
    "quantity": "quantity",
    "unit": "unit",
    "sigma": "sigma",
    "counted": "counted in",
    "significant": "highest third",
    "one_in_10": "highest tenth",
    "one_in_1000": "1 in 1000",
    "zero_crossing_s": "zero crossing, s",
    "static": "static",
    "slack_probability": "slack a cycle",
}
_EXTREMES = {
    "quantity": "quantity",
    "unit": "unit",
    "cycles": "cycles",
    "most_probable": "most probable",
    "expected": "expected",
    "one_in_100": "exceeded in 1 of 100",
    "static": "static",
    "largest": "static + expected",
    "least": "static - expected",
    "slack_in_duration": "chance of slack",
}
_ERRORS = {
    "quantity": "quantity",
    "mesh_error_percent": "segments, %",
    "frequency_error_percent": "frequencies, %",
    "tail_percent": "variance in the last tenth, %",
}
#: Chances of slack that are none, and that make the linear tensions doubtful.
_NEVER, _OFTEN = 1e-12, 1e-3


def write_sea_page(folder: Path, material: SeaMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page(material.title), Album(folder)
    page.paragraph(material.description)
    page.paragraph(*_result(material))
    _sea(page, album, material)
    _motions(page, album, material)
    _slack(page, album, material)
    _extremes(page, album, material)
    if material.check is not None:
        time_domain.section(page, material.check)
    _trust(page, material)
    if len(material.configuration):
        sections.configuration(page, material.configuration, material.left_out, material.unused)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


def _result(material: SeaMaterial) -> list[str]:
    """What the sea does, in words made from the numbers."""
    table, extremes = material.table.set_index("quantity"), material.extremes.set_index("quantity")
    heave = table.loc["heave"]
    first = (
        f"{material.sea}: the vehicle's heave has a significant height of {_told(heave['significant'])} m, one in a "
        f"thousand exceeds {_told(heave['one_in_1000'])} m, and it crosses zero every "
        f"{_told(heave['zero_crossing_s'])} s."
    )
    sentences = [first]
    for name in ("tension_bottom", "tension_top"):
        row = extremes.loc[name].to_dict()
        sentences.append(
            f"The {_NAMES[name]} is {_told(row['static'], 1e-3)} kN in a calm and is expected to reach "
            f"{_told(row['largest'], 1e-3)} kN in {_hours(row['duration_s'])}."
        )
    worst = _worst(material.cable)
    chance = float(worst["slack_probability"])
    if chance < _NEVER:
        sentences.append("No part of the cable goes slack.")
    else:
        sentences.append(f"Slack is likeliest {_place(material.cable)}, in {_chance(chance)} cycles.")
    if chance >= _OFTEN:
        sentences.append("Dynamic tensions beyond the static one are not to be believed: a slack cable snaps.")
    return sentences


def _sea(page: Page, album: Album, material: SeaMaterial) -> None:
    page.heading("The sea")
    page.paragraph(f"{material.sea}.", *material.sea_notes, material.top)
    page.table(material.state, {"quantity": "quantity", "value": "value", "unit": "unit"})
    caption = "Spectrum of the wave"
    if len(material.rao):
        caption += " and of the vessel's motion, and the vessel's motion a metre of wave"
    page.figure(album.draw("sea", seas.sea, material.spectra, material.rao), f"{caption}.")


def _motions(page: Page, album: Album, material: SeaMaterial) -> None:
    page.heading("Motions and tensions")
    page.paragraph(
        "Highest third and tenth are averages, `2 sqrt2 sigma [sqrt(ln n) + n sqrt(pi)/2 erfc(sqrt(ln n))]` with n = 3 "
        "and 10; 1 in 1000 is what one in a thousand exceeds, `2 sigma sqrt(2 ln 1000)`, which the paper prints under "
        "that name, not the average of the highest thousandth. Motions are counted in heights, tensions in "
        "amplitudes, half as much. Surge and heave are along and across the body. A cycle is slack where its amplitude "
        "exceeds the static tension, `exp(-T^2/(2 sigma^2))`."
    )
    table = material.table.assign(quantity=material.table["quantity"].map(_NAMES))
    page.table(table, _TABLE, {"slack_probability": ".2g", "zero_crossing_s": ".2f"})
    page.figure(
        album.draw("motions", seas.motions, material.spectra),
        "Spectra of the cable's top and of the vehicle's motions.",
    )
    page.figure(album.draw("tensions", seas.tensions, material.spectra), "Spectra of the dynamic tension at both ends.")


def _slack(page: Page, album: Album, material: SeaMaterial) -> None:
    page.heading("Along the cable")
    worst = _worst(material.cable)
    chance = float(worst["slack_probability"])

    if chance >= _NEVER:
        page.paragraph(
            f"The static tension is least safe {_place(material.cable)}: it is {_told(worst['static_N'])} N there "
            f"beside a sigma of {_told(worst['sigma_N'])} N of the dynamic tension, so that {_chance(chance)} "
            "cycles are slack."
        )
    page.figure(
        album.draw("along", seas.along, material.cable),
        "Static tension with its dynamic range (left), and the chance that a cycle goes slack (right; chances below "
        f"{_NEVER:g} are drawn there).",
    )


def _extremes(page: Page, album: Album, material: SeaMaterial) -> None:
    duration = float(material.extremes["duration_s"].iloc[0])
    page.heading("Extremes")
    page.paragraph(
        f"The largest amplitude in {_hours(duration)}, peaks taken as independent and Rayleigh distributed: most "
        "probable `sigma sqrt(2 ln N)` of N cycles, expected `sigma (sqrt(2 ln N) + 0.577/sqrt(2 ln N))`, and what is "
        "exceeded in one of a hundred such stays in the sea. The chance of slack is that of one cycle or more "
        "in the duration."
    )
    table = material.extremes.assign(quantity=material.extremes["quantity"].map(_NAMES))
    page.table(table, _EXTREMES, {"cycles": ".0f", "slack_in_duration": ".2g"})
    if len(material.durations):
        page.figure(
            album.draw("durations", seas.growth, material.durations, duration),
            f"Largest dynamic tension against the time in the sea; the grey line marks {_hours(duration)}.",
        )


def _trust(page: Page, material: SeaMaterial) -> None:
    page.heading("How far to trust it")
    page.paragraph(
        "The drag is linearised for the whole sea at once, as a Gaussian process that loses as much energy. "
        f"The damping settled in {findings.count(material.iterations, 'iteration')}; the last moved the cable by "
        f"{significant(material.change)} of what the sea does, in the paper's norm. The cable has {material.segments} "
        "segments. Estimated errors of sigma, from half as many segments and half as many frequencies, and the part "
        "of the variance that lies in the last tenth of the frequencies, beyond which the spectrum says nothing:"
    )
    table = material.table.assign(quantity=material.table["quantity"].map(_NAMES))
    page.table(table, _ERRORS, dict.fromkeys(_ERRORS, ".2g"))


def _told(value: Any, scale: float = 1.0) -> str:
    """A number of a table in words, in another unit where scaled."""
    return significant(scale * float(value))


def _worst(cable: pd.DataFrame) -> "pd.Series[float]":
    """The place where slack is likeliest."""
    return cable.iloc[int(cable["slack_probability"].to_numpy().argmax())]


def _place(cable: pd.DataFrame) -> str:
    """Where slack is likeliest, in words."""
    s = float(_worst(cable)["s_m"])
    ends = {0.0: "at the vehicle", float(cable["s_m"].iloc[-1]): "at the top"}
    return ends.get(s, f"{significant(s)} m above the vehicle")


def _chance(chance: float) -> str:
    """A share of the cycles in words."""
    return f"{100.0 * chance:.2g} % of the" if chance >= 1e-3 else f"one in {significant(1.0 / chance)}"


def _hours(seconds: Any) -> str:
    """A duration in words."""
    return f"{seconds / 3600.0:g} hours" if seconds != 3600.0 else "an hour"
