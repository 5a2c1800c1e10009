"""Transmission, critical stiffness and tuning of a heave compensator, and H's Table III from them."""

import math

import numpy as np
import pytest

from models.compensator import (
    Setting,
    critical_stiffness,
    dynamic_stiffness,
    largest_free_height,
    motion_ratio,
    relative_limit,
    relative_ratio,
    tune,
)
from models.quantity import InvalidInput, NumericalFailure
from models.tow import Tow
from models.transfer_matrix.axial import AxialString, axial_response, compensated_response

MASS = 530.0
#: Of H Table II in its sea states: significant heave [m], and the peak frequency that fits Table III best [rad/s].
SEAS = {5: (2.99, 0.605), 6: (5.25, 0.54)}
#: H Table III: tuned damping [N s/m], tuned stiffness and critical stiffness [N/m].
TABLE_THREE = {5: (3160.0, 6410.0, 1600.0), 6: (7150.0, 7020.0, 1510.0)}
LEAST = {"least_stiffness": 100.0, "least_damping": 100.0}
#: A cable above its first resonance, and the frequency [rad/s].
C, OMEGA = -1500.0 + 1600.0j, 0.55


def settings(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Stiffnesses and dampings over six decades."""
    return 10.0 ** rng.uniform(0.0, 6.0, count), 10.0 ** rng.uniform(0.0, 6.0, count)


def test_the_ratios_are_those_of_the_balance_at_the_cables_top() -> None:
    k, b = 2000.0, 800.0
    top, relative = motion_ratio(C, OMEGA, k, b), relative_ratio(C, OMEGA, k, b)
    assert top * C == pytest.approx((k + 1j * OMEGA * b) * (1.0 - top))
    assert relative == pytest.approx(top - 1.0)
    assert top == pytest.approx((k + 1j * OMEGA * b) / (C + k + 1j * OMEGA * b))


def test_the_ends_of_the_range_are_a_free_and_a_locked_top() -> None:
    assert abs(motion_ratio(C, OMEGA, 0.0, 0.0)) == 0.0
    assert relative_ratio(C, OMEGA, 0.0, 0.0) == pytest.approx(-1.0)
    for k, b in ((math.inf, 0.0), (0.0, math.inf), (math.inf, math.inf)):
        assert motion_ratio(C, OMEGA, k, b) == 1.0
        assert abs(relative_ratio(C, OMEGA, k, b)) == 0.0
    shape = motion_ratio(np.array([C, 2 * C]), OMEGA, np.ones((3, 1, 1)), np.array([[1.0], [math.inf]])).shape
    assert shape == (3, 2, 2)


def test_a_resonance_without_damping_is_named() -> None:
    with pytest.raises(NumericalFailure, match="resonate without any damping"):
        motion_ratio(-1500.0 + 0.0j, OMEGA, 1500.0, 0.0)


def test_below_the_critical_stiffness_no_damping_amplifies_and_above_it_little_damping_does() -> None:
    critical = float(critical_stiffness(C))
    assert critical == pytest.approx(abs(C) ** 2 / 3000.0)
    dampings = np.logspace(-2.0, 6.0, 400)
    assert np.abs(motion_ratio(C, OMEGA, 0.9999 * critical, dampings)).max() < 1.0
    assert np.abs(motion_ratio(C, OMEGA, 1.001 * critical, dampings)).max() > 1.0
    assert abs(motion_ratio(C, OMEGA, critical, 0.0)) == pytest.approx(1.0, rel=1e-12)


def test_a_cable_that_is_a_spring_has_no_critical_stiffness() -> None:
    rng = np.random.default_rng(3)
    for c in (2000.0 + 10.0j, 0.0 + 500.0j):
        assert critical_stiffness(c) == math.inf
        assert np.abs(motion_ratio(c, OMEGA, *settings(rng, 500))).max() < 1.0
        made = tune(c, OMEGA, 0.4, **LEAST)
        assert made.advice == "damp"
        assert "no stiffness amplifies" in made.why
        assert made.relative(made.by_damping) == pytest.approx(0.4, rel=1e-12)
    assert critical_stiffness(np.array([C, -C])).tolist() == [pytest.approx(abs(C) ** 2 / 3000.0), math.inf]


@pytest.mark.parametrize("limit", [0.02, 0.2, 0.41, 0.72, 0.95, 1.005])
def test_tuned_settings_meet_the_limit_from_the_soft_side(limit: float) -> None:
    made = tune(C, OMEGA, limit, **LEAST)
    assert made.relative(made.softest) > limit
    for setting, stiffer in (
        (made.by_stiffness, Setting(stiffness=1.01 * made.by_stiffness.stiffness, damping=100.0)),
        (made.by_damping, Setting(stiffness=100.0, damping=1.01 * made.by_damping.damping)),
    ):
        assert made.relative(setting) == pytest.approx(limit, rel=1e-12)
        assert made.relative(stiffer) < limit
    assert made.by_stiffness.damping == made.by_damping.stiffness == 100.0
    assert made.by_stiffness.stiffness > 100.0
    assert made.by_damping.damping > 100.0


def test_tuning_the_damping_spares_the_cable_and_tuning_the_stiffness_does_not() -> None:
    made = tune(C, OMEGA, 0.41, **LEAST)
    assert made.advice == "damp"
    assert made.top(made.by_damping) < 1.0 < made.top(made.by_stiffness)
    assert f"is below k_crit = {made.critical:.4g} N/m" in made.why


def test_a_stroke_that_is_long_enough_leaves_the_compensator_soft() -> None:
    made = tune(C, OMEGA, 1.2, **LEAST)
    assert made.advice == "soft"
    assert made.by_stiffness == made.by_damping == made.softest == Setting(stiffness=100.0, damping=100.0)
    assert "nothing has to be constrained" in made.why
    relative = made.relative(made.softest)
    height = largest_free_height(4.0, relative)
    assert relative_limit(4.0, height / 4.004) == pytest.approx(relative, rel=1e-4)
    assert largest_free_height(4.0, 0.0) == math.inf


def test_a_compensator_that_cannot_get_soft_enough_is_locked() -> None:
    for limit in (0.41, 5.0):
        made = tune(C, OMEGA, limit, least_stiffness=1.0001 * float(critical_stiffness(C)), least_damping=100.0)
        assert made.advice == "lock"
        assert "not below k_crit" in made.why


def test_the_rule_is_stricter_than_a_damped_compensator_needs() -> None:
    """Between k_crit without damping and k_crit at the tuned damping, the tuned damping still spares the cable."""
    stiff = 1.5 * float(critical_stiffness(C))
    made = tune(C, OMEGA, 0.41, least_stiffness=stiff, least_damping=100.0)
    assert made.advice == "lock"
    assert made.critical < stiff < made.critical_tuned
    assert made.strict
    assert not tune(C, OMEGA, 0.41, **LEAST).strict
    assert not tune(C, OMEGA, 0.41, least_stiffness=1.01 * made.critical_tuned, least_damping=100.0).strict
    assert made.top(made.by_damping) < 1.0
    at = Setting(stiffness=made.critical_tuned, damping=made.by_damping.damping)
    assert made.top(at) == pytest.approx(1.0, rel=1e-12)


def test_a_stroke_too_short_for_any_use_locks() -> None:
    made = tune(C, OMEGA, 0.005, **LEAST)
    assert made.advice == "lock"
    assert 1.0 - made.top(made.by_damping) < 0.005
    none = tune(C, OMEGA, 0.0, **LEAST)
    assert none.advice == "lock"
    assert none.by_damping == none.by_stiffness == Setting(stiffness=math.inf, damping=math.inf)
    assert none.top(none.by_damping) == 1.0


def test_the_limit_is_that_of_the_thousandth_height() -> None:
    """H IV-B: 0.41 in sea state 6 with a stroke of 4 m; sea state 5 then has 0.72."""
    assert relative_limit(4.0, 5.25 / 4.004) == pytest.approx(0.41, abs=5e-4)
    assert relative_limit(4.0, 2.99 / 4.004) == pytest.approx(0.72, abs=1e-3)
    assert relative_limit(0.0, 1.0) == 0.0


def test_bad_input_is_refused() -> None:
    with pytest.raises(InvalidInput, match="stroke must be at least 0 m, but it is -1 m"):
        relative_limit(-1.0, 1.0)
    with pytest.raises(InvalidInput, match="a vessel that moves"):
        relative_limit(4.0, 0.0)
    with pytest.raises(InvalidInput, match=r"omega.* above 0 rad/s, but it is 0 rad/s"):
        tune(C, 0.0, 0.4, **LEAST)
    with pytest.raises(InvalidInput, match=r"b_min.* at least 0 N s/m, but it is -1 N s/m"):
        tune(C, OMEGA, 0.4, least_stiffness=100.0, least_damping=-1.0)


@pytest.mark.parametrize("state", [5, 6])
def test_table_three_comes_out_at_the_inferred_peak(table_two: Tow, state: int) -> None:
    """Its peak frequencies are not printed; at these, all six values lie within 12 % of the printed ones."""
    heave, omega = SEAS[state]
    string = AxialString.from_tow(table_two, velocity=0.5 * heave * omega)
    response = axial_response(string, omega)
    c = complex(dynamic_stiffness(response.tension_top, omega, MASS)[0])
    made = tune(c, omega, relative_limit(4.0, heave / 4.004), **LEAST)
    ours = (made.by_damping.damping, made.by_stiffness.stiffness, made.critical)
    assert ours == pytest.approx(TABLE_THREE[state], rel=0.12)
    assert made.advice == "damp"


def test_the_maps_have_the_ridge_of_figure_three(table_two: Tow) -> None:
    """Heave and tensions peak along the stiffness and grow along the damping; the relative motion peaks there too."""
    heave, omega = SEAS[6]
    response = axial_response(AxialString.from_tow(table_two, velocity=0.5 * heave * omega), omega)
    k, b = np.logspace(1.0, 6.0, 251), np.logspace(1.0, 5.0, 81)
    made = compensated_response(response, MASS, k[:, None, None], b[:, None])
    maps = {name: np.abs(getattr(made, name)[..., 0]) for name in ("bottom", "relative", "tension_bottom")}
    assert maps["bottom"].shape == (251, 81)
    least = maps["bottom"][:, 0]
    ridge = int(np.argmax(least))
    assert 0 < ridge < 250
    assert least[ridge] > 1.3 * abs(response.bottom[0])
    assert least[-1] == pytest.approx(abs(response.bottom[0]), rel=0.01)
    assert np.all(np.diff(maps["bottom"][0]) > 0.0)
    assert np.all(np.diff(maps["relative"][0]) < 0.0)
    same = np.argmax(maps["relative"][:, 0])
    assert abs(math.log(k[same] / k[ridge])) < 1.0
    assert np.argmax(maps["tension_bottom"][:, 0]) == ridge
