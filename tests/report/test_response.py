"""The response study on the paper's two examples and on a hanging cable: tables, page and what it says of itself."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from ident.configuration import load
from ident.printed_responses import beside_paper, explanation
from ident.response_tables import details_table, peaks_of
from ident.studies.response import ResponseResult, response
from models.quantity import InvalidInput, NumericalFailure
from models.transfer_matrix import frequency_response

#: The whole range of the paper's figures.
RANGE: dict[str, Any] = {"amplitude": 1.0, "low": 0.05, "high": 1.5}
#: Enough frequencies for the sharp peaks of an almost undamped cable.
MANY = 146


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., ResponseResult]:
    """Runs the study of a configuration into a folder of its own, once for each set of arguments."""
    done: dict[str, ResponseResult] = {}

    def run(name: str, **given: Any) -> ResponseResult:
        key = f"{name} {sorted(given.items())}"
        if key not in done:
            out = tmp_path_factory.mktemp("response") / "made"
            done[key] = response(load(name), **{**RANGE, "points": 60, **given}, out=out, progress=quiet)
        return done[key]

    return run


def table(result: ResponseResult, name: str) -> pd.DataFrame:
    return pd.read_csv(result.folder / f"{name}.csv")


def page(result: ResponseResult) -> str:
    return (result.folder / "report.md").read_text(encoding="utf-8")


def test_the_tables_have_the_promised_columns(study: Callable[..., ResponseResult]) -> None:
    result = study("swath-4000")
    made = table(result, "response")
    assert ",".join(made.columns) == ("omega_rad_s,surge_m,heave_m,pitch_rad,tension_bottom_N,tension_top_N,iterations")
    assert made["omega_rad_s"].to_numpy() == pytest.approx(np.linspace(0.05, 1.5, 60))
    statics = table(result, "statics")
    assert ",".join(statics.columns) == "s_m,x_m,z_m,tension_N,angle_rad"
    assert statics["s_m"].iloc[[0, -1]].to_list() == [0.0, 4000.0]
    assert statics["tension_N"].iloc[0] == pytest.approx(3920.0 - 780.0)
    assert statics["z_m"].iloc[-1] == 0.0


def test_the_tables_hold_the_amplitudes_of_the_method(study: Callable[..., ResponseResult]) -> None:
    made, details = table(study("swath-4000"), "response"), table(study("swath-4000"), "response-details")
    nodes = table(study("swath-4000"), "statics")["s_m"].to_numpy()
    own = frequency_response(load("swath-4000").tow, np.linspace(0.05, 1.5, 60), nodes=nodes, tolerance=1e-12)
    for column, amplitude in {"heave_m": own.heave, "tension_top_N": own.tension_top, "pitch_rad": own.pitch}.items():
        assert made[column].to_numpy() == pytest.approx(np.abs(amplitude), rel=1e-2)
    turned = details["heave_m"] * np.exp(1j * details["heave_phase_rad"])
    assert turned.to_numpy() == pytest.approx(own.heave, rel=1e-3, abs=1e-6)
    assert details["heave_db"].to_numpy() == pytest.approx(20.0 * np.log10(made["heave_m"].to_numpy()), abs=1e-6)
    ratio = np.abs(own.tension) / own.shape.T
    assert details["slack_ratio"].to_numpy() == pytest.approx(ratio.max(axis=1), rel=1e-3)


def test_the_heave_peak_of_the_paper(study: Callable[..., ResponseResult]) -> None:
    peaks = table(study("swath-4000"), "peaks").set_index("quantity")
    assert peaks.loc["heave", "level_db"] == pytest.approx(5.25, abs=0.8)
    assert peaks.loc["heave", "omega_rad_s"] == pytest.approx(0.90, abs=0.12)
    assert peaks.loc["tension_bottom", "omega_rad_s"] == pytest.approx(1.19, rel=0.07)
    assert math.isnan(peaks.loc["tension_bottom", "level_db"])
    assert peaks.loc["tension_bottom", "unit"] == "N"
    assert 10.0 ** (peaks.loc["heave", "level_db"] / 20.0) == pytest.approx(peaks.loc["heave", "level"], rel=1e-6)


def test_both_conventions_of_the_tangential_drag_stand_beside_the_paper(study: Callable[..., ResponseResult]) -> None:
    printed = table(study("swath-4000"), "printed").set_index("what")
    narrow, wide = (printed.loc["heave peak", name] for name in ("C_t on d (this run)", "C_t on pi d"))
    assert narrow == pytest.approx(5.83, abs=0.05)
    assert wide == pytest.approx(5.04, abs=0.05)
    assert printed.loc["first tension peak at the vehicle", "C_t on pi d"] == pytest.approx(1.25, abs=0.01)
    assert printed.loc["heave peak", "off by"] == f"{narrow - 5.25:+.1f} dB"
    text = page(study("swath-4000"))
    assert f"{narrow:.2f} dB with C_t on d (this run), {wide:.2f} dB with C_t on pi d" in text


def test_slack_is_named_with_frequency_and_place(study: Callable[..., ResponseResult]) -> None:
    result = study("swath-4000")
    details = table(result, "response-details")
    first = details.loc[details["slack_ratio"] >= 1.0, "omega_rad_s"].iloc[0]
    assert f"goes slack from {first:.3g} rad/s on, first at the vehicle" in page(result)
    assert len(result.notes) == 1
    assert f"{first:.3g} rad/s" in result.notes[0]
    assert (details["slack_s_m"] == 0.0).iloc[-1]


def test_a_taut_cable_says_when_it_would_go_slack(study: Callable[..., ResponseResult]) -> None:
    result = study("swath-4000", amplitude=0.1, high=0.7, points=12)
    most = table(result, "response-details")["slack_ratio"].max()
    assert 0.0 < most < 1.0
    assert f"at most {100.0 * most:.0f} % of the static one" in page(result)
    assert f"slack at {0.1 / most:.2f} m" in page(result)
    assert result.notes == ()
    assert "Beside the paper" not in page(result)


def test_every_figure_is_there_and_linked_once(study: Callable[..., ResponseResult]) -> None:
    for name, points in {"swath-4000": 60, "s-shape-205-thrust": MANY}.items():
        folder = study(name, points=points).folder
        links = re.findall(r"\]\((figures/[^)]+)\)", page(study(name, points=points)))
        assert len(links) == len(set(links))
        assert {f"figures/{path.name}" for path in (folder / "figures").iterdir()} == set(links)
        assert all((folder / link).stat().st_size > 1000 for link in links)
        assert ("figures/mode-shapes.png" in links) == (name == "s-shape-205-thrust")


@pytest.mark.parametrize(("name", "within"), [("s-shape-205", 0.15), ("s-shape-205-thrust", 0.17)])
def test_the_modes_of_the_s_shape_stand_in_the_almost_undamped_cable(
    study: Callable[..., ResponseResult], name: str, within: float
) -> None:
    printed = table(study(name, points=MANY), "printed").set_index("what")
    ours, little = printed["C_t on d (this run)"], printed["almost undamped"]
    assert ours["depth"] == pytest.approx(100.0, rel=0.015)
    assert ours["static tension at the vehicle"] == pytest.approx(530.0, rel=0.01)
    assert ours["static tension at the top"] == pytest.approx(840.0, rel=0.03)
    for mode, omega in {"surge mode": 0.280, "heave mode": 0.435, "third mode": 0.550}.items():
        assert little[mode] == pytest.approx(omega, rel=within), mode
        assert math.isnan(ours[mode]), mode
        assert printed.loc[mode, "off by"] == f"{100.0 * (little[mode] / omega - 1.0):+.1f} % (almost undamped)"
    assert "compare their frequencies, not levels" in page(study(name, points=MANY))
    assert ("0.01 m, no current" in printed) == (name == "s-shape-205-thrust")
    if name == "s-shape-205-thrust":
        for mode, omega in {"surge mode": 0.280, "heave mode": 0.435, "third mode": 0.550}.items():
            assert printed.loc[mode, "0.01 m, no current"] == pytest.approx(omega, rel=0.05)
        assert "Without the current, in the shape that the ROV's thrust alone gives" in page(study(name, points=MANY))


def test_the_segments_are_fine_enough_for_the_tight_arc(study: Callable[..., ResponseResult]) -> None:
    refinement = table(study("s-shape-205-thrust", points=MANY), "segments")
    assert refinement["order"].iloc[-1] == pytest.approx(2.0, abs=0.2)
    assert refinement["error"].iloc[-1] < 1e-3
    statics = table(study("s-shape-205-thrust", points=MANY), "statics")
    turn = np.degrees(np.abs(np.diff(statics["angle_rad"])))
    i = int(turn.argmax())
    assert turn[i] < 5.0
    place = 0.5 * float(statics["s_m"][i] + statics["s_m"][i + 1])
    assert f"{place:.1f} m from the vehicle, it is" in page(study("s-shape-205-thrust", points=MANY))


def test_slow_motion_is_the_derivative_of_the_statics_but_as_printed(study: Callable[..., ResponseResult]) -> None:
    for name, flow in {"swath-4000": 2.0, "s-shape-205-thrust": 0.2}.items():
        slow = table(study(name, points=60 if name == "swath-4000" else MANY), "slow-motion").set_index("flow_m_s")
        assert flow in slow.index
        assert slow["consistent"].max() < 1e-4
        assert slow.loc[flow, "printed"] > 10.0 * slow["consistent"].max()
    assert "### Slow motion" in page(study("swath-4000"))


def test_the_product_of_matrices_loses_its_digits_and_the_stable_solve_does_not(
    study: Callable[..., ResponseResult],
) -> None:
    digits = table(study("swath-4000"), "digits")
    own = digits[digits["coefficient"] == 1.6].pivot(index="length_m", columns="omega_rad_s", values="digits")
    assert own.loc[500.0].iloc[-1] > 5.0
    assert own.loc[4000.0].iloc[-1] == 0.0
    assert (digits.groupby(["length_m", "omega_rad_s"])["digits"].first() >= 0.0).all()
    text = page(study("swath-4000"))
    assert "all of this is for a current of 0.5 m/s" in text
    kept = re.search(r"stable solve keeps at least (\d+\.\d)", text)
    assert kept is not None
    assert float(kept[1]) > 10.0
    assert f"in {int((digits['digits'] < 1.0).sum())} of {len(digits)} cases" in text


def test_a_depth_is_met_by_the_length_and_the_paper_is_left_out(study: Callable[..., ResponseResult]) -> None:
    result = study("s-shape-205", depth=110.0, points=20, high=0.6, segments=200)
    statics = table(result, "statics")
    assert statics["z_m"].iloc[0] == pytest.approx(-110.0, abs=1e-6)
    assert statics["s_m"].iloc[-1] > 205.0
    assert len(statics) == 201
    assert "for the depth asked for" in page(result)
    assert "Beside the paper" not in page(result)


def test_a_hanging_cable_moved_sideways_keeps_its_tension(study: Callable[..., ResponseResult]) -> None:
    result = study("mangus-740", direction="surge", high=0.4, points=20)
    assert "To first order the tension does not change." in page(result)
    assert not {"tensions.png", "slack.png"} & {path.name for path in (result.folder / "figures").iterdir()}
    assert set(table(result, "peaks")["quantity"]) <= {"surge"}
    made = table(result, "response")
    assert made["surge_m"].iloc[0] > 0.5
    assert (made["heave_m"] < 1e-12).all()
    assert (made["pitch_rad"] == 0.0).all()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"low": 0.0}, "above 0 rad/s"),
        ({"low": 1.0, "high": 0.5}, "from 1 to 0.5 rad/s"),
        ({"high": math.inf}, "inf rad/s"),
        ({"points": 2}, "2 were asked for"),
        ({"amplitude": -1.0}, "amplitude must be above 0"),
        ({"depth": 10.0}, "10 m"),
    ],
)
def test_what_has_no_response(given: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=re.escape(message)):
        response(load("s-shape-205"), **{**RANGE, **given}, out=tmp_path / "made", progress=quiet)
    assert not (tmp_path / "made").exists()


def test_a_product_without_digits_is_refused_by_name(tmp_path: Path) -> None:
    given = {**RANGE, "solver": "product", "segments": 256, "points": 5}
    with pytest.raises(NumericalFailure, match="product of transfer matrices"):
        response(load("multipart-2200"), **given, out=tmp_path / "made", progress=quiet)
    assert not (tmp_path / "made").exists()


def test_a_quantity_that_is_but_rounding_has_neither_level_nor_peak() -> None:
    run = frequency_response(load("mangus-740").tow, np.linspace(0.05, 0.5, 12), direction="surge", segments=64)
    assert peaks_of(run, "heave") == peaks_of(run, "tension_top") == ()
    details = details_table(run)
    assert details["heave_db"].isna().all()
    assert details["surge_db"].notna().all()


def test_outside_the_printed_frequencies_nothing_is_claimed() -> None:
    run = frequency_response(load("s-shape-205").tow, np.linspace(0.6, 0.7, 4), segments=128)
    rows = beside_paper("s-shape-205", [("first", run), ("last", run)], dynamic=True)
    told = rows.set_index("what")
    assert told.loc[["surge mode", "heave mode", "third mode", "heave at 0.80 rad/s"], "first"].isna().all()
    assert (told.loc[["surge mode", "heave at 0.80 rad/s"], "off by"] == "").all()
    assert told.loc["depth", "off by"] == "+0.0 %"
    assert explanation(rows) == ""
    assert beside_paper("autec-1200", [("first", run)], dynamic=True).empty
    assert len(beside_paper("s-shape-205", [("first", run)], dynamic=False)) == 4


def test_the_static_state_of_the_page_is_that_of_the_table(study: Callable[..., ResponseResult]) -> None:
    result = study("s-shape-205-thrust", points=MANY)
    statics, text = table(result, "statics"), page(result)

    def told(quantity: str) -> float:
        found = re.search(rf"\| {re.escape(quantity)} +\| +(-?[\d.]+) \|", text)
        assert found is not None, quantity
        return float(found[1])

    for quantity, column, row in (
        ("tension at the vehicle", "tension_N", 0),
        ("tension at the top", "tension_N", -1),
        ("x of the cable's lower end, from the top", "x_m", 0),
    ):
        assert told(quantity) == pytest.approx(statics[column].iloc[row], rel=5e-3), quantity
    assert told("depth of the cable's lower end") == pytest.approx(-statics["z_m"].iloc[0], rel=5e-3)
    assert told("pitch of the vehicle") == pytest.approx(8.0, abs=0.1)
    radius = np.min(np.diff(statics["s_m"]) / np.abs(np.diff(statics["angle_rad"])))
    assert told("least radius of curvature") == pytest.approx(radius, rel=5e-3)
