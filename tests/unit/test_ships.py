"""Ship inputs: settings are checked, scales are exact, sums are sums."""

import numpy as np
import pytest

from data_synth import inputs, ships
from models.quantity import InvalidInput
from models.trace import Trace


@pytest.mark.parametrize("seed", range(5))
def test_standard_input_reaches_its_maximum_speed_exactly(seed: int) -> None:
    trace = ships.standard_input(ships.StandardInput(), np.random.default_rng(seed))
    assert len(trace) == 3601
    assert trace.t[-1] == 3600.0
    assert np.abs(trace.velocity).max() == 0.5
    assert trace.position[0, 0] == 0.0


def test_standard_input_is_the_same_for_the_same_seed_only() -> None:
    first, again, other = (
        ships.standard_input(ships.StandardInput(), np.random.default_rng(seed)).position for seed in (7, 7, 8)
    )
    assert np.array_equal(first, again)
    assert not np.allclose(first, other)


def test_standard_input_has_its_power_below_the_cutoff() -> None:
    velocity = ships.standard_input(ships.StandardInput(), np.random.default_rng(0)).rates()[:, 0]
    power = np.abs(np.fft.rfft(velocity)) ** 2
    omega = 2.0 * np.pi * np.fft.rfftfreq(velocity.size, 1.0)
    assert power[omega < 0.06].sum() > 0.9 * power.sum()
    assert power[omega > 0.3].sum() < 1e-3 * power.sum()


def test_biases_last_a_segment() -> None:
    settings = ships.StandardInput(noise_sigma=0.0, biases=(0.2, -0.2), segment=600.0)
    for seed in range(4):
        signs = np.sign(ships.standard_input(settings, np.random.default_rng(seed)).rates()[400::600, 0])
        drawn = np.random.default_rng(seed)
        drawn.standard_normal(3601)
        assert np.array_equal(signs, np.sign(drawn.choice([0.2, -0.2], size=6)))


def test_the_spline_of_the_standard_input_gives_its_velocity_back() -> None:
    trace = ships.standard_input(ships.StandardInput(), np.random.default_rng(0))
    error = trace.spline(trace.t, 1)[:, 0] - trace.rates()[:, 0]
    assert np.sqrt(np.mean(error**2)) < 3e-5
    assert np.abs(error).max() < 5e-4


@pytest.mark.parametrize("kind", inputs.KINDS)
def test_every_kind_has_usable_defaults(kind: str) -> None:
    trace = inputs.ship_trace(inputs.KINDS[kind](), np.random.default_rng(0))
    assert trace.t[-1] > 2000.0
    assert trace.valid.all()
    assert trace.velocity is not None
    # The trace's own spline moves as the closed form says; kinks of velocity cost a little.
    error = trace.spline(trace.t, 1)[10:-10] - trace.rates()[10:-10]
    assert np.sqrt(np.mean(error**2)) < 2e-3 * np.abs(trace.rates()).max()


@pytest.mark.parametrize("kind", [kind for kind, settings in inputs.KINDS.items() if hasattr(settings, "duration")])
def test_duration_and_sample_are_kept(kind: str) -> None:
    trace = inputs.ship_trace(inputs.KINDS[kind](duration=900.0, sample=0.5), np.random.default_rng(0))
    assert trace.t[-1] == 900.0
    assert np.diff(trace.t) == pytest.approx(0.5)


def test_starts_and_stops_keep_one_direction_about_a_quarter_metre_a_second() -> None:
    v = ships.starts_and_stops(ships.StartsAndStops()).rates()[:, 0]
    assert v.min() >= 0.0
    assert v.max() <= 0.5 + 1e-12
    assert np.mean(v) == pytest.approx(0.25, abs=0.03)
    assert np.sum((v[1:] < 1e-3) & (v[:-1] >= 1e-3)) >= 5


def test_sharp_transients_are_sharp_and_have_steady_stretches() -> None:
    v = ships.sharp_transients(ships.SharpTransients()).rates()[:, 0]
    assert np.abs(v).max() <= 0.5 + 1e-12
    assert np.abs(np.diff(v)).max() > 0.05
    assert np.mean(np.abs(np.diff(v)) < 1e-12) > 0.5


def test_few_sinusoids_move_to_the_printed_amplitudes() -> None:
    trace = ships.few_sinusoids(ships.FewSinusoids())
    x = trace.position[:, 0]
    rest = 0.5 * 0.2 * 240.0
    assert x[240] == pytest.approx(rest)
    assert x[240 : 240 + 720].max() - rest == pytest.approx(2 * 25.0, abs=1e-3)
    assert rest - x[960 : 960 + 720].min() == pytest.approx(2 * 50.0, abs=1e-3)
    assert np.abs(trace.rates()).max() <= 0.5


def test_superpose_adds_on_the_first_times() -> None:
    slow = ships.step(ships.Step(speed=0.3, duration=100.0, sample=1.0))
    tone = ships.sinusoids(
        ships.Sinusoids(duration=120.0, sample=0.5, surge_amplitudes=(1.0,), surge_omegas=(0.1,), surge_phases=(0.4,))
    )
    both = ships.superpose(slow, tone)
    assert np.array_equal(both.t, slow.t)
    expected = 0.3 * slow.t + np.sin(0.1 * slow.t + 0.4)
    assert both.position[:, 0] == pytest.approx(expected, abs=1e-12)
    assert both.rates()[:, 0] == pytest.approx(0.3 + 0.1 * np.cos(0.1 * slow.t + 0.4), abs=1e-6)
    assert np.array_equal(ships.superpose(slow).position, slow.position)


def test_superpose_does_not_guess_beyond_a_motion() -> None:
    long, short = (Trace.along_x(np.arange(n), np.zeros(n)) for n in (100, 50))
    with pytest.raises(InvalidInput, match=r"number 2 lasts from 0 to 49 s"):
        ships.superpose(long, short)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ships.StandardInput(max_speed=0.0), r"StandardInput\.max_speed \(v_max\) must be above 0 m/s"),
        (lambda: ships.StandardInput(biases=(0.0, np.nan)), r"StandardInput\.biases\[1\]"),
        (lambda: ships.StandardInput(biases=()), "at least one value"),
        (lambda: ships.StandardInput(cutoff=4.0), r"below pi/sample = 3\.14159 rad/s"),
        (lambda: ships.Sinusoids(surge_amplitudes=(1.0, 2.0)), "surge_amplitudes has 2, surge_omegas has 1"),
        (lambda: ships.Sinusoids(surge_phases=(1.0, 2.0)), "surge_phases has 2"),
        (lambda: ships.Ramps(times=(0.0, 0.0), speeds=(1.0, 2.0)), "must increase"),
        (lambda: ships.Ramps(times=(), speeds=()), "at least one"),
        (lambda: ships.FirstOrder(time_constants=(1.0,)), "time_constants has 1"),
        (lambda: ships.StartsAndStops(rise=400.0), "longer than a run or a pause of 150 s"),
        (lambda: ships.StartsAndStops(runs=()), "at least one speed, one run and one pause"),
        (lambda: ships.SharpTransients(rise=60.0), "longer than the shortest interval of 40 s"),
        (lambda: ships.FewSinusoids(cycles=(0, 1, 1, 1)), r"FewSinusoids\.cycles\[0\]"),
        (lambda: ships.step(ships.Step(duration=3.0)), "at least 4 steps"),
    ],
)
def test_bad_settings_are_refused_in_words(make, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        make()


def test_a_silent_standard_input_is_refused() -> None:
    with pytest.raises(InvalidInput, match="zero throughout"):
        ships.standard_input(ships.StandardInput(noise_sigma=0.0, biases=(0.0,)), np.random.default_rng(0))
