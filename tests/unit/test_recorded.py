"""Records from files as cases: blank cells, records without noise, and the deep-tow files."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from data_synth.records import Record, write_record
from data_synth.ships import StandardInput, standard_input
from ident.configuration import load
from ident.learning import fit
from ident.recorded import recorded_case
from models import reduced
from models.drive import Drive
from models.quantity import InvalidInput
from models.reduced import ReducedModel
from models.statics import static_shape
from models.trace import Trace

TOW_FILES = Path(__file__).resolve().parents[2].parent / "shared" / "records" / "deep-tow-camera"
SHIP = standard_input(StandardInput(duration=900.0), np.random.default_rng(1))


def model() -> ReducedModel:
    tow = load("autec-1200").tow
    return reduced.section("massless-2-quadratic", tow, static_shape(tow))


def written(path: Path, *, every: int = 1, angle: float = 0.0) -> Path:
    """The record of a ship and of a reduced model behind it, the vehicle's cells blank but for every so many."""
    track = reduced.simulate(model(), SHIP).position.copy()
    track[np.arange(len(SHIP)) % every != 0] = np.nan
    turn = np.array([[np.cos(angle), np.sin(angle), 0.0], [-np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    ship = Trace(t=SHIP.t, position=SHIP.position @ turn)
    write_record(Record(name="tow", ship=ship, vehicle=Trace(t=SHIP.t, position=track @ turn)), path)
    return path


@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_fixes_between_blank_cells_fit(tmp_path: Path, angle: float) -> None:
    """The same operator goes over the record and over the model: the model it was made with is left without error."""
    path = written(tmp_path / "tow.csv", every=10, angle=angle)
    assert ",," in path.read_text().splitlines()[2]
    case = recorded_case(path, settle=300.0, window=90.0, start="rest").case
    assert case.name == "tow.csv"
    assert case.velocity_reading is not None
    assert np.diff(case.time) == pytest.approx(10.0)
    assert case.time[[0, -1]].tolist() == [300.0, 850.0]
    np.testing.assert_allclose(case.residual(reduced.respond(model(), case.drive)), 0.0, atol=1e-9)
    known = [parameter.value for parameter in reduced.parameters(model())]
    off = reduced.with_values(model(), [1.3 * value for value in known])
    found = fit(off, [case], profile=False)
    assert [parameter.value for parameter in reduced.parameters(found.model)] == pytest.approx(known, rel=1e-3)


def test_a_window_of_zero_compares_with_the_records_own_derivative(tmp_path: Path) -> None:
    case = recorded_case(written(tmp_path / "tow.csv"), settle=300.0, window=0.0, start="rest").case
    assert case.velocity_reading is None
    assert case.time.size == 601
    exact = reduced.simulate(model(), SHIP).velocity
    assert exact is not None
    error = case.velocity - exact[300:, 0]  # a massless model's velocity has kinks where it reverses
    assert float(np.median(np.abs(error))) < 1e-6
    assert float(np.sqrt(np.mean(error**2))) < 1e-3
    smoothed = recorded_case(tmp_path / "tow.csv", settle=300.0, window=90.0, start="rest").case
    late = np.searchsorted(case.time, smoothed.time)
    assert np.abs(smoothed.velocity - case.velocity[late]).max() > 1e-3


def test_a_longer_settling_time_scores_less(tmp_path: Path) -> None:
    path = written(tmp_path / "tow.csv", every=10)
    early, late = (recorded_case(path, settle=settle, window=90.0, start="rest").case for settle in (0.0, 400.0))
    assert early.time[0] == 50.0
    assert late.time[0] == 400.0
    with pytest.raises(InvalidInput, match="at least 20 scored samples"):
        recorded_case(path, settle=800.0, window=90.0, start="rest")


def test_the_start_is_handed_on(tmp_path: Path) -> None:
    path = written(tmp_path / "tow.csv")
    rest, steady = (recorded_case(path, settle=0.0, window=0.0, start=start).case.drive for start in ("rest", "steady"))
    assert rest.start_speed == 0.0
    assert steady.start_speed == pytest.approx(float(SHIP.at(60.0)[0]) / 60.0)
    assert isinstance(steady, Drive)


def test_a_record_without_a_vehicle_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "ship.csv"
    write_record(Record(name="ship", ship=SHIP), path)
    for window in (0.0, 90.0):
        with pytest.raises(InvalidInput, match="no vehicle"):
            recorded_case(path, settle=0.0, window=window, start="rest")
    with pytest.raises(InvalidInput, match="10 vehicle fixes"):
        recorded_case(written(tmp_path / "few.csv", every=100), settle=0.0, window=90.0, start="rest")


def test_what_is_no_record_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "none.csv"):
        with pytest.raises(InvalidInput, match=path.name):
            recorded_case(path, settle=0.0, window=90.0, start="rest")


def test_deep_tow_files_are_read_through_their_smoother() -> None:
    path = TOW_FILES / "060.CSV"
    if not path.exists():
        pytest.skip(f"the recorded tow is not at hand ({os.path.relpath(path)})")
    found = recorded_case(path, settle=0.0, window=90.0, start="steady")
    case, plane = found.case, found.planar
    assert plane.record.source == "deep-tow"
    assert case.name == "060.CSV"
    assert case.velocity_reading is not None
    assert case.position_reading is not None
    assert case.velocity_reading.constant.any()  # the share of the ship's velocity that the smoother lets through
    assert not plane.record.ship.position[:, 1].any()
    assert 0.3 < case.drive.start_speed < 0.8
    tow = load("deep-tow-camera").tow
    response = reduced.respond(reduced.section("massless-4-quadratic", tow, static_shape(tow)), case.drive)
    through = case.model_velocity(response)
    alone = replace(case, velocity_reading=None).model_velocity(response)
    assert np.isfinite(through).all()
    assert 1e-4 < float(np.sqrt(np.mean((through - alone) ** 2))) < 0.2
