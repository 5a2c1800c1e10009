"""A small page builder: plain Markdown that also reads well as text."""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

MISSING = "–"


def significant(value: float, digits: int = 3) -> str:
    """A number to so many significant digits; whole digits are never replaced by zeros.

    Examples
    --------
    ``0.010432`` is ``0.0104``, ``12.346`` is ``12.3``, ``16718.2`` is ``16718``, ``0.00001234`` is ``1.23e-05``.
    """
    if math.isnan(value):
        return MISSING
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    if value == 0.0:
        return "0"
    power = math.floor(math.log10(abs(value)))
    if power < -4 or power > 6:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - power)}f}"


def exact(value: object) -> str:
    """A setting as it was given, without rounding that a reader would notice."""
    if isinstance(value, float) and math.isfinite(value):
        return f"{value:.10g}"
    return cell(value)


def escape(text: str) -> str:
    """Text that stays in one cell of a table."""
    return text.replace("|", "\\|").replace("\n", " ").strip()


def cell(value: object, form: str | None = None) -> str:
    """One table cell: words escaped, flags as yes and no, numbers to 3 digits or in the given format."""
    if value is None or value is pd.NA or value is pd.NaT:
        return MISSING
    if isinstance(value, str):
        return escape(value) or " "
    if type(value).__name__ in ("bool", "bool_"):
        return "yes" if value else "no"
    if isinstance(value, list | tuple):
        return ", ".join(exact(part) for part in value)
    number = float(value)  # type: ignore[arg-type]
    if not math.isfinite(number):
        return significant(number)
    if form is not None:
        return format(number, form)
    return str(int(number)) if type(value).__name__.startswith("int") else significant(number)


def listed(words: Sequence[str]) -> str:
    """Words joined as in a sentence: ``a``, ``a and b``, ``a, b and c``."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


class Page:
    """Collects the blocks of one page; `text` joins them with a blank line between."""

    def __init__(self, title: str) -> None:
        self._blocks = [f"# {title}"]
        self._figures = 0

    @property
    def text(self) -> str:
        """The whole page, ending with a line feed."""
        return "\n\n".join(self._blocks) + "\n"

    def heading(self, words: str, level: int = 2) -> None:
        """A heading, second level unless told."""
        self._blocks.append(f"{'#' * level} {words}")

    def paragraph(self, *sentences: str) -> None:
        """The sentences that are not empty, as one paragraph; nothing when all are."""
        words = " ".join(sentence.strip() for sentence in sentences if sentence.strip())
        if words:
            self._blocks.append(words)

    def bullets(self, items: Iterable[str]) -> None:
        """A bullet list."""
        lines = [f"* {item.strip()}" for item in items]
        if lines:
            self._blocks.append("\n".join(lines))

    def code(self, text: str, language: str = "") -> None:
        """A fenced block."""
        self._blocks.append(f"```{language}\n{text.rstrip()}\n```")

    def figure(self, link: str, caption: str) -> None:
        """A numbered figure with its caption below."""
        self._figures += 1
        alternative = caption.split(". ")[0].rstrip(".").replace("[", "(").replace("]", ")")
        self._blocks.append(f"![{alternative}]({link})")
        self._blocks.append(f"*Figure {self._figures}. {caption}*")

    def table(
        self,
        frame: pd.DataFrame,
        headings: Mapping[str, str] | None = None,
        formats: Mapping[str, str] | None = None,
        *,
        exactly: Sequence[str] = (),
    ) -> None:
        """A table of the columns named in `headings` that the frame has, in that order.

        Parameters
        ----------
        frame
            One row a line.
        headings
            Column name to heading; every column under its own name when left out.
        formats
            Column name to format specification for its numbers, such as ``.4f``; 3 significant digits otherwise.
        exactly
            Columns whose numbers are shown as given.
        """
        headings = headings or {str(name): str(name) for name in frame.columns}
        formats = formats or {}
        columns = [name for name in headings if name in frame.columns]
        rows = [
            [
                exact(value) if name in exactly else cell(value, formats.get(name))
                for name in columns
                for value in [line[name]]
            ]
            for line in frame.to_dict("records")
        ]
        right = [_numeric(frame[name]) for name in columns]
        self._blocks.append(_aligned([escape(headings[name]) for name in columns], rows, right))

    def write(self, path: Path) -> None:
        """Write the page as UTF-8 with line feeds."""
        path.write_text(self.text, encoding="utf-8", newline="\n")


def _numeric(values: "pd.Series[Any]") -> bool:
    """Whether a column is set to the right: numbers, but not flags."""
    return pd.api.types.is_numeric_dtype(values.dtype) and not pd.api.types.is_bool_dtype(values.dtype)


def _aligned(heads: list[str], rows: list[list[str]], right: list[bool]) -> str:
    """A pipe table padded so that its columns line up as text."""
    widths = [max(3, len(head), *(len(row[i]) for row in rows)) for i, head in enumerate(heads)]

    def line(cells: list[str]) -> str:
        padded = [
            text.rjust(width) if flush else text.ljust(width)
            for text, width, flush in zip(cells, widths, right, strict=True)
        ]
        return "| " + " | ".join(padded) + " |"

    rule = ["-" * (width - 1) + ":" if flush else "-" * width for width, flush in zip(widths, right, strict=True)]
    return "\n".join([line(heads), "| " + " | ".join(rule) + " |", *(line(row) for row in rows)])
