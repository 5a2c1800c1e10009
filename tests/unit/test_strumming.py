"""Strumming: the amplified drag against figures worked by hand, and its limits."""

from dataclasses import replace

import pytest

from models.cable import Cable
from models.strumming import amplification, strouhal_frequency

CABLE = Cable(
    length=100.0,
    diameter=0.02,
    mass=0.9,
    weight_in_water=5.0,
    added_mass=0.1,
    axial_stiffness=1e7,
    normal_drag_coefficient=1.2,
    tangential_drag_coefficient=0.02,
)


def test_amplification_of_a_cable_worked_by_hand() -> None:
    # m_t = 1 kg/m, rho d^2 = 0.4 kg/m: SG = 2 pi 0.04 x 2 x 2 pi 0.1/0.4 = 0.78957; Y/d = 1.29/1.33951^3.35 = 0.48452;
    # 2 Y_rms/d = 0.68522; 1 + 1.043 x 0.68522^0.65 = 1.81578.
    assert amplification(CABLE, 1000.0, 0.1) == pytest.approx(1.81578, abs=1e-5)


def test_a_cable_without_damping_strums_at_the_largest_amplitude() -> None:
    # Y/d = 1.29: a known ceiling, drag 2.54 times that of the still cable.
    assert amplification(CABLE, 1000.0, 0.0) == pytest.approx(1.0 + 1.043 * (2.0 * 1.29 / 2.0**0.5) ** 0.65)


def test_mass_and_damping_hold_the_drag_down_to_that_of_a_still_cable() -> None:
    values = [amplification(CABLE, 1000.0, damping) for damping in (0.0, 0.005, 0.05, 0.5, 1.0)]
    assert values == sorted(values, reverse=True)
    assert min(values) > 1.0
    heavy = replace(CABLE, mass=5.0)
    assert amplification(heavy, 1000.0, 0.005) < amplification(CABLE, 1000.0, 0.005)
    assert amplification(replace(CABLE, mass=1e6), 1000.0, 1.0) == pytest.approx(1.0, abs=1e-6)


def test_vortices_leave_at_the_strouhal_frequency() -> None:
    assert strouhal_frequency(CABLE, 3.0) == pytest.approx(30.0)
    assert strouhal_frequency(CABLE, -3.0) == strouhal_frequency(CABLE, 3.0)
