"""The way up from the vehicle: the cable's force and place integrated through its sections (see `models.statics`)."""

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.balance import end_force
from models.cable import Cable
from models.quantity import GRAVITY, NumericalFailure
from models.tow import Tow

Floats = NDArray[np.float64]

#: Relative error of a step, and absolute ones over the force and the length of the whole cable.
_RELATIVE, _OF_FORCE, _OF_LENGTH = 1e-11, 1e-13, 1e-12
#: A step that cannot be made has come to a slack place if the tension there is below this share of the forces.
_SLACK = 1e-6


class SlackCable(NumericalFailure):
    """The tension falls to zero somewhere along the cable."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Span:
    """One cable of the way, between the unstretched lengths `start` and `end` [m] from the vehicle."""

    cable: Cable
    start: float
    end: float
    states: Callable[[Floats], Floats]
    squeeze: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Rise:
    """The way up from a vehicle at a given depth.

    `steps` (k,) [m] are the ends of the steps taken, `angle` [rad], without jumps, and `level` [m], its height over
    the water's surface, the way's there; `pitch` [rad] is the vehicle's.
    """

    spans: tuple[_Span, ...]
    steps: Floats
    angle: Floats
    level: Floats
    pitch: float

    @property
    def height(self) -> float:
        """Where the way ends over the water's surface [m]."""
        return float(self.level[-1])

    def at(self, s: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """Angle [rad], tension [N], x from the vehicle [m], height over the surface [m] and strain at s (n,) [m]."""
        state, strain = np.empty((4, s.size)), np.empty(s.size)
        first = 0
        for span in self.spans:
            last = s.size if span is self.spans[-1] else int(np.searchsorted(s, span.end, side="right"))
            if last > first:
                part = span.states(np.minimum(s[first:last], span.end))
                state[:, first:last] = part
                T = np.hypot(part[0], part[1])
                strain[first:last] = T / span.cable.axial_stiffness + span.squeeze * np.minimum(part[3], 0.0)
            first = last
        angle = np.arctan2(state[1], state[0])
        near = np.interp(s, self.steps, self.angle)
        angle += 2.0 * math.pi * np.round((near - angle) / (2.0 * math.pi))
        return angle, np.hypot(state[0], state[1]), state[2], state[3], strain


def rise(tow: Tow, depth: float, *, to_surface: bool = False) -> Rise:
    """Integrate from the vehicle at `depth` [m] to the cable's end, or `to_surface`: to where the upper cable is there.

    Raises
    ------
    InvalidInput
        A towfish without a stable pitch angle.
    SlackCable
        The tension falls to zero; says where.
    NumericalFailure
        The integration cannot go on, though the cable is taut.
    """
    from scipy.integrate import solve_ivp

    flow = flow_along(tow)
    force_x, force_z, pitch = end_force(tow, flow(-depth))
    state = np.array([-force_x, -force_z, 0.0, -depth])
    scale = math.hypot(force_x, force_z) + sum(abs(cable.weight_in_water) * cable.length for cable in tow.cables)
    # On the way to the surface the upper cable is as long as may be, which is nobody's length.
    whole = "" if to_surface else f" of {tow.length:g} m"
    if force_x == force_z == 0.0:
        raise _slack(0.0, whole)
    atol = np.array([_OF_FORCE * scale, _OF_FORCE * scale, _OF_LENGTH * tow.length, _OF_LENGTH * tow.length])
    spans, steps, states = [], [np.zeros(1)], [state[:, None]]
    start = 0.0
    for i, cable in enumerate(tow.cables):
        end = start + cable.length
        slope, squeeze = _slope(tow, cable, flow)
        event = _Surface() if to_surface and i == len(tow.sections) else None
        way = solve_ivp(
            slope, (start, end), state, method="DOP853", rtol=_RELATIVE, atol=atol, dense_output=True, events=event
        )
        steps.append(way.t[1:])
        states.append(way.y[:, 1:])
        state = way.y[:, -1]
        _check_taut(np.append(steps[-2][-1:], way.t[1:]), np.column_stack([states[-2][:, -1:], way.y[:, 1:]]), whole)
        if way.status < 0:
            if math.hypot(state[0], state[1]) < _SLACK * scale:
                raise _slack(float(way.t[-1]), whole)
            raise NumericalFailure(
                f"The static shape cannot be integrated past s = {way.t[-1]:.1f} m{whole} from the vehicle, "
                f"where the tension is {math.hypot(state[0], state[1]):.3g} N: {way.message}"
            )
        spans.append(_Span(cable=cable, start=start, end=float(way.t[-1]), states=way.sol, squeeze=squeeze))
        start = end
    every = np.concatenate(states, axis=1)
    return Rise(
        spans=tuple(spans),
        steps=np.concatenate(steps),
        angle=np.unwrap(np.arctan2(every[1], every[0])),
        level=every[3],
        pitch=pitch,
    )


def flow_along(tow: Tow) -> Callable[[float], float]:
    """The water's speed [m/s] relative to the steadily towed frame at a height [m], negative below the surface."""
    if tow.current is None:
        still = -tow.speed
        return lambda _: still
    depths: list[float] = tow.current.depth.tolist()
    speeds: list[float] = (tow.current.velocity[:, 0] - tow.speed).tolist()
    last = len(depths) - 1

    def flow(z: float) -> float:
        i = bisect_right(depths, -z)
        if i == 0 or i > last:
            return speeds[min(i, last)]
        share = (-z - depths[i - 1]) / (depths[i] - depths[i - 1])
        return speeds[i - 1] + share * (speeds[i] - speeds[i - 1])

    return flow


class _Surface:
    """The event that ends the way where it comes up to the surface, as `solve_ivp` wants it."""

    terminal, direction = True, 1.0

    def __call__(self, _: float, state: Floats) -> float:
        return float(state[3])


def _slope(
    tow: Tow, cable: Cable, flow: Callable[[float], float]
) -> tuple[Callable[[float, Floats], tuple[float, float, float, float]], float]:
    """Derivative of (F_x, F_z, x, z) along a cable, and its strain a metre of height [1/m]."""
    w, nu, EA = cable.weight_in_water, cable.poisson_ratio, cable.axial_stiffness
    k_n, k_t = cable.normal_drag(tow.water_density), cable.tangential_drag(tow.water_density)
    squeeze = (1.0 - 2.0 * nu) * tow.water_density * GRAVITY * cable.cross_section / EA
    hypot = math.hypot

    def slope(_: float, state: Floats) -> tuple[float, float, float, float]:
        F_x, F_z, _x, z = state.tolist()
        T = hypot(F_x, F_z) or 1e-300
        cosine, sine = F_x / T, F_z / T
        u = flow(z)
        e = T / EA + squeeze * min(z, 0.0)
        c = (1.0 + e) * (1.0 - nu * e)
        u_n, u_t = u * sine, u * cosine
        # Drag along the normal (sin phi, -cos phi), in which the flow is u_n, and along the tangent.
        normal, tangential = k_n * c * u_n * abs(u_n), k_t * c * u_t * abs(u_t)
        return (
            -normal * sine - tangential * cosine,
            w + normal * cosine - tangential * sine,
            (1.0 + e) * cosine,
            (1.0 + e) * sine,
        )

    return slope, squeeze


def _check_taut(s: Floats, states: Floats, whole: str) -> None:
    """A smooth turn takes many steps: a force that turns by more than a right angle in one has passed zero."""
    turned = np.sum(states[:2, 1:] * states[:2, :-1], axis=0) <= 0.0
    if turned.any():
        i = int(np.argmax(turned))
        below, above = np.hypot(states[0, i : i + 2], states[1, i : i + 2])
        raise _slack(float(s[i] + (s[i + 1] - s[i]) * below / max(below + above, 1e-300)), whole)


def _slack(s: float, whole: str) -> SlackCable:
    return SlackCable(
        f"The cable goes slack: its static tension falls to zero at s = {s:.1f} m{whole} from the vehicle. "
        "The weight below that place does not stretch it; add weight or shorten the cable."
    )
