"""What a scene is made of and leaves out, as the head of every report says it."""

from collections.abc import Callable

import pytest

from ident import scene
from ident.builtin import builtin_text
from ident.configuration import Configuration, builtin_names, load

BASE = """
[cable]
length_m = 800.0
diameter_m = 0.0173
density_kg_m3 = 4400.0
young_modulus_Pa = 6.2e10
added_mass_kg_m = 0.24
normal_drag_coefficient = 1.6
tangential_drag_coefficient = 0.08
"""
POINT = """
[vehicle]
weight_in_water_N = 6000.0
mass_kg = 760.0
added_mass_kg = 545.0
area_m2 = 0.52
drag_coefficient = 1.6
"""
TOWFISH = """
[towfish]
weight_N = 3920.0
buoyancy_N = 780.0
mass_kg = 400.0
added_mass_p_kg = 500.0
added_mass_q_kg = 500.0
inertia_kg_m2 = 280.0
drag_coefficient = 2.0
area_p_m2 = 0.25
area_q_m2 = 1.0
length_m = 2.0
"""


def configuration(text: str) -> Configuration:
    return Configuration.from_text(text, "scene", "scene.toml")


def left_out(text: str) -> set[str]:
    return {term for term, _ in scene.left_out(configuration(text))}


@pytest.mark.parametrize(
    ("effect", "change"),
    [
        ("current", lambda text: text + "[current]\ndepth_m = [0.0]\nspeed_m_s = [0.1]\n"),
        ("steady tow", lambda text: text + "[tow]\nspeed_m_s = 0.5\n"),
        ("pitch of the vehicle", lambda text: text.replace(POINT, TOWFISH)),
        (
            "stretch by water pressure",
            lambda text: text.replace("length_m = 800.0", "length_m = 800.0\npoisson_ratio = 0.3", 1),
        ),
        (
            "internal loss of the cable",
            lambda text: text.replace("length_m = 800.0", "length_m = 800.0\naxial_damping_s = 0.01", 1),
        ),
    ],
)
def test_an_effect_that_is_given_is_not_left_out(effect: str, change: Callable[[str], str]) -> None:
    before, after = left_out(BASE + POINT), left_out(change(BASE + POINT))
    assert before - after == {effect}
    assert after <= before


def test_a_coefficient_of_zero_is_an_effect_left_out() -> None:
    without = BASE.replace("tangential_drag_coefficient = 0.08", "tangential_drag_coefficient = 0.0")
    assert left_out(without + POINT) - left_out(BASE + POINT) == {"tangential drag"}


def test_a_study_with_a_winch_or_a_sea_says_so() -> None:
    own = configuration(BASE + POINT)
    terms = {term for term, _ in scene.left_out(own)}
    assert terms - {term for term, _ in scene.left_out(own, winch=True)} == {"winch"}
    assert terms - {term for term, _ in scene.left_out(own, sea=True)} == {"sea state"}


def test_every_reason_is_a_phrase() -> None:
    for _, why in scene.left_out(configuration(BASE + POINT)):
        assert len(why) > 10
        assert not why.endswith(".")


def test_table_has_the_settings_as_given_and_what_follows_from_them() -> None:
    own = configuration('guesses = ["cable.added_mass_kg_m", "vehicle.drag_coefficient"]\n' + BASE + POINT)
    table = scene.configuration_table(own)
    assert list(table.columns) == ["part", "setting", "value", "unit", "guess", "note"]
    rows = {(row["part"], row["setting"]): row for row in table.to_dict("records")}
    assert rows["cable", "length"]["value"] == 800.0
    assert rows["cable", "length"]["unit"] == "m"
    assert rows["cable", "added mass"]["unit"] == "kg/m"
    assert rows["vehicle", "drag coefficient"]["unit"] == ""
    assert {key for key, row in rows.items() if row["guess"]} == {
        ("cable", "added mass"),
        ("vehicle", "drag coefficient"),
    }
    assert rows["cable", "mass"]["value"] == pytest.approx(own.tow.cable.mass)
    assert rows["cable", "axial stiffness"]["unit"] == "N"
    assert "density" in rows["cable", "weight in water"]["note"]


def test_what_is_given_itself_does_not_follow_from_the_material() -> None:
    by_length = BASE.replace(
        "density_kg_m3 = 4400.0\nyoung_modulus_Pa = 6.2e10",
        "mass_per_length_kg_m = 1.03\nweight_in_water_N_m = 7.8\naxial_stiffness_N = 1.4e7",
    )
    table = scene.configuration_table(configuration(by_length + POINT))
    assert (table["note"] == "").all()
    assert not table.duplicated(["part", "setting"]).any()


def test_lists_and_texts_are_shown() -> None:
    text = BASE + POINT + "[current]\ndepth_m = [0.0, 100.0]\nspeed_m_s = [0.2, 0.1]\n"
    table = scene.configuration_table(
        configuration(text.replace("length_m", 'tangential_area = "diameter"\nlength_m', 1))
    )
    values = {row["setting"]: row["value"] for row in table.to_dict("records")}
    assert values["tangential area"] == "diameter"
    assert values["depth"] == "[0.0, 100.0]"


@pytest.mark.parametrize("name", builtin_names())
def test_every_guess_is_marked(name: str) -> None:
    own = load(name)
    table = scene.configuration_table(own)
    assert int(table["guess"].sum()) == len(own.guesses)
    assert ("guesses" in builtin_text(name)) == bool(own.guesses)


def test_parts_behind_the_vehicle_are_listed_and_said_to_be_left_out() -> None:
    own = load("multipart-2200-strumming")
    rows = {(row["part"], row["setting"]): row for row in scene.configuration_table(own).to_dict("records")}
    assert rows["tail.2", "name"]["value"] == "towed-body"
    assert rows["tail.1.cable", "length"]["value"] == 200.0
    assert rows["tail.1.body", "added mass heave"]["guess"]
    missing = dict(scene.left_out(own))
    assert "damping-unit, towed-body" in missing["parts behind the vehicle"]
    assert "link-joint" in missing["strumming"]
    beside = dict(scene.left_out(own, chain=True))
    assert beside["parts behind the vehicle"].startswith("the models are identified without damping-unit, towed-body")
    assert beside["strumming"] == "only the verification truth has it"
    fish = configuration(BASE + TOWFISH)
    assert "pitch of the vehicle in the verification truth" in dict(scene.left_out(fish, chain=True))
    assert "pitch of the vehicle in the verification truth" not in dict(scene.left_out(fish))
    assert "parts behind the vehicle" not in dict(scene.left_out(load("mangus-740")))


def test_sections_thrust_and_compensator_are_in_the_table() -> None:
    text = BASE + "[[section]]\nlength_m = 75.0\nweight_in_water_N_m = -10.2\n"
    text += "[[section]]\nlength_m = 5.0\ndiameter_m = 0.03\n[[section]]\nlength_m = 6.0\n"
    own = configuration(
        'guesses = ["section.1.length_m", "vehicle.thrust_N"]\n'
        + text
        + POINT
        + "thrust_N = 70.0\n[compensator]\nmass_kg = 530.0\n"
    )
    table = scene.configuration_table(own)
    assert list(dict.fromkeys(table["part"])) == [
        "cable",
        "section.1",
        "section.2",
        "section.3",
        "vehicle",
        "compensator",
    ]
    rows = {(row["part"], row["setting"]): row for row in table.to_dict("records")}
    assert rows["section.1", "length"]["guess"]
    assert rows["section.1", "weight in water"]["value"] == -10.2
    assert (rows["vehicle", "thrust"]["value"], rows["vehicle", "thrust"]["unit"]) == (70.0, "N")
    assert rows["vehicle", "thrust"]["guess"]
    assert (rows["compensator", "mass"]["value"], rows["compensator", "mass"]["unit"]) == (530.0, "kg")
    # What follows from the material is told where it is not the cable's.
    assert rows["section.2", "mass"]["value"] == pytest.approx(own.tow.sections[1].mass)
    assert "density" in rows["section.2", "weight in water"]["note"]
    assert ("section.1", "mass") not in rows
    assert ("section.3", "mass") not in rows


def test_an_effect_of_any_section_is_not_left_out() -> None:
    without = BASE.replace("tangential_drag_coefficient = 0.08", "tangential_drag_coefficient = 0.0") + POINT
    section = "[[section]]\nlength_m = 75.0\ntangential_drag_coefficient = 0.1\npoisson_ratio = 0.3\n"
    assert left_out(without) - left_out(without + section) == {"tangential drag", "stretch by water pressure"}


def test_a_table_with_inputs_is_made() -> None:
    text = 'guesses = ["inputs.step.speed_m_s"]\n' + BASE + POINT + "[inputs.step]\nspeed_m_s = 0.3\n"
    table = scene.configuration_table(configuration(text))
    assert list(table.loc[table["guess"], "part"]) == ["inputs.step"]


def test_settings_that_no_study_reads_are_listed_with_the_reason() -> None:
    own = configuration(
        BASE + POINT + "[inputs.step]\nspeed_m_s = 0.4\n[step]\nspeed_m_s = 0.3\n[bode]\namplitudes_m = [9.0]\n"
    )
    listed = dict(scene.unused(own, own.unused))
    assert set(listed) == {"inputs.step.speed_m_s", "step.speed_m_s"}
    assert all("reads it" in why for why in listed.values())
    assert scene.unused(own, ()) == []
