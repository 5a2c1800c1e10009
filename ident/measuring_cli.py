"""The commands that measure the program itself: compare, bench, stability and gallery; parse, call, print."""

from pathlib import Path
from typing import Annotated

import typer

from ident import options
from ident.options import Out, Quiet
from ident.terminal import progress, write_table
from models.quantity import NumericalFailure

Quick = Annotated[
    bool, typer.Option("--quick", help="A small part of everything, in less than a minute once compiled.")
]


def compare(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME|FILE]...", help="Configurations; three built in if left out.")
    ] = None,
    out: Out = Path("compare"),
    quiet: Quiet = False,
) -> None:
    """Compare the simulators over speed and angle."""
    configurations = [options.load(name) for name in names or options.COMPARED]
    from ident.studies import compare as study

    with progress(quiet=quiet) as report:
        result = study.compare(configurations, out=out, progress=report)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")


def bench(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME|FILE]...", help="Configurations; four built in if left out.")
    ] = None,
    out: Out = Path("bench"),
    quick: Quick = False,
    quiet: Quiet = False,
) -> None:
    """Measure error against run time, also of MoorDyn."""
    configurations = [options.load(name) for name in names or (options.BENCHED[:2] if quick else options.BENCHED)]
    from ident.studies import bench as study

    with progress(quiet=quiet) as report:
        result = study.bench(configurations, out=out, progress=report, quick=quick)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")


def stability(
    out: Out = Path("stability"),
    only: Annotated[
        str | None, typer.Option(metavar="CASE[,CASE]", help="Cases whose names begin so; all if left out.")
    ] = None,
    quick: Quick = False,
    quiet: Quiet = False,
) -> None:
    """Check stiff and extreme cases against what they must end in."""
    chosen = options.listed("--only", only, str.strip)
    from ident.studies import stability as study

    with progress(quiet=quiet) as report:
        result = study.stability(out=out, progress=report, only=chosen, quick=quick)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")
    if result.failed:
        raise NumericalFailure(
            f"{len(result.failed)} of the cases did not end as expected: {', '.join(result.failed)}; "
            f"{result.folder / 'report.md'} says what each gave."
        )


def gallery(out: Out = Path("reports/gallery"), quiet: Quiet = False) -> None:
    """Make the pages of the built-in configurations."""
    from ident.studies import gallery as study

    with progress(quiet=quiet) as report:
        study.gallery(out=out, progress=report)


def add_to(app: typer.Typer) -> None:
    """Give the commands to the program."""
    for command in (compare, bench, stability, gallery):
        app.command()(command)
