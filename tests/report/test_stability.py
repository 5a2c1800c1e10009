"""The catalogue end to end: its tables, its page, and what it says of a case that does not pass."""

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from ident.cli import main
from ident.places import new_folder
from ident.stability.aliasing import AliasingMap
from ident.stability.case import Case, Expectation, Figure, Finding
from ident.studies import stability as study
from ident.studies.stability import COLUMNS, stability
from models.quantity import InvalidInput


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


def test_a_run_writes_its_tables_and_its_page(tmp_path: Path) -> None:
    out = tmp_path / "out"
    result = stability(
        out=out, progress=quiet, only=["chain-length-5", "chain-one-link", "control-too-few-links", "matrix-rubber"]
    )
    assert result.failed == ()
    assert result.folder == out
    assert [line["passed"] for line in result.table] == ["2 of 2", "1 of 1", "1 of 1"]
    table = pd.read_csv(out / "stability.csv")
    assert tuple(table.columns) == COLUMNS
    assert table["case"].tolist() == ["chain-length-5", "chain-one-link", "matrix-rubber", "control-too-few-links"]
    assert table["outcome"].tolist() == ["answer", "InvalidInput", "answer", "caught"]
    assert table["passed"].all()
    assert table["margin"].between(0.0, 1.0, inclusive="right").all()
    assert (table["seconds"] >= 0.0).all()
    figures = pd.read_csv(out / "figures.csv")
    assert set(figures["case"]) == {"chain-length-5", "matrix-rubber", "control-too-few-links"}
    # The margins are those of the worst figures.
    worst = figures.groupby("case")["share"].max()
    margins = table.set_index("case")["margin"]
    assert margins["matrix-rubber"] == pytest.approx(1.0 - worst["matrix-rubber"], rel=1e-5)
    assert margins["control-too-few-links"] == pytest.approx(1.0 - 1.0 / worst["control-too-few-links"], rel=1e-5)
    page = (out / "report.md").read_text(encoding="utf-8")
    assert "4 cases, of which 4 end as expected" in page
    assert "Not as expected" not in page
    for words in ("The link-joint chain", "The matrix method", "Faults that must be caught", "figures/deviations.png"):
        assert words in page
    assert (out / "figures" / "deviations.png").exists()
    assert json.loads((out / "manifest.json").read_text())["command"] == "stability"


def fake(name: str, expected: str, found: float) -> tuple[Case, Expectation]:
    """A case that gives a depth for 10 m within 1 m."""
    figure = Figure(quantity="depth", reference=10.0, unit="m", allowed=1.0, source="known")
    wanted = Expectation(name=name, model="any", expected=expected, figures=(figure,), source="known")
    return Case(name=name, run=lambda: Finding(figures={"depth": found})), wanted


def test_cases_that_do_not_pass_are_named_and_the_rest_is_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cases = [
        fake("chain-wrong", "answer", 12.5),
        fake("chain-none", "answer", math.nan),
        fake("control-missed", "caught", 10.5),
        fake("chain-right", "answer", 10.25),
    ]
    monkeypatch.setattr(study, "catalogue", lambda only, *, reduced: cases)
    result = stability(out=tmp_path / "out", progress=quiet)
    assert result.failed == ("chain-wrong", "chain-none", "control-missed")
    assert [line["passed"] for line in result.table] == ["1 of 3", "0 of 1", "no", "no", "no"]
    table = pd.read_csv(tmp_path / "out" / "stability.csv").set_index("case")
    assert table["passed"].tolist() == [False, False, False, True]
    assert table["margin"].tolist() == pytest.approx([-1.5, -math.inf, -1.0, 0.75])
    assert table["outcome"]["control-missed"] == "answer"
    page = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    assert "of which 1 end as expected" in page
    assert "Not as expected" in page


def test_the_map_is_drawn_with_its_cases(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = AliasingMap(
        harmonics=(4, 8),
        stations=(4, 12),
        error=np.array([[0.01, 1e-4], [np.inf, 0.3]]),
        accepted=np.array([[True, True], [False, True]]),
    )
    monkeypatch.setattr(study, "aliasing_map", lambda *, few: made)
    monkeypatch.setattr(study, "catalogue", lambda only, *, reduced: [fake("spectral-aliasing-map", "answer", 10.0)])
    stability(out=tmp_path / "out", progress=quiet)
    page = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    assert "Of 4 pairs 2 are unstable. The simulator accepts 3, of which 1 is unstable" in page
    assert (tmp_path / "out" / "figures" / "aliasing.png").exists()


def test_nothing_is_written_where_the_names_are_wrong(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="No case begins with"):
        stability(out=tmp_path / "out", progress=quiet, only=["chain-", "no-such"])
    assert not (tmp_path / "out").exists()
    # An earlier result may be replaced.
    with new_folder(tmp_path / "out") as folder:
        (folder / "manifest.json").write_text("{}")
    stability(out=tmp_path / "out", progress=quiet, only=["chain-one-link"])
    assert (tmp_path / "out" / "stability.csv").exists()


def test_the_command_ends_with_1_where_a_case_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    cases = [fake("chain-wrong", "answer", 12.5), fake("chain-right", "answer", 10.25)]
    monkeypatch.setattr(study, "catalogue", lambda only, *, reduced: cases)
    assert main(["stability", "--out", str(tmp_path / "out"), "--quiet"]) == 1
    shown = capsys.readouterr()
    assert "error: 1 of the cases did not end as expected: chain-wrong;" in shown.err
    assert "answers within their bounds" in shown.out
    assert len(pd.read_csv(tmp_path / "out" / "stability.csv")) == 2


def test_the_command_runs_what_it_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["stability", "--only", "chain-one-link,reduced-mass-0", "--out", str(out), "--quiet"]) == 0
    assert pd.read_csv(out / "stability.csv")["case"].tolist() == ["chain-one-link", "reduced-mass-0"]
    capsys.readouterr()
    assert main(["stability", "--only", "chain-two-link", "--out", str(tmp_path / "other"), "--quiet"]) == 2
    assert 'No case begins with "chain-two-link"; names begin with chain, matrix' in capsys.readouterr().err
    assert not (tmp_path / "other").exists()
