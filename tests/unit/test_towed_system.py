"""Towed systems in three dimensions: the body as a joint, the order of the parts, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from models.body import Body
from models.cable import Cable
from models.current import Current
from models.quantity import GRAVITY, InvalidInput
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.vehicle import Towfish, Vehicle

CABLE = Cable(
    length=100.0,
    diameter=0.02,
    mass=1.0,
    weight_in_water=5.0,
    added_mass=0.3,
    axial_stiffness=1e7,
    normal_drag_coefficient=1.2,
    tangential_drag_coefficient=0.02,
)
POINT = Vehicle(weight_in_water=6000.0, mass=760.0, added_mass=545.0, area=0.52, drag_coefficient=1.6)
BODY = Body.from_vehicle(POINT)


def part(name: str, after: str | None = None, body: Body | None = BODY) -> Part:
    return Part(name=name, cable=CABLE, body=body, after=after)


def test_a_point_vehicle_is_a_body_alike_along_every_axis() -> None:
    assert BODY.weight == pytest.approx(760.0 * GRAVITY)
    assert BODY.weight_in_water == pytest.approx(6000.0)
    assert {BODY.area_surge, BODY.area_sway, BODY.area_heave} == {0.52}
    assert {BODY.added_mass_surge, BODY.added_mass_sway, BODY.added_mass_heave} == {545.0}


@pytest.mark.parametrize(("mass", "weight"), [(10.0, 6000.0), (760.0, -50.0), (0.0, 0.0), (0.0, -50.0)])
def test_weight_in_water_is_kept_whatever_the_mass(mass: float, weight: float) -> None:
    body = Body.from_vehicle(replace(POINT, mass=mass, weight_in_water=weight))
    assert body.weight_in_water == pytest.approx(weight)
    assert min(body.weight, body.buoyancy) >= 0.0


def test_a_towfish_keeps_its_axes() -> None:
    fish = Towfish(
        weight=3920.0,
        buoyancy=780.0,
        mass=400.0,
        added_mass_p=50.0,
        added_mass_q=500.0,
        inertia=280.0,
        drag_coefficient=2.0,
        area_p=0.25,
        area_q=1.0,
        length=2.0,
    )
    body = Body.from_vehicle(fish)
    assert (body.weight, body.buoyancy, body.mass) == (3920.0, 780.0, 400.0)
    assert (body.area_surge, body.area_sway, body.area_heave) == (0.25, 1.0, 1.0)
    assert (body.added_mass_surge, body.added_mass_sway, body.added_mass_heave) == (50.0, 500.0, 500.0)


@pytest.mark.parametrize("axis", ["surge", "sway", "heave"])
def test_a_body_without_area_is_refused(axis: str) -> None:
    with pytest.raises(InvalidInput, match=rf"Body\.area_{axis} .* must be above 0 m2, but it is 0 m2"):
        replace(BODY, **{f"area_{axis}": 0.0})


def test_a_vehicle_without_area_is_named_by_its_own_field() -> None:
    with pytest.raises(InvalidInput, match=r"Vehicle\.area \(A\) must be above 0 m2 in the link-joint chain"):
        Body.from_vehicle(replace(POINT, area=0.0))
    assert replace(BODY, drag_coefficient=0.0).drag_coefficient == 0.0


def test_a_tow_is_a_system_of_one_part() -> None:
    current = Current.uniform(0.1)
    tow = Tow(cable=CABLE, vehicle=POINT, water_density=1000.0, speed=2.0, current=current)
    system = TowedSystem.from_tow(tow)
    assert system.parts == (Part(name="vehicle", cable=CABLE, body=BODY),)
    assert (system.water_density, system.speed, system.current) == (1000.0, 2.0, current)


def test_parts_may_branch_and_end_bare() -> None:
    system = TowedSystem(parts=(part("a"), part("b", "a"), part("c", "a", body=None), part("d", "c")))
    assert [each.after for each in system.parts] == [None, "a", "a", "c"]
    assert part("e", body=None).weight_in_water == 500.0


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ((), "at least one part"),
        ((part("a", "b"),), 'first part, "a", begins at the ship, but it is after "b"'),
        ((part("a"), part("b")), 'Part "b" must be after one of .* "a", but it is after nothing'),
        ((part("a"), part("b", "b")), 'after one of the parts before it, "a", but it is after "b"'),
        ((part("a"), part("b", "c"), part("c", "a")), 'after "c"'),
        ((part("a"), part("a", "a")), 'Two parts are called "a"'),
    ],
)
def test_parts_that_make_no_system_are_refused(parts: tuple[Part, ...], words: str) -> None:
    with pytest.raises(InvalidInput, match=words):
        TowedSystem(parts=parts)


def test_a_system_that_floats_up_is_refused_as_a_whole() -> None:
    float_up = replace(BODY, buoyancy=BODY.weight + 400.0)
    TowedSystem(parts=(part("a", body=float_up),))  # the cable holds it down
    with pytest.raises(InvalidInput, match=r"whole system floats up: .* is -1000 N"):
        TowedSystem(parts=(part("a", body=replace(float_up, buoyancy=BODY.weight + 1500.0)),))
    weightless = Part(name="a", cable=replace(CABLE, weight_in_water=0.0), body=None)
    with pytest.raises(InvalidInput, match="must be above 0 N"):
        TowedSystem(parts=(weightless,))


def test_a_part_without_length_or_with_an_odd_name_is_refused() -> None:
    with pytest.raises(InvalidInput, match=r"Cable\.length \(L\) must be above 0 m"):
        replace(CABLE, length=0.0)
    for name in ("", "two words", "a.b", "a\n"):
        with pytest.raises(InvalidInput, match="letters, digits"):
            part(name)


def test_components_of_a_current_are_interpolated() -> None:
    current = Current.from_profile([0.0, 100.0], [1.0, 1.0], [0.0, 0.5 * math.pi])
    velocity = current.velocity_at([[-5.0, 50.0], [100.0, 900.0]])
    assert velocity == pytest.approx(np.array([[[1.0, 0.0], [0.5, 0.5]], [[0.0, 1.0], [0.0, 1.0]]]), abs=1e-15)
    assert current.at([0.0, 50.0]) == pytest.approx([1.0, 0.5])
    assert not current.planar


def test_a_current_along_x_is_planar_in_either_sense() -> None:
    assert Current.uniform(-0.3).planar
    assert Current.uniform(0.3, math.pi).planar
    assert Current.uniform(0.0, 1.0).planar
    assert Current.uniform(0.3, math.pi).at(0.0) == pytest.approx(-0.3)
    assert Current.from_profile([0.0, 9.0], [1.0, 2.0], [0.5]).direction.tolist() == [0.5, 0.5]


def test_a_speed_toward_x_is_added_to_every_depth() -> None:
    more = Current.from_profile([0.0, 100.0], [-1.0, 1.0], [0.0, 0.5 * math.pi]).plus(0.25)
    assert more.velocity == pytest.approx(np.array([[-0.75, 0.0], [0.25, 1.0]]), abs=1e-15)
    assert Current.uniform(0.2).plus(-0.5).planar
