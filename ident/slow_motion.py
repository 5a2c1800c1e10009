"""Slow motion of the top against the derivative of the statics: what each form of the drag makes of the limit.

A top that moves to and fro ever more slowly with velocity v leaves the tow in the steady shape of the flow U - v. The
part of the response in phase with the velocity is then the derivative of the statics by the flow.
"""

import math
from dataclasses import replace

import numpy as np
import pandas as pd

from models.current import Current
from models.quantity import InvalidInput, NumericalFailure
from models.statics import static_shape
from models.tow import Tow
from models.transfer_matrix import DragForm, Response, frequency_response

#: Flows over the tow's own, and flows for one that hangs still [m/s].
_SHARES, _FLOWS = (0.25, 0.5, 1.0, 1.5), (0.1, 0.25, 0.5, 1.0, 2.0)
#: Frequency [rad/s], amplitude [m] and segments of the slow motion, and the step of the derivative [m/s].
_OMEGA, _AMPLITUDE, _SEGMENTS, _STEP = 1e-7, 1e-3, 1600, 2e-3
#: H's norm to which the slow motion is solved: its part in phase with the velocity is small beside the motion.
_TIGHT = 1e-22


def slow_table(tow: Tow) -> pd.DataFrame:
    """Columns ``flow_m_s`` at the top, ``consistent``, ``printed``: the error of the tension over its largest change.

    Flows in which the tow has no steady shape are left out.
    """
    rows = []
    for flow, each in _flows(tow):
        try:
            rows.append((flow, missed(each, "consistent"), missed(each, "printed")))
        except (InvalidInput, NumericalFailure):
            continue
    return pd.DataFrame(rows, columns=["flow_m_s", "consistent", "printed"])


def missed(tow: Tow, drag: DragForm) -> float:
    """The error of the slow response's tension over the largest derivative of the static tension.

    Raises
    ------
    InvalidInput, NumericalFailure
        There is no steady shape.
    """
    answer = frequency_response(
        tow,
        [_OMEGA],
        amplitude=_AMPLITUDE,
        direction="surge",
        segments=_SEGMENTS,
        drag=drag,
        tolerance=_TIGHT,
        companion=False,
    )
    derivative = _derivative(tow, answer)
    velocity = 1j * _OMEGA * _AMPLITUDE
    return float(np.max(np.abs((answer.tension[0] / velocity).real - derivative)) / np.max(np.abs(derivative)))


def _derivative(tow: Tow, answer: Response) -> np.ndarray:
    """Static tension by the tow speed, at the nodes of the response [N s/m]."""

    def at(change: float) -> np.ndarray:
        return static_shape(replace(tow, speed=tow.speed + change), nodes=answer.shape.s).T

    central: np.ndarray = (8.0 * (at(_STEP) - at(-_STEP)) - (at(2.0 * _STEP) - at(-2.0 * _STEP))) / (12.0 * _STEP)
    return central


def _flows(tow: Tow) -> list[tuple[float, Tow]]:
    """The tow in several flows, each with the flow at its top [m/s]."""
    surface = 0.0 if tow.current is None else float(tow.current.at(0.0))
    own = surface - tow.speed
    if own == 0.0:
        return [(flow, replace(tow, current=Current.uniform(flow), speed=0.0)) for flow in _FLOWS]
    found = []
    for share in _SHARES:
        current = None
        if tow.current is not None:
            speed, direction = share * tow.current.speed, tow.current.direction
            current = Current(depth=tow.current.depth, speed=speed, direction=direction)
        found.append((math.fabs(share * own), replace(tow, current=current, speed=share * tow.speed)))
    return found
