"""Continuum solutions of a towed cable in three dimensions, written apart from the simulators that they judge.

Loaded through the fixture `continuum`. Symbols: s unstretched length from the lower end up [m]; t the cable's
tangent toward the ship; F = T t the pull of what lies above [N]; u the water's velocity over the cable [m/s]; a the
material's acceleration [m/s2]. The momentum of an element and of a body of mass M with added mass B give

    dF/ds = w e_z - D(t, u) + m a + m_a (a - (a . t) t),   dx/ds = (1 + e) t,   e = T/EA,
    F(above) = F(below) + W e_z - D + (M + B) a,

with D the drag per unstretched length on the stretched area, (1 + e)(1 - nu e) times the unstretched one; no strain
by pressure, which is nu = 1/2. In a straight tow a = 0; in a circular one at
the rate Omega the velocity is Omega e_z x x and a = -Omega^2 (x, y, 0), so that the lower end's radius is the only
unknown. Everything is shot from the lower end up, where the cable gathers what hangs below.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve
from scipy.special import j0, j1, y0, y1

from models.body import Body
from models.cable import Cable
from models.towed_system import Part, TowedSystem

Floats = NDArray[np.float64]
Field = Callable[[Floats], Floats]
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, kw_only=True, eq=False)
class Line:
    """One part of a steady tow: positions (3,) and pulls F (3,) at its lower and upper end, and in between."""

    lower: Floats
    upper: Floats
    pull_lower: Floats
    pull_upper: Floats
    at: Callable[[float], Floats]

    @property
    def tension(self) -> tuple[float, float]:
        """[N] at the top and at the bottom."""
        return float(np.linalg.norm(self.pull_upper)), float(np.linalg.norm(self.pull_lower))


def _cable_drag(cable: Cable, rho: float, law: str, t: Floats, u: Floats) -> Floats:
    """Force of the water per unstretched length [N/m]: by components, or by the incidence of W with |u|^2."""
    along = float(u @ t)
    tangent, normal = along * t, u - along * t
    if law == "quadratic":
        width = cable.diameter * (math.pi if cable.tangential_area == "circumference" else 1.0)
        k_n = 0.5 * rho * cable.diameter * cable.normal_drag_coefficient
        k_t = 0.5 * rho * width * cable.tangential_drag_coefficient
        return k_n * np.linalg.norm(normal) * normal + k_t * abs(along) * tangent
    speed, across = np.linalg.norm(u), np.linalg.norm(normal)
    alpha = math.atan2(across, abs(along))
    size = 0.273 + 0.827 * alpha**2 if alpha < math.radians(30.0) else math.sin(alpha)
    return 0.5 * rho * cable.diameter * cable.normal_drag_coefficient * size * speed * u


def _above(body: Body, rho: float, below: Floats, u: Floats, a: Floats) -> Floats:
    """The cable's pull on a body [N]; surge is the horizontal direction of that pull, so it is found by iteration."""
    size = 0.5 * rho * body.drag_coefficient * np.linalg.norm(u)
    areas = np.array([body.area_surge, body.area_sway, body.area_heave])
    added = np.array([body.added_mass_surge, body.added_mass_sway, body.added_mass_heave])
    F = below + (body.weight - body.buoyancy) * UP - size * body.area_surge * u
    relaxed = min(1.0, body.area_surge / body.area_sway)
    for _ in range(1000):
        flat = math.hypot(F[0], F[1])
        ahead = np.array([F[0], F[1], 0.0]) / flat if flat > 0.0 else np.array([1.0, 0.0, 0.0])
        axes = np.stack([ahead, np.cross(UP, ahead), UP])
        drag = axes.T @ (size * areas * (axes @ u))
        new = below + (body.weight - body.buoyancy) * UP - drag + body.mass * a + axes.T @ (added * (axes @ a))
        if np.linalg.norm(new - F) <= 1e-12 * np.linalg.norm(new):
            return new
        F = F + relaxed * (new - F)
    raise RuntimeError("the direction of the body does not settle")


def climb(system: TowedSystem, start: Floats, water: Field, velocity: Field, acceleration: Field) -> list[Line]:
    """The lines of a system without branches from the lowest end up, listed from the ship down.

    `water`, `velocity` and `acceleration` are functions of the place; the lowest part needs a body.
    """
    rho, lines = system.water_density, []
    x, F = start, np.zeros(3)

    def loads(part: Part, x: Floats, F: Floats) -> Floats:
        T = math.sqrt(F @ F)
        t, a, cable = F / T, acceleration(x), part.cable
        e = T / cable.axial_stiffness
        inertia = cable.mass * a + cable.added_mass * (a - (a @ t) * t)
        drag = _cable_drag(cable, rho, system.drag_law, t, water(x) - velocity(x))
        drag *= (1.0 + e) * (1.0 - cable.poisson_ratio * e)
        return np.concatenate([(1.0 + e) * t, cable.weight_in_water * UP - drag + inertia])

    for part in reversed(system.parts):
        if part.body is not None:
            F = _above(part.body, rho, F, water(x) - velocity(x), acceleration(x))
        run = solve_ivp(
            lambda _, y, part=part: loads(part, y[:3], y[3:]),
            (0.0, part.cable.length),
            np.concatenate([x, F]),
            method="DOP853",
            rtol=1e-10,
            atol=1e-8,
            dense_output=True,
        )
        top, pull = run.y[:3, -1], run.y[3:, -1]
        lines.append(Line(lower=x, upper=top, pull_lower=F, pull_upper=pull, at=run.sol))
        x, F = top, pull
    return lines[::-1]


def straight_tow(system: TowedSystem, velocity: Floats) -> list[Line]:
    """The steady tow at a constant velocity (3,) through the system's current; the ship is at the height 0."""
    current = system.current

    def water(x: Floats) -> Floats:
        if current is None:
            return np.zeros(3)
        xy = [np.interp(-x[2], current.depth, current.velocity[:, i]) for i in (0, 1)]
        return np.array([*xy, 0.0])

    def lines(depth: float) -> list[Line]:
        return climb(system, np.array([0.0, 0.0, -depth]), water, lambda _: velocity, lambda _: np.zeros(3))

    longest = 1.1 * sum(part.cable.length for part in system.parts)
    depth = brentq(lambda d: lines(d)[0].upper[2], -1.0, longest, xtol=1e-8, rtol=1e-13)
    return lines(depth)


@dataclass(frozen=True, kw_only=True, eq=False)
class Circle:
    """A steady circular tow, seen from above: `lines` in the turning frame, with the ship at the height 0.

    `radius` [m] of each part's lower end; `lag` [rad], how far it is behind the ship; `depth` [m].
    """

    rate: float
    lines: list[Line]

    @property
    def radius(self) -> Floats:
        return np.array([math.hypot(*line.lower[:2]) for line in self.lines])

    @property
    def depth(self) -> Floats:
        return np.array([self.lines[0].upper[2] - line.lower[2] for line in self.lines])

    @property
    def lag(self) -> Floats:
        ship = math.atan2(self.lines[0].upper[1], self.lines[0].upper[0])
        behind = [ship - math.atan2(line.lower[1], line.lower[0]) for line in self.lines]
        return np.mod(math.copysign(1.0, self.rate) * np.array(behind), 2.0 * math.pi)


def circle_from(system: TowedSystem, rate: float, radius: float) -> Circle:
    """The circular tow at a rate [rad/s, counterclockwise] whose lowest end has a radius [m]."""
    lines = climb(
        system,
        np.array([radius, 0.0, 0.0]),
        lambda _: np.zeros(3),
        lambda x: rate * np.array([-x[1], x[0], 0.0]),
        lambda x: -(rate**2) * np.array([x[0], x[1], 0.0]),
    )
    return Circle(rate=rate, lines=lines)


def circular_tows(system: TowedSystem, radius: float, speed: float) -> list[Circle]:
    """All steady tows behind a ship on a circle [m] at a speed [m/s], the widest first, in still water."""
    rate = speed / radius

    def miss(log_r: float) -> float:
        return math.log(math.hypot(*circle_from(system, rate, math.exp(log_r)).lines[0].upper[:2]) / radius)

    grid = math.log(radius) + np.concatenate([np.linspace(0.7, -2.0, 28), np.linspace(-2.25, -14.0, 48)])
    values = [miss(each) for each in grid]
    roots = [
        brentq(miss, grid[i + 1], grid[i], xtol=1e-11) for i in range(len(grid) - 1) if values[i] * values[i + 1] < 0.0
    ]
    return [circle_from(system, rate, math.exp(root)) for root in roots]


def hanging_frequencies(cable: Cable, weight: float, mass: float, count: int = 3) -> Floats:
    """The lowest frequencies [rad/s] of a chain that hangs with a weight [N] and a moving mass [kg] at its end.

    y = A J0(z) + B Y0(z), z = (2 omega/w) sqrt(mu (W + w s)): y = 0 at the top, M omega^2 y + W y' = 0 at the end.
    """
    w, mu = cable.weight_in_water, cable.mass + cable.added_mass
    top = weight + w * cable.length

    def determinant(omega: float) -> float:
        z_0, z_1 = (2.0 * omega / w * math.sqrt(mu * T) for T in (weight, top))
        slope = omega * math.sqrt(mu / weight)

        def end(f: Callable[[float], float], g: Callable[[float], float]) -> float:
            return mass * omega**2 * f(z_0) - weight * slope * g(z_0)

        return float(end(j0, j1) * y0(z_1) - end(y0, y1) * j0(z_1))

    travel = 2.0 / w * math.sqrt(mu) * (math.sqrt(top) - math.sqrt(weight))
    grid = np.linspace(1e-4, 1.0, 200 * (count + 1)) * (count + 1) * math.pi / travel
    values = [determinant(each) for each in grid]
    signs = [i for i in range(len(grid) - 1) if values[i] * values[i + 1] < 0.0]
    return np.array([brentq(determinant, grid[i], grid[i + 1], xtol=1e-15) for i in signs[:count]])


@dataclass(frozen=True, kw_only=True, eq=False)
class Catenary:
    """A cable held at both ends: `H` [N], the vertical pulls at the upper and the lower end, the shape of s [m].

    s runs from the upper end; `at(s)` gives the horizontal distance and the height from the upper end, and T [N].
    """

    H: float
    V_upper: float
    V_lower: float
    at: Callable[[Floats], tuple[Floats, Floats, Floats]]


def catenary(cable: Cable, span: float, drop: float) -> Catenary:
    """The catenary in still water between ends `span` apart and `drop` below; elastic by Irvine's closed form.

    x = H s/EA + (H/w) [asinh(V/H) - asinh((V - w s)/H)],
    z = (s/EA) (V - w s/2) + (1/w) [sqrt(H^2 + V^2) - sqrt(H^2 + (V - w s)^2)], z down.
    """
    w, L, EA = cable.weight_in_water, cable.length, cable.axial_stiffness

    def shape(H: float, V: float, s: Floats) -> tuple[Floats, Floats, Floats]:
        rest = V - w * s
        x = H * s / EA + H / w * (np.arcsinh(V / H) - np.arcsinh(rest / H))
        z = s / EA * (V - 0.5 * w * s) + (math.hypot(H, V) - np.hypot(H, rest)) / w
        return x, -z, np.hypot(H, rest)

    # Rigid: sqrt(L^2 - h^2) = (2 H/w) sinh(w l/(2 H)), a start for the elastic one.
    bow = math.sqrt(L**2 - drop**2)
    b = brentq(lambda b: math.sinh(b) / b - bow / span, 1e-6, 50.0, xtol=1e-15)
    H = 0.5 * w * span / b
    V = 0.5 * w * (L + drop / math.tanh(b))

    def miss(p: Floats) -> list[float]:
        x, z, _ = shape(H * p[0], V * p[1], np.array(L))
        return [float(x) / span - 1.0, (float(z) + drop) / L]

    p, _, done, text = fsolve(miss, [1.0, 1.0], xtol=1e-14, full_output=True)
    if done != 1 and max(map(abs, miss(p))) > 1e-12:
        raise RuntimeError(text)
    H, V = H * p[0], V * p[1]
    return Catenary(H=H, V_upper=V, V_lower=V - w * L, at=lambda s: shape(H, V, s))


def tractrix(ship: Callable[[float], tuple[Floats, Floats]], start: Floats, times: Floats) -> Floats:
    """(n, 2) places of a body that is dragged by a rod behind `ship(t) -> place, velocity`, along the rod alone."""

    def rate(t: float, x: Floats) -> Floats:
        place, velocity = ship(t)
        rod = place - x
        return (rod @ velocity) / (rod @ rod) * rod

    run = solve_ivp(rate, (times[0], times[-1]), start, t_eval=times, method="DOP853", rtol=1e-11, atol=1e-11)
    return np.asarray(run.y.T)
