"""Quantities, cable, vehicle, current and trace: what they accept, refuse and compute."""

import math
from dataclasses import replace
from typing import Annotated

import numpy as np
import pytest

from models.cable import Cable
from models.current import Current
from models.quantity import GRAVITY, InvalidInput, Quantity, non_negative, positive, quantities
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Towfish, Vehicle


@pytest.fixture
def cable() -> Cable:
    return Cable.from_material(
        length=1000.0,
        diameter=0.02,
        density=4000.0,
        young_modulus=5e10,
        water_density=1000.0,
        added_mass=0.3,
        normal_drag_coefficient=1.5,
        tangential_drag_coefficient=0.1,
    )


@pytest.mark.parametrize(
    ("quantity", "inside", "outside", "text"),
    [
        (positive("L", "m"), (1e-9, 5.0), (0.0, -1.0), "above 0"),
        (non_negative("M", "kg"), (0.0, 5.0), (-1e-9,), "at least 0"),
        (Quantity("nu", "-", 0.0, 0.5), (0.0, 0.5), (-0.1, 0.6), "at least 0 and at most 0.5"),
        (Quantity("c", "-", 0.0, 1.0, open_upper=True), (0.0, 0.99), (1.0,), "at least 0 and below 1"),
        (Quantity("x", "m", upper=3.0), (-1e9, 3.0), (3.1,), "at most 3"),
        (Quantity("x", "m"), (-1e9, 1e9), (), "finite"),
    ],
)
def test_bounds(quantity: Quantity, inside: tuple[float, ...], outside: tuple[float, ...], text: str) -> None:
    assert all(quantity.holds(value) for value in inside)
    assert not any(quantity.holds(value) for value in (*outside, math.nan, math.inf, -math.inf))
    assert quantity.bound_text == text


def test_quantities_come_in_order_and_through_optional_types() -> None:
    class Pair:
        first: Annotated[float, positive("a", "m")]
        plain: int
        second: Annotated[float | None, non_negative("b", "s")]

    assert {name: q.symbol for name, q in quantities(Pair).items()} == {"first": "a", "second": "b"}
    assert list(quantities(Cable))[:4] == ["length", "diameter", "mass", "weight_in_water"]


def test_cable_from_material(cable: Cable) -> None:
    area = math.pi * 0.01**2
    assert cable.mass == pytest.approx(4000.0 * area)
    assert cable.weight_in_water == pytest.approx(3000.0 * area * GRAVITY)
    assert cable.axial_stiffness == pytest.approx(5e10 * area)
    assert cable.cross_section == pytest.approx(area)
    assert cable.poisson_ratio == 0.5


def test_cable_drag_on_its_reference_area(cable: Cable) -> None:
    assert cable.normal_drag(1025.0) == pytest.approx(0.5 * 1025.0 * 0.02 * 1.5)
    assert cable.tangential_drag(1025.0) == pytest.approx(0.5 * 1025.0 * 0.02 * 0.1)
    around = replace(cable, tangential_area="circumference")
    assert around.tangential_drag(1025.0) == pytest.approx(math.pi * cable.tangential_drag(1025.0))


@pytest.mark.parametrize(
    ("field", "value"), [("length", 0.0), ("diameter", -1.0), ("added_mass", -0.1), ("poisson_ratio", 0.51)]
)
def test_cable_refuses_with_field_value_unit_and_bound(cable: Cable, field: str, value: float) -> None:
    with pytest.raises(InvalidInput, match=rf"Cable\.{field} .*{value:g}") as refusal:
        replace(cable, **{field: value})
    assert quantities(Cable)[field].bound_text in str(refusal.value)


def test_vehicle_drag_and_bounds() -> None:
    vehicle = Vehicle(weight_in_water=6000.0, mass=760.0, added_mass=545.0, area=0.52, drag_coefficient=1.6)
    assert vehicle.drag(1025.0) == pytest.approx(0.5 * 1025.0 * 1.6 * 0.52)
    with pytest.raises(InvalidInput, match=r"Vehicle\.area"):
        replace(vehicle, area=-0.1)


def test_towfish_weighs_what_its_mass_weighs(table_two: Tow) -> None:
    fish = table_two.vehicle
    assert isinstance(fish, Towfish)
    assert fish.weight_in_water == pytest.approx(3140.0)
    assert fish.drag(1025.0) == pytest.approx(0.5 * 1025.0 * 2.0 * 0.25)
    with pytest.raises(InvalidInput, match="mass times gravity within 2 %"):
        replace(fish, weight=3140.0)


def test_current_is_linear_between_and_constant_outside() -> None:
    current = Current.from_profile([10.0, 20.0, 40.0], [1.0, 0.5, 0.0])
    np.testing.assert_allclose(current.at([0.0, 10.0, 15.0, 30.0, 99.0]), [1.0, 1.0, 0.75, 0.25, 0.0])
    assert Current.uniform(0.3).at(np.zeros((2, 3))).shape == (2, 3)
    with pytest.raises(ValueError, match="read-only"):
        current.speed[0] = 2.0


@pytest.mark.parametrize(
    ("depth", "speed", "message"),
    [
        ([0.0, 1.0], [0.0], "2 depths and 1 speeds"),
        ([], [], "0 depths"),
        ([0.0, math.nan], [0.0, 0.0], "finite"),
        ([0.0, 5.0, 5.0], [0.0, 0.1, 0.2], r"depth\[1\] = 5 m and depth\[2\] = 5 m"),
    ],
)
def test_current_refuses(depth: list[float], speed: list[float], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        Current.from_profile(depth, speed)


def test_trace_spline_reproduces_a_cubic_and_its_rate() -> None:
    t = np.array([0.0, 1.0, 1.5, 4.0, 6.0])
    trace = Trace.along_x(t, t**3 - 2.0 * t, z=-t)
    times = np.linspace(0.0, 6.0, 31)
    np.testing.assert_allclose(trace.at(times)[:, 0], times**3 - 2.0 * times, atol=1e-11)
    np.testing.assert_allclose(trace.rates()[:, 0], 3.0 * t**2 - 2.0, atol=1e-11)
    np.testing.assert_allclose(trace.at(times)[:, 2], -times, atol=1e-12)
    assert len(trace) == 5


def test_trace_leaves_missing_fixes_out() -> None:
    t = np.arange(6.0)
    position = np.column_stack([t**2, 0.0 * t, 0.0 * t])
    position[2] = np.nan
    trace = Trace(t=t, position=position)
    assert trace.valid.tolist() == [True, True, False, True, True, True]
    np.testing.assert_allclose(trace.at([2.0])[0], [4.0, 0.0, 0.0], atol=1e-12)
    position[1:] = np.nan
    with pytest.raises(InvalidInput, match="at least 2 fixes"):
        _ = Trace(t=t, position=position).spline


def test_trace_prefers_the_velocity_it_was_given() -> None:
    t = np.arange(3.0)
    given = np.full((3, 3), 7.0)
    assert np.array_equal(Trace(t=t, position=np.zeros((3, 3)), velocity=given).rates(), given)


@pytest.mark.parametrize(
    ("t", "message"),
    [
        ([0.0], "at least 2 times"),
        ([0.0, 1.0, 1.0], r"t\[1\] = 1 s and t\[2\] = 1 s"),
        ([0.0, math.nan, 2.0], r"t\[1\] is not"),
    ],
)
def test_trace_refuses_times(t: list[float], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        Trace(t=np.array(t), position=np.zeros((len(t), 3)))


def test_trace_refuses_wrong_shapes_and_keeps_its_own_copy() -> None:
    t = np.arange(3.0)
    with pytest.raises(InvalidInput, match=r"Trace\.position needs the shape \(3, 3\)"):
        Trace(t=t, position=np.zeros((3, 2)))
    with pytest.raises(InvalidInput, match=r"Trace\.tension needs the shape \(3, 2\)"):
        Trace(t=t, position=np.zeros((3, 3)), tension=np.zeros((2, 2)))
    trace = Trace.along_x(t, t)
    t[0] = 99.0
    assert trace.t[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        trace.position[0, 0] = 1.0
