"""The main study end to end, on a short record with two models: the files of the contract and what they say."""

import json
import os
import re
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from data_synth.records import read_record
from ident.cli import main

ROOT = Path(__file__).resolve().parents[2]
MODELS = ["second-order-quadratic", "massless-2-quadratic"]
RECORDS = ["identification", "verification-truth", "verification-measured"]
TIMES = ["simulation_s_per_hour", "identification_s"]
SHORT = """
description = "a sled on 740 m of cable"
guesses = ["cable.added_mass_kg_m"]

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
tolerance_m_s = 5e-4

[input]
duration_s = 900.0
segment_s = 200.0

[verification]
kind = "starts-and-stops"
duration_s = 900.0
runs_s = [130.0, 180.0]
pauses_s = [100.0]

[identification]
models = ["second-order-quadratic", "massless-2-quadratic"]

[step]
speed_m_s = 0.4

[bode]
amplitudes_m = [25.0]
omegas_rad_s = [0.01, 0.03]
"""


def configured(folder: Path, text: str = SHORT) -> str:
    path = folder / "short.toml"
    path.write_text(text)
    return str(path)


def make(folder: Path, *options: str, text: str = SHORT) -> Path:
    out = folder / "out"
    assert main(["run", configured(folder, text), "--out", str(out), "--quiet", *options]) == 0
    return out


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make(tmp_path_factory.mktemp("run"))


def page_table(page: str, heading: str) -> pd.DataFrame:
    """The first table below a heading, cells as text, the first column as index."""
    lines = page.split(f"# {heading}\n", 1)[1].splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("|"))
    rows = []
    for line in lines[start:]:
        if not line.startswith("|"):
            break
        rows.append([cell.strip() for cell in line.strip("|").split("|")])
    table = pd.DataFrame(rows[2:], columns=rows[0])
    return table.set_index(rows[0][0])


def test_files_are_those_of_the_contract(result: Path) -> None:
    assert {path.name for path in result.iterdir()} == {
        "report.md",
        "figures",
        "traces",
        "scores.csv",
        "scores-current.csv",
        "parameters.csv",
        "manifest.json",
    }
    records = [*RECORDS, "verification-current"]
    assert {path.name for path in (result / "traces").iterdir()} == {
        *(f"{name}.csv" for name in records),
        *(f"{name}-responses.csv" for name in records),
    }


def test_report_shows_every_figure_and_no_other(result: Path) -> None:
    linked = re.findall(r"!\[.*?\]\((figures/.*?\.png)\)", (result / "report.md").read_text())
    there = sorted(f"figures/{path.name}" for path in (result / "figures").iterdir())
    assert sorted(linked) == there
    assert len(there) > 10
    for name in there:
        assert (result / name).read_bytes().startswith(b"\x89PNG")


def test_columns_are_exactly_those_of_the_contract(result: Path) -> None:
    scores = (
        "model,drag,links,states,parameters,record,rms_velocity_m_s,rms_position_m,rms_position_offset_removed_m,"
        "fit_percent,vehicle_rms_velocity_m_s,simulation_s_per_hour,identification_s,simulations,outcome"
    )
    parameters = "model,parameter,symbol,unit,mapped,identified,change_percent,low,high,determined"
    for name, header in (("scores", scores), ("scores-current", scores), ("parameters", parameters)):
        assert (result / f"{name}.csv").read_text().splitlines()[0] == header


def test_scores_have_a_row_a_model_and_record(result: Path) -> None:
    scores = pd.read_csv(result / "scores.csv", keep_default_na=False)
    expected = [(model, record) for record in RECORDS for model in ["baseline-rigid", *MODELS]]
    assert list(zip(scores["model"], scores["record"], strict=True)) == expected
    current = pd.read_csv(result / "scores-current.csv", keep_default_na=False)
    assert current["model"].tolist() == ["baseline-rigid", *MODELS]
    assert set(current["record"]) == {"verification-current"}
    fitted = scores[scores["model"].isin(MODELS)]
    assert set(fitted["drag"]) == {"quadratic"}
    assert set(fitted["outcome"]) <= {"converged", "bound", "budget", "flat"}
    by_model = fitted.drop_duplicates("model").set_index("model")
    assert by_model.loc[MODELS, "links"].tolist() == [0, 2]
    assert by_model.loc[MODELS, "states"].tolist() == [2, 2]
    assert by_model.loc[MODELS, "parameters"].tolist() == [3, 2]
    baselines = scores[scores["model"] == "baseline-rigid"]
    assert set(baselines["outcome"]) == {""}


def test_models_are_better_than_the_ship_itself(result: Path) -> None:
    scores = pd.read_csv(result / "scores.csv")
    errors = scores.pivot(index="model", columns="record", values="rms_velocity_m_s")
    for model in MODELS:
        assert (errors.loc[model] < 0.5 * errors.loc["baseline-rigid"]).all()
    assert errors.loc["massless-2-quadratic", "identification"] < 0.03


def test_numbers_of_the_report_are_those_of_the_tables(result: Path) -> None:
    page = (result / "report.md").read_text()
    scores = pd.concat([pd.read_csv(result / "scores.csv"), pd.read_csv(result / "scores-current.csv")])
    for heading, column, form in (
        ("Velocity error", "rms_velocity_m_s", ".4f"),
        ("Position error", "rms_position_m", ".1f"),
        ("Fit", "fit_percent", ".1f"),
    ):
        table = page_table(page, heading)
        for row in scores.to_dict("records"):
            assert table.loc[row["model"], row["record"]] == f"{row[column]:{form}}"
        assert table.shape == (3, 4)
    shown = page_table(page, "Parameters").reset_index()
    parameters = pd.read_csv(result / "parameters.csv")
    assert shown["model"].tolist() == parameters["model"].tolist()
    assert [float(x) for x in shown["identified"]] == pytest.approx(parameters["identified"].tolist(), rel=6e-3)
    ends = page_table(page, "How the searches ended")["outcome"]
    for row in scores[scores["model"].isin(MODELS)].to_dict("records"):
        assert ends[row["model"]] == row["outcome"]


def test_report_says_what_stands_for_the_truth_and_what_is_a_guess(result: Path) -> None:
    page = (result / "report.md").read_text()
    truth = page.split("# Verification\n", 1)[1].split("#", 1)[0]
    assert "The truth is a run of the link-joint simulator, a nonlinear three-dimensional chain" in truth
    assert "60 links" in truth
    assert "no link goes slack" in truth
    said = re.search(r"estimated error (\S+) m/s RMS", truth)
    assert said is not None
    made = json.loads((result / "manifest.json").read_text())["verification"]
    assert float(said[1]) == pytest.approx(made["error_m_s"], rel=0.05)
    assert made["links"] == [60]
    for name, factor in made["coefficients"].items():
        assert f"{name} {100.0 * (factor - 1.0):+.0f} %" in truth
    assert "One value of" in page
    assert "is a guess" in page
    assert page_table(page, "Configuration").reset_index().iloc[:, -1].tolist().count("guess") == 1
    assert "* `step.speed_m_s`: no part of this study reads it" in page
    assert "seed 0" in page


def test_report_suggests_to_leave_out_what_makes_no_difference(result: Path) -> None:
    page = (result / "report.md").read_text()
    part = page.split("# Settings that make no difference here\n", 1)[1].split("#", 1)[0]
    found = re.search(
        r"\* `cable.tangential_drag_coefficient`: in \d+ s .* velocity by (?:less than )?(\S+) m/s RMS", part
    )
    assert found is not None
    assert 0.0 < float(found[1]) <= 5e-4
    assert "set it to 0" in part


def test_manifest_holds_versions_seed_and_the_configuration_as_used(result: Path) -> None:
    manifest = json.loads((result / "manifest.json").read_text())
    assert manifest["configuration"] == SHORT
    assert tomllib.loads(manifest["configuration"])["cable"]["length_m"] == 740.0
    assert (manifest["command"], manifest["seed"], manifest["models"]) == ("run", 0, MODELS)
    assert {"cable-ident", "python", "numpy", "scipy", "numba", "pandas", "matplotlib", "control"} <= set(
        manifest["versions"]
    )
    assert manifest["reference"]["error_m_s"] <= 5e-4
    assert set(manifest["verification"]["coefficients"].values()) <= {0.95, 1.05}


def test_traces_read_back_and_give_the_scores_again(result: Path, tmp_path: Path) -> None:
    """A fit and a verification on the written records, through the other commands, meet the run's own numbers."""
    scores = pd.read_csv(result / "scores.csv").set_index(["model", "record"])
    traces, model = result / "traces", MODELS[1]
    assert read_record(traces / "identification.csv").tension is not None
    fit, again = tmp_path / "fit.json", tmp_path / "again.csv"
    own = configured(tmp_path)
    known = ["--differentiator", "0", "--quiet"]
    line = ["fit", own, "--record", str(traces / "identification.csv"), "--model", model, "--out", str(fit), *known]
    assert main(line) == 0
    found = json.loads(fit.read_text())["fits"][0]
    assert found["rms_velocity_m_s"] == pytest.approx(
        scores.loc[(model, "identification"), "rms_velocity_m_s"], rel=1e-2
    )
    parameters = pd.read_csv(result / "parameters.csv").set_index(["model", "parameter"])["identified"]
    for name, value in found["values"].items():
        assert value == pytest.approx(parameters[model, name], rel=2e-2)
    records = ["--record", str(traces / "verification-measured.csv")]
    assert main(["verify", str(fit), *records, "--differentiator", "90", "--out", str(again)]) == 0
    measured = pd.read_csv(again).set_index("model")
    for column in ("rms_velocity_m_s", "rms_position_m", "fit_percent"):
        expected = scores.loc[(model, "verification-measured"), column]
        assert measured.loc[model, column] == pytest.approx(expected, rel=1e-2)


def test_response_tables_give_the_scores(result: Path) -> None:
    scores = pd.read_csv(result / "scores.csv").set_index(["model", "record"])["rms_velocity_m_s"]
    for record in RECORDS:
        table = pd.read_csv(result / "traces" / f"{record}-responses.csv")
        late = table[table["time_s"] >= 300.0]
        for model in MODELS:
            error = late[f"{model}_velocity_m_s"] - late["vehicle_velocity_m_s"]
            assert float(np.sqrt(np.mean(error**2))) == pytest.approx(scores[model, record], rel=1e-4)


def test_the_same_seed_gives_the_same_tables_and_replaces_an_earlier_result_whole(result: Path, tmp_path: Path) -> None:
    """One model fitted alone ends where it ends beside another."""
    out = tmp_path / "out"
    out.mkdir()
    (out / "manifest.json").write_text("{}")
    (out / "earlier.txt").write_text("earlier")
    make(tmp_path, "--models", MODELS[1])
    assert not (out / "earlier.txt").exists()
    for name in ("scores.csv", "scores-current.csv", "parameters.csv"):
        one, two = (pd.read_csv(folder / name).drop(columns=TIMES, errors="ignore") for folder in (result, out))
        one = one[one["model"] != MODELS[0]].reset_index(drop=True)
        assert MODELS[1] in set(one["model"])
        pd.testing.assert_frame_equal(one, two, check_exact=True)
    for name in ("traces/identification.csv", "traces/verification-measured.csv"):
        assert (result / name).read_bytes() == (out / name).read_bytes()
    assert {path.name for path in tmp_path.iterdir()} == {"short.toml", "out"}


@pytest.mark.slow
def test_another_seed_and_fewer_models(result: Path, tmp_path: Path) -> None:
    out = make(tmp_path, "--seed", "5", "--models", "massless-2-quadratic")
    one, two = (pd.read_csv(folder / "scores.csv") for folder in (result, out))
    assert set(two["model"]) == {"baseline-rigid", "massless-2-quadratic"}
    both = one.merge(two, on=["model", "record"])
    assert len(both) == 6
    assert (both["rms_velocity_m_s_x"] != both["rms_velocity_m_s_y"]).all()
    assert json.loads((out / "manifest.json").read_text())["seed"] == 5
    assert "second-order" not in (out / "scores.csv").read_text()


@pytest.mark.parametrize("kind", ["folder", "file"])
def test_a_place_that_holds_something_else_is_refused(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    kept = out if kind == "file" else out / "mine.txt"
    kept.parent.mkdir(exist_ok=True)
    kept.write_text("mine")
    assert main(["run", configured(tmp_path), "--out", str(out)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert error.count("\n") == 1
    assert kept.read_text() == "mine"
    assert {path.name for path in tmp_path.iterdir()} == {"short.toml", "out"}


@pytest.mark.slow
def test_a_tow_with_a_part_behind_is_verified_with_it(tmp_path: Path) -> None:
    tail = """
[tow]
speed_m_s = 1.0

[[tail]]
name = "towed-body"
[tail.cable]
length_m = 100.0
diameter_m = 0.03
mass_per_length_kg_m = 0.725
weight_in_water_N_m = 0.0
axial_stiffness_N = 2e6
added_mass_kg_m = 0.725
normal_drag_coefficient = 1.2
tangential_drag_coefficient = 0.02
[tail.body]
weight_N = 1323.9
buoyancy_N = 1323.9
mass_kg = 135.0
added_mass_surge_kg = 135.0
added_mass_sway_kg = 135.0
added_mass_heave_kg = 135.0
area_surge_m2 = 1.0
area_sway_m2 = 1.0
area_heave_m2 = 1.0
drag_coefficient = 1.2

[link-joint]
links = 30
"""
    out = make(tmp_path, "--models", "massless-2-quadratic", text=SHORT + tail)
    page = (out / "report.md").read_text()
    assert "the models are identified without towed-body, which the verification truth tows" in page
    assert "The truth tows towed-body as well" in page
    assert "* `link-joint.links`: no part of this study reads it" in page
    assert json.loads((out / "manifest.json").read_text())["verification"]["links"] == [60, 8]


@pytest.mark.slow
def test_a_steady_tow_runs_to_its_report(tmp_path: Path) -> None:
    text = SHORT + "\n[tow]\nspeed_m_s = 0.3\n\n[current]\ndepth_m = [0.0, 400.0]\nspeed_m_s = [0.1, 0.0]\n"
    out = make(tmp_path, "--models", "massless-2-quadratic", text=text)
    page = (out / "report.md").read_text()
    assert "**steady tow**" not in page
    assert "**current**" not in page
    record = read_record(out / "traces" / "identification.csv")
    assert record.vehicle is not None
    assert record.ship.position[-1, 0] - record.ship.position[0, 0] > 150.0
    gap = record.ship.position[:, 0] - record.vehicle.position[:, 0]
    assert gap[0] > 20.0
    speed = record.vehicle.spline(record.vehicle.t[:20], 1)[:, 0]
    assert speed == pytest.approx(0.3, abs=0.02)
    scores = pd.read_csv(out / "scores.csv").set_index(["model", "record"])["rms_velocity_m_s"]
    assert scores["massless-2-quadratic", "identification"] < scores["baseline-rigid", "identification"]


@pytest.mark.parametrize(
    "stage",
    [
        pytest.param("simulating the truth", marks=pytest.mark.slow),
        "fitting the reduced models",
        pytest.param("drawing the report", marks=pytest.mark.slow),
    ],
)
@pytest.mark.skipif(os.name == "nt", reason="no POSIX signals here")
def test_an_interrupt_leaves_nothing_behind(stage: str, tmp_path: Path) -> None:
    configured(tmp_path)
    command = [sys.executable, "-m", "ident.cli", "run", "./short.toml"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stderr is not None
        assert any(stage in line for line in process.stderr)
        process.send_signal(signal.SIGINT)
        rest = process.stderr.read()
        assert process.wait() == 130
    assert rest.endswith("error: interrupted.\n")
    assert "Traceback" not in rest
    assert [path.name for path in tmp_path.iterdir()] == ["short.toml"]
