"""Peaks of a response between the points of its grid."""

import math

import numpy as np
import pytest

from ident.response_peaks import decibels, highest, peaks


def uneven(low: float, high: float, count: int) -> np.ndarray:
    """Frequencies that lie closer together at the low end."""
    return low + (high - low) * np.linspace(0.0, 1.0, count) ** 1.5


def test_a_parabola_in_decibels_is_met_exactly_on_an_uneven_grid() -> None:
    omega = uneven(0.1, 2.0, 12)
    found = peaks(omega, 3.0 * 10.0 ** (-40.0 * (omega - 0.7312) ** 2 / 20.0))
    assert len(found) == 1
    assert found[0].omega == pytest.approx(0.7312, rel=1e-9)
    assert found[0].level == pytest.approx(3.0, rel=1e-9)
    assert found[0].decibels == pytest.approx(20.0 * math.log10(3.0), rel=1e-9)


@pytest.mark.parametrize("damping_ratio", [0.05, 0.2])
def test_a_resonance_is_found_between_the_points(damping_ratio: float) -> None:
    omega = np.linspace(0.2, 2.0, 37)
    size = 1.0 / np.abs(1.0 - omega**2 + 2.0j * damping_ratio * omega)
    (peak,) = peaks(omega, size)
    assert peak.omega == pytest.approx(math.sqrt(1.0 - 2.0 * damping_ratio**2), abs=0.003)
    assert peak.level == pytest.approx(0.5 / damping_ratio / math.sqrt(1.0 - damping_ratio**2), rel=0.03)


def test_the_reference_moves_the_decibels_alone() -> None:
    omega = np.linspace(0.0, 1.0, 21)
    size = 5.0 + np.sin(math.pi * omega)
    (one,), (other,) = peaks(omega, size), peaks(omega, size, reference=0.1)
    assert (one.omega, one.level) == (other.omega, other.level)
    assert other.decibels == pytest.approx(one.decibels + 20.0)


def test_the_ends_of_the_range_are_no_peaks() -> None:
    omega = np.linspace(0.1, 1.0, 10)
    assert peaks(omega, omega) == ()
    assert peaks(omega, 1.0 / omega) == ()


def test_what_does_not_stand_out_is_no_peak() -> None:
    omega = np.linspace(0.0, 1.0, 101)
    ripple = 0.5 * np.cos(60.0 * omega)
    size = 10.0 ** ((10.0 * np.exp(-40.0 * (omega - 0.5) ** 2) + ripple) / 20.0)
    (clear,) = peaks(omega, size, prominence=3.0)
    assert abs(clear.omega - 0.5) < 0.06
    assert clear.prominence > 9.0
    assert len(peaks(omega, size)) == 5


def test_a_flat_top_is_one_peak() -> None:
    found = peaks(np.arange(7.0), np.array([1.0, 2.0, 3.0, 3.0, 3.0, 2.0, 1.0]))
    assert [(peak.omega, peak.level) for peak in found] == [(3.0, pytest.approx(3.0))]


def test_complex_amplitudes_count_by_their_size_and_silence_has_no_peak() -> None:
    omega = np.linspace(0.0, 1.0, 11)
    size = 1.0 + np.exp(-50.0 * (omega - 0.45) ** 2)
    (turned,), (plain,) = peaks(omega, size * np.exp(3.0j * omega)), peaks(omega, size)
    assert (turned.omega, turned.level) == pytest.approx((plain.omega, plain.level), rel=1e-12)
    assert peaks(omega, np.zeros(11)) == ()
    assert peaks(omega[:2], size[:2]) == ()


def test_a_zero_between_two_peaks_is_no_error() -> None:
    found = peaks(np.arange(7.0), np.array([0.5, 1.0, 0.5, 0.0, 1.0, 2.0, 1.0]))
    assert [round(peak.omega, 6) for peak in found] == [1.0, 5.0]
    assert highest(found) == found[1]
    assert highest(()) is None


def test_decibels() -> None:
    assert decibels([10.0, 1.0, -0.1]).tolist() == pytest.approx([20.0, 0.0, -20.0])
    assert decibels(2.0, 2.0) == 0.0
    assert decibels(0.0) == -math.inf
