"""The command line: parse, call, print. Whatever computes is imported by the command that needs it."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal

import typer

from ident import frequency_cli, measuring_cli, options
from ident.exits import exit_code
from ident.options import (
    Budget,
    Folder,
    Models,
    NameOrFile,
    Out,
    Quiet,
    Records,
    Reference,
    Seed,
    Start,
    Starts,
    Stepper,
    Tolerance,
    Window,
)
from ident.terminal import progress, write_notes, write_table
from models.quantity import InvalidInput, Quantity, non_negative, positive

app = typer.Typer(
    name="cable-ident",
    help="Small models of towed cables and their vehicles for controllers, and how far to trust them.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"cable-ident {version('cable-ident')}")
        raise typer.Exit


@app.callback()
def common(
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
        length = document["cable"]["length_m"] + sum(section["length_m"] for section in document.get("section", []))
        fish = document.get("towfish")
        weight = fish["weight_N"] - fish["buoyancy_N"] if fish else document["vehicle"]["weight_in_water_N"]
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
    configuration = options.load(name)
    folder = out if out is not None else Path(configuration.name)
    chosen = None if models is None else options.models(models)
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
    links: Annotated[
        int | None, typer.Option(min=4, help="Links of the chain's first part; as configured if left out.")
    ] = None,
    tolerance: Tolerance = None,
    start: Annotated[
        Start | None, typer.Option(help="Where it starts; if left out, the chain as the ship does, else at rest.")
    ] = None,
    stepper: Annotated[Stepper | None, typer.Option(help="The time stepper, of the spectral simulator.")] = None,
) -> None:
    """Simulate what is towed under a ship's motion."""
    from ident.settings import SpectralSettings
    from models.quantity import quantities

    options.within("--tolerance", tolerance, quantities(SpectralSettings)["tolerance"])
    options.apart(out, ship)
    configuration = options.load(name)
    from ident.studies import simulate as study

    typer.echo(
        study.simulate(
            configuration,
            ship=ship,
            out=out,
            reference=reference.value,
            links=links,
            tolerance=tolerance,
            start=None if start is None else start.value,
            stepper=None if stepper is None else stepper.value,
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
            help="standard, recorded-style, sinusoids, ramps, first-order, step, straight, full-turn, u-turn, "
            "speed-changes, zig-zag, waypoints, sea, winch, winch-depth, a ship trace, or several joined by +.",
        ),
    ],
    out: Out,
    duration: Annotated[float | None, typer.Option(help="How long [s]; as configured if left out.")] = None,
    sensor: Annotated[bool, typer.Option("--sensor", help="What the sensor sees, not the truth.")] = False,
    reference: Annotated[
        Reference | None, typer.Option(help="The simulator; the one that the input needs if left out.")
    ] = None,
    seed: Seed = 0,
) -> None:
    """Make a synthetic record of ship and vehicle."""
    options.within("--duration", duration, positive("T", "s"))
    configuration = options.load(name)
    from ident.studies import record as study

    typer.echo(
        study.record(
            configuration,
            kind=kind,
            duration=duration,
            sensor=sensor,
            seed=seed,
            out=out,
            reference=None if reference is None else reference.value,
        )
    )


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
    options.apart(out, *records)
    options.within("--differentiator", differentiator, non_negative("T_w", "s"))
    configuration, chosen = options.load(name), options.models(model)
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
    options.apart(out, fit, *records)
    options.within("--differentiator", differentiator, non_negative("T_w", "s"))
    from ident.studies import verify as study

    chosen: Literal["rest", "steady"] | None = None if start is None else start.value
    result = study.verify(fit, records=tuple(records), out=out, start=chosen, window=differentiator)
    write_notes(result.notes)
    write_table(result.table)


@app.command()
def step(name: NameOrFile, out: Out, quiet: Quiet = False) -> None:
    """Compare step responses over lengths, weights."""
    configuration = options.load(name)
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
    options.within("--fraction", fraction, Quantity("f", "-", lower=0.0, upper=1.0, open_lower=True, open_upper=True))
    configuration = options.load(name)
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
def turn(
    name: NameOrFile,
    out: Out,
    speed: Annotated[str | None, typer.Option(metavar="SPEED[,SPEED]", help="Such as '6 kn' or '3 m/s'.")] = None,
    radius: Annotated[str | None, typer.Option(metavar="M[,M]", help="Radii of the turn [m].")] = None,
    turns: Annotated[str | None, typer.Option(metavar="N[,N]", help="Circles of a full turn.")] = None,
    u_turn: Annotated[bool, typer.Option("--u-turn", help="Half a circle, then straight back.")] = False,
    parts: Annotated[str | None, typer.Option(metavar="N[,N]", help="Parts that are towed; all if left out.")] = None,
    length: Annotated[str | None, typer.Option(metavar="M[,M]", help="Lengths of the main cable [m].")] = None,
    heave_period: Annotated[
        str | None, typer.Option(metavar="S[,S]", help="Also a straight tow under a metre of heave [s].")
    ] = None,
    claims: Annotated[bool, typer.Option("--claims", help="The sweeps that answer the paper's claims.")] = False,
    quiet: Quiet = False,
) -> None:
    """Turn with one to three parts: heave, depth, tension."""
    from ident.speeds import parse_speeds

    given = (speed, radius, turns, parts, length, heave_period)
    if claims and (u_turn or any(text is not None for text in given)):
        raise InvalidInput("--claims has sweeps of its own; leave out the options of the turn.")
    speeds = () if speed is None else parse_speeds(speed)
    radii = options.listed("--radius", radius, float)
    circles = options.listed("--turns", turns, float)
    counts = options.listed("--parts", parts, int)
    lengths = options.listed("--length", length, float)
    periods = options.listed("--heave-period", heave_period, float)
    configuration = options.load(name)
    from ident.studies import turn as study

    with progress(quiet=quiet) as report:
        if claims:
            result = study.answer_claims(configuration, out=out, progress=report)
        else:
            result = study.turn(
                configuration,
                speeds=speeds,
                radii=radii,
                turns=circles,
                u_turn=u_turn,
                parts=counts,
                lengths=lengths,
                heave_periods=periods,
                out=out,
                progress=report,
            )
    write_notes(result.notes)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")


frequency_cli.add_to(app)
measuring_cli.add_to(app)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code, see `ident.exits`."""
    arguments = list(sys.argv[1:] if argv is None else argv) or ["--help"]
    return exit_code(lambda: _execute(arguments))


def _execute(arguments: list[str]) -> None:
    command = typer.main.get_command(app)
    with command.make_context("cable-ident", arguments) as context:
        command.invoke(context)


if __name__ == "__main__":
    sys.exit(main())
