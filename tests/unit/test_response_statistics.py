"""Statistics of a response, beside quadrature of the Rayleigh law and beside random peaks and records."""

import numpy as np
import pytest
from scipy.integrate import quad

from models import response_statistics as statistics
from models.quantity import InvalidInput
from models.response_statistics import Extreme


@pytest.mark.parametrize("n", [1.0, 3.0, 10.0, 1000.0])
def test_highest_average_is_the_mean_of_the_tail(n: float) -> None:
    level = np.sqrt(2.0 * np.log(n))
    beyond, _ = quad(lambda x: np.exp(-0.5 * x * x), level, 40.0)
    mean_peak = level + n * beyond  # by parts: int_level^inf x f dx / P(x > level)
    assert statistics.highest_average(1.5, n) == pytest.approx(2.0 * 1.5 * mean_peak, rel=1e-9)


def test_the_factors_that_the_paper_prints() -> None:
    assert statistics.significant(1.0) == pytest.approx(4.004, abs=5e-4)
    assert statistics.highest_average(1.0, 10.0) == pytest.approx(5.09, abs=5e-3)
    assert statistics.highest_average(1.0, 1000.0) == pytest.approx(7.94, abs=5e-3)
    assert statistics.exceeded_by_one_in(1.0, 1000.0) == pytest.approx(7.43, abs=5e-3)
    # H Table IV: R_1/1000 over R_1/3 of 1.854 to 1.862.
    ratio = statistics.exceeded_by_one_in(1.0, 1000.0) / statistics.significant(1.0)
    assert 1.854 <= ratio <= 1.862


def test_heights_of_a_narrow_band_record() -> None:
    rng = np.random.default_rng(7)
    peaks = rng.rayleigh(2.0, 1_000_000)
    heights = np.sort(2.0 * peaks)[::-1]
    assert heights[: heights.size // 3].mean() == pytest.approx(float(statistics.significant(2.0)), rel=3e-3)
    assert heights[: heights.size // 10].mean() == pytest.approx(float(statistics.highest_average(2.0, 10.0)), rel=3e-3)
    assert heights[heights.size // 1000] == pytest.approx(float(statistics.exceeded_by_one_in(2.0, 1000.0)), rel=1e-2)


def test_crossings_of_a_random_record() -> None:
    rng = np.random.default_rng(3)
    omega = np.linspace(0.5, 1.5, 400)
    density = np.exp(-(((omega - 0.9) / 0.15) ** 2))
    size = np.sqrt(2.0 * density * (omega[1] - omega[0]))
    t = np.arange(0.0, 6000.0, 0.2)
    record = np.zeros(t.size)
    for om, a, phase in zip(omega, size, rng.uniform(0.0, 2.0 * np.pi, omega.size), strict=True):
        record += a * np.cos(om * t + phase)
    sigma, rate = np.sqrt(0.5 * np.sum(size**2)), np.sqrt(0.5 * np.sum((omega * size) ** 2))
    ups = np.flatnonzero((record[:-1] < 0.0) & (record[1:] >= 0.0))
    measured = (t[ups[-1]] - t[ups[0]]) / (ups.size - 1)
    assert measured == pytest.approx(float(statistics.zero_crossing_period(sigma, rate)), rel=0.02)


def test_slack_is_the_share_of_peaks_above_the_static_tension() -> None:
    peaks = np.random.default_rng(1).rayleigh(1.0, 400_000)
    for tension in (0.5, 1.0, 2.5):
        assert np.mean(peaks > tension) == pytest.approx(float(statistics.slack_probability(tension, 1.0)), rel=0.02)
    assert statistics.slack_probability([3.0, 0.0, -1.0, 5.0], [0.0, 1.0, 1.0, 0.1]) == pytest.approx([0, 1, 1, 0])


@pytest.mark.parametrize("cycles", [10.0, 100.0, 10_000.0])
def test_expected_extreme_beside_the_exact_one(cycles: float) -> None:
    mean, _ = quad(lambda x: -np.expm1(cycles * np.log1p(-np.exp(-0.5 * x * x))), 1e-6, 12.0, limit=200)
    assert Extreme(sigma=1.0, cycles=cycles).expected == pytest.approx(mean, rel=0.02)


def test_extremes_of_random_storms() -> None:
    rng = np.random.default_rng(5)
    extreme = Extreme(sigma=2.0, cycles=500.0)
    largest = rng.rayleigh(2.0, (20_000, 500)).max(axis=1)
    assert largest.mean() == pytest.approx(extreme.expected, rel=0.01)
    counts, edges = np.histogram(largest, bins=60)
    mode = 0.5 * (edges[counts.argmax()] + edges[counts.argmax() + 1])
    assert mode == pytest.approx(extreme.most_probable, rel=0.03)
    for chance in (0.5, 0.1, 0.01):
        level = extreme.exceeded_with(chance)
        assert np.mean(largest > level) == pytest.approx(chance, rel=0.15)
        assert extreme.chance_above(level) == pytest.approx(chance, rel=1e-9)


def test_extremes_over_a_duration() -> None:
    made = Extreme.over(3600.0, sigma=3.0, rate=3.0 * 2.0 * np.pi / 12.0)
    assert made.cycles == pytest.approx(300.0)
    assert made.most_probable == pytest.approx(3.0 * np.sqrt(2.0 * np.log(300.0)))
    # One in N exceeds the most probable largest peak, and a height is two peaks.
    assert 2.0 * made.most_probable == pytest.approx(float(statistics.exceeded_by_one_in(3.0, 300.0)))


def test_a_response_that_stands_still_has_no_period() -> None:
    assert np.isnan(statistics.zero_crossing_period([0.0, 0.0], [0.0, 1.0])).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: statistics.highest_average(1.0, 0.5), "at least 1, but it is 0.5"),
        (lambda: statistics.exceeded_by_one_in(-1.0, 3.0), "at least 0"),
        (lambda: statistics.significant([1.0, np.nan]), "finite"),
        (lambda: statistics.slack_probability(1.0, -1.0), "at least 0"),
        (lambda: Extreme(sigma=1.0, cycles=3.0), "at least 10 cycles"),
        (lambda: Extreme.over(-5.0, sigma=1.0, rate=1.0), "above 0 s"),
        (lambda: Extreme.over(60.0, sigma=1.0, rate=1.0), "take a longer one"),
        (lambda: Extreme.over(60.0, sigma=0.0, rate=0.0), "stands still"),
        (lambda: Extreme(sigma=1.0, cycles=50.0).exceeded_with(0.0), "chance"),
    ],
)
def test_what_has_no_statistics(call: object, message: str) -> None:
    assert callable(call)
    with pytest.raises(InvalidInput, match=message):
        call()
