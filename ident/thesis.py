"""What the thesis prints for its three tows, beside which a report sets its own figures (T tables 6-I, 6-II, 6.7)."""

from typing import NamedTuple

import pandas as pd

_MODELS = ("second-order-linear", "inertial-4-linear", "second-order-quadratic", "inertial-4-quadratic")


class _Printed(NamedTuple):
    """RMS velocity [m/s] and position [m] errors of `_MODELS`, and b/k [s2/m] predicted and identified."""

    velocity: tuple[tuple[float, ...], tuple[float, ...]]
    position: tuple[tuple[float, ...], tuple[float, ...]]
    drag_over_spring: tuple[float, float]


_PRINTED = {
    "mangus-740": _Printed(
        ((0.048, 0.061, 0.031, 0.017), (0.051, 0.049, 0.036, 0.026)),
        ((11.5, 9.1, 5.6, 4.0), (20.2, 20.6, 8.8, 6.7)),
        (459.0, 571.0),
    ),
    "autec-1200": _Printed(
        ((0.051, 0.059, 0.032, 0.011), (0.070, 0.058, 0.064, 0.026)),
        ((9.6, 7.8, 4.5, 1.6), (13.3, 13.6, 8.6, 4.6)),
        (425.0, 500.0),
    ),
    "mangus-2500": _Printed(
        ((0.030, 0.034, 0.027, 0.006), (0.047, 0.051, 0.045, 0.014)),
        ((14.6, 10.3, 11.0, 3.7), (2.4, 3.9, 2.2, 1.5)),
        (2778.0, 4833.0),
    ),
}
#: Massless models, printed for 1200 m only (T 6.6): velocity error at identification and at verification.
_MASSLESS = {"first-order-quadratic": (0.0336, 0.0501), "massless-4-quadratic": (0.01039, 0.0263)}
#: Delays of T 4.1 [s] by (length [m], weight [N]).
DELAYS = {
    (500.0, 6000.0): 5.7,
    (1000.0, 6000.0): 10.2,
    (2500.0, 6000.0): 20.2,
    (2500.0, 11000.0): 17.7,
    (2500.0, 16000.0): 15.8,
}


def printed_errors(name: str, identification: str, verification: str) -> pd.DataFrame:
    """Columns model, record, rms_velocity_m_s, rms_position_m of a built-in tow; empty for any other name."""
    rows: list[tuple[str, str, float, float]] = []
    if name in _PRINTED:
        printed = _PRINTED[name]
        for i, record in enumerate((identification, verification)):
            rows += [(model, record, printed.velocity[i][k], printed.position[i][k]) for k, model in enumerate(_MODELS)]
            if name == "autec-1200":
                rows += [(model, record, errors[i], float("nan")) for model, errors in _MASSLESS.items()]
    return pd.DataFrame(rows, columns=["model", "record", "rms_velocity_m_s", "rms_position_m"])


def with_printed_drag_over_spring(name: str, table: pd.DataFrame) -> pd.DataFrame:
    """The b/k table with what T 6.7 prints for the second-order model beside it."""
    predicted, identified = _PRINTED[name].drag_over_spring if name in _PRINTED else (float("nan"), float("nan"))
    here = table["model"] == "second-order-quadratic"
    return table.assign(
        thesis_predicted=[predicted if yes else float("nan") for yes in here],
        thesis_identified=[identified if yes else float("nan") for yes in here],
    )
