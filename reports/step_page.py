"""The page of a step study: how the response depends on length and weight (T 4.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from reports import sections
from reports.figures import steps
from reports.figures.records import rms
from reports.figures.steps import StepResponse
from reports.markdown import Page, significant
from reports.series import Floats
from reports.style import Album


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StepMaterial:
    """Everything that the page of a step study shows; what is left empty is left out of the page.

    Parameters
    ----------
    title
        Heading of the page.
    description
        The system in a sentence or two.
    step
        Ship velocity after the step [m/s].
    delay_definition
        How the delay was measured on a response, as a clause: ``the time at which ...``.
    by_length, by_weight
        Responses for several cable lengths and for several vehicle weights.
    random_t, random_ship_velocity
        (n,) [s], [m/s] of the random input.
    random_vehicle_velocity
        Label, such as ``740 m``, to (n,) [m/s].
    random_note
        How the random input was made, with its seed.
    left_out, unused
        (term, why), (setting, why) as on the page of a run.
    configuration
        As on the page of a run.
    configuration_text, manifest
        As on the page of a run.
    """

    title: str
    step: float
    by_length: Sequence[StepResponse]
    by_weight: Sequence[StepResponse]
    delay_definition: str
    description: str = ""
    random_t: Floats = field(default_factory=lambda: np.empty(0))
    random_ship_velocity: Floats = field(default_factory=lambda: np.empty(0))
    random_vehicle_velocity: Mapping[str, Floats] = field(default_factory=dict)
    random_note: str = ""
    configuration: pd.DataFrame = field(default_factory=pd.DataFrame)
    configuration_text: str = ""
    left_out: Sequence[tuple[str, str]] = ()
    unused: Sequence[tuple[str, str]] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)


_HEADINGS = {
    "label": "response",
    "length": "length, m",
    "weight": "weight in water, N",
    "measured": "measured delay, s",
    "midpoint": "midpoint tension, no added mass, s",
    "front": "wave front, with added mass, s",
    "thesis": "thesis, s",
    "at_60_s": "velocity after 60 s, m/s",
}
_FORMATS = {
    "length": ".0f",
    "weight": ".0f",
    "measured": ".1f",
    "midpoint": ".1f",
    "front": ".1f",
    "thesis": ".1f",
    "at_60_s": ".3f",
}


def write_step_page(folder: Path, material: StepMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page(material.title), Album(folder)
    page.paragraph(material.description)
    page.paragraph(*_result(material))
    page.paragraph(
        f"Delay here is {material.delay_definition}. Beside it stand two travel times of a transverse wave: "
        "`L / sqrt(T_mid / m)` with the tension at midpoint and no added mass, as the thesis has it, "
        "and the wave front's own, `int ds / sqrt(T / (m + m_a))`."
    )
    for name, words, responses in (
        ("length", "cable length", material.by_length),
        ("weight", "vehicle weight", material.by_weight),
    ):
        if responses:
            page.heading(f"Step response against {words}")
            page.table(_delays(responses), _HEADINGS, _FORMATS)
            link = album.draw(f"step-{name}", steps.step_responses, responses, material.step)
            page.figure(
                link,
                f"Vehicle velocity after a step of {material.step:g} m/s, by {words}. Below: the three delays of each.",
            )
    if material.random_vehicle_velocity:
        page.heading("Random input against cable length")
        page.paragraph(material.random_note)
        page.table(_random(material), formats={"RMS velocity, m/s": ".3f", "share of the ship's, %": ".0f"})
        link = album.draw(
            "random-length",
            steps.random_responses,
            material.random_t,
            material.random_ship_velocity,
            material.random_vehicle_velocity,
        )
        page.figure(link, "Vehicle velocity under the same random ship input, by cable length.")
    if len(material.configuration):
        sections.configuration(page, material.configuration, material.left_out, material.unused)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


def _delays(responses: Sequence[StepResponse]) -> pd.DataFrame:
    """One row a response: the three delays, and how far the vehicle has come up to speed."""
    table = pd.DataFrame(
        [
            {
                "label": response.label,
                "length": response.length,
                "weight": response.weight,
                "measured": response.delay_measured,
                "midpoint": response.delay_midpoint,
                "front": response.delay_front,
                "thesis": response.delay_thesis,
                "at_60_s": float(np.interp(60.0, response.t, response.velocity, right=np.nan)),
            }
            for response in responses
        ]
    )
    return table.drop(columns=[name for name in ("thesis", "at_60_s") if table[name].isna().all()])


def _result(material: StepMaterial) -> list[str]:
    """What the delays show, in words made from the numbers."""
    sentences = []
    for words, unit, key, responses in (
        ("Cable length", "m", "length", material.by_length),
        ("Vehicle weight", "N", "weight", material.by_weight),
    ):
        if len(responses) > 1:
            ends = sorted(responses, key=lambda response: float(getattr(response, key)))
            low, high = ends[0], ends[-1]
            sentences.append(
                f"{words} from {getattr(low, key):g} to {getattr(high, key):g} {unit} takes the delay from "
                f"{low.delay_measured:.1f} to {high.delay_measured:.1f} s."
            )
    everything = [*material.by_length, *material.by_weight]
    for words, key in (("the midpoint formula", "delay_midpoint"), ("the wave front", "delay_front")):
        ratios = [response.delay_measured / float(getattr(response, key)) for response in everything]
        if ratios:
            low_ratio, high_ratio = significant(min(ratios)), significant(max(ratios))
            spread = low_ratio if low_ratio == high_ratio else f"{low_ratio} to {high_ratio}"
            sentences.append(f"The measured delay is {spread} times that of {words}.")
    return sentences


def _random(material: StepMaterial) -> pd.DataFrame:
    """RMS velocity of each cable's vehicle under the random input."""
    ship = rms(material.random_ship_velocity)
    sizes = {label: rms(velocity) for label, velocity in material.random_vehicle_velocity.items()}
    return pd.DataFrame(
        {
            "cable": ["ship", *sizes],
            "RMS velocity, m/s": [ship, *sizes.values()],
            "share of the ship's, %": [100.0, *(100.0 * size / ship for size in sizes.values())],
        }
    )
