"""The fine chain converges at second order in links and in steps, each against its own fine run."""

import numpy as np
import pytest

from ident.configuration import load
from models import fine_chain
from models.trace import Trace

# From rest without a jump of speed or acceleration, to two reversing tones: the kinks of |v| v are in it.
T = np.arange(0.0, 601.0)
SHIP = Trace.along_x(T, (1.0 - np.exp(-((T / 60.0) ** 3))) * (12.0 * np.sin(0.04 * T) + 20.0 * np.sin(0.013 * T)))


def velocity(links: int, step: float) -> np.ndarray:
    trace = fine_chain.simulate(load("autec-1200").tow, SHIP, links=links, step=step).vehicle
    assert trace.velocity is not None
    return trace.velocity[:, 0]


def orders(errors: list[float]) -> np.ndarray:
    return np.log2(np.array(errors[:-1]) / errors[1:])


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def test_second_order_in_links() -> None:
    exact = velocity(960, 0.5)
    found = orders([rms(velocity(links, 0.5) - exact) for links in (60, 120, 240)])
    assert found == pytest.approx(2.0, abs=0.2)


def test_second_order_in_steps() -> None:
    exact = velocity(60, 1.0 / 64.0)
    found = orders([rms(velocity(60, step) - exact) for step in (1.0, 0.5, 0.25, 0.125)])
    assert found == pytest.approx(2.0, abs=0.2)
