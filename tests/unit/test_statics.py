"""What the statics refuse, and how; the places that a shape is told at."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

from models.current import Current
from models.quantity import InvalidInput
from models.statics import SlackCable, length_for_depth, static_shape
from models.tow import Tow
from models.vehicle import Towfish


def test_a_buoyant_cable_goes_slack_and_says_where(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("mangus-740")
    # T = 6000 - 10 s reaches zero at s = 600 m.
    floating = replace(tow, cable=replace(tow.cable, weight_in_water=-10.0))
    with pytest.raises(SlackCable, match=r"s = (59\d|60\d)\.\d m of 740 m"):
        static_shape(floating)
    static_shape(replace(floating, cable=replace(floating.cable, length=590.0)))


def test_at_least_two_segments(configurations: Callable[[str], Tow]) -> None:
    with pytest.raises(InvalidInput, match="at least 2 segments, but 1"):
        static_shape(configurations("mangus-740"), stations=1)


def test_a_towfish_without_a_stable_pitch_angle(table_two: Tow) -> None:
    assert isinstance(table_two.vehicle, Towfish)
    # Towed from below its centre of mass it turns over.
    below = replace(table_two.vehicle, tow_point_q=-0.8, buoyancy_centre_q=-0.02)
    with pytest.raises(InvalidInput, match=r"no stable pitch angle .* tow point or its buoyancy centre up"):
        static_shape(replace(table_two, vehicle=below))


def test_the_shape_ends_at_the_tow_point(configurations: Callable[[str], Tow]) -> None:
    shape = static_shape(replace(configurations("mangus-740"), speed=0.5), stations=10)
    assert shape.s.shape == shape.phi.shape == shape.T.shape == shape.x.shape == shape.z.shape == (11,)
    assert (shape.x[-1], shape.z[-1]) == (0.0, 0.0)
    assert shape.trail == -shape.x[0] > 0.0
    assert shape.depth == -shape.z[0] > 0.0
    assert shape.tension_at(37.0) == pytest.approx(0.5 * (shape.T[0] + shape.T[1]))


def test_slack_between_sections_says_where_in_the_whole_cable(configurations: Callable[[str], Tow]) -> None:
    tow = replace(configurations("s-shape-205"), current=None)
    # 530 N are lifted by 10.2 N/m over 51.96 m.
    with pytest.raises(SlackCable, match=r"at s = 52\.0 m of 205 m from the vehicle"):
        static_shape(tow)
    # A slow current draws the arc out to a hand's breadth: taut.
    taut = static_shape(replace(tow, current=Current.uniform(0.01)), stations=2000)
    assert 0.0 < taut.T.min() < 5.0
    with pytest.raises(SlackCable, match=r"s = 0\.0 m"):
        static_shape(replace(tow, vehicle=replace(tow.vehicle, buoyancy=3920.0)))
    afloat = replace(tow, sections=(), cable=replace(tow.cable, weight_in_water=0.0))
    with pytest.raises(SlackCable, match=r"s = 0\.0 m of 130 m"):
        static_shape(replace(afloat, vehicle=replace(tow.vehicle, buoyancy=3920.0)))


def test_slack_at_a_depth_that_is_only_tried_is_not_told(configurations: Callable[[str], Tow]) -> None:
    """In still water at 205 m, where the search for the depth begins, the float folds; at 101 m there is a current."""
    current = Current.from_profile([0.0, 120.0, 150.0], [0.3, 0.2, 0.0])
    tow = replace(configurations("s-shape-205"), current=current)
    shape = static_shape(tow)
    assert shape.flow[0] == pytest.approx(0.3 - 0.1 * shape.depth / 120.0, abs=1e-9)
    with pytest.raises(SlackCable):
        static_shape(replace(tow, current=Current.from_profile([0.0, 1.0, 2.0], [0.3, 0.2, 0.0])))


def test_a_cable_out_of_the_water_is_refused(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("s-shape-205")
    short = replace(tow, cable=replace(tow.cable, length=20.0))
    with pytest.raises(InvalidInput, match=r"out of the water: at s = 5\d\.\d m of 95 m .* m above the tow point"):
        static_shape(short)


def test_nodes_are_the_places_that_are_told(configurations: Callable[[str], Tow]) -> None:
    tow = configurations("s-shape-205")
    every = static_shape(tow, stations=410)
    nodes = np.array([0.0, 3.5, 40.0, 75.0, 130.5, 205.0])
    told = static_shape(tow, nodes=nodes)
    np.testing.assert_array_equal(told.s, nodes)
    for name in ("phi", "T", "x", "z", "strain", "flow"):
        np.testing.assert_allclose(getattr(told, name), getattr(every, name)[(2 * nodes).astype(int)], rtol=1e-12)
    nodes[1] = 300.0
    assert told.s[1] == 3.5


@pytest.mark.parametrize(
    ("nodes", "reason"),
    [
        ([0.0, 205.0], r"at least 3 nodes .* shape \(2,\)"),
        ([[0.0, 1.0, 205.0]], r"on one axis, but they have the shape \(1, 3\)"),
        ([0.0, float("nan"), 205.0], r"finite nodes, but nodes\[1\]"),
        ([0.0, 5.0, 5.0, 205.0], r"nodes\[1\] = 5 m and nodes\[2\] = 5 m"),
        ([1.0, 5.0, 205.0], r"from 0 m to the cable's 205 m, but they run from 1 m to 205 m"),
        ([0.0, 5.0, 130.0], r"but they run from 0 m to 130 m"),
    ],
)
def test_nodes_that_are_refused(configurations: Callable[[str], Tow], nodes: ArrayLike, reason: str) -> None:
    with pytest.raises(InvalidInput, match=reason):
        static_shape(configurations("s-shape-205"), nodes=nodes)


@pytest.mark.parametrize(
    ("depth", "reason"),
    [
        (40.0, r"at 40 m: .* rises at least 48\.\d+ m above it\. Ask for another depth"),
        (0.0, r"^The depth must be above 0 m, but it is 0 m"),
        (float("inf"), r"^The depth must be above 0 m, but it is inf m"),
    ],
)
def test_depths_out_of_reach(configurations: Callable[[str], Tow], depth: float, reason: str) -> None:
    with pytest.raises(InvalidInput, match=reason):
        length_for_depth(configurations("s-shape-205"), depth)


def test_a_cable_that_levels_out_does_not_reach_the_surface(configurations: Callable[[str], Tow]) -> None:
    tow = replace(configurations("mangus-740"), speed=2.0)
    afloat = replace(tow, cable=replace(tow.cable, weight_in_water=0.0, tangential_drag_coefficient=0.0))
    with pytest.raises(InvalidInput, match=r"at 5000 m: .* rises at most \d+\.?\d* m above it"):
        length_for_depth(afloat, 5000.0)
    with pytest.raises(SlackCable, match=r"at s = 52\.0 m from the vehicle"):
        length_for_depth(replace(configurations("s-shape-205"), current=None), 100.0)
    across = replace(tow, current=Current.uniform(0.3, 1.0))
    with pytest.raises(InvalidInput, match="across it"):
        length_for_depth(across, 100.0)


def test_a_towfish_may_hang_by_its_nose(table_two: Tow) -> None:
    """A tow point ahead of the centre of mass and nothing else: it hangs nose up, a quarter turn from level."""
    fish = replace(table_two.vehicle, tow_point_p=1.0, tow_point_q=0.0, buoyancy_centre_q=0.0, drag_centre_p=0.0)
    assert static_shape(replace(table_two, vehicle=fish)).pitch == pytest.approx(0.5 * math.pi, abs=1e-6)
