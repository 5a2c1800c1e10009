"""The parts that pages are made of: numbers as text, tables, files, labels, and sentences from tables."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib import rc_context
from matplotlib.text import Annotation, Text

from models.quantity import InvalidInput
from reports import findings, style
from reports.figures.scores import bars, error_against_run_time
from reports.files import write_json, write_parameters, write_scores, write_table, write_traces
from reports.markdown import Page, cell, exact, listed, significant
from reports.series import RecordSeries


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.010432, "0.0104"),
        (12.346, "12.3"),
        (16718.2, "16718"),
        (1.234e-5, "1.23e-05"),
        (2.5e8, "2.50e+08"),
        (-0.5, "-0.500"),
        (0.0, "0"),
        (float("nan"), "–"),
        (float("inf"), "∞"),
    ],
)
def test_numbers_keep_three_significant_digits(value: float, text: str) -> None:
    assert significant(value) == text


def test_cells_say_flags_in_words_and_escape_pipes() -> None:
    assert cell("a|b\nc") == "a\\|b c"
    assert cell(np.True_) == "yes"
    assert cell(False) == "no"
    assert cell(None) == cell(pd.NA) == cell(np.nan) == "–"
    assert cell(np.int64(1234567)) == "1234567"
    assert cell(0.01239, ".4f") == "0.0124"
    assert exact(0.0173) == "0.0173"
    assert exact(np.nan) == "–"
    assert exact([0.0, 0.12]) == "0, 0.12"


def test_words_are_listed_as_in_a_sentence() -> None:
    assert listed([]) == ""
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"


def test_a_table_lines_up_as_text_and_leaves_unnamed_columns_out() -> None:
    page = Page("T")
    frame = pd.DataFrame({"model": ["a", "long|name"], "error": [0.5, 0.0123], "hidden": [1, 2]})
    page.table(frame, {"model": "model", "error": "error, m/s", "absent": "absent"}, {"error": ".4f"})
    lines = page.text.splitlines()[2:]
    assert lines == [
        "| model      | error, m/s |",
        "| ---------- | ---------: |",
        "| a          |     0.5000 |",
        "| long\\|name |     0.0123 |",
    ]
    assert len({len(line) for line in lines}) == 1


def test_figures_are_numbered_and_captions_stand_below() -> None:
    page = Page("T")
    page.figure("figures/a.png", "First. More words.")
    page.figure("figures/b.png", "Second.")
    assert "![First](figures/a.png)\n\n*Figure 1. First. More words.*" in page.text
    assert "*Figure 2. Second.*" in page.text


def test_csv_is_stable_quoted_and_ends_with_a_line_feed(tmp_path: Path) -> None:
    frame = pd.DataFrame({"name": ['a,"b"', "c"], "x": [1.0 / 3.0, np.nan], "ok": [True, False], "n": [1, 20]})
    write_table(tmp_path / "deep" / "t.csv", frame, digits=6)
    assert (tmp_path / "deep" / "t.csv").read_bytes() == (b'name,x,ok,n\n"a,""b""",0.333333,true,1\nc,,false,20\n')
    back = pd.read_csv(tmp_path / "deep" / "t.csv")
    assert back["name"].tolist() == ['a,"b"', "c"]


def test_zero_has_no_sign_in_a_file(tmp_path: Path) -> None:
    write_table(tmp_path / "t.csv", pd.DataFrame({"x": [-0.0]}))
    assert (tmp_path / "t.csv").read_text() == "x\n0\n"


def test_scores_and_parameters_have_the_agreed_columns(tmp_path: Path) -> None:
    with pytest.raises(KeyError):
        write_scores(tmp_path / "scores.csv", pd.DataFrame({"model": ["a"]}))
    row = dict.fromkeys(("symbol", "unit", "model", "parameter", "determined"), "x")
    numbers = dict.fromkeys(("mapped", "identified", "change_percent", "low", "high"), 1.5)
    write_parameters(tmp_path / "parameters.csv", pd.DataFrame([row | numbers]))
    head = (tmp_path / "parameters.csv").read_text().splitlines()[0]
    assert head == "model,parameter,symbol,unit,mapped,identified,change_percent,low,high,determined"


def test_traces_are_written_one_file_each(tmp_path: Path) -> None:
    write_traces(tmp_path, {"a": pd.DataFrame({"time_s": [0.0, 1.0]}), "b": pd.DataFrame({"time_s": [0.5]})})
    assert (tmp_path / "a.csv").read_text() == "time_s\n0\n1\n"
    assert (tmp_path / "b.csv").read_text() == "time_s\n0.5\n"


def test_a_manifest_is_plain_json(tmp_path: Path) -> None:
    content = {
        "seed": np.int64(3),
        "x": np.array([1.0, np.nan]),
        "path": Path("a"),
        "ok": np.True_,
        "deep": {"t": (1, 2)},
    }
    write_json(tmp_path / "manifest.json", content)
    text = (tmp_path / "manifest.json").read_text()
    assert json.loads(text) == {"seed": 3, "x": [1.0, None], "path": "a", "ok": True, "deep": {"t": [1, 2]}}
    assert text.endswith("}\n")


def test_a_model_looks_the_same_in_any_company_and_groups_differ() -> None:
    usual = ["inertial-4-quadratic", "massless-4-quadratic", "second-order-quadratic", "first-order-quadratic"]
    alone = style.looks(["massless-4-quadratic"])["massless-4-quadratic"]
    together = style.looks([*usual, "inertial-8-quadratic", "massless-4-linear"])
    assert together["massless-4-quadratic"] == alone
    assert together["massless-4-linear"].color == alone.color
    assert together["massless-4-linear"].width < alone.width
    quadratic = [together[name] for name in [*usual, "inertial-8-quadratic"]]
    assert len({look.color for look in quadratic}) == len({look.marker for look in quadratic}) == 5


def scores_of(errors: dict[str, float], times: dict[str, float]) -> pd.DataFrame:
    rows = [
        {"model": model, "record": record, "rms_velocity_m_s": error * grow, "simulation_s_per_hour": times[model]}
        for model, error in errors.items()
        for record, grow in (("identification", 1.0), ("verification-truth", 1.2))
    ]
    return pd.DataFrame(rows)


def test_labels_of_crowded_points_do_not_overlap() -> None:
    names = [f"{kind}-{law}" for law in ("linear", "quadratic") for kind in ("inertial-4", "massless-4", "first-order")]
    errors = {name: 0.03 + 0.0007 * i for i, name in enumerate(names)}
    times = {name: 0.002 + 0.00003 * (i % 3) for i, name in enumerate(names)}
    errors["second-order-linear"], times["second-order-linear"] = 0.5, 0.05  # far away: the others move together
    with rc_context(style.SETTINGS):
        figure = error_against_run_time(scores_of(errors, times), ["identification", "verification-truth"])
        figure.draw_without_rendering()
        boxes = {
            text.get_text(): Text.get_window_extent(text)
            for text in figure.axes[0].texts
            if isinstance(text, Annotation)
        }
    assert set(boxes) == set(errors)
    extents = list(boxes.values())
    for i, box in enumerate(extents):
        assert box.x0 >= 0.0
        assert box.x1 <= figure.bbox.width
        for other in extents[:i]:
            assert not (box.x0 < other.x1 and other.x0 < box.x1 and box.y0 < other.y1 and other.y0 < box.y1)


def test_bars_survive_a_model_without_a_score() -> None:
    table = scores_of({"inertial-4-linear": 0.05, "massless-4-linear": np.inf}, dict.fromkeys(MODELS, 0.002))
    figure = bars(table, ["identification"])
    assert [text.get_text() for text in figure.axes[0].texts] == ["0.0500", "–"]


MODELS = ("inertial-4-linear", "massless-4-linear")


def full_scores(velocity: dict[str, dict[str, float]], **columns: object) -> pd.DataFrame:
    rows = [
        {
            "model": model,
            "record": record,
            "rms_velocity_m_s": value,
            "rms_position_m": 100.0 * value,
            "rms_position_offset_removed_m": 50.0 * value,
            "vehicle_rms_velocity_m_s": 0.4,
            "simulation_s_per_hour": 0.004,
            "outcome": "converged",
            **columns,
        }
        for model, errors in velocity.items()
        for record, value in errors.items()
    ]
    return pd.DataFrame(rows)


def test_the_best_model_is_the_one_that_verifies_best_not_the_one_that_fits_best() -> None:
    table = full_scores(
        {
            "a-linear": {"identification": 0.010, "verification-truth": 0.050},
            "b-linear": {"identification": 0.020, "verification-truth": 0.030},
        }
    )
    words = " ".join(findings.verdict(table, pd.DataFrame()))
    assert "**b-linear**" in words
    assert "0.0300 m/s RMS" in words
    assert "grows by a factor of 1.5" in words


def test_a_failed_fit_is_never_the_best_and_a_bound_is_called_out() -> None:
    table = full_scores({"a-linear": {"identification": 0.01}, "b-linear": {"identification": 0.02}})
    table.loc[table["model"] == "a-linear", "outcome"] = "failed"
    table.loc[table["model"] == "b-linear", "outcome"] = "bound"
    words = " ".join(findings.verdict(table, pd.DataFrame()))
    assert "**b-linear**" in words
    assert "did **not** converge: it ended at a bound" in words
    assert findings.verdict(table[table["model"] == "a-linear"], pd.DataFrame()) == ["No model could be scored."]


def test_a_much_cheaper_model_that_is_nearly_as_good_is_named() -> None:
    table = full_scores({"a-linear": {"verification-truth": 0.010}, "b-linear": {"verification-truth": 0.014}})
    table.loc[table["model"] == "b-linear", "simulation_s_per_hour"] = 0.001
    assert "The cheapest within half as much error again is b-linear: 0.0140 m/s, 4.0 times faster." in " ".join(
        findings.verdict(table, pd.DataFrame())
    )


@pytest.mark.parametrize(
    ("verdict", "determined"), [(True, True), (np.False_, False), ("yes", True), ("no (wide)", False), ("true", True)]
)
def test_verdicts_are_flags_or_words(verdict: object, determined: bool) -> None:
    assert findings.is_determined(verdict) is determined


def test_series_of_another_length_are_refused() -> None:
    four = np.zeros(4)
    with pytest.raises(InvalidInput, match=r"model_position\[m\] of the shape \(4,\) of t, but it has \(3,\)"):
        RecordSeries(
            record="r",
            t=np.arange(4.0),
            ship_position=four,
            ship_velocity=four,
            vehicle_position=four,
            vehicle_velocity=four,
            model_position={"m": np.zeros(3)},
        )
