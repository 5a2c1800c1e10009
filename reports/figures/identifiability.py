"""What the record says of each parameter: intervals, and how parameters stand in for one another."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports import style
from reports.findings import is_determined, spoken

_NARROWEST, _WIDEST = 0.05, 20.0
_BLUE_TO_RED = LinearSegmentedColormap.from_list("correlation", [style.BLUE, "#FFFFFF", style.VERMILION])


def intervals(parameters: pd.DataFrame) -> Figure:
    """Identified value and 95 % interval of every parameter as a ratio to its mapped value.

    Parameters
    ----------
    parameters
        Columns model, parameter, mapped, identified, low, high, determined. An interval that leaves the axes ends
        in an arrow head.
    """
    models = [str(name) for name in dict.fromkeys(parameters["model"])]
    look = style.looks(models)
    rows = parameters[(parameters["mapped"].abs() > 0.0)]
    made, grid = style.figure(0.75 + 0.165 * (len(rows) + 0.4 * len(models)))
    axes = grid[0, 0]
    ratios = rows[["identified", "low", "high"]].div(rows["mapped"], axis=0)
    inside = ratios["identified"].replace([np.inf, -np.inf], np.nan).dropna()
    inside = inside[inside > 0.0]
    low_edge = max(_NARROWEST, min(0.5, float(inside.min()) / 1.5)) if len(inside) else 0.5
    high_edge = min(_WIDEST, max(2.0, 1.5 * float(inside.max()))) if len(inside) else 2.0
    place, ticks, names = 0.0, [], []
    for model in models:
        drawn = look[model]
        for index, row in rows[rows["model"] == model].iterrows():
            value, low, high = ratios.loc[[index]].to_numpy(dtype=float)[0]
            seen = float(np.clip(value, low_edge, high_edge)) if np.isfinite(value) else np.nan
            left = float(np.clip(low, low_edge, high_edge)) if np.isfinite(low) else seen
            right = float(np.clip(high, low_edge, high_edge)) if not np.isnan(high) else seen
            axes.plot([left, right], [place, place], color=drawn.color, linewidth=1.4, solid_capstyle="butt")
            for edge, beyond, mark in ((left, low < low_edge, "<"), (right, high > high_edge, ">")):
                axes.plot(edge, place, mark if beyond else "|", color=drawn.color, markersize=4.5, clip_on=False)
            fill = drawn.color if is_determined(row["determined"]) else "white"
            outside = not low_edge <= value <= high_edge
            axes.plot(
                seen, place, "x" if outside else drawn.marker, color=drawn.color, markerfacecolor=fill, markersize=5
            )
            ticks.append(place)
            names.append(f"{model}: {spoken(str(row['parameter']))}")
            place -= 1.0
        place -= 0.4
    axes.axvline(1.0, color=style.BLACK, linewidth=0.9)
    axes.set_xscale("log")
    axes.set_xlim(low_edge / 1.08, high_edge * 1.08)
    axes.set_ylim(place + 0.6, 0.8)
    style.plain_log(axes.xaxis)
    axes.set_yticks(ticks, names, fontsize=7.0)
    axes.grid(visible=False, axis="y")
    axes.set_xlabel("Identified over mapped value (no unit)")
    kinds = (("determined", style.GREY), ("not determined", "white"))
    made.legend(
        handles=[
            Line2D([], [], color=style.GREY, marker="o", markerfacecolor=fill, linestyle="none", label=name)
            for name, fill in kinds
        ],
        loc="outside upper right",
        ncols=2,
    )
    return made


def correlations(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Correlation of the estimates, one triangle a model with the symbols on its diagonal.

    Parameters
    ----------
    tables
        Model to a square table, symbols as index and columns, values from -1 to 1.
    """
    shown = {name: table for name, table in tables.items() if len(table) > 1}
    columns = 4
    rows = -(-len(shown) // columns)
    made, axes = style.figure(0.1 + 1.7 * rows, rows=rows, columns=columns, gridspec_kw={"hspace": 0.12})
    for panel, (model, table) in zip(axes.flat, shown.items(), strict=False):
        values = table.to_numpy(dtype=float)
        size = len(values)
        below = np.where(np.tri(size, k=-1, dtype=bool), values, np.nan)
        panel.imshow(below, cmap=_BLUE_TO_RED, vmin=-1.0, vmax=1.0)
        for i, symbol in enumerate(table.columns):
            panel.text(
                i, i, str(symbol), ha="center", va="center", fontsize=7.0 if size < 5 else 6.0, fontweight="bold"
            )
            for j in range(i):
                text = f"{values[i, j]:.2f}" if np.isfinite(values[i, j]) else "–"
                color = "white" if abs(values[i, j]) > 0.6 else "black"
                panel.text(j, i, text, ha="center", va="center", fontsize=7.5 if size < 5 else 6.0, color=color)
        panel.set_title(model, fontsize=7.5)
    for panel in axes.flat:
        panel.set_axis_off()
    return made
