"""The records of a run: what the seed draws, what the configuration asks for, and how a tow starts."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from data_synth import inputs
from data_synth.ships import FewSinusoids, SharpTransients, StartsAndStops
from ident import truth
from ident.configuration import Configuration, load
from models import link_joint
from models.current import Current
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.trace import Trace

CHANGED = ("cable normal drag", "cable added mass", "vehicle drag", "vehicle added mass")


def short(name: str = "autec-1200") -> Configuration:
    own = load(name)
    return replace(own, manoeuvre=replace(own.manoeuvre, duration=600.0), input=replace(own.input, duration=600.0))


@cache
def checked(seed: int) -> truth.Verification:
    return truth.verification(short(), seed)


def test_a_seed_gives_the_same_records_again() -> None:
    again, before = truth.verification(short(), 3), checked(3)
    assert again.changes == before.changes
    np.testing.assert_array_equal(again.truth.position, before.truth.position)
    np.testing.assert_array_equal(
        truth.fixes(short(), again.truth, 3).position, truth.fixes(short(), before.truth, 3).position
    )
    np.testing.assert_array_equal(again.in_current.position, before.in_current.position)
    one, two = (truth.identification_ship(short(), 3).position for _ in range(2))
    np.testing.assert_array_equal(one, two)


def test_another_seed_gives_other_records() -> None:
    ships = [truth.identification_ship(short(), seed).position[:, 0] for seed in (0, 1)]
    assert np.abs(ships[0] - ships[1]).max() > 1.0
    noise = [truth.fixes(short(), checked(seed).truth, seed).position[:, 1] for seed in (3, 4)]
    assert np.nanmin(np.abs(noise[0] - noise[1])) > 0.0
    assert len({tuple(checked(seed).changes.values()) for seed in range(8)}) > 3


def test_the_use_of_one_stream_moves_no_other() -> None:
    """Less noise, another input and no change of coefficients leave all else as it was drawn."""
    own, before = short(), checked(3)
    other_input = truth.verification(replace(own, input=replace(own.input, duration=900.0, noise_sigma=0.1)), 3)
    np.testing.assert_array_equal(other_input.truth.position, before.truth.position)
    seen = truth.fixes(own, before.truth, 3).position
    quiet = truth.fixes(replace(own, sensor=replace(own.sensor, fix_sigma=0.5)), before.truth, 3).position
    np.testing.assert_array_equal(np.isnan(quiet), np.isnan(seen))
    unchanged = truth.verification(replace(own, verification=replace(own.verification, coefficient_change=0.0)), 3)
    np.testing.assert_allclose(
        truth.fixes(own, unchanged.truth, 3).position[:, 1], seen[:, 1], atol=1e-12
    )  # across the track there is nothing but noise
    draws = {
        use: truth.stream(3, use).random() for use in (truth.INPUT, truth.COEFFICIENTS, truth.SENSOR, truth.SEARCH)
    }
    assert len(set(draws.values())) == 4


def test_coefficients_change_by_exactly_the_configured_share() -> None:
    assert set(checked(0).changes) == set(CHANGED)
    for seed in range(8):
        assert set(checked(seed).changes.values()) <= {0.95, 1.05}
    for name in CHANGED:
        assert {checked(seed).changes[name] for seed in range(8)} == {0.95, 1.05}
    own = short()
    wide = truth.verification(replace(own, verification=replace(own.verification, coefficient_change=0.2)), 0)
    assert set(wide.changes.values()) <= {0.8, 1.2}
    assert [wide.changes[name] > 1.0 for name in CHANGED] == [checked(0).changes[name] > 1.0 for name in CHANGED]


def chain_of(own: Configuration, system: TowedSystem, ship: Trace) -> link_joint.LinkJointResult:
    settings = own.verification
    return link_joint.simulate(system, ship, links=settings.links, tolerance=settings.tolerance, start="rest")


def changed_by_hand(part: Part, by: dict[str, float]) -> Part:
    assert part.body is not None
    drag, added = part.cable.normal_drag_coefficient, part.cable.added_mass
    cable = replace(
        part.cable,
        normal_drag_coefficient=drag * by["cable normal drag"],
        added_mass=added * by["cable added mass"],
    )
    mass = by["vehicle added mass"]
    body = replace(
        part.body,
        drag_coefficient=part.body.drag_coefficient * by["vehicle drag"],
        added_mass_surge=part.body.added_mass_surge * mass,
        added_mass_sway=part.body.added_mass_sway * mass,
        added_mass_heave=part.body.added_mass_heave * mass,
    )
    return replace(part, cable=cable, body=body)


@pytest.mark.parametrize("seed", [0, 3])
def test_the_truth_is_the_chain_of_the_changed_tow(seed: int) -> None:
    """Every factor is on its own coefficient and on nothing else."""
    check, own = checked(seed), short()
    system = own.system
    changed = replace(system, parts=tuple(changed_by_hand(part, check.changes) for part in system.parts))
    expected = chain_of(own, changed, check.ship)
    np.testing.assert_array_equal(check.truth.position, expected.vehicle.position)
    assert (check.chain.links, check.chain.error) == ((60,), expected.error)
    flowing = chain_of(own, replace(changed, current=Current.uniform(0.05)), check.ship)
    np.testing.assert_array_equal(check.in_current.position, flowing.vehicle.position)


def unchanged(own: Configuration) -> Configuration:
    return replace(own, verification=replace(own.verification, coefficient_change=0.0))


def test_no_change_is_the_chain_of_the_tow_itself_with_the_links_asked_for() -> None:
    own = unchanged(short())
    fewer = replace(own, verification=replace(own.verification, links=20))
    for each in (own, fewer):
        check = truth.verification(each, 0)
        expected = chain_of(each, own.system, check.ship).vehicle
        np.testing.assert_array_equal(check.truth.position, expected.position)
    assert check.chain.links == (20,)


@pytest.mark.parametrize("name", ["mangus-740", "autec-1200", "mangus-2500"])
def test_the_truth_errs_by_a_ten_thousandth_of_a_metre_a_second_and_says_so(name: str) -> None:
    """Against twice the links and a fiftieth of the tolerance."""
    check = truth.verification(load(name), 0)
    system = load(name).system
    changed = replace(system, parts=tuple(changed_by_hand(part, check.changes) for part in system.parts))
    finer = link_joint.simulate(changed, check.ship, links=120, tolerance=1e-6, start="rest", companion=False).vehicle
    assert check.truth.velocity is not None
    assert finer.velocity is not None
    error = float(np.sqrt(np.mean(np.sum((check.truth.velocity - finer.velocity) ** 2, axis=1))))
    assert check.chain.error is not None
    assert error < check.chain.error < 1e-4
    assert error > 0.3 * check.chain.error
    assert check.chain.imbalance < 1e-3
    assert check.chain.slack == ()


def test_a_leaning_tow_and_a_towfish_are_chains_too(table_two: Tow) -> None:
    own = unchanged(short())
    for tow in (replace(own.tow, speed=1.0), table_two):
        check = truth.verification(replace(own, tow=tow), 0)
        expected = chain_of(own, TowedSystem.from_tow(tow), check.ship).vehicle
        np.testing.assert_array_equal(check.truth.position, expected.position)


def test_parts_behind_the_vehicle_are_towed_and_changed() -> None:
    own = short("multipart-2200")
    check = truth.verification(own, 1)
    assert check.chain.names == ("vehicle", "damping-unit", "towed-body")
    changed = replace(own.system, parts=tuple(changed_by_hand(part, check.changes) for part in own.system.parts))
    np.testing.assert_array_equal(check.truth.position, chain_of(own, changed, check.ship).vehicle.position)
    alone = truth.verification(replace(own, tails=()), 1)
    assert np.abs(alone.truth.position - check.truth.position).max() > 5.0


def test_a_bare_end_has_only_a_cable_to_change() -> None:
    own = short().system.parts[0]
    part = truth._changed(replace(own, body=None), dict.fromkeys(CHANGED, 1.1))
    assert part.body is None
    assert part.cable.added_mass == pytest.approx(1.1 * own.cable.added_mass)


def test_fixes_have_the_configured_interval_noise_offset_and_dropouts() -> None:
    own = load("autec-1200")
    errors, missing = [], []
    for seed in range(4):
        check = truth.verification(own, seed)
        fixes = truth.fixes(own, check.truth, seed)
        np.testing.assert_allclose(np.diff(fixes.t), own.sensor.fix_interval)
        assert fixes.t[[0, -1]].tolist() == [0.0, 3600.0]
        seen = fixes.valid
        errors.append((fixes.position - check.truth.at(fixes.t))[seen])
        missing.append(float(np.mean(~seen)))
    error = np.concatenate(errors)
    assert error.mean(axis=0) == pytest.approx([own.sensor.offset, 0.0, 0.0], abs=0.2)
    assert error.std(axis=0) == pytest.approx(own.sensor.fix_sigma, rel=0.1)
    assert 0.02 < np.mean(missing) < 0.09


@pytest.mark.parametrize(
    ("name", "kind", "settings"),
    [
        ("mangus-740", "starts-and-stops", StartsAndStops),
        ("autec-1200", "sharp-transients", SharpTransients),
        ("mangus-2500", "few-sinusoids", FewSinusoids),
    ],
)
def test_each_tow_has_the_manoeuvre_of_its_kind(name: str, kind: str, settings: type) -> None:
    own = load(name)
    assert own.verification.kind == kind
    assert isinstance(own.manoeuvre, settings)
    assert own.manoeuvre.duration == 3600.0
    check = truth.verification(short(name), 0)
    expected = inputs.ship_trace(short(name).manoeuvre, np.random.default_rng(0))
    np.testing.assert_array_equal(check.ship.position, expected.position)


def test_the_current_of_the_second_truth_is_added_to_the_tows_own() -> None:
    own = short()
    sheared = Current.from_profile([0.0, 500.0], [0.1, 0.0])
    check = truth.verification(replace(own, tow=replace(own.tow, current=sheared)), 0)
    assert check.truth.position[0, 0] > 0.1
    assert check.in_current.position[0, 0] > check.truth.position[0, 0]
    both = truth._added(sheared, 0.05)
    assert both.at([0.0, 500.0]).tolist() == pytest.approx([0.15, 0.05])


def test_resolution_of_the_reference_is_as_configured() -> None:
    own = short()
    ship = truth.identification_ship(own, 0)
    by_tolerance = truth.reference_run(own, ship)
    assert by_tolerance.error is not None
    assert by_tolerance.error <= own.spectral.tolerance
    given = truth.reference_run(replace(own, spectral=replace(own.spectral, harmonics=9, stations=40)), ship)
    assert (given.harmonics, given.stations) == (9, 40)
    assert given.error is not None
    assert 0.0 < given.error < 1e-3


def test_a_tow_starts_steady() -> None:
    own, speed = short("mangus-740"), 0.3
    towing = replace(own, tow=replace(own.tow, speed=speed))
    assert truth.start_of(own.tow) == "rest"
    assert truth.start_of(towing.tow) == "steady"
    still, moving = truth.identification_ship(own, 0), truth.identification_ship(towing, 0)
    np.testing.assert_allclose(moving.position[:, 0], still.position[:, 0] + speed * still.t, atol=1e-12)
    assert truth.towed(own.tow, still) is still
    reference, check = truth.reference_run(towing, moving).vehicle, truth.verification(towing, 0)
    for vehicle in (reference, check.truth):
        assert vehicle.velocity is not None
        assert vehicle.velocity[0, 0] == pytest.approx(speed, abs=1e-6)
        assert vehicle.position[0, 0] < -20.0
    assert isinstance(check.ship, Trace)
    assert check.ship.position[-1, 0] > speed * check.ship.t[-1]
