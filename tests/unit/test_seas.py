"""Random seas: what a realisation keeps of its spectrum, and what is refused."""

import numpy as np
import pytest

from data_synth import seas
from models.quantity import InvalidInput


@pytest.mark.parametrize("spectrum", ["bretschneider", "jonswap"])
def test_height_in_is_height_out(spectrum: str) -> None:
    settings = seas.RandomSea(spectrum=spectrum, significant_height=3.0, peak_period=9.0, duration=7200.0)
    for seed in (0, 1):
        trace = seas.random_sea(settings, np.random.default_rng(seed))
        assert 4.0 * np.std(trace.position[:, 2]) == pytest.approx(3.0, rel=2e-3)
        assert 4.0 * np.std(trace.position[:, 0]) == pytest.approx(3.0, rel=2e-3)


def test_surge_follows_its_ratio_and_is_forward_at_the_crest() -> None:
    full = seas.random_sea(seas.RandomSea(), np.random.default_rng(3))
    half = seas.random_sea(seas.RandomSea(surge_ratio=0.5), np.random.default_rng(3))
    assert half.position[:, 0] == pytest.approx(0.5 * full.position[:, 0])
    assert np.array_equal(half.position[:, 2], full.position[:, 2])
    assert np.corrcoef(full.rates()[:, 0], full.position[:, 2])[0, 1] > 0.9


def test_phases_come_from_the_generator() -> None:
    a, b, c = (seas.random_sea(seas.RandomSea(), np.random.default_rng(seed)).position for seed in (1, 1, 2))
    assert np.array_equal(a, b)
    assert not np.allclose(a, c)


def test_a_sea_does_not_repeat_in_its_duration() -> None:
    z = seas.random_sea(seas.RandomSea(), np.random.default_rng(5)).position[:, 2]
    z = z - z.mean()
    size = z.size
    correlation = np.fft.irfft(np.abs(np.fft.rfft(z, 2 * size)) ** 2)[:size] / (z @ z)
    assert np.abs(correlation[200 : size // 2]).max() < 0.5


def test_velocity_is_that_of_the_motion() -> None:
    trace = seas.random_sea(seas.RandomSea(sample=0.1, duration=300.0, peak_period=8.0), np.random.default_rng(0))
    assert trace.spline(trace.t, 1)[50:-50] == pytest.approx(trace.rates()[50:-50], abs=1e-4)


def test_a_calm_sea_is_still() -> None:
    assert not seas.random_sea(seas.RandomSea(significant_height=0.0), np.random.default_rng(0)).position.any()


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"spectrum": "bretshneider"}, "one of bretschneider, jonswap"),
        ({"gamma": 3.3}, "used by jonswap only"),
        ({"sample": 1.1}, "at least ten samples"),
        ({"spectrum": "jonswap", "gamma": 0.5}, "gamma"),
        ({"peak_period": 0.0}, "peak_period"),
    ],
)
def test_bad_settings_are_refused_in_words(settings: dict, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        seas.RandomSea(**settings)


def test_a_sea_too_fast_for_its_times_is_refused() -> None:
    with pytest.raises(InvalidInput, match=r"steps below 0\.785398 s"):
        seas.realise(lambda w: seas.bretschneider(w, 1.0, 1.0), (0.2, 4.0), np.arange(100.0), np.random.default_rng(0))


def test_a_short_sea_still_has_its_height_on_average() -> None:
    settings = seas.RandomSea(duration=60.0, significant_height=2.0)
    squares = [np.mean(seas.random_sea(settings, np.random.default_rng(k)).position[:, 2] ** 2) for k in range(300)]
    assert 4.0 * np.sqrt(np.mean(squares)) == pytest.approx(2.0, rel=0.03)
