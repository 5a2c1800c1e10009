"""What is said of a scene that leaves a term out: equal to the full model at zero, what is saved, what it would err."""

import math
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ident.benchmark import leaving_out
from ident.benchmark.bench_record import Record
from ident.benchmark.leaving_out import EQUAL, REDUCED
from ident.configuration import load
from ident.leaving_out import scenes as leaving_out_scenes
from ident.leaving_out.case import NOTHING, Case, apart, difference, measure, table
from ident.leaving_out.idle_operations import Noticing, spent
from ident.leaving_out.responses import by_reduced
from ident.leaving_out.scenes import Scene, by_chain, by_spectral, on_course, step_scene
from models import link_joint
from models.current import Current
from models.link_joint.chain import build
from models.towed_system import TowedSystem
from reports.leaving_out import LeavingOutMaterial, write
from reports.markdown import Page


@pytest.fixture(scope="module")
def cases() -> list[Case]:
    return leaving_out.cases(REDUCED)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return step_scene("autec-1200", 0.1)


def made(**fields: object) -> Case:
    """A case of two samples of one velocity."""

    def answer(value: float) -> object:
        return lambda: {"velocity": np.array([[value], [2.0]]), "tension": np.array([100.0, value])}

    forms = {"off": answer(1.0), "zero": answer(1.0 + 1e-6), "on": answer(4.0)}
    return Case(**({"scene": "s", "simulator": "m", "term": "t", "strength": ""} | forms | fields))  # type: ignore[arg-type]


def test_a_scene_without_a_term_equals_the_full_model_with_it_at_zero(cases: list[Case]) -> None:
    found = {
        (case.simulator, case.term): apart((case.same_off or case.off)(), (case.same_zero or case.zero)())
        for case in cases
        if case.zero is not None
    }
    assert len(found) > 20
    assert {name: value for name, value in found.items() if value > EQUAL} == {}


def test_every_term_does_something_where_it_is_on(cases: list[Case]) -> None:
    for case in cases:
        assert difference((case.beside or case.off)(), case.on())[0] > 1e-8, (case.simulator, case.term)


def test_a_term_that_is_not_at_zero_is_seen(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    for small in (NOTHING, 1e-6):
        monkeypatch.setattr(leaving_out_scenes, "NOTHING", small)
        for case in (*by_spectral(scene), *by_chain(scene)):
            if case.term in ("tangential drag", "current", "third axis"):
                assert case.zero is not None
                found = apart((case.same_off or case.off)(), (case.same_zero or case.zero)())
                assert (found <= EQUAL) == (small == NOTHING), (case.simulator, case.term)


def test_the_chain_builds_no_current_that_is_off(scene: Scene) -> None:
    system = TowedSystem.from_tow(scene.tow)
    for speed, size in ((0.0, 0), (NOTHING, 1)):
        assert build(replace(system, current=Current.uniform(speed)), 8).chain.current_depth.size == size


def test_a_planar_scene_stays_in_its_plane(scene: Scene) -> None:
    system = TowedSystem.from_tow(scene.tow)
    found = link_joint.simulate(system, scene.ship, links=8, start="rest", companion=False)
    assert not found.vehicle.position[:, 1].any()
    third = next(case for case in by_chain(scene) if case.term == "third axis")
    assert third.zero is not None
    assert apart(third.off(), third.zero()) <= EQUAL
    turned = link_joint.simulate(system, on_course(scene.ship), links=8, start="rest", companion=False)
    assert turned.vehicle.position[:, 1].any()


def test_a_rigid_chain_is_the_limit_of_a_stiff_one(scene: Scene) -> None:
    case = next(each for each in by_chain(scene) if each.term == "elasticity")
    cable = scene.tow.cable
    stiffer = replace(
        scene, tow=replace(scene.tow, cable=replace(cable, axial_stiffness=100.0 * cable.axial_stiffness))
    )
    again = next(each for each in by_chain(stiffer) if each.term == "elasticity")
    assert difference(again.off(), again.on())[0] < 0.1 * difference(case.off(), case.on())[0]


def test_a_chain_with_mass_takes_more_steps(scene: Scene) -> None:
    mass = next(each for each in by_reduced(scene) if each.term == "mass")
    assert mass.zero is not None
    assert apart(mass.off(), mass.zero()) > EQUAL


def test_a_row_says_what_was_found() -> None:
    arrays = {
        "built_off": lambda: [np.zeros(3), np.ones(2)],
        "built_on": lambda: [np.ones(3), np.ones(2), np.ones(5)],
    }
    row = measure(made(**arrays), 1)
    assert row.apart == pytest.approx(1e-6 / 2.0)
    assert row.error == pytest.approx(3.0 / math.sqrt(2.0))
    assert row.error_unit == "m/s RMS"
    assert (row.built, row.idle) == (40, 24)


def test_what_has_no_form_at_zero_has_no_difference() -> None:
    row = measure(made(zero=None), 1)
    assert math.isnan(row.apart)
    assert math.isnan(row.seconds_zero)
    assert row.error > 0.0


def test_forms_on_the_same_steps_and_beside_are_taken_where_given() -> None:
    form = made()
    row = measure(made(same_zero=form.off, beside=form.on), 1)
    assert row.apart == 0.0
    assert row.error == 0.0


def test_velocities_are_compared_as_vectors() -> None:
    one, other = {"velocity": np.zeros((4, 3))}, {"velocity": np.full((4, 3), 2.0)}
    error, unit = difference(one, other)
    assert error == pytest.approx(2.0 * math.sqrt(3.0))
    assert unit == "m/s RMS"


def test_amplitudes_are_compared_over_the_largest() -> None:
    one, other = {"motion": np.array([2.0 + 0.0j, 0.1])}, {"motion": np.array([2.0 + 0.0j, 0.1 + 0.4j])}
    error, unit = difference(one, other)
    assert error == pytest.approx(0.2)
    assert unit == "of the largest amplitude"
    assert apart({"y": np.zeros(3)}, {"y": np.full(3, 1e-9)}) == 1e-9


def test_a_term_that_changes_the_scene_misses_the_target(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(leaving_out, "cases", lambda effort: [made(), made(zero=None)])
    run = Record(progress=lambda what, share: None, budget=1e3)
    material = leaving_out.record(run, REDUCED)
    assert [target["met"] for target in run.targets] == [False]
    page = Page("bench")
    write(page, material)
    assert "5e-07" in page.text
    assert "2.1 m/s RMS" in page.text
    assert re.search(r"\| link-joint \| third axis +\| +4\d\.\d \| +0\.0 \|", page.text)


def test_no_time_leaves_the_part_out() -> None:
    run = Record(progress=lambda what, share: None, budget=0.0)
    material = leaving_out.record(run, REDUCED)
    assert [what for what, _ in run.cut] == ["what scenes leave out"]
    page = Page("bench")
    before = page.text
    write(page, material)
    assert page.text == before


def test_the_page_has_a_table_a_simulator() -> None:
    rows = table([measure(made(simulator=name, note="so it is"), 1) for name in ("one", "other")])
    page = Page("bench")
    write(page, LeavingOutMaterial(words=["Words."], table=rows))
    assert page.text.count("| left out |") == 2
    assert "### one" in page.text
    assert "Operations" not in page.text
    assert "* **t**: so it is" in page.text


@pytest.mark.parametrize(
    ("work", "idle"),
    [
        (lambda x, o: x + o, 1),
        (lambda x, o: x * x, 0),
        (lambda x, o: 0.0 - x, 1),
        (lambda x, o: 1j * o, 2),
        (lambda x, o: (1.0 + 1j * x) * o, 2),
        (lambda x, o: x / 2.0 + x, 0),
        (lambda x, o: np.array([x, o], dtype=object) * x, 1),
        (lambda x, o: abs(x * o) - x, 2),
    ],
)
def test_operations_on_zeros_are_noticed(work: Callable[[Noticing, Noticing], object], idle: int) -> None:
    tally: Counter[str] = Counter()
    work(Noticing(3.0, tally), Noticing(0.0, tally))
    assert tally["idle"] == idle


def test_what_is_off_is_spared_or_idle() -> None:
    found = {(each.simulator, each.term): (each.spared, each.idle) for each in spent(load("autec-1200").tow)}
    # Branches spare the whole of a current to the chain, and the bend and the moved angle to the sines.
    assert found["link-joint", "current"][0] > 0.01
    assert found["link-joint", "current"][1] == 0.0
    assert found["spectral", "current"][0] > 0.3
    # The plane spares all of the third axis, which is near to half of a stage.
    assert found["link-joint", "third axis"][0] > 0.4
    assert found["link-joint", "third axis"][1] == 0.0
    # What has no branch is done on zeros.
    assert found["matrix", "current"][1] > 0.05
    assert all(idle < 0.12 for _, idle in found.values())
