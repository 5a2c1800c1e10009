"""Inputs and operators against something independent: quadrature, SciPy's filters, published check values."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson, quad, solve_ivp
from scipy.signal import savgol_filter

from data_synth import seas, ships
from data_synth.sensors import differentiator, usbl_smoother
from models.trace import Trace


def _integrated(trace: Trace, velocity, breaks=()) -> None:
    """The trace's x is the adaptive quadrature of an independently written velocity, interval by interval."""
    cuts = np.unique([0.0, *(b for b in breaks if 0.0 < b < trace.t[-1]), trace.t[-1]])
    for a, b in pairwise(cuts):
        inside = trace.t[(trace.t >= a) & (trace.t <= b)]
        for end in inside[[len(inside) // 3, -1]]:
            travelled = quad(velocity, a, end, epsabs=1e-10, epsrel=1e-10, limit=200)[0]
            from_a = trace.position[trace.t == end, 0][0] - trace.position[trace.t == a, 0][0]
            assert from_a == pytest.approx(travelled, abs=1e-7)
    middle = trace.t[5:-5:37]
    middle = middle[~np.isin(middle, cuts)]
    assert np.interp(middle, trace.t, trace.rates()[:, 0]) == pytest.approx([velocity(t) for t in middle], abs=1e-12)


def test_sinusoids_against_quadrature() -> None:
    amplitudes, omegas, phases = (25.0, 4.0), (0.011, 0.05), (0.3, -1.0)
    trace = ships.sinusoids(
        ships.Sinusoids(
            surge_amplitudes=amplitudes,
            surge_omegas=omegas,
            surge_phases=phases,
            heave_amplitudes=(1.5,),
            heave_omegas=(0.2,),
            heave_phases=(0.7,),
        )
    )

    def velocity(t: float) -> float:
        return sum(a * o * np.cos(o * t + p) for a, o, p in zip(amplitudes, omegas, phases, strict=True))

    _integrated(trace, velocity, breaks=np.arange(0.0, 3600.0, 400.0))
    rise = quad(lambda t: 1.5 * 0.2 * np.cos(0.2 * t + 0.7), 0.0, 100.0, epsabs=1e-11)[0]
    assert trace.position[100, 2] - trace.position[0, 2] == pytest.approx(rise, abs=1e-9)
    assert trace.rates()[100, 2] == pytest.approx(0.3 * np.cos(20.7))


@pytest.mark.parametrize("first", [0.0, 100.0])
def test_ramps_against_quadrature(first: float) -> None:
    times, speeds = (first, 400.0, 1000.0, 1060.0), (0.1, 0.5, -0.3, 0.2)
    trace = ships.ramps(ships.Ramps(times=times, speeds=speeds))
    _integrated(trace, lambda t: float(np.interp(t, times, speeds)), breaks=times)


def test_first_order_against_an_ode() -> None:
    times, speeds, lags = (50.0, 900.0, 1700.0), (0.4, -0.1, 0.3), (60.0, 20.0, 150.0)
    trace = ships.first_order(ships.FirstOrder(times=times, speeds=speeds, time_constants=lags))
    # Each change is its own lag u' = (dv - u)/T from its order on; x is the integral of their sum.
    state, x = np.zeros(3), 0.0
    cuts = [0.0, *times, 3600.0]
    changes = np.diff(speeds, prepend=0.0)
    for part, (a, b) in enumerate(pairwise(cuts)):
        ordered = np.where(np.arange(3) < part, changes, 0.0)

        def slopes(_t: float, y: np.ndarray, ordered: np.ndarray = ordered) -> np.ndarray:
            return np.append((ordered - y[:3]) / lags, y[:3].sum())

        end = solve_ivp(slopes, (a, b), [*state, x], rtol=1e-11, atol=1e-12, method="DOP853").y[:, -1]
        state, x = end[:3], end[3]
        assert trace.position[int(b), 0] == pytest.approx(x, abs=1e-7)
        assert trace.rates()[int(b), 0] == pytest.approx(state.sum(), abs=1e-9)


def test_step_against_quadrature() -> None:
    trace = ships.step(ships.Step(speed=-0.4, start=600.0))
    _integrated(trace, lambda t: -0.4 if t >= 600.0 else 0.0, breaks=[600.0])


def test_standard_input_against_simpson() -> None:
    trace = ships.standard_input(ships.StandardInput(), np.random.default_rng(2))
    x = cumulative_simpson(trace.rates()[:, 0], x=trace.t, initial=0.0)
    assert trace.position[:, 0] == pytest.approx(x, abs=2e-3)


@pytest.mark.parametrize(
    "trace",
    [
        ships.starts_and_stops(ships.StartsAndStops(sample=0.5)),
        ships.sharp_transients(ships.SharpTransients(sample=0.5)),
        ships.few_sinusoids(ships.FewSinusoids(sample=0.5)),
    ],
    ids=["starts-and-stops", "sharp-transients", "few-sinusoids"],
)
def test_manoeuvres_against_simpson(trace: Trace) -> None:
    x = cumulative_simpson(trace.rates()[:, 0], x=trace.t, initial=0.0)
    assert trace.position[:, 0] == pytest.approx(x, abs=2e-3)


@pytest.mark.parametrize("gamma", [1.0, 3.3, 7.0])
def test_spectra_hold_the_variance_of_their_height(gamma: float) -> None:
    peak = 0.6
    for density in (
        lambda omega: float(seas.bretschneider(omega, 5.0, peak)),
        lambda omega: float(seas.jonswap(omega, 5.0, peak, gamma)),
    ):
        variance = sum(
            quad(density, a, b, epsabs=1e-12)[0] for a, b in ((0.1, 0.5), (0.5, peak), (peak, 0.8), (0.8, 60.0))
        )
        assert 4.0 * np.sqrt(variance) == pytest.approx(5.0, rel=1e-6)


def test_bretschneider_has_its_known_value_and_peak() -> None:
    assert seas.bretschneider(0.5, 4.0, 0.5) == pytest.approx(5.0 / 16.0 * 16.0 / 0.5 * np.exp(-1.25))
    omega = np.linspace(0.3, 1.2, 90_001)
    assert omega[np.argmax(seas.bretschneider(omega, 4.0, 0.5))] == pytest.approx(0.5, abs=1e-4)


def test_jonswap_enhances_the_peak_and_is_bretschneider_without() -> None:
    omega = np.linspace(0.2, 3.0, 200)
    assert seas.jonswap(omega, 2.0, 0.7, 1.0) == pytest.approx(seas.bretschneider(omega, 2.0, 0.7))
    # Peak enhancement 3.3 by the area 1.5 that it adds (Goda's fit 1/(1 - 0.287 ln gamma) for the area).
    gain = seas.jonswap(0.7, 2.0, 0.7) / seas.bretschneider(0.7, 2.0, 0.7)
    assert gain == pytest.approx(3.3 * (1.0 - 0.287 * np.log(3.3)), rel=0.01)


def test_a_realisation_has_the_spectrum_it_came_from() -> None:
    settings = seas.RandomSea(duration=14_400.0, significant_height=4.0, peak_period=10.0, spectrum="jonswap")
    z = seas.random_sea(settings, np.random.default_rng(0)).position[:, 2]
    power = 2.0 * np.abs(np.fft.rfft(z)) ** 2 / z.size**2
    omega = 2.0 * np.pi * np.fft.rfftfreq(z.size, 0.5)
    peak = 0.2 * np.pi
    for low, high in ((0.4, 0.55), (0.55, 0.7), (0.7, 1.0), (1.0, 2.0)):
        inside = (omega >= low) & (omega < high)
        expected = quad(lambda w: float(seas.jonswap(w, 4.0, peak)), low, high, points=[peak])[0]
        assert power[inside].sum() == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize(("interval", "points"), [(10.0, 9), (5.0, 19), (1.0, 91)])
def test_differentiator_is_savitzky_golay_on_a_uniform_record(interval: float, points: int) -> None:
    t = np.arange(0.0, 1200.0 + interval / 2, interval)
    x = np.random.default_rng(0).standard_normal(t.size)
    for order in (1, 2, 3):
        operator = differentiator(t, order=order)
        expected = savgol_filter(x, points, order, deriv=1, delta=interval)
        assert operator.velocity(x) == pytest.approx(expected[operator.index], abs=1e-12)


def _kalman_and_rts(t: np.ndarray, fixes: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """The source's smoother on one axis, written out: filter forward, smooth back."""
    Q, R = 1e-3 * np.eye(2), np.diag([15.0, 0.01])
    observations = np.column_stack([fixes, speeds])
    mean, covariance = observations[0], R
    means, covariances, predicted, spreads, moves = [mean], [covariance], [], [], []
    for k in range(1, t.size):
        F = np.array([[1.0, t[k] - t[k - 1]], [0.0, 1.0]])
        ahead, spread = F @ mean, F @ covariance @ F.T + Q
        gain = spread @ np.linalg.inv(spread + R)
        mean = ahead + gain @ (observations[k] - ahead)
        covariance = (np.eye(2) - gain) @ spread
        means.append(mean)
        covariances.append(covariance)
        predicted.append(ahead)
        spreads.append(spread)
        moves.append(F)
    smooth = means[-1]
    track = [smooth[0]]
    for k in range(t.size - 2, -1, -1):
        back = covariances[k] @ moves[k].T @ np.linalg.inv(spreads[k])
        smooth = means[k] + back @ (smooth - predicted[k])
        track.append(smooth[0])
    return np.array(track[::-1])


def test_usbl_smoother_is_kalman_and_rauch_tung_striebel() -> None:
    rng = np.random.default_rng(0)
    t = np.cumsum(rng.choice([5.0, 5.01, 10.0, 14.8], 120, p=[0.6, 0.3, 0.07, 0.03]))
    fixes, speeds = np.cumsum(rng.standard_normal(t.size)), 0.3 * rng.standard_normal(t.size)
    expected = _kalman_and_rts(t, fixes, speeds)
    assert usbl_smoother(t).published(fixes, speeds) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("period", "survives", "leaks"), [(300.0, 0.58, 0.38), (600.0, 0.86, 0.14)])
def test_usbl_smoother_leaks_the_ship_as_the_records_say(period: float, survives: float, leaks: float) -> None:
    t = 5.0 * np.arange(450)
    operator = usbl_smoother(t)
    omega = 2.0 * np.pi / period
    tone, middle = np.exp(1j * omega * t), 225
    assert abs((operator.fixes @ tone)[middle]) == pytest.approx(survives, abs=0.005)
    assert abs(omega * (operator.leak @ tone)[middle]) == pytest.approx(leaks, abs=0.005)
