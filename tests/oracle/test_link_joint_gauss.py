"""Gauss's principle in the dense form that W prints, and a naive linearly implicit step, beside the kernel's."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ident.benchmark.dense_chain import accelerations, lumps
from models.link_joint import gauss
from models.link_joint.chain import Chain, build
from models.link_joint.columns import work_for
from models.link_joint.energy import energy_of, power_of
from models.link_joint.simulation import LARGEST_IMBALANCE
from models.tow import Tow
from models.towed_system import TowedSystem


def naive_run(
    system: TowedSystem,
    ship: Callable[[float], tuple[np.ndarray, np.ndarray, np.ndarray]],
    links: int,
    step: float,
    end: float,
) -> tuple[np.ndarray, ...]:
    """Times, places, velocities, accelerations (k, n + 1, 3) and tensions (k, n), from rest under a ship that stands.

    One linear solve a step. Drag is implicit with the speed of the step's start, the multipliers hold the links (with
    Baumgarte's terms), but their directions are those of the step's start: the geometric stiffness is explicit.
    """
    part = system.parts[0]
    size, omega = part.cable.length / links, 0.5 / step
    x = np.zeros((links + 1, 3))
    x[:, 2] = -size * np.arange(links + 1)
    v = np.zeros_like(x)
    times, record = np.arange(round(end / step) + 1) * step, []
    for t in times:
        x[0], v[0], pull = ship(t)
        M, weight, C = lumps(part, system.water_density, x, v)
        r, rate = np.diff(x, axis=0), np.diff(v, axis=0)
        correction = 2.0 * omega * (r * rate).sum(axis=1) + 0.5 * omega**2 * ((r**2).sum(axis=1) - size**2)
        a, T = accelerations(M + step * C, weight - C @ v[1:].ravel(), x, v, pull, correction)
        record.append((x.copy(), v.copy(), np.concatenate([[pull], a]), T))
        v[1:] += step * a
        x[1:] += step * v[1:]
    return times, *(np.array(each) for each in zip(*record, strict=True))


def random_state(length: float, links: int, seed: int, planar: bool) -> tuple[np.ndarray, np.ndarray]:
    """Places and velocities (links + 1, 3) of rigid links, each turning at a rate of its own; row 0 moves freely."""
    rng = np.random.default_rng(seed)
    plane = np.array([1.0, 0.0 if planar else 1.0, 1.0])
    t = plane * rng.normal(size=(links, 3)) - np.array([0.0, 0.0, 1.0])
    r = length / links * t / np.linalg.norm(t, axis=1)[:, None]
    start = plane * rng.normal(size=(2, 1, 3))
    turning = plane * np.cross(0.02 * rng.normal(size=(links, 3)), r)
    return (
        np.concatenate([start[0], start[0] + np.cumsum(r, axis=0)]),
        np.concatenate([start[1], start[1] + np.cumsum(turning, axis=0)]),
    )


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("seed", range(5))
def test_the_kernel_solves_the_accelerations(configurations: Callable[[str], Tow], seed: int, planar: bool) -> None:
    """Any shape, also a pushing one; the kernel eliminates link by link, the printed form takes a pseudo-inverse.

    Without the cable's drag, which the kernel lumps in its own way; the body has its own.
    """
    tow = configurations("autec-1200")
    bare = replace(tow.cable, axial_stiffness=1e15, normal_drag_coefficient=0.0, tangential_drag_coefficient=0.0)
    tow = replace(tow, cable=bare)
    system, links = TowedSystem.from_tow(tow), 24
    x, v = random_state(1200.0, links, seed, planar)
    ship, axes = np.array([0.3, 0.0 if planar else -0.2, 0.5]), [0, 2] if planar else [0, 1, 2]
    M, weight, C = lumps(system.parts[0], 1025.0, x, v)
    exact, tension = accelerations(M, weight - C @ v[1:].ravel(), x, v, ship)
    chain, moving = build(system, links).chain, (each[::-1][:, axes] for each in (x, v))
    found, T = gauss.accelerations(chain, *moving, np.zeros(links), ship[axes])
    np.testing.assert_allclose(found[:-1][::-1], exact[:, axes], rtol=1e-8, atol=1e-8 * np.abs(exact).max())
    np.testing.assert_allclose(T[::-1], tension, rtol=1e-8, atol=1e-8 * np.abs(tension).max())
    assert np.abs(tension).max() > 200.0


def swaying(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Place, velocity and acceleration of a ship that sways 20 m, eased in over a minute."""
    q, omega = t / 60.0, 0.02
    left = math.exp(-(q**3))
    e, e_1, e_2 = 1.0 - left, 3.0 * q**2 * left / 60.0, (6.0 * q - 9.0 * q**4) * left / 3600.0
    s, c = math.sin(omega * t), math.cos(omega * t)
    x = 20.0 * np.array([e * s, e_1 * s + e * omega * c, e_2 * s + 2.0 * e_1 * omega * c - e * omega**2 * s])
    return tuple(np.array([one, 0.0, 0.0]) for one in x)  # type: ignore[return-value]


def imbalance(chain: Chain, times: np.ndarray, *states: np.ndarray) -> float:
    """The kernel's own account of energy over a run, as a share of the work turned over."""
    n, step = chain.length.size, float(times[1])
    x, v, a, T = (np.ascontiguousarray(each[:, ::-1]) for each in states)
    work = work_for(n + 1)
    energy = [energy_of(chain, n, x[k], v[k], T[k], work) for k in range(times.size)]
    power = np.array([power_of(chain, n, x[k], v[k], a[k], T[k], work) for k in range(times.size)])
    drag, other = power[:, 1], power[:, 0] - power[:, 1]
    worked = float(np.trapezoid(power[:, 0], dx=step))
    turnover = float(np.trapezoid(np.abs(drag) + np.abs(other), dx=step))
    return abs(energy[-1] - energy[0] - worked) / turnover


def test_the_account_of_energy_catches_the_naive_step(configurations: Callable[[str], Tow]) -> None:
    """Past one transit of a link its track stays bounded and smooth, and is wrong by a third; the account tells."""
    tow = configurations("autec-1200")
    cable = replace(tow.cable, axial_stiffness=1e15)
    system, links, end = TowedSystem.from_tow(replace(tow, cable=cable)), 20, 600.0
    chain = build(system, links).chain
    transit = 60.0 * math.sqrt((cable.mass + cable.added_mass) / 28_000.0)
    t, *fine = naive_run(system, swaying, links, 0.5 * transit, end)
    late, *coarse = naive_run(system, swaying, links, 1.11 * transit, end)
    right, wrong = fine[0][:, -1, 0], coarse[0][:, -1, 0]
    # Bounded, closed and smooth to the eye: the velocity changes by little from step to step.
    assert np.isfinite(wrong).all()
    assert np.abs(wrong).max() < 1.5 * np.abs(right).max()
    assert np.abs(np.linalg.norm(np.diff(coarse[0], axis=1), axis=2) - 60.0).max() < 60.0 * 1e-3
    assert np.abs(np.diff(coarse[1][:, -1, 0])).max() < 0.05 * np.abs(coarse[1][:, -1, 0]).max()
    error = np.interp(t, late, wrong) - right
    assert error.std() > 0.3 * right.std()
    assert imbalance(chain, t, *fine) < 0.2 * LARGEST_IMBALANCE
    assert imbalance(chain, late, *coarse) > 5.0 * LARGEST_IMBALANCE
