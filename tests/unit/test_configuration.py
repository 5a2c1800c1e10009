"""Configurations: what is read, what is refused and in which words."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from ident.builtin import find
from ident.configuration import Configuration, builtin_names, builtin_text, load, template
from ident.schema import keys_of
from ident.sections import INPUTS, MANOEUVRES, SECTIONS
from models.quantity import InvalidInput
from models.tow import Tow
from models.vehicle import Towfish

BASE = """
description = "a test"
[water]
density_kg_m3 = 1025.0
[cable]
length_m = 1000
diameter_m = 0.0173
density_kg_m3 = 4400.0
young_modulus_Pa = 6.2e10
added_mass_kg_m = 0.24
normal_drag_coefficient = 1.6
tangential_drag_coefficient = 0.08
[vehicle]
weight_in_water_N = 6000.0
mass_kg = 760.0
added_mass_kg = 545.0
area_m2 = 0.52
drag_coefficient = 1.6
"""
SECTION = "[[section]]\nlength_m = 75.0\n"
BY_LENGTH = "mass_per_length_kg_m = 1.03\nweight_in_water_N_m = 7.8\naxial_stiffness_N = 1.4e7\n"


def read(text: str) -> Configuration:
    return Configuration.from_text(text, "test", "test.toml")


def refusal(text: str) -> str:
    with pytest.raises(InvalidInput) as caught:
        read(text)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def changed(old: str, new: str) -> str:
    assert old in BASE
    return BASE.replace(old, new, 1)


def test_built_in_figures() -> None:
    assert builtin_names() == (
        "autec-1200",
        "deep-tow-camera",
        "mangus-2500",
        "mangus-740",
        "multipart-2200",
        "multipart-2200-strumming",
        "s-shape-205",
        "s-shape-205-thrust",
        "swath-4000",
    )
    tow = load("autec-1200").tow
    assert (tow.cable.length, tow.vehicle.weight_in_water, tow.vehicle.mass) == (1200.0, 19170.0, 2240.0)
    assert tow.cable.mass == pytest.approx(4400.0 * tow.cable.cross_section)
    for name, length in (("mangus-740", 740.0), ("mangus-2500", 2500.0)):
        tow = load(name).tow
        assert (tow.cable.length, tow.vehicle.weight_in_water, tow.vehicle.added_mass) == (length, 6000.0, 545.0)


def test_swath_4000_is_table_two(table_two: Tow) -> None:
    own = load("swath-4000")
    assert own.tow.vehicle == table_two.vehicle
    given = replace(own.tow.cable, axial_stiffness=table_two.cable.axial_stiffness)
    assert given == table_two.cable
    assert own.tow.cable.axial_stiffness == pytest.approx(table_two.cable.axial_stiffness, rel=1e-8)
    assert own.compensator.mass == 530.0
    assert own.guesses == ()


@pytest.mark.parametrize(
    ("name", "weight", "thrust", "float_length"),
    [("s-shape-205", 530.0, 0.0, 75.0), ("s-shape-205-thrust", 524.0, 70.0, 73.75)],
)
def test_s_shape_is_table_two_with_a_float(
    table_two: Tow, name: str, weight: float, thrust: float, float_length: float
) -> None:
    own = load(name)
    tow = own.tow
    assert isinstance(tow.vehicle, Towfish)
    assert tow.vehicle == replace(table_two.vehicle, buoyancy=3920.0 - weight, thrust=thrust)
    assert tow.length == 205.0
    (floated,) = tow.sections
    assert (floated.length, floated.weight_in_water) == (float_length, -10.2)
    assert replace(floated, length=tow.cable.length, weight_in_water=8.14) == tow.cable
    assert tow.current is not None
    assert tow.current.at([0.0, 100.0]).tolist() == [0.2, 0.2]
    assert "towfish.buoyancy_N" in own.guesses
    assert ("towfish.thrust_N" in own.guesses) == (thrust != 0.0)


@pytest.mark.parametrize("name", builtin_names())
def test_built_ins_rebuild_from_their_text(name: str) -> None:
    configuration = load(name)
    again = Configuration.from_text(configuration.text, configuration.name, "FIT.json")
    assert configuration.text == builtin_text(name)
    assert (again.tow.cable, again.tow.vehicle) == (configuration.tow.cable, configuration.tow.vehicle)
    assert (again.input, again.manoeuvre, again.identification) == (
        configuration.input,
        configuration.manoeuvre,
        configuration.identification,
    )
    assert configuration.manoeuvre.duration == configuration.input.duration == 3600.0


def test_deep_tow_camera_marks_every_property_as_a_guess() -> None:
    configuration = load("deep-tow-camera")
    properties = {key for key in configuration.given if key.startswith(("cable.", "vehicle.", "tow."))}
    assert properties == set(configuration.guesses)
    assert load("autec-1200").guesses == ()


def test_defaults_and_whole_numbers() -> None:
    configuration = read(BASE)
    assert configuration.tow.cable.length == 1000.0
    assert isinstance(configuration.tow.cable.length, float)
    assert configuration.spectral.tolerance == 1e-4
    assert configuration.scoring.settle == 300.0
    assert configuration.identification.budget == 3000
    assert len(configuration.identification.models) == 8
    assert set(configuration.inputs) == set(INPUTS)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (changed("length_m", "lenght_m"), ("test.toml: [cable]", "lenght_m = 1000", "did you mean length_m?")),
        (changed("length_m = 1000\n", ""), ("test.toml: [cable]", "length_m (L)", "above 0 m")),
        (changed("= 1000", "= -3"), ("test.toml: [cable]", "length_m (L)", "above 0 m", "-3 m")),
        (changed("= 1000", "= true"), ("length_m (L)", "a number above 0 m", "it is true.")),
        (changed("= 1000", '= "1000"'), ("length_m (L)", "a number above 0 m", '"1000"')),
        (changed("= 1000", "= [1000]"), ("length_m (L)", "[1000]")),
        (changed("= 1000", "= 2026-01-01"), ("length_m (L)", "2026-01-01")),
        (changed("= 1000", "= {a = 1}"), ("length_m (L)", "a table")),
        (changed("= 1000", "= nan"), ("length_m (L)", "nan m")),
        (changed("= 1000", "= inf"), ("length_m (L)", "inf m")),
        (changed("= 1000", "= 1" + "0" * 400), ("length_m (L)", "digits m")),
        (BASE + "[cabel]\n", ("unknown section [cabel]", "did you mean cable?")),
        (BASE + "[inputs.ramp]\n", ("unknown section [inputs.ramp]", "did you mean inputs.ramps?")),
        ("inputs = 3\n" + BASE, ("inputs = 3", "[inputs.ramps]")),
        ("tow = 3\n" + BASE, ("tow = 3", "section [tow]")),
        ("descriptoin = 'x'\n" + BASE, ('descriptoin = "x"', "did you mean description?")),
        ("description2 = 3\ndescription = 4\n", ("description2 = 3",)),
        (BASE + "[[bode]]\n", ("bode = [a table]",)),
        (BASE + "[section]\nlength_m = 5.0\n", ("section = a table", "[[section]]", "two brackets")),
        (BASE + "[[section]]\ndiameter_m = 0.02\n", ("[section] (section 1)", "length_m (L)", "above 0 m")),
        (BASE + SECTION + "[[section]]\nlength_m = -5.0\n", ("[section] (section 2) length_m (L)", "-5.0 m")),
        (BASE + SECTION + "lenght = 5.0\n", ("[section] (section 1)", "unknown key lenght", "did you mean length_m?")),
        (
            BASE + SECTION + "mass_per_length_kg_m = 1.0\ndensity_kg_m3 = 900.0\n",
            ("[section] (section 1) has mass_per_length_kg_m beside keys of the material",),
        ),
        (
            BASE + "[[section]]\nlength_m = 5.0\npoisson_ratio = 0.6\n",
            ("[section] (section 1) poisson_ratio (nu)", "0.6"),
        ),
        (
            changed("density_kg_m3 = 4400.0\nyoung_modulus_Pa = 6.2e10\n", BY_LENGTH)
            + SECTION
            + "density_kg_m3 = 900.0\n",
            ("[section] (section 1) lacks the key young_modulus_Pa (E)",),
        ),
        (BASE + "[compensator]\nstroke_m = 0.0\n", ("[compensator] stroke_m (R_max)", "above 0 m")),
        ('guesses = ["section.1.diameter_m"]\n' + BASE + SECTION, ("guesses[0]", "section.1.length_m")),
        (BASE + "[verification]\nkind = 'slow'\n", ("kind", '"starts-and-stops"', '"slow"')),
        (BASE + "[verification]\nlinks = 7\n", ("links (n)", "at least 8", "7.")),
        (BASE + "[verification]\nlinks = true\n", ("links (n)", "a whole number", "true.")),
        (BASE + "[verification]\nlinks = 60.0\n", ("links (n)", "a whole number", "60.0")),
        (BASE + "[verification]\nkind = 'few-sinusoids'\npauses_s = [1.0]\n", ("unknown key pauses_s", "periods_s")),
        (BASE + "[step]\nlengths_m = []\n", ("lengths_m (L)", "at least one")),
        (BASE + "[step]\nlengths_m = [500, -1]\n", ("lengths_m (L)[1]", "above 0 m", "-1 m")),
        (BASE + "[step]\nlengths_m = 500\n", ("lengths_m (L)", "a list")),
        (BASE + "[current]\ndepth_m = [0.0]\n", ("[current]", "speed_m_s (U)", "a list")),
        (BASE + "[current]\ndepth_m = [9.0, 1.0]\nspeed_m_s = [0, 1]\n", ("test.toml: [current]", "increasing depths")),
        (BASE + "[input]\nbiases_m_s = []\n", ("[input]", "at least one")),
        (BASE + "[identification]\nmodels = ['cubic']\n", ("test.toml: [identification]", "cubic")),
        (BASE + "[identification]\nmodels = ['massless-linear', 'massless-4-linear']\n", ("there twice",)),
        (BASE + "[identification]\ndelay = 'none'\n", ("delay", '"fit", "fixed"')),
        (BASE + "[towfish]\nmass_kg = 1.0\n", ("[towfish] lacks the key",)),
        (BASE[: BASE.index("[vehicle]")], ("one of the sections [vehicle] and [towfish]", "neither")),
        ('guesses = ["cable.lenght_m"]\n' + BASE, ("guesses[0]", "did you mean cable.length_m?")),
        ('guesses = ["cable.length_m", "cable.length_m"]\n' + BASE, ("guesses[1]", "twice")),
        (changed("density_kg_m3 = 4400.0\n", ""), ("[cable]", "lacks the key density_kg_m3 (rho_c)")),
        (changed("density_kg_m3 = 4400.0\nyoung_modulus_Pa = 6.2e10\n", ""), ("[cable]", "none of them")),
        (changed("density_kg_m3 = 4400.0\n", "axial_stiffness_N = 1e7\n"), ("[cable]", "keys of both")),
        ("", ("test.toml: [cable]", "length_m (L)")),
        ("a = 1\na = 2\n", ("not valid TOML", "line 2")),
        ("a = \n", ("not valid TOML", "line 1")),
        ("a = " + "[" * 5000, ("not usable TOML",)),
        ("a = " + "1" * 5000, ("not usable TOML",)),
    ],
)
def test_refusals_name_file_key_value_and_bound(text: str, parts: tuple[str, ...]) -> None:
    message = refusal(text)
    for part in parts:
        assert part in message


def test_vehicle_and_towfish_together_are_refused() -> None:
    assert "has both" in refusal(BASE + _section("towfish"))


def test_towfish_is_read() -> None:
    fish = read(BASE[: BASE.index("[vehicle]")] + _section("towfish")).tow.vehicle
    assert isinstance(fish, Towfish)
    assert (fish.inertia, fish.tow_point_q, fish.weight_in_water) == (280.0, 0.8, 3140.0)


def test_towfish_contradiction_names_the_section() -> None:
    text = BASE[: BASE.index("[vehicle]")] + _section("towfish").replace("weight_N = 3920.0", "weight_N = 4920.0")
    assert refusal(text).startswith("test.toml: [towfish] Towfish.weight")


def test_cable_by_length_equals_cable_by_material() -> None:
    cable = read(BASE).tow.cable
    by_length = f"mass_per_length_kg_m = {cable.mass!r}\nweight_in_water_N_m = {cable.weight_in_water!r}\n"
    by_length += f"axial_stiffness_N = {cable.axial_stiffness!r}\n"
    text = changed("density_kg_m3 = 4400.0\nyoung_modulus_Pa = 6.2e10\n", by_length)
    assert read(text).tow.cable == cable


def test_a_section_takes_from_the_cable_what_it_does_not_say() -> None:
    text = changed("density_kg_m3 = 4400.0\nyoung_modulus_Pa = 6.2e10\n", BY_LENGTH)
    text += SECTION + "[[section]]\nlength_m = 20.0\nweight_in_water_N_m = -10.2\ntangential_area = 'circumference'\n"
    tow = read(text).tow
    first, second = tow.sections
    assert first == replace(tow.cable, length=75.0)
    assert second == replace(tow.cable, length=20.0, weight_in_water=-10.2, tangential_area="circumference")
    assert tow.cables == (second, first, tow.cable)
    assert tow.length == 1095.0
    assert read(BASE).tow.cables == (read(BASE).tow.cable,)
    with pytest.raises(InvalidInput, match="The model needs one uniform cable, but this one has 2 further sections"):
        tow.single_cable("The model")
    assert read(BASE).tow.single_cable("The model").length == 1000.0


def test_a_section_of_the_same_material_follows_its_diameter() -> None:
    tow = read(BASE + SECTION + "diameter_m = 0.0346\n").tow
    (thick,) = tow.sections
    assert thick.mass == pytest.approx(4.0 * tow.cable.mass)
    assert thick.axial_stiffness == pytest.approx(4.0 * tow.cable.axial_stiffness)
    # Only what is given by length departs from the cable.
    (floated,) = read(BASE + SECTION + "diameter_m = 0.0346\nweight_in_water_N_m = -10.2\n").tow.sections
    assert (floated.mass, floated.weight_in_water) == (tow.cable.mass, -10.2)
    (light,) = read(BASE + SECTION + "density_kg_m3 = 900.0\n").tow.sections
    assert light.axial_stiffness == pytest.approx(tow.cable.axial_stiffness)
    assert light.weight_in_water < 0.0


def test_water_density_reaches_the_cable() -> None:
    fresh = read(changed("= 1025.0", "= 1000.0")).tow
    assert fresh.water_density == 1000.0
    assert fresh.cable.weight_in_water > read(BASE).tow.cable.weight_in_water


def test_models_get_their_full_names() -> None:
    text = BASE + '[identification]\nmodels = ["inertial-linear", "massless-2-quadratic"]\n'
    assert read(text).identification.models == ("inertial-4-linear", "massless-2-quadratic")


def test_unused_settings_are_listed() -> None:
    assert read(BASE).unused == ()
    text = BASE + "[step]\nspeed_m_s = 0.4\n[inputs.step]\nspeed_m_s = 0.4\n"
    assert read(text).unused == ("step.speed_m_s", "inputs.step.speed_m_s")
    assert read(BASE + "[compensator]\nmass_kg = 1.0\n").unused == ("compensator.mass_kg",)
    assert "cable.length_m" in read(text).unused_beside({"step"})
    chain = BASE + '[link-joint]\nlinks = 50\ndrag_law = "incidence"\n[verification]\nlinks = 50\n'
    assert read(chain).unused == ("link-joint.links",)
    delay = BASE + '[identification]\ndelay = "fixed"\nmodels = ["massless-4-linear"]\n'
    assert read(delay).unused == ("identification.delay",)


def test_template_loads_and_names_every_key() -> None:
    read(template())
    named = set(_named(template()))
    for section, keys in SECTIONS.items():
        if section not in ("tail.cable", "section"):  # the keys of [cable], shown there
            assert {(section, key.name) for key in keys} <= named
    assert ("section", "length_m") in named
    for manoeuvre in MANOEUVRES.values():
        for key in keys_of(manoeuvre):
            assert key.name in template()


@pytest.mark.parametrize("section", ["tow", "current", "compensator", *(f"inputs.{kind}" for kind in INPUTS)])
def test_sections_left_out_of_the_template_are_valid(section: str) -> None:
    configuration = read(BASE + _section(section))
    assert any(key.startswith(f"{section}.") for key in configuration.given)


def test_a_section_of_cable_left_out_of_the_template_is_valid() -> None:
    text = "[[section]]\n" + _section("section").partition("\n")[2]
    (floated,) = read(BASE + text).tow.sections
    assert (floated.length, floated.weight_in_water) == (75.0, -10.2)


def test_keys_left_out_of_the_template_are_valid() -> None:
    text = re.sub(r"^#(harmonics|stations|step_s) =", r"\1 =", template(), flags=re.MULTILINE)
    assert read(text).spectral.harmonics == 20
    text = re.sub(r"^(young_modulus_Pa|density_kg_m3 = 4400.*) ?.*\n", "", template(), flags=re.MULTILINE)
    text = re.sub(r"^#(mass_per_length|weight_in_water_N_m|axial)", r"\1", text, count=3, flags=re.MULTILINE)
    assert read(text).tow.cable.mass == 1.034


def test_no_key_is_declared_twice() -> None:
    for section, keys in SECTIONS.items():
        names = [key.name for key in keys]
        assert len(names) == len(set(names)), section


def test_a_built_in_name_wins_over_a_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mangus-740").write_text(BASE)
    assert load("mangus-740").tow.cable.length == 740.0
    assert load("./mangus-740").tow.cable.length == 1000.0


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"autec-1200, .* did you mean autec-1200\?"):
        load("Autec-120")
    with pytest.raises(InvalidInput, match="is a folder"):
        load(str(tmp_path))
    with pytest.raises(InvalidInput, match="cannot be read"):
        load("zero\0byte")
    with pytest.raises(InvalidInput, match="no built-in configuration mangus; did you mean mangus-740"):
        builtin_text("mangus")
    path = tmp_path / "latin.toml"
    path.write_bytes(b"[water]\n# 5 \xb0C\n")
    with pytest.raises(InvalidInput, match="line 2: not UTF-8"):
        load(str(path))


def test_byte_order_mark_and_windows_lines_are_fine(tmp_path: Path) -> None:
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + BASE.replace("\n", "\r\n").encode())
    assert load(str(path)).name == "windows"
    assert find(str(path)).data.startswith(b"\xef\xbb\xbf")


def _commented_out() -> Iterator[str]:
    """The settings that the template leaves out, without their #."""
    for line in template().splitlines():
        if re.match(r"#(\[|\w+ = )", line):
            yield line[1:]


def _section(name: str) -> str:
    """A section that the template leaves out, as text."""
    lines = list(_commented_out())
    start = next(i for i, line in enumerate(lines) if line.lstrip("[").startswith(f"{name}]"))
    end = next((i for i, line in enumerate(lines) if i > start and line.startswith("[")), len(lines))
    keys = {key.name for key in SECTIONS[name]}
    own = [line for line in lines[start + 1 : end] if line.split(" = ")[0] in keys]
    return "\n".join([lines[start], *own]) + "\n"


def _named(text: str) -> Iterator[tuple[str, str]]:
    """Section and key of every setting in the text, left out or not."""
    section = ""
    for line in text.splitlines():
        if header := re.match(r"#?\[{1,2}([\w.-]+)\]", line):
            section = header[1]
        elif key := re.match(r"#?(\w+) = ", line):
            yield section, key[1]
