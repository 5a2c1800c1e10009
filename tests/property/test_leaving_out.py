"""For any tow: what is left out is the full model with the term at zero."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from data_synth.ships import SpeedChanges, speed_changes
from ident.benchmark.leaving_out import EQUAL
from ident.leaving_out.case import apart
from ident.leaving_out.responses import by_matrix
from ident.leaving_out.scenes import Scene, by_chain, by_spectral
from models.cable import Cable
from models.tow import Tow
from models.vehicle import Vehicle

lengths = st.floats(100.0, 4000.0)
weights = st.floats(3e3, 3e4)
drags = st.floats(0.5, 2.0)
speeds = st.floats(0.05, 0.8)


def scene(length: float, weight: float, drag: float, speed: float) -> Scene:
    cable = Cable(
        length=length,
        diameter=0.017,
        mass=1.0,
        weight_in_water=7.0,
        added_mass=0.24,
        axial_stiffness=1.4e7,
        normal_drag_coefficient=drag,
        tangential_drag_coefficient=0.05,
    )
    vehicle = Vehicle(weight_in_water=weight, mass=0.15 * weight, added_mass=100.0, area=0.5, drag_coefficient=drag)
    orders = SpeedChanges(duration=60.0, sample=1.0, times=(5.0,), speeds=(0.0, speed), rise=10.0)
    return Scene(name="any", tow=Tow(cable=cable, vehicle=vehicle), ship=speed_changes(orders))


@settings(max_examples=10, deadline=None)
@given(lengths, weights, drags, speeds)
def test_any_scene_equals_its_full_model_at_zero(length: float, weight: float, drag: float, speed: float) -> None:
    any_scene = scene(length, weight, drag, speed)
    for case in (*by_spectral(any_scene), *by_chain(any_scene)):
        if case.zero is not None:
            found = apart((case.same_off or case.off)(), (case.same_zero or case.zero)())
            assert found <= EQUAL, (case.simulator, case.term)


@settings(max_examples=5, deadline=None)
@given(lengths, weights, drags)
def test_any_response_equals_its_full_model_at_zero(length: float, weight: float, drag: float) -> None:
    for case in by_matrix(scene(length, weight, drag, 0.5)):
        if case.zero is not None:
            assert apart((case.same_off or case.off)(), (case.same_zero or case.zero)()) <= EQUAL, case.term


@settings(max_examples=10, deadline=None)
@given(st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=5), st.floats(-2.0, 2.0))
def test_scaling_all_answers_leaves_their_difference(values: list[float], scale: float) -> None:
    one, other = np.array(values), np.array(values[::-1])
    if abs(scale) > 0.1 and np.abs(one).max() > 1.0:
        found, scaled = apart({"y": one}, {"y": other}), apart({"y": scale * one}, {"y": scale * other})
        np.testing.assert_allclose(found, scaled, rtol=1e-9, atol=1e-12)
