"""The statics converge at the fourth order of the classical Runge-Kutta method."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from models.current import Current
from models.statics import static_shape
from models.tow import Tow


def test_order_four_in_segments(configurations: Callable[[str], Tow]) -> None:
    tow = replace(configurations("mangus-2500"), speed=0.7, current=Current.uniform(0.1))
    ends = np.array(
        [[s.x[0], s.z[0], s.T[-1], s.phi[-1]] for s in (static_shape(tow, stations=n) for n in (10, 20, 40, 640))]
    )
    errors = np.abs(ends[:3] - ends[3])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(np.abs(orders[1] - 4.0) < 0.2), orders
