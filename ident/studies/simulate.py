"""The reference simulator on a ship's track from a file."""

from pathlib import Path

import numpy as np

from data_synth.records import Record, planar, read_record, write_record
from ident.configuration import Configuration
from ident.places import new_file
from ident.truth import reference_run
from models import spectral
from models.drive import Start
from models.quantity import InvalidInput
from models.spectral import Stepper
from models.trace import Trace

#: A track counts as planar within this distance, or this share of its extent along the plane.
_OFF_PLANE, _OFF_SHARE = 1.0, 0.01


def simulate(
    configuration: Configuration,
    *,
    ship: Path,
    out: Path,
    reference: str,
    tolerance: float | None,
    start: Start,
    stepper: Stepper,
) -> str:
    """Simulate and write the vehicle on the ship file's own times; says in a sentence what was done.

    Raises
    ------
    InvalidInput
        The ship's track leaves its plane, or a file cannot be read or written.
    NumericalFailure
        The simulation fails.
    """
    if reference != "spectral":
        raise InvalidInput(f"The reference must be spectral, but {reference!r} was given.")
    with new_file(out) as temporary:
        record = read_record(ship)
        plane = planar(record)
        extent = float(np.ptp(plane.record.ship.position[:, 0]))
        if plane.off_plane > max(_OFF_PLANE, _OFF_SHARE * extent):
            raise InvalidInput(
                f"{ship}: the spectral simulator is planar, but the ship leaves the vertical plane of its track by "
                f"{plane.off_plane:.3g} m ({extent:.3g} m along it); give a straight track."
            )
        result = reference_run(configuration, plane.record.ship, tolerance=tolerance, stepper=stepper, start=start)
        vehicle = plane.on_map(result.vehicle)
        written = Record(
            name=configuration.name,
            ship=record.ship,
            vehicle=Trace(t=vehicle.t, position=vehicle.position),
            depth=-vehicle.position[:, 2],
            tension=result.vehicle.tension,
        )
        write_record(written, temporary)
    counted = "".join(f" {note}" for note in record.notes)
    return f"{out} written: {describe(result)}{counted}"


def describe(result: spectral.SpectralResult) -> str:
    """Resolution, cost and error of a spectral run, as the end of a sentence."""
    given = result.error is None
    error = "as configured, no error estimate" if given else f"estimated error {result.error:.1e} m/s RMS"
    return f"{result.harmonics} harmonics, {result.stations} stations, {result.steps} steps; {error}."
