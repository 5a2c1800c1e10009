"""Checks of the matrix method against the chain in the time domain: what is drawn, compared and counted."""

import json
import math
import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from data_synth.rao import Rao, read_rao
from data_synth.spectra import SeaState, Spectrum, sea_state
from ident import chain_record, sea_drawing, time_domain
from ident.chain_record import ChainRecord, ChainSetting, moves, resolved
from ident.compensated_checks import SETTLED, check_compensated
from ident.compensator_seas import LOCKED, Seaway
from ident.configuration import load
from ident.harmonic_checks import check_harmonics
from ident.sea_checks import check_sea, comparison, level
from ident.studies.compensator import compensator
from ident.studies.sea import sea
from models.compensator import Setting
from models.quantity import InvalidInput
from models.tow import Tow
from models.transfer_matrix import Direction, frequency_response, sea_response

SWATH = Path(sea_drawing.__file__).parent / "vessels" / "swath.csv"
#: Times of a chain that is not simulated [s].
_TIMES = np.linspace(0.0, 399.9, 4000)
COARSE = ChainSetting(links=16, share=5e-3, error={"vertical": 0.01})


def _value(table: pd.DataFrame, quantity: str, column: str) -> float:
    return float(table.loc[table["quantity"] == quantity, column].iloc[0])


@pytest.fixture(scope="module")
def waves() -> Spectrum:
    return SeaState(height=2.0, peak_period=9.0).spectrum(points=60)


@pytest.fixture(scope="module")
def swell() -> Rao:
    omega = np.linspace(0.1, 6.0, 60)
    one = np.ones(60)
    return Rao(omega=omega, heave=0.8 * one, heave_phase=0.3 * one, surge=0.5 * one, surge_phase=-0.4 * one)


def test_a_drawn_sea_has_the_spectrum_and_other_phases_for_another_seed(waves: Spectrum) -> None:
    one, other = (sea_drawing.draw(waves, 900.0, np.random.default_rng(seed)) for seed in (1, 2))
    assert one.period >= 900.0
    first, second = (each.series(np.ones(each.t.size, dtype=complex)) for each in (one, other))
    assert np.std(first) == pytest.approx(waves.sigma, rel=2e-3)
    assert np.std(second) == pytest.approx(np.std(first), rel=1e-9)
    assert np.abs(np.corrcoef(first, second)[0, 1]) < 0.2
    assert sea_drawing.between(first, one.sample, float(waves.omega[0]) - 0.01) == pytest.approx(first, abs=1e-9)


def test_a_record_too_short_for_its_sea_is_refused(waves: Spectrum) -> None:
    with pytest.raises(InvalidInput, match=r"needs a record of at least \d+ s, but it is 60 s"):
        sea_drawing.draw(waves, 60.0, np.random.default_rng(1))


@pytest.mark.parametrize("direction", ["axial", "heave"])
def test_the_chain_s_top_moves_as_that_of_the_matrix_method(
    waves: Spectrum, swell: Rao, direction: Direction, configurations: Callable[[str], Tow]
) -> None:
    tow = replace(configurations("autec-1200"), speed=1.0)
    made = sea_response(
        tow,
        waves.omega,
        waves.density,
        motion=swell.motion(waves.omega),
        direction=direction,
        segments=32,
    )
    angle = float(made.response.shape.phi[-1])
    motion = sea_drawing.imposed_motion(waves.omega, direction, swell, angle)
    along = motion @ np.array([math.cos(angle), math.sin(angle)])
    assert along == pytest.approx(made.response.top, rel=1e-9)


def test_the_ship_sets_in_from_rest_and_runs_into_the_record(waves: Spectrum, swell: Rao) -> None:
    drawing = sea_drawing.draw(waves, 300.0, np.random.default_rng(3))
    position = drawing.series(sea_drawing.imposed_motion(drawing.omega, "heave", swell, 1.0))
    ship = sea_drawing.ship_trace(drawing, position, 2.0, 100.0)
    moved = ship.position - np.outer(2.0 * ship.t, [1.0, 0.0, 0.0])
    assert moved[0] == pytest.approx(np.zeros(3), abs=1e-12)
    assert moved[-drawing.t.size :, [0, 2]] == pytest.approx(position, abs=1e-9)
    before = ship.t.size - drawing.t.size
    assert moved[before // 2 + 1 : before, 2] == pytest.approx(position[before // 2 + 1 - before :, 1], abs=1e-9)
    assert np.std(moved[: before // 8, 2]) < 0.1 * np.std(position[:, 1])


def test_the_scatter_of_a_record_s_rms_is_that_of_a_normal_process() -> None:
    tow = load("autec-1200").tow
    omega = np.linspace(0.5, 0.9, 41)
    made = sea_response(tow, omega, np.ones(41), direction="heave", segments=16, companion=False)
    expected = sea_drawing.sampling_error(made, "top", 1000.0)
    assert expected == pytest.approx(math.sqrt(0.5 * math.pi / (1000.0 * 0.4)), rel=1e-9)
    # The components of a record of 1000 s, with amplitudes of their own.
    rng, components = np.random.default_rng(4), round(0.4 * 1000.0 / (2.0 * math.pi))
    rms = np.sqrt(rng.exponential(size=(4000, components)).mean(axis=1))
    assert np.std(rms) / np.mean(rms) == pytest.approx(expected, rel=0.05)


def test_both_methods_agree_in_a_moderate_sea(waves: Spectrum, configurations: Callable[[str], Tow]) -> None:
    check = check_sea(configurations("autec-1200"), waves, duration=600.0, run_in=200.0, setting=COARSE)
    table = check.table
    assert _value(table, "top", "difference_percent") == pytest.approx(0.0, abs=0.3)
    for name in ("vertical", "tension_bottom", "tension_top"):
        assert abs(_value(table, name, "difference_percent")) < 6.0
        assert 1.0 < _value(table, name, "sampling_percent") < 15.0
        assert _value(table, name, "largest") == pytest.approx(_value(table, name, "expected"), rel=0.35)
    assert math.isnan(_value(table, "horizontal", "difference_percent"))
    assert 60 <= _value(table, "top", "crests") <= 120
    assert list(check.costs["method"]) == ["chain", "matrix, with its error", "matrix, once"]
    assert check.costs["ratio"].iloc[0] == 1.0
    assert check.costs["error_percent"].iloc[2] <= 0.5


def test_a_wrong_sea_is_found_out(waves: Spectrum, configurations: Callable[[str], Tow]) -> None:
    tow = configurations("autec-1200")
    check = check_sea(tow, waves, duration=300.0, run_in=100.0, setting=COARSE)
    wrong = sea_response(tow, waves.omega, 2.0 * waves.density, direction="heave")
    table = comparison(check.drawing, check.chain, wrong, COARSE, float(waves.omega[0]))
    assert _value(table, "top", "difference_percent") == pytest.approx(100.0 * (math.sqrt(0.5) - 1.0), abs=0.5)
    assert _value(table, "tension_top", "difference_percent") < -15.0


def test_the_first_harmonic_is_that_of_the_matrix_method(configurations: Callable[[str], Tow]) -> None:
    table = check_harmonics(configurations("autec-1200"), [0.5, 1.0], amplitude=1.0, links=24, cycles_before=15)
    assert set(table["omega_rad_s"]) == {0.5, 1.0}
    table = table[table["difference_percent"].notna() & (table["quantity"] != "top")]
    assert set(table["quantity"]) == {"vertical", "tension_bottom", "tension_top"}
    assert table["difference_percent"].abs().max() < 2.0
    assert table["phase_rad"].abs().max() < 0.05
    assert table["unsettled_percent"].max() < 1.0
    # Quadratic drag leaves higher harmonics behind, which no linear method has.
    assert table["harmonics_percent"].max() > 2.0


def test_a_level_body_never_pitches(configurations: Callable[[str], Tow]) -> None:
    assert level(configurations("autec-1200")) is None
    tow = load("s-shape-205").tow
    still = level(tow)
    assert still is not None
    pitches = [np.abs(frequency_response(each, [0.5], segments=128, companion=False).pitch[0]) for each in (tow, still)]
    assert pitches[0] > 1e-4
    assert pitches[1] < 1e-9


def test_tensions_are_those_of_the_ends_of_the_whole_cable(waves: Spectrum) -> None:
    tow = load("s-shape-205").tow
    drawing = sea_drawing.draw(waves, 200.0, np.random.default_rng(1))
    position = 0.01 * drawing.series(sea_drawing.imposed_motion(drawing.omega, "heave", None, 1.0))
    made = chain_record.chain_record(tow, drawing, position, 1.0, links=48, share=0.01, run_in=20.0)
    shape = frequency_response(tow, [0.5], segments=128, companion=False).shape
    assert made.rest["tension_bottom"] == pytest.approx(shape.T[0], rel=2e-3)
    assert made.rest["tension_top"] == pytest.approx(shape.T[-1], rel=2e-3)
    assert len(made.links) == 2


def test_a_tow_under_way_is_followed(waves: Spectrum, configurations: Callable[[str], Tow]) -> None:
    tow = replace(configurations("autec-1200"), speed=1.0)
    drawing = sea_drawing.draw(waves, 200.0, np.random.default_rng(1))
    position = 0.01 * drawing.series(sea_drawing.imposed_motion(drawing.omega, "heave", None, 1.0))
    made = chain_record.chain_record(tow, drawing, position, 1.0, links=24, share=0.01, run_in=50.0)
    assert np.abs(made.series["horizontal"]).max() < 0.02
    assert 0.003 < np.std(made.series["vertical"]) < 0.02


def test_a_vehicle_with_thrust_is_refused(waves: Spectrum) -> None:
    with pytest.raises(InvalidInput, match="knows no thrust"):
        check_sea(load("s-shape-205-thrust").tow, waves, duration=300.0, setting=COARSE)


def _fake(error: float, links: int, steps: int) -> ChainRecord:
    """A chain whose RMS errs by a share that falls at second order, `error` at 12 links."""
    size = 1.0 + error * (12.0 / links) ** 2
    return ChainRecord(
        series={"vertical": size * math.sqrt(2.0) * np.sin(2.0 * math.pi * 0.1 * _TIMES)},
        rest={},
        links=(links,),
        tolerance=0.01,
        steps=steps,
        slack=0,
        cpu=1.0,
        imposed=1.0,
    )


def test_links_are_doubled_until_the_error_is_small(waves: Spectrum) -> None:
    asked: list[tuple[int, float]] = []

    def record(drawing: sea_drawing.Drawing, links: int, share: float, run_in: float) -> ChainRecord:
        asked.append((links, share))
        return _fake(0.1, links, 10)

    def draw(period: float) -> sea_drawing.Drawing:
        return replace(sea_drawing.draw(waves, period, np.random.default_rng(1)), t=_TIMES)

    found = resolved(record, draw, 0.4, 10_800.0, 0.002)
    assert [links for links, _ in asked] == [12, 24, 48, 96]
    assert np.diff(np.log([share for _, share in asked])) == pytest.approx(-math.log(8.0))
    assert found.links == 96
    assert found.error["vertical"] == pytest.approx(0.1 / 64.0, rel=0.05)


def test_links_stop_at_what_the_run_can_afford(waves: Spectrum) -> None:
    def record(drawing: sea_drawing.Drawing, links: int, share: float, run_in: float) -> ChainRecord:
        return _fake(0.1, links, 20_000)

    def draw(period: float) -> sea_drawing.Drawing:
        return replace(sea_drawing.draw(waves, period, np.random.default_rng(1)), t=_TIMES)

    found = resolved(record, draw, 0.4, 10_800.0, 1e-9)
    assert found.links == 24
    assert 24 * 20_000 * 10_800.0 / 700.0 < chain_record.BUDGET < 10 * 24 * 20_000 * 10_800.0 / 700.0


def test_what_hardly_moves_is_not_compared() -> None:
    record = replace(_fake(0.0, 12, 1), rest={"tension_top": 1000.0})
    assert moves("tension_top", 10.0, record)
    assert not moves("tension_top", 2.0, record)
    assert moves("vertical", 0.01, record)
    assert not moves("vertical", 0.001, record)


@pytest.fixture(scope="module")
def seaway() -> Seaway:
    state = sea_state(5)
    return Seaway(
        configuration=load("swath-4000"), height=state.height, spectrum=state.spectrum(points=60), rao=read_rao(SWATH)
    )


def test_the_compensator_s_balance_holds_in_the_time_domain(seaway: Seaway) -> None:
    setting = Setting(stiffness=100.0, damping=3160.0)
    check = check_compensated(seaway, setting, duration=900.0, run_in=200.0, chain_setting=COARSE)
    assert check.settled
    assert check.history["correction_percent"].iloc[-1] <= 100.0 * SETTLED < check.history["correction_percent"].iloc[0]
    table = check.table
    for name in ("top", "relative", "vertical", "tension_bottom", "tension_top"):
        assert abs(_value(table, name, "difference_percent")) < 8.0
    # m p'' + T~ + b R' + k R = 0, by differences of the series themselves.
    series, n = check.chain.series, check.chain.series["top"].size
    sample = sea_drawing.draw(seaway.spectrum, 900.0, np.random.default_rng(1)).sample
    omega = 2.0 * math.pi * np.fft.rfftfreq(n, sample)

    def derived(values: np.ndarray, times: int) -> np.ndarray:
        return np.asarray(np.fft.irfft((1j * omega) ** times * np.fft.rfft(values), n))

    pull = series["tension_top"] - series["tension_top"].mean()
    mass = seaway.configuration.compensator.mass
    force = mass * derived(series["top"], 2) + 3160.0 * derived(series["relative"], 1) + 100.0 * series["relative"]
    left = sea_drawing.between(pull + force, sample, 0.0, 1.5)
    assert np.std(left) < 0.03 * np.std(pull)


def test_a_locked_compensator_has_nothing_to_solve_for(seaway: Seaway) -> None:
    with pytest.raises(InvalidInput, match="locked compensator"):
        check_compensated(seaway, LOCKED, duration=900.0)


def _quiet(stage: str, fraction: float) -> None:
    """No progress."""


def test_the_sea_study_shows_the_time_domain(tmp_path: Path) -> None:
    folder = tmp_path / "sea"
    settings = {"spectrum": "bretschneider", "height": 2.0, "peak_period": 9.0, "duration": 600.0, "points": 60}
    sea(load("autec-1200"), **settings, time_domain=True, seed=7, out=folder, progress=_quiet)  # type: ignore[arg-type]
    table, costs = (pd.read_csv(folder / f"time-domain{ending}.csv") for ending in ("", "-costs"))
    sigma = pd.read_csv(folder / "sea.csv").set_index("quantity")["sigma"]
    assert _value(table, "tension_top", "sigma") == pytest.approx(float(sigma["tension_top"]), rel=1e-6)
    assert json.loads((folder / "manifest.json").read_text())["seed"] == 7
    harmonics = pd.read_csv(folder / "time-domain-harmonics.csv")
    assert _value(harmonics, "top", "amplitude_m") == pytest.approx(
        math.sqrt(2.0) * _value(table, "top", "rms"), rel=1e-3
    )
    page = (folder / "report.md").read_text()
    told = re.search(r"RMS and sigma differ by up to ([\d.]+) %", page)
    assert told is not None
    compared = table.loc[(table["quantity"] != "top"), "difference_percent"].abs()
    assert float(told.group(1)) == pytest.approx(float(compared.max()), abs=0.051)
    assert "drawn with the seed 7" in page
    assert costs["settings"].iloc[0] in page


def test_the_compensator_study_shows_the_time_domain(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    short = partial(time_domain.of_compensator, duration=600.0, run_in=120.0, setting=COARSE)
    monkeypatch.setattr(time_domain, "of_compensator", short)
    folder = tmp_path / "compensator"
    compensator(load("swath-4000"), sea_state=5, time_domain=True, seed=2, out=folder, progress=_quiet)
    table, runs = (pd.read_csv(folder / f"time-domain{ending}.csv") for ending in ("", "-runs"))
    assert set(table["strategy"]) == set(time_domain.STRATEGIES)
    assert list(runs["strategy"]) == ["tuned-stiffness", "tuned-damping"]
    assert runs["settled"].all()
    assert table["difference_percent"].abs().max() < 12.0
    page = (folder / "report.md").read_text()
    assert "the compensator's balance is solved by running it over" in page
    assert "tuned-damping" in page.split("## Against the time domain")[1]


def test_without_being_asked_no_time_domain_is_shown(tmp_path: Path) -> None:
    folder = tmp_path / "sea"
    sea(
        load("autec-1200"),
        spectrum="bretschneider",
        height=2.0,
        peak_period=9.0,
        points=30,
        segments=32,
        out=folder,
        progress=_quiet,
    )
    assert not list(folder.glob("time-domain*"))
    assert "Against the time domain" not in (folder / "report.md").read_text()
