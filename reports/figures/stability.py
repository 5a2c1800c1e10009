"""The catalogue of extreme cases as pictures: how far each is from its bounds, and the map of aliasing."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from reports import style

#: Deviations below this share of the allowed one are drawn here.
_LEAST, _MOST = 1e-4, 1e4


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pairs:
    """Harmonics (n,) against stations (m,): error (n, m) as a share, and whether the simulator accepts a pair."""

    rows: Sequence[int]
    columns: Sequence[int]
    error: NDArray[np.float64]
    accepted: NDArray[np.bool_]
    limit: float


def deviations(shares: pd.DataFrame) -> Figure:
    """The worst deviation of every case over what is allowed, a row for each group: answers left, faults right of 1.

    Parameters
    ----------
    shares
        Columns ``case, group, share, control``.
    """
    groups = list(dict.fromkeys(shares["group"]))
    made, grid = style.figure(0.9 + 0.34 * len(groups))
    axes = grid[0, 0]
    for place, name in enumerate(groups):
        for control, mark, color in ((False, "o", style.BLUE), (True, "X", style.VERMILION)):
            some = shares[(shares["group"] == name) & (shares["control"] == control)]
            values = np.clip(np.sort(some["share"].to_numpy(dtype=float)), _LEAST, _MOST)
            # Cases of one group a little above each other, so that like ones are told apart.
            height = place + 0.22 * np.sin(2.4 * np.arange(values.size))
            axes.plot(values, height, mark, color=color, linestyle="none", markersize=4.0, alpha=0.8)
    axes.axvline(1.0, color=style.BLACK, linewidth=1.0)
    axes.set(xscale="log", xlim=(0.6 * _LEAST, 1.7 * _MOST), xlabel="deviation from the reference over the allowed one")
    axes.set_yticks(range(len(groups)), groups)
    axes.invert_yaxis()
    handles = [
        Line2D([], [], color=color, marker=mark, linestyle="none", label=label)
        for color, mark, label in ((style.BLUE, "o", "case"), (style.VERMILION, "X", "fault that must be caught"))
    ]
    made.legend(handles=handles, loc="outside upper right", ncols=2)
    return made


def aliasing(pairs: Pairs) -> Figure:
    """The error of every pair of harmonics and stations; those that the simulator accepts have a point."""
    made, grid = style.figure(3.2)
    axes = grid[0, 0]
    share = np.clip(np.where(np.isfinite(pairs.error), pairs.error, np.inf), 1e-6, 10.0)
    shown: Any = axes.pcolormesh(
        np.log10(share), cmap="cividis", vmin=-6.0, vmax=1.0, edgecolors="white", linewidth=0.5
    )
    for i, j in np.ndindex(pairs.error.shape):
        if not np.isfinite(pairs.error[i, j]):
            axes.plot(j + 0.5, i + 0.5, "x", color=style.BLACK, markersize=5.0)
        elif pairs.accepted[i, j]:
            axes.plot(j + 0.5, i + 0.5, "o", color="white", markersize=3.0)
        elif pairs.error[i, j] > pairs.limit:
            axes.plot(j + 0.5, i + 0.5, "s", color=style.VERMILION, markersize=4.0)
    axes.set_xticks(np.arange(len(pairs.columns)) + 0.5, [str(each) for each in pairs.columns])
    axes.set_yticks(np.arange(len(pairs.rows)) + 0.5, [str(each) for each in pairs.rows])
    axes.set(xlabel="stations", ylabel="harmonics")
    axes.grid(visible=False)
    bar = made.colorbar(shown, ax=axes, ticks=range(-6, 2, 2))
    bar.ax.set_yticklabels([f"1e{each}" for each in range(-6, 2, 2)])
    bar.set_label("error over the RMS velocity")
    return made
