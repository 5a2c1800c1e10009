"""The pages say what the tables say: numbers are compared as text, pictures only looked for."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from models.quantity import InvalidInput
from reports import findings
from reports.figures.residuals import ResidualCurves
from reports.figures.steps import StepResponse
from reports.run_page import RunMaterial, write_run_page
from reports.series import RecordSeries
from reports.step_page import StepMaterial, write_step_page
from reports.tow_page import TowMaterial, TowRecord, write_tow_page

MODELS = [
    f"{name}-{law}"
    for law in ("linear", "quadratic")
    for name in ("second-order", "first-order", "inertial-4", "massless-4")
]
ERRORS = dict(zip(MODELS, (0.051, 0.052, 0.059, 0.058, 0.0318, 0.0336, 0.0108, 0.0104), strict=True))
GROWTH = {"identification": 1.0, "verification-truth": 1.9, "verification-measured": 2.3}
COSTS = dict(zip(MODELS, (0.0011, 0.0010, 0.0021, 0.0017, 0.0016, 0.0012, 0.0049, 0.0030), strict=True))
OUTCOMES = {"second-order-linear": "bound", "inertial-4-quadratic": "flat"}
SYMBOLS = {
    "second-order": [("spring over mass", "a", "1/s2"), ("drag over mass", "b", "1/m"), ("delay", "tau", "s")],
    "first-order": [("drag over spring", "b/a", "s2/m"), ("delay", "tau", "s")],
    "inertial-4": [
        ("cable drag per metre", "r", "N s2/m3"),
        ("cable mass per metre", "m", "kg/m"),
        ("vehicle drag", "r_veh", "N s2/m2"),
        ("vehicle mass", "m_veh", "kg"),
    ],
    "massless-4": [("cable drag per metre", "r", "N s2/m3"), ("vehicle drag", "r_veh", "N s2/m2")],
}


def lagged(values: np.ndarray, steps: float) -> np.ndarray:
    out = np.empty_like(values)
    state = values[0]
    for i, value in enumerate(values):
        state += (value - state) / steps
        out[i] = state
    return out


def series(record: str, seed: int, *, step: float = 1.0, models: list[str] | None = None) -> RecordSeries:
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 3600.0 + step, step)
    ship = lagged(
        lagged(
            rng.normal(0.0, 1.0 / 3.0, t.size)
            + np.repeat(rng.choice([0, 0.2, -0.18, 0.3], 6), t.size // 6 + 1)[: t.size],
            16 / step,
        ),
        16 / step,
    )
    ship *= 0.5 / np.abs(ship).max()
    vehicle = lagged(lagged(ship, 60.0 / step), 30.0 / step)
    velocity, position = {}, {}
    for model in models or MODELS:
        size = ERRORS.get(model, 0.08) * GROWTH.get(record, 1.5)
        noise = lagged(lagged(rng.normal(0.0, 1.0, t.size), 20.0 / step), 20.0 / step)
        error = size * noise / noise.std()
        velocity[model] = vehicle + error
        position[model] = np.cumsum(vehicle + error) * step
    return RecordSeries(
        record=record,
        t=t,
        ship_position=np.cumsum(ship) * step,
        ship_velocity=ship,
        vehicle_position=np.cumsum(vehicle) * step,
        vehicle_velocity=vehicle,
        model_velocity=velocity,
        model_position=position,
        scored_from=300.0,
        description=f"Record {record}, 3600 s.",
    )


def score_rows(records: list[str], models: list[str] | None = None) -> pd.DataFrame:
    rows = []
    for model in models or MODELS:
        for record in records:
            velocity = ERRORS.get(model, 0.1) * GROWTH.get(record, 1.5)
            links = 4 if "-4-" in model else 0
            rows.append(
                {
                    "model": model,
                    "drag": model.rsplit("-", 1)[-1] if "baseline" not in model else "",
                    "links": links,
                    "states": {"second-order": 2, "first-order": 1, "inertial-4": 8, "massless-4": 4}.get(
                        model.rsplit("-", 1)[0], 0
                    ),
                    "parameters": len(SYMBOLS.get(model.rsplit("-", 1)[0], [])),
                    "record": record,
                    "rms_velocity_m_s": velocity,
                    "rms_position_m": 200.0 * velocity,
                    "rms_position_offset_removed_m": 120.0 * velocity,
                    "fit_percent": 100.0 * (1.0 - velocity / 0.351),
                    "vehicle_rms_velocity_m_s": 0.351,
                    "simulation_s_per_hour": COSTS.get(model, np.nan),
                    "identification_s": 600.0 * COSTS.get(model, np.nan),
                    "simulations": 312.0,
                    "outcome": OUTCOMES.get(model, "converged"),
                }
            )
    return pd.DataFrame(rows)


def parameter_rows() -> pd.DataFrame:
    rng = np.random.default_rng(3)
    rows = []
    for model in MODELS:
        for name, symbol, unit in SYMBOLS[model.rsplit("-", 1)[0]]:
            mapped = {"r": 13.84, "m": 1.275, "r_veh": 416.0, "m_veh": 1305.0, "tau": 11.6}.get(symbol, 0.004)
            ratio = {"r_veh": 6.0, "m_veh": 0.09}.get(symbol, 1.0) * float(np.exp(rng.normal(0.0, 0.2)))
            loose = symbol in ("r_veh", "m_veh")
            rows.append(
                {
                    "model": model,
                    "parameter": name,
                    "symbol": symbol,
                    "unit": unit,
                    "mapped": mapped,
                    "identified": mapped * ratio,
                    "change_percent": 100.0 * (ratio - 1.0),
                    "low": mapped * ratio * (0.01 if loose else 0.95),
                    "high": np.inf if symbol == "m_veh" else mapped * ratio * (9.0 if loose else 1.05),
                    "determined": not loose,
                }
            )
    return pd.DataFrame(rows)


def bode_tables() -> tuple[pd.DataFrame, pd.DataFrame]:
    def response(omega: np.ndarray, lag: float) -> dict[str, np.ndarray]:
        value = np.exp(-6j * omega) / (1.0 + 1j * omega * lag) / (1.0 + 0.3j * omega * lag)
        return {"gain_db": 20.0 * np.log10(np.abs(value)), "phase_deg": np.rad2deg(np.unwrap(np.angle(value)))}

    points, curves = [], []
    coarse, fine = np.geomspace(0.006, 0.1, 7), np.geomspace(0.004, 0.15, 60)
    for amplitude in (25.0, 50.0):
        points.append(
            pd.DataFrame({"amplitude_m": amplitude, "omega_rad_s": coarse, **response(coarse, 1.1 * amplitude)})
        )
        for i, model in enumerate(MODELS):
            if model.endswith("quadratic"):
                lag = amplitude * (1.0 + 0.07 * i)
                curves.append(
                    pd.DataFrame({"model": model, "amplitude_m": amplitude, "omega_rad_s": fine, **response(fine, lag)})
                )
    for i, model in enumerate(MODELS):
        if model.endswith("linear"):
            curves.append(
                pd.DataFrame(
                    {"model": model, "amplitude_m": np.nan, "omega_rad_s": fine, **response(fine, 40.0 + 3 * i)}
                )
            )
    return pd.concat(points, ignore_index=True), pd.concat(curves, ignore_index=True)


def residual_test(model: str) -> ResidualCurves:
    lag, cross = np.arange(0.0, 301.0), np.arange(-300.0, 301.0)
    return ResidualCurves(
        model=model,
        lag=lag,
        autocorrelation=np.exp(-lag / 40.0) * np.cos(lag / 60.0),
        cross_lag=cross,
        cross_correlation=0.3 * np.exp(-np.abs(cross - 40.0) / 80.0),
        band=0.034,
        cross_band=0.08,
    )


def run_material(**changes: object) -> RunMaterial:
    parameters = parameter_rows()
    points, curves = bode_tables()
    symbols = {model: [symbol for _, symbol, _ in SYMBOLS[model.rsplit("-", 1)[0]]] for model in MODELS}
    correlations = {}
    for model, names in symbols.items():
        values = np.full((len(names), len(names)), -0.99 if len(names) == 2 else 0.4)
        np.fill_diagonal(values, 1.0)
        correlations[model] = pd.DataFrame(values, index=names, columns=names)
    depth = np.linspace(0.0, 1200.0, 80)
    rng = np.random.default_rng(1)
    histories = {
        model: ERRORS[model]
        * (1.0 + 4.0 * np.exp(-np.arange(200 + 60 * i) / 30.0) * rng.uniform(0.5, 1.5, 200 + 60 * i))
        for i, model in enumerate(MODELS)
    }
    fields: dict[str, object] = {
        "title": "autec-1200",
        "description": "A steel sphere of 19170 N on 1200 m of cable.",
        "configuration": pd.DataFrame(
            [
                ("cable", "length_m", 1200.0, "m", False),
                ("cable", "diameter_m", 0.0173, "m", False),
                ("cable", "young_modulus_Pa", 6.2e10, "Pa", False),
                ("vehicle", "added_mass_kg", 45.0, "kg", True),
                ("input", "biases", [0.0, 0.12, -0.12, 0.2], "m/s", False),
            ],
            columns=["part", "setting", "value", "unit", "guess"],
        ),
        "configuration_text": "[cable]\nlength_m = 1200.0\n",
        "left_out": [("strumming", "its amplification law is for steady towing")],
        "unused": [("water.current_m_s", "the scene has no current")],
        "input_note": "Seeded normal sequence (seed 0), six biases, filtered at 0.06 rad/s, 0.50 m/s at most.",
        "truth_note": "The truth here is a chain of 60 links with its coefficients changed by 5 %.",
        "records": [series(name, i) for i, name in enumerate(GROWTH)],
        "scores": score_rows(list(GROWTH)),
        "parameters": parameters,
        "ends": pd.DataFrame(
            {
                "model": MODELS,
                "outcome": [OUTCOMES.get(model, "converged") for model in MODELS],
                "reason": ["The simplex shrank below its tolerance after 2 restarts." for _ in MODELS],
            }
        ),
        "thesis": pd.DataFrame(
            [
                ("second-order-linear", "identification", 0.051, 9.6),
                ("second-order-quadratic", "identification", 0.032, 4.5),
                ("inertial-4-quadratic", "identification", 0.011, 1.6),
                ("massless-4-quadratic", "identification", 0.01039, np.nan),
                ("second-order-quadratic", "verification-truth", 0.064, 8.6),
                ("inertial-4-quadratic", "verification-truth", 0.026, 4.6),
                ("massless-4-quadratic", "verification-truth", 0.0263, np.nan),
                ("first-order-quadratic", "verification-truth", 0.0501, np.nan),
            ],
            columns=["model", "record", "rms_velocity_m_s", "rms_position_m"],
        ),
        "floors": pd.DataFrame(
            {"record": ["verification-measured"], "rms_velocity_m_s": [0.021], "rms_position_m": [1.2]}
        ),
        "drag_over_spring": pd.DataFrame(
            {
                "model": ["second-order-quadratic", "first-order-quadratic"],
                "predicted": [424.0, 424.0],
                "identified": [498.0, 505.0],
                "thesis_predicted": [425.0, np.nan],
                "thesis_identified": [500.0, np.nan],
            }
        ),
        "total_drag": pd.DataFrame(
            {
                "model": ["inertial-4-quadratic", "massless-4-quadratic"],
                "cable": [16700.0, 12339.0],
                "vehicle": [1.8, 4469.0],
                "total": [16701.8, 16808.0],
                "mapped_total": [16718.0, 16718.0],
                "low": [16500.0, 16600.0],
                "high": [16900.0, 17000.0],
            }
        ),
        "histories": histories,
        "correlations": correlations,
        "twins": [("massless-4-linear", "r 13.8 with r_veh 416 and r 9.1 with r_veh 5210 give the same response.")],
        "bode_points": points,
        "bode_curves": curves,
        "static_shape": (np.zeros(80), -depth),
        "snapshots": [
            (60.0 * (i + 1), 30.0 * (i + 1) * (1.0 - (depth / 1200.0) ** 2 * np.exp(-0.2 * i)), -depth)
            for i in range(8)
        ],
        "snapshots_note": "The ship leaves at 0.5 m/s.",
        "residual_tests": [
            residual_test(model) for model in ("inertial-4-quadratic", "massless-4-quadratic", "second-order-quadratic")
        ],
        "manifest": {
            "program": "0.1.0",
            "versions": {"python": "3.11.9", "numpy": "2.4.0"},
            "seeds": {"input": 0},
            "machine": "x86_64, 2 cores",
        },
    }
    return RunMaterial(**{**fields, **changes})  # type: ignore[arg-type]


def step_response(length: float, weight: float, label: str, thesis: float = np.nan) -> StepResponse:
    t = np.arange(0.0, 100.5, 0.5)
    delay = 8.0 + 20.0 * length / 2500.0 * (6000.0 / weight) ** 0.3
    return StepResponse(
        label=label,
        length=length,
        weight=weight,
        t=t,
        velocity=0.5 * (1.0 - np.exp(-np.maximum(t - delay, 0.0) / (30.0 + length / 20.0))),
        delay_measured=delay,
        delay_midpoint=0.85 * delay,
        delay_front=delay - 0.4,
        delay_thesis=thesis,
    )


def step_material() -> StepMaterial:
    record = series("identification", 0)
    return StepMaterial(
        title="Step study: mangus-2500",
        step=0.5,
        by_length=[
            step_response(length, 6000.0, f"{length:.0f} m", thesis)
            for length, thesis in ((500.0, 5.7), (1000.0, 10.2), (2500.0, 20.2))
        ],
        by_weight=[step_response(2500.0, weight, f"{weight:.0f} N") for weight in (6000.0, 11000.0, 16000.0)],
        delay_definition="the time at which the vehicle reaches 2 % of the step",
        random_t=record.t,
        random_ship_velocity=record.ship_velocity,
        random_vehicle_velocity={
            "740 m": lagged(record.ship_velocity, 60.0),
            "1200 m": lagged(record.ship_velocity, 90.0),
            "2500 m": lagged(record.ship_velocity, 400.0),
        },
        manifest={"seed": 0},
    )


BASELINES = ["baseline-constant-velocity", "baseline-rigid-offset"]


def tow_material() -> TowMaterial:
    names = ["045", "060"]
    tows = []
    for i, name in enumerate(names):
        made = series(name, 10 + i, step=5.0, models=[*BASELINES, *MODELS])
        steady = 0.9 * made.t
        moved = RecordSeries(
            record=name,
            t=made.t,
            ship_position=made.ship_position + steady,
            ship_velocity=made.ship_velocity + 0.9,
            vehicle_position=made.vehicle_position + steady - 1400.0,
            vehicle_velocity=made.vehicle_velocity + 0.9,
            model_position={key: value + steady - 1400.0 for key, value in made.model_position.items()},
            model_velocity={key: value + 0.9 for key, value in made.model_velocity.items() if key in MODELS},
            scored_from=2160.0,
            description="Recorded 2018-11-29.",
        )
        turn = 60.0 * np.sin(made.t / 900.0)
        tows.append(
            TowRecord(
                name=name,
                series=moved,
                ship_track=np.column_stack([0.7 * moved.ship_position, -0.7 * moved.ship_position + turn]),
                vehicle_track=np.column_stack(
                    [0.7 * moved.vehicle_position, -0.7 * moved.vehicle_position + lagged(turn, 100)]
                ),
                axis_rms_m=930.0,
                off_axis_rms_m=240.0 if i == 0 else 41.0,
                axis_degrees=135.0,
                depth=1400.0 + 200.0 * np.sin(made.t / 700.0),
                slant_range=2000.0 + 220.0 * np.sin(made.t / 700.0),
                notes=["Read 898 rows, merged 449 pairs of the two cameras, moved 3 rows into time order."],
                warnings=[] if i else ["the cable length changed by 400 m under the winch."],
                residual_tests=[residual_test("massless-4-quadratic")] if i == 0 else [],
            )
        )
    scores = score_rows(names, [*MODELS, *BASELINES])
    scores.loc[(scores["record"] == "060") & (scores["model"] == "baseline-rigid-offset"), "rms_position_m"] = 1.0
    return TowMaterial(
        title="Recorded tows",
        tows=tows,
        scores=scores,
        ends=pd.DataFrame(
            {
                "record": ["045"],
                "model": ["massless-4-quadratic"],
                "outcome": ["budget"],
                "reason": ["2000 simulations used."],
            }
        ),
        limits=["the cable's length, which changes under the winch;"],
    )


def links(text: str) -> list[str]:
    return re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)


def table_row(text: str, heading: str, model: str) -> list[str]:
    """The cells of a model's row in the first table after a heading."""
    after = text[text.index(f"# {heading}\n") :]
    line = next(line for line in after.splitlines() if line.startswith(f"| {model} "))
    return [cell.strip() for cell in line.strip("|").split("|")]


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    write_run_page(folder, run_material())
    return folder


@pytest.fixture(scope="module")
def run_text(run_folder: Path) -> str:
    return (run_folder / "report.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def tow_text(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("tow")
    write_tow_page(folder, tow_material())
    text = (folder / "report.md").read_text(encoding="utf-8")
    assert {f"figures/{path.name}" for path in (folder / "figures").iterdir()} == set(links(text))
    return text


def test_a_run_page_has_its_sections_in_order(run_text: str) -> None:
    wanted = [
        "Configuration",
        "The cable",
        "Input and responses",
        "Scores",
        "Error against run time",
        "How the searches ended",
        "Parameters",
        "Identifiability",
        "Verification",
        "Frequency response",
        "Manifest",
    ]
    assert re.findall(r"^## (.+)$", run_text, re.MULTILINE) == wanted
    assert run_text.startswith("# autec-1200\n")
    assert run_text.endswith("\n")


def test_every_figure_is_linked_exists_and_is_modest(run_folder: Path, run_text: str) -> None:
    found = links(run_text)
    assert len(found) == 14
    assert {f"figures/{path.name}" for path in (run_folder / "figures").iterdir()} == set(found)
    for link in found:
        content = (run_folder / link).read_bytes()
        width = int.from_bytes(content[16:20], "big")
        assert content[:8] == b"\x89PNG\r\n\x1a\n"
        assert width == 930, link
        assert 1_000 < len(content) < 150_000, link


def test_the_result_names_the_best_model_at_verification_its_errors_and_its_cost(run_text: str) -> None:
    result = run_text.split("\n\n")[2]
    assert "Of eight reduced models, **massless-4-quadratic** comes nearest on the record it has not seen" in result
    assert "0.0198 m/s RMS, a fit of " in result
    assert "On the record it was fitted to the velocity error is 0.0104 m/s." in result
    assert "It simulates an hour in 3.00 ms." in result
    assert "grows by a factor of 1.9" in result
    assert "Its search converged." in result
    assert "does not determine its vehicle drag" in result


def test_score_tables_show_the_scores_and_the_thesis(run_text: str) -> None:
    velocity = table_row(run_text, "Velocity error", "inertial-4-quadratic")
    assert velocity == ["inertial-4-quadratic", "0.0108", "0.011", "0.0205", "0.026", "0.0248"]
    position = table_row(run_text, "Position error", "first-order-quadratic")
    assert position == ["first-order-quadratic", "6.7", "–", "12.8", "–", "15.5"]
    fit = table_row(run_text, "Fit", "second-order-linear")
    assert fit == ["second-order-linear", "85.5", "72.4", "66.6"]
    assert "Six of the eight velocity errors that the thesis prints are met or bettered." in run_text
    assert "first-order-quadratic on verification-truth (0.06384 against 0.0501 m/s)" in run_text


def test_searches_that_did_not_converge_are_called_out(run_text: str) -> None:
    assert "Two of eight did not converge:" in run_text
    assert "* **second-order-linear** ended at a bound; its values are where the search stopped" in run_text
    assert "* **inertial-4-quadratic** lies on a flat floor;" in run_text
    assert "* **massless-4-quadratic**" not in run_text.split("## How the searches ended")[1].split("## Parameters")[0]


def test_parameters_intervals_and_totals_are_in_their_tables(run_text: str) -> None:
    rows = parameter_rows()
    row = rows[(rows["model"] == "massless-4-quadratic") & (rows["symbol"] == "r")].iloc[0]
    line = next(line for line in run_text.splitlines() if line.startswith("| massless-4-quadratic ") and " r " in line)
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[4:] == [
        "13.8",
        f"{row['identified']:.1f}",
        f"{row['change_percent']:+.1f}",
        f"{row['low']:.1f}",
        f"{row['high']:.1f}",
        "yes",
    ]
    assert table_row(run_text, "Total drag", "massless-4-quadratic")[1:4] == ["12339", "4469", "16808"]
    assert table_row(run_text, "Drag over spring", "second-order-quadratic")[1:] == [
        "424",
        "498",
        "+17.5",
        "425",
        "500",
    ]


def test_guesses_omissions_floor_and_truth_are_said(run_text: str) -> None:
    assert "One value of 5 is a guess" in run_text
    assert re.search(r"added_mass_kg +\| 45 +\| kg +\| guess", run_text)
    assert "* **strumming**: its amplification law is for steady towing" in run_text
    assert "* `water.current_m_s`: the scene has no current" in run_text
    assert "The truth here is a chain of 60 links" in run_text
    assert "verification-measured: 0.0210 m/s and 1.20 m" in run_text
    assert "r_veh and r (-0.990)" in run_text
    assert "versions: numpy" in run_text


def test_a_page_is_the_same_bytes_again(tmp_path: Path) -> None:
    for name in ("once", "again"):
        (tmp_path / name).mkdir()
        write_step_page(tmp_path / name, step_material())
    files = [path.relative_to(tmp_path / "once") for path in (tmp_path / "once").rglob("*.*")]
    assert len(files) == 4
    for path in files:
        assert (tmp_path / "once" / path).read_bytes() == (tmp_path / "again" / path).read_bytes(), path


def test_a_run_of_one_model_without_verification_says_what_is_missing(tmp_path: Path) -> None:
    only = ["massless-4-quadratic"]
    scores, parameters = score_rows(["identification"], only), parameter_rows()
    material = run_material(
        records=[series("identification", 0, models=only)],
        scores=scores,
        parameters=parameters[parameters["model"] == only[0]],
        ends=pd.DataFrame({"model": only, "outcome": ["converged"], "reason": ["Done."]}),
        histories={},
        correlations={},
        floors=pd.DataFrame(),
        thesis=pd.DataFrame(),
        bode_points=pd.DataFrame(),
        static_shape=None,
        residual_tests=[],
    )
    write_run_page(tmp_path, material)
    text = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "**massless-4-quadratic** was tried on the record it was fitted to" in text
    assert "No other record was tried" in text
    assert "Every search converged." in text
    for absent in ("## Verification", "## Frequency response", "## The cable", "thesis, identification"):
        assert absent not in text


def test_verdict_words_are_kept_with_the_parameters_they_doubt() -> None:
    parameters = parameter_rows()
    words = ["no (correlated)" if symbol == "r_veh" else "yes" for symbol in parameters["symbol"]]
    lines = findings.identifiable(parameters.assign(determined=words))
    assert lines[-1] == (
        "**massless-4-quadratic**: the record determines cable drag per metre, but not vehicle drag (correlated)."
    )


def test_a_table_without_a_needed_column_is_refused() -> None:
    with pytest.raises(InvalidInput, match=r"RunMaterial\.scores needs the columns .* but outcome is missing"):
        run_material(scores=score_rows(["identification"]).drop(columns="outcome"))


def test_the_step_page_sets_the_measured_delay_beside_both_formulas(tmp_path: Path) -> None:
    write_step_page(tmp_path, step_material())
    text = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert set(links(text)) == {f"figures/{name}.png" for name in ("step-length", "step-weight", "random-length")}
    assert "Cable length from 500 to 2500 m takes the delay from 12.0 to 28.0 s." in text
    assert "The measured delay is 1.18 times that of the midpoint formula." in text
    assert "the time at which the vehicle reaches 2 % of the step" in text
    row = table_row(text, "Step response against cable length", "2500 m")
    assert row == ["2500 m", "2500", "6000", "28.0", "23.8", "27.6", "20.2", "0.093"]
    assert "thesis" not in text.split("## Step response against vehicle weight")[1].split("![")[0]


def test_the_tow_page_shows_baselines_first_and_says_when_models_lose(tow_text: str) -> None:
    first = tow_text.split("## Tow 045")[1].split("## Tow 060")[0]
    rows = [line.split("|")[1].strip() for line in first.splitlines() if line.startswith("| ")][2:]
    assert rows == [*BASELINES, *MODELS]
    assert "On one of two tows the best predictor of position is a model" in tow_text
    assert "the model is 90 % better. All eight models beat it." in tow_text
    assert "the model is 212 % **worse**. None of eight models beats it." in tow_text


def test_the_tow_page_warns_of_motion_off_the_axis(tow_text: str) -> None:
    first, second = tow_text.split("## Tow 045")[1].split("## Tow 060")
    assert "930 m RMS along its principal direction and 240 m across it (25.8 %)" in first
    assert "**Warning**: the motion across the axis is above 20 %" in first
    assert "across the axis is above" not in second.split("## How the searches ended")[0]
    assert "**Warning**: the cable length changed by 400 m under the winch." in first
    assert "merged 449 pairs" in first
    assert "**massless-4-quadratic** ran out of its budget of simulations on 045" in second


def test_pages_are_drawn_without_pyplot() -> None:
    code = (
        "import sys, reports.run_page, reports.step_page, reports.tow_page; print('matplotlib.pyplot' in sys.modules)"
    )
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=root, check=True)
    assert done.stdout.strip() == "False"
