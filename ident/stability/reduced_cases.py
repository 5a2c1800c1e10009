"""Cases of the reduced models: links, lengths, masses, drag, steps, rest, reversal and delays.

Their independent figures are closed forms. One massless link of stiffness k and quadratic drag r behind a ship at U
from rest moves at v = U (1 + W_0(-exp(-1 - k t/(2 r U)))), W_0 Lambert's function; when the ship stops, it comes to
rest in the time 2 r U/k, and when the ship turns back, it stands still after (2 r U/k)(1 - ln 2).
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from ident.stability.case import Case, Finding
from ident.stability.planar import TEN_KNOTS, Floats, at_once, gentle, heavier_drag, lag, mangus, transfer
from models import reduced
from models.delayed import FirstOrder, SecondOrder
from models.drive import Drive, Start
from models.inertial import Inertial
from models.massless import Massless
from models.reduced import ReducedModel
from models.statics import static_shape
from models.tow import Tow
from models.trace import Trace


def sectioned(name: str, tow: Tow | None = None) -> ReducedModel:
    """The first guess of a model of mangus-740, or of another tow."""
    tow = mangus() if tow is None else tow
    return reduced.section(name, tow, static_shape(tow))


def behind(model: ReducedModel, ship: Trace, start: Start = "rest") -> tuple[Trace, str]:
    """The vehicle's trace, and in words what its steps err by."""
    error = reduced.step_error(model, Drive.from_trace(ship, start=start))
    return reduced.simulate(model, ship, start=start), f"steps err by {error:.1e} m/s"


def settled(model: ReducedModel, speed: float = 0.4, *, duration: float = 6000.0, sample: float = 1.0) -> Finding:
    """From rest to a steady tow: how far the vehicle is behind."""
    ship = gentle(np.arange(0.0, duration + sample, sample), 0.0, speed)
    vehicle, text = behind(model, ship)
    return Finding(figures={"lag": lag(ship, vehicle)}, text=text)


def stepped(model: ReducedModel, speed: float, *times: float, sample: float = 1.0) -> Finding:
    """Behind a ship that is at its speed from the first sample on: the velocity at some times."""
    ship = at_once(np.arange(0.0, max(times) + sample, sample), speed)
    vehicle, text = behind(model, ship)
    v = vehicle.rates()[:, 0]
    return Finding(figures={f"velocity at {t:g} s": float(np.interp(t, ship.t, v)) for t in times}, text=text)


def gain(model: ReducedModel, omega: float, *, duration: float = 4000.0, sample: float = 1.0) -> Finding:
    """The amplitude of the vehicle over that of the ship."""
    t = np.arange(0.0, duration, sample)
    ship = Trace.along_x(t, 10.0 * (1.0 - np.cos(omega * t)))
    vehicle, text = behind(model, ship)
    return Finding(figures={"gain": abs(transfer(t, ship.position[:, 0], vehicle.position[:, 0], omega))}, text=text)


def _turned(links: int, after: float, duration: float, sample: float) -> tuple[Floats, Floats, Floats, str]:
    """Since the ship, steadily at 0.4 m/s, changed to `after` [m/s]: time, gap to the vehicle, its velocity, words."""
    t = np.arange(0.0, 100.0 + duration, sample)
    ship = Trace.along_x(t, 0.4 * np.minimum(t, 100.0) + after * np.maximum(t - 100.0, 0.0))
    vehicle, text = behind(sectioned(f"massless-{links}-quadratic"), ship, "steady")
    return t - 100.0, ship.position[:, 0] - vehicle.position[:, 0], vehicle.rates()[:, 0], text


def _rest() -> Finding:
    """Half way to rest in time, the gap is a quarter; then the vehicle stands, and does not creep or chatter."""
    t, gap, v, text = _turned(1, 0.0, 600.0, 0.1)
    figures = {
        "gap at 189.204 s": float(np.interp(189.204, t, gap)),
        "gap at 400 s": float(np.interp(400.0, t, gap)),
        "velocity at the end": float(np.abs(v[-100:]).max()),
    }
    return Finding(figures=figures, text=text)


def _rest_of_many() -> Finding:
    _, gap, v, text = _turned(16, 0.0, 20_000.0, 1.0)
    figures = {"gap at the end": float(gap[-1]), "velocity at the end": float(np.abs(v[-100:]).max())}
    return Finding(figures=figures, text=text)


def _reversal() -> Finding:
    t, gap, v, text = _turned(1, -0.4, 4000.0, 0.1)
    turn = int(np.argmax(v < 0.0))
    return Finding(
        figures={
            "still after": float(np.interp(0.0, -v[turn - 1 : turn + 1], t[turn - 1 : turn + 1])),
            "gap at the end": float(gap[-1]),
        },
        text=text,
    )


def _vehicle_mass(mass: float, drag: float | None = None) -> Inertial:
    model = sectioned("inertial-1-quadratic")
    assert isinstance(model, Inertial)
    return replace(model, vehicle_mass=mass, vehicle_drag=model.vehicle_drag if drag is None else drag)


def _delayed(delay: float) -> FirstOrder:
    return FirstOrder(drag="linear", spring=0.01, delay=delay)


def _delay_beyond(steady: bool) -> Finding:
    """A delay longer than the record: the vehicle has not heard of the ship's motion yet."""
    ship = at_once(np.arange(0.0, 601.0), 0.4)
    model = SecondOrder(drag="quadratic", spring=0.0065, damping=2.8, delay=1000.0)
    response = reduced.respond(model, Drive.from_trace(ship, start="steady" if steady else "rest"))
    way = float(response.position[-1] - response.position[0])
    return Finding(figures={"velocity": float(response.velocity[-1]), "way": way})


def _quadratic_delay() -> FirstOrder:
    one = sectioned("massless-1-quadratic")
    assert isinstance(one, Massless)
    return FirstOrder(drag="quadratic", spring=float(one.stiffness[0]) / one.vehicle_drag, delay=0.37)


def _case(name: str, run: Callable[[], Finding], *, reduced: bool = True) -> Case:
    return Case(name=f"reduced-{name}", run=run, reduced=reduced)


def _chains() -> tuple[Case, ...]:
    """Steady lags of 1 to 64 links, massless and inertial, and linear responses of 64."""
    found = []
    for kind in ("massless", "inertial"):
        for links in (1, 4, 16, 64):
            name = f"{kind}-{links}-quadratic"
            found.append(_case(f"links-{links}-{kind}", partial(_settled_of, name), reduced=links != 64))
        found.append(_case(f"links-64-{kind}-gain", partial(_gain_of, f"{kind}-64-linear")))
    return tuple(found)


def _settled_of(name: str) -> Finding:
    return settled(sectioned(name))


def _gain_of(name: str) -> Finding:
    return gain(sectioned(name), 0.03)


CASES: tuple[Case, ...] = (
    *_chains(),
    _case("links-65", lambda: settled(sectioned("massless-65-quadratic"))),
    _case("length-5", lambda: settled(sectioned("inertial-16-quadratic", mangus(length=5.0)))),
    _case(
        "length-11000",
        lambda: settled(sectioned("inertial-16-quadratic", mangus(length=11_000.0)), duration=150_000.0, sample=30.0),
        reduced=False,
    ),
    _case("mass-0", lambda: settled(_vehicle_mass(0.0))),
    _case("mass-vanishing", lambda: stepped(_vehicle_mass(1e-6), 0.4, 60.0, 600.0)),
    _case("mass-hundredfold", lambda: stepped(_vehicle_mass(177_648.0, 1e-3), 0.4, 200.0, 20_000.0)),
    _case("step", lambda: stepped(sectioned("massless-1-quadratic"), 0.4, 60.0, 600.0)),
    _case("step-ten-knots", lambda: stepped(sectioned("massless-1-quadratic"), TEN_KNOTS, 60.0, 3600.0)),
    _case(
        "step-second-order",
        lambda: stepped(SecondOrder(drag="linear", spring=0.0065, damping=0.05, delay=0.0), 0.4, 30.0, 100.0),
    ),
    _case(
        "drag-tenfold", lambda: settled(sectioned("massless-4-quadratic", heavier_drag(10.0)), 0.1, duration=20_000.0)
    ),
    _case("drag-0", lambda: settled(sectioned("massless-4-quadratic", heavier_drag(0.0)))),
    _case("cable-floats", lambda: settled(sectioned("massless-4-quadratic", mangus(weight_in_water=-10.0)))),
    _case("rest", _rest),
    _case("rest-16-links", _rest_of_many),
    _case("reversal", _reversal),
    _case("delay-0", lambda: stepped(_delayed(0.0), 0.4, 60.0)),
    _case("delay-of-a-fraction", lambda: stepped(_delayed(0.37), 0.4, 60.0)),
    _case("delay-of-a-fraction-quadratic", lambda: stepped(_quadratic_delay(), 0.4, 60.0)),
    _case("delay-beyond-the-record", lambda: _delay_beyond(False)),
    _case("delay-beyond-the-record-steady", lambda: _delay_beyond(True)),
)
