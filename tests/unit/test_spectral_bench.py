"""What the benchmark of the spectral simulator rests on: the library's equations, its tolerances, and its rows."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ident.benchmark import spectral_bench, spectral_library, spectral_record
from ident.benchmark.bench_record import Record
from ident.benchmark.simulator_defaults import Kept, kept
from ident.benchmark.spectral_bench import CHOSEN, REDUCED, Setting, error_of, ship_of, velocity_of
from ident.benchmark.spectral_library import Equations, LibraryRun
from ident.configuration import load
from ident.timing import Timing
from models.quantity import InvalidInput
from models.spectral import simulate
from models.tow import Tow
from models.trace import Trace
from reports import spectral_bench as part
from reports.markdown import Page
from reports.style import Album

NAMES = ("mangus-740", "autec-1200", "mangus-2500")
TINY = replace(
    REDUCED, harmonics=(4, 8), tolerances=(1e-2, 1e-4), steps=(1.0,), growth_lengths=(50.0, 100.0), methods=("Radau",)
)


def ship(duration: float = 200.0) -> Trace:
    return ship_of(load("autec-1200").input, duration)


@pytest.mark.parametrize("name", NAMES)
def test_the_library_solves_the_equations_of_the_simulator(name: str, configurations: Callable[[str], Tow]) -> None:
    tow, track = replace(configurations(name), speed=0.3), ship()
    exact = simulate(tow, track, harmonics=6, tolerance=1e-8, stepper="runge-kutta")
    found, evaluations, seconds = Equations(tow, track, 6).solve("Radau", 1e-9, True)
    assert np.abs(found - velocity_of(exact)).max() < 1e-6
    assert np.ptp(found[:, 0]) > 0.01
    assert evaluations > 100
    assert seconds > 0.0


def test_the_jacobian_is_that_of_the_slopes(configurations: Callable[[str], Tow]) -> None:
    equations = Equations(configurations("mangus-2500"), ship(), 5)
    y = 0.3 * np.random.default_rng(2).standard_normal(equations.size)
    J = equations.jacobian(70.3, y)
    for k in range(y.size):
        d = 1e-5 * (np.arange(y.size) == k)
        central = (equations(70.3, y + d) - equations(70.3, y - d)) / 2e-5
        np.testing.assert_allclose(J[:, k], central, rtol=1e-4, atol=1e-5 * np.abs(J).max())


def test_a_towfish_has_no_constant_mass(table_two: Tow) -> None:
    with pytest.raises(InvalidInput, match="point body"):
        Equations(table_two, ship(), 4)


def library(power: float, floor: float = 0.0) -> Callable[[float], LibraryRun]:
    """A method whose error is a power of its tolerance."""

    def run(tolerance: float) -> LibraryRun:
        return LibraryRun(
            method="Radau",
            jacobian=False,
            tolerance=tolerance,
            error=3.0 * tolerance**power + floor,
            evaluations=1,
            timing=Timing(1.0, 0.0, 1),
        )

    return run


@pytest.mark.parametrize("asked", [3e-2, 1e-4, 2e-7])
@pytest.mark.parametrize("power", [0.7, 1.3])
def test_the_loosest_tolerance_that_just_meets_the_error(asked: float, power: float) -> None:
    found = spectral_library._loosest(library(power), asked)
    assert found.error <= asked
    looser = library(power)(found.tolerance * 1.5)
    assert looser.error > asked


def test_an_error_that_no_tolerance_meets_is_not_met() -> None:
    assert spectral_library._loosest(library(1.0, floor=1e-3), 1e-4).error > 1e-4


def test_an_integrator_that_fails_at_loose_tolerances() -> None:
    usual = library(1.0)

    def run(tolerance: float) -> LibraryRun:
        return replace(usual(tolerance), error=math.inf) if tolerance > 1e-4 else usual(tolerance)

    found = spectral_library._loosest(run, 1e-2)
    assert found.error <= 1e-2
    assert found.tolerance == pytest.approx(1e-4)


def test_the_last_run_errs_as_asked(configurations: Callable[[str], Tow]) -> None:
    tow, track = configurations("mangus-740"), ship()
    exact = velocity_of(simulate(tow, track, harmonics=5, tolerance=1e-8, stepper="runge-kutta"))
    runs = spectral_library.at_error(Equations(tow, track, 5), "BDF", exact, 1e-4)
    assert runs[-1].error <= 1e-4
    assert max(run.error for run in runs) > 1e-4
    velocity, _, _ = Equations(tow, track, 5).solve("BDF", runs[-1].tolerance, runs[-1].jacobian)
    again = float(np.sqrt(np.mean(np.sum((velocity - exact) ** 2, axis=1))))
    assert again == pytest.approx(runs[-1].error, rel=1e-6)


def test_a_setting_runs_as_it_says(configurations: Callable[[str], Tow]) -> None:
    tow, track = configurations("mangus-740"), ship()
    for stepper in ("implicit", "newmark", "runge-kutta"):
        run = Setting(stepper=stepper, harmonics=5, stations=21, accuracy=1.0).run(tow, track)
        assert (run.harmonics, run.stations, run.error) == (5, 21, None)
    newmark = Setting(stepper="newmark", harmonics=5, stations=21, accuracy=0.5)
    assert newmark.run(tow, track).steps == 400
    assert newmark.words == "newmark: 5 harmonics, 21 stations, 0.5 s"
    assert Setting(stepper=CHOSEN, harmonics=0, stations=0, accuracy=1e-3).run(tow, track).error is not None


def test_errors_fall_and_the_converged_run_is_better(configurations: Callable[[str], Tow]) -> None:
    found = spectral_bench.work_precision(configurations("mangus-740"), ship(), REDUCED)
    errors = {
        (each.setting.stepper, each.setting.harmonics, each.setting.accuracy): each.error for each in found.points
    }
    assert len(errors) == len(spectral_bench.settings_of(REDUCED))
    assert not found.failed
    assert errors["implicit", 8, 1e-2] > 4.0 * errors["implicit", 8, 1e-4]
    assert errors["newmark", 8, 2.0] > 2.0 * errors["newmark", 8, 1.0]
    assert errors["runge-kutta", 4, 1e-4] > 2.0 * errors["runge-kutta", 8, 1e-4]
    assert found.uncertainty < 0.5 * min(errors.values())
    assert [each.setting.stations for each in found.stations] == [17, 26, 52, 104]


def test_equal_error_is_of_the_steps_alone(configurations: Callable[[str], Tow]) -> None:
    tow, track = configurations("autec-1200"), ship()
    found = spectral_bench.libraries(tow, track, TINY)
    assert found.best["Radau"].error <= found.error
    assert found.uncertainty < 0.2 * found.error
    exact = simulate(tow, track, harmonics=found.harmonics, tolerance=1e-8, stepper="runge-kutta")
    assert found.error == pytest.approx(error_of(simulate(tow, track, harmonics=found.harmonics), exact))
    seconds = found.best["Radau"].timing.seconds
    assert found.ratio == pytest.approx(seconds / found.ours.seconds)


@pytest.mark.parametrize("name", NAMES)
def test_the_defaults_keep_what_they_ask_for(name: str) -> None:
    configuration, track = load(name), ship_of(load(name).input, 600.0)
    converged = simulate(configuration.tow, track, harmonics=40, tolerance=1e-6)
    rows = kept(configuration, track, converged, ship_of(configuration.input, 300.0))
    assert [each.simulator for each in rows] == ["spectral", "link-joint", "matrix"]
    for each in rows:
        assert each.met, each
        assert each.estimated <= each.asked
        # An estimate may be cautious, but not careless.
        assert 0.5 * each.found < each.estimated


def test_an_error_past_what_is_asked_is_not_met() -> None:
    assert not Kept(simulator="matrix", unit="m/s", asked=1e-3, estimated=1e-4, found=1.1e-3).met


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


def test_the_part_of_the_page(tmp_path: Path) -> None:
    run = Record(progress=quiet, budget=1000.0)
    material = spectral_record.measure(run, TINY, [load("mangus-740")])
    page, album = Page("Benchmark"), Album(tmp_path)
    part.write(page, album, material)
    for heading in ("Stations", "Library integrators", "What the defaults keep", "Growth of the spectral simulator"):
        assert heading in page.text
    for figure in ("spectral-precision", "spectral-libraries", "spectral-growth"):
        assert (tmp_path / "figures" / f"{figure}.png").stat().st_size > 1000
    rows = run.table().to_dict("records")
    assert {row["method"] for row in rows} == {"spectral", "solve_ivp Radau"}
    assert all(row["seconds_per_hour"] > 0.0 for row in rows)
    growth = [row for row in rows if row["error_kind"].startswith("growth")]
    assert len(growth) == 3 + 3 + 2
    assert len(run.targets) == 2
    assert not run.cut


def test_what_there_is_no_time_for_is_listed(tmp_path: Path) -> None:
    run = Record(progress=quiet, budget=0.0)
    material = spectral_record.measure(run, TINY, [load("mangus-740")])
    assert [what for what, _ in run.cut] == ["mangus-740 by the spectral simulator", "growth of the spectral simulator"]
    assert not run.rows
    page = Page("Benchmark")
    part.write(page, Album(tmp_path), material)
    assert "figures" not in page.text


def test_a_configuration_that_cannot_be_run_is_listed() -> None:
    run = Record(progress=quiet, budget=1000.0)
    spectral_record.measure(run, TINY, [load("mangus-740"), load("s-shape-205")])
    [(what, why)] = run.cut
    assert what == "s-shape-205 by the spectral simulator"
    assert "sections" in why
