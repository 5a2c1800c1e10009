"""Turns of a tow: plan views, heave and tension histories, and what a sweep makes of the heave's period."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports import style
from reports.series import Floats

#: Quantity that a sweep goes over: column of the table, label of the axis.
SWEPT = {
    "ratio": "R / L",
    "speed_m_s": "Tow speed, m/s",
    "length_m": "Main cable, m",
    "sigma": "$\\sigma = m\\,l/M$",
}
#: What stays the same along a line over each of them.
_KEPT = {
    "ratio": ["length_m", "speed_m_s", "turns"],
    "speed_m_s": ["length_m", "radius_m", "turns"],
    "length_m": ["radius_m", "speed_m_s", "turns"],
    "sigma": ["radius_m", "speed_m_s", "turns"],
}
_SHOWN = {
    "gap_over_circle": "Second gap / circle",
    "period_over_circle": "Fitted period / circle",
    "damping_ratio": "Damping ratio",
    "decay_per_turn": "Decay per turn",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TurnHistory:
    """One manoeuvre.

    Parameters
    ----------
    label
        Above its panel or in a legend: what tells it from the others.
    t
        (n,) [s] from where the ship begins to turn.
    circle
        Time of the ship's circle [s]; NaN in a U-turn.
    ship
        (n, 3) [m].
    bodies
        Name to (n, 3) [m], from the ship down.
    tension_ship, tension_body
        (n,) [N] at both ends of the first cable.
    """

    label: str
    t: Floats
    circle: float
    ship: Floats
    bodies: Mapping[str, Floats]
    tension_ship: Floats
    tension_body: Floats


def plan_views(histories: Sequence[TurnHistory]) -> Figure:
    """Tracks of the ship and of all bodies seen from above, a panel for each run, all axes equal."""
    made, panels = _panels(len(histories), 2.2)
    for axes, history in zip(panels, histories, strict=False):
        axes.plot(history.ship[:, 0], history.ship[:, 1], color=style.GREY, linewidth=0.9, label="ship")
        for i, (name, track) in enumerate(history.bodies.items()):
            axes.plot(track[:, 0], track[:, 1], label=name, **_body(i))
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_title(history.label)
        axes.set_xlabel("x, m")
        axes.set_ylabel("y, m")
        style.few_ticks(axes.xaxis, 5)
        style.few_ticks(axes.yaxis, 5)
    _legend(made, panels)
    return made


def heave_histories(histories: Sequence[TurnHistory]) -> Figure:
    """Height of all bodies against time from the turn's begin, a panel for each run."""
    made, panels = _panels(len(histories), 1.9)
    for axes, history in zip(panels, histories, strict=False):
        for i, (name, track) in enumerate(history.bodies.items()):
            axes.plot(history.t, track[:, 2], label=name, **_body(i))
        axes.axvline(0.0, color=style.GREY, linewidth=0.7, linestyle=":")
        axes.set_xlim(history.t[0], history.t[-1])
        axes.set_title(history.label)
        axes.set_xlabel("Time in the turn, s")
        axes.set_ylabel("Height z, m")
        style.few_ticks(axes.xaxis, 5)
    _legend(made, panels)
    return made


def tension_histories(histories: Sequence[TurnHistory], body: str) -> Figure:
    """Tension at both ends of the first cable, a line for each run; full turns against the circles that were made."""
    circles = all(math.isfinite(history.circle) for history in histories)
    times = [history.t / (history.circle if circles else 1.0) for history in histories]
    made, grid = style.figure(4.2, rows=2, sharex=True)
    for axes, place in zip(grid[:, 0], ("tension_ship", "tension_body"), strict=True):
        for i, history in enumerate(histories):
            look = {"color": style.SEQUENCE[i % 7], "linestyle": style.DASHES[i % 6]}
            axes.plot(times[i], 1e-3 * getattr(history, place), label=history.label, linewidth=1.1, **look)
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel(f"At the {'ship' if place == 'tension_ship' else body}, kN")
    grid[1, 0].set_xlabel("Circles made" if circles else "Time in the turn, s")
    grid[1, 0].set_xlim(min(float(t[0]) for t in times), max(float(t[-1]) for t in times))
    _legend(made, [grid[0, 0]])
    return made


def sweep(table: pd.DataFrame, over: Sequence[str]) -> Figure:
    """Period over circle time, damping and decay against what a sweep goes over; runs without a figure leave a gap.

    Parameters
    ----------
    table
        One row a run and body: its ``length_m``, ``radius_m``, ``speed_m_s`` and ``turns``, the columns of `over` and
        of the four panels' quantities, and ``series``, which has a colour of its own and a line for each
        combination of what is kept along it.
    over
        Columns among those of `SWEPT`.
    """
    made, grid = style.figure(6.2, rows=len(_SHOWN), columns=len(over), sharex="col", sharey="row")
    for column, quantity in enumerate(over):
        for row, name in enumerate(_SHOWN):
            axes = grid[row, column]
            for i, (label, rows) in enumerate(table.groupby("series", sort=False)):
                if rows[list(_SHOWN)].isna().all(axis=None):
                    continue
                look = {"color": style.SEQUENCE[i % 7], "linestyle": style.DASHES[i % 6]}
                for _, line in rows.sort_values(quantity).groupby(_KEPT[quantity]):
                    axes.plot(line[quantity], line[name], marker=style.MARKERS[i % 7], label=str(label), **look)
            axes.set_ylim(0.0, 1.1 * float(np.nanmax([*table[name], 0.01])))
            if name.endswith("over_circle"):
                axes.axhline(1.0, color=style.GREY, linewidth=0.8, linestyle=":")
            if column == 0:
                axes.set_ylabel(_SHOWN[name])
        low, high = float(table[quantity].min()), float(table[quantity].max())
        grid[-1, column].set_xlim(low - 0.05 * (high - low), high + 0.05 * (high - low))
        grid[-1, column].set_xlabel(SWEPT[quantity])
    _legend(made, grid[0])
    return made


def ship_heave(table: pd.DataFrame) -> Figure:
    """Heave of each body over that of the ship, a group for each tow and a bar for each body.

    Parameters
    ----------
    table
        One row a tow, period and body: ``parts``, ``period_s``, ``body`` and ``of_ship`` [-].
    """
    periods = sorted(table["period_s"].unique())
    made, grid = style.figure(2.6, columns=len(periods), sharey=True)
    names = list(dict.fromkeys(table["body"]))
    counts = sorted(table["parts"].unique())
    for axes, period in zip(grid[0], periods, strict=True):
        rows = table[table["period_s"] == period]
        for i, name in enumerate(names):
            own = rows[rows["body"] == name]
            places = [counts.index(parts) + 0.26 * (i - 0.5 * (parts - 1)) for parts in own["parts"]]
            axes.bar(places, own["of_ship"], 0.24, color=style.SEQUENCE[i], label=name)
        axes.set_xticks(range(len(counts)), [f"{parts} part{'' if parts == 1 else 's'}" for parts in counts])
        axes.set_title(f"Ship heave of {period:g} s")
        axes.grid(visible=False, axis="x")
    grid[0, 0].set_ylabel("Heave over the ship's")
    _legend(made, grid[0])
    return made


def _panels(count: int, height: float) -> tuple[Figure, list[Axes]]:
    """So many panels two to a row, those of no use taken away."""
    columns = min(2, count)
    rows = math.ceil(count / columns)
    made, grid = style.figure(0.35 + height * rows, rows=rows, columns=columns)
    panels = list(np.ravel(grid))
    for axes in panels[count:]:
        axes.remove()
    return made, panels[:count]


def _body(place: int) -> dict[str, Any]:
    """The look of a body by its place from the ship down."""
    return {"color": style.SEQUENCE[place % 7], "linestyle": style.DASHES[place % 6], "linewidth": 1.2}


def _legend(made: Figure, panels: Iterable[Axes]) -> None:
    """One legend of all panels, above them."""
    found: dict[str, Any] = {}
    for axes in panels:
        handles, labels = axes.get_legend_handles_labels()
        found |= dict(zip(labels, handles, strict=True))
    made.legend(found.values(), found.keys(), loc="outside upper right", ncols=min(4, len(found)))
