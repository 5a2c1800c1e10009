"""Scenes of the chain's cases: a tow, the ship's motion, and what of the run is compared with an independent figure."""

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from data_synth.ships.motion import eased
from data_synth.ships.path import level
from ident.configuration import load
from ident.stability.case import Finding
from models import link_joint
from models.link_joint import LinkJointResult
from models.payout import Payout
from models.towed_system import TowedSystem
from models.trace import Trace

Floats = NDArray[np.float64]


@cache
def system_of(name: str) -> TowedSystem:
    """The first part of a built-in configuration, at rest."""
    return replace(load(name).system_of(1), speed=0.0)


def changed(
    system: TowedSystem, *, cable: dict[str, float] | None = None, body: dict[str, float] | None = None
) -> TowedSystem:
    """The system with other fields of its first cable and of the body at its end."""
    first = system.parts[0]
    assert first.body is not None
    part = replace(first, cable=replace(first.cable, **(cable or {})), body=replace(first.body, **(body or {})))  # type: ignore[arg-type]
    return replace(system, parts=(part, *system.parts[1:]))


def scaled(system: TowedSystem, factor: float, *names: str) -> TowedSystem:
    """The system with some fields of its first cable times a factor."""
    cable = system.parts[0].cable
    return changed(system, cable={name: factor * getattr(cable, name) for name in names})


def started(speed: float, duration: float, sample: float, *, then: float | None = None) -> Trace:
    """The ship along +X from rest to a speed [m/s] within a minute; at half of the time within a minute to another."""
    t: Floats = sample * np.arange(round(duration / sample) + 1, dtype=float)
    orders, levels = [0.0], [speed]
    if then is not None:
        orders, levels = [*orders, 0.5 * duration], [*levels, then]
    x, v = eased(t, orders, levels, 60.0)
    nothing = np.zeros(t.size)
    return level(t, np.column_stack([x, nothing]), np.column_stack([v, nothing]))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Towed:
    """From rest to a speed toward +X, held until the tow is steady; `final` is the length of cable at the end [m].

    `links` steers the resolution, or, left out, the tolerance of the simulator does.
    """

    system: TowedSystem
    speed: float
    duration: float
    sample: float = 5.0
    then: float | None = None
    final: float | None = None
    links: int | None = None
    tolerance: float = 1e-3

    @property
    def last_speed(self) -> float:
        """The speed that the steady tow has [m/s]."""
        return self.speed if self.then is None else self.then

    @property
    def last_system(self) -> TowedSystem:
        """The system with the cable that is out at the end."""
        return self.system if self.final is None else changed(self.system, cable={"length": self.final})

    def simulate(self) -> LinkJointResult:
        """The run, its winch between a tenth and six tenths of the time."""
        payout = None
        if self.final is not None:
            change = self.final - self.system.parts[0].cable.length
            payout = Payout(t=self.duration * np.array([0.1, 0.6]), length=np.array([0.0, change]))
        ship = started(self.speed, self.duration, self.sample, then=self.then)
        return link_joint.simulate(
            self.system, ship, links=self.links, tolerance=self.tolerance, start="rest", payout=payout
        )

    def find(self) -> Finding:
        """Trail, depth and tension at the end, and the run's own error."""
        return steady_figures(self.simulate(), self)


def steady_figures(run: LinkJointResult, scene: Towed) -> Finding:
    """What the end of a run has of a steady tow behind a ship along X."""
    body = run.vehicle
    ship = started(scene.speed, scene.duration, scene.sample, then=scene.then)
    assert body.tension is not None
    assert run.error is not None
    return Finding(
        figures={
            "trail": float(ship.position[-1, 0] - body.position[-1, 0]),
            "depth": -float(body.position[-1, 2]),
            "tension_top": float(body.tension[-1, 0]),
            "error": run.error,
        },
        text=_told(run),
    )


def _told(run: LinkJointResult) -> str:
    slack = f", {len(run.slack)} slack events" if run.slack else ""
    return f"{run.links[0]} links, {run.steps} steps, energy unexplained {run.imbalance:.2g}{slack}"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Circled:
    """Round and round on one circle until the tow is steady in the ship's turning frame."""

    system: TowedSystem
    radius: float
    speed: float
    turns: float
    tolerance: float = 1e-3

    def find(self) -> Finding:
        """Radius and depth of the body, tension at the ship."""
        turn = 2.0 * math.pi * self.radius / self.speed
        t = np.linspace(0.0, self.turns * turn, round(120 * self.turns) + 1)
        angle = self.speed / self.radius * t
        xy = self.radius * np.column_stack([np.sin(angle), 1.0 - np.cos(angle)])
        ship = level(t, xy, self.speed * np.column_stack([np.cos(angle), np.sin(angle)]))
        run = link_joint.simulate(self.system, ship, tolerance=self.tolerance)
        body = run.vehicle
        assert body.tension is not None
        assert run.error is not None
        x, y, z = body.position[-1]
        return Finding(
            figures={
                "radius": math.hypot(x, y - self.radius),
                "depth": -float(z),
                "tension_top": float(body.tension[-1, 0]),
                "error": run.error,
            },
            text=_told(run),
        )


def smooth(t: Floats) -> Floats:
    """From 0 to 1 over 0 to 1, with two continuous derivatives."""
    t = np.clip(t, 0.0, 1.0)
    return np.asarray(t**3 * (10.0 - 15.0 * t + 6.0 * t**2))


def strongest(t: Floats, x: Floats, near: float) -> float:
    """The frequency [rad/s] within 15 % of `near` at which the windowed record is strongest."""
    weighted = np.hanning(t.size) * (x - x.mean())
    low, high = 0.85 * near, 1.15 * near
    for _ in range(6):
        grid = np.linspace(low, high, 41)
        best = grid[np.argmax(np.abs(np.exp(-1j * np.outer(grid, t)) @ weighted))]
        low, high = best - 2.0 * (grid[1] - grid[0]), best + 2.0 * (grid[1] - grid[0])
    return float(best)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Swung:
    """Swinging freely after a push of the top: the lowest frequencies, looked for near the ones given [rad/s].

    `push` [m] within `rise` [s], along X or, if `heave`, up.
    """

    system: TowedSystem
    near: tuple[float, ...]
    duration: float
    step: float
    links: int = 48
    push: float = 0.5
    rise: float = 6.0
    heave: bool = False

    def find(self) -> Finding:
        """The frequencies, numbered from 1, and the part of the energy that is unexplained."""
        axis = 2 if self.heave else 0
        t = np.arange(0.0, self.duration, 2.0 * self.step)
        position = np.zeros((t.size, 3))
        position[:, axis] = self.push * smooth(t / self.rise)
        run = link_joint.simulate(
            self.system, Trace(t=t, position=position), links=self.links, step=self.step, companion=False
        )
        free = t > 1.5 * self.rise
        swing = run.vehicle.position[free, axis]
        found = [strongest(t[free], swing, each) for each in self.near]
        return Finding(
            figures={f"omega_{i}": each for i, each in enumerate(found, start=1)} | {"imbalance": run.imbalance},
            text=_told(run),
        )
