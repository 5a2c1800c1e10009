"""One case of the stability catalogue: what is run, what is expected of it, and how the two are judged.

What is expected stands in tables beside this file, one row for every figure of a case, and does not come from what is
run: `name, model, expected, quantity, reference, unit, allowed, source`. `expected` is ``answer``, ``caught`` of a
negative control, or the name of the error that must be raised; then there is one row and no figure.
"""

import csv
import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from models.quantity import InvalidInput, NumericalFailure

#: What a case may be expected to end in, beside the name of an error.
ANSWER, CAUGHT = "answer", "caught"
_COLUMNS = ("name", "model", "expected", "quantity", "reference", "unit", "allowed", "source")


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What a case's run hands back: figures by quantity, in the units of the table, and a line for the reader."""

    figures: Mapping[str, float]
    text: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A case: its name in the table, what runs it, and whether the reduced form of the catalogue has it too.

    `may_fail`: a fault whose computation may blow up, which counts as caught; other faults must show in a figure.
    """

    name: str
    run: Callable[[], Finding]
    reduced: bool = False
    may_fail: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """A figure that a case must give: within `allowed` of `reference`, both in `unit`."""

    quantity: str
    reference: float
    unit: str
    allowed: float
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Expectation:
    """What is expected of a case: ``answer``, ``caught`` or the name of an error, and the figures."""

    name: str
    model: str
    expected: str
    figures: tuple[Figure, ...]
    source: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """How a case ended.

    `margin` is without dimension and above 0 where the case passed: 1 less the deviation over the allowed one, of the
    worst figure; of a control 1 less the allowed deviation over that of its worst figure; 1 for the expected error.
    `given` holds the figures that were found.
    """

    expectation: Expectation
    ended: str
    passed: bool
    margin: float
    text: str
    seconds: float = 0.0
    given: Mapping[str, float] = field(default_factory=dict)


def expectations(*tables: Path) -> dict[str, Expectation]:
    """All expectations of the tables by name, in their order.

    Raises
    ------
    InvalidInput
        A table with other columns, or a row that contradicts another of its case, or with a figure that is none.
    """
    found: dict[str, Expectation] = {}
    for table in tables:
        with table.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
            if not rows or tuple(rows[0]) != _COLUMNS:
                raise InvalidInput(f"{table.name} needs the columns {', '.join(_COLUMNS)} and at least one row.")
        for line, row in enumerate(rows, start=2):
            where = f"{table.name}, line {line}"
            before = found.get(row["name"])
            if before is not None and (before.model, before.expected) != (row["model"], row["expected"]):
                raise InvalidInput(f"{where}: another row of {row['name']} names another model or outcome.")
            if before is not None and before.expected not in (ANSWER, CAUGHT):
                raise InvalidInput(f"{where}: {row['name']} must end in {before.expected} and needs no second row.")
            figures = () if before is None else before.figures
            if row["expected"] in (ANSWER, CAUGHT):
                figures = (*figures, _figure(row, where))
            found[row["name"]] = Expectation(
                name=row["name"],
                model=row["model"],
                expected=row["expected"],
                figures=figures,
                source=row["source"] if before is None else before.source,
            )
    return found


def judge(case: Case, expectation: Expectation) -> Outcome:
    """Run a case and hold what it gives against what is expected; an error that nothing names is a failure too."""
    began = time.perf_counter()
    outcome = _judged(case, expectation)
    return replace(outcome, seconds=time.perf_counter() - began)


def _judged(case: Case, expectation: Expectation) -> Outcome:
    try:
        finding = case.run()
    except (InvalidInput, NumericalFailure) as error:
        kind = type(error).__name__
        caught = expectation.expected == CAUGHT and case.may_fail and isinstance(error, NumericalFailure)
        wanted = caught or kind == expectation.expected
        return Outcome(
            expectation=expectation, ended=kind, passed=wanted, margin=1.0 if wanted else -math.inf, text=str(error)
        )
    except Exception as error:  # a crash, which must not keep the rest from running
        return _failed(expectation, "crash", f"{type(error).__name__}: {error}")
    missing = [each.quantity for each in expectation.figures if each.quantity not in finding.figures]
    if missing:
        return _failed(expectation, ANSWER, f"It does not give {', '.join(missing)}.", finding.figures)
    if expectation.expected not in (ANSWER, CAUGHT):
        return _failed(expectation, ANSWER, f"It gave an answer: {finding.text}", finding.figures)
    shares = {figure.quantity: share_of(figure, finding.figures) for figure in expectation.figures}
    worst = max(expectation.figures, key=lambda figure: shares[figure.quantity])
    share = shares[worst.quantity]
    caught = expectation.expected == CAUGHT
    margin = (1.0 - 1.0 / share if share > 0.0 else -math.inf) if caught else 1.0 - share
    value = finding.figures[worst.quantity]
    told = f"{worst.quantity} {value:.6g} {worst.unit} for {worst.reference:.6g} within {worst.allowed:.2g}"
    return Outcome(
        expectation=expectation,
        ended=CAUGHT if caught and margin > 0.0 else ANSWER,
        passed=margin > 0.0,
        margin=margin,
        text="; ".join(each for each in (told, finding.text) if each),
        given=finding.figures,
    )


def _failed(expectation: Expectation, ended: str, text: str, given: Mapping[str, float] | None = None) -> Outcome:
    return Outcome(
        expectation=expectation,
        ended=ended,
        passed=False,
        margin=-math.inf,
        text=text,
        given={} if given is None else given,
    )


def pairs(cases: Sequence[Case], expected: Mapping[str, Expectation]) -> list[tuple[Case, Expectation]]:
    """Every case with its expectation.

    Raises
    ------
    InvalidInput
        A name twice, a case that the tables do not know, or a row without a case.
    """
    names = [case.name for case in cases]
    twice = sorted({name for name in names if names.count(name) > 1})
    unknown, idle = sorted(set(names) - set(expected)), sorted(set(expected) - set(names))
    for what, which in (("There twice", twice), ("Not in a table", unknown), ("In a table, but never run", idle)):
        if which:
            raise InvalidInput(f"{what}: {', '.join(which)}. Every case needs one name and its rows in a table.")
    return [(case, expected[case.name]) for case in cases]


def _figure(row: Mapping[str, str], where: str) -> Figure:
    try:
        reference, allowed = float(row["reference"]), float(row["allowed"])
    except ValueError as error:
        raise InvalidInput(f"{where}: reference and allowed must be numbers.") from error
    if not (math.isfinite(reference) and 0.0 < allowed < math.inf and row["quantity"]):
        raise InvalidInput(f"{where}: a figure needs a quantity, a finite reference and an allowed deviation above 0.")
    return Figure(
        quantity=row["quantity"], reference=reference, unit=row["unit"], allowed=allowed, source=row["source"]
    )


def share_of(figure: Figure, given: Mapping[str, float]) -> float:
    """The deviation over the allowed one; infinite where the figure is not finite."""
    share = abs(given[figure.quantity] - figure.reference) / figure.allowed
    return share if math.isfinite(share) else math.inf
