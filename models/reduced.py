"""The reduced models by name: first guess, parameters, response, linear form.

    second-order-linear, second-order-quadratic    T (6.1), (6.2)
    first-order-linear, first-order-quadratic      T (6.5), (6.6)
    inertial-N-linear, inertial-N-quadratic        T (6.4)
    massless-N-linear, massless-N-quadratic        T (6.7)

N is the number of links, 1 to 64, 4 where it is left out.
"""

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.chain import Motion, quadratic_motion
from models.delayed import FirstOrder, SecondOrder, shifted
from models.drive import Drive, Start
from models.equivalent_drag import at_ship_motion, at_speed
from models.inertial import Inertial
from models.linear_model import LinearModel, linear_motion, state_space
from models.massless import MAX_LINKS, Massless
from models.parameter import Drag, Parameter, free_parameters, with_free
from models.quantity import InvalidInput, NumericalFailure
from models.statics import StaticShape, travel_time
from models.tow import Tow, refuse_sections_and_thrust
from models.trace import Trace

ReducedModel = SecondOrder | FirstOrder | Inertial | Massless

DEFAULT_LINKS = 4

MODEL_NAMES = (
    "second-order-linear",
    "second-order-quadratic",
    "first-order-linear",
    "first-order-quadratic",
    "inertial-4-linear",
    "inertial-4-quadratic",
    "massless-4-linear",
    "massless-4-quadratic",
)

_NAME = re.compile(r"(second-order|first-order|inertial|massless)(?:-(\d+))?-(linear|quadratic)", re.ASCII)

#: Parts of the longest step in the run that another's steps are judged by.
_FINER = 8
#: Steps of that run at the most.
_JUDGED = 1_000_000


class Response(NamedTuple):
    """Position [m] (same origin as the ship's x) and velocity [m/s] of the vehicle, each (n,), at the ship's times."""

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]


class Info(NamedTuple):
    """Canonical name, drag law, number of links (0 for a delayed model) and of states (without the delay)."""

    model: str
    drag: Drag
    links: int
    states: int


def parse_name(name: str) -> str:
    """The canonical name of a model, such as ``massless-4-quadratic`` for ``massless-quadratic``.

    Raises
    ------
    InvalidInput
        No model has this name; the message lists the names.
    """
    kind, links, drag = _parse(name)
    return f"{kind}-{links}-{drag}" if links else f"{kind}-{drag}"


def section(name: str, tow: Tow, shape: StaticShape, *, speed: float = 0.25) -> ReducedModel:
    """The first guess: the continuous quantities of a tow, sectioned (T 6.7).

    Parameters
    ----------
    shape
        Static shape of the tow; its tensions become the springs, T_mid/ds for each link (T (6.3)).
    speed
        Velocity amplitude [m/s] at which linear models take their drag, 8/(3 pi) r `speed`.

    Raises
    ------
    InvalidInput
        Unknown name, a speed that is not above zero, a tow without drag, with sections or a thrust, or a slack cable.

    Notes
    -----
    Inner nodes carry ds of cable each, the vehicle's node the vehicle and its own half link, as does the one node
    of the delayed models (B + beta L/2, as in T 6.7). T's mapping leaves the half link out. The delay starts at
    the travel time of the wave front, int ds / sqrt(T/(m + m_a)).
    """
    kind, links, drag = _parse(name)
    if not 0.0 < speed < float("inf"):
        raise InvalidInput(f"The speed of the equivalent linear drag must be above 0 m/s, but it is {speed:g} m/s.")
    refuse_sections_and_thrust(tow, "A reduced model")
    n = max(links, 1)
    link = float(shape.s[-1]) / n
    middle = link * (n - 0.5 - np.arange(n, dtype=float))
    stiffness = shape.tension_at(middle) / link
    mass = tow.cable.mass + tow.cable.added_mass
    vehicle_mass = tow.vehicle.mass + tow.vehicle.added_mass + 0.5 * mass * link
    cable_drag = tow.cable.normal_drag(tow.water_density)
    vehicle_drag = tow.vehicle.drag(tow.water_density) + 0.5 * cable_drag * link
    if drag == "linear":
        cable_drag, vehicle_drag = (float(r) for r in at_speed(np.array([cable_drag, vehicle_drag]), speed))
    if kind == "second-order":
        return SecondOrder(
            drag=drag,
            spring=float(stiffness[0]) / vehicle_mass,
            damping=vehicle_drag / vehicle_mass,
            delay=travel_time(tow, shape),
        )
    if kind == "first-order":
        return FirstOrder(drag=drag, spring=float(stiffness[0]) / vehicle_drag, delay=travel_time(tow, shape))
    inner = 1.0 if n > 1 else 0.0
    if kind == "massless":
        return Massless(
            drag=drag, stiffness=stiffness, link=link, cable_drag=inner * cable_drag, vehicle_drag=vehicle_drag
        )
    return Inertial(
        drag=drag,
        stiffness=stiffness,
        link=link,
        cable_drag=inner * cable_drag,
        cable_mass=inner * mass,
        vehicle_drag=vehicle_drag,
        vehicle_mass=vehicle_mass,
    )


def parameters(model: ReducedModel) -> tuple[Parameter, ...]:
    """The free parameters: value, unit and the range of a search."""
    return free_parameters(model, model.held)


def with_values(model: ReducedModel, values: Sequence[float]) -> ReducedModel:
    """The model with other values of its free parameters, in the order of `parameters`.

    Raises
    ------
    InvalidInput
        The number of values is wrong, or one of them is outside what the model takes.
    NumericalFailure
        A value is not finite.
    """
    return with_free(model, [parameter.name for parameter in parameters(model)], values)


def respond(model: ReducedModel, drive: Drive) -> Response:
    """The vehicle's motion behind a prepared ship.

    Raises
    ------
    NumericalFailure
        The motion cannot be solved or leaves the finite range; time, node and amount are in the message.
    """
    # What overflows here is caught below, with its time.
    with np.errstate(all="ignore"):
        chain = model.chain()
        motion: Motion = (quadratic_motion if model.drag == "quadratic" else linear_motion)(chain, drive)
        if isinstance(model, SecondOrder | FirstOrder):
            motion = shifted(motion, chain, model.drag, drive, model.delay)
    finite = np.isfinite(motion.x) & np.isfinite(motion.v)
    if not finite.all():
        at = drive.t[int(np.argmin(finite))]
        raise NumericalFailure(
            f"The vehicle of {info(model).model} leaves the finite range at t = {at:g} s; "
            "its parameters are too extreme."
        )
    return Response(drive.x0 + motion.x, motion.v)


def step_error(model: ReducedModel, drive: Drive) -> float:
    """RMS error of the vehicle's velocity that the steps leave [m/s], estimated by a run with finer ones.

    Stability may make a model take steps down to a quarter of the longest, so that an eighth of that halves all of
    them; at second order or better four thirds of the difference are the error at the most. A linear model is solved
    exactly for the ship's spline: its error is that of rounding. Of a record of weeks its beginning is judged.

    Raises
    ------
    NumericalFailure
        As `respond` does.
    """
    finer = np.cumsum(np.ceil(np.diff(drive.t) * (_FINER / drive.max_step)) + 1.0)
    drive = drive.first(max(1, int(np.searchsorted(finer, _JUDGED))))
    difference = respond(model, drive).velocity - respond(model, drive.finer(_FINER)).velocity
    return float(4.0 / 3.0 * np.sqrt(np.mean(difference**2)))


def simulate(model: ReducedModel, ship: Trace, *, start: Start = "rest") -> Trace:
    """The vehicle's trace behind a ship that moves along x: x and its velocity; y and z stay 0."""
    drive = Drive.from_trace(ship, start=start)
    response = respond(model, drive)
    position, velocity = np.zeros((drive.t.size, 3)), np.zeros((drive.t.size, 3))
    position[:, 0], velocity[:, 0] = response
    return Trace(t=drive.t, position=position, velocity=velocity)


def linearise(
    model: ReducedModel,
    *,
    ship_amplitude: float | None = None,
    omega: float | None = None,
    speed: float | None = None,
) -> LinearModel:
    """State-space arrays from ship velocity to vehicle velocity, which is also ship to vehicle position.

    Parameters
    ----------
    ship_amplitude, omega
        A quadratic model takes the drag 8/(3 pi) r V_i of each node at the velocity amplitudes V_i that a ship's
        sinusoid of this amplitude [m] and frequency [rad/s] causes, iterated to consistency.
    speed
        Or the same velocity amplitude [m/s] at every node. Linear models need neither.

    Raises
    ------
    InvalidInput
        A quadratic model without a motion to linearise about, or an amplitude or frequency not above zero.
    NumericalFailure
        The equivalent drag does not settle.
    """
    chain = model.chain()
    if model.drag == "quadratic":
        given = [value for value in (ship_amplitude, omega, speed) if value is not None]
        both = ship_amplitude is not None and omega is not None
        if both == (speed is not None) or len(given) != (2 if both else 1):
            raise InvalidInput("A quadratic model is linearised about ship_amplitude and omega together, or a speed.")
        if not all(0.0 < value < float("inf") for value in given):
            raise InvalidInput(f"Amplitude, frequency and speed must be above 0, but were given as {given}.")
        if ship_amplitude is not None and omega is not None:
            chain = chain._replace(r=at_ship_motion(chain, ship_amplitude, omega))
        elif speed is not None:
            chain = chain._replace(r=at_speed(chain.r, speed))
    return state_space(chain, model.delay if isinstance(model, SecondOrder | FirstOrder) else 0.0)


def info(model: ReducedModel) -> Info:
    """Name, drag law, links and states of a model."""
    match model:
        case SecondOrder():
            return Info(f"second-order-{model.drag}", model.drag, 0, 2)
        case FirstOrder():
            return Info(f"first-order-{model.drag}", model.drag, 0, 1)
        case Inertial():
            n = model.stiffness.size
            return Info(f"inertial-{n}-{model.drag}", model.drag, n, 2 * n)
        case Massless():
            n = model.stiffness.size
            return Info(f"massless-{n}-{model.drag}", model.drag, n, n)


def _parse(name: str) -> tuple[str, int, Drag]:
    """Kind, number of links (0 for a delayed model) and drag law."""
    match = _NAME.fullmatch(name)
    if match:
        kind, number, law = match.groups()
        drag: Drag = "linear" if law == "linear" else "quadratic"
        if kind.endswith("order"):
            if number is None:
                return kind, 0, drag
        elif 1 <= (links := int(number or DEFAULT_LINKS)) <= MAX_LINKS:
            return kind, links, drag
    raise InvalidInput(
        f"No reduced model is named {name!r}. Names are second-order, first-order, inertial-N or massless-N with "
        f"N links from 1 to {MAX_LINKS} ({DEFAULT_LINKS} where left out), each followed by -linear or -quadratic: "
        f"{', '.join(MODEL_NAMES)}."
    )
