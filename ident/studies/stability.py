"""Stability on stiff and extreme cases: the catalogue run, held against its table, and written as a page."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from ident.configuration import load
from ident.manifest import manifest
from ident.places import new_folder
from ident.stability.aliasing import LIMIT, AliasingMap, aliasing_map
from ident.stability.case import ANSWER, CAUGHT, Outcome, judge, share_of
from ident.stability.catalogue import catalogue
from ident.terminal import Progress
from reports.figures.stability import Pairs
from reports.files import write_json, write_table
from reports.stability_page import StabilityMaterial, write_stability_page

COLUMNS = ("case", "model", "expected", "outcome", "passed", "margin", "seconds")
#: Cases whose names begin so are those of the map.
_MAP = "spectral-aliasing"
#: The configuration that most cases start from.
_FIRST = "mangus-740"


@dataclass(frozen=True, kw_only=True)
class StabilityResult:
    """Where the page is, the table for the terminal, and the names of the cases that did not pass."""

    folder: Path
    table: list[dict[str, str]]
    failed: tuple[str, ...]


def stability(
    *, out: Path, progress: Progress, only: Sequence[str] | None = None, quick: bool = False
) -> StabilityResult:
    """Run the catalogue and write the page, its figures and the tables.

    Parameters
    ----------
    only
        Beginnings of the names of the cases to run; all of them when left out.
    quick
        Run the cases that take no time, enough to see that the catalogue still stands.

    Raises
    ------
    InvalidInput
        The place cannot be written, `only` names nothing, or cases and tables do not match.
    """
    chosen = catalogue(tuple(only or ()), reduced=quick)
    outcomes: list[Outcome] = []
    with new_folder(out) as folder:
        for i, (case, expectation) in enumerate(chosen):
            progress(case.name, 0.95 * i / len(chosen))
            outcomes.append(judge(case, expectation))
        mapped = any(case.name.startswith(_MAP) for case, _ in chosen)
        pairs = _pairs(aliasing_map(few=quick)) if mapped else None
        progress("drawing the page", 0.98)
        table = pd.DataFrame([_row(each) for each in outcomes], columns=list(COLUMNS))
        figures = pd.DataFrame([row for each in outcomes for row in _figures(each)])
        told = manifest("stability", load(_FIRST), None, only=list(only or ()), quick=quick)
        write_table(folder / "stability.csv", table, digits=6)
        if len(figures):
            write_table(folder / "figures.csv", figures)
        material = StabilityMaterial(
            table=table.assign(text=[each.text for each in outcomes]),
            figures=figures,
            pairs=pairs,
            # No case is run on the configuration as it stands.
            manifest={name: value for name, value in told.items() if not name.startswith("configuration")},
        )
        write_stability_page(folder, material)
        write_json(folder / "manifest.json", told)
        progress("done", 1.0)
    failed = tuple(each.expectation.name for each in outcomes if not each.passed)
    return StabilityResult(folder=out, table=_summary(outcomes), failed=failed)


def _row(outcome: Outcome) -> tuple[object, ...]:
    wanted = outcome.expectation
    return (
        wanted.name,
        wanted.model,
        wanted.expected,
        outcome.ended,
        outcome.passed,
        outcome.margin,
        outcome.seconds,
    )


def _figures(outcome: Outcome) -> list[dict[str, Any]]:
    """Every figure of a case that gave them."""
    return [
        {
            "case": outcome.expectation.name,
            "quantity": figure.quantity,
            "unit": figure.unit,
            "reference": figure.reference,
            "allowed": figure.allowed,
            "found": outcome.given[figure.quantity],
            "share": share_of(figure, outcome.given),
            "source": figure.source,
        }
        for figure in outcome.expectation.figures
        if figure.quantity in outcome.given
    ]


def _pairs(found: AliasingMap) -> Pairs:
    return Pairs(rows=found.harmonics, columns=found.stations, error=found.error, accepted=found.accepted, limit=LIMIT)


def _summary(outcomes: Sequence[Outcome]) -> list[dict[str, str]]:
    """A line for every kind of outcome that was expected, and one for every case that did not pass."""
    lines = []
    for what, holds in (
        ("answers within their bounds", lambda kind: kind == ANSWER),
        ("named errors", lambda kind: kind not in (ANSWER, CAUGHT)),
        ("faults caught", lambda kind: kind == CAUGHT),
    ):
        some = [each for each in outcomes if holds(each.expectation.expected)]
        if some:
            worst = min(some, key=lambda each: each.margin)
            lines.append(
                {
                    "cases": what,
                    "passed": f"{sum(each.passed for each in some)} of {len(some)}",
                    "least margin": f"{worst.margin:.3f}, {worst.expectation.name}",
                    "seconds": f"{sum(each.seconds for each in some):.1f}",
                }
            )
    return lines + [
        {
            "cases": each.expectation.name,
            "passed": "no",
            "least margin": f"{each.margin:.3f}",
            "seconds": f"{each.seconds:.1f}",
        }
        for each in outcomes
        if not each.passed
    ]
