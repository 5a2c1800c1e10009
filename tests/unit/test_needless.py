"""What a configuration asks for without a measurable effect: found with its figure, and nothing else."""

from dataclasses import replace

import pytest

from ident.configuration import Configuration, builtin_text, load
from ident.leaving_out import needless as module
from ident.leaving_out.needless import needless
from ident.truth import identification_ship
from models.quantity import NumericalFailure
from reports.leaving_out import suggest
from reports.markdown import Page

HARMONICS = 9


def configured(more: str = "", name: str = "autec-1200") -> Configuration:
    return Configuration.from_text(f"{builtin_text(name)}\n{more}", name, name)


def keys(configuration: Configuration) -> list[str]:
    return [each.key for each in needless(configuration, identification_ship(configuration, 1), HARMONICS)]


def current(*speeds: float) -> str:
    depths = [400.0 * i for i in range(len(speeds))]
    return f"[current]\ndepth_m = {depths}\nspeed_m_s = {list(speeds)}\n"


@pytest.mark.parametrize(("speed", "found"), [(1e-4, True), (0.05, False)])
def test_a_current_too_weak_to_matter_is_named(speed: float, found: bool) -> None:
    assert ("current" in keys(configured(current(speed)))) == found


@pytest.mark.parametrize(
    ("speeds", "found"), [((0.1, 0.1001), True), ((0.1, 0.2), False), ((0.1,), False)], ids=["flat", "sheared", "one"]
)
def test_a_profile_that_is_flat_is_named(speeds: tuple[float, ...], found: bool) -> None:
    assert ("current.depth_m" in keys(configured(current(*speeds)))) == found


def test_terms_without_effect_are_named_where_they_are_given() -> None:
    asked = configured()
    assert keys(asked) == ["cable.tangential_drag_coefficient", "cable.axial_damping_s"]
    assert keys(replace(asked, given=())) == []


@pytest.mark.parametrize("change", ["velocity", "position", "tension"])
def test_each_of_the_three_changes_keeps_a_term(change: str, monkeypatch: pytest.MonkeyPatch) -> None:
    changes = {"velocity": 0.0, "position": 0.0, "tension": 0.0}
    monkeypatch.setattr(module, "_change", lambda one, other: tuple(changes.values()))
    asked = configured()
    assert keys(asked)
    changes[change] = {"velocity": 2e-4, "position": 50.0, "tension": 2e-3}[change]
    assert keys(asked) == []


def test_strumming_and_pitch_are_kept_where_they_matter() -> None:
    strums = configured("[link-joint]\nstrumming = true\n")
    assert [key for key, *_ in module._terms(strums)][-1] == "link-joint.strumming"
    assert "link-joint.strumming" not in keys(strums)
    assert "towfish" not in keys(load("swath-4000"))


def test_what_cannot_do_without_a_term_keeps_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(*_: object) -> tuple[float, float, float]:
        raise NumericalFailure("slack")

    monkeypatch.setattr(module, "_change", failing)
    assert keys(configured()) == []


def test_the_page_tells_the_figure() -> None:
    asked = configured(current(1e-4))
    first = needless(asked, identification_ship(asked, 1), HARMONICS)[0]
    assert 0.0 < first.velocity < 1e-4
    page = Page("run")
    suggest(page, [(first.key, first.words)])
    assert "`current`: in 1800 s of the identification record" in page.text
    assert "leave the section out" in page.text
    before = page.text
    suggest(page, [])
    assert page.text == before
