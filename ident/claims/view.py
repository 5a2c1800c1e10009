"""What claims are judged by: the runs that they speak of, trends as powers, and the verdicts."""

import math

import numpy as np
import pandas as pd

from data_synth.ships import KNOT
from ident.claims.runs import RADII, SPEEDS
from ident.configuration import Configuration
from reports.markdown import significant

#: A trend y ~ x^p counts from this exponent on.
FLAT = 0.1

AGREES, PARTLY, DISAGREES, UNKNOWN = "agrees", "agrees in part", "disagrees", "cannot tell"


class View:
    """The parts of the table of turns that a claim speaks of.

    Attributes
    ----------
    base
        All bodies of one, two and three parts in the tightest, fastest turn.
    radii, speeds
        The first body of one part, a row a radius or speed.
    lengths
        The first body of two parts, a row a length.
    all_parts
        The first body of all parts, a row a radius.
    u_turns
        The first body, a row a radius and speed.
    """

    def __init__(self, configuration: Configuration, turns: pd.DataFrame) -> None:
        first = turns["body"].iloc[0]
        own = np.isclose(turns["length_m"], configuration.tow.cable.length)
        fast = np.isclose(turns["speed_m_s"], max(SPEEDS) * KNOT)
        tight = np.isclose(turns["radius_m"], RADII[0])
        full, top = turns["manoeuvre"] == "full-turn", turns["body"] == first
        one = turns["parts"] == 1
        self.base = turns[full & own & fast & tight].drop_duplicates(["parts", "body"])
        self.radii = _by(turns[full & top & one & own & fast], "radius_m")
        self.speeds = _by(turns[full & top & one & own & tight], "speed_m_s")
        by_length = turns[full & top & fast & tight & (turns["parts"] == min(2, turns["parts"].max()))]
        self.lengths = _by(by_length, "length_m")
        last = turns["parts"] == min(3, turns["parts"].max())
        self.all_parts = _by(turns[full & top & last & own & fast], "radius_m")
        self.u_turns = turns[~full & top].sort_values(["radius_m", "speed_m_s"])

    def body(self, parts: int, place: int) -> "pd.Series | None":
        """One body of the tow of so many parts in the tightest, fastest turn; ``None`` where there is none."""
        rows = self.base[self.base["parts"] == parts]
        return rows.iloc[place] if len(rows) > place else None


def _by(rows: pd.DataFrame, column: str) -> pd.DataFrame:
    return rows.drop_duplicates(column).sort_values(column)


def exponent(x: "pd.Series[float]", y: "pd.Series[float]") -> float:
    """p of the best ``y ~ x^p``; NaN where fewer than three points are known."""
    known = (x > 0.0) & (y > 0.0)
    if int(known.sum()) < 3:
        return math.nan
    return float(np.polyfit(np.log(x[known]), np.log(y[known]), 1)[0])


def ends(rows: pd.DataFrame, x: str, y: str, unit: str, scale: float = 1.0) -> str:
    """``0.254 at 2 kn to 0.0428 at 6 kn``: the first and the last known value."""
    known = rows[rows[y].notna()]
    if known.empty:
        return "no figure"
    both = [known.iloc[i] for i in ((0, -1) if len(known) > 1 else (0,))]
    return " to ".join(f"{significant(float(row[y]))} at {float(row[x]) / scale:.4g}{unit}" for row in both)


def claim(about: str, paper: str, ours: str, verdict: str, why: str) -> dict[str, str]:
    """A row of the table of claims."""
    return {"about": about, "paper": paper, "ours": ours, "verdict": verdict, "why": why}


def trend(p: float, wanted: float) -> str:
    """Whether an exponent has the sign that is wanted."""
    if math.isnan(p):
        return UNKNOWN
    return AGREES if p * wanted > FLAT else DISAGREES


def power(p: float, of: str) -> str:
    """What follows the name of a quantity."""
    return "is known in fewer than three runs" if math.isnan(p) else f"goes as {of} to the power {p:+.2f}"
