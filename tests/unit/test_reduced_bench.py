"""What the benchmark of the reduced models rests on: the ship refined, libraries, searches, and real errors."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import approx_fprime

from data_synth.ships import SpeedChanges, speed_changes
from ident.benchmark import library_bench, library_integrators, reduced_bench, reduced_record, search_bench
from ident.benchmark.bench_record import Record
from ident.benchmark.library_bench import FLOOR, LibraryPoint
from ident.benchmark.library_integrators import IMPLICIT, METHODS, Method, TookTooLong
from ident.benchmark.reduced_bench import REDUCED, Point
from ident.configuration import load
from ident.timing import Timing
from models import reduced
from models.drive import MAX_STEP, Drive
from models.quantity import InvalidInput, NumericalFailure
from models.reduced import ReducedModel
from models.statics import static_shape
from models.tow import Tow
from reports import reduced_bench as section
from reports.markdown import Page
from reports.style import Album

CHAINS = tuple(f"{kind}-3-{law}" for kind in ("massless", "inertial") for law in ("linear", "quadratic"))
Tows = Callable[[str], Tow]


def ship(duration: float = 120.0, sample: float = 1.0, *, start: str = "rest") -> Drive:
    orders = SpeedChanges(duration=duration, sample=sample, times=(20.0, 60.0), speeds=(0.4, 0.1, 0.5), rise=20.0)
    return Drive.from_trace(speed_changes(orders), start="steady" if start == "steady" else "rest")


@pytest.fixture
def models(configurations: Tows) -> Callable[[str], ReducedModel]:
    tow = configurations("autec-1200")
    shape = static_shape(tow)
    return lambda name: reduced.section(name, tow, shape)


def test_a_refined_ship_moves_as_before() -> None:
    drive = ship()
    fine = reduced_bench.refined(drive, 5)
    assert fine.t.size == 5 * (drive.t.size - 1) + 1
    np.testing.assert_allclose(fine.u[::5], drive.u, atol=1e-12)
    np.testing.assert_allclose(fine.rates[::5], drive.rates, atol=1e-12)
    # Between its samples too: the position is the integral of the velocity, by Simpson's rule exact for a cubic.
    v = fine.rates[:, 0]
    middle = v[:-1] + 0.5 * np.diff(fine.t) * (fine.rates[:-1, 1] + 0.25 * np.diff(fine.t) * fine.rates[:-1, 2])
    np.testing.assert_allclose(np.diff(fine.u), np.diff(fine.t) * (v[:-1] + 4.0 * middle + v[1:]) / 6.0, atol=1e-12)


def test_a_repeated_ship_goes_on_from_where_it_ended() -> None:
    drive = ship()
    long = reduced_bench.repeated(drive, 3)
    assert long.t[-1] == pytest.approx(3.0 * drive.t[-1])
    assert long.u[-1] == pytest.approx(3.0 * drive.u[-1])
    assert np.abs(np.diff(long.u)).max() == pytest.approx(np.abs(np.diff(drive.u)).max())


def test_a_record_too_short_is_refused() -> None:
    with pytest.raises(InvalidInput, match="has 120 s"):
        reduced_bench.cut(ship(), 200.0)
    assert reduced_bench.cut(ship(), 60.0).t[-1] == 60.0


@pytest.mark.parametrize("start", ["rest", "steady"])
@pytest.mark.parametrize("name", CHAINS)
def test_a_library_answers_as_the_model_does(models: Callable[[str], ReducedModel], name: str, start: str) -> None:
    model, drive = models(name), ship(start=start)
    given = library_integrators.problem(model.chain(), model.drag, drive)
    fine = reduced_bench.stepped(drive, 1.0 / 32.0)
    own = reduced.respond(model, fine).velocity
    assert np.ptp(own) > 0.01
    theirs = library_integrators.velocity(given, "LSODA", 1e-9)
    assert np.abs(theirs - own).max() < (1e-7 if name.endswith("linear") else 1e-4)


@pytest.mark.parametrize("name", CHAINS)
def test_the_derivatives_are_those_of_the_right_hand_side(models: Callable[[str], ReducedModel], name: str) -> None:
    model = models(name)
    given = library_integrators.problem(model.chain(), model.drag, ship())
    rest = (given.values, given.quadratic, given.ship, given.begin, given.interval)
    y = given.start + np.random.default_rng(0).uniform(-0.5, 0.5, given.start.size)
    found = library_integrators._slopes(70.3, y, *rest)
    numeric = approx_fprime(y, lambda state: library_integrators._rates(70.3, state, *rest), 1e-7)
    np.testing.assert_allclose(found, numeric, atol=1e-4 * np.abs(numeric).max())


@pytest.mark.parametrize("method", METHODS)
def test_every_integrator_converges(models: Callable[[str], ReducedModel], method: Method) -> None:
    model, drive = models("inertial-3-quadratic"), ship()
    given = library_integrators.problem(model.chain(), model.drag, drive)
    own = reduced.respond(model, reduced_bench.stepped(drive, 1.0 / 64.0)).velocity
    loose, tight = (
        reduced_bench.rms(library_integrators.velocity(given, method, each, jacobian=method in IMPLICIT) - own)
        for each in (1e-2, 1e-6)
    )
    assert tight < 0.01 * loose
    assert tight < 1e-5


def test_an_integrator_is_stopped_at_its_limit(models: Callable[[str], ReducedModel]) -> None:
    model = models("massless-3-quadratic")
    given = library_integrators.problem(model.chain(), model.drag, ship(1200.0))
    with pytest.raises(TookTooLong, match=r"stopped after 0 s of CPU time, at t = "):
        library_integrators.velocity(given, "RK45", 1e-8, limit=0.0)


def test_a_library_refuses_a_ship_sampled_unevenly(models: Callable[[str], ReducedModel]) -> None:
    model, drive = models("massless-3-linear"), ship()
    keep = np.arange(drive.t.size) != 50
    uneven = replace(drive, t=drive.t[keep], u=drive.u[keep], rates=drive.rates[keep])
    with pytest.raises(InvalidInput, match="1 to 2 s"):
        library_integrators.problem(model.chain(), model.drag, uneven)


def test_the_errors_of_the_steps_are_real_and_estimated(models: Callable[[str], ReducedModel]) -> None:
    model = models("inertial-3-quadratic")
    found = reduced_bench.precision("inertial-3-quadratic", model, ship(), REDUCED)
    assert [point.step for point in found.points] == [1.0, 0.5, 0.25]
    assert found.usual.step == MAX_STEP == 0.5
    usual = reduced.respond(model, ship()).velocity
    assert found.usual.error == pytest.approx(reduced_bench.rms(usual - found.converged), rel=1e-12)
    errors = [point.error for point in found.points]
    assert errors == sorted(errors, reverse=True)
    assert 0.0 < found.uncertainty < 0.02 * errors[-1]
    slow = replace(model, vehicle_drag=50.0, cable_drag=1.0)
    orders = reduced_bench.observed_order(reduced_bench.precision("", slow, ship(), REDUCED).points)
    assert 3.5 < orders[-1] < 4.5, orders


def test_linear_models_are_exact_but_for_the_delay(models: Callable[[str], ReducedModel]) -> None:
    [chain] = reduced_bench.precision("", models("inertial-3-linear"), ship(), REDUCED).points
    [delayed] = reduced_bench.precision("", models("second-order-linear"), ship(), REDUCED).points
    assert chain.error < 1e-13
    # The delayed answer is interpolated between the ship's samples.
    assert 1e-13 < delayed.error < 1e-6


def test_the_tolerance_just_meets_the_error(models: Callable[[str], ReducedModel]) -> None:
    model, drive = models("inertial-3-quadratic"), ship(600.0)
    found = reduced_bench.precision("inertial-3-quadratic", model, drive, REDUCED)
    compared = library_bench.compare(found, drive, ("RK45", "LSODA"), repetitions=1)
    assert compared.wanted == pytest.approx(max(found.usual.error, FLOOR))
    assert all(each.reached for each in compared.met)
    for each in compared.met:
        assert each.point.error <= compared.wanted
        looser = [run for run in compared.runs if run.method == each.point.method and run.error > compared.wanted]
        assert each.point.tolerance < min(run.tolerance for run in looser) <= 10.001 * each.point.tolerance
    assert compared.fastest in [each.point for each in compared.met]
    assert compared.ratio == pytest.approx(compared.fastest.timing.seconds / compared.own.seconds)
    assert compared.apart < 0.1 * compared.wanted


def test_ratios_are_between_the_runs_of_the_libraries(models: Callable[[str], ReducedModel]) -> None:
    model = models("inertial-3-quadratic")
    found = reduced_bench.precision("", model, ship(), REDUCED)
    points = [Point(step=s, usual=s == 0.5, error=e, timing=Timing(1.0, 0.0, 1)) for s, e in ((1.0, 1e-3), (0.5, 1e-5))]
    runs = [
        LibraryPoint(method="LSODA", jacobian=False, tolerance=e, error=e, timing=Timing(t, 0.0, 1))
        for e, t in ((1e-4, 10.0), (1e-6, 40.0), (1e-5, 90.0))
    ]
    compared = library_bench.Comparison(
        precision=replace(found, points=points), wanted=1e-5, own=Timing(1.0, 0.0, 1), runs=runs, met=[], apart=0.0
    )
    assert compared.ratios() == pytest.approx([10.0, 20.0])
    with pytest.raises(NumericalFailure, match="1e-05 m/s"):
        assert compared.fastest
    lost = replace(points[1], error=1e-7 if FLOOR > 1e-7 else 1e-8)
    compared = replace(compared, precision=replace(found, points=[lost]), runs=runs[:1])
    assert np.isnan(compared.ratios()).all()


def test_the_search_once_is_the_beginning_of_the_search_with_restarts(models: Callable[[str], ReducedModel]) -> None:
    configuration = load("autec-1200")
    short = replace(configuration, input=replace(configuration.input, duration=1200.0, segment=300.0))
    cases = [search_bench.record_of(short)]
    once, full, plain = search_bench.descents("", models("massless-3-quadratic"), cases, off=3.0)
    assert len(full.starts) >= 2
    assert once.best.size == full.starts[1] < full.best.size
    np.testing.assert_array_equal(once.best, full.best[: once.best.size])
    for each in (once, full, plain):
        assert each.ended
        assert each.found < 0.5 * each.best[0]
        assert (np.diff(each.best) <= 0.0).all()
        assert (np.diff(each.seconds) >= 0.0).all()
    assert full.found <= once.found
    assert full.found == pytest.approx(plain.found, rel=1e-3)
    [_, cut, _] = search_bench.descents("", models("massless-3-quadratic"), cases, off=3.0, budget=10)
    assert cut.best.size == 10
    assert not cut.ended


def quiet(stage: str, fraction: float) -> None:
    """No progress."""


def test_the_part_of_the_page(tmp_path: Path) -> None:
    run = Record(progress=quiet, budget=1000.0)
    material = reduced_record.measure(run, REDUCED, [load("autec-1200")])
    rows = run.table().to_dict("records")
    names = {row["method"] for row in rows}
    assert set(reduced_bench.names(REDUCED.links)) <= names
    assert {"solve_ivp RK45", "solve_ivp LSODA"} <= names
    assert all(row["seconds_per_hour"] > 0.0 for row in rows)
    assert len(run.targets) == len(reduced_record.TIMES)
    page = Page("x")
    section.write(page, Album(tmp_path), material)
    for heading in ("Reduced models", "Against the integrators", "Growth of the reduced", "What an identification"):
        assert heading in page.text
    for figure in ("precision", "libraries", "growth", "identification"):
        assert (tmp_path / "figures" / f"reduced-{figure}.png").stat().st_size > 1000


def test_what_has_no_time_is_listed() -> None:
    run = Record(progress=quiet, budget=0.0)
    material = reduced_record.measure(run, REDUCED, [load("autec-1200")])
    assert not run.rows
    assert not run.targets
    assert not len(material.precision)
    assert [what for what, _ in run.cut] == [
        "autec-1200: the reduced models",
        "autec-1200: growth of the reduced models",
        "autec-1200: the record to identify",
    ]
