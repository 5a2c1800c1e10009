"""The other commands end to end through the command line, on short records."""

import json
import math
import os
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from data_synth.records import read_record
from ident import thesis
from ident.cli import main
from ident.configuration import Configuration, load
from ident.studies import gallery
from models import link_joint, reduced
from models.statics import midpoint_travel_time, static_shape, travel_time

TOW_FILES = Path(__file__).resolve().parents[2].parent / "shared" / "records" / "deep-tow-camera"
CABLE = """
description = "a sled on 740 m of cable"

[cable]
length_m = 740.0
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

[spectral]
tolerance_m_s = 1e-3

[input]
duration_s = 900.0
segment_s = 200.0
settle_s = 100.0

[verification]
kind = "starts-and-stops"
duration_s = 900.0
runs_s = [130.0, 180.0]
pauses_s = [100.0]

[identification]
models = ["massless-2-quadratic", "first-order-linear"]

[step]
lengths_m = [400.0, 800.0]
weights_N = [9000.0]
"""
MODEL = "massless-2-quadratic"
Capture = pytest.CaptureFixture[str]


@pytest.fixture
def cable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of a configuration file in the current folder, which is empty beside it."""
    monkeypatch.chdir(tmp_path)
    Path("cable.toml").write_text(CABLE)
    return "./cable.toml"


def own() -> Configuration:
    return Configuration.from_text(CABLE, "cable", "cable.toml")


def ok(*line: str) -> None:
    assert main(list(line)) == 0


def refused(capsys: Capture, *line: str) -> str:
    """The one error line, after any progress, of a command that ends with 2 and leaves the folder as it was."""
    before = sorted(os.listdir())
    capsys.readouterr()
    assert main(list(line)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    *progress, error = captured.err.splitlines()
    assert error.startswith("error: ")
    assert all(" % " in each for each in progress)
    assert sorted(os.listdir()) == before
    return error


def write_ship(
    path: str, t: np.ndarray, x: np.ndarray, y: np.ndarray | float = 0.0, z: np.ndarray | float = 0.0
) -> None:
    frame = pd.DataFrame({"time_s": t, "ship_x_m": x})
    frame["ship_y_m"], frame["ship_z_m"] = y, z
    frame.to_csv(path, index=False)


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.asarray(values) ** 2)))


# record


@pytest.mark.parametrize(
    "kind",
    [
        "standard",
        "recorded-style",
        "sinusoids",
        "ramps",
        "first-order",
        "step",
        "winch",
        "winch-depth",
        "standard+sinusoids",
        "sinusoids+winch",
        "recorded-style+winch-depth",
        pytest.param("sea", marks=pytest.mark.slow),
        pytest.param("standard+sea", marks=pytest.mark.slow),
    ],
)
def test_record_of_every_kind(kind: str, cable: str, capsys: Capture) -> None:
    ok("record", cable, "--input", kind, "--duration", "60", "--out", "r.csv")
    said = capsys.readouterr().out
    assert "r.csv written (seed 0)" in said
    record = read_record("r.csv")
    assert record.t[[0, -1]].tolist() == [0.0, 60.0]
    assert record.vehicle is not None
    assert record.vehicle.valid.all()
    assert record.depth is not None
    np.testing.assert_allclose(record.depth, -record.vehicle.position[:, 2])
    assert record.depth == pytest.approx(740.0, abs=3.0)
    assert record.tension is not None
    assert ("link-joint" in said) == (kind == "recorded-style")
    ship = record.ship.position
    assert bool(ship[:, 0].any()) == (kind not in ("winch", "winch-depth"))
    assert bool(ship[:, 2].any()) == ("sea" in kind)


MANOEUVRES = """
[inputs.straight]
duration_s = 60.0
[inputs.full-turn]
speed_m_s = 1.0
radius_m = 60.0
turns = 0.2
approach_s = 30.0
exit_s = 30.0
[inputs.u-turn]
speed_m_s = 1.0
radius_m = 40.0
approach_s = 10.0
exit_s = 10.0
[inputs.speed-changes]
duration_s = 60.0
times_s = [20.0]
speeds_m_s = [1.0, 0.5]
rise_s = 20.0
[inputs.zig-zag]
speed_m_s = 1.0
radius_m = 40.0
leg_s = 30.0
legs = 2
[inputs.waypoints]
speed_m_s = 1.0
points_x_m = [0.0, 100.0, 100.0]
points_y_m = [0.0, 0.0, 100.0]
radius_m = 40.0

[tow]
speed_m_s = 0.3
"""


@pytest.mark.parametrize("kind", ["straight", "full-turn", "u-turn", "speed-changes", "zig-zag", "waypoints"])
def test_record_of_a_manoeuvre_is_the_chains_from_the_ships_own_speed(kind: str, cable: str, capsys: Capture) -> None:
    """The tow's own way is not added: the ship is under way already."""
    Path("turns.toml").write_text(CABLE + MANOEUVRES)
    ok("record", "./turns.toml", "--input", kind, "--out", "r.csv")
    assert "the link-joint simulator with" in capsys.readouterr().out
    record = read_record("r.csv")
    assert record.vehicle is not None
    speed = 3.0867 if kind == "straight" else 1.0
    for trace in (record.ship, record.vehicle):
        assert trace.spline(0.0, 1)[:2] == pytest.approx([speed, 0.0], abs=0.01)
    assert bool(np.ptp(record.ship.position[:, 1]) > 1.0) == (kind not in ("straight", "speed-changes"))
    if kind in ("full-turn", "u-turn", "zig-zag", "waypoints"):
        assert "has no duration" in refused(
            capsys, "record", "./turns.toml", "--input", kind, "--duration", "60", "--out", "x.csv"
        )


def test_record_takes_the_simulator_that_the_input_needs_or_the_one_asked_for(cable: str, capsys: Capture) -> None:
    t = np.arange(0.0, 121.0)
    write_ship("bent.csv", t, 0.3 * t, 0.02 * np.maximum(t - 30.0, 0.0) ** 1.5)
    write_ship("flat.csv", t, 0.3 * t, 0.4 * t)
    for kind, name in (("bent.csv", "link-joint"), ("flat.csv", "spectral"), ("step", "spectral")):
        ok("record", cable, "--input", kind, "--out", "r.csv")
        assert f"the {name} simulator with" in capsys.readouterr().out
    both = {}
    for name in ("link-joint", "spectral"):
        line = ("record", cable, "--input", "sinusoids", "--duration", "120", "--reference", name)
        ok(*line, "--out", f"{name}.csv")
        vehicle = read_record(f"{name}.csv").vehicle
        assert vehicle is not None
        both[name] = vehicle.position[:, 0]
    assert np.ptp(both["spectral"]) > 1.0
    # Each estimates its error at 2e-4 m/s, for two minutes.
    np.testing.assert_allclose(both["link-joint"], both["spectral"], atol=0.03)
    no = ("record", cable, "--input", "recorded-style", "--reference", "spectral", "--out", "x.csv")
    assert "leave out --reference" in refused(capsys, *no)
    no = ("record", cable, "--input", "winch-depth", "--reference", "link-joint", "--out", "x.csv")
    assert "holds a depth" in refused(capsys, *no)


def test_the_winch_pays_out_on_the_chain_too(cable: str) -> None:
    Path("winch.toml").write_text(
        CABLE + "\n[inputs.winch]\nduration_s = 200.0\ntimes_s = [20.0, 60.0]\nrates_m_s = [0.2, 0.0]\n"
    )
    depths = {}
    for name in ("spectral", "link-joint"):
        ok("record", "./winch.toml", "--input", "winch", "--reference", name, "--out", "r.csv")
        depths[name] = read_record("r.csv").depth
    np.testing.assert_allclose(depths["link-joint"], depths["spectral"], atol=0.05)


def test_record_sums_its_inputs_and_takes_a_file(cable: str) -> None:
    for kind in ("ramps", "sinusoids", "ramps+sinusoids", "one.csv+sinusoids"):
        ok("record", cable, "--input", kind, "--duration", "60", "--out", "sum.csv")
        if kind == "ramps":
            os.rename("sum.csv", "one.csv")
        elif kind == "sinusoids":
            os.rename("sum.csv", "two.csv")
        else:
            parts = read_record("one.csv").ship.position + read_record("two.csv").ship.position
            np.testing.assert_allclose(read_record("sum.csv").ship.position, parts, atol=1e-12)


def test_record_takes_as_much_of_a_file_as_asked(cable: str) -> None:
    write_ship("ship.csv", np.arange(100.0, 301.0), 0.1 * np.arange(201.0))
    ok("record", cable, "--input", "ship.csv", "--duration", "40", "--out", "r.csv")
    assert read_record("r.csv").t[[0, -1]].tolist() == [100.0, 140.0]


def test_record_pays_out_as_the_winch_says(cable: str) -> None:
    Path("winch.toml").write_text(
        CABLE + "\n[inputs.winch]\nduration_s = 200.0\ntimes_s = [20.0, 60.0]\nrates_m_s = [0.2, 0.0]\n"
    )
    ok("record", "./winch.toml", "--input", "winch", "--out", "r.csv")
    depth = read_record("r.csv").depth
    assert depth is not None
    assert depth[200] - depth[0] == pytest.approx(8.0, rel=0.01)
    assert depth[19] == pytest.approx(depth[0], abs=1e-9)


def test_record_shows_what_the_sensor_sees(cable: str) -> None:
    kind = ("--input", "recorded-style", "--duration", "300", "--seed", "2")
    ok("record", cable, *kind, "--out", "truth.csv")
    ok("record", cable, *kind, "--sensor", "--out", "fixes.csv")
    truth, fixes = read_record("truth.csv").vehicle, read_record("fixes.csv").vehicle
    assert truth is not None
    assert fixes is not None
    seen = fixes.valid
    assert (fixes.t[seen] % 10.0 == 0.0).all()
    assert 20 <= seen.sum() <= 31
    error = (fixes.position - truth.position)[seen, 0] - 40.0
    assert 0.5 < rms(error) < 3.0


def test_record_draws_by_its_seed(cable: str) -> None:
    for seed, name in (("0", "a"), ("0", "b"), ("1", "c")):
        ok("record", cable, "--input", "standard", "--duration", "60", "--seed", seed, "--out", name)
    assert Path("a").read_bytes() == Path("b").read_bytes()
    assert Path("a").read_bytes() != Path("c").read_bytes()


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("squares", "neither a file nor one of standard, recorded-style"),
        ("standard+squares", "'squares'"),
        ("winch+winch-depth", "one winch"),
        ("standard+", "error: "),
    ],
)
def test_record_refuses_an_unknown_input(kind: str, words: str, cable: str, capsys: Capture) -> None:
    assert words in refused(capsys, "record", cable, "--input", kind, "--duration", "60", "--out", "r.csv")


# simulate


def manoeuvre(t: np.ndarray) -> np.ndarray:
    return 20.0 * (1.0 - np.exp(-((t / 40.0) ** 3))) * np.sin(0.03 * t)


def test_simulate_on_a_turned_track_comes_back_on_its_own_line(cable: str, capsys: Capture) -> None:
    t = np.arange(0.0, 301.0)
    along, angle = manoeuvre(t), 2.2
    write_ship("straight.csv", t, along)
    write_ship("turned.csv", t, 5e5 + along * math.cos(angle), 6e6 + along * math.sin(angle), np.full(t.size, -4.0))
    for name in ("straight", "turned"):
        ok("simulate", cable, "--ship", f"{name}.csv", "--out", f"{name}-out.csv", "--tolerance", "1e-4")
    assert "harmonics" in capsys.readouterr().out
    straight, turned = read_record("straight-out.csv"), read_record("turned-out.csv")
    assert straight.vehicle is not None
    assert turned.vehicle is not None
    x, y, z = turned.vehicle.position.T
    np.testing.assert_allclose((y - 6e6) * math.cos(angle) - (x - 5e5) * math.sin(angle), 0.0, atol=1e-6)
    back = (x - 5e5) * math.cos(angle) + (y - 6e6) * math.sin(angle)
    np.testing.assert_allclose(back, straight.vehicle.position[:, 0], atol=1e-3)
    np.testing.assert_allclose(z, straight.vehicle.position[:, 2] - 4.0, atol=1e-3)
    np.testing.assert_allclose(turned.depth, -z)
    np.testing.assert_array_equal(turned.ship.position[:, 0], read_record("turned.csv").ship.position[:, 0])
    assert turned.tension is not None
    assert turned.tension[0] == pytest.approx([6000.0 + 7.78 * 740.0, 6000.0], rel=1e-3)


def test_simulate_refuses_a_track_that_turns_and_says_by_how_much(cable: str, capsys: Capture) -> None:
    t = np.arange(0.0, 301.0)
    write_ship("bent.csv", t, 0.3 * t, np.where(t > 150.0, 0.3 * (t - 150.0), 0.0))
    message = refused(capsys, "simulate", cable, "--ship", "bent.csv", "--out", "out.csv")
    amount = float(message.split("of its track by ")[1].split(" m")[0])
    assert 5.0 < amount < 30.0
    write_ship("jump.csv", t, np.where(t > 150.0, 100.0, 0.0))
    assert "jumps" in refused(capsys, "simulate", cable, "--ship", "jump.csv", "--out", "out.csv")


def test_the_chain_follows_a_track_that_turns_and_writes_every_body(cable: str, capsys: Capture) -> None:
    text = Path(cable).read_text()
    tail = "[[tail]]\nname = 'fish'\n[tail.cable]\n" + text[text.index("[cable]") + 8 : text.index("[vehicle]")]
    body = (
        "[tail.body]\nweight_N = 500.0\nbuoyancy_N = 100.0\nmass_kg = 50.0\nadded_mass_surge_kg = 20.0\n"
        "added_mass_sway_kg = 20.0\nadded_mass_heave_kg = 20.0\narea_surge_m2 = 0.1\narea_sway_m2 = 0.1\n"
        "area_heave_m2 = 0.1\ndrag_coefficient = 1.2\n"
    )
    Path("two.toml").write_text(text + tail.replace("740.0", "100.0") + body)
    t = np.arange(0.0, 201.0)
    x, y = 5e5 + 80.0 * np.sin(t / 80.0), 6e6 + 80.0 * (1.0 - np.cos(t / 80.0))
    write_ship("turn.csv", t, x, y, 0.2 * np.sin(0.6 * t))
    line = ("--ship", "turn.csv", "--reference", "link-joint", "--start", "steady", "--links", "24")
    ok("simulate", "./two.toml", *line, "--tolerance", "1e-3", "--out", "out.csv")
    said = capsys.readouterr().out
    told = r"the link-joint simulator with 24 \+ 4 links, \d+ steps; estimated error \S+ m/s RMS, energy balanced"
    assert re.search(told, said)
    record = read_record("out.csv")
    assert record.vehicle is not None
    assert record.tension is not None
    assert record.tension.shape == (201, 2)
    np.testing.assert_allclose(record.depth, -record.vehicle.position[:, 2])
    (fish,) = record.bodies
    assert np.linalg.norm(fish.position - record.vehicle.position, axis=1).max() < 101.0
    assert (fish.position[:, 2] < record.vehicle.position[:, 2] - 50.0).all()
    expected = link_joint.simulate(load("./two.toml").system, read_record("turn.csv").ship, links=24, tolerance=1e-3)
    np.testing.assert_allclose(record.vehicle.position, expected.vehicle.position, atol=1e-5)
    write_ship("straight.csv", t, 0.01 * t)
    ok("simulate", "./two.toml", "--ship", "straight.csv", "--out", "one.csv")
    assert "It tows the first part alone, without fish." in capsys.readouterr().out
    assert read_record("one.csv").bodies == ()


def test_a_slack_cable_is_told(cable: str, capsys: Capture) -> None:
    t = np.arange(0.0, 61.0, 0.25)
    write_ship("heave.csv", t, 0.0 * t, 0.0, 6.0 * (1.0 - np.exp(-((t / 10.0) ** 3))) * np.sin(1.2 * t))
    line = ("--ship", "heave.csv", "--reference", "link-joint", "--links", "20", "--tolerance", "1e-2")
    ok("simulate", cable, *line, "--out", "out.csv")
    told = r"\d+ slack events?: vehicle at \d+\.\d s, \d+ m below its upper end, taut at \S+ s with \d+ N"
    assert re.search(told, capsys.readouterr().out)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--reference", "link-joint", "--stepper", "implicit"), "leave out --stepper"),
        (("--links", "20"), "leave out --links"),
        (("--reference", "link-joint", "--links", "3"), "--links"),
        (("--reference", "dense"), "--reference"),
    ],
)
def test_options_of_the_other_simulator_are_refused(
    options: tuple[str, ...], words: str, cable: str, capsys: Capture
) -> None:
    write_ship("ship.csv", np.arange(60.0), 0.1 * np.arange(60.0))
    assert words in refused(capsys, "simulate", cable, "--ship", "ship.csv", "--out", "x.csv", *options)


def test_steppers_agree(cable: str) -> None:
    t = np.arange(0.0, 201.0)
    write_ship("ship.csv", t, manoeuvre(t))
    tracks = {}
    for stepper in ("implicit", "newmark", "runge-kutta"):
        ok("simulate", cable, "--ship", "ship.csv", "--stepper", stepper, "--out", "out.csv")
        vehicle = read_record("out.csv").vehicle
        assert vehicle is not None
        tracks[stepper] = vehicle.position
        assert np.ptp(vehicle.position[:, 0]) > 5.0
    for stepper in ("newmark", "runge-kutta"):
        np.testing.assert_allclose(tracks[stepper], tracks["implicit"], atol=0.1)
        assert (tracks[stepper] != tracks["implicit"]).any()


def test_simulate_can_start_steady(cable: str) -> None:
    t = np.arange(0.0, 121.0)
    write_ship("ship.csv", t, 0.3 * t)
    for start in ("rest", "steady"):
        ok("simulate", cable, "--ship", "ship.csv", "--start", start, "--out", f"{start}.csv")
    rest, steady = (read_record(f"{start}.csv").vehicle for start in ("rest", "steady"))
    assert rest is not None
    assert steady is not None
    assert rest.position[0, 0] == pytest.approx(0.0, abs=1e-9)
    assert steady.position[0, 0] < -20.0
    np.testing.assert_allclose(steady.position[:, 0] - 0.3 * t, steady.position[0, 0], atol=1e-6)


# fit and verify


def test_fit_on_one_record_and_verify_on_another(cable: str, capsys: Capture) -> None:
    for seed, name in (("0", "a.csv"), ("1", "b.csv")):
        ok("record", cable, "--input", "standard", "--seed", seed, "--out", name)
    names = f"{MODEL},second-order-quadratic"
    known = ("--differentiator", "0")
    ok("fit", cable, "--record", "a.csv", "--model", names, "--out", "fit.json", *known, "--quiet")
    table = capsys.readouterr().out
    assert "cable_drag" in table
    content = json.loads(Path("fit.json").read_text())
    assert content["configuration"] == CABLE
    assert (content["start"], content["differentiator_s"]) == ("rest", 0.0)
    fit = next(each for each in content["fits"] if each["model"] == MODEL)
    total = fit["values"]["vehicle_drag"] + 370.0 * fit["values"]["cable_drag"]
    tow = own().tow
    expected = tow.vehicle.drag(1025.0) + 740.0 * tow.cable.normal_drag(1025.0)
    assert total == pytest.approx(expected, rel=0.35)
    ok("verify", "fit.json", "--record", "a.csv", "--record", "b.csv", "--out", "scores.csv")
    scores = pd.read_csv("scores.csv").set_index(["model", "record"])
    assert scores.index.get_level_values(0).unique().tolist() == ["baseline-rigid", MODEL, "second-order-quadratic"]
    errors = scores["rms_velocity_m_s"]
    assert errors[MODEL, "a.csv"] == pytest.approx(fit["rms_velocity_m_s"], rel=1e-4)
    assert errors[MODEL, "b.csv"] < 2.0 * errors[MODEL, "a.csv"]
    assert errors[MODEL, "b.csv"] < 0.3 * errors["baseline-rigid", "b.csv"]


def test_fit_through_the_sensor_and_a_held_delay(cable: str) -> None:
    ok("record", cable, "--input", "standard", "--sensor", "--out", "a.csv")
    line = ("fit", cable, "--record", "a.csv", "--model", f"{MODEL},first-order-quadratic", "--out", "fit.json")
    ok(*line, "--fixed-delay", "--quiet")
    content = json.loads(Path("fit.json").read_text())
    delayed = content["fits"][1]
    tow = own().tow
    delay = travel_time(tow, static_shape(tow))
    assert delayed["fixed"] == ["delay"]
    assert delayed["values"]["delay"] == pytest.approx(delay)
    assert content["differentiator_s"] == 90.0
    ok("verify", "fit.json", "--record", "a.csv", "--out", "scores.csv")
    scores = pd.read_csv("scores.csv").set_index("model")
    assert scores.loc["first-order-quadratic", "parameters"] == 1
    for fit in content["fits"]:
        found = scores.loc[fit["model"], "rms_velocity_m_s"]
        assert found == pytest.approx(fit["rms_velocity_m_s"], rel=1e-4)


def test_verify_reads_records_as_the_fit_did_unless_told_otherwise(cable: str) -> None:
    t = np.arange(0.0, 901.0)
    write_ship("ship.csv", t, 0.25 * t + manoeuvre(t))
    ok("simulate", cable, "--ship", "ship.csv", "--start", "steady", "--out", "a.csv")
    line = ("fit", cable, "--record", "a.csv", "--model", MODEL, "--out", "fit.json", "--start", "steady", "--quiet")
    ok(*line, "--differentiator", "40")
    content = json.loads(Path("fit.json").read_text())
    assert (content["start"], content["differentiator_s"]) == ("steady", 40.0)
    fitted = content["fits"][0]["rms_velocity_m_s"]

    def verified(*options: str) -> float:
        ok("verify", "fit.json", "--record", "a.csv", "--out", "scores.csv", *options)
        return float(pd.read_csv("scores.csv").set_index("model").loc[MODEL, "rms_velocity_m_s"])

    assert verified() == pytest.approx(fitted, rel=1e-4)
    assert verified("--start", "steady", "--differentiator", "40") == pytest.approx(fitted, rel=1e-4)
    assert abs(verified("--start", "rest") / fitted - 1.0) > 1e-3
    assert abs(verified("--differentiator", "0") / fitted - 1.0) > 1e-3


def test_a_small_budget_is_a_result_that_says_so(cable: str) -> None:
    ok("record", cable, "--input", "standard", "--out", "a.csv")
    ok("fit", cable, "--record", "a.csv", "--model", MODEL, "--out", "fit.json", "--budget", "5", "--quiet")
    fit = json.loads(Path("fit.json").read_text())["fits"][0]
    assert fit["outcome"] == "budget"
    assert fit["simulations"] == 5


# crossval


def test_crossval_lists_every_model_and_the_baselines_first(cable: str) -> None:
    for seed, name in (("0", "a.csv"), ("1", "b.csv")):
        ok("record", cable, "--input", "standard", "--seed", seed, "--sensor", "--out", name)
    ok("crossval", cable, "--record", "a.csv", "--record", "b.csv", "--start", "rest", "--out", "out", "--quiet")
    scores = pd.read_csv("out/scores.csv")
    order = [
        "baseline-constant-velocity",
        "baseline-rigid-offset",
        f"baseline-unfitted-{MODEL}",
        MODEL,
        "first-order-linear",
    ]
    assert scores["model"].tolist() == 2 * order
    assert scores["record"].tolist() == 5 * ["a.csv"] + 5 * ["b.csv"]
    errors = scores.pivot(index="model", columns="record", values="rms_velocity_m_s")
    assert (errors.loc[MODEL] < errors.loc["baseline-rigid-offset"]).all()
    assert {path.name for path in Path("out").iterdir()} == {
        "report.md",
        "figures",
        "scores.csv",
        "parameters-a.csv",
        "parameters-b.csv",
        "manifest.json",
    }
    manifest = json.loads(Path("out/manifest.json").read_text())
    assert (manifest["records"], manifest["fraction"], manifest["start"]) == (["a.csv", "b.csv"], 0.6, "rest")
    page = Path("out/report.md").read_text()
    for name in ("a.csv", "b.csv", *order):
        assert name in page


def test_crossval_refuses_records_of_one_name(cable: str, capsys: Capture) -> None:
    ok("record", cable, "--input", "standard", "--sensor", "--out", "a.csv")
    line = ("crossval", cable, "--record", "a.csv", "--record", "a.csv", "--out", "out", "--quiet")
    assert "a.csv" in refused(capsys, *line)


@pytest.mark.slow
def test_crossval_of_the_recorded_tows(tmp_path: Path) -> None:
    paths = [TOW_FILES / f"{name}.CSV" for name in ("045", "060", "168")]
    if not all(path.exists() for path in paths):
        pytest.skip(f"the recorded tows are not at hand ({os.path.relpath(TOW_FILES)})")
    out = tmp_path / "out"
    records = [part for path in paths for part in ("--record", str(path))]
    ok("crossval", "deep-tow-camera", *records, "--out", str(out), "--quiet")
    scores = pd.read_csv(out / "scores.csv")
    models = list(load("deep-tow-camera").identification.models)
    assert sorted(models) == sorted(reduced.MODEL_NAMES)
    for _, part in scores.groupby("record"):
        names = part["model"].tolist()
        assert names[:2] == ["baseline-constant-velocity", "baseline-rigid-offset"]
        assert names[2].startswith("baseline-unfitted-")
        assert names[3:] == models
    assert scores["record"].unique().tolist() == ["045.CSV", "060.CSV", "168.CSV"]
    page = (out / "report.md").read_text()
    assert "winch" in page
    assert "guess" in page
    assert not list(out.rglob("*.CSV"))
    assert (out / "report.md").stat().st_size < 100_000


# step


def test_step_study_sets_measured_delays_beside_both_formulas(cable: str) -> None:
    ok("step", cable, "--out", "out", "--quiet")
    table = pd.read_csv("out/step.csv").set_index("response")
    assert table.index.tolist() == ["400 m", "800 m", "9000 N"]
    cable_, W = own().tow.cable, 6000.0
    w, m, m_a = cable_.weight_in_water, cable_.mass, cable_.added_mass
    for name, L, weight in (("400 m", 400.0, W), ("800 m", 800.0, W), ("9000 N", 740.0, 9000.0)):
        row = table.loc[name]
        assert (row["length_m"], row["weight_N"]) == (L, weight)
        assert row["midpoint_s"] == pytest.approx(L / math.sqrt((weight + 0.5 * w * L) / m), rel=1e-6)
        closed = 2.0 * math.sqrt(m + m_a) / w * (math.sqrt(weight + w * L) - math.sqrt(weight))
        assert row["front_s"] == pytest.approx(closed, rel=1e-5)
        assert row["measured_s"] > row["front_s"]
        assert math.isnan(row["thesis_s"])
    responses = pd.read_csv("out/responses.csv")
    assert responses.columns.tolist() == ["time_s", "400 m_m_s", "800 m_m_s", "9000 N_m_s"]
    for name in table.index:
        share = responses[f"{name}_m_s"] / 0.5
        first = int(np.argmax(share >= 0.02))
        assert responses["time_s"][first - 1] <= table.loc[name, "measured_s"] <= responses["time_s"][first]
    assert "8.1" not in table.columns
    page = Path("out/report.md").read_text()
    assert f"{table.loc['800 m', 'measured_s']:.1f}" in page
    assert json.loads(Path("out/manifest.json").read_text())["command"] == "step"


def test_formulas_of_the_delay_are_those_printed() -> None:
    tow = load(gallery.STEP_NAME).tow
    shape = static_shape(tow)
    assert midpoint_travel_time(tow, shape) == pytest.approx(thesis.DELAYS[2500.0, 6000.0], abs=0.1)
    assert travel_time(tow, shape) == pytest.approx(23.8, abs=0.05)


@pytest.mark.slow
def test_step_study_of_the_thesis(tmp_path: Path) -> None:
    """Delays near those of many sines, 30.36 s at 2500 m with 160; midpoint formula as the thesis prints it (T 4.1)."""
    ok("step", gallery.STEP_NAME, "--out", str(tmp_path / "out"), "--quiet")
    table = pd.read_csv(tmp_path / "out" / "step.csv").set_index("response")
    assert table.loc[["500 m", "1000 m", "2500 m"], "measured_s"].tolist() == pytest.approx(
        [8.15, 14.7, 30.36], abs=0.2
    )
    printed = table["thesis_s"].dropna()
    assert printed.tolist() == [5.7, 10.2, 20.2, 20.2, 17.7, 15.8]
    assert table.loc[printed.index, "midpoint_s"].tolist() == pytest.approx(printed.tolist(), abs=0.15)


def test_step_study_needs_a_point_vehicle(cable: str, capsys: Capture) -> None:
    text = Path(cable).read_text()
    body = "[towfish]\nweight_N = 3920.0\nbuoyancy_N = 780.0\nmass_kg = 400.0\nadded_mass_p_kg = 500.0\n"
    body += "added_mass_q_kg = 500.0\ninertia_kg_m2 = 280.0\ndrag_coefficient = 2.0\narea_p_m2 = 0.25\n"
    body += "area_q_m2 = 1.0\nlength_m = 2.0\ntow_point_q_m = 0.8\n\n"
    start, end = text.index("[vehicle]"), text.index("[spectral]")
    Path("fish.toml").write_text(text[:start] + body + text[end:])
    assert "give a [vehicle] instead" in refused(capsys, "step", "./fish.toml", "--out", "out", "--quiet")


# gallery


def test_errors_over_seeds_and_their_summary() -> None:
    table = gallery.errors_over_seeds(own(), (0, 1), lambda stage, share: None)
    models = ["massless-2-quadratic", "first-order-linear"]
    assert list(table.columns) == [
        "seed",
        "model",
        "record",
        "rms_velocity_m_s",
        "rms_position_m",
        "fit_percent",
        "outcome",
    ]
    assert len(table) == 2 * 2 * 4
    found = gallery.summary(table.assign(configuration="autec-1200"))
    assert set(found["model"]) == set(models)
    for row in found.to_dict("records"):
        part = table[(table["model"] == row["model"]) & (table["record"] == row["record"])]["rms_velocity_m_s"]
        assert row["median"] == pytest.approx(part.median())
        assert row["worst"] == part.max()
        assert row["worst"] > row["median"]
    assert (found["met"] == "").all()


def test_summary_holds_the_median_against_the_thesis() -> None:
    rows = [
        ("autec-1200", "inertial-4-quadratic", "identification", seed, error)
        for seed, error in enumerate([0.010, 0.0105, 0.5])
    ] + [("autec-1200", "second-order-quadratic", "verification-truth", 0, 0.065)]
    rows += [("cable", "inertial-4-quadratic", "identification", 0, 0.001)]
    errors = pd.DataFrame(rows, columns=["configuration", "model", "record", "seed", "rms_velocity_m_s"])
    found = gallery.summary(errors).set_index(["configuration", "model"])
    assert found.loc[("autec-1200", "inertial-4-quadratic"), ["median", "worst", "thesis", "met"]].tolist() == [
        0.0105,
        0.5,
        0.011,
        "yes",
    ]
    assert found.loc[("autec-1200", "second-order-quadratic"), "met"] == "no"
    assert found.loc[("cable", "inertial-4-quadratic"), "met"] == ""


# wrong input


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("simulate {cable} --ship none.csv --out x.csv", "none.csv"),
        ("simulate {cable} --ship . --out x.csv", "folder"),
        ("simulate {cable} --ship bad.csv --out x.csv", "bad.csv"),
        ("simulate {cable} --ship ship.csv --out x.csv --tolerance nan", "--tolerance"),
        ("simulate {cable} --ship ship.csv --out none/x.csv", "make it first"),
        ("simulate {cable} --ship ship.csv --out .", "is a folder"),
        ("simulate broken.toml --ship ship.csv --out x.csv", "broken.toml"),
        ("run broken.toml --out out", "broken.toml"),
        ("run {cable} --out none/out", "make it first"),
        ("run {cable} --out ship.csv", "is a file"),
        ("run {cable} --out out --models massless-0-linear", "massless-0-linear"),
        ("record {cable} --input ship.csv+bad.csv --out x.csv", "bad.csv"),
        ("record {cable} --input step --duration nan --out x.csv", "--duration"),
        ("record {cable} --input standard --duration 2 --out x.csv", "at least 4 steps"),
        ("fit {cable} --record none.csv --model massless-linear --out x.json", "none.csv"),
        ("fit {cable} --record ship.csv --model massless-linear --out x.json", "no vehicle"),
        ("fit {cable} --record bad.csv --model massless-linear --out x.json", "bad.csv"),
        ("fit {cable} --record ship.csv --model massless-linear --out x.json --differentiator nan", "--differentiator"),
        ("fit {cable} --record ship.csv --model massless-65-linear --out x.json", "from 1 to 64"),
        ("verify none.json --record ship.csv --out x.csv", "none.json"),
        ("verify ship.csv --record ship.csv --out x.csv", "ship.csv"),
        ("verify {cable} --record ship.csv --out x.csv", "cable.toml"),
        ("verify . --record ship.csv --out x.csv", "cannot be read"),
        ("step broken.toml --out out", "broken.toml"),
        ("step {cable} --out ship.csv", "is a file"),
        ("crossval {cable} --record none.csv --out out", "none.csv"),
        ("crossval {cable} --record ship.csv --out out", "no vehicle"),
        ("crossval {cable} --record ship.csv --out ship.csv", "is a file"),
        ("bench s-shape-205 --out out", "sections"),
        ("bench none --out out", "none"),
        ("bench --out ship.csv", "is a file"),
        ("stability --out ship.csv", "is a file"),
        ("stability --only none --out out", "No case begins with"),
        ("gallery --out ship.csv", "is a file"),
        ("gallery --out none/gallery", "make it first"),
    ],
)
def test_wrong_input_ends_with_2_and_one_line(line: str, words: str, cable: str, capsys: Capture) -> None:
    write_ship("ship.csv", np.arange(60.0), 0.1 * np.arange(60.0))
    Path("bad.csv").write_text("time_s,ship_x_m\n0,0\n1,x\n2,1\n")
    Path("broken.toml").write_text("[cable\nlength_m = ")
    assert words in refused(capsys, *line.format(cable=cable).split())
