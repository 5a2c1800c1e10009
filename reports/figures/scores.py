"""Scores as pictures: error against run time, bars for each record, and the course of the searches."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from reports import style
from reports.figures.labels import label_points
from reports.findings import by_model

Floats = NDArray[np.float64]


def error_against_run_time(scores: pd.DataFrame, records: Sequence[str]) -> Figure:
    """RMS velocity error over the cost of simulating an hour; filled for the first record, open for the second.

    Parameters
    ----------
    scores
        Columns model, record, rms_velocity_m_s, simulation_s_per_hour; baselines are left out.
    records
        One or two record names: that of the fit, and that of the verification.
    """
    made, grid = style.figure(3.9)
    axes = grid[0, 0]
    kept = scores[~scores["model"].map(style.is_baseline).astype(bool) & scores["record"].isin(list(records))]
    kept = kept[
        (kept["simulation_s_per_hour"] > 0.0) & kept["rms_velocity_m_s"].between(0.0, np.inf, inclusive="neither")
    ]
    look = style.looks(scores["model"])
    error = kept.pivot_table(index="model", columns="record", values="rms_velocity_m_s", sort=False)
    cost = 1e3 * kept.groupby("model", sort=False)["simulation_s_per_hour"].median()
    anchors, obstacles, colors = {}, [], []
    for model in map(str, error.index):
        x, drawn = float(cost[model]), look[model]
        values = error.loc[model].reindex(list(records)).to_numpy(dtype=float)
        finite = values[np.isfinite(values)]
        axes.plot(
            [x] * values.size, values, color=drawn.color, linewidth=0.7, linestyle=":" if drawn.width < 1 else "-"
        )
        for value, fill in zip(values, (drawn.color, "white"), strict=False):
            axes.plot(x, value, drawn.marker, color=drawn.color, markerfacecolor=fill, markersize=5.5)
        anchors[model] = np.column_stack([np.full(finite.size, x), finite])
        obstacles += [[x, value] for value in np.geomspace(finite.min(), finite.max(), 9)]
        colors.append(drawn.color)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.margins(0.16, 0.1)
    style.plain_log(axes.xaxis)
    style.plain_log(axes.yaxis)
    axes.set_xlabel("Time to simulate an hour of record, ms")
    axes.set_ylabel("RMS velocity error, m/s")
    fills = [style.GREY, "white"]
    made.legend(
        handles=[
            Line2D([], [], color=style.GREY, marker="o", linestyle="none", markerfacecolor=fill, label=name)
            for name, fill in zip(records, fills, strict=False)
        ],
        loc="outside upper right",
        ncols=2,
    )
    if anchors:
        label_points(made, axes, list(anchors.values()), list(anchors), colors, obstacles=np.array(obstacles))
    return made


#: Panels that fit side by side.
_PANELS = 3


def bars(
    scores: pd.DataFrame,
    records: Sequence[str],
    *,
    thesis: pd.DataFrame | None = None,
    floors: Mapping[str, float] | None = None,
) -> Figure:
    """RMS velocity error of every model, one panel a record.

    Parameters
    ----------
    scores
        Columns model, record, rms_velocity_m_s.
    records
        The panels, in order.
    thesis
        Columns model, record, rms_velocity_m_s: the values to reach, drawn as ticks.
    floors
        Record to the error [m/s] that its sensors alone make.
    """
    models = [str(name) for name in dict.fromkeys(scores["model"])]
    look = style.looks(models)
    columns = len(records) if len(records) <= _PANELS else 2
    rows = -(-len(records) // columns)
    made, axes = style.figure(0.5 + rows * (0.35 + 0.21 * len(models)), rows=rows, columns=columns, sharey=True)
    for panel in axes.flat[len(records) :]:
        panel.set_axis_off()
    places = np.arange(len(models))[::-1]
    goals = thesis if thesis is not None and len(thesis) else scores.iloc[:0]
    for panel, record in zip(axes.flat, records, strict=False):
        values = by_model(scores, record, "rms_velocity_m_s", models).replace(np.inf, np.nan).to_numpy()
        panel.barh(
            places,
            values,
            height=0.66,
            color=[look[name].color for name in models],
            alpha=0.85,
            hatch=["////" if style.drag(name) == "linear" else "" for name in models],
            edgecolor="white",
            linewidth=0.0,
        )
        goal = by_model(goals, record, "rms_velocity_m_s", models).to_numpy()
        top = np.nanmax(np.concatenate([values, goal])) if np.isfinite(values).any() else 1.0
        panel.set_xlim(0.0, 1.42 * top)
        panel.vlines(goal, places - 0.42, places + 0.42, color=style.BLACK, linewidth=1.8)
        for place, value, target in zip(places, values, goal, strict=True):
            text = f"{value:.4f}" if np.isfinite(value) else "–"
            reach = np.nanmax([value, target, 0.0])
            panel.text(reach + 0.03 * top, place, text, va="center", ha="left", fontsize=7.0)
        floor = (floors or {}).get(record, np.nan)
        if np.isfinite(floor):
            panel.axvline(floor, color=style.BLACK, linewidth=0.9, linestyle=":")
        panel.set_title(record)
        panel.set_xlabel("RMS error, m/s")
        panel.grid(visible=False, axis="y")
        panel.locator_params(axis="x", nbins=4)
        panel.tick_params(axis="y", length=0)
    for row in axes[:, 0]:
        row.set_yticks(places, models)
    handles = []
    if len(goals):
        handles.append(
            Line2D(
                [],
                [],
                color=style.BLACK,
                markeredgewidth=1.8,
                marker="|",
                markersize=9,
                linestyle="none",
                label="thesis",
            )
        )
    if any(np.isfinite((floors or {}).get(record, np.nan)) for record in records):
        handles.append(Line2D([], [], color=style.BLACK, linewidth=0.9, linestyle=":", label="sensors alone"))
    if handles:
        made.legend(handles=handles, loc="outside lower right", ncols=2)
    return made


def searches(histories: Mapping[str, Floats], starts: pd.DataFrame | None = None) -> Figure:
    """Best error so far against the number of simulations; beside it, where several starts ended, sorted.

    Parameters
    ----------
    histories
        Model to (k,) RMS velocity error [m/s] of each simulation in the order tried; a failed one is NaN or inf.
    starts
        Columns model, start, rms_velocity_m_s: one row a start point.
    """
    several = starts is not None and len(starts) > 0 and bool(starts["model"].duplicated().any())
    made, axes = style.figure(3.3, columns=2 if several else 1, sharey=True)
    look = style.looks(histories)
    course = axes[0, 0]
    for model, tried in histories.items():
        values = np.where(np.isfinite(tried), tried, np.inf)
        best = np.minimum.accumulate(values)
        count = np.arange(1, best.size + 1)
        keep = np.isfinite(best)
        course.step(count[keep], best[keep], where="post", label=model, **look[model].line())
        if keep.any():
            course.plot(count[-1], best[-1], look[model].marker, color=look[model].color)
    course.set_xscale("log")
    course.set_yscale("log")
    style.plain_log(course.xaxis, (1.0,))
    style.plain_log(course.yaxis)
    course.set_xlabel("Simulations")
    course.set_ylabel("Best RMS velocity error so far, m/s")
    if several and starts is not None:
        waterfall = axes[0, 1]
        for name, rows in starts.groupby("model", sort=False):
            ends = np.sort(rows["rms_velocity_m_s"].to_numpy(dtype=float))
            drawn = look.get(str(name)) or style.looks([str(name)])[str(name)]
            waterfall.plot(np.arange(1, ends.size + 1), ends, marker=drawn.marker, **drawn.line())
        waterfall.set_xlabel("Start point, sorted by result")
        waterfall.locator_params(axis="x", integer=True)
    made.legend(handles=course.get_legend_handles_labels()[0], loc="outside lower center", ncols=3)
    return made
