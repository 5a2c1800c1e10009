"""The reduced models against independent integrations of T (6.1)-(6.7)."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from models import reduced
from models.chain import Chain, quadratic_motion
from models.delayed import FirstOrder, SecondOrder
from models.drive import GAMMA, Drive
from models.inertial import Inertial
from models.linear_model import linear_motion, state_space
from models.massless import Massless
from models.trace import Trace

Floats = NDArray[np.float64]
STIFFNESS = np.array([88.0, 81.0, 74.0, 67.0])
LINK = 300.0


def spring_forces(chain: Chain, power: int, ship_speed: Callable[[float], float]) -> Callable[[float, Floats], Floats]:
    """T (6.4) and (6.7) as printed, in spring forces and flows; `power` 1 is linear, 2 quadratic drag."""
    k, r, m = chain
    n = k.size

    def rate(t: float, z: Floats) -> Floats:
        e = np.append(z[:n], 0.0)
        if m.any():
            f = z[n:]
            drag = r * f * np.abs(f) ** (power - 1)
            return np.concatenate([k * (np.append(ship_speed(t), f[:-1]) - f), (e[:-1] - e[1:] - drag) / m])
        net = (e[:-1] - e[1:]) / r
        f = np.sign(net) * np.abs(net) ** (1.0 / power)
        return k * (np.append(ship_speed(t), f[:-1]) - f)

    return rate


def integrate(chain: Chain, power: int, ship: Trace, delay: float, speed: float) -> tuple[Floats, Floats]:
    """Vehicle position and velocity at the ship's times, from a steady tow at `speed` (0: from rest)."""
    k, r, m = chain
    begin, first = ship.t[0], float(ship.position[0, 0])

    def ship_speed(t: float) -> float:
        return float(ship.spline(t - delay, 1)[0]) if t - delay >= begin else speed

    def ship_position(t: Floats) -> Floats:
        return np.where(t - delay >= begin, ship.at(t - delay)[:, 0], first + speed * (t - delay - begin))

    start = np.cumsum(r[::-1])[::-1] * speed * abs(speed) ** (power - 1)
    if m.any():
        start = np.append(start, np.full(k.size, speed))
    rate = spring_forces(chain, power, ship_speed)
    scale = np.append(np.full(k.size, 100.0), np.full(start.size - k.size, 0.3))
    solution = solve_ivp(
        rate, (begin, ship.t[-1]), start, "LSODA", ship.t, rtol=1e-10, atol=1e-10 * scale, max_step=1.0
    )
    assert solution.success
    e = solution.y[: k.size]
    velocity = solution.y[-1] if m.any() else np.sign(e[-1]) * (np.abs(e[-1]) / r[-1]) ** (1.0 / power)
    return ship_position(ship.t) - (e / k[:, None]).sum(axis=0), velocity


def wandering_ship(step: float = 2.0, duration: float = 300.0) -> Trace:
    """Forward all the time, with a smooth start of the record in steady tow."""
    t = np.arange(0.0, duration + step / 2, step)
    swell = 1.0 - np.cos(0.05 * np.maximum(t - 60.0, 0.0))
    return Trace.along_x(t, 1000.0 + 0.3 * t + 2.0 * swell)


def models(drag: str) -> dict[str, reduced.ReducedModel]:
    """One model of each kind, of several sizes."""
    loose = 0.5 if drag == "linear" else 1.0
    return {
        "second-order": SecondOrder(drag=drag, spring=0.0065, damping=2.8 * loose, delay=7.3),
        "first-order": FirstOrder(drag=drag, spring=0.0023 / loose, delay=7.3),
        "massless-1": Massless(drag=drag, stiffness=STIFFNESS[:1], link=LINK, vehicle_drag=5000.0 * loose),
        "massless-4": Massless(drag=drag, stiffness=STIFFNESS, link=LINK, cable_drag=14.0 * loose, vehicle_drag=2200.0),
        "inertial-1": Inertial(
            drag=drag, stiffness=STIFFNESS[:1], link=LINK, vehicle_drag=5000.0 * loose, vehicle_mass=2400.0
        ),
        "inertial-4": Inertial(
            drag=drag,
            stiffness=STIFFNESS,
            link=LINK,
            cable_drag=14.0 * loose,
            cable_mass=1.27,
            vehicle_drag=2200.0 * loose,
            vehicle_mass=2400.0,
        ),
        "inertial-4-light": Inertial(
            drag=drag,
            stiffness=STIFFNESS,
            link=LINK,
            cable_drag=24.0 * loose,
            cable_mass=3.7,
            vehicle_drag=0.002,
            vehicle_mass=150.0,
        ),
    }


@pytest.mark.parametrize("drag", ["linear", "quadratic"])
@pytest.mark.parametrize("kind", list(models("linear")))
def test_against_the_printed_equations(kind: str, drag: str) -> None:
    model = models(drag)[kind]
    ship = wandering_ship()
    drive = Drive.from_trace(ship, start="steady", max_step=1 / 64)
    delay = getattr(model, "delay", 0.0)
    position, velocity = integrate(model.chain(), 2 if drag == "quadratic" else 1, ship, delay, drive.start_speed)
    response = reduced.respond(model, drive)
    np.testing.assert_allclose(response.velocity, velocity, atol=2e-6)
    np.testing.assert_allclose(response.position, position, atol=2e-5)


@pytest.mark.parametrize("kind", ["second-order", "inertial-4"])
def test_through_reversal_from_rest(kind: str) -> None:
    model = models("quadratic")[kind]
    t = np.arange(0.0, 401.0)
    ship = Trace.along_x(t, 10.0 * np.sin(0.04 * t) ** 2 * np.sin(0.017 * t))
    _, velocity = integrate(model.chain(), 2, ship, getattr(model, "delay", 0.0), 0.0)
    response = reduced.respond(model, Drive.from_trace(ship, max_step=1 / 16))
    np.testing.assert_allclose(response.velocity, velocity, atol=1e-5)


def test_massless_through_reversal_against_implicit_euler() -> None:
    """One link from rest and through reversal, each Euler step solved in closed form, and extrapolated."""
    model = models("quadratic")["massless-1"]
    t = np.arange(0.0, 241.0)
    ship = Trace.along_x(t, 10.0 * np.sin(0.04 * t) ** 2)
    k, r = float(STIFFNESS[0]), 5000.0

    def euler(cut: int) -> Floats:
        fine = np.linspace(t[0], t[-1], cut * (t.size - 1) + 1)
        h, x = fine[1], np.zeros(fine.size)
        for j, u in enumerate(ship.at(fine[1:])[:, 0], start=1):
            # r v|v| + h k v = k (u - x)
            gap = k * (u - x[j - 1])
            x[j] = x[j - 1] + h * np.sign(gap) * 2.0 * abs(gap) / (h * k + np.sqrt((h * k) ** 2 + 4.0 * r * abs(gap)))
        return x[::cut]

    response = reduced.respond(model, Drive.from_trace(ship, max_step=1 / 64))
    np.testing.assert_allclose(response.position, 2.0 * euler(256) - euler(128), atol=5e-5)


def test_chain_against_a_dense_newton_formulation() -> None:
    rng = np.random.default_rng(4)
    n = 6
    chain = Chain(rng.uniform(30.0, 90.0, n), rng.uniform(10.0, 5000.0, n), rng.uniform(0.1, 500.0, n))
    t = np.arange(0.0, 61.0)
    drive = Drive.from_trace(Trace.along_x(t, np.cumsum(rng.normal(0.0, 0.5, t.size))), max_step=1.0)
    K = np.diag(chain.k + np.append(chain.k[1:], 0.0)) - np.diag(chain.k[1:], 1) - np.diag(chain.k[1:], -1)
    pull = np.zeros(n)
    pull[0] = chain.k[0]
    x, v = np.zeros(n), np.zeros(n)
    found = [0.0]
    h = 0.5
    g = GAMMA * h

    def stage(xh: Floats, vh: Floats, u: float) -> Floats:
        w = vh.copy()
        for _ in range(60):
            residual = chain.m / g * (w - vh) - pull * u + K @ (xh + g * w) + chain.r * w * np.abs(w)
            w = w - np.linalg.solve(np.diag(chain.m / g + 2.0 * chain.r * np.abs(w)) + g * K, residual)
        return w

    for u1, u2 in drive.fine.stage:
        first = stage(x, v, u1)
        xh, vh = x + (h - g) * first, v + (h - g) / g * (first - v)
        v = stage(xh, vh, u2)
        x = xh + g * v
        found.append(v[-1])
    np.testing.assert_allclose(quadratic_motion(chain, drive, path="implicit").v, found[::2], atol=3e-9)


@pytest.mark.parametrize("n", [1, 3, 12])
@pytest.mark.parametrize("inertial", [False, True])
@pytest.mark.parametrize("even", [True, False])
def test_linear_chain_against_the_matrix_exponential(n: int, inertial: bool, even: bool) -> None:
    rng = np.random.default_rng(n)
    m = rng.uniform(5.0, 3000.0, n) if inertial else np.zeros(n)
    chain = Chain(rng.uniform(20.0, 90.0, n), rng.uniform(300.0, 3000.0, n), m)
    t = np.arange(0.0, 30.0) if even else np.cumsum(rng.uniform(0.2, 9.0, 30))
    drive = Drive.from_trace(Trace.along_x(t, np.cumsum(rng.normal(0.0, 0.5, t.size))))
    system = state_space(chain)
    size = len(system.A)
    whole = np.zeros((size + 3, size + 3))
    whole[:size, :size], whole[:size, size : size + 1] = system.A, system.B
    whole[size, size + 1] = whole[size + 1, size + 2] = 1.0
    z = np.zeros(size)
    found = [0.0]
    propagator = {interval: expm(whole * interval) for interval in np.diff(t)}
    for interval, rates in zip(np.diff(t), drive.rates, strict=False):
        z = (propagator[interval] @ np.append(z, rates))[:size]
        found.append(float(system.C[0] @ z))
    np.testing.assert_allclose(linear_motion(chain, drive).v, found, atol=1e-10)


@pytest.mark.parametrize("kind", [kind for kind in models("linear") if kind != "inertial-4-light"])
def test_frequency_response_of_linear_models(kind: str) -> None:
    model = models("linear")[kind]
    omega = 0.05
    t = np.arange(0.0, 6000.0, 0.5)
    response = reduced.respond(model, Drive.from_trace(Trace.along_x(t, 8.0 * np.sin(omega * t))))
    late = t > 5000.0
    basis = np.stack([np.sin(omega * t[late]), np.cos(omega * t[late])], axis=1)
    a, b = np.linalg.lstsq(basis, response.position[late], rcond=None)[0] / 8.0
    expected = reduced.linearise(model).response(np.array([omega]))[0]
    assert a + 1j * b == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("kind", ["second-order", "first-order", "massless-4", "inertial-4"])
def test_describing_function_predicts_the_first_harmonic(kind: str) -> None:
    model = models("quadratic")[kind]
    omega, amplitude = 0.02, 20.0
    t = np.arange(0.0, 20 * 2 * np.pi / omega)
    response = reduced.respond(model, Drive.from_trace(Trace.along_x(t, amplitude * np.sin(omega * t))))
    late = t > 10 * 2 * np.pi / omega
    basis = np.stack([np.sin(omega * t[late]), np.cos(omega * t[late])], axis=1)
    a, b = np.linalg.lstsq(basis, response.position[late], rcond=None)[0] / amplitude
    expected = reduced.linearise(model, ship_amplitude=amplitude, omega=omega).response(np.array([omega]))[0]
    # The describing function itself is good to a few per cent of the ship's motion.
    assert abs(a + 1j * b - expected) < 0.05


@pytest.mark.parametrize("drag", ["linear", "quadratic"])
@pytest.mark.parametrize("kind", ["second-order", "first-order"])
@pytest.mark.parametrize("delay", [0.0, 0.4, 7.0, 33.3, 900.0])
@pytest.mark.parametrize("start", ["rest", "steady"])
def test_delay_equals_a_ship_that_is_late(kind: str, drag: str, delay: float, start: str) -> None:
    model = models(drag)[kind]
    assert isinstance(model, SecondOrder | FirstOrder)
    ship = wandering_ship(step=1.0)
    drive = Drive.from_trace(ship, start=start, max_step=0.25)
    delayed = reduced.respond(replace(model, delay=delay), drive)
    # The late ship on its own: the same model without a delay, read at the earlier times from a fine record.
    fine = np.linspace(ship.t[0], ship.t[-1], 20 * (len(ship) - 1) + 1)
    late = Drive.from_trace(Trace.along_x(fine, ship.at(fine)[:, 0]), start=start, max_step=0.25)
    plain = reduced.respond(replace(model, delay=0.0), late)
    when = ship.t - delay
    known = when >= ship.t[0]
    np.testing.assert_allclose(delayed.velocity[known], np.interp(when, fine, plain.velocity)[known], atol=1e-4)
    np.testing.assert_allclose(delayed.position[known], np.interp(when, fine, plain.position)[known], atol=1e-3)
    np.testing.assert_array_equal(delayed.velocity[~known], drive.start_speed)
    before = plain.position[0] + drive.start_speed * (when - ship.t[0])
    np.testing.assert_allclose(delayed.position[~known], before[~known], atol=1e-9)
