"""Intervals, profiles, correlations and verdicts."""

import math

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.cases import Case, case_from_truth
from ident.identifiability import examine
from ident.objective import residuals
from ident.profile import profile_interval
from ident.residuals import autocovariance, examine_residuals, memory_length
from ident.search_space import SearchSpace
from ident.sensitivity import covariance, sensitivities
from models import reduced
from models.delayed import FirstOrder
from models.massless import Massless
from models.reduced import ReducedModel
from models.trace import Trace

T = np.arange(0.0, 3601.0)
SHIP = Trace.along_x(T, -22.0 * np.cos(0.011 * T) - 4.0 * np.cos(0.037 * T + 1.0))
FIRST = FirstOrder(drag="linear", spring=0.009, delay=12.0)
CHAIN = Massless(
    drag="quadratic", stiffness=np.array([95.0, 90.0, 84.0, 78.0]), link=300.0, cable_drag=14.2, vehicle_drag=2240.0
)


def noisy(model: ReducedModel, noise: np.ndarray) -> Case:
    """A record whose velocity is the model's plus noise."""
    track = reduced.simulate(model, SHIP)
    assert track.velocity is not None
    velocity = np.array(track.velocity)
    velocity[:, 0] += noise
    return case_from_truth("noisy", SHIP, Trace(t=track.t, position=track.position, velocity=velocity), 300.0)


def white(seed: int, sigma: float = 0.01) -> np.ndarray:
    return sigma * np.random.default_rng(seed).standard_normal(T.size)


def test_sensitivities_are_the_derivatives_by_the_logarithm() -> None:
    case, space = noisy(FIRST, white(0)), SearchSpace.of(FIRST)
    J = sensitivities(space, space.coordinates(FIRST), [case])
    moved = FirstOrder(drag="linear", spring=FIRST.spring * math.exp(1e-6), delay=FIRST.delay)
    change = residuals(moved, [case]) - residuals(FIRST, [case])
    np.testing.assert_allclose(J[:, 0], change / 1e-6, atol=1e-5)


def test_white_residuals_give_the_covariance_of_least_squares() -> None:
    case, space = noisy(FIRST, white(1)), SearchSpace.of(FIRST)
    spread = covariance(space, space.coordinates(FIRST), [case])
    np.testing.assert_allclose(np.diag(spread.covariance), 0.01**2 * np.diag(spread.inverse), rtol=0.3)
    assert spread.degrees > 1000


def test_autocorrelated_residuals_give_the_true_covariance() -> None:
    # Moving average over 90 samples: the exact covariance is known, that of white residuals is far too small.
    space, u = SearchSpace.of(FIRST), SearchSpace.of(FIRST).coordinates(FIRST)
    width = 90
    ratio = []
    for seed in range(8):
        noise = lfilter(np.ones(width) / width, 1.0, white(seed, 0.05))
        case = noisy(FIRST, noise)
        spread = covariance(space, u, [case])
        J = sensitivities(space, u, [case])
        smoothed = lfilter(np.ones(width) / width, 1.0, J[::-1], axis=0)[::-1]
        exact = 0.05**2 * spread.inverse @ (smoothed.T @ smoothed) @ spread.inverse
        ratio.append(np.sqrt(np.diag(spread.covariance) / np.diag(exact)))
        naive = 0.05**2 / width * np.diag(spread.inverse)
        assert np.all(naive < 0.2 * np.diag(exact))
    np.testing.assert_allclose(np.mean(ratio, axis=0), 1.0, atol=0.2)


def test_the_memory_of_a_moving_average_is_found() -> None:
    noise = lfilter(np.ones(20), 1.0, white(3))
    gamma = autocovariance(noise)
    assert 15 <= memory_length(gamma / gamma[0], noise.size) <= 60
    gamma = autocovariance(white(3))
    assert memory_length(gamma / gamma[0], noise.size) <= 3


def test_the_profile_of_a_parabola_is_its_curvature() -> None:
    A = np.array([[2.0, 1.5], [0.0, 0.7], [0.3, 0.0]])
    threshold = 0.04
    half = math.sqrt(threshold * np.linalg.inv(A.T @ A)[0, 0])
    low, high = profile_interval(
        lambda x: A @ x,
        np.zeros(2),
        np.full(2, -5.0),
        np.full(2, 5.0),
        0,
        threshold=threshold,
        half_width=0.3 * half,
        slope=np.array([1.0, 0.0]),
    )
    assert high == pytest.approx(half, rel=0.05)
    assert low == pytest.approx(-half, rel=0.05)


def test_a_profile_that_levels_out_ends_at_the_range() -> None:
    low, high = profile_interval(
        lambda x: np.array([1.0 - math.exp(x[0]), 0.1 * x[1]]),
        np.zeros(2),
        np.full(2, -20.0),
        np.full(2, 20.0),
        0,
        threshold=4.0,
        half_width=2.0,
        slope=np.array([1.0, 0.0]),
    )
    assert low == -20.0
    assert high == pytest.approx(math.log(3.0), rel=0.05)


def test_a_well_determined_parameter_and_a_loose_one() -> None:
    case, space = noisy(FIRST, white(4, 0.02)), SearchSpace.of(FIRST)
    tight = examine(space, space.coordinates(FIRST), [case])
    assert [p.verdict for p in tight.intervals] == ["yes", "yes"]
    assert tight.intervals[0].low < 0.009 < tight.intervals[0].high
    assert not tight.flat
    case = noisy(FIRST, white(4, 1.0))
    loose = examine(space, space.coordinates(FIRST), [case])
    assert loose.intervals[1].verdict == "no (wide)"
    assert loose.intervals[1].half_width > 0.2


def test_the_total_drag_is_determined_where_the_split_is_not() -> None:
    case, space = noisy(CHAIN, white(5, 0.05)), SearchSpace.of(CHAIN)
    found = examine(space, space.coordinates(CHAIN), [case])
    assert abs(found.correlation[0, 1]) > 0.95
    assert found.total_drag is not None
    assert found.total_drag.value == pytest.approx(3 * 300.0 * 14.2 + 2240.0)
    assert found.total_drag.low < found.total_drag.value < found.total_drag.high
    width = [math.log(p.high / p.low) for p in (*found.intervals, found.total_drag)]
    assert width[2] < width[0] < width[1]
    assert found.directions[0].factor < found.directions[-1].factor
    assert "vehicle_drag" in found.directions[-1].text


def test_collinear_parameters_need_a_narrower_interval() -> None:
    # The same record and noise: the split passes alone at 20 %, but not in a pair of correlation above 0.98.
    case, space = noisy(CHAIN, white(6, 0.02)), SearchSpace.of(CHAIN)
    found = examine(space, space.coordinates(CHAIN), [case])
    assert abs(found.correlation[0, 1]) > 0.98
    cable = found.intervals[0]
    assert 0.04 < cable.half_width < 0.20
    assert cable.verdict == "no (correlated)"


def test_residuals_without_structure_stay_in_their_bands() -> None:
    outside = []
    for seed in range(12):
        case = noisy(FIRST, white(seed))
        test = examine_residuals(case, case.residual(reduced.respond(FIRST, case.drive)))
        assert test.memory <= 3.0
        assert test.autocorrelation[0] == pytest.approx(1.0)
        outside.append(test.cross_outside)
    assert 0.01 < np.mean(outside) < 0.10


def test_a_wrong_delay_shows_in_the_cross_correlation() -> None:
    case = noisy(FIRST, white(8, 0.001))
    late = FirstOrder(drag="linear", spring=0.009, delay=20.0)
    test = examine_residuals(case, case.residual(reduced.respond(late, case.drive)))
    assert abs(test.cross_peak[0]) > test.cross_band
    assert test.memory > 20.0
