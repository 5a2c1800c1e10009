"""What W says of turns, each with our figure beside it and a verdict (W section 3.2 and conclusion)."""

import pandas as pd

from ident.claims import full_turns, parts
from ident.claims.runs import Group, groups
from ident.claims.view import View
from ident.configuration import Configuration

__all__ = ["Group", "claims", "groups"]


def claims(configuration: Configuration, turns: pd.DataFrame, heave: pd.DataFrame) -> pd.DataFrame:
    """A row a claim: `about`, `paper`, `ours`, `verdict` and `why`.

    Parameters
    ----------
    turns
        The rows of `turn.csv` of all `groups`.
    heave
        The rows of `ship-heave.csv`, with one to three parts.
    """
    view = View(configuration, turns)
    rows = [judge(view) for judge in (*full_turns.CLAIMS, *parts.CLAIMS)]
    return pd.DataFrame([*rows, parts.under_ship_heave(heave)], columns=["about", "paper", "ours", "verdict", "why"])
