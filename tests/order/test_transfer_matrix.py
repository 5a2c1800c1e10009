"""The stable solve converges at second order in the length of segments, where the product of matrices cannot follow."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from models.current import Current
from models.quantity import NumericalFailure
from models.tow import Tow
from models.transfer_matrix import frequency_response
from models.transfer_matrix.setup import nodes_of

#: Up to the highest frequency that the method is meant for [rad/s].
OMEGA = np.array([0.1, 0.5, 1.2, 3.0])
NAMES = ("mangus-740", "autec-1200", "mangus-2500", "deep-tow-camera", "multipart-2200", "swath-4000", "s-shape-205")


def orders(tow: Tow, direction: str, segments: int) -> np.ndarray:
    """Observed orders (k,) of the deflection along the cable, from four nested meshes."""
    finest = nodes_of(tow, 8 * segments, OMEGA, 1.0, halvings=3)
    answers = [
        frequency_response(tow, OMEGA, nodes=finest[::every], direction=direction, tolerance=1e-20, companion=False)
        for every in (8, 4, 2, 1)
    ]  # type: ignore[call-overload]
    coarse = [answer.states[:, ::every] for answer, every in zip(answers, (1, 2, 4, 8), strict=True)]
    # Nothing is asked of a state that the motion does not reach.
    scale = np.abs(coarse[-1]).max(axis=1, keepdims=True)
    floor = np.array([tow.cable.axial_stiffness / tow.length, 1.0 / tow.length, 1.0, 1.0]) * 1e-6
    apart = [
        np.sqrt(np.mean(np.abs((a - b) / np.maximum(scale, floor)) ** 2, axis=(1, 2))) for a, b in pairwise(coarse)
    ]
    return np.log2(apart[1] / apart[2])


@pytest.mark.parametrize("direction", ["axial", "surge"])
@pytest.mark.parametrize("name", NAMES)
def test_second_order_for_every_built_in_tow(configurations: Callable[[str], Tow], name: str, direction: str) -> None:
    found = orders(configurations(name), direction, 800)
    assert np.all(np.abs(found - 2.0) < 0.2), found


@pytest.mark.parametrize("direction", ["axial", "surge", "heave"])
def test_second_order_over_six_kilometres_with_large_drag(table_two: Tow, direction: str) -> None:
    tow = replace(
        table_two,
        cable=replace(table_two.cable, length=6000.0, normal_drag_coefficient=3.0),
        current=Current.from_profile([0.0, 2000.0, 6000.0], [0.8, 0.4, 0.1]),
    )
    found = orders(tow, direction, 1600)
    assert np.all(np.abs(found - 2.0) < 0.2), found
    with pytest.raises(NumericalFailure, match=r"product of transfer matrices keeps .* of 16 digits at .* rad/s"):
        frequency_response(tow, OMEGA, direction=direction, segments=800, solver="product")  # type: ignore[call-overload]
