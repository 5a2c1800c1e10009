"""What the command line shows: progress on the error stream, tables on the output, one line for an error."""

import os
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

from ident.places import interruption

#: Told what is being done and how much of the whole is done (0 to 1); may be called from any thread.
Progress = Callable[[str, float], None]


@contextmanager
def progress(*, quiet: bool) -> Iterator[Progress]:
    """Show progress on the error stream: a bar on a terminal, else a line for each stage and each tenth."""
    if quiet or sys.stderr is None:
        yield _nothing
    elif sys.stderr.isatty() and os.environ.get("TERM") != "dumb":
        with _bar() as report:
            yield report
    else:
        yield _lines()


def _nothing(stage: str, fraction: float) -> None:
    """Show nothing."""


@contextmanager
def _bar() -> Iterator[Progress]:
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (BarColumn(), TaskProgressColumn(), TimeElapsedColumn(), TextColumn("{task.description}", markup=False))
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=1.0)
        done = 0.0

        def report(stage: str, fraction: float) -> None:
            nonlocal done
            done = max(done, min(fraction, 1.0))
            bar.update(task, completed=done, description=stage)

        yield report


def _lines() -> Progress:
    lock = threading.Lock()
    told: set[str] = set()
    done = 0

    def report(stage: str, fraction: float) -> None:
        nonlocal done
        with lock:
            if interruption.is_set():  # a fit that ends after the user has stopped the run
                return
            percent = max(done, min(round(100.0 * fraction), 100))
            if stage in told and percent // 10 == done // 10:
                return
            told.add(stage)
            done = percent
            sys.stderr.write(f"{percent:3d} % {stage}\n")
            sys.stderr.flush()

    return report


def write_table(rows: Sequence[Mapping[str, str]]) -> None:
    """Write a table to the output: ruled on a terminal, else columns parted by two spaces."""
    if not rows:
        return
    headings = list(rows[0])
    if sys.stdout.isatty():
        _write_ruled(headings, rows)
        return
    cells = [headings, *([row.get(heading, "") for heading in headings] for row in rows)]
    widths = [max(len(line[i]) for line in cells) for i in range(len(headings))]
    right = _numeric(headings, rows)
    for line in cells:
        padded = (f"{c:>{w}}" if r else f"{c:<{w}}" for c, w, r in zip(line, widths, right, strict=True))
        sys.stdout.write("  ".join(padded).rstrip() + "\n")


def _write_ruled(headings: Sequence[str], rows: Sequence[Mapping[str, str]]) -> None:
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for heading, right in zip(headings, _numeric(headings, rows), strict=True):
        table.add_column(Text(heading), justify="right" if right else "left", overflow="fold")
    for row in rows:
        table.add_row(*(Text(row.get(heading, "")) for heading in headings))
    Console().print(table)


def _numeric(headings: Sequence[str], rows: Sequence[Mapping[str, str]]) -> list[bool]:
    """For each column, whether every cell starts as a number does (empty cells aside)."""
    columns = ([row.get(heading, "") for row in rows] for heading in headings)
    return [all(not cell or cell.lstrip("+-").replace(".", "", 1)[:1].isdigit() for cell in each) for each in columns]


def write_notes(notes: Sequence[str]) -> None:
    """Write what there is to say beside a result, a line each, where it does not mix with the table."""
    for note in notes:
        sys.stderr.write(f"note: {note}\n")


def write_error(message: str) -> None:
    """Write ``error: ...`` as one line; line breaks become spaces, unprintable characters their escapes."""
    line = " ".join(message.split("\n"))
    printable = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line)
    if sys.stderr is not None:
        sys.stderr.write(f"error: {printable}\n")
        sys.stderr.flush()
