"""The spectral simulator's tables, refusals and results."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from data_synth.ships import Sinusoids, sinusoids
from models.quantity import InvalidInput, NumericalFailure
from models.spectral import STEPPERS, initial_speed, simulate, simulation
from models.spectral.basis import QUADRATURE, SINE, X, prepare, smallest_stations
from models.statics import SlackCable, static_shape
from models.tow import Tow
from models.trace import Trace


@pytest.fixture(scope="module")
def short() -> Trace:
    return sinusoids(
        Sinusoids(
            duration=120.0,
            sample=0.5,
            surge_amplitudes=(8.0,),
            surge_omegas=(0.08,),
            heave_amplitudes=(0.3,),
            heave_omegas=(0.5,),
        )
    )


def test_a_known_shape_gives_its_coefficients_back(configurations: Callable[[str], Tow]) -> None:
    """Projection of q = eta_1 (1 - x) + eta_2 x + sum Q_n sin(n pi x) by the model's own stations."""
    rng = np.random.default_rng(3)
    fields = prepare(replace(configurations("mangus-740"), speed=0.5), harmonics=12)
    x, weight = fields.station[X], fields.station[QUADRATURE]
    Q, eta_1, eta_2 = rng.normal(size=12), 2.0, -3.0
    n = np.arange(1, 13)
    sines = np.sin(math.pi * n[:, None] * x)
    assert weight.sum() == pytest.approx(740.0)
    q = eta_1 * (1.0 - x) + eta_2 * x + Q @ sines
    projected = 2.0 / 740.0 * fields.sines[0] @ (weight * (q - eta_1 * (1.0 - x) - eta_2 * x))
    np.testing.assert_allclose(projected, Q, atol=1e-10)
    slope = fields.sines[1].T @ Q
    np.testing.assert_allclose(slope, (Q * n * math.pi / 740.0) @ np.cos(math.pi * n[:, None] * x), atol=1e-12)
    shape = static_shape(replace(configurations("mangus-740"), speed=0.5))
    np.testing.assert_allclose(fields.station[SINE], np.sin(np.interp(x * 740.0, shape.s, shape.phi)), atol=1e-6)


def test_the_cable_drawn_has_the_amplitudes_of_the_state(configurations: Callable[[str], Tow], short: Trace) -> None:
    """A vertical cable bends along -X only, so its drawing projects back on the sines by a dense sum."""
    tow = configurations("mangus-740")
    result = simulate(tow, short, harmonics=8)
    for sample in (60, 151, 240):
        X_, _ = result.cable_at(sample, points=2001)
        x = np.linspace(0.0, 1.0, 2001)
        q = -(X_ - short.position[0, 0])
        q -= q[0] * (1.0 - x) + q[-1] * x
        Q = [2.0 * np.trapezoid(q * np.sin(n * math.pi * x), x) for n in range(1, 9)]
        np.testing.assert_allclose(Q, result.amplitudes[sample, 2:], atol=1e-6)
        assert np.abs(result.amplitudes[sample, 2:]).max() > 0.1


@pytest.mark.parametrize("stepper", STEPPERS)
def test_the_cable_drawn_runs_from_vehicle_to_ship(
    configurations: Callable[[str], Tow], short: Trace, stepper: str
) -> None:
    """At every sample, also where a step of the method passes over several of them."""
    tow = replace(configurations("mangus-740"), speed=0.3)
    ship = Trace.along_x(short.t, 100.0 + 0.3 * short.t + short.position[:, 0], short.position[:, 2])
    result = simulate(
        tow, ship, harmonics=6, tolerance=1e-3, step=0.7 if stepper == "newmark" else None, stepper=stepper
    )
    for sample in range(0, 241, 16):
        x, z = result.cable_at(sample)
        np.testing.assert_allclose([x[0], z[0]], result.vehicle.position[sample, [0, 2]], atol=1e-9)
        np.testing.assert_allclose([x[-1], z[-1]], ship.position[sample, [0, 2]], atol=1e-9)


def test_results_do_not_depend_on_the_sampling(configurations: Callable[[str], Tow], short: Trace) -> None:
    """Position, velocity, tension and amplitudes belong to the sample's time, not to the step's end."""
    t = np.arange(0.0, 120.1, 0.125)
    fine = sinusoids(
        Sinusoids(
            duration=120.0,
            sample=0.125,
            surge_amplitudes=(8.0,),
            surge_omegas=(0.08,),
            heave_amplitudes=(0.3,),
            heave_omegas=(0.5,),
        )
    )
    assert fine.t.size == t.size
    one, four = (simulate(configurations("mangus-740"), s, harmonics=6, tolerance=1e-5) for s in (short, fine))
    assert np.abs(one.vehicle.position - four.vehicle.position[::4]).max() < 2e-4
    assert np.abs(one.amplitudes - four.amplitudes[::4]).max() < 2e-4
    swing = np.ptp(one.vehicle.tension[:, 1])
    assert np.abs(one.vehicle.tension - four.vehicle.tension[::4]).max() < 2e-3 * swing


def test_too_many_harmonics_for_the_stations_are_refused_and_wrong(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    ship = sinusoids(Sinusoids(duration=300.0, surge_amplitudes=(10.0,), surge_omegas=(0.05,)))
    needed = smallest_stations(24)
    with pytest.raises(InvalidInput, match=rf"24 harmonics need at least {needed} stations .* but 16 were"):
        simulate(tow, ship, harmonics=24, stations=16)
    right = simulate(tow, ship, harmonics=24, stations=needed).vehicle
    wrong = simulate(tow, ship, harmonics=24, stations=16, allow_aliasing=True).vehicle
    many = simulate(tow, ship, harmonics=24, stations=4 * needed).vehicle
    assert right.velocity is not None
    assert np.abs(right.velocity - many.velocity).max() < 1e-4
    assert np.abs(wrong.velocity - many.velocity).max() > 1e-2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"stepper": "euler"}, "one of implicit, newmark, runge-kutta, but 'euler'"),
        ({"start": "moving"}, "rest or steady, but 'moving'"),
        ({"tolerance": -1e-4}, "above 0 m/s, but -0.0001 m/s"),
        ({"tolerance": math.nan}, "above 0 m/s, but nan"),
        ({"step": 0.0}, "above 0 s, but 0 s"),
        ({"harmonics": 0}, "at least 1 harmonic, but 0"),
        ({"drag_angle": "frozen"}, "one of moved, as-printed, but 'frozen'"),
        ({"end_condition": "strong"}, "one of weak, pointwise, but 'strong'"),
    ],
)
def test_options_refused(
    configurations: Callable[[str], Tow], short: Trace, options: dict[str, object], message: str
) -> None:
    with pytest.raises(InvalidInput, match=message):
        simulate(configurations("mangus-740"), short, **options)


def test_a_track_out_of_the_plane_is_refused_with_the_amount(
    configurations: Callable[[str], Tow], short: Trace
) -> None:
    position = np.array(short.position)
    position[:, 1] = np.linspace(3.0, 15.5, len(short))
    with pytest.raises(InvalidInput, match=r"planar, but the ship leaves the plane by 12\.5 m"):
        simulate(configurations("mangus-740"), Trace(t=short.t, position=position))
    # A constant y is a plane like any other.
    position[:, 1] = 7.0
    result = simulate(configurations("mangus-740"), Trace(t=short.t, position=position), harmonics=4)
    assert np.all(result.vehicle.position[:, 1] == 7.0)


def test_a_missing_ship_sample_is_named(configurations: Callable[[str], Tow], short: Trace) -> None:
    position = np.array(short.position)
    position[6, 2] = np.nan
    with pytest.raises(InvalidInput, match=r"sample 6 at t = 3 s is missing"):
        simulate(configurations("mangus-740"), Trace(t=short.t, position=position))


def test_slack_is_raised_with_time_and_place(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    light = replace(tow, vehicle=replace(tow.vehicle, weight_in_water=500.0))
    sea = sinusoids(
        Sinusoids(
            duration=60.0,
            sample=0.1,
            surge_amplitudes=(),
            surge_omegas=(),
            heave_amplitudes=(2.0,),
            heave_omegas=(0.8,),
        )
    )
    for stepper in STEPPERS:
        with pytest.raises(SlackCable, match=r"slack at t = \d+\.\d\d s, s = \d+\.\d m of 740 m"):
            simulate(light, sea, harmonics=4, stepper=stepper, step=0.05)


def test_a_budget_of_steps(configurations: Callable[[str], Tow], short: Trace, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulation, "STEP_BUDGET", 7)
    for stepper in STEPPERS:
        with pytest.raises(NumericalFailure, match=r"budget of 7 steps by t = \d+\.\d\d s"):
            simulate(configurations("mangus-740"), short, harmonics=4, stepper=stepper, step=0.2)


def test_newmark_corrects_a_coarse_step(configurations: Callable[[str], Tow], short: Trace) -> None:
    """A slow correction renews its factors instead of giving up."""
    tow = configurations("mangus-740")
    result = simulate(tow, short, harmonics=4, stepper="newmark", step=0.8, tolerance=1e-5)
    fine = simulate(tow, short, harmonics=4)
    assert np.sqrt(np.mean((result.vehicle.velocity - fine.vehicle.velocity)[:, 0] ** 2)) < 2e-3


def test_initial_speed_is_the_mean_of_the_first_minute() -> None:
    t = np.arange(0.0, 200.0, 0.5)
    assert initial_speed(Trace.along_x(t, 3.0 + 0.01 * t**2)) == pytest.approx(0.6)
    assert initial_speed(Trace.along_x(t[:41], 0.5 * t[:41])) == pytest.approx(0.5)


def test_steady_start_is_a_steady_tow(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("autec-1200")
    t = np.arange(0.0, 300.0, 2.0)
    result = simulate(tow, Trace.along_x(t, -40.0 + 0.6 * t), start="steady")
    shape = static_shape(replace(tow, speed=0.6))
    np.testing.assert_allclose(result.vehicle.velocity[:, 0], 0.6, atol=1e-9)
    np.testing.assert_allclose(result.vehicle.position[:, 0], -40.0 + 0.6 * t + shape.x[0], atol=1e-6)
    assert result.tow.speed == pytest.approx(0.6)
    np.testing.assert_allclose(result.vehicle.tension, [[shape.T[-1], shape.T[0]]] * t.size, rtol=1e-9)


def test_two_samples_are_a_straight_line(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    two = simulate(tow, Trace.along_x([0.0, 60.0], [0.0, 12.0]), harmonics=6)
    many = simulate(tow, Trace.along_x(np.arange(0.0, 61.0), 0.2 * np.arange(0.0, 61.0)), harmonics=6)
    assert two.vehicle.position[-1, 0] == pytest.approx(many.vehicle.position[-1, 0], abs=1e-5)


@pytest.mark.parametrize(("amplitude", "omega"), [(25.0, 2e-4), (250.0, 2e-4), (25.0, 5e-4)])
def test_slow_motion_of_a_tied_vehicle_is_followed_in_few_steps(
    amplitude: float, omega: float, configurations: Callable[[str], Tow]
) -> None:
    """Where every place is tied to the ship's the factors hide a step's error; it must be seen, and cheaply."""
    tow = configurations("mangus-740")
    t = np.linspace(0.0, 10.0 * math.pi / omega, 301)
    ship = Trace.along_x(t, -amplitude * np.expm1(-((0.16 * omega * t) ** 3)) * np.sin(omega * t))
    run = simulate(tow, ship)
    exact = simulate(tow, ship, harmonics=run.harmonics, tolerance=1e-9)
    assert run.vehicle.velocity is not None
    assert exact.vehicle.velocity is not None
    error = float(np.sqrt(np.mean(np.sum((run.vehicle.velocity - exact.vehicle.velocity) ** 2, axis=1))))
    assert error < 1e-4
    assert run.error is not None
    assert error < 2.0 * run.error
    assert run.steps < 500


def test_the_largest_turn_of_the_cable(configurations: Callable[[str], Tow]) -> None:
    """A ship that has towed to a steady trail: the cable's steepest turn is at the vehicle, U^2 B/W there."""
    tow = configurations("mangus-740")
    t = np.arange(0.0, 6000.0)
    run = simulate(tow, Trace.along_x(t, 0.2 * (t - 300.0 * -np.expm1(-t / 300.0))))
    shape = static_shape(replace(tow, speed=0.2))
    assert run.largest_angle == pytest.approx(0.5 * math.pi - float(shape.phi.min()), rel=0.05)
