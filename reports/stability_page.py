"""The page of the stability catalogue: what was expected of every case, how it ended, and with what margin."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from reports import sections
from reports.figures import stability
from reports.figures.stability import Pairs
from reports.markdown import Page, significant
from reports.style import Album


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StabilityMaterial:
    """Everything that the page of the catalogue shows.

    Parameters
    ----------
    table
        Columns ``case, model, expected, outcome, passed, margin, seconds, text``; the part of a case's name before
        its first hyphen is its group.
    figures
        Columns ``case, quantity, unit, reference, allowed, found, share, source``; empty where no case gave any.
    pairs
        The map of aliasing, where it was made.
    manifest
        As on the page of a run.
    """

    table: pd.DataFrame
    figures: pd.DataFrame
    pairs: Pairs | None = None
    manifest: Mapping[str, Any] = field(default_factory=dict)


#: What the groups are, in the order of the page.
_GROUPS = {
    "chain": "The link-joint chain",
    "matrix": "The matrix method",
    "spectral": "The spectral simulator",
    "reduced": "Reduced models",
    "record": "Records",
    "fit": "Fits started far away",
    "control": "Faults that must be caught",
    "twin": "The schemes of the faults within their limits",
}
_HEADINGS = {
    "case": "case",
    "expected": "expected",
    "outcome": "outcome",
    "passed": "passed",
    "margin": "margin",
    "seconds": "seconds",
    "text": "what it gave",
}
_FIGURES = {
    "case": "case",
    "quantity": "figure",
    "unit": "unit",
    "reference": "reference",
    "allowed": "allowed",
    "found": "found",
    "source": "where the reference comes from",
}
_FORMATS = {"margin": ".3f", "seconds": ".2f"}


def write_stability_page(folder: Path, material: StabilityMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page("Stability on stiff and extreme cases"), Album(folder)
    table = material.table
    failed = table[~table["passed"].astype(bool)]
    page.paragraph(
        f"{len(table)} cases, of which {len(table) - len(failed)} end as expected, in {table['seconds'].sum():.2g} s.",
        "What is expected of a case stands in a table apart from it, with its source: an answer within the allowed "
        "deviation of figures that were found in another way, or a named error. The margin "
        "is 1 less the worst deviation over the allowed one, and 1 for the expected error; above 0 a case passes. Of a "
        "fault, put in on purpose, the deviation must be the larger one: its margin is 1 less the allowed deviation "
        "over the one found.",
        "This is a quick run: the cases that take no time." if material.manifest.get("quick") else "",
    )
    if len(failed):
        page.heading("Not as expected")
        page.table(failed, _HEADINGS, _FORMATS)
    group = table["case"].str.partition("-")[0]
    if len(material.figures):
        page.figure(
            album.draw("deviations", stability.deviations, _shares(material)),
            "The worst deviation of every case that gave figures, over the allowed one. Deviations below 1e-4 are "
            "drawn there, and those of faults beyond 1e4, or that are no number, at the right edge.",
        )
    for name, title in _GROUPS.items():
        some = table[group == name]
        if not len(some):
            continue
        page.heading(title)
        if name == "spectral" and material.pairs is not None:
            _map(page, album, material.pairs)
        page.table(some, _HEADINGS, _FORMATS)
    if len(material.figures):
        page.heading("All figures")
        exact = dict.fromkeys(("reference", "allowed", "found"), ".6g")
        page.table(material.figures, _FIGURES, exact)
    sections.manifest(page, material.manifest, "")
    page.write(folder / "report.md")


def _shares(material: StabilityMaterial) -> pd.DataFrame:
    """The worst figure of every case, with its group."""
    worst = material.figures.groupby("case", sort=False)["share"].max()
    expected = material.table.set_index("case")["expected"]
    return pd.DataFrame(
        {
            "case": worst.index,
            "group": [str(name).partition("-")[0] for name in worst.index],
            "share": worst.to_numpy(),
            "control": [expected[name] == "caught" for name in worst.index],
        }
    )


def _map(page: Page, album: Album, pairs: Pairs) -> None:
    """The map of stable and unstable pairs, and what the simulator accepts of it."""
    stable = pairs.error <= pairs.limit
    wrong = int(np.sum(pairs.accepted & ~stable))
    largest = float(np.max(pairs.error[pairs.accepted], initial=0.0))
    page.figure(
        album.draw("aliasing", stability.aliasing, pairs),
        "Harmonics against stations: the error of the vehicle's velocity against as many harmonics on ample stations. "
        f"A white point: the simulator accepts the pair; a red square: off by more than {100.0 * pairs.limit:g} %; a "
        "cross: the run fails.",
    )
    page.paragraph(
        f"Of {pairs.error.size} pairs {int(np.sum(~stable))} are unstable. The simulator accepts "
        f"{int(np.sum(pairs.accepted))}, of which {wrong or 'none'} {'are' if wrong > 1 else 'is'} unstable; the "
        f"largest error among them is {significant(largest, 2)} of the velocity."
    )
