"""The link-joint chain converges at second order in links and in steps."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ident.configuration import load
from models import link_joint
from models.towed_system import TowedSystem
from models.trace import Trace

# A sweep and a heave from steady tow, without a jump of speed or of acceleration; three-dimensional.
T = np.arange(0.0, 241.0)
EASE = 1.0 - np.exp(-((T / 40.0) ** 3))
SHIP = Trace(
    t=T,
    position=np.stack(
        [1.2 * T, 25.0 * EASE * np.sin(0.03 * T), 2.0 * EASE * np.sin(0.11 * T)],
        axis=1,
    ),
)


def velocity(stiffness: float | None, links: int, step: float) -> np.ndarray:
    tow = load("mangus-740").tow
    cable = tow.cable if stiffness is None else replace(tow.cable, axial_stiffness=stiffness)
    system = TowedSystem.from_tow(replace(tow, cable=cable))
    run = link_joint.simulate(system, SHIP, links=links, step=step, companion=False)
    return run.vehicle.rates()


def orders(errors: list[float]) -> np.ndarray:
    return np.log2(np.array(errors[:-1]) / errors[1:])


def rms(values: np.ndarray) -> float:
    return math.sqrt(float(np.mean(values**2)))


@pytest.mark.parametrize("stiffness", [1e15, None], ids=["rigid", "elastic"])
def test_second_order_in_links(stiffness: float | None) -> None:
    exact = velocity(stiffness, 320, 0.1)
    found = orders([rms(velocity(stiffness, links, 0.1) - exact) for links in (20, 40, 80)])
    assert found == pytest.approx(2.0, abs=0.2)


@pytest.mark.parametrize("stiffness", [1e15, None], ids=["rigid", "elastic"])
def test_second_order_in_steps(stiffness: float | None) -> None:
    exact = velocity(stiffness, 20, 1.0 / 64.0)
    found = orders([rms(velocity(stiffness, 20, step) - exact) for step in (1.0, 0.5, 0.25, 0.125)])
    assert found == pytest.approx(2.0, abs=0.2)
