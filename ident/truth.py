"""The records of a run: made with the reference simulator to identify on, and with a changed system to verify on."""

from dataclasses import dataclass, replace

import numpy as np

from data_synth import inputs
from data_synth.sensors import measure
from data_synth.ships import standard_input
from ident.configuration import Configuration
from models import link_joint, spectral
from models.current import Current
from models.drive import Start
from models.link_joint import LinkJointResult
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.trace import Trace

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
    """The verification records of a run: the ship, the run that is the truth, and the vehicle in a current.

    `changes` are the factors on the drag and added-mass coefficients.
    """

    ship: Trace
    chain: LinkJointResult
    in_current: Trace
    changes: dict[str, float]

    @property
    def truth(self) -> Trace:
        """The vehicle as it truly moves."""
        return self.chain.vehicle

    @property
    def changed(self) -> str:
        """The changes in words."""
        return ", ".join(f"{name} {100.0 * (factor - 1.0):+.0f} %" for name, factor in self.changes.items())


def verification(configuration: Configuration, seed: int) -> Verification:
    """Recorded-style traces of T 6.2 from the link-joint chain with changed coefficients, parts behind included.

    The drag and added-mass coefficients of all cables and of all bodies are raised or lowered by the configured share,
    the signs drawn from the seed.
    """
    settings = configuration.verification
    ship = towed(configuration.tow, inputs.ship_trace(configuration.manoeuvre, stream(seed, INPUT)))
    rng = stream(seed, COEFFICIENTS)
    names = ("cable normal drag", "cable added mass", "vehicle drag", "vehicle added mass")
    signs = rng.choice([-1.0, 1.0], len(names))
    changes = dict(zip(names, (1.0 + settings.coefficient_change * signs).tolist(), strict=True))
    own = configuration.system
    system = replace(own, parts=tuple(_changed(part, changes) for part in own.parts))
    flowing = replace(system, current=_added(system.current, settings.current_speed))

    def run(tow: TowedSystem, companion: bool) -> LinkJointResult:
        return link_joint.simulate(
            tow, ship, links=settings.links, tolerance=settings.tolerance, start="rest", companion=companion
        )

    return Verification(ship=ship, chain=run(system, True), in_current=run(flowing, False).vehicle, changes=changes)


def fixes(configuration: Configuration, vehicle: Trace, seed: int) -> Trace:
    """What the configured sensor sees of a vehicle."""
    return measure(vehicle, configuration.sensor, stream(seed, SENSOR))


def _changed(part: Part, factor: dict[str, float]) -> Part:
    cable = replace(
        part.cable,
        normal_drag_coefficient=part.cable.normal_drag_coefficient * factor["cable normal drag"],
        added_mass=part.cable.added_mass * factor["cable added mass"],
    )
    if part.body is None:
        return replace(part, cable=cable)
    mass = {
        name: getattr(part.body, name) * factor["vehicle added mass"]
        for name in ("added_mass_surge", "added_mass_sway", "added_mass_heave")
    }
    drag = part.body.drag_coefficient * factor["vehicle drag"]
    return replace(part, cable=cable, body=replace(part.body, drag_coefficient=drag, **mass))


def _added(current: Current | None, speed: float) -> Current:
    """A current with the same speed more at every depth."""
    return Current.uniform(speed) if current is None else current.plus(speed)
