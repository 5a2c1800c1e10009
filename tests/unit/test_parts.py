"""Configurations of several parts: tails, currents across the tow and the settings of the link-joint simulator."""

import re

import pytest

from ident.configuration import Configuration, builtin_text, load, template
from models.quantity import GRAVITY, InvalidInput
from models.statics import static_shape

BASE = builtin_text("mangus-740")

TAIL = """
[[tail]]
name = "fish"
[tail.cable]
length_m = 200.0
diameter_m = 0.03
density_kg_m3 = 1500.0
young_modulus_Pa = 2e9
added_mass_kg_m = 0.7
normal_drag_coefficient = 1.2
tangential_drag_coefficient = 0.02
"""
BODY = """
[tail.body]
weight_N = 1000.0
buoyancy_N = 900.0
mass_kg = 100.0
added_mass_surge_kg = 50.0
added_mass_sway_kg = 60.0
added_mass_heave_kg = 70.0
area_surge_m2 = 0.5
area_sway_m2 = 0.6
area_heave_m2 = 0.7
drag_coefficient = 1.0
"""


def read(text: str) -> Configuration:
    return Configuration.from_text(text, "test", "test.toml")


def test_tails_are_parts_of_the_system_and_not_of_the_tow() -> None:
    other = TAIL.replace("fish", "side").replace("[tail.cable]", 'after = "vehicle"\n[tail.cable]')
    configuration = read(BASE + TAIL + BODY + TAIL.replace("fish", "end") + other)
    parts = {part.name: part for part in configuration.system.parts}
    assert {name: part.after for name, part in parts.items()} == {
        "vehicle": None,
        "fish": "vehicle",
        "end": "fish",
        "side": "vehicle",
    }
    fish = parts["fish"].body
    assert fish is not None
    assert (fish.weight_in_water, fish.area_sway, fish.added_mass_heave) == (100.0, 0.6, 70.0)
    assert parts["end"].body is None
    assert parts["fish"].cable.mass == pytest.approx(1500.0 * parts["fish"].cable.cross_section)
    assert configuration.tow.cable == parts["vehicle"].cable
    assert [part.name for part in configuration.system_of(2).parts] == ["vehicle", "fish"]
    assert not [key for key in configuration.unused if key.startswith("tail.")]
    assert set(configuration.unused_beside({"cable"})) >= {"tail.1.name", "tail.2.cable.length_m"}
    tails = {"tail", "tail.cable", "tail.body"}
    assert not [key for key in configuration.unused_beside(tails) if key.startswith("tail.")]


def test_link_joint_settings_reach_the_system() -> None:
    text = '[link-joint]\nlinks = 30\ndrag_law = "incidence"\nstrumming = true\nstrumming_damping = 0.01\n'
    configuration = read(BASE + text)
    assert (configuration.link_joint.links, configuration.link_joint.tolerance) == (30, 1e-3)
    system = configuration.system
    assert (system.drag_law, system.strumming, system.strumming_damping) == ("incidence", True, 0.01)
    assert not read(BASE).system.strumming


def test_a_current_across_the_tow_is_for_the_link_joint_simulator() -> None:
    text = BASE + "[current]\ndepth_m = [0, 500]\nspeed_m_s = [0.5, 0.2]\ndirection_rad = "
    current = read(text + "[0.0, 1.5707963267948966]\n").system.current
    assert current is not None
    assert current.velocity_at(500.0) == pytest.approx([0.0, 0.2])
    with pytest.raises(InvalidInput, match=r"at 500 m the current has 0\.2 m/s across it"):
        static_shape(read(text + "[0.0, 1.57]\n").tow)
    against = static_shape(read(text + "[3.141592653589793]\n").tow)
    assert against.trail > 0.0
    with pytest.raises(InvalidInput, match=r"test\.toml: \[current\] .* one direction \[rad\] for each depth"):
        read(text + "[0.0, 1.0, 2.0]\n")


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (BASE + TAIL.replace("= 200.0", "= 0.0"), ("[tail.cable] (tail 1) length_m (L)", "above 0 m", "0.0 m")),
        (BASE + TAIL.replace("= 2e9", "= 2e9\nlenght_m = 2"), ("[tail.cable] (tail 1)", "did you mean length_m")),
        (BASE + TAIL + BODY.replace("= 0.7\n", "= 0\n"), ("[tail.body] (tail 1) area_heave_m2", "above 0 m2")),
        (BASE + TAIL + BODY.replace("sway_m2 = 0.6", "sway_m = 0.6"), ("[tail.body] (tail 1)", "area_sway_m2?")),
        (BASE + TAIL + TAIL, ("test.toml:", 'Two parts are called "fish"')),
        (BASE + TAIL.replace("fish", "vehicle"), ('Two parts are called "vehicle"',)),
        (BASE + TAIL + 'after = "body"\n', ("[tail.cable] (tail 1)", "unknown key after")),
        (BASE + TAIL.replace('"fish"', '"fish"\nafter = "body"'), ('Part "fish"', '"vehicle"', 'after "body"')),
        (BASE + TAIL.replace("fish", "a fish"), ("[tail] (tail 1)", "letters, digits", "'a fish'")),
        (BASE + TAIL.replace('name = "fish"', ""), ("[tail] (tail 1)", "lacks the key name")),
        (BASE + TAIL + BODY.replace("= 900.0", "= 90000.0"), ("test.toml:", "floats up", "above 0 N")),
        (BASE + '[[tail]]\nname = "fish"\n', ("[tail.cable] (tail 1)", "length_m (L)")),
        (BASE + '[[tail]]\nname = "fish"\ncable = 3\n', ("cable = 3 of tail 1", "section [tail.cable]")),
        (BASE + TAIL.replace("[[tail]]", "[tail]"), ("tail = a table", "[[tail]]")),
        (BASE + '["tail.cable"]\nlength_m = 3.0\n', ("unknown section [tail.cable]",)),
        (BASE + "[link-joint]\nlinks = 3\n", ("[link-joint] links (n)", "at least 4")),
        ('guesses = ["tail.2.cable.length_m"]\n' + BASE + TAIL, ("did you mean tail.1.cable.length_m?",)),
    ],
)
def test_refusals_of_systems_name_the_part(text: str, parts: tuple[str, ...]) -> None:
    with pytest.raises(InvalidInput) as caught:
        read(text)
    for part in parts:
        assert part in str(caught.value)


def test_one_part_is_refused_only_where_it_is_towed_in_three_dimensions() -> None:
    assert BASE.count("area_m2 = 0.52") == 1
    bare = read(BASE.replace("area_m2 = 0.52", "area_m2 = 0.0"))
    with pytest.raises(InvalidInput, match=r"test\.toml: Vehicle\.area \(A\) must be above 0 m2"):
        bare.system_of()
    with pytest.raises(InvalidInput, match="1 part, but 2 were asked for"):
        read(BASE).system_of(2)
    with pytest.raises(InvalidInput, match="1 to 3 parts, but 0 were asked for"):
        load("multipart-2200").system_of(0)


def test_a_tail_of_the_template_is_valid() -> None:
    tail = template()[template().index("#[[tail]]") :]
    tail = re.sub(r"^#(?=\w|\[)", "", tail[: tail.index("\n\n")], flags=re.MULTILINE)
    assert [(part.name, part.after) for part in read(BASE + tail).system.parts] == [
        ("vehicle", None),
        ("towed-body", "vehicle"),
    ]


def test_multipart_2200_has_the_figures_of_its_source() -> None:
    own = load("multipart-2200")
    main, unit, body = own.system.parts
    assert (main.cable.length, unit.cable.length, body.cable.length) == (2200.0, 200.0, 200.0)
    assert (unit.after, body.after) == ("vehicle", "damping-unit")
    assert main.body is not None
    assert main.body.weight_in_water == pytest.approx(700.0 * GRAVITY, rel=1e-5)
    assert main.cable.mass * 3200.0 / main.body.mass == pytest.approx(3.429, rel=1e-3)
    assert own.system.speed == pytest.approx(6.0 * 1852.0 / 3600.0, rel=1e-4)
    for part in (main, unit):
        displaced = 1025.0 * part.cable.cross_section
        assert part.cable.weight_in_water == pytest.approx((part.cable.mass - displaced) * GRAVITY, abs=1e-3)
    assert body.body == unit.body
    assert body.body is not None
    assert body.body.weight_in_water == 0.0
    strumming = load("multipart-2200-strumming")
    assert strumming.system.parts == own.system.parts
    assert (strumming.system.strumming, own.system.strumming) == (True, False)
