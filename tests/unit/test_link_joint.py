"""The link-joint chain says yes and no rightly: bad input, payout, branches, drag laws, what a result tells."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from models import link_joint
from models.body import Body
from models.cable import Cable
from models.current import Current
from models.link_joint import simulation
from models.link_joint.forces import drag_law, end_drag
from models.payout import Payout
from models.quantity import InvalidInput, NumericalFailure
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.trace import Trace


@pytest.fixture
def system(configurations: Callable[[str], Tow]) -> TowedSystem:
    return TowedSystem.from_tow(configurations("mangus-740"))


def straight(speed: float, duration: float, sample: float = 1.0) -> Trace:
    t = np.arange(0.0, duration + 0.5 * sample, sample)
    return Trace.along_x(t, speed * t)


def test_a_track_that_jumps_is_named(system: TowedSystem) -> None:
    ship = straight(1.0, 100.0)
    position = ship.position.copy()
    position[60:] += 55.0
    with pytest.raises(InvalidInput, match=r"jumps: between t = 59 s and 60 s it moves .* m"):
        link_joint.simulate(system, Trace(t=ship.t, position=position), links=8)


def test_a_gap_in_the_track_is_named(system: TowedSystem) -> None:
    ship = straight(1.0, 100.0)
    position = ship.position.copy()
    position[30] = np.nan
    with pytest.raises(InvalidInput, match="t = 30 s has none"):
        link_joint.simulate(system, Trace(t=ship.t, position=position), links=8)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"links": 3}, "4 to 4096 links"),
        ({"links": 8, "tolerance": 0.0}, "tolerance must be above 0"),
        ({"links": 8, "step": -1.0}, "step must be above 0"),
        ({"links": 8, "payout": Payout(t=[0.0, 50.0], length=[0.0, -700.0])}, "two links of 92.5 m must be left"),
    ],
)
def test_settings_out_of_bounds(system: TowedSystem, settings: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        link_joint.simulate(system, straight(0.5, 100.0), **settings)  # type: ignore[arg-type]


def test_a_tolerance_out_of_reach_is_a_failure(system: TowedSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("models.link_joint.simulation.LAST_LINKS", 24)
    t = np.arange(0.0, 300.0)
    with pytest.raises(NumericalFailure, match="does not reach 1e-07 m/s: with 24 links"):
        link_joint.simulate(system, Trace.along_x(t, 20.0 * np.sin(0.05 * t)), tolerance=1e-7)


def test_a_step_past_its_limit_is_a_failure_or_an_account_that_does_not_close(system: TowedSystem) -> None:
    t = np.arange(0.0, 1200.0, 5.0)
    ship = Trace.along_x(t, 60.0 * np.sin(0.15 * t))
    with pytest.raises(NumericalFailure, match="smaller step"):
        link_joint.simulate(system, ship, links=24, step=40.0, companion=False)


def test_the_resolution_follows_from_the_tolerance(system: TowedSystem) -> None:
    t = np.arange(0.0, 900.0)
    ship = Trace.along_x(t, 20.0 * (1.0 - np.cos(0.02 * t)))
    fine = link_joint.simulate(system, ship, links=192, tolerance=1e-6, companion=False).vehicle
    assert fine.velocity is not None
    for tolerance in (1e-3, 1e-4):
        run = link_joint.simulate(system, ship, tolerance=tolerance)
        assert run.vehicle.velocity is not None
        miss = np.sqrt(np.mean(np.sum((run.vehicle.velocity - fine.velocity) ** 2, axis=1)))
        assert run.error is not None
        assert run.error <= tolerance
        assert miss <= tolerance
        assert run.drift < 1e-8
        assert run.imbalance < 0.01


@pytest.mark.parametrize(("paid", "links"), [(300.0, 24), (-400.0, 24), (740.0, 12), (-666.0, 40)])
def test_payout_ends_in_the_shape_of_its_length_without_a_spike(
    system: TowedSystem, configurations: Callable[[str], Tow], paid: float, links: int
) -> None:
    tow = configurations("mangus-740")
    ship = straight(0.0, 1500.0, 0.5)
    payout = Payout(t=[0.0, 50.0, 50.0 + abs(paid), 1500.0], length=[0.0, 0.0, paid, paid])
    run = link_joint.simulate(system, ship, links=links, payout=payout, companion=False)
    longer = replace(tow, cable=replace(tow.cable, length=tow.cable.length + paid))
    hung = link_joint.steady_tow(TowedSystem.from_tow(longer), links=links)
    assert run.vehicle.position[-1, 2] == pytest.approx(hung.position[0, 2], rel=2e-5)
    # While the drum turns evenly the pull at the ship changes by the cable's weight and drag, link or no link.
    assert run.vehicle.tension is not None
    turning = (ship.t > 80.0) & (ship.t < abs(paid) + 40.0)
    steps = np.abs(np.diff(run.vehicle.tension[turning, 0]))
    assert steps.max() < 25.0
    assert run.imbalance < 1e-3


def test_a_branch_is_carried_like_its_weight(system: TowedSystem) -> None:
    """Two like bodies on two like branches hang as one of twice the weight on twice the cable."""
    main = system.parts[0]
    branch = Cable(
        length=100.0,
        diameter=0.01,
        mass=0.4,
        weight_in_water=3.0,
        added_mass=0.1,
        axial_stiffness=4e6,
        normal_drag_coefficient=1.2,
        tangential_drag_coefficient=0.02,
    )
    weight = Body(
        weight=1500.0,
        buoyancy=500.0,
        mass=150.0,
        added_mass_surge=50.0,
        added_mass_sway=50.0,
        added_mass_heave=50.0,
        area_surge=0.2,
        area_sway=0.2,
        area_heave=0.2,
        drag_coefficient=1.0,
    )
    parts = [main, *(Part(name=name, cable=branch, body=weight, after=main.name) for name in ("left", "right"))]
    branched = replace(system, parts=tuple(parts))
    t = np.arange(0.0, 400.0)
    ship = Trace.along_x(t, 10.0 * (1.0 - np.cos(0.05 * t)))
    run = link_joint.simulate(branched, ship, links=16, companion=False)
    np.testing.assert_allclose(run.bodies[1].position, run.bodies[2].position, atol=1e-9)
    assert run.names == (main.name, "left", "right")
    assert run.bodies[1].tension is not None
    assert run.bodies[1].tension[0, 1] == pytest.approx(1000.0, rel=1e-6)
    assert run.bodies[1].tension[0, 0] == pytest.approx(1300.0, rel=1e-6)
    hung = link_joint.steady_tow(branched, links=16)
    alone = link_joint.steady_tow(system, links=16)
    assert hung.tension[-1] - alone.tension[-1] == pytest.approx(2.0 * 1300.0, rel=1e-6)


def test_a_cross_current_carries_the_chain_with_it(system: TowedSystem) -> None:
    """At rest in a stream as towed against it: the same shape, turned into the stream's direction."""
    stream = replace(system, current=Current(depth=[0.0], speed=[0.8], direction=[1.2]))
    still = link_joint.steady_tow(system, (-0.8, 0.0, 0.0), links=30).position
    carried = link_joint.steady_tow(stream, links=30).position
    np.testing.assert_allclose(carried[:, 0], still[:, 0] * np.cos(1.2), atol=1e-6)
    np.testing.assert_allclose(carried[:, 1], still[:, 0] * np.sin(1.2), atol=1e-6)
    np.testing.assert_allclose(carried[:, 2], still[:, 2], atol=1e-6)


@pytest.mark.parametrize("law", [0, 1])
@pytest.mark.parametrize("un", [0.05, 0.4, 0.7, 2.0])
@pytest.mark.parametrize("ut", [-1.5, 0.9])
def test_derivatives_of_the_drag_laws(law: int, un: float, ut: float) -> None:
    e = 1e-6
    here = drag_law(law, 3.0, 0.2, un, ut)
    for k, (da, db) in enumerate(((2, 4), (3, 5))):
        step = np.array([e, 0.0] if k == 0 else [0.0, e])
        up, down = (drag_law(law, 3.0, 0.2, *(np.array([un, ut]) + sign * step)) for sign in (1.0, -1.0))
        assert (up[0] - down[0]) / (2.0 * e) == pytest.approx(here[da], abs=1e-6)
        assert (up[1] - down[1]) / (2.0 * e) == pytest.approx(here[db], abs=1e-6)


@pytest.mark.parametrize("axes", [[0, 2], [0, 1, 2]], ids=["plane", "space"])
@pytest.mark.parametrize("law", [0, 1])
def test_derivatives_of_a_links_drag(law: int, axes: list[int]) -> None:
    """D = -dF/du and S = -dF/dr against differences, r turned and stretched."""
    u, r = np.array([1.1, -0.4, 0.3])[axes], np.array([3.0, 1.0, -5.0])[axes]
    d = len(axes)

    def drag(u: np.ndarray, r: np.ndarray) -> tuple[np.ndarray, ...]:
        size = float(np.linalg.norm(r))
        return tuple(map(np.array, end_drag(law, 3.0, 0.2, tuple(u), tuple(r / size), size)))

    _, D, S = drag(u, r)
    e = 1e-6
    for k in range(d):
        step = e * np.eye(d)[k]
        by_u = (drag(u + step, r)[0] - drag(u - step, r)[0]) / (2.0 * e)
        by_r = (drag(u, r + step)[0] - drag(u, r - step)[0]) / (2.0 * e)
        np.testing.assert_allclose(D.reshape(d, d)[:, k], -by_u, atol=1e-7)
        np.testing.assert_allclose(S.reshape(d, d)[:, k], by_r, atol=1e-7)


def test_the_incidence_law_pulls_along_a_cable_that_follows_the_flow() -> None:
    """W's 0.273 D0 along the cable, on |V|^2, and the critical angle that follows."""
    a, b, *_ = drag_law(1, 1.0, 0.0, 0.0, 2.0)
    assert a == pytest.approx(0.273 * 2.0)
    assert b == pytest.approx(0.273 * 4.0)
    steep = drag_law(1, 1.0, 0.0, 3.0, 0.4)
    assert steep[0] == pytest.approx(3.0)
    assert steep[1] == pytest.approx(3.0 * 0.4)


def test_a_towfish_and_a_steep_tow_run(table_two: Tow) -> None:
    system = TowedSystem.from_tow(table_two)
    run = link_joint.simulate(system, straight(2.5, 300.0), links=24)
    assert run.error is not None
    assert run.error < 1e-6
    assert -run.vehicle.position[-1, 2] < 0.6 * table_two.cable.length


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 3e-4])
@pytest.mark.parametrize("stiffness", [1e15, 1e7])
def test_changing_steps_leave_no_spikes_of_tension(
    configurations: Callable[[str], Tow], stiffness: float, tolerance: float
) -> None:
    """A rigid chain under heave pulls as it does at a fixed step: no link is called slack that is not."""
    tow = configurations("multipart-2200")
    system = TowedSystem.from_tow(replace(tow, cable=replace(tow.cable, axial_stiffness=stiffness)))
    t = np.arange(0.0, 200.0, 0.5)
    heave = 0.5 * np.sin(2.0 * np.pi / 12.0 * t) * np.clip(t / 60.0, 0.0, 1.0)
    ship = Trace.along_x(t, tow.speed * t, heave)
    fixed = link_joint.simulate(system, ship, links=40, step=0.1, companion=False)
    run = link_joint.simulate(system, ship, links=40, tolerance=tolerance, companion=False)
    assert not run.slack
    assert not fixed.slack
    assert run.tension_max[0] == pytest.approx(fixed.tension_max[0], rel=0.005)
    assert run.vehicle.tension is not None
    assert fixed.vehicle.tension is not None
    np.testing.assert_allclose(run.vehicle.tension, fixed.vehicle.tension, rtol=0.02)


def test_shapes_are_kept_on_request(system: TowedSystem) -> None:
    run = link_joint.simulate(system, straight(1.0, 60.0), links=10, shapes_at=np.array([0.0, 30.0]), companion=False)
    assert run.shape_times.tolist() == [0.0, 30.0]
    assert [shape.shape for shape in run.shapes] == [(11, 3), (11, 3)]
    np.testing.assert_allclose(run.shapes[1][0], run.vehicle.position[30], atol=1e-9)
    np.testing.assert_allclose(run.shapes[1][-1], [30.0, 0.0, 0.0], atol=1e-9)


def test_a_run_ends_when_its_links_have_taken_their_steps(system: TowedSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    """The budget is of links times steps, so that many links do not take hours; the message has the steps."""
    monkeypatch.setattr(simulation, "LINK_BUDGET", 24 * 150)
    with pytest.raises(NumericalFailure, match=r"150 steps are spent at t = "):
        link_joint.simulate(system, straight(1.0, 300.0), links=24, step=0.1, companion=False)


def test_a_long_march_comes_back_to_python_and_goes_on(system: TowedSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    t = np.arange(0.0, 600.0)
    ship = Trace.along_x(t, 3.0 * (1.0 - np.cos(0.3 * t)))
    payout = Payout(t=[0.0, 100.0, 400.0, 600.0], length=[0.0, 0.0, 120.0, 120.0])

    def run() -> link_joint.LinkJointResult:
        return link_joint.simulate(system, ship, links=12, tolerance=1e-4, payout=payout, companion=False)

    whole, calls, march = run(), [], simulation.kernel.march

    def counted(*given: object) -> object:
        calls.append(1)
        if len(calls) == 4 and interrupted:
            raise KeyboardInterrupt
        return march(*given)

    interrupted = False
    monkeypatch.setattr(simulation, "AT_A_TIME", 0)
    monkeypatch.setattr(simulation.kernel, "march", counted)
    pieces = run()
    assert len(calls) > 10
    assert pieces.steps == pytest.approx(whole.steps, rel=0.02)
    np.testing.assert_allclose(pieces.vehicle.position, whole.vehicle.position, atol=2e-3)
    assert pieces.imbalance < 1e-3
    calls.clear()
    interrupted = True
    with pytest.raises(KeyboardInterrupt):
        run()
