"""The statics keep their error far below that of any model, however few places are told, with tight arcs too."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from models.cable import Cable
from models.current import Current
from models.statics import StaticShape, static_shape
from models.tow import Tow

RHO = 1025.0


def slope(y: np.ndarray, cable: Cable, flow: float) -> np.ndarray:
    """Derivative of (phi, T, x, z) along a cable, T (2.8)-(2.9) with the tangential drag."""
    phi, T, _, _ = y
    s, c, e = math.sin(phi), math.cos(phi), T / cable.axial_stiffness
    k = 0.5 * RHO * cable.diameter * (1.0 + e) * (1.0 - 0.5 * e) * flow * abs(flow)
    bend = (cable.weight_in_water * c + k * cable.normal_drag_coefficient * s * abs(s)) / T
    pull = cable.weight_in_water * s - k * cable.tangential_drag_coefficient * c * abs(c)
    return np.array([bend, pull, (1.0 + e) * c, (1.0 + e) * s])


def classical(tow: Tow, shape: StaticShape, steps: int) -> np.ndarray:
    """(phi, T, x, z) at the top by the classical Runge-Kutta method in the angle, from the shape's own lower end.

    The steps are short where the tension is small, so that every arc has as many as its turn needs.
    """
    y = np.array([shape.phi[0], shape.T[0], shape.x[0], shape.z[0]])
    flow, done = float(shape.flow[0]), 0.0
    for cable in tow.cables:
        inside = np.linspace(done, done + cable.length, 2001)
        density = 1.0 / cable.length + 30.0 / np.interp(inside, shape.s, shape.T)
        share = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
        for h in np.diff(np.interp(np.linspace(0.0, share[-1], steps + 1), share, inside)):
            a = slope(y, cable, flow)
            b = slope(y + 0.5 * h * a, cable, flow)
            c = slope(y + 0.5 * h * b, cable, flow)
            d = slope(y + h * c, cable, flow)
            y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        done += cable.length
    return y


@pytest.mark.parametrize(
    ("name", "speed", "current"),
    [("mangus-2500", 0.7, 0.1), ("swath-4000", -1.5, 0.0), ("s-shape-205", 0.0, 0.2), ("s-shape-205", 0.0, 0.03)],
)
def test_error_is_that_of_rounding(
    configurations: Callable[[str], Tow], name: str, speed: float, current: float
) -> None:
    tow = replace(configurations(name), speed=speed, current=Current.uniform(current))
    shape = static_shape(tow, stations=2000)
    scale = np.array([1.0, shape.T[-1], tow.length, tow.length])
    top = np.array([shape.phi[-1], shape.T[-1], 0.0, 0.0])
    assert np.max(np.abs(classical(tow, shape, 1000) - top) / scale) < 3e-11
    # Where the places are has no say in it.
    few = static_shape(tow, stations=2)
    np.testing.assert_allclose([few.phi[-1], few.T[-1]], top[:2], rtol=1e-13)
    np.testing.assert_allclose([few.x[0], few.z[0]], [shape.x[0], shape.z[0]], atol=1e-11 * tow.length)
    # Between its steps the integration is as good as at them, where a cut makes it step.
    upper = tow.cable
    for s in (0.37 * upper.length, 0.81 * upper.length):
        cut = replace(upper, length=s)
        stepped = replace(tow, cable=replace(upper, length=upper.length - s), sections=(cut, *tow.sections))
        place = tow.length - upper.length + s
        there, between = (static_shape(each, nodes=[0.0, place, tow.length]) for each in (stepped, tow))
        for field, size in (("phi", 1.0), ("T", scale[1]), ("x", tow.length), ("z", tow.length)):
            assert abs(getattr(there, field)[1] - getattr(between, field)[1]) < 1e-10 * size
