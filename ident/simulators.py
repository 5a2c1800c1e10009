"""The two reference simulators on a ship's track: which one it needs, the record of its answer, and how good it is."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from data_synth.records import PlanarRecord, Record, planar
from ident.configuration import Configuration
from ident.truth import reference_run
from models import link_joint
from models.drive import Start
from models.link_joint import LinkJointResult, SlackEvent
from models.payout import Payout
from models.quantity import InvalidInput
from models.spectral import DepthWinch, SpectralResult, Stepper, Winch
from models.trace import Trace

Reference = Literal["spectral", "link-joint"]

#: A track counts as planar within this distance, or this share of its extent along the plane.
_OFF_PLANE, _OFF_SHARE = 1.0, 0.01
#: A ship that begins faster than this is under way [m/s].
_UNDER_WAY = 0.05
#: Slack events that a sentence tells one by one.
_TOLD = 3


def needed(configuration: Configuration, ship: Record) -> Reference:
    """The spectral simulator for one uniform part behind a ship that keeps to a plane, the chain for the rest."""
    several = configuration.tails or configuration.tow.sections
    return "link-joint" if several or _excess(planar(ship)) > 0.0 else "spectral"


def answer(
    configuration: Configuration,
    ship: Record,
    reference: Reference,
    *,
    links: int | None = None,
    tolerance: float | None = None,
    start: Start | None = None,
    stepper: Stepper | None = None,
    winch: Winch | None = None,
) -> tuple[Record, str]:
    """The record of the ship and of all that it tows, and in words how it was made.

    Parameters
    ----------
    links
        Of the link-joint chain's first part; as configured when left out.
    tolerance
        RMS velocity error [m/s]; as configured for the simulator when left out.
    start
        Left out, the chain is in the steady tow of a ship that is under way from the first; else all starts at rest.
    stepper
        Of the spectral simulator.

    Raises
    ------
    InvalidInput
        The simulator has no such setting, cannot follow the track, or has no such winch.
    NumericalFailure
        The simulation fails.
    """
    if reference == "spectral":
        if links is not None:
            raise InvalidInput("The spectral simulator has no links; leave out --links or take --reference link-joint.")
        return _by_spectral(configuration, ship, tolerance, start or "rest", stepper or "implicit", winch)
    if stepper is not None:
        raise InvalidInput(
            "The link-joint simulator has one stepper of its own; leave out --stepper or take --reference spectral."
        )
    if isinstance(winch, DepthWinch):
        raise InvalidInput(
            "The winch that holds a depth works with the spectral simulator alone; take the input winch, or a planar "
            "input with --reference spectral."
        )
    under_way = float(np.linalg.norm(ship.ship.spline(ship.t[0], 1)[:2])) > _UNDER_WAY
    own: Start = "steady" if under_way else "rest"
    return _by_chain(configuration, ship, links, tolerance, start or own, winch)


def _by_spectral(
    configuration: Configuration,
    ship: Record,
    tolerance: float | None,
    start: Start,
    stepper: Stepper,
    winch: Winch | None,
) -> tuple[Record, str]:
    plane = planar(ship)
    if _excess(plane) > 0.0:
        raise InvalidInput(
            f"{ship.name}: the spectral simulator is planar, but the ship leaves the vertical plane of its track by "
            f"{plane.off_plane:.3g} m ({_extent(plane):.3g} m along it); take --reference link-joint."
        )
    result = reference_run(
        configuration, plane.record.ship, tolerance=tolerance, stepper=stepper, start=start, winch=winch
    )
    words = f"the spectral simulator with {describe_spectral(result)}"
    if configuration.tails:
        words += f" It tows the first part alone, without {', '.join(part.name for part in configuration.tails)}."
    vehicle = plane.on_map(result.vehicle)
    return recorded(configuration.name, ship.ship, [vehicle]), words


def _by_chain(
    configuration: Configuration,
    ship: Record,
    links: int | None,
    tolerance: float | None,
    start: Start,
    payout: Payout | None,
) -> tuple[Record, str]:
    settings = configuration.link_joint
    result = link_joint.simulate(
        configuration.system,
        ship.ship,
        links=settings.links if links is None else links,
        tolerance=settings.tolerance if tolerance is None else tolerance,
        step=settings.step,
        start=start,
        payout=payout,
    )
    words = f"the link-joint simulator with {describe_chain(result)}"
    return recorded(configuration.name, ship.ship, ends(configuration, result)), words


def ends(configuration: Configuration, result: LinkJointResult) -> tuple[Trace, ...]:
    """The vehicle and the lower ends of the tails; the vehicle's tensions are those of the whole cable above it."""
    top, vehicle = result.bodies[0].tension, result.vehicle.tension
    assert top is not None
    assert vehicle is not None
    whole = replace(result.vehicle, tension=np.column_stack([top[:, 0], vehicle[:, 1]]))
    return whole, *result.bodies[1 + len(configuration.tow.sections) :]


def recorded(name: str, ship: Trace, bodies: Sequence[Trace]) -> Record:
    """The record of a ship and what it tows, on the same times; depth and tensions are those of the first part."""
    first, *others = (Trace(t=ship.t, position=body.position) for body in bodies)
    return Record(
        name=name,
        ship=ship,
        vehicle=first,
        depth=-first.position[:, 2],
        tension=bodies[0].tension,
        bodies=tuple(others),
    )


def describe_spectral(result: SpectralResult) -> str:
    """Resolution, cost and error of a spectral run, as the end of a sentence."""
    given = result.error is None
    error = "no error estimate" if given else f"estimated error {result.error:.1e} m/s RMS"
    leans = f"the cable turns by up to {math.degrees(result.largest_angle):.2g} degrees from its static shape"
    return f"{result.harmonics} harmonics, {result.stations} stations, {result.steps} steps; {error}; {leans}."


def describe_chain(result: LinkJointResult) -> str:
    """Resolution, cost, error, balance and slack of a link-joint run, as the end of a sentence."""
    links = " + ".join(map(str, result.links))
    return (
        f"{links} links, {result.steps} steps; estimated error {result.error:.1e} m/s RMS, energy balanced to "
        f"{result.imbalance:.1e} of the work turned over; {slack_in_words(result.slack)}."
    )


def slack_in_words(events: Sequence[SlackEvent]) -> str:
    """When and where the cable went slack, and the peak when it was taut again, the first few one by one."""
    if not events:
        return "no link goes slack"
    told = [
        f"{event.part} at {event.t:.1f} s, {event.s:.0f} m below its upper end, "
        + (f"taut at {event.until:.1f} s with {event.peak:.0f} N" if np.isfinite(event.until) else "to the end")
        for event in events[:_TOLD]
    ]
    more = [f"{len(events) - _TOLD} more"] if len(events) > _TOLD else []
    return f"{len(events)} slack event{'' if len(events) == 1 else 's'}: {'; '.join([*told, *more])}"


def _extent(plane: PlanarRecord) -> float:
    return float(np.ptp(plane.record.ship.position[:, 0]))


def _excess(plane: PlanarRecord) -> float:
    """How much farther the ship is off the plane of its track than counts as planar [m]."""
    return plane.off_plane - max(_OFF_PLANE, _OFF_SHARE * _extent(plane))
