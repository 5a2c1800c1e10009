"""A scene in one vertical plane is computed there: it says rightly which one is, and the result is that in space."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ident.benchmark.operations import in_python
from models import link_joint
from models.body import Body
from models.cable import Cable
from models.current import Current
from models.link_joint import LinkJointResult, columns, simulation, vectors
from models.link_joint.chain import RIGID, build
from models.link_joint.plane import Plane, plane_of
from models.payout import Payout
from models.quantity import NumericalFailure
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.trace import Floats, Trace

#: Largest difference of any motion or tension, over the largest value of that quantity.
EQUAL = 1e-12
STILL = np.zeros((0, 2))
BODY = Body(
    weight=1500.0, buoyancy=500.0, mass=150.0, added_mass_surge=30.0, added_mass_sway=90.0, added_mass_heave=50.0,
    area_surge=0.1, area_sway=0.6, area_heave=0.2, drag_coefficient=1.0,
)  # fmt: skip
SHEARED = Current.from_profile([0.0, 300.0, 900.0], [0.4, 0.1, -0.3])

t = np.arange(0.0, 121.0)
s = np.cumsum(1.0 + 0.5 * np.sin(0.08 * t)) - 1.0
towing, starting = Trace.along_x(t, s), Trace.along_x(t, 2.0 * t**2 / (t + 30.0))
heaving = Trace.along_x(t[:41], 0.2 * t[:41], 12.0 * np.sin(0.8 * t[:41]))


@pytest.fixture
def tow(configurations: Callable[[str], Tow]) -> Tow:
    return configurations("mangus-740")


@pytest.fixture
def system(tow: Tow) -> TowedSystem:
    """Of which the body differs by axis."""
    system = TowedSystem.from_tow(tow)
    return replace(system, parts=(replace(system.parts[0], body=BODY),))


def branched(system: TowedSystem, cable: Cable) -> TowedSystem:
    main, tail = system.parts[0], replace(cable, length=150.0)
    tails = (Part(name=name, cable=tail, body=body, after=main.name) for name, body in (("left", BODY), ("free", None)))
    return replace(system, parts=(main, *tails))


def chosen(run: Callable[[], LinkJointResult], monkeypatch: pytest.MonkeyPatch) -> tuple[LinkJointResult, set[int]]:
    """What a run gives, and along how many axes its chain moved."""
    march, axes = simulation.kernel.march, set()

    def watched(*given: Any) -> Any:
        axes.add(given[3].x.shape[2])
        return march(*given)

    with monkeypatch.context() as patch:
        patch.setattr(simulation.kernel, "march", watched)
        return run(), axes


def apart(one: LinkJointResult, other: LinkJointResult) -> float:
    pairs = [
        (getattr(a, name), getattr(b, name))
        for a, b in zip(one.bodies, other.bodies, strict=True)
        for name in ("position", "velocity", "tension")
    ]
    pairs += zip(one.shapes, other.shapes, strict=True)
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


@pytest.mark.parametrize(
    ("ship", "changes"),
    [
        (towing, {}),
        (towing, {"current": SHEARED}),
        (towing, {"drag_law": "incidence"}),
        (towing, {"winch": Payout(t=[0.0, 20.0, 100.0], length=[0.0, 0.0, 120.0])}),
        (towing, {"winch": Payout(t=[0.0, 20.0, 100.0], length=[0.0, 0.0, -120.0])}),
        (towing, {"stiffness": RIGID}),
        (towing, {"stiffness": RIGID, "winch": Payout(t=[0.0, 20.0, 100.0], length=[0.0, 0.0, -120.0])}),
        (towing, {"tails": True}),
        (towing, {"loss": 0.02}),
        (starting, {"start": "rest"}),
        (heaving, {"start": "rest", "step": 0.05}),
        (heaving, {"start": "rest", "step": 0.05, "current": Current.uniform(0.3)}),
    ],
    ids=[
        "under way", "sheared", "incidence", "payout", "haul", "rigid", "rigid haul", "tails", "loss", "from rest",
        "slack", "slack in a stream",
    ],
)  # fmt: skip
def test_the_plane_equals_space(
    system: TowedSystem, tow: Tow, ship: Trace, changes: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    changes = dict(changes)
    cable = replace(
        system.parts[0].cable,
        axial_stiffness=changes.pop("stiffness", tow.cable.axial_stiffness),
        axial_damping=changes.pop("loss", 0.0),
    )
    system = replace(system, parts=(replace(system.parts[0], cable=cable),))
    if changes.pop("tails", False):
        system = branched(system, tow.cable)
    options = {"start": changes.pop("start", "steady"), "step": changes.pop("step", 0.5)}
    options |= {"payout": changes.pop("winch", None), "links": 12, "companion": False, "shapes_at": ship.t[[5, -1]]}
    system = replace(system, **changes)
    plane, two = chosen(lambda: link_joint.simulate(system, ship, **options), monkeypatch)
    space, three = chosen(lambda: link_joint.simulate(system, ship, planar=False, **options), monkeypatch)
    assert (two, three) == ({2}, {3})
    assert apart(plane, space) <= EQUAL
    assert (plane.steps, plane.iterations, plane.slack) == (space.steps, space.iterations, space.slack)
    np.testing.assert_allclose(plane.tension_max, space.tension_max, rtol=EQUAL)
    assert plane.imbalance == pytest.approx(space.imbalance, rel=1e-6, abs=1e-12)
    assert plane.snap_loss == pytest.approx(space.snap_loss, rel=1e-6, abs=1e-6)
    assert not plane.vehicle.position[:, 1].any()
    if ship is heaving:
        assert plane.slack


def test_the_error_is_estimated_alike(system: TowedSystem) -> None:
    plane, space = (link_joint.simulate(system, towing, tolerance=1e-2, planar=planar) for planar in (True, False))
    assert plane.error == pytest.approx(space.error, rel=1e-9)
    assert plane.links == space.links


def test_a_failure_is_told_alike(system: TowedSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulation, "LARGEST_IMBALANCE", 0.0)
    told = []
    for planar in (True, False):
        with pytest.raises(NumericalFailure, match="account of energy does not close") as failure:
            link_joint.simulate(system, towing, links=8, step=0.5, companion=False, planar=planar)
        told.append(str(failure.value))
    assert told[0] == told[1]


@pytest.mark.parametrize("degrees", [30.0, 90.0, 180.0, 257.0])
def test_any_heading_has_its_plane(tow: Tow, degrees: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against the same scene along x; in space rounding of places is felt through the cable's stiffness."""
    way, place = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0]), np.array([40.0, -90.0, 0.0])
    depth, speed = [0.0, 900.0], [0.2, 0.1]
    system = replace(TowedSystem.from_tow(tow), current=Current.from_profile(depth, speed))
    towards = Current.from_profile(depth, speed, direction=np.radians([degrees, degrees]).tolist())
    turned, there = replace(system, current=towards), Trace(t=t, position=place + s[:, None] * way)
    along = link_joint.simulate(system, towing, links=12, step=0.5, companion=False)
    plane, axes = chosen(lambda: link_joint.simulate(turned, there, links=12, step=0.5, companion=False), monkeypatch)
    space = link_joint.simulate(turned, there, links=12, step=0.5, companion=False, planar=False)
    assert axes == {2}
    assert apart(plane, space) < 1e-8
    for one, other in zip(plane.bodies, along.bodies, strict=True):
        up = np.array([0.0, 0.0, 1.0])
        expected = place + other.position[:, :1] * way + other.position[:, 2:] * up
        np.testing.assert_allclose(one.position, expected, rtol=1e-10, atol=1e-8)
        np.testing.assert_allclose(one.tension, other.tension, rtol=1e-8, atol=1e-4)


def turning(angle: float) -> Trace:
    """A course that changes half way."""
    course = angle / (1.0 + np.exp(-0.1 * (t - 60.0)))
    return Trace(t=t, position=np.column_stack([np.cumsum(np.cos(course)), np.cumsum(np.sin(course)), 0.0 * t]))


@pytest.mark.parametrize(
    ("ship", "changes"),
    [
        (turning(0.3), {}),
        (turning(1e-9), {}),
        (towing, {"current": Current.uniform(0.2, direction=0.3)}),
        (towing, {"current": Current.from_profile([0.0, 500.0], [0.2, 0.2], direction=[0.0, 0.1])}),
        (Trace(t=t, position=np.column_stack([0.0 * t, s, 0.0 * t])), {"speed": 1.0, "start": "rest"}),
    ],
    ids=["turn", "hardly a turn", "cross current", "turning current", "other start"],
)
def test_a_scene_that_leaves_the_plane_is_computed_in_space(
    system: TowedSystem, ship: Trace, changes: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    changes = dict(changes)
    start = changes.pop("start", "steady")
    system = replace(system, **changes)
    run, axes = chosen(lambda: link_joint.simulate(system, ship, links=8, start=start, companion=False), monkeypatch)
    assert axes == {3}
    assert np.ptp(run.vehicle.position[:, 1]) > 0.0


def test_the_plane_is_that_of_all_that_moves() -> None:
    east, north = np.array([[0.3, 0.0]]), np.array([[0.0, 0.3]])
    lying = Trace(t=t, position=np.column_stack([0.0 * t + 5.0, 0.0 * t + 7.0, np.sin(t)]))
    assert plane_of(STILL, (0.0, 0.0, 0.0), lying) == Plane(x=1.0, y=0.0, offset=7.0)
    assert plane_of(north, (0.0, 0.0, 0.0), lying) == Plane(x=0.0, y=1.0, offset=-5.0)
    assert plane_of(north, (1.0, 0.0, 0.0), lying) is None
    assert plane_of(east, (-1.0, 0.0, 0.0), towing) == Plane(x=1.0, y=0.0)
    assert plane_of(north, (0.0, 0.0, 0.0), towing) is None
    assert plane_of(np.concatenate([east, north]), (0.0, 0.0, 0.0)) is None
    # What is lost in the digits of the places is no motion, and as little more is.
    for across, found in ((1e-60, True), (1e-14, True), (1e-11, False)):
        position = towing.position + across * np.outer(np.sin(t), [0.0, 1.0, 0.0])
        assert (plane_of(STILL, (0.0, 0.0, 0.0), Trace(t=t, position=position)) is not None) == found


def test_a_chain_in_its_plane_has_nothing_across_it(system: TowedSystem) -> None:
    chain = Plane(x=0.6, y=0.8).chain(build(replace(system, current=Current.uniform(0.5, direction=1.0)), 8).chain)
    assert chain.current_y.size == 0
    np.testing.assert_allclose(chain.current_x, 0.5 * (0.6 * np.cos(1.0) + 0.8 * np.sin(1.0)))
    assert columns.work_for(9, 2).W.shape[1] < 0.6 * columns.work_for(9).W.shape[1]


@pytest.mark.parametrize("d", [2, 3])
def test_vectors_and_matrices_are_those_of_algebra(d: int) -> None:
    rng = np.random.default_rng(d)
    axes, one = vectors.axes_of(d), np.eye(d)
    a, b, A, B = rng.normal(size=d), rng.normal(size=d), rng.normal(size=(d, d)), rng.normal(size=(d, d))

    def of(name: str, *given: Any) -> Floats:
        tuples = (tuple(each.ravel().tolist()) if isinstance(each, np.ndarray) else each for each in given)
        return np.array(in_python(getattr(vectors, name))(*tuples))

    upwards = np.append(np.zeros(d - 1), 3.0)
    for found, expected in (
        (of("plus", A, B), A + B),
        (of("minus", a, b), a - b),
        (of("minus", A, B), A - B),
        (of("times", 2.5, A), 2.5 * A),
        (of("combined", 2.0, a, -3.0, b), 2.0 * a - 3.0 * b),
        (of("dot", a, b), a @ b),
        (of("raised", a, 3.0), a + upwards),
        (of("nought", axes), 0.0 * a),
        (of("outer", a, b), np.outer(a, b)),
        (of("with_diagonal", A, 0.7), A + 0.7 * one),
        (of("across", 1.3, a), 1.3 * (one - np.outer(a, a))),
        (of("applied", A, a), A @ a),
        (of("from_left", a, A), a @ A),
        (of("product", A, B), A @ B),
        (of("inverse", A, False), np.linalg.inv(A)),
        (of("inverse", A, True), 0.0 * A),
    ):
        np.testing.assert_allclose(found, np.ravel(expected) if found.ndim else expected, rtol=1e-11, atol=1e-13)
    rows = np.zeros((2, d * d + 2))
    for at, values in ((1, A), (2, b)):
        in_python(vectors.put)(rows, 1, at, tuple(values.ravel()))
    in_python(vectors.add)(rows, axes, 1, 2, tuple(a))
    assert not rows[0].any()
    np.testing.assert_allclose(in_python(vectors.vector)(axes, rows, 1, 2), a + b)
    np.testing.assert_allclose(in_python(vectors.matrix)(axes, rows, 1, 1)[d + 1 :], A.ravel()[d + 1 :])
