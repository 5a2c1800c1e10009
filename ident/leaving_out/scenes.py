"""The scenes whose terms are left out one by one: simulations in time by the spectral simulator and by the chain."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from data_synth.records import Record, planar
from data_synth.ships import SpeedChanges, speed_changes
from ident import tows_compared
from ident.configuration import load
from ident.leaving_out.case import NOTHING, Answer, Case, Floats
from models import link_joint, spectral
from models.cable import Cable
from models.current import Current
from models.drive import Start
from models.link_joint.chain import RIGID, build
from models.payout import Payout
from models.spectral.basis import prepare
from models.strumming import amplification
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.trace import Trace
from models.vehicle import Towfish, Vehicle

#: Speed of the current that is left out [m/s], and the shear that keeps its mean; share and rate [m/s] of the haul.
CURRENT, HAUL, RATE = 0.25, 0.02, 0.2
#: Step [s] at which forms are compared that steer their steps by themselves, and the tolerance [m/s] that the
#: iterations follow there.
STEP, _TIGHT = 1.0, 1e-6
#: Links of the chain, and the ship's change of course [degrees].
LINKS, COURSE = 24, 20.0
_JUST_BELOW_HALF = float(np.nextafter(0.5, 0.0))
_POISSON = 0.3


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A tow behind a ship; `tails` are the parts after it."""

    name: str
    tow: Tow
    ship: Trace
    start: Start = "rest"
    tails: tuple[Part, ...] = ()


def step_scene(name: str, scale: float = 1.0) -> Scene:
    """A built-in configuration behind a ship that starts to 0.5 m/s, for 600 s times `scale`."""
    return Scene(name=name, tow=load(name).tow, ship=tows_compared.tows(scale)["step"])


def under_way(name: str, scale: float = 1.0) -> Scene:
    """A built-in configuration with a speed, in its steady tow, behind a ship that gains 0.5 m/s."""
    found = load(name)
    speed, duration = found.tow.speed, 600.0 * scale
    orders = SpeedChanges(duration=duration, sample=1.0, times=(10.0,), speeds=(speed, speed + 0.5), rise=5.0)
    return Scene(name=name, tow=found.tow, ship=speed_changes(orders), start="steady", tails=found.tails)


def changed(tow: Tow, **fields: Any) -> Tow:
    """The tow with other fields of its cable."""
    return replace(tow, cable=replace(tow.cable, **fields))


def currents(tow: Tow) -> tuple[Tow, Tow, Tow]:
    """The tow in a uniform current, in the same as a profile, and in a sheared one of the same mean over the depth."""
    deep = 2.0 * tow.length
    flat, sheared = (CURRENT, CURRENT), (2.0 * CURRENT, 2.0 * CURRENT - 2.0 * CURRENT * deep / tow.length)
    evenly, unevenly = (replace(tow, current=Current.from_profile([0.0, deep], each)) for each in (flat, sheared))
    return replace(tow, current=Current.uniform(CURRENT)), evenly, unevenly


def haul(tow: Tow, ship: Trace, share: float = HAUL) -> Payout:
    """A winch that hauls a share of the cable after a tenth of the record; share 0: one that stands still."""
    first, last = float(ship.t[0]), float(ship.t[-1])
    begin = first + 0.1 * (last - first)
    length = min(share * tow.cable.length, RATE * (last - begin))
    end = begin + length / RATE if length > 0.0 else last
    return Payout(t=np.array([first, begin, end]), length=np.array([0.0, 0.0, -length]))


def without_drag(fish: Towfish) -> tuple[Vehicle, Towfish]:
    """A point and a towfish that nothing turns, both without drag: the towfish has its pitch at zero."""
    flat = replace(fish, drag_coefficient=0.0, added_mass_centre_p=0.0, tow_point_q=0.0, drag_centre_p=0.0)
    return replace(as_point(fish), drag_coefficient=0.0), flat


def as_point(fish: Towfish) -> Vehicle:
    """The towfish as a point with the drag and added mass of its motion along itself."""
    return Vehicle(
        weight_in_water=fish.weight_in_water,
        mass=fish.mass,
        added_mass=fish.added_mass_p,
        area=fish.area_p,
        drag_coefficient=fish.drag_coefficient,
    )


def by_spectral(scene: Scene) -> list[Case]:
    """The terms of the spectral simulator."""
    tow, ship = scene.tow, scene.ship
    harmonics = spectral.simulate(tow, ship).harmonics

    def runs(of: Tow, winch: Payout | None = None, *, fixed: bool = False) -> Callable[[], Answer]:
        stepper: dict[str, Any] = {"stepper": "newmark", "step": STEP, "tolerance": _TIGHT} if fixed else {}
        return lambda: _answer(
            spectral.simulate(of, ship, harmonics=harmonics, winch=winch, companion=False, **stepper).vehicle
        )

    def arrays(of: Tow) -> Callable[[], Sequence[Floats]]:
        def built() -> Sequence[Floats]:
            fields = prepare(of, harmonics=harmonics)
            return [*fields.scalar[:, None], *fields.station, fields.sines, fields.moments, fields.axial, fields.body]

        return built

    def case(term: str, strength: str, off: Tow, zero: Tow, on: Tow, beside: Tow | None = None, note: str = "") -> Case:
        return Case(
            scene=scene.name, simulator="spectral", term=term, strength=strength, off=runs(off), zero=runs(zero),
            on=runs(on), same_off=runs(off, fixed=True), same_zero=runs(zero, fixed=True),
            beside=None if beside is None else runs(beside), built_off=arrays(off), built_on=arrays(on), note=note,
        )  # fmt: skip

    cases = [
        case(term, strength, changed(tow, **off), changed(tow, **zero), changed(tow, **on))
        for term, strength, off, zero, on in of_cable(tow.cable)
    ]
    uniform, flat, sheared = currents(tow)
    nothing = replace(tow, current=Current.uniform(NOTHING))
    cases.append(case("current", f"{CURRENT:g} m/s", tow, nothing, uniform))
    cases.append(case("shear", f"{2 * CURRENT:g} m/s at the surface, none at depth", uniform, flat, sheared))
    still, hauls = haul(tow, ship, 0.0), haul(tow, ship)
    cases.append(
        Case(
            scene=scene.name, simulator="spectral", term="winch", strength=f"{HAUL:.0%} of the cable hauled",
            off=runs(tow), zero=runs(tow, still), on=runs(tow, hauls), same_off=runs(tow, fixed=True),
            same_zero=runs(tow, still, fixed=True), note="a winch is sampled at least every second",
        )
    )  # fmt: skip
    if isinstance(tow.vehicle, Towfish):
        point, level = (replace(tow, vehicle=each) for each in without_drag(tow.vehicle))
        as_it_is = replace(tow, vehicle=as_point(tow.vehicle))
        cases.append(case("pitch", "the towfish as it is", point, level, tow, as_it_is))
    return cases


def by_chain(scene: Scene) -> list[Case]:
    """The terms of the link-joint chain."""
    tow, ship = scene.tow, scene.ship
    system = TowedSystem.from_tow(tow)

    def runs(
        of: TowedSystem, payout: Payout | None = None, track: Trace = ship, *, planar: bool = True
    ) -> Callable[[], Answer]:
        options: dict[str, Any] = {"start": scene.start, "payout": payout, "companion": False, "planar": planar}
        return lambda: _answer(link_joint.simulate(of, track, links=LINKS, **options).vehicle)

    def arrays(of: TowedSystem) -> Callable[[], Sequence[Floats]]:
        return lambda: [each for each in map(np.asarray, build(of, LINKS).chain) if each.ndim and each.dtype == float]

    def case(term: str, strength: str, off: TowedSystem, zero: TowedSystem | None, on: TowedSystem) -> Case:
        return Case(
            scene=scene.name, simulator="link-joint", term=term, strength=strength, off=runs(off), on=runs(on),
            zero=None if zero is None else runs(zero), built_off=arrays(off), built_on=arrays(on),
        )  # fmt: skip

    def of(one: Tow) -> TowedSystem:
        return TowedSystem.from_tow(one)

    cases = [
        case(term, strength, of(changed(tow, **off)), of(changed(tow, **zero)), of(changed(tow, **on)))
        for term, strength, off, zero, on in of_cable(tow.cable)
    ]
    uniform, flat, sheared = (of(each) for each in currents(tow))
    nothing = replace(system, current=Current.uniform(NOTHING))
    cases.append(case("current", f"{CURRENT:g} m/s", system, nothing, uniform))
    cases.append(case("shear", f"{2 * CURRENT:g} m/s at the surface, none at depth", uniform, flat, sheared))
    cases.append(
        Case(
            scene=scene.name, simulator="link-joint", term="winch", strength=f"{HAUL:.0%} of the cable hauled",
            off=runs(system), zero=runs(system, haul(tow, ship, 0.0)), on=runs(system, haul(tow, ship)),
        )
    )  # fmt: skip
    rigid = of(changed(tow, axial_stiffness=RIGID))
    strums = replace(system, strumming=True)
    times = amplification(tow.cable, tow.water_density, strums.strumming_damping)
    by_hand = of(changed(tow, normal_drag_coefficient=times * tow.cable.normal_drag_coefficient))
    cases += [
        replace(
            case("elasticity", f"{tow.cable.axial_stiffness:.3g} N", rigid, None, system),
            note="a rigid link is a constraint, no stiffness of a size: there is no elastic form to compare with",
        ),
        replace(
            case("strumming", f"drag times {times:.2f}", system, system, strums),
            same_off=lambda: {"drag": build(by_hand, LINKS).chain.normal_drag},
            same_zero=lambda: {"drag": build(strums, LINKS).chain.normal_drag},
            note="a factor on the normal drag, put in once: compared are the kernels' drag and that with it by hand",
        ),
        Case(
            scene=scene.name, simulator="link-joint", term="third axis", strength=f"{COURSE:g} degrees of course",
            off=runs(system), zero=runs(system, track=_weaving(ship), planar=False),
            on=runs(system, track=on_course(ship)), beside=runs(system, track=_in_plane(on_course(ship))),
            note=f"compared with all three axes and a ship that weaves by {NOTHING:g} m",
        ),
    ]  # fmt: skip
    if scene.tails:
        whole = TowedSystem.from_tow(tow, scene.tails)
        names = ", ".join(part.name for part in scene.tails)
        cases.append(replace(case("parts behind", names, system, None, whole), note="there is no part of no size"))
    return cases


def on_course(ship: Trace) -> Trace:
    """The same speeds, on a course that changes by `COURSE` half way along."""
    way = ship.position[:, 0] - ship.position[0, 0]
    angle = math.radians(COURSE) / (1.0 + np.exp(-(way - 0.5 * way[-1]) / (0.05 * way[-1])))
    step = np.diff(way, prepend=0.0)
    x, y = np.cumsum(step * np.cos(angle)), np.cumsum(step * np.sin(angle))
    return Trace(t=ship.t, position=np.column_stack([x, y, np.zeros(len(ship))]))


def _in_plane(ship: Trace) -> Trace:
    """The track laid into its own vertical plane."""
    plane = planar(Record(name="track", ship=ship))
    return plane.on_map(plane.record.ship)


def _weaving(ship: Trace) -> Trace:
    """The track with a motion across it that is too small to change a digit, but not zero."""
    position = ship.position.copy()
    position[:, 1] += NOTHING * np.sin(0.1 * ship.t)
    return Trace(t=ship.t, position=position, velocity=None)


Fields = dict[str, Any]


def of_cable(cable: Cable) -> list[tuple[str, str, Fields, Fields, Fields]]:
    """Term, its strength, and the fields of the cable without it, with it at zero, and with it."""
    C_t, tau = cable.tangential_drag_coefficient, cable.axial_damping or 0.01
    values = [
        ("tangential drag", f"C_t {C_t:g}", "tangential_drag_coefficient", (0.0, NOTHING, C_t)),
        ("internal loss", f"{tau:g} s", "axial_damping", (0.0, NOTHING, tau)),
        ("water pressure", f"nu {_POISSON:g}", "poisson_ratio", (0.5, _JUST_BELOW_HALF, _POISSON)),
    ]
    return [(term, told, {name: off}, {name: zero}, {name: on}) for term, told, name, (off, zero, on) in values]


def _answer(vehicle: Trace) -> Answer:
    assert vehicle.velocity is not None
    assert vehicle.tension is not None
    return {"velocity": vehicle.velocity, "position": vehicle.position, "tension": vehicle.tension}
