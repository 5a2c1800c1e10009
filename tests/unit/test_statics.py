"""What the statics refuse, and how."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from models.quantity import InvalidInput
from models.statics import SlackCable, static_shape
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
