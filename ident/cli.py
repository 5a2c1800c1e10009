"""The command line: parse, call, print. Whatever computes is imported by the command that needs it."""

import sys
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ident.exits import exit_code
from ident.terminal import progress, write_notes, write_table
from models.quantity import InvalidInput, Quantity, non_negative, positive

if TYPE_CHECKING:
    from ident.configuration import Configuration

app = typer.Typer(
    name="cable-ident",
    help="Small models of towed cables and their vehicles for controllers, and how far to trust them.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


class Start(StrEnum):
    """Where a simulation starts."""

    rest = "rest"
    steady = "steady"


class Reference(StrEnum):
    """The reference simulators."""

    spectral = "spectral"


class Stepper(StrEnum):
    """The steppers of the reference simulator."""

    implicit = "implicit"
    newmark = "newmark"
    runge_kutta = "runge-kutta"


NameOrFile = Annotated[str, typer.Argument(metavar="NAME|FILE", help="A built-in configuration, or a file.")]
Records = Annotated[list[Path], typer.Option("--record", metavar="FILE", help="A trace; may be repeated.")]
Out = Annotated[Path, typer.Option(metavar="PATH", help="Where the result goes.")]
Folder = Annotated[Path | None, typer.Option(metavar="DIR", help="Where the result goes; ./NAME if left out.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of all that is drawn.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Show no progress.")]
Models = Annotated[str | None, typer.Option(metavar="MODEL[,MODEL]", help="The models to fit.")]
Window = Annotated[
    float | None,
    typer.Option(
        "--differentiator",
        help="Window [s] that velocity is read over; as configured if left out, 0 for records without noise.",
    ),
]
Budget = Annotated[int | None, typer.Option(min=1, help="Most simulations a fit; as configured if left out.")]
Starts = Annotated[int | None, typer.Option(min=1, max=1000, help="Start points; as configured if left out.")]


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"cable-ident {version('cable-ident')}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Small models of towed cables and their vehicles for controllers, and how far to trust them."""


@app.command("list")
def list_configurations() -> None:
    """List the built-in configurations."""
    import tomllib

    from ident.builtin import builtin_names, builtin_text

    rows = []
    for name in builtin_names():
        document = tomllib.loads(builtin_text(name))
        length, weight = document["cable"]["length_m"], document["vehicle"]["weight_in_water_N"]
        row = {"name": name, "length_m": f"{length:g}", "weight_in_water_N": f"{weight:g}"}
        rows.append(row | {"description": document["description"]})
    write_table(rows)


@app.command()
def show(name: NameOrFile) -> None:
    """Write a configuration, byte for byte, to the output."""
    from ident.builtin import find

    sys.stdout.flush()
    sys.stdout.buffer.write(find(name).data)
    sys.stdout.buffer.flush()


@app.command()
def new(file: Annotated[Path, typer.Argument(metavar="FILE", help="The file to write.")]) -> None:
    """Write a commented configuration to fill in."""
    from ident.builtin import template
    from ident.places import new_file

    if file.exists():
        raise InvalidInput(f"{file} exists; give the name of a new file.")
    with new_file(file) as temporary:
        temporary.write_bytes(template().encode("utf-8"))
    typer.echo(f"{file} written; fill it in, then: cable-ident run {file}")


@app.command()
def run(name: NameOrFile, out: Folder = None, seed: Seed = 0, models: Models = None, quiet: Quiet = False) -> None:
    """Identify reduced models, verify and report.

    Makes truth with the reference simulator, fits the reduced models to it, and scores them on another record.
    """
    configuration = _load(name)
    folder = out if out is not None else Path(configuration.name)
    chosen = None if models is None else _models(models)
    from ident.studies import run as study

    with progress(quiet=quiet) as report:
        result = study.run(configuration, out=folder, seed=seed, models=chosen, progress=report)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")


@app.command()
def simulate(
    name: NameOrFile,
    ship: Annotated[Path, typer.Option(metavar="TRACE.csv", help="The ship's motion.")],
    out: Out,
    reference: Annotated[Reference, typer.Option(help="The simulator.")] = Reference.spectral,
    tolerance: Annotated[
        float | None, typer.Option(help="RMS velocity error [m/s]; as configured if left out.")
    ] = None,
    start: Annotated[Start, typer.Option(help="Where it starts.")] = Start.rest,
    stepper: Annotated[Stepper, typer.Option(help="The time stepper.")] = Stepper.implicit,
) -> None:
    """Simulate the vehicle under a ship's motion."""
    from ident.settings import SpectralSettings
    from models.quantity import quantities

    _within("--tolerance", tolerance, quantities(SpectralSettings)["tolerance"])
    _apart(out, ship)
    configuration = _load(name)
    from ident.studies import simulate as study

    typer.echo(
        study.simulate(
            configuration,
            ship=ship,
            out=out,
            reference=reference.value,
            tolerance=tolerance,
            start=start.value,
            stepper=stepper.value,
        )
    )


@app.command()
def record(
    name: NameOrFile,
    kind: Annotated[
        str,
        typer.Option(
            "--input",
            metavar="KIND|FILE",
            help="standard, recorded-style, sinusoids, ramps, first-order, step, sea, winch, winch-depth, "
            "a ship trace, or several joined by +.",
        ),
    ],
    out: Out,
    duration: Annotated[float | None, typer.Option(help="How long [s]; as configured if left out.")] = None,
    sensor: Annotated[bool, typer.Option("--sensor", help="What the sensor sees, not the truth.")] = False,
    seed: Seed = 0,
) -> None:
    """Make a synthetic record of ship and vehicle."""
    _within("--duration", duration, positive("T", "s"))
    configuration = _load(name)
    from ident.studies import record as study

    typer.echo(study.record(configuration, kind=kind, duration=duration, sensor=sensor, seed=seed, out=out))


@app.command()
def fit(
    name: NameOrFile,
    records: Records,
    model: Annotated[str, typer.Option(metavar="MODEL[,MODEL]", help="The models to fit.")],
    out: Out,
    start: Annotated[Start, typer.Option(help="Where simulations start.")] = Start.rest,
    budget: Budget = None,
    starts: Starts = None,
    fixed_delay: Annotated[bool, typer.Option("--fixed-delay", help="Keep the delay at the travel time.")] = False,
    differentiator: Window = None,
    seed: Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Fit reduced models to records."""
    _apart(out, *records)
    _within("--differentiator", differentiator, non_negative("T_w", "s"))
    configuration, chosen = _load(name), _models(model)
    from ident.studies import fit as study

    with progress(quiet=quiet) as report:
        result = study.fit(
            configuration,
            records=tuple(records),
            models=chosen,
            out=out,
            start=start.value,
            budget=budget,
            starts=starts,
            fixed_delay=fixed_delay,
            window=differentiator,
            seed=seed,
            progress=report,
        )
    write_notes(result.notes)
    write_table(result.table)


@app.command()
def verify(
    fit: Annotated[Path, typer.Argument(metavar="FIT.json", help="What fit wrote.")],
    records: Records,
    out: Out,
    start: Annotated[Start | None, typer.Option(help="Where simulations start; as fitted if left out.")] = None,
    differentiator: Window = None,
) -> None:
    """Score fitted models on other records."""
    _apart(out, fit, *records)
    _within("--differentiator", differentiator, non_negative("T_w", "s"))
    from ident.studies import verify as study

    chosen: Literal["rest", "steady"] | None = None if start is None else start.value
    result = study.verify(fit, records=tuple(records), out=out, start=chosen, window=differentiator)
    write_notes(result.notes)
    write_table(result.table)


@app.command()
def step(name: NameOrFile, out: Out, quiet: Quiet = False) -> None:
    """Compare step responses over lengths, weights."""
    configuration = _load(name)
    from ident.studies import step as study

    with progress(quiet=quiet) as report:
        result = study.step(configuration, out=out, progress=report)
    write_table(result.table)
    typer.echo(f"{result.folder} written.")


@app.command()
def crossval(
    name: NameOrFile,
    records: Records,
    out: Out,
    fraction: Annotated[float, typer.Option(help="The part of each record that is fitted.")] = 0.6,
    start: Annotated[Start, typer.Option(help="Where simulations start.")] = Start.steady,
    seed: Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Fit the first part of tows, score the rest."""
    _within("--fraction", fraction, Quantity("f", "-", lower=0.0, upper=1.0, open_lower=True, open_upper=True))
    configuration = _load(name)
    from ident.studies import crossval as study

    with progress(quiet=quiet) as report:
        result = study.crossval(
            configuration,
            records=tuple(records),
            out=out,
            fraction=fraction,
            start=start.value,
            seed=seed,
            progress=report,
        )
    write_table(result.table)
    typer.echo(f"{result.folder} written.")


@app.command()
def gallery(out: Out = Path("reports/gallery"), quiet: Quiet = False) -> None:
    """Make the pages of the built-in configurations."""
    from ident.studies import gallery as study

    with progress(quiet=quiet) as report:
        study.gallery(out=out, progress=report)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code, see `ident.exits`."""
    arguments = list(sys.argv[1:] if argv is None else argv) or ["--help"]
    return exit_code(lambda: _execute(arguments))


def _execute(arguments: list[str]) -> None:
    command = typer.main.get_command(app)
    with command.make_context("cable-ident", arguments) as context:
        command.invoke(context)


def _load(name: str) -> "Configuration":
    from ident.configuration import load

    return load(name)


def _models(names: str) -> tuple[str, ...]:
    from ident.configuration import model_names

    return model_names([name.strip() for name in names.split(",")])


def _within(option: str, value: float | None, quantity: Quantity) -> None:
    if value is not None and not quantity.holds(value):
        unit = "" if quantity.unit == "-" else f" {quantity.unit}"
        raise InvalidInput(f"{option} must be {quantity.bound_text}{unit}, but it is {value:g}{unit}.")


def _apart(out: Path, *inputs: Path) -> None:
    """Refuse to write a result over one of the files it is made from."""
    for path in inputs:
        if path.exists() and out.exists() and out.samefile(path):
            raise InvalidInput(f"--out {out} is one of the files to read; give another name.")


if __name__ == "__main__":
    sys.exit(main())
