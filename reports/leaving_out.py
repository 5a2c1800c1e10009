"""What a scene leaves out: the part of the benchmark's page, and what the page of a run suggests."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import pandas as pd

from reports.markdown import Page


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LeavingOutMaterial:
    """What the part shows; an empty table leaves it out.

    Parameters
    ----------
    words
        Sentences before the tables.
    table
        Columns ``scene, simulator, term, seconds_off, seconds_zero, seconds_on, apart, built, idle, strength, error,
        error_unit, note``; a row a term.
    operations
        Columns ``simulator, term, spared, idle``: shares of a kernel's operations with the term on.
    """

    words: Sequence[str] = ()
    table: pd.DataFrame = field(default_factory=pd.DataFrame)
    operations: pd.DataFrame = field(default_factory=pd.DataFrame)


_HEADINGS = {
    "scene": "scene",
    "term": "left out",
    "without": "without, ms",
    "at_zero": "at zero, ms",
    "saved": "saved, %",
    "apart": "difference at zero",
    "idle_percent": "zeros kept, %",
    "strength": "with",
    "within": "with it, ms",
    "shown_error": "error of leaving it out",
}
_OPERATIONS = {"simulator": "simulator", "term": "left out", "spared": "spared, %", "idle": "idle, %"}
_FORMATS = {"without": ".2f", "at_zero": ".2f", "within": ".2f", "saved": ".0f", "apart": ".0e", "idle_percent": ".1f"}


def write(page: Page, material: LeavingOutMaterial) -> None:
    """Add the part to a page: a table for each simulator, and the notes of its rows."""
    if not len(material.table):
        return
    page.heading("What scenes leave out")
    for words in material.words:
        page.paragraph(words)
    table = material.table
    shown = table.assign(
        without=1e3 * table["seconds_off"],
        at_zero=1e3 * table["seconds_zero"],
        within=1e3 * table["seconds_on"],
        saved=100.0 * (1.0 - table["seconds_off"] / table["seconds_zero"]),
        idle_percent=100.0 * table["idle"] / table["built"].where(table["built"] > 0),
        shown_error=[_error(value, unit) for value, unit in zip(table["error"], table["error_unit"], strict=True)],
    )
    for simulator, part in shown.groupby("simulator", sort=False):
        page.heading(str(simulator), 3)
        page.table(part, _HEADINGS, _FORMATS)
        notes = part.loc[part["note"] != "", ["term", "note"]].drop_duplicates()
        page.bullets(f"**{term}**: {note}" for term, note in notes.itertuples(index=False))
    if len(material.operations):
        page.heading("Operations spent on terms that are off", 3)
        page.paragraph(
            "Floating-point operations of one evaluation, all other terms on, counted by running the kernels' own "
            "source on numbers that notice a zero: spared are those that are not done without the term, idle those "
            "that are done on its zeros. A kernel without the term could save the idle ones at the most."
        )
        shares = material.operations
        percent = shares.assign(spared=100.0 * shares["spared"], idle=100.0 * shares["idle"])
        page.table(percent, _OPERATIONS, {"spared": ".1f", "idle": ".1f"})


def suggest(page: Page, suggestions: Sequence[tuple[str, str]]) -> None:
    """Add what a configuration asks for without effect, (key, why) each; nothing where there is none."""
    if suggestions:
        page.heading("Settings that make no difference here", 3)
        page.paragraph(
            "As far as the motion of this run goes; another study, such as the response to waves, may need them."
        )
        page.bullets(f"`{setting}`: {why}" for setting, why in suggestions)


def _error(value: float, unit: str) -> str:
    return f"{value:.2g} {unit}" if unit.startswith("m/s") else f"{100.0 * value:.2g} % {unit}"
