"""The commands of the frequency domain: response, sea and compensator; parse, call, print as `ident.cli` does."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ident import options
from ident.options import NameOrFile, Out, Quiet
from ident.terminal import progress, write_notes, write_table
from models.quantity import Quantity, non_negative, positive


class Direction(StrEnum):
    """What the cable's top is moved along."""

    axial = "axial"
    heave = "heave"
    surge = "surge"


class DragForm(StrEnum):
    """The forms of the linearised equations."""

    consistent = "consistent"
    printed = "printed"


class Solver(StrEnum):
    """The solvers of the same equations."""

    stable = "stable"
    product = "product"


Drag = Annotated[
    DragForm,
    typer.Option(help="With the drag of the moved angle, of shear and coupled at the body, or as H prints it."),
]
Segments = Annotated[int | None, typer.Option(min=4, help="Of the cable; as the error asks for if left out.")]
Rao = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", help="The vessel: omega_rad_s, heave_m_m, heave_phase_rad, surge_m_m, surge_phase_rad."
    ),
]


def response(
    name: NameOrFile,
    out: Out,
    amplitude: Annotated[float, typer.Option(help="Of the motion of the cable's top [m].")] = 1.0,
    low: Annotated[float, typer.Option("--from", metavar="W", help="Lowest frequency [rad/s].")] = 0.05,
    high: Annotated[float, typer.Option("--to", metavar="W", help="Highest frequency [rad/s].")] = 1.5,
    points: Annotated[int, typer.Option(min=3, max=20_000, help="Frequencies.")] = 100,
    direction: Annotated[
        Direction, typer.Option(help="Of the top's motion; axial is along the cable.")
    ] = Direction.axial,
    drag: Drag = DragForm.consistent,
    solver: Annotated[Solver, typer.Option(help="The product of matrices is H's own.")] = Solver.stable,
    segments: Segments = None,
    depth: Annotated[
        float | None, typer.Option(help="Of the vehicle [m]; the upper cable gets the length for it.")
    ] = None,
    tolerance: Annotated[float, typer.Option(help="H's norm of the last change of the drag; H takes 1e-4.")] = 1e-10,
    quiet: Quiet = False,
) -> None:
    """Respond to sinusoidal motion of the cable's top."""
    options.within("--amplitude", amplitude, Quantity("a", "m", 0.0, 1000.0, open_lower=True))
    options.within("--from", low, positive("omega", "rad/s"))
    options.within("--to", high, positive("omega", "rad/s"))
    options.within("--depth", depth, positive("z", "m"))
    options.within("--tolerance", tolerance, Quantity("eps", "-", 0.0, 1.0, open_lower=True, open_upper=True))
    configuration = options.load(name)
    from ident.studies import response as study

    with progress(quiet=quiet) as report:
        result = study.response(
            configuration,
            amplitude=amplitude,
            low=low,
            high=high,
            points=points,
            direction=direction.value,
            drag=drag.value,
            solver=solver.value,
            segments=segments,
            depth=depth,
            tolerance=tolerance,
            out=out,
            progress=report,
        )
    write_notes(result.notes)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")


def sea(
    name: NameOrFile,
    spectrum: Annotated[
        str, typer.Option(metavar="bretschneider|jonswap|FILE", help="A form, or a measured spectrum.")
    ],
    out: Out,
    hs: Annotated[float | None, typer.Option("--hs", metavar="M", help="Significant height [m].")] = None,
    tp: Annotated[float | None, typer.Option("--tp", metavar="S", help="Peak period [s].")] = None,
    record: Annotated[str | None, typer.Option(help="Which record of a file of many; the highest if left out.")] = None,
    rao: Rao = None,
    direction: Annotated[
        Direction, typer.Option(help="Of the top's motion, of that a wave or the vessel makes.")
    ] = Direction.heave,
    duration: Annotated[float, typer.Option(help="Of the sea, for the extremes [s].")] = 10_800.0,
    points: Annotated[int, typer.Option(min=8, max=20_000, help="Frequencies.")] = 200,
    segments: Segments = None,
    drag: Drag = DragForm.consistent,
    time_domain: Annotated[bool, typer.Option("--time-domain", help="Also a drawn sea through the chain.")] = False,
    seed: options.Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Respond to a random sea: motions, tensions, slack."""
    options.within("--hs", hs, Quantity("H_s", "m", 0.0, 50.0, open_lower=True))
    options.within("--tp", tp, positive("T_p", "s"))
    options.within("--duration", duration, positive("T", "s"))
    configuration = options.load(name)
    from ident.studies import sea as study

    with progress(quiet=quiet) as report:
        result = study.sea(
            configuration,
            spectrum=spectrum,
            height=hs,
            peak_period=tp,
            record=record,
            rao=rao,
            direction=direction.value,
            duration=duration,
            points=points,
            segments=segments,
            drag=drag.value,
            time_domain=time_domain,
            seed=seed,
            out=out,
            progress=report,
        )
    write_notes(result.notes)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")


def compensator(
    name: NameOrFile,
    sea_state: Annotated[int, typer.Option(help="5 or 6.")],
    out: Out,
    stroke: Annotated[float | None, typer.Option(help="Between the stops [m]; as configured if left out.")] = None,
    rao: Rao = None,
    segments: Segments = None,
    time_domain: Annotated[bool, typer.Option("--time-domain", help="Also a drawn sea through the chain.")] = False,
    seed: options.Seed = 0,
    quiet: Quiet = False,
) -> None:
    """Tune a passive heave compensator for a sea state."""
    options.within("--stroke", stroke, non_negative("R_max", "m"))
    configuration = options.load(name)
    from ident.studies import compensator as study

    with progress(quiet=quiet) as report:
        result = study.compensator(
            configuration,
            sea_state=sea_state,
            stroke=stroke,
            rao=rao,
            segments=segments,
            time_domain=time_domain,
            seed=seed,
            out=out,
            progress=report,
        )
    write_notes(result.notes)
    write_table(result.table)
    typer.echo(f"{result.folder / 'report.md'} written.")


def add_to(app: typer.Typer) -> None:
    """Give the commands to the program."""
    for command in (response, sea, compensator):
        app.command()(command)
