"""The sensor: what it measures, what it loses, and what velocity can be read from it."""

import numpy as np
import pytest

from data_synth.sensors import SensorModel, differentiator, measure, usbl_smoother
from models.quantity import InvalidInput
from models.trace import Trace


def _track(duration: float = 3600.0) -> Trace:
    t = np.arange(0.0, duration + 1.0)
    return Trace.along_x(t, 0.2 * t + 20.0 * np.sin(0.01 * t), -700.0)


def test_fixes_come_at_their_interval_with_the_offset() -> None:
    track = _track()
    fixes = measure(track, SensorModel(fix_sigma=0.0, dropout_fraction=0.0), np.random.default_rng(0))
    assert np.array_equal(fixes.t, np.arange(0.0, 3601.0, 10.0))
    assert np.abs(fixes.position - track.position[::10] - np.array([40.0, 0.0, 0.0])).max() < 1e-12


def test_fixes_between_samples_lie_on_the_spline() -> None:
    track = _track()
    model = SensorModel(fix_interval=2.5, fix_sigma=0.0, dropout_fraction=0.0, offset=0.0)
    fixes = measure(track, model, np.random.default_rng(0))
    expected = 0.2 * fixes.t + 20.0 * np.sin(0.01 * fixes.t)
    assert fixes.position[:, 0] == pytest.approx(expected, abs=1e-6)


def test_noise_has_its_sigma_on_each_axis() -> None:
    track = _track(200_000.0)
    fixes = measure(track, SensorModel(dropout_fraction=0.0, offset=0.0), np.random.default_rng(1))
    noise = fixes.position - track.position[::10]
    assert noise.std(axis=0) == pytest.approx(1.5, rel=0.02)
    assert np.abs(np.corrcoef(noise.T) - np.eye(3)).max() < 0.03


def test_dropouts_have_their_fraction_and_run_length() -> None:
    model = SensorModel(dropout_fraction=0.05, dropout_run=3.0)
    missing = ~measure(_track(1_000_000.0), model, np.random.default_rng(2)).valid
    runs = np.sum(np.diff(missing.astype(int)) == 1)
    assert missing.mean() == pytest.approx(0.05, abs=0.004)
    assert missing.sum() / runs == pytest.approx(3.0, rel=0.06)


def test_a_track_shorter_than_an_interval_is_refused() -> None:
    with pytest.raises(InvalidInput, match="at least one fix interval of 10 s"):
        measure(_track(5.0), SensorModel(), np.random.default_rng(0))


def test_sensor_settings_are_checked() -> None:
    with pytest.raises(InvalidInput, match=r"dropout_fraction \(f\)"):
        SensorModel(dropout_fraction=0.6)
    with pytest.raises(InvalidInput, match="dropout_run"):
        SensorModel(dropout_run=0.5)


def test_windows_stay_inside_the_record_and_missing_samples_are_not_scored() -> None:
    t = np.arange(0.0, 601.0, 10.0)
    valid = np.ones(t.size, dtype=bool)
    valid[30] = False
    index = differentiator(t, valid).index
    assert t[index[0]] == 50.0
    assert t[index[-1]] == 550.0
    assert 30 not in index
    assert 29 in index


def test_a_sample_at_the_edge_of_a_long_gap_has_no_velocity() -> None:
    t = np.arange(0.0, 1001.0, 10.0)
    valid = np.ones(t.size, dtype=bool)
    valid[40:60] = False
    index = set(differentiator(t, valid).index.tolist())
    assert 39 not in index
    assert 60 not in index
    assert {35, 65} <= index


def test_missing_positions_may_be_nan_and_others_may_not() -> None:
    t = np.arange(0.0, 601.0, 10.0)
    valid = np.ones(t.size, dtype=bool)
    valid[[20, 21]] = False
    operator = differentiator(t, valid)
    x = np.where(valid, 0.3 * t, np.nan)
    assert operator.velocity(x) == pytest.approx(0.3, abs=1e-12)
    x[25] = np.nan
    with pytest.raises(InvalidInput, match="marked as missing"):
        operator.velocity(x)


def test_too_few_fixes_for_any_velocity_is_said() -> None:
    with pytest.raises(InvalidInput, match="make the window longer or use a longer record"):
        differentiator(np.arange(0.0, 601.0, 60.0), window=90.0)


def test_noise_floor_is_that_of_the_operator_on_noise() -> None:
    rng = np.random.default_rng(4)
    t = np.arange(0.0, 3601.0, 10.0)
    valid = rng.random(t.size) > 0.1
    operator = differentiator(t, valid)
    squares = [np.mean(operator.velocity(1.5 * rng.standard_normal(t.size)) ** 2) for _ in range(400)]
    assert operator.noise_floor(1.5) == pytest.approx(np.sqrt(np.mean(squares)), rel=0.02)


def test_the_smoother_keeps_a_steady_tow_as_it_is() -> None:
    t = np.cumsum(np.random.default_rng(0).uniform(4.5, 15.0, 200))
    x = 1000.0 + 0.6 * t
    assert usbl_smoother(t).published(x, np.full(t.size, 0.6)) == pytest.approx(x, abs=1e-8)
    assert usbl_smoother(t).fixes.sum(axis=1) == pytest.approx(1.0)


def test_the_smoother_needs_increasing_pings() -> None:
    with pytest.raises(InvalidInput, match="increasing"):
        usbl_smoother([0.0, 5.0, 5.0])
