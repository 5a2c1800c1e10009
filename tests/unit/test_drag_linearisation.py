"""Linearised drag against the integrals that define it."""

import math

import numpy as np
import pytest
from numba import njit
from scipy.integrate import quad

from models.transfer_matrix import columns as c
from models.transfer_matrix.drag import body_gaussian, body_harmonic, gaussian, harmonic, mean_speed

PHASES = 2.0 * math.pi * (np.arange(100_000) + 0.5) / 100_000


@pytest.mark.parametrize(("z", "flow"), [(0.7, 0.0), (0.3, 0.5), (0.5, 0.5), (0.8, 0.5), (0.8, -0.5), (3.0, 0.01)])
def test_harmonic_drag_has_the_first_harmonic_of_the_force(z: float, flow: float) -> None:
    velocity = flow + z * np.sin(PHASES)
    force = np.mean(2.0 * velocity * np.abs(velocity) * np.sin(PHASES))
    assert harmonic(z, flow) * z == pytest.approx(force, rel=1e-8)


@pytest.mark.parametrize(("z", "flow"), [(0.7, 0.0), (0.3, 0.5), (0.8, 0.5)])
def test_harmonic_drag_loses_the_energy_that_the_drag_loses(z: float, flow: float) -> None:
    v = z * np.sin(PHASES)
    lost = np.mean(v * ((flow + v) * np.abs(flow + v) - flow * abs(flow)))
    assert harmonic(z, flow) * z * z / 2.0 == pytest.approx(lost, rel=1e-8)


def test_the_cases_meet() -> None:
    assert harmonic(0.5 * (1 + 1e-9), 0.5) == pytest.approx(harmonic(0.5, 0.5), rel=1e-6)
    assert harmonic(0.5, 1e-9) == pytest.approx(harmonic(0.5, 0.0), rel=1e-6)
    assert gaussian(0.5, 1e-9) == pytest.approx(gaussian(0.5, 0.0), rel=1e-6)
    assert gaussian(0.0, 0.0) == 0.0
    assert gaussian(1e-9, -0.5) == pytest.approx(1.0)


@pytest.mark.parametrize(("sigma", "flow"), [(0.4, 0.0), (0.4, 0.3), (0.4, -2.0)])
def test_random_drag_is_twice_the_mean_speed(sigma: float, flow: float) -> None:
    def density(v: float) -> float:
        return abs(v) * math.exp(-0.5 * ((v - flow) / sigma) ** 2) / (sigma * math.sqrt(2.0 * math.pi))

    mean = quad(density, flow - 12 * sigma, flow + 12 * sigma, points=[0.0], limit=200)[0]
    assert mean_speed(sigma, flow) == pytest.approx(mean, rel=1e-9)
    assert gaussian(sigma, flow) == pytest.approx(2.0 * mean, rel=1e-9)


@njit
def _fill(body: np.ndarray, u: complex, v: complex, D: np.ndarray) -> None:
    body_harmonic(body, u, v, D)


def _body(rng: np.random.Generator, pitches: float) -> np.ndarray:
    body = np.zeros(c.BODY_COLUMNS)
    body[c.BODY_PITCHES], body[c.BODY_COUPLED] = pitches, 1.0
    body[[c.BODY_K_P, c.BODY_K_Q]] = rng.uniform(1.0, 3.0, 2) if pitches else rng.uniform(1.0, 3.0)
    body[[c.BODY_FLOW_P, c.BODY_FLOW_Q]] = rng.normal(size=2)
    return body


def _force(body: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    point = body[c.BODY_PITCHES] == 0.0
    factor = body[c.BODY_K_P] * np.hypot(x, y) if point else body[c.BODY_K_P] * abs(x) + body[c.BODY_K_Q] * abs(y)
    return np.array([factor * x, factor * y])


@pytest.mark.parametrize(("pitches", "closeness"), [(1.0, 1e-7), (0.0, 2e-4)])
def test_coupled_drag_of_a_body_has_the_first_harmonic_of_its_force(pitches: float, closeness: float) -> None:
    rng = np.random.default_rng(4)
    for _ in range(8):
        body = _body(rng, pitches)
        u, v = (complex(*rng.normal(size=2)) for _ in range(2))
        D = np.zeros((2, 2), dtype=complex)
        _fill(body, u, v, D)
        turn = np.exp(1j * PHASES)
        force = _force(body, body[c.BODY_FLOW_P] + (u * turn).real, body[c.BODY_FLOW_Q] + (v * turn).real)
        first = np.mean(2.0 * force / turn, axis=1)
        assert np.abs(D @ np.array([u, v]) - first).max() < closeness * np.abs(first).max()


def test_a_point_that_moves_mostly_along_one_axis_has_its_small_force_right() -> None:
    """Where the larger velocity changes its sign, what it makes of the smaller one jumps."""
    rng = np.random.default_rng(8)
    for i in range(8):
        body = _body(rng, 0.0)
        body[[c.BODY_FLOW_P, c.BODY_FLOW_Q]] *= (0.3, 0.02) if i % 2 else (0.02, 0.3)
        u, v = (complex(*rng.normal(size=2)) * share for share in ((1.0, 0.05) if i % 2 else (0.05, 1.0)))
        D = np.zeros((2, 2), dtype=complex)
        _fill(body, u, v, D)
        turn = np.exp(1j * PHASES)
        force = _force(body, body[c.BODY_FLOW_P] + (u * turn).real, body[c.BODY_FLOW_Q] + (v * turn).real)
        first = np.mean(2.0 * force / turn, axis=1)
        assert np.abs((D @ np.array([u, v]) - first) / first).max() < 0.02


def test_small_motion_of_a_body_meets_the_derivative_of_its_drag() -> None:
    body = _body(np.random.default_rng(2), 1.0)
    D = np.zeros((2, 2), dtype=complex)
    _fill(body, 1e-6 + 0j, 2e-6j, D)
    u, v, step = body[c.BODY_FLOW_P], body[c.BODY_FLOW_Q], 1e-6
    up, down = (_force(body, np.array([u + s, u]), np.array([v, v + s])) for s in (step, -step))
    assert D.real == pytest.approx((up - down) / (2.0 * step), rel=1e-6)
    assert np.abs(D.imag).max() < 1e-6
    assert body_gaussian(body, np.diag([1e-16, 1e-16])).real == pytest.approx(D.real, rel=1e-6)


def test_drag_that_is_not_coupled_keeps_to_its_axes() -> None:
    body = _body(np.random.default_rng(3), 1.0)
    body[c.BODY_COUPLED] = 0.0
    D = np.ones((2, 2), dtype=complex)
    _fill(body, 0.3 + 0.1j, 0.2 + 0j, D)
    assert D[0, 1] == D[1, 0] == 0.0
    assert D[0, 0] == pytest.approx(body[c.BODY_K_P] * harmonic(abs(0.3 + 0.1j), body[c.BODY_FLOW_P]))


@pytest.mark.parametrize("pitches", [1.0, 0.0])
def test_random_drag_of_a_body_is_the_best_linear_force(pitches: float) -> None:
    rng = np.random.default_rng(6)
    body = _body(rng, pitches)
    root = rng.normal(size=(2, 2))
    covariance = root @ root.T
    drawn = rng.multivariate_normal(np.zeros(2), covariance, 2_000_000).T
    force = _force(body, body[c.BODY_FLOW_P] + drawn[0], body[c.BODY_FLOW_Q] + drawn[1])
    best = np.cov(np.vstack([force, drawn]))[:2, 2:] @ np.linalg.inv(np.cov(drawn))
    assert body_gaussian(body, covariance).real == pytest.approx(best, rel=0.01, abs=0.01 * np.abs(best).max())
