"""What holds for every reduced model and every ship."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from models import reduced
from models.chain import BUDGET, TOLERANCE, Chain, _march, quadratic_motion
from models.delayed import FirstOrder, SecondOrder
from models.drive import GAMMA, MAX_STEP, Drive
from models.inertial import Inertial
from models.linear_model import doublings, linear_motion
from models.massless import Massless
from models.parameter import Drag
from models.trace import Trace

Floats = NDArray[np.float64]
few = settings(max_examples=12, deadline=None)
seeds = st.integers(0, 2**32 - 1)
laws = st.sampled_from(["linear", "quadratic"])


def some_ship(seed: int, *, step: float = 1.0) -> Trace:
    """Smooth random wandering, below about one knot, on a grid of positions that large offsets do not round."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 300.0, step)
    x = sum(rng.uniform(0.5, 8.0) * (1.0 - np.cos(w * t + rng.uniform(0.0, 6.0))) for w in rng.uniform(0.005, 0.08, 3))
    return Trace.along_x(t, np.round(np.asarray(x) * 2**16) / 2**16)


def some_model(seed: int, drag: Drag) -> reduced.ReducedModel:
    rng = np.random.default_rng(seed + 1)
    n = int(rng.integers(2, 7))
    k, loose = rng.uniform(20.0, 90.0, n), 0.3 if drag == "linear" else 1.0
    cable_drag, vehicle_drag = loose * rng.uniform(5.0, 30.0), loose * 10 ** rng.uniform(0.0, 4.0)
    match rng.integers(4):
        case 0:
            return SecondOrder(
                drag=drag,
                spring=rng.uniform(0.001, 0.02),
                damping=loose * rng.uniform(1.0, 6.0),
                delay=rng.uniform(0, 30),
            )
        case 1:
            return FirstOrder(drag=drag, spring=rng.uniform(0.0003, 0.003) / loose, delay=rng.uniform(0, 30))
        case 2:
            return Massless(drag=drag, stiffness=k, link=300.0, cable_drag=cable_drag, vehicle_drag=vehicle_drag)
        case _:
            return Inertial(
                drag=drag,
                stiffness=k,
                link=300.0,
                cable_drag=cable_drag,
                cable_mass=rng.uniform(0.1, 5.0),
                vehicle_drag=vehicle_drag,
                vehicle_mass=10 ** rng.uniform(1.0, 4.0),
            )


def moved(ship: Trace, *, by: float = 0.0, later: float = 0.0, sign: float = 1.0) -> Trace:
    return Trace.along_x(ship.t + later, by + sign * ship.position[:, 0])


@few
@given(seeds, laws, st.sampled_from(["rest", "steady"]))
def test_the_vehicle_follows_a_moved_mirrored_or_later_ship(seed: int, drag: Drag, start: str) -> None:
    model, ship = some_model(seed, drag), some_ship(seed)

    def run(trace: Trace) -> reduced.Response:
        return reduced.respond(model, Drive.from_trace(trace, start=start))

    plain = run(ship)
    far = run(moved(ship, by=5_000_000.0))
    np.testing.assert_allclose(far.velocity, plain.velocity, atol=1e-10)
    np.testing.assert_allclose(far.position - 5_000_000.0, plain.position, atol=2e-9)
    mirrored = run(moved(ship, sign=-1.0))
    np.testing.assert_allclose(mirrored.velocity, -plain.velocity, atol=1e-12)
    np.testing.assert_allclose(run(moved(ship, later=4096.0)).velocity, plain.velocity, atol=1e-10)


@few
@given(seeds, laws)
def test_a_ship_that_waits_first_makes_the_vehicle_wait(seed: int, drag: Drag) -> None:
    model = some_model(seed, drag)
    t = np.arange(0.0, 400.0)

    def response(wait: float) -> Floats:
        since = np.maximum(t - wait - 40.0, 0.0)
        return reduced.respond(model, Drive.from_trace(Trace.along_x(t, 8.0 * (1.0 - np.cos(0.03 * since))))).velocity

    np.testing.assert_allclose(response(50.0)[50:], response(0.0)[:-50], atol=1e-8)


@few
@given(seeds, laws)
def test_no_input_no_motion(seed: int, drag: Drag) -> None:
    t = np.arange(0.0, 100.0)
    response = reduced.respond(some_model(seed, drag), Drive.from_trace(Trace.along_x(t, np.full(t.size, 123.456))))
    np.testing.assert_array_equal(response.velocity, 0.0)
    np.testing.assert_allclose(response.position, 123.456, rtol=1e-15)


@few
@given(seeds, laws, st.floats(-0.5, 0.5))
@example(seed=1, drag="quadratic", speed=7.156841917547687e-15)
def test_a_steady_tow_stays_steady(seed: int, drag: Drag, speed: float) -> None:
    t = np.arange(0.0, 200.0)
    drive = Drive.from_trace(Trace.along_x(t, 7.0 + speed * t), start="steady")
    response = reduced.respond(some_model(seed, drag), drive)
    np.testing.assert_allclose(response.velocity, speed, atol=1e-10)
    np.testing.assert_allclose(response.position - response.position[0], speed * t, atol=1e-9)


@few
@given(seeds, laws, st.booleans())
def test_one_link_is_the_single_link(seed: int, drag: Drag, inertial: bool) -> None:
    """The delayed models without delay are chains of one link, whatever the scale of mass or drag."""
    rng = np.random.default_rng(seed)
    k, r, m = rng.uniform(10.0, 90.0), rng.uniform(500.0, 9000.0), rng.uniform(50.0, 5000.0)
    drive = Drive.from_trace(some_ship(seed))
    chain: reduced.ReducedModel
    single: reduced.ReducedModel
    if inertial:
        chain = Inertial(drag=drag, stiffness=np.array([k]), link=1200.0, vehicle_drag=r, vehicle_mass=m)
        single = SecondOrder(drag=drag, spring=k / m, damping=r / m, delay=0.0)
    else:
        chain = Massless(drag=drag, stiffness=np.array([k]), link=1200.0, vehicle_drag=r)
        single = FirstOrder(drag=drag, spring=k / r, delay=0.0)
    np.testing.assert_allclose(
        reduced.respond(chain, drive).velocity, reduced.respond(single, drive).velocity, atol=2.0 * TOLERANCE
    )


@few
@given(seeds)
def test_energy_never_grows_without_input(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 9))
    k, r = rng.uniform(10.0, 90.0, n), 10 ** rng.uniform(-3.0, 4.0, n)
    m = 10 ** rng.uniform(0.0, 4.0, n)
    x, v = rng.normal(0.0, 20.0, n), rng.normal(0.0, 0.5, n)
    grid = Drive.from_trace(Trace.along_x([0.0, 0.5], [0.0, 0.0])).coarse
    energy = []
    for _ in range(200):
        stretch = np.diff(x, prepend=0.0)
        energy.append(0.5 * float(k @ stretch**2 + m @ v**2))
        failed, _, _ = _march(k, r, m, x, v, *grid, TOLERANCE, BUDGET, np.empty(2), np.empty(2))
        assert failed < 0
    # Newton's tolerance may carry TOLERANCE of velocity into a mass.
    assert np.all(np.diff(energy) <= 4.0 * TOLERANCE * float(m @ (0.1 + np.abs(v))))


@few
@given(seeds, st.booleans(), st.floats(1e-3, 1e4))
def test_the_linear_propagator_never_amplifies(seed: int, inertial: bool, h: float) -> None:
    """In energy coordinates the system matrix is a skew part less a dissipative part."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 9))
    skew = rng.normal(size=(n, n))
    dissipative = rng.normal(size=(n, n)) if inertial else np.diag(rng.uniform(0.0, 5.0, n))
    A = skew - skew.T - dissipative @ dissipative.T
    for E in doublings(A, h):
        assert np.linalg.norm(E + np.eye(n), 2) <= 1.0 + 1e-12


@few
@given(seeds, laws)
def test_massless_is_the_limit_of_small_masses(seed: int, drag: Drag) -> None:
    rng = np.random.default_rng(seed)
    ship = some_ship(seed)
    k, r = rng.uniform(20.0, 90.0, 4), rng.uniform(500.0, 5000.0, 4)
    motion = quadratic_motion if drag == "quadratic" else linear_motion
    # The same steps for both: a chain with mass takes half of max_step where it is marched implicitly.
    limit = motion(Chain(k, r, np.zeros(4)), Drive.from_trace(ship, max_step=0.5)).v

    def gap(mass: float) -> float:
        return float(
            np.abs(motion(Chain(k, r, np.full(4, mass)), Drive.from_trace(ship, max_step=1.0)).v - limit).max()
        )

    assert gap(1e-4) < 1e-4
    assert gap(1e-6) < max(0.2 * gap(1e-3), 1e-7)


@few
@given(seeds)
def test_linear_twins_give_the_same_response(seed: int) -> None:
    """Two massless linear links: r1' = r2 (k1 + k2)/k2, r2' = r1 k2/(k1 + k2)."""
    rng = np.random.default_rng(seed)
    k1, k2 = rng.uniform(20.0, 90.0, 2)
    r1, r2 = rng.uniform(300.0, 5000.0, 2)
    drive = Drive.from_trace(some_ship(seed))

    def velocity(first: float, second: float) -> Floats:
        model = Massless(
            drag="linear", stiffness=np.array([k1, k2]), link=600.0, cable_drag=first / 600.0, vehicle_drag=second
        )
        return reduced.respond(model, drive).velocity

    twin = velocity(r2 * (k1 + k2) / k2, r1 * k2 / (k1 + k2))
    np.testing.assert_allclose(velocity(r1, r2), twin, atol=1e-9)


@few
@given(seeds, st.floats(0.0, 400.0))
def test_the_response_is_smooth_in_the_delay(seed: int, delay: float) -> None:
    """The response moves in proportion to a small change of the delay: no jump at a sample or at the start."""
    drive = Drive.from_trace(some_ship(seed))

    def velocity(tau: float) -> Floats:
        return reduced.respond(SecondOrder(drag="quadratic", spring=0.006, damping=2.8, delay=tau), drive).velocity

    for tau in (delay, float(round(delay))):
        step = np.abs(velocity(tau + 1e-6) - velocity(tau)).max()
        assert step <= 1e-6 * 0.1


@pytest.mark.parametrize("distance", [10.0, 1500.0])
@pytest.mark.parametrize("delay", [0.0, 0.3, 7.3])
def test_a_stopped_ship_lets_the_delayed_massless_model_come_to_rest(distance: float, delay: float) -> None:
    """At rest but for the rounding of computed positions, of which a root of the drag would make 1e-9 m/s."""
    t = np.arange(0.0, 4000.0)
    x = 0.5 * distance * (1.0 - np.cos(np.pi * np.minimum(t, 1000.0) / 1000.0))
    x += np.spacing(distance) * np.random.default_rng(0).integers(-1, 2, t.size)
    model = FirstOrder(drag="quadratic", spring=0.0023, delay=delay)
    velocity = reduced.respond(model, Drive.from_trace(Trace.along_x(t, x))).velocity
    assert np.abs(velocity[:2000]).max() > 0.01
    # A stage moves by gamma h v: a jump of the ship by its rounding, to and fro, is all that may be seen.
    assert np.abs(velocity[-200:]).max() <= 2.0 * np.spacing(distance) / (GAMMA * MAX_STEP)


@pytest.mark.parametrize("links", [1, 4, 16])
def test_a_stopped_ship_lets_massless_chains_come_to_rest(links: int) -> None:
    """The square root of the drag law has no slope at rest; the velocity of the stopped chain is still exact."""
    rng = np.random.default_rng(links)
    k, r = rng.uniform(40.0, 90.0, links), rng.uniform(500.0, 2000.0, links)
    t = np.arange(0.0, 60.0 + 4000.0 * max(1, links / 4))
    x = np.where(t < 40.0, 5.0 * (1.0 - np.cos(np.pi * np.minimum(t, 40.0) / 40.0)), 10.0)
    drive = Drive.from_trace(Trace.along_x(t, x))
    assert np.abs(quadratic_motion(Chain(k, r, np.zeros(links)), drive).v[-100:]).max() < 1e-12
