"""The benchmark end to end at a small size: its tables, its page, and what it leaves out."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from ident.benchmark import chain_bench, compiling, leaving_out, peers, reduced_bench, spectral_bench, transfer_bench
from ident.benchmark.bench_record import COLUMNS, FREQUENCY_COLUMNS, Record
from ident.benchmark.chain_bench import REDUCED
from ident.configuration import load
from ident.studies.bench import Effort, bench
from ident.timing import Timing
from models.tow import Tow
from models.towed_system import TowedSystem

FEW, SMALL = transfer_bench.REDUCED, reduced_bench.REDUCED
SINES = replace(spectral_bench.REDUCED, tolerances=(1e-2, 1e-4), methods=("Radau",))
LEFT = replace(leaving_out.REDUCED, spectral=("autec-1200",), matrix=())
TINY = replace(REDUCED, links=(4, 6), tolerances=(1e-2,), growth_links=(8, 16), growth_lengths=(60.0, 120.0))


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two configurations at the smallest size, without the peer."""
    out = tmp_path_factory.mktemp("bench") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(peers, "version", lambda: None)
        names = ["autec-1200", "multipart-2200"]
        result = bench(
            [load(name) for name in names],
            out=out,
            progress=quiet,
            budget=1000.0,
            effort=Effort(chain=TINY, matrix=FEW, reduced=SMALL, leaving=LEFT, spectral=SINES),
        )
    assert result.folder == out
    assert {"target", "asked", "found", "met"} == set(result.table[0])
    return out


def test_every_setting_has_a_row(folder: Path) -> None:
    table = pd.read_csv(folder / "bench.csv")
    assert tuple(table.columns) == COLUMNS
    table = table[table["method"] == "link-joint"]
    precision = table[~table["error_kind"].str.startswith("growth")]
    assert len(precision) == 2 * 3 * 2
    assert (precision["error_rms_velocity_m_s"] > 0.0).all()
    assert (table["seconds_per_hour"] > 0.0).all()
    assert table["spread"].ge(0.0).all()
    # Twice the tow, six links instead of four: the error falls, nearly as the square.
    for _, pair in precision.groupby(["configuration", precision["setting"].str.partition(":")[0]]):
        assert pair["error_rms_velocity_m_s"].iloc[1] < 0.8 * pair["error_rms_velocity_m_s"].iloc[0]


def test_the_matrix_method_has_rows_without_simulated_time(folder: Path) -> None:
    table = pd.read_csv(folder / "bench.csv")
    matrix = table[table["method"] == "matrix"]
    assert matrix["seconds_per_hour"].isna().all()
    precision = matrix[~matrix["error_kind"].str.startswith("growth")]
    names = ["s-shape-205", "swath-4000", "autec-1200", "multipart-2200"]
    assert precision["configuration"].unique().tolist() == names
    for _, pair in precision.groupby("configuration"):
        assert pair["error_rms_velocity_m_s"].iloc[0] > 2.5 * pair["error_rms_velocity_m_s"].iloc[1] > 0.0


def test_the_seconds_of_the_matrix_method(folder: Path) -> None:
    table = pd.read_csv(folder / "frequency.csv")
    assert tuple(table.columns) == FREQUENCY_COLUMNS
    assert (table["seconds"] > 0.0).all()
    parts = table[table["part"] == "paper's run"]["setting"].tolist()
    assert {"whole run", "mesh", "steady shape", "solves of all frequencies"} <= set(parts)
    sea = table[table["part"].str.startswith("sea state")]
    assert sea["configuration"].unique().tolist() == ["swath-4000"]
    assert len(sea) == 3
    solvers = table[(table["part"] == "one solve of all") & (table["setting"] == "stable sweep")]
    assert solvers["error_share"].max() < 1e-10
    page = (folder / "report.md").read_text(encoding="utf-8")
    for heading in ("Operations of one iteration", "What the tolerance leaves", "Against the simulation"):
        assert heading in page
    for figure in ("matrix-precision", "matrix-growth"):
        assert (folder / "figures" / f"{figure}.png").stat().st_size > 1000


def test_the_reduced_models_have_rows(folder: Path) -> None:
    table = pd.read_csv(folder / "bench.csv")
    reduced = table[table["method"].isin(reduced_bench.names(SMALL.links))]
    assert set(reduced["method"]) == set(reduced_bench.names(SMALL.links))
    assert (reduced["seconds_per_hour"] > 0.0).all()
    libraries = table[table["method"].str.startswith("solve_ivp")]
    assert libraries["configuration"].unique().tolist() == ["autec-1200"]
    page = (folder / "report.md").read_text(encoding="utf-8")
    assert "## Reduced models" in page
    for figure in ("precision", "libraries", "growth", "identification"):
        assert f"figures/reduced-{figure}.png" in page
    assert len(pd.read_csv(folder / "libraries.csv")) == 4 * len(SMALL.methods)
    assert len(pd.read_csv(folder / "searches.csv")) == 6


def test_the_spectral_simulator_has_rows(folder: Path) -> None:
    table = pd.read_csv(folder / "bench.csv")
    spectral = table[table["method"] == "spectral"]
    assert spectral["configuration"].unique().tolist() == ["autec-1200"]
    assert {words.partition(":")[0] for words in spectral["setting"]} >= {"implicit", "newmark", "runge-kutta"}
    assert (spectral["seconds_per_hour"] > 0.0).all()
    same = table[table["error_kind"].str.startswith("steps alone")]
    assert same["method"].unique().tolist() == ["solve_ivp Radau"]
    page = (folder / "report.md").read_text(encoding="utf-8")
    assert "## Spectral simulator" in page
    for figure in ("precision", "libraries", "growth"):
        assert f"figures/spectral-{figure}.png" in page


def test_the_turn_is_run_with_each_number_of_parts(folder: Path) -> None:
    turns = pd.read_csv(folder / "turn.csv")
    assert turns["configuration"].unique().tolist() == ["multipart-2200"]
    assert turns["parts"].tolist() == [1, 2, 3]
    assert (turns["track_m"] > 0.0).all()


def test_the_page_names_what_is_missing(folder: Path) -> None:
    page = (folder / "report.md").read_text(encoding="utf-8")
    assert peers.INSTALL in page
    assert "## Growth" in page
    for figure in ("growth", "work-precision-autec-1200", "work-precision-multipart-2200"):
        assert (folder / "figures" / f"{figure}.png").stat().st_size > 1000
    told = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    assert list(told["configurations"]) == ["autec-1200", "multipart-2200"]
    assert told["moordyn"] == "not installed"


def test_what_scenes_leave_out_has_rows_and_a_target(folder: Path) -> None:
    table = pd.read_csv(folder / "leaving-out.csv")
    assert {"spectral", "link-joint"} < set(table["simulator"])
    assert table["apart"].max() <= leaving_out.EQUAL
    assert (table["error"] > 0.0).all()
    page = (folder / "report.md").read_text(encoding="utf-8")
    assert "## What scenes leave out" in page
    assert "scenes without a term against the full model with it at zero" in page


def test_what_the_budget_cuts_is_listed(tmp_path: Path) -> None:
    out = tmp_path / "out"
    bench(
        [load("multipart-2200")],
        out=out,
        progress=quiet,
        budget=0.0,
        effort=Effort(chain=TINY, matrix=FEW, reduced=SMALL),
    )
    page = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    left_out = page[page.index("## Left out") : page.index("## Manifest")]
    for what in ("growth", "the dense form", "the turn with 3 parts", "the paper's run of the matrix method"):
        assert what in left_out
    assert "what scenes leave out" in left_out
    assert "they know nothing of parts behind the vehicle" in left_out
    assert not (out / "leaving-out.csv").exists()
    assert not (tmp_path / "out" / "turn.csv").exists()
    assert not (tmp_path / "out" / "frequency.csv").exists()


def test_growth_is_per_doubling() -> None:
    sizes = (10.0, 20.0, 80.0)
    growth = chain_bench.Growth(
        what="links", sizes=sizes, seconds=(1.0, 1.5, 6.0), iterations=(2.0,) * 3, spread=(0.0,) * 3, repetitions=1
    )
    assert growth.doubling == pytest.approx(2.0)
    assert growth.exponent == pytest.approx(1.0)


def test_the_dense_form_is_timed_on_a_state_it_solves(configurations: Callable[[str], Tow]) -> None:
    system = TowedSystem.from_tow(configurations("autec-1200"))
    [row] = chain_bench.dense_form(system, chain_bench.circles(3.0, 250.0, 60.0), replace(TINY, dense_links=(8,)))
    assert row.links == 8
    assert math.isfinite(row.evaluation / row.step)
    assert np.sign(row.step) == 1.0


@pytest.mark.slow
def test_compiling_anew_takes_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process of its own with no machine code kept compiles; one that calls for the second time does not."""
    monkeypatch.setattr(compiling, "METHODS", {"matrix": compiling.METHODS["matrix"]})
    assert compiling.compiled_anew()["matrix"] > 1.0
    compiling.METHODS["matrix"]()
    assert compiling.first_call("matrix") < 0.1


def test_a_quick_run_is_not_judged(folder: Path) -> None:
    record = Record(progress=quiet, budget=1.0, judged=False)
    record.target("any", "1", "2", met=True)
    assert record.targets[0]["met"] == "-"
    assert "too small to be held against" not in (folder / "report.md").read_text(encoding="utf-8")


def test_every_row_has_what_its_method_took_to_compile() -> None:
    record = Record(progress=quiet, budget=1.0)
    for method in ("matrix", "other"):
        record.row("any", method, "", "", 0.0, Timing(1.0, 0.0, 1))
    record.compiled("matrix", 3.0)
    assert record.table()["compile_s"].fillna(-1.0).tolist() == [3.0, -1.0]
