"""What the options of the command line are called, say and accept; imports nothing that computes."""

from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from models.quantity import InvalidInput, Quantity

if TYPE_CHECKING:
    from ident.configuration import Configuration

T = TypeVar("T")

#: What the simulators are compared on, and what the benchmark measures, unless told.
COMPARED = ("mangus-740", "autec-1200", "mangus-2500")
BENCHED = ("multipart-2200", "autec-1200", "mangus-740", "mangus-2500")


class Start(StrEnum):
    """Where a simulation starts."""

    rest = "rest"
    steady = "steady"


class Reference(StrEnum):
    """The reference simulators."""

    spectral = "spectral"
    link_joint = "link-joint"


class Stepper(StrEnum):
    """The steppers of the spectral simulator."""

    implicit = "implicit"
    newmark = "newmark"
    runge_kutta = "runge-kutta"


NameOrFile = Annotated[str, typer.Argument(metavar="NAME|FILE", help="A built-in configuration, or a file.")]
Records = Annotated[list[Path], typer.Option("--record", metavar="FILE", help="A trace; may be repeated.")]
Out = Annotated[Path, typer.Option(metavar="PATH", help="Where the result goes.")]
Folder = Annotated[Path | None, typer.Option(metavar="DIR", help="Where the result goes; ./NAME if left out.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of all that is drawn.")]
Tolerance = Annotated[float | None, typer.Option(help="RMS velocity error [m/s]; as configured if left out.")]
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


def load(name: str) -> "Configuration":
    """The configuration of a name or a file."""
    from ident import configuration

    return configuration.load(name)


def models(names: str) -> tuple[str, ...]:
    """The models of a list such as ``massless-linear,inertial-4-quadratic``, in full."""
    from ident.configuration import model_names

    return model_names([name.strip() for name in names.split(",")])


def within(option: str, value: float | None, quantity: Quantity) -> None:
    """Refuse a value out of bounds; one left out is none."""
    if value is not None and not quantity.holds(value):
        unit = "" if quantity.unit == "-" else f" {quantity.unit}"
        raise InvalidInput(f"{option} must be {quantity.bound_text}{unit}, but it is {value:g}{unit}.")


def apart(out: Path, *inputs: Path) -> None:
    """Refuse to write a result over one of the files it is made from."""
    for path in inputs:
        if path.exists() and out.exists() and out.samefile(path):
            raise InvalidInput(f"--out {out} is one of the files to read; give another name.")


def listed(option: str, text: str | None, read: Callable[[str], T]) -> tuple[T, ...]:
    """The values of a list such as ``250,500``; none of an option left out."""
    try:
        return () if text is None else tuple(read(part) for part in text.split(","))
    except ValueError as error:
        raise InvalidInput(f"{option} needs numbers joined by commas, but it is {text!r}.") from error
