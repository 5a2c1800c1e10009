"""Cases of extreme records: a day, samples of 0.01 s and of 60 s, two samples, gaps, and a far origin."""

from collections.abc import Callable
from functools import partial

import numpy as np

from ident.stability.case import Case, Finding
from ident.stability.planar import at_once, gentle, lag, mangus, transfer
from ident.stability.reduced_cases import behind, gain, sectioned, settled, stepped
from models import reduced
from models.delayed import SecondOrder
from models.spectral import simulate
from models.trace import Trace

DAY = 86_400.0
#: An easting as on a map [m].
FAR = 5e6


def _day_of(name: str) -> Finding:
    ship = gentle(np.arange(0.0, DAY + 1.0), 0.0, 0.4, origin=FAR)
    vehicle, text = behind(sectioned(name), ship)
    return Finding(figures={"lag": lag(ship, vehicle), "velocity": float(vehicle.rates()[-1, 0])}, text=text)


def _day_of_the_simulator() -> Finding:
    ship = gentle(np.arange(0.0, DAY + 1.0), 0.0, 0.25, origin=FAR)
    result = simulate(mangus(), ship)
    figures = {"trail": lag(ship, result.vehicle), "velocity": float(result.vehicle.rates()[-1, 0])}
    return Finding(figures=figures, text=f"error {result.error:.1e} m/s, {result.steps} steps")


def _day_of_swinging() -> Finding:
    """The linear second order under a sinusoid for a day: its amplitude is what it was, and that of the closed form."""
    return gain(_second_order(), 0.1, duration=DAY)


def _second_order() -> SecondOrder:
    return SecondOrder(drag="linear", spring=0.0065, damping=0.05, delay=7.3)


def _hundredths_of_the_simulator() -> Finding:
    t = np.arange(0.0, 120.0, 0.01)
    ship = Trace.along_x(t, np.zeros(t.size), 0.5 * (1.0 - np.cos(0.8 * t)))
    result = simulate(mangus(length=5.0), ship)
    ratio = transfer(t, ship.position[:, 2], result.vehicle.position[:, 2], 0.8).real
    return Finding(figures={"heave ratio": ratio}, text=f"error {result.error:.1e} m/s")


def _minutes_of_the_simulator() -> Finding:
    ship = gentle(np.arange(0.0, 6001.0, 60.0), 0.0, 0.25)
    result = simulate(mangus(), ship)
    return Finding(figures={"trail": lag(ship, result.vehicle)}, text=f"error {result.error:.1e} m/s")


def _two_samples() -> Finding:
    ship = Trace.along_x([0.0, 600.0], [0.0, 240.0])
    vehicle, text = behind(sectioned("massless-1-quadratic"), ship)
    return Finding(figures={"velocity at 600 s": float(vehicle.rates()[-1, 0])}, text=text)


def _two_samples_of_the_simulator() -> Finding:
    ship = Trace.along_x([0.0, 6000.0], [0.0, 1500.0])
    result = simulate(mangus(), ship)
    return Finding(figures={"trail": lag(ship, result.vehicle)}, text=f"error {result.error:.1e} m/s")


def _ends_missing() -> Finding:
    t = np.arange(0.0, 601.0)
    ship = Trace.along_x(t, np.where(t < 300.0, 0.4 * t, np.nan))
    return Finding(figures={"lag": lag(ship, reduced.simulate(sectioned("massless-4-quadratic"), ship))})


def _gap_of_the_simulator() -> Finding:
    t = np.arange(0.0, 601.0)
    ship = Trace.along_x(t, np.where((t < 300.0) | (t > 310.0), 0.4 * t, np.nan))
    return Finding(figures={"lag": lag(ship, simulate(mangus(), ship).vehicle)})


def _gap() -> Finding:
    """A gap of ten minutes in a steady tow is bridged."""
    t = np.arange(0.0, 6001.0)
    ship = at_once(t, 0.4, origin=FAR)
    gappy = Trace.along_x(t, np.where((t < 3000.0) | (t > 3600.0), ship.position[:, 0], np.nan))
    vehicle, text = behind(sectioned("massless-4-quadratic"), gappy)
    return Finding(figures={"lag": lag(ship, vehicle)}, text=text)


def _repeated() -> Finding:
    ship = Trace.along_x([0.0, 1.0, 1.0, 2.0], [0.0, 0.4, 0.4, 0.8])
    return Finding(figures={"lag": lag(ship, reduced.simulate(sectioned("massless-4-quadratic"), ship))})


def _case(name: str, run: Callable[[], Finding], *, reduced: bool = True) -> Case:
    return Case(name=f"record-{name}", run=run, reduced=reduced)


CASES: tuple[Case, ...] = (
    *(
        _case(f"day-{kind}", partial(_day_of, name), reduced=False)
        for kind, name in (
            ("massless", "massless-4-quadratic"),
            ("inertial", "inertial-4-quadratic"),
            ("inertial-linear", "inertial-4-linear"),
            ("second-order", "second-order-quadratic"),
        )
    ),
    _case("day-swinging", _day_of_swinging, reduced=False),
    _case("day-simulator", _day_of_the_simulator, reduced=False),
    _case("hundredths", lambda: gain(_second_order(), 0.1, duration=600.0, sample=0.01)),
    _case("hundredths-massless", lambda: stepped(sectioned("massless-1-quadratic"), 0.4, 60.0, 600.0, sample=0.01)),
    _case("hundredths-simulator", _hundredths_of_the_simulator, reduced=False),
    _case("minutes", lambda: gain(_second_order(), 0.01, duration=60_000.0, sample=60.0)),
    _case("minutes-massless", lambda: settled(sectioned("massless-4-quadratic"), sample=60.0)),
    _case("minutes-simulator", _minutes_of_the_simulator),
    _case("two-samples", _two_samples),
    _case("two-samples-simulator", _two_samples_of_the_simulator),
    _case("gap", _gap),
    _case("gap-simulator", _gap_of_the_simulator),
    _case("ends-missing", _ends_missing),
    _case("repeated-time", _repeated),
)
