"""What the winch accepts and refuses, and what its drum does between the samples of the regulator."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from models.quantity import InvalidInput
from models.spectral import DepthWinch, Payout, simulate
from models.tow import Tow
from models.trace import Trace

STILL = Trace.along_x(np.arange(0.0, 301.0), np.zeros(301))


@pytest.mark.parametrize("length", [37.5, -37.5])
def test_more_than_a_twentieth_is_refused(configurations: Callable[[str], Tow], length: float) -> None:
    winch = Payout(t=[0.0, 200.0], length=[0.0, length])
    with pytest.raises(
        InvalidInput, match=r"at most 5% of the cable \(37 m of 740 m\), but the payout reaches 37\.5 m"
    ):
        simulate(configurations("mangus-740"), STILL, harmonics=3, winch=winch)


@pytest.mark.parametrize(
    ("t", "length", "message"),
    [
        ([0.0, 1.0], [0.0], "one length for each time"),
        ([0.0, 0.0], [0.0, 1.0], "strictly increasing"),
        ([0.0, 1.0], [0.0, math.nan], "finite"),
        ([0.0], [0.0], "at least 2 times"),
    ],
)
def test_payout_refuses(t: list[float], length: list[float], message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        Payout(t=t, length=length)


@pytest.mark.parametrize("field", ["rate_limit", "period", "acceleration_limit"])
def test_depth_winch_refuses(field: str) -> None:
    with pytest.raises(InvalidInput, match=rf"DepthWinch\.{field}"):
        DepthWinch(t=[0.0], change=[5.0], **{field: 0.0})


def test_the_drum_follows_its_table(configurations: Callable[[str], Tow]) -> None:
    winch = Payout(t=[0.0, 50.0, 150.0, 200.0], length=[0.0, 0.0, 20.0, 10.0])
    result = simulate(configurations("mangus-740"), STILL, harmonics=3, winch=winch)
    assert result.payout is not None
    wanted = np.interp(STILL.t, [0.0, 50.0, 150.0, 200.0], [0.0, 0.0, 20.0, 10.0])
    inside = (np.abs(STILL.t[:, None] - [0.0, 50.0, 150.0, 200.0]) > 2.0).all(axis=1)
    np.testing.assert_allclose(result.payout[inside], wanted[inside], atol=1e-9)
    assert np.abs(result.payout - wanted).max() < 0.2


def test_no_winch_no_payout(configurations: Callable[[str], Tow]) -> None:
    assert simulate(configurations("mangus-740"), STILL, harmonics=3).payout is None
    still = simulate(configurations("mangus-740"), STILL, harmonics=3, winch=Payout(t=[0.0, 9.0], length=[0.0, 0.0]))
    assert still.payout is not None
    assert not still.payout.any()
    assert np.abs(still.vehicle.velocity).max() < 1e-9
