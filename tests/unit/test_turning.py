"""Manoeuvres under way: lengths, radii and headings are those asked for, and settings that cannot be are refused."""

import math
from itertools import pairwise

import numpy as np
import pytest

from data_synth import ships
from models.quantity import InvalidInput
from models.trace import Floats, Trace

SIX_KNOTS = 3.0866666666666664


def heading(trace: Trace) -> Floats:
    return np.asarray(np.unwrap(np.arctan2(trace.rates()[:, 1], trace.rates()[:, 0])))


def acceleration(trace: Trace) -> Floats:
    """Largest over the spline, between the samples too."""
    return np.linalg.norm(trace.spline(np.linspace(trace.t[0], trace.t[-1], 7 * len(trace)), 2), axis=1)


def test_a_straight_tow_is_steady() -> None:
    trace = ships.straight_tow(ships.StraightTow(duration=600.0, speed=2.5))
    assert trace.t[-1] == 600.0
    assert trace.position == pytest.approx(np.outer(trace.t, [2.5, 0.0, 0.0]), abs=1e-9)
    assert trace.rates() == pytest.approx(np.tile([2.5, 0.0, 0.0], (601, 1)), abs=1e-12)


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_a_full_turn_has_its_radius_and_its_turns(side: str, sign: float) -> None:
    asked = ships.FullTurn(speed=SIX_KNOTS, radius=250.0, turns=3.0, approach=100.0, exit=200.0, ease=10.0, side=side)
    trace = ships.full_turn(asked)
    circle = 2.0 * math.pi * 250.0 / SIX_KNOTS
    assert circle == pytest.approx(508.9, abs=0.05)
    assert trace.t[-1] == math.floor(300.0 + 3.0 * circle + 10.0)
    assert heading(trace)[-1] == pytest.approx(sign * 6.0 * math.pi, abs=1e-12)
    on_arc = (trace.t >= 110.0) & (trace.t <= 100.0 + 3.0 * circle)
    x, y = trace.position[on_arc, :2].T
    matrix = np.column_stack([2.0 * x, 2.0 * y, np.ones(x.size)])
    (x0, y0, _), *_ = np.linalg.lstsq(matrix, x**2 + y**2)
    assert np.hypot(x - x0, y - y0) == pytest.approx(250.0, abs=1e-8)
    assert sign * y0 > 0.0
    assert acceleration(trace).max() == pytest.approx(SIX_KNOTS**2 / 250.0, rel=0.02)


def test_a_u_turn_comes_back_beside_its_way() -> None:
    trace = ships.u_turn(ships.UTurn(speed=2.0, radius=100.0, approach=60.0, exit=300.0, ease=0.01))
    assert heading(trace)[-1] == pytest.approx(math.pi, abs=1e-12)
    assert trace.position[-1, 1] == pytest.approx(200.0, abs=1e-3)
    assert trace.rates()[-1] == pytest.approx([-2.0, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("sample", [0.1, 1.0, 200.0])
def test_the_sample_does_not_move_the_ship(sample: float) -> None:
    fine = ships.full_turn(ships.FullTurn(radius=60.0, ease=3.7, sample=0.05))
    coarse = ships.full_turn(ships.FullTurn(radius=60.0, ease=3.7, sample=sample))
    same = np.round(coarse.t / 0.05).astype(int)
    assert coarse.position == pytest.approx(fine.position[same], abs=1e-9)


def test_the_positions_are_the_integral_of_the_velocity() -> None:
    from scipy.integrate import cumulative_simpson

    trace = ships.zig_zag(ships.ZigZag(sample=0.05, leg=30.0))
    x = cumulative_simpson(trace.rates(), x=trace.t, axis=0, initial=np.zeros((1, 3)))
    assert x == pytest.approx(trace.position, abs=1e-7)


def test_speeds_change_along_the_heading() -> None:
    asked = ships.SpeedChanges(duration=900.0, times=(100.0, 500.0), speeds=(2.0, 4.0, 1.0), rise=40.0, heading=2.0)
    trace = ships.speed_changes(asked)
    course = np.array([math.cos(2.0), math.sin(2.0), 0.0])
    speed = trace.rates() @ course
    assert trace.rates() == pytest.approx(np.outer(speed, course))
    assert speed[[0, 100, 120, 140, 500, 520, 540, 900]] == pytest.approx([2.0, 2.0, 3.0, 4.0, 4.0, 2.5, 1.0, 1.0])
    assert trace.position[-1] @ course == pytest.approx(100 * 2.0 + 40 * 3.0 + 360 * 4.0 + 40 * 2.5 + 360 * 1.0)
    assert acceleration(trace).max() == pytest.approx(math.pi / 2.0 * 3.0 / 40.0, rel=0.01)


def test_zig_zag_legs_go_to_both_sides() -> None:
    trace = ships.zig_zag(ships.ZigZag(heading_change=1.0, leg=200.0, legs=3, radius=150.0))
    psi = heading(trace)
    seen = [round(float(value), 9) for value in psi[1:] if np.sum(np.abs(psi - value) < 1e-12) > 100]
    assert [seen[0], *(b for a, b in pairwise(seen) if a != b)] == [0.0, 0.5, -0.5, 0.5, 0.0]


def test_waypoints_are_joined_by_straights_and_arcs() -> None:
    trace = ships.waypoints(
        ships.Waypoints(points_x=(10.0, 10.0, 1000.0), points_y=(-5.0, 900.0, 900.0), radius=100.0, speed=2.0)
    )
    x, y = trace.position[:, :2].T
    assert trace.position[0].tolist() == [10.0, -5.0, 0.0]
    assert trace.position[-1] == pytest.approx([1000.0, 900.0, 0.0], abs=2.0)
    on_first, on_last = y < 780.0, x > 130.0
    assert x[on_first] == pytest.approx(10.0, abs=1e-9)
    assert y[on_last] == pytest.approx(900.0, abs=1e-9)
    assert np.hypot(x - 10.0, y - 900.0).min() == pytest.approx(100.0 * (math.sqrt(2.0) - 1.0), abs=0.6)
    assert acceleration(trace).max() == pytest.approx(0.04, rel=0.03)


def test_a_small_corner_is_turned_wider_and_still_by_its_angle() -> None:
    points = {"points_x": (0.0, 500.0, 1000.0), "points_y": (0.0, 0.0, 5.0)}
    trace = ships.waypoints(ships.Waypoints(**points, radius=100.0, speed=3.0, ease=20.0))
    assert heading(trace)[-1] == pytest.approx(math.atan2(5.0, 500.0), abs=1e-12)
    assert acceleration(trace).max() < 1.1 * 3.0 * math.atan2(5.0, 500.0) / 20.0
    assert trace.position[-1, 1] == pytest.approx(5.0, abs=0.05)


def test_waypoints_on_a_line_make_no_turn() -> None:
    trace = ships.waypoints(ships.Waypoints(points_x=(0.0, 300.0, 900.0), points_y=(0.0, 0.0, 0.0)))
    assert not trace.position[:, 1].any()


@pytest.mark.parametrize(
    ("kind", "values", "message"),
    [
        (ships.FullTurn, {"radius": 0.0}, "radius .R. must be above 0 m"),
        (ships.FullTurn, {"turns": 0.01, "ease": 10.0}, r"ease must be at most 5\.08\d* s .* but it is 10 s"),
        (ships.UTurn, {"ease": 300.0}, "ease must be at most"),
        (ships.ZigZag, {"heading_change": 0.01}, "ease must be at most"),
        (ships.ZigZag, {"heading_change": 4.0}, "heading_change"),
        (ships.SpeedChanges, {"speeds": (1.0, 2.0)}, "2 speeds for 2 times"),
        (ships.SpeedChanges, {"times": (9.0, 9.0)}, "times must increase"),
        (ships.StraightTow, {"speed": math.nan}, "speed"),
        (ships.Waypoints, {"points_x": (0.0,)}, "one length"),
        (ships.Waypoints, {"points_x": (0.0,), "points_y": (0.0,)}, "at least 2 points"),
        (ships.Waypoints, {"points_x": (0.0, 5.0, 5.0), "points_y": (0.0, 1.0, 1.0)}, "points 2 and 3 in one place"),
        (ships.Waypoints, {"points_x": (0.0, 5e3, 0.0), "points_y": (0.0, 0.0, 0.0)}, "straight back at point 2"),
        (ships.Waypoints, {"radius": 1500.0}, "leg from point 2 to 3, but it has 2000 m"),
    ],
)
def test_what_cannot_be_sailed_is_refused(kind: type, values: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        kind(**values)
