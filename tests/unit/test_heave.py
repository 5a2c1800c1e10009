"""Peaks of heave, and the second-order system fitted to it, on signals whose answers are known."""

import math

import numpy as np
import pytest

from ident.heave import find_heave_peaks, fit_heave
from ident.turning import _dip

T = np.arange(0.0, 3001.0)
PERIOD, ZETA, SIZE, DROP, TAU = 500.0, 0.05, 150.0, 1200.0, 600.0
W = 2.0 * math.pi / PERIOD
A = W * ZETA / math.sqrt(1.0 - ZETA**2)


def turn(*, size: float = SIZE, drop: float = DROP, zeta: float = ZETA) -> tuple[np.ndarray, np.ndarray]:
    """Heave that sinks by `drop` and swings with a first peak at t = 0, and its velocity."""
    a = W * zeta / math.sqrt(1.0 - zeta**2)
    swing, sink = size * np.exp(-a * T), drop * np.exp(-T / TAU)
    z = -2000.0 + sink + swing * np.cos(W * T)
    return z, -sink / TAU - swing * (a * np.cos(W * T) + W * np.sin(W * T))


def test_gaps_and_decay_of_a_decaying_swing() -> None:
    z, _ = turn(drop=0.0)
    peaks = find_heave_peaks(T, z)
    assert peaks.gaps == pytest.approx(np.full(peaks.gaps.size, PERIOD), abs=5.0)
    assert peaks.gaps[1:] == pytest.approx(np.full(peaks.gaps.size - 1, PERIOD), abs=0.05)
    # The line through two troughs lies (e^(aP/2) + e^(-aP/2))/2 times the peak's size below zero.
    assert np.nanmean(peaks.decay) == pytest.approx(math.exp(-A * PERIOD), rel=1e-3)
    assert peaks.dips == 6


def test_a_slow_sinking_hardly_changes_the_height_of_a_peak() -> None:
    z, _ = turn(drop=0.0)
    alone = find_heave_peaks(T, z)
    sinking = find_heave_peaks(T, z - 0.2 * T)
    assert sinking.height[1:5] == pytest.approx(alone.height[1:5], rel=0.06)


def test_the_first_peak_is_where_a_level_body_begins_to_fall() -> None:
    z, _ = turn()
    level = np.concatenate([np.full(300, z[0]), z])
    t = np.arange(level.size, dtype=float)
    assert find_heave_peaks(t, level).t[0] == pytest.approx(300.0, abs=5.0)


def test_a_peak_lies_between_samples() -> None:
    t = np.arange(0.0, 2000.0, 10.0)
    z = np.cos(2.0 * math.pi * (t - 3.7) / 400.0) - 1e-3 * t
    assert find_heave_peaks(t, z).gaps[1:] == pytest.approx(400.0, abs=0.1)


def test_a_steady_fall_has_no_gap_and_no_fit() -> None:
    z = -2000.0 + DROP * np.exp(-T / TAU)
    peaks = find_heave_peaks(T, z)
    assert peaks.gaps.size == 0
    assert peaks.dips == 0
    assert peaks.rise == 0.0
    fitted = fit_heave(T, np.gradient(z, T), peaks)
    assert math.isnan(fitted.period)
    assert "fewer than 3 peaks" in fitted.note


def test_a_body_that_does_not_heave() -> None:
    peaks = find_heave_peaks(T, np.full(T.size, -500.0))
    assert peaks.gaps.size == 0
    assert peaks.rise == 0.0


def test_the_way_up_after_falling() -> None:
    z = np.interp(T, [0.0, 1000.0, 1500.0, 2000.0, 3000.0], [0.0, -100.0, -60.0, -120.0, -90.0])
    assert find_heave_peaks(T, z).rise == pytest.approx(40.0)


def test_the_fit_gives_back_what_the_heave_was_made_of() -> None:
    z, velocity = turn()
    fitted = fit_heave(T, velocity, find_heave_peaks(T, z))
    assert fitted.note == ""
    assert fitted.period == pytest.approx(PERIOD, rel=2e-3)
    assert fitted.damping_ratio == pytest.approx(ZETA, rel=0.02)
    assert fitted.amplitude == pytest.approx(SIZE, rel=0.02)
    assert fitted.drop == pytest.approx(DROP, rel=0.02)
    assert fitted.relaxation == pytest.approx(TAU, rel=0.02)
    assert fitted.fit_percent > 99.0
    assert fitted.plain_fit_percent < 70.0


def test_without_sinking_the_plain_system_is_enough() -> None:
    z, velocity = turn(drop=0.0)
    fitted = fit_heave(T, velocity, find_heave_peaks(T, z))
    assert fitted.period == pytest.approx(PERIOD, rel=2e-3)
    assert fitted.plain_fit_percent > 99.0


def test_a_fit_that_explains_little_is_not_made_up() -> None:
    z, _ = turn()
    noise = np.random.default_rng(3).normal(0.0, 1.0, T.size)
    fitted = fit_heave(T, noise, find_heave_peaks(T, z))
    assert "explains" in fitted.note
    assert math.isnan(fitted.period)
    assert math.isnan(fitted.damping_ratio)
    assert fitted.fit_percent < 50.0


def test_a_swing_that_dies_within_its_period_is_no_oscillation() -> None:
    z, _ = turn()
    _, velocity = turn(zeta=0.7, drop=0.0)
    fitted = fit_heave(T, velocity, find_heave_peaks(T, z))
    assert "damping ratio" in fitted.note
    assert math.isnan(fitted.amplitude)


def test_a_dip_is_timed_at_half_its_depth() -> None:
    z = np.interp(T, [0.0, 500.0, 1000.0, 2000.0, 3000.0], [-100.0, -100.0, -300.0, -100.0, -100.0])
    assert _dip(T, z) == pytest.approx(750.0, abs=2.0)
    assert math.isnan(_dip(T[:1200], z[:1200]))
