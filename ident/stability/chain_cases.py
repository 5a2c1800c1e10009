"""Cases of the link-joint chain: far from the cables, speeds and links that it is usually asked for."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from data_synth.ships.turning import KNOT
from ident.stability.case import Case, Finding
from ident.stability.scenes import Circled, Swung, Towed, changed, scaled, started, system_of
from models import link_joint
from models.current import Current
from models.link_joint import simulation
from models.payout import Payout
from models.quantity import GRAVITY
from models.towed_system import TowedSystem
from models.trace import Trace

_DRAGS = ("normal_drag_coefficient", "tangential_drag_coefficient")
#: Toward +X at the surface, the other way below 380 m.
SHEARED = Current.from_profile([0.0, 250.0, 500.0, 740.0], [1.0, 0.3, -0.5, -0.5])


def mangus(length: float = 740.0) -> TowedSystem:
    """The camera sled MANGUS on a length of its cable [m]."""
    return changed(system_of("mangus-740"), cable={"length": length})


def with_weight(net: float) -> TowedSystem:
    """The sled with another weight in water [N]; its mass stays."""
    system = mangus()
    body = system.parts[0].body
    assert body is not None
    weight = max(body.mass * GRAVITY, net)
    return changed(system, body={"weight": weight, "buoyancy": weight - net})


def with_mass(system: TowedSystem, factor: float) -> TowedSystem:
    """The body with mass and added mass times a factor; its weight in water stays."""
    body = system.parts[0].body
    assert body is not None
    mass, net = factor * body.mass, body.weight_in_water
    weight = max(mass * GRAVITY, net)
    added = {f"added_mass_{axis}": factor * body.added_mass_surge for axis in ("surge", "sway", "heave")}
    return changed(system, body={"mass": mass, "weight": weight, "buoyancy": weight - net, **added})


def without_drag(system: TowedSystem) -> TowedSystem:
    """No drag and no internal loss anywhere."""
    return changed(system, cable=dict.fromkeys((*_DRAGS, "axial_damping"), 0.0), body={"drag_coefficient": 0.0})


def with_drag(factor: float) -> TowedSystem:
    """The sled with all drag coefficients times a factor."""
    return changed(scaled(mangus(), factor, *_DRAGS), body={"drag_coefficient": 1.6 * factor})


def _linked(links: int) -> Towed:
    return Towed(system=mangus(), speed=1.0, duration=7200.0, links=links)


def _stiff(factor: float, duration: float = 7200.0) -> Towed:
    return Towed(system=scaled(mangus(), factor, "axial_stiffness"), speed=1.0, duration=duration)


#: Runs that end in a steady tow, whose figures the continuum gives.
TOWED: dict[str, Callable[[], Towed]] = {
    "chain-length-5": lambda: Towed(system=mangus(5.0), speed=0.5, duration=900.0, sample=1.0),
    "chain-length-11000": lambda: Towed(system=mangus(11_000.0), speed=1.0, duration=110_000.0, sample=20.0),
    **{f"chain-links-{links}": partial(_linked, links) for links in (4, 8, 16, 32, 64)},
    "chain-stiffness-times-1000": partial(_stiff, 1e3),
    "chain-stiffness-times-600": partial(_stiff, 6e2),
    "chain-rubber": partial(_stiff, 1e-3, 14_400.0),
    "chain-speed-10-knots": lambda: Towed(system=mangus(), speed=10.0 * KNOT, duration=7200.0),
    "chain-current-reversed": lambda: Towed(system=replace(mangus(), current=SHEARED), speed=0.5, duration=14_400.0),
    "chain-drag-tenfold": lambda: Towed(system=with_drag(10.0), speed=1.0, duration=36_000.0),
    "chain-weight-zero": lambda: Towed(system=with_weight(0.0), speed=1.0, duration=14_400.0),
    "chain-slightly-buoyant": lambda: Towed(system=with_weight(-100.0), speed=1.0, duration=14_400.0, links=48),
    "chain-payout-double": lambda: Towed(system=mangus(), speed=1.0, duration=14_400.0, final=1480.0),
    "chain-haul-tenth": lambda: Towed(system=mangus(), speed=1.0, duration=7200.0, final=74.0),
    "chain-ship-reversing": lambda: Towed(
        system=with_weight(500.0), speed=2.0, then=-2.0, duration=7200.0, sample=2.0, links=48
    ),
}

CIRCLED = {"chain-full-turn-50": lambda: Circled(system=mangus(), radius=50.0, speed=1.0, turns=20.0)}

#: Free swinging, whose frequencies are closed forms; rubber bounces as a bar with a mass at its end.
SWUNG: dict[str, Callable[[], Swung]] = {
    "chain-drag-zero": lambda: Swung(system=without_drag(mangus()), near=(0.08, 0.35, 0.7), duration=2000.0, step=0.1),
    "chain-vehicle-massless": lambda: Swung(
        system=with_mass(without_drag(mangus()), 0.0), near=(0.2, 0.5, 0.9), duration=2000.0, step=0.1
    ),
    "chain-vehicle-mass-hundredfold": lambda: Swung(
        system=with_mass(without_drag(mangus()), 100.0), near=(0.01,), duration=20_000.0, step=1.0, rise=60.0
    ),
    "chain-rubber-bounce": lambda: Swung(
        system=scaled(without_drag(mangus()), 1e-3, "axial_stiffness"),
        near=(0.11,),
        duration=2000.0,
        step=0.1,
        rise=20.0,
        heave=True,
    ),
}


def at_rest() -> Finding:
    """An hour of a ship that lies still: nothing moves, and the cable hangs by its weight."""
    t = np.linspace(0.0, 3600.0, 361)
    run = link_joint.simulate(mangus(), Trace(t=t, position=np.zeros((t.size, 3))), links=48)
    body = run.vehicle
    assert body.tension is not None
    return Finding(
        figures={
            "moved": float(np.abs(body.position - body.position[0]).max()),
            "depth": -float(body.position[-1, 2]),
            "tension_top": float(body.tension[-1, 0]),
        }
    )


def step_in_a_sample() -> Finding:
    """A step of 0.5 m/s at the first sample on 2500 m: what is left of 300 m after ten minutes."""
    t = np.arange(0.0, 601.0)
    run = link_joint.simulate(system_of("mangus-2500"), Trace.along_x(t, 0.5 * t), start="rest")
    assert run.error is not None
    return Finding(figures={"x": float(run.vehicle.position[-1, 0]), "error": run.error})


def jerked() -> Finding:
    """The top of a steel cable jerked upward by 0.3 m/s within 40 ms: the plateau before the wave is back."""
    system = changed(mangus(), cable={"tangential_drag_coefficient": 0.0, "axial_damping": 0.0})
    speed, rise = 0.3, 0.04
    t = np.arange(0.0, 0.4, 0.002)
    s = t / rise
    lift = speed * rise * np.where(s < 1.0, s**3 - 0.5 * s**4, s - 0.5)
    run = link_joint.simulate(system, Trace.along_x(t, 0.0 * t, lift), links=200, step=5e-4, companion=False).vehicle
    assert run.tension is not None
    plateau = (t > 0.06) & (t < 0.37)
    jump = run.tension[plateau, 0] - run.tension[0, 0]
    return Finding(figures={"lowest_jump": float(jump.min()), "highest_jump": float(jump.max())})


def one_link() -> Finding:
    """A chain of one link."""
    return _answered(links=1)


def too_many_links() -> Finding:
    """A chain of more links than there may be."""
    return _answered(links=5000)


def jumping_track() -> Finding:
    """A ship that is 100 m further on after a second."""
    t = np.arange(0.0, 60.0)
    return _answered(Trace.along_x(t, np.where(t < 30.0, 0.0, 100.0)))


def hauled_to_nothing() -> Finding:
    """More cable hauled in than is out."""
    payout = Payout(t=np.array([10.0, 900.0]), length=np.array([0.0, -800.0]))
    return _answered(started(1.0, 1000.0, 5.0), payout=payout)


def step_budget() -> Finding:
    """Steps of a millisecond for ten minutes, where a run may take twenty thousand; it usually may take more."""
    usual = simulation.STEP_BUDGET
    simulation.STEP_BUDGET = 20_000
    try:
        return _answered(started(1.0, 600.0, 5.0), links=4, step=1e-3)
    finally:
        simulation.STEP_BUDGET = usual


def slack_unasked() -> Finding:
    """The ship reversing under a cable that falls slack, without a word on the links."""
    scene = replace(TOWED["chain-ship-reversing"](), links=None)
    return scene.find()


def _answered(
    ship: Trace | None = None,
    *,
    links: int | None = None,
    step: float | None = None,
    payout: Payout | None = None,
) -> Finding:
    """The end of a run that should not have given one."""
    track = started(1.0, 120.0, 5.0) if ship is None else ship
    run = link_joint.simulate(mangus(), track, links=links, step=step, payout=payout, start="rest", companion=False)
    x, y, z = run.vehicle.position[-1]
    return Finding(figures={"x": float(x), "y": float(y), "z": float(z)}, text=f"the body ends at {x:.4g}, {z:.4g} m")


def _case(name: str, scene: Callable[[], Towed | Circled | Swung]) -> Case:
    return Case(name=name, run=lambda: scene().find(), reduced=name in _REDUCED)


_REDUCED = ("chain-length-5", "chain-links-8", "chain-weight-zero", "chain-stiffness-times-600")

CASES = (
    *(_case(name, scene) for scenes in (TOWED, CIRCLED, SWUNG) for name, scene in scenes.items()),
    Case(name="chain-speed-0", run=at_rest, reduced=True),
    Case(name="chain-step-in-a-sample", run=step_in_a_sample),
    Case(name="chain-jerk", run=jerked, reduced=True),
    Case(name="chain-one-link", run=one_link, reduced=True),
    Case(name="chain-links-5000", run=too_many_links, reduced=True),
    Case(name="chain-jumping-track", run=jumping_track, reduced=True),
    Case(name="chain-hauled-to-nothing", run=hauled_to_nothing, reduced=True),
    Case(name="chain-step-budget", run=step_budget, reduced=True),
    Case(name="chain-slack-unasked", run=slack_unasked),
)
