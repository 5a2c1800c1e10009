"""What H prints of the heave compensator of its example 1, beside which a study sets its own figures."""

from collections.abc import Mapping
from typing import NamedTuple

import pandas as pd

from models.compensator import Setting

#: The configuration that Table II describes, and the stroke [m] and least stiffness and damping of the printed values.
NAME, STROKE, LEAST = "swath-4000", 4.0, 100.0
#: Strategies of Table IV, in the order of its columns.
STRATEGIES = ("locked", "tuned-stiffness", "tuned-damping")


class TableThree(NamedTuple):
    """Tuned damping [N s/m], tuned stiffness [N/m] and k_crit [N/m] of a sea state, from the linear analysis."""

    damping: float
    stiffness: float
    critical: float


TABLE_THREE = {5: TableThree(3160.0, 6410.0, 1600.0), 6: TableThree(7150.0, 7020.0, 1510.0)}

#: Table IV by sea state: row to the values of `STRATEGIES`; its tensions are in kN.
_TABLE_FOUR = {
    5: {
        "H_third_m": (3.23, 3.23, 3.23),
        "D_third_m": (2.99, 2.99, 2.99),
        "p_n_third_m": (2.99, 3.28, 1.28),
        "R_third_m": (0.00, 1.74, 2.21),
        "Q_third_m": (4.81, 4.99, 2.32),
        "R_thousandth_m": (0.00, 3.24, 4.11),
        "T_1_thousandth_N": (5.18e3, 5.38e3, 1.42e3),
        "T_1_N": (3.14e3, 3.14e3, 3.14e3),
        "T_n_thousandth_N": (10.62e3, 10.47e3, 4.51e3),
        "T_n_N": (35.70e3, 35.70e3, 35.70e3),
    },
    6: {
        "H_third_m": (4.99, 4.99, 4.99),
        "D_third_m": (5.25, 5.25, 5.25),
        "p_n_third_m": (5.25, 5.53, 3.47),
        "R_third_m": (0.00, 2.07, 2.13),
        "Q_third_m": (7.02, 7.25, 5.06),
        "R_thousandth_m": (0.00, 3.84, 3.95),
        "T_1_thousandth_N": (7.77e3, 8.09e3, 4.08e3),
        "T_1_N": (3.14e3, 3.14e3, 3.14e3),
        "T_n_thousandth_N": (13.55e3, 13.68e3, 8.80e3),
        "T_n_N": (35.70e3, 35.70e3, 35.70e3),
    },
}
#: The rows of Table IV, in its order.
ROWS = tuple(_TABLE_FOUR[6])
#: Those that a strategy changes.
_DEPENDENT = tuple(name for name in ROWS if name not in ("H_third_m", "D_third_m", "T_1_N", "T_n_N"))


def printed(name: str, sea_state: int, *, stroke: float, stiffness: float, damping: float) -> bool:
    """Whether the paper prints values for a configuration with this stroke and these least values."""
    return name == NAME and sea_state in TABLE_THREE and (stroke, stiffness, damping) == (STROKE, LEAST, LEAST)


def settings(sea_state: int) -> dict[str, Setting]:
    """The two tuned strategies of Table IV as Table III prints them."""
    tuned = TABLE_THREE[sea_state]
    return {
        "tuned-stiffness": Setting(stiffness=tuned.stiffness, damping=LEAST),
        "tuned-damping": Setting(stiffness=LEAST, damping=tuned.damping),
    }


def table_four(sea_state: int) -> pd.DataFrame:
    """Table IV of a sea state: a column ``strategy`` and one for each of `ROWS`."""
    rows = _TABLE_FOUR[sea_state]
    return pd.DataFrame({"strategy": STRATEGIES, **{name: rows[name] for name in ROWS}})


def beside_table_four(
    sea_state: int, ours: Mapping[str, Mapping[str, float]], at_printed: Mapping[str, Mapping[str, float]]
) -> pd.DataFrame:
    """Table IV, a row a strategy and quantity that depends on it, beside what we make of it.

    Parameters
    ----------
    ours, at_printed
        Strategy to the quantities of `ROWS`, with our settings and with those of `settings`.

    Returns
    -------
    pd.DataFrame
        ``strategy, quantity, printed, at_printed_settings, off_percent, at_our_settings, our_off_percent``.
    """
    rows = []
    for i, strategy in enumerate(STRATEGIES):
        for quantity in _DEPENDENT:
            printed = _TABLE_FOUR[sea_state][quantity][i]
            if printed > 0.0:
                values = (at_printed[strategy][quantity], ours[strategy][quantity])
                off = [100.0 * (value / printed - 1.0) for value in values]
                rows.append((strategy, quantity, printed, values[0], off[0], values[1], off[1]))
    names = ["strategy", "quantity", "printed", "at_printed_settings", "off_percent", "at_our_settings"]
    return pd.DataFrame(rows, columns=[*names, "our_off_percent"])
