"""The records of a run: made with the reference simulator to identify on, and with a changed system to verify on."""

import math
from dataclasses import dataclass, replace

import numpy as np

from data_synth import inputs
from data_synth.sensors import measure
from data_synth.ships import standard_input
from ident.configuration import Configuration
from models import fine_chain, spectral
from models.current import Current
from models.drive import Start
from models.statics import static_shape
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Towfish

#: Largest angle of the static cable from the vertical for which a chain of small angles may stand for the truth [rad].
LARGEST_SLANT = math.radians(15.0)

#: Streams of random numbers: each use has its own, so that one does not move another.
INPUT, COEFFICIENTS, SENSOR, SEARCH = range(4)


def stream(seed: int, use: int) -> np.random.Generator:
    """The generator of one use of a run's seed."""
    return np.random.default_rng([seed, use])


def start_of(tow: Tow) -> Start:
    """How models start: in their own steady shape where the scene is about a steady tow, else at rest."""
    return "steady" if tow.speed != 0.0 else "rest"


def towed(tow: Tow, ship: Trace) -> Trace:
    """A motion about the steady tow: the tow's own way added to the ship's."""
    if tow.speed == 0.0:
        return ship
    position = ship.position.copy()
    position[:, 0] += tow.speed * (ship.t - ship.t[0])
    return Trace(t=ship.t, position=position)


def identification_ship(configuration: Configuration, seed: int) -> Trace:
    """The standard input of T 6.1."""
    return towed(configuration.tow, standard_input(configuration.input, stream(seed, INPUT)))


def reference_run(
    configuration: Configuration,
    ship: Trace,
    *,
    tolerance: float | None = None,
    stepper: spectral.Stepper = "implicit",
    start: Start = "rest",
    winch: spectral.Winch | None = None,
) -> spectral.SpectralResult:
    """The spectral simulator with the configuration's resolution, and its tolerance where none is given."""
    settings = configuration.spectral
    return spectral.simulate(
        configuration.tow,
        ship,
        tolerance=settings.tolerance if tolerance is None else tolerance,
        harmonics=settings.harmonics,
        stations=settings.stations,
        step=settings.step,
        stepper=stepper,
        start=start,
        winch=winch,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Verification:
    """The verification records of a run: ship, true vehicle, and the truth in a current.

    `changes` are the factors on the drag and mass coefficients, `links` those of the fine chain or ``None`` where the
    spectral simulator stands in, `slant` the static cable's largest angle from the vertical [rad], `error` the truth's
    own error estimate [m/s], ``None`` where its resolution was given.
    """

    ship: Trace
    truth: Trace
    in_current: Trace
    changes: dict[str, float]
    links: int | None
    slant: float
    error: float | None


def verification(configuration: Configuration, seed: int) -> Verification:
    """Recorded-style traces of T 6.2 from a fine inertial chain with changed coefficients.

    The chain hangs: where the static cable leans by more than 15 degrees, or its body pitches, the spectral simulator
    with the same changes takes its place.

    Every drag and added-mass coefficient is raised or lowered by the configured share, the sign drawn from the seed.
    """
    settings = configuration.verification
    ship = towed(configuration.tow, inputs.ship_trace(configuration.manoeuvre, stream(seed, INPUT)))
    rng = stream(seed, COEFFICIENTS)
    names = ("cable normal drag", "cable added mass", "vehicle drag", "vehicle added mass")
    signs = rng.choice([-1.0, 1.0], len(names))
    changes = dict(zip(names, (1.0 + settings.coefficient_change * signs).tolist(), strict=True))
    changed = _changed(configuration.tow, changes)
    flowing = replace(changed, current=_added(changed.current, settings.current_speed))
    slant = max(float(np.abs(static_shape(tow).phi - 0.5 * math.pi).max()) for tow in (changed, flowing))
    links = settings.links if slant <= LARGEST_SLANT and not isinstance(changed.vehicle, Towfish) else None
    error: float | None
    if links is not None:
        chain = fine_chain.simulate(changed, ship, links=links)
        truth, error = chain.vehicle, chain.error
        in_current = fine_chain.simulate(flowing, ship, links=links).vehicle
    else:
        reference = reference_run(replace(configuration, tow=changed), ship)
        truth, error = reference.vehicle, reference.error
        in_current = reference_run(replace(configuration, tow=flowing), ship).vehicle
    return Verification(
        ship=ship,
        truth=truth,
        in_current=in_current,
        changes=changes,
        links=links,
        slant=slant,
        error=error,
    )


def fixes(configuration: Configuration, vehicle: Trace, seed: int) -> Trace:
    """What the configured sensor sees of a vehicle."""
    return measure(vehicle, configuration.sensor, stream(seed, SENSOR))


def _changed(tow: Tow, factor: dict[str, float]) -> Tow:
    cable = replace(
        tow.cable,
        normal_drag_coefficient=tow.cable.normal_drag_coefficient * factor["cable normal drag"],
        added_mass=tow.cable.added_mass * factor["cable added mass"],
    )
    drag, mass = factor["vehicle drag"], factor["vehicle added mass"]
    body = tow.vehicle
    if isinstance(body, Towfish):
        vehicle: Towfish = replace(
            body,
            drag_coefficient=body.drag_coefficient * drag,
            added_mass_p=body.added_mass_p * mass,
            added_mass_q=body.added_mass_q * mass,
        )
        return replace(tow, cable=cable, vehicle=vehicle)
    point = replace(body, drag_coefficient=body.drag_coefficient * drag, added_mass=body.added_mass * mass)
    return replace(tow, cable=cable, vehicle=point)


def _added(current: Current | None, speed: float) -> Current:
    """A current with the same speed more at every depth."""
    if current is None:
        return Current.uniform(speed)
    return Current(depth=current.depth, speed=current.speed + speed)
