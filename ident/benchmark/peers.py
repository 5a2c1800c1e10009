"""A peer on the same tow: MoorDyn, where the optional extra ``peers`` is installed.

MoorDyn (Hall and Goupee 2015, doi:10.1016/j.oceaneng.2015.05.035; PyPI ``moordyn``, BSD-3) is a lumped-mass code
with axial springs. A part of one cable and one body is written as its input file so that the physics is the same:

* the line's diameter is that of its displacement, ``rho pi D^2/4 = m - w/g``, and drag and added mass are referred
  to it: ``Cd = C_n d/D``; the tangential coefficient to its surface, ``CdAx = C_t (area per length)/(pi D)``;
* the body is a point with the mass ``M + M_a`` and the volume that leaves its weight in water, ``V = (M + M_a - W/g)
  /rho``, so that no added mass is left to be asked for; its drag area is ``C_d A``;
* the axial loss is that of the cable, ``BA = tau_a EA``, or a share of critical in each segment.

The run starts with the cable hanging at rest, MoorDyn's own equilibrium, so the ship has to begin at rest.
"""

import contextlib
import math
import os
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

import numpy as np

from models.body import Body
from models.quantity import GRAVITY, InvalidInput, NumericalFailure
from models.towed_system import TowedSystem
from models.trace import Trace

INSTALL = "pip install 'cable-ident[peers]'"

#: A ship slower than this has not begun to move [m/s].
_AT_REST = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """How MoorDyn runs.

    Parameters
    ----------
    segments
        Segments of the line.
    scheme
        MoorDyn's name of the time integrator: ``Euler``, ``RK2``, ``RK4``, ``Midpoint3``, ...
    step
        Longest time step [s].
    coupling
        Time between two positions of the ship handed over [s]; it moves straight between them.
    damping
        Axial loss as a share of critical in each segment; None: the cable's own.
    """

    segments: int
    scheme: str
    step: float
    coupling: float = 1.0
    damping: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PeerRun:
    """The body's trace, with the tension in the first and the last segment, and the CPU time of the stepping [s]."""

    body: Trace
    seconds: float


#: Time integrators worth a try, each with the axial loss that lets it take its longest steps, and the longest and the
#: shortest step tried, times the fastest rate. The others of MoorDyn 2.7 need more time for the same error
#: (RK4, Heun, ACA, BEuler), or leave the finite range at any step tried (Adams-Bashforth, Wilson).
CANDIDATES: Mapping[str, tuple[float, float, float]] = {
    "Euler": (1.0, 2.2, 0.2),
    "RK2": (0.8, 2.4, 0.4),
    "Midpoint3": (1.0, 5.0, 0.5),
}


def version() -> str | None:
    """MoorDyn's version, None where it is not installed."""
    try:
        return metadata.version("moordyn")
    except metadata.PackageNotFoundError:
        return None


def simulate(system: TowedSystem, ship: Trace, setting: Setting) -> PeerRun:
    """Run MoorDyn on a system of one part, from rest.

    Raises
    ------
    InvalidInput
        MoorDyn is not installed, or it has no such tow: more parts, a current, strumming, another drag law, a body
        that differs by axis, a cable without displacement, a ship that does not begin at rest.
    NumericalFailure
        MoorDyn stops, or its numbers do.
    """
    if version() is None:
        raise InvalidInput(f"MoorDyn is not installed; get it with {INSTALL}.")
    text = input_file(system, setting)
    if np.linalg.norm(ship.rates()[0]) > _AT_REST:
        raise InvalidInput("The run of MoorDyn begins at rest, but the ship is already moving; let it begin at rest.")
    import moordyn

    parts = max(1, round(float(ship.t[1] - ship.t[0]) / setting.coupling))
    times = np.interp(np.arange(parts * (len(ship) - 1) + 1) / parts, np.arange(len(ship)), ship.t)
    place = ship.at(times)
    speed = np.diff(place, axis=0) / np.diff(times)[:, None]
    calls = list(zip(place[:-1].tolist(), speed.tolist(), times[:-1].tolist(), np.diff(times).tolist(), strict=True))
    rows = np.empty((len(ship), 8))
    with tempfile.TemporaryDirectory() as folder, _silent():
        path = Path(folder) / "tow.txt"
        path.write_text(text, encoding="utf-8")
        instance = moordyn.Create(str(path))
        try:
            moordyn.Init(instance, place[0].tolist(), [0.0, 0.0, 0.0])
            point, line = moordyn.GetPoint(instance, 1), moordyn.GetLine(instance, 1)

            def row() -> list[float]:
                ends = (moordyn.GetLineNodeTen(line, k) for k in (setting.segments, 0))
                return [
                    *moordyn.GetPointPos(point),
                    *moordyn.GetPointVel(point),
                    *(math.hypot(*tension) for tension in ends),
                ]

            rows[0] = row()
            begun = time.thread_time()
            for i, call in enumerate(calls, start=1):
                moordyn.Step(instance, *call)
                if i % parts == 0:
                    rows[i // parts] = row()
            seconds = time.thread_time() - begun
        except RuntimeError as failure:
            raise NumericalFailure(f"MoorDyn stopped with {setting}: {failure}.") from failure
        finally:
            moordyn.Close(instance)
    if not np.isfinite(rows).all():
        raise NumericalFailure(f"MoorDyn left the finite range with {setting}.")
    body = Trace(t=ship.t, position=rows[:, :3], velocity=rows[:, 3:6], tension=rows[:, 6:])
    return PeerRun(body=body, seconds=seconds)


def input_file(system: TowedSystem, setting: Setting) -> str:
    """MoorDyn's input file of a system of one part.

    Raises
    ------
    InvalidInput
        MoorDyn has no such tow.
    """
    if len(system.parts) != 1 or system.current is not None or system.strumming or system.drag_law != "quadratic":
        raise InvalidInput(
            "The comparison with MoorDyn is of one part with quadratic drag, without current or strumming."
        )
    cable, rho = system.parts[0].cable, system.water_density
    displaced = cable.mass - cable.weight_in_water / GRAVITY
    if displaced <= 0.0:
        raise InvalidInput(
            f"MoorDyn takes the weight in water from a diameter, but the cable has {cable.mass:g} kg/m and "
            f"{cable.weight_in_water:g} N/m in water, which leaves no displacement."
        )
    diameter = math.sqrt(4.0 * displaced / (math.pi * rho))
    normal = cable.normal_drag(rho) / (0.5 * rho * diameter)
    tangential = cable.tangential_drag(rho) / (0.5 * rho * math.pi * diameter)
    loss = cable.axial_damping * cable.axial_stiffness if setting.damping is None else -setting.damping
    mass, volume, area = _point(system.parts[0].body, rho)
    weight = (mass - rho * volume) * GRAVITY
    hanging = cable.length * (1.0 + (weight + 0.5 * cable.weight_in_water * cable.length) / cable.axial_stiffness)
    return f"""--------------------- MoorDyn input file ---------------------
One part of a towed system
---------------------- LINE TYPES ----------------------
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
cable {diameter!r} {cable.mass!r} {cable.axial_stiffness!r} {loss!r} 0 {normal!r} {cable.added_mass / displaced!r} \
{tangential!r} 0
---------------------- POINTS ----------------------
ID Attachment X Y Z Mass Volume CdA Ca
(#) (word/ID) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Free 0 0 {-hanging!r} {mass!r} {volume!r} {area!r} 0
2 Coupled 0 0 0 0 0 0 0
---------------------- LINES ----------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (ID) (ID) (m) (-) (-)
1 cable 1 2 {cable.length!r} {setting.segments} -
---------------------- OPTIONS ----------------------
0 writeLog
{setting.step!r} dtM
1e9 CFL
{setting.scheme} tScheme
{GRAVITY!r} g
{rho!r} rho
1e5 WtrDpth
1e-8 threshIC
1000 TmaxIC
1 disableOutput
1 disableOutTime
------------------------- need this line -------------------------
"""


def fastest_rate(system: TowedSystem, ship: Trace, segments: int) -> float:
    """What bounds the step [rad/s]: the highest axial frequency of the line, or the decay of its drag."""
    cable = system.parts[0].cable
    axial = 2.0 * segments / cable.length * math.sqrt(cable.axial_stiffness / cable.mass)
    speed = float(np.linalg.norm(ship.rates(), axis=1).max())
    return max(axial, 2.0 * cable.normal_drag(system.water_density) * speed / (cable.mass + cable.added_mass))


def largest_steps(
    system: TowedSystem, ship: Trace, converged: Trace, segments: int, share: float = 0.3
) -> dict[str, float]:
    """The longest step of each candidate on a tow, times the fastest rate; found by bisection.

    A step counts when the run keeps within `share` of the error of its segments, which the converged run tells, of
    RK4 at a short step: a run past its limit can stay bounded and be wrong. A candidate that not even the shortest
    step saves is left out.
    """
    rate = fastest_rate(system, ship, segments)

    def run(scheme: str, reach: float, damping: float) -> Trace:
        setting = Setting(segments=segments, scheme=scheme, step=reach / rate, damping=damping)
        return simulate(system, ship, setting).body

    exact = run("RK4", 2.0, 0.8)
    allowed = share * velocity_error(exact, converged)
    found = {}
    for scheme, (damping, high, low) in CANDIDATES.items():

        def holds(reach: float, scheme: str = scheme, damping: float = damping) -> bool:
            try:
                return velocity_error(run(scheme, reach, damping), exact) <= allowed
            except NumericalFailure:
                return False

        if holds(high):
            low = high
        elif not holds(low):
            continue
        while high > 1.05 * low:
            middle = math.sqrt(low * high)
            low, high = (middle, high) if holds(middle) else (low, middle)
        found[scheme] = low
    return found


def velocity_error(trace: Trace, other: Trace) -> float:
    """RMS of the difference of two traces' velocities [m/s]."""
    return float(np.sqrt(np.mean(np.sum((trace.rates() - other.rates()) ** 2, axis=1))))


def _point(body: Body | None, rho: float) -> tuple[float, float, float]:
    """Mass with added mass [kg], volume that leaves the weight in water [m3] and drag area [m2] of the body."""
    if body is None:
        return 0.0, 0.0, 0.0
    added = {body.added_mass_surge, body.added_mass_sway, body.added_mass_heave}
    areas = {body.area_surge, body.area_sway, body.area_heave}
    if len(added) > 1 or len(areas) > 1:
        raise InvalidInput("MoorDyn's point has one area and one added mass, but those of the body differ by axis.")
    mass = body.mass + added.pop()
    return mass, (mass - body.weight_in_water / GRAVITY) / rho, body.drag_coefficient * areas.pop()


@contextlib.contextmanager
def _silent() -> Iterator[None]:
    """What a library prints from outside Python goes nowhere."""
    kept = [os.dup(1), os.dup(2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        yield
    finally:
        for at, old in zip((1, 2), kept, strict=True):
            os.dup2(old, at)
            os.close(old)
        os.close(nowhere)
