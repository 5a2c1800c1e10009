"""The matrix method: what it accepts, what it says of itself, and what it refuses."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from models.current import Current
from models.quantity import InvalidInput, NumericalFailure
from models.statics import SlackCable, steady_way
from models.tow import Tow
from models.transfer_matrix import (
    Compensator,
    UniformDamping,
    frequency_response,
    product_digits,
    sea_response,
    setup,
)
from models.transfer_matrix.mesh import graded_nodes, joints_of
from models.transfer_matrix.work import Work


@pytest.mark.parametrize(
    ("omega", "words"),
    [
        ([0.0, 1.0], r"above 0 rad/s, but omega\[0\] = 0 rad/s"),
        ([0.5, -1.0], r"above 0 rad/s, but omega\[1\] = -1 rad/s"),
        ([0.5, float("nan")], r"omega\[1\] = nan"),
        ([0.5, 0.5], r"must increase, but omega\[0\] = 0.5 and omega\[1\] = 0.5"),
        ([], "at least one frequency"),
    ],
)
def test_frequencies_are_above_zero_and_increase(table_two: Tow, omega: list[float], words: str) -> None:
    with pytest.raises(InvalidInput, match=words):
        frequency_response(table_two, omega)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"amplitude": 0.0}, "amplitude must be above 0 m"),
        ({"tolerance": 0.0}, "tolerance must be above 0 and below 1"),
        ({"direction": "sway"}, "direction must be one of axial, heave, surge, but it is 'sway'"),
        ({"drag": "none"}, "drag must be 'consistent' or 'printed'"),
        ({"solver": "riccati"}, "solver must be 'stable' or 'product'"),
        ({"segments": 1}, "at least 2, but 1 were given|at least 2 segments, but 1 were given"),
        ({"nodes": [0.0, 100.0, 50.0]}, "three increasing lengths"),
        ({"nodes": [0.0, 100.0, 3999.0]}, "4000 m is missing"),
        ({"compensator": Compensator(stiffness=0.0, damping=0.0)}, "hangs on nothing"),
        (
            {"compensator": Compensator(stiffness=10.0, damping=0.0), "direction": "surge"},
            "acts along the cable .* use the direction 'axial'",
        ),
    ],
)
def test_settings_are_checked(table_two: Tow, settings: dict[str, object], words: str) -> None:
    with pytest.raises(InvalidInput, match=words):
        frequency_response(table_two, [0.5], **settings)  # type: ignore[call-overload]


def test_a_cable_that_goes_slack_has_no_response(table_two: Tow) -> None:
    light = replace(table_two, cable=replace(table_two.cable, weight_in_water=-3.0))
    with pytest.raises(SlackCable, match="tension falls to zero at s ="):
        frequency_response(light, [0.5])


def test_a_towfish_without_equilibrium_has_no_response(table_two: Tow) -> None:
    fish = replace(table_two.vehicle, tow_point_q=-0.8, buoyancy_centre_q=-0.5)
    with pytest.raises(InvalidInput, match="no stable pitch angle"):
        frequency_response(replace(table_two, vehicle=fish), [0.5])


def test_a_resonance_without_any_damping_is_told_or_finite(table_two: Tow) -> None:
    """An undamped cable has frequencies at which the top cannot be moved: the answer is large, never not a number."""
    still = UniformDamping()
    omega = np.linspace(0.7, 1.1, 4001)
    answer = frequency_response(table_two, omega, damping=still, segments=64, companion=False)
    assert np.isfinite(answer.states).all()
    assert np.abs(answer.tension_top).max() > 100.0 * np.median(np.abs(answer.tension_top))


def test_a_mesh_that_cannot_be_made_fine_enough_says_what_errs(table_two: Tow, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(setup, "LAST_SEGMENTS", 64)
    with pytest.raises(NumericalFailure, match=r"With 64 segments the \w+ still errs by .* of its largest amplitude"):
        frequency_response(replace(table_two, current=Current.uniform(0.5)), [3.0, 30.0])


def test_the_product_of_matrices_names_its_failure(table_two: Tow) -> None:
    tow = replace(table_two, current=Current.uniform(0.5))
    words = r"product of transfer matrices keeps 0.0 of 16 digits at 0.1 rad/s over 4000 m.*Use the stable solver"
    with pytest.raises(NumericalFailure, match=words.replace("0.0", r"\d\.\d").replace("0.1", r"[\d.]+")):
        frequency_response(tow, [0.1, 1.0], direction="surge", solver="product", segments=400)
    digits = product_digits(tow, [0.1, 0.3, 1.0], direction="surge", segments=400)
    assert digits[0] > 4.0
    assert digits[-1] == 0.0


def test_convergence_is_told(table_two: Tow, monkeypatch: pytest.MonkeyPatch) -> None:
    answer = frequency_response(table_two, [0.5, 0.9], tolerance=1e-4, segments=64)
    assert answer.converged.all()
    assert np.all(answer.change <= 1e-4)
    tighter = frequency_response(table_two, [0.5, 0.9], tolerance=1e-12, segments=64)
    assert np.all(tighter.iterations > answer.iterations)
    monkeypatch.setattr(Work.march, "__kwdefaults__", {"most": 2, "by_product": False})
    short = frequency_response(table_two, [0.5, 0.9], tolerance=1e-12, segments=64)
    assert not short.converged.any()


def test_the_estimated_error_is_about_that_against_a_fine_mesh(table_two: Tow) -> None:
    tow = replace(table_two, current=Current.uniform(0.3))
    omega = np.linspace(0.2, 1.5, 14)
    fine = frequency_response(tow, omega, segments=4096, companion=False)
    answer = frequency_response(tow, omega, segments=128)
    for name in ("heave", "tension_bottom", "tension_top"):
        error = np.abs(getattr(answer, name) - getattr(fine, name)).max()
        assert 0.5 < answer.error[name].max() / error < 2.0
    resolved = frequency_response(tow, omega)
    assert max(resolved.shares.values()) <= setup.SHARE


def test_a_mesh_holds_joints_and_kinks_and_bends(configurations: Callable[[str], Tow], table_two: Tow) -> None:
    tow = configurations("s-shape-205")
    nodes = graded_nodes(tow, 82, 1.5, 0.15)
    assert nodes.size == 83
    assert np.isclose(nodes[::2], 75.0).any()
    steps = np.diff(nodes)
    assert steps[int(np.argmin(np.abs(nodes - 52.0)))] < 0.2 * steps.max()
    kinked = replace(table_two, current=Current.from_profile([0.0, 1000.0, 2500.0], [0.8, 0.3, 0.1]))
    nodes = graded_nodes(kinked, 100, 1.5, 0.1, halvings=2)
    shape = frequency_response(kinked, [1.0], nodes=nodes, companion=False).shape
    assert joints_of(kinked, steady_way(kinked)).size == 4
    assert np.abs(shape.z[::4] + 1000.0).min() < 1e-6
    assert np.abs(shape.z[::4] + 2500.0).min() < 1e-6
    with pytest.raises(InvalidInput, match=r"3 stretches .* at least 12 segments, but 8 were given"):
        graded_nodes(kinked, 8, 1.5, 0.1, halvings=2)


def test_any_spacing_of_nodes_is_taken(table_two: Tow) -> None:
    rng = np.random.default_rng(0)
    nodes = np.concatenate([[0.0], np.sort(rng.uniform(1.0, 3999.0, 1500)), [4000.0]])
    answer = frequency_response(table_two, [0.85], nodes=nodes)
    assert abs(answer.heave[0]) == pytest.approx(1.9564, rel=1e-3)


OMEGA = np.linspace(0.2, 2.0, 40)


@pytest.mark.parametrize(
    ("density", "words"),
    [
        (np.zeros(40), "no energy"),
        (np.full(40, -1.0), r"at least 0 m2 s/rad, but it is -1 at 0.2 rad/s"),
        (np.full(40, np.nan), "nan"),
        (np.ones(39), "40 frequencies and 39 densities"),
    ],
)
def test_a_spectrum_is_checked(table_two: Tow, density: np.ndarray, words: str) -> None:
    with pytest.raises(InvalidInput, match=words):
        sea_response(table_two, OMEGA, density)


def test_a_vessel_is_checked(table_two: Tow) -> None:
    with pytest.raises(InvalidInput, match="for each of 40 frequencies, but its shape is"):
        sea_response(table_two, OMEGA, np.ones(40), motion=np.ones((39, 2)))
    with pytest.raises(InvalidInput, match="no energy: the vessel does not answer"):
        sea_response(table_two, OMEGA, np.ones(40), motion=np.zeros((40, 2)))


def test_a_sea_answers_for_its_error_and_its_convergence(table_two: Tow) -> None:
    density = np.exp(-0.5 * ((OMEGA - 0.7) / 0.15) ** 2)
    sea = sea_response(table_two, OMEGA, density, segments=64)
    assert sea.converged
    assert sea.change <= 1e-10
    fine = sea_response(table_two, OMEGA, density, segments=2048, companion=False)
    for name in ("heave", "tension_top"):
        assert 0.3 < sea.error[name] / abs(sea.sigma[name] - fine.sigma[name]) < 3.0
    assert sea.sigma["relative"] == pytest.approx(0.0, abs=1e-12)
    assert sea.sigma["top"] == pytest.approx(np.sqrt(np.trapezoid(density, OMEGA)))
    assert sea.sigma_tension[-1] == pytest.approx(sea.sigma["tension_top"])


def test_the_motion_of_a_vessel_is_turned_to_the_cable(table_two: Tow) -> None:
    """Heave alone of an RAO is the direction 'heave'; horizontal motion with a quarter period is circular."""
    tow = replace(table_two, speed=1.0)
    density = np.exp(-0.5 * ((OMEGA - 0.7) / 0.15) ** 2)
    heave = np.column_stack([np.zeros(40), np.full(40, 0.8)])
    a = sea_response(tow, OMEGA, density, motion=heave, direction="heave", segments=64, companion=False)
    b = sea_response(tow, OMEGA, 0.64 * density, direction="heave", segments=64, companion=False)
    assert a.sigma["tension_top"] == pytest.approx(b.sigma["tension_top"], rel=1e-6)
    along = sea_response(tow, OMEGA, density, motion=heave, direction="axial", segments=64, companion=False)
    assert along.sigma["top"] == pytest.approx(0.8 * np.sqrt(np.trapezoid(density, OMEGA)))
