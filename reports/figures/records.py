"""Time series of one record: ship and vehicle, and the models' errors (T figures 6-2 to 6-8, 6-11 to 6-26)."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from reports import style
from reports.series import RecordSeries

Floats = NDArray[np.float64]
_LAW_LINES: dict[str, dict[str, Any]] = {
    "linear": {"linestyle": (0, (3, 1)), "linewidth": 0.8, "alpha": 0.8},
    "quadratic": {"linestyle": "-", "linewidth": 1.2},
}
_SHORT = {"linear": "lin.", "quadratic": "quad."}


def rms(values: Floats) -> float:
    """Root mean square of the finite values."""
    finite = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(finite**2))) if finite.size else float("nan")


def response(record: RecordSeries) -> Figure:
    """Ship and vehicle: velocity above, position below (T figures 6-2 to 6-8)."""
    made, axes = style.figure(4.0, rows=2, sharex=True)
    upper, lower = axes[:, 0]
    pairs = (
        (upper, record.ship_velocity, record.vehicle_velocity),
        (lower, record.ship_position, record.vehicle_position),
    )
    for panel, ship, vehicle in pairs:
        style.shade_unscored(panel, float(record.t[0]), record.scored_from)
        panel.plot(record.t, ship, color=style.GREY, linewidth=0.9, label="ship")
        panel.plot(record.t, vehicle, color=style.BLUE, linewidth=1.4, label=record.vehicle_label)
    upper.set_ylabel("Velocity, m/s")
    lower.set_ylabel("Position, m")
    lower.set_xlabel("Time, s")
    lower.set_xlim(record.t[0], record.t[-1])
    _legend_above(upper)
    return made


def errors(record: RecordSeries, *, scored_only: bool = False) -> Figure:
    """Model minus vehicle for every model: velocity left, position right, one row a group (T figures 6-11 to 6-26).

    Above each panel stand the RMS errors of the scored window; limits are those of that window too.

    Parameters
    ----------
    record
        The vehicle and the models.
    scored_only
        Show the scored window alone, and baselines in the position panels.
    """
    names = style.groups(record.models)
    look = style.looks(record.models)
    made, axes = style.fixed_grid(0.82, len(names), 2, sharex=True, sharey="col")
    show = record.scored if scored_only else np.ones(record.t.shape, dtype=bool)
    baselines = [name for name in record.model_position if style.is_baseline(name)] if scored_only else []
    sides = (
        (axes[:, 0], record.model_velocity, record.vehicle_velocity, ".4f"),
        (axes[:, 1], record.model_position, record.vehicle_position, ".1f"),
    )
    for panels, modelled, vehicle, form in sides:
        error = {model: values - vehicle for model, values in modelled.items()}
        for panel, name in zip(panels, names, strict=True):
            if not scored_only:
                style.shade_unscored(panel, float(record.t[0]), record.scored_from)
            panel.axhline(0.0, color="#444444", linewidth=0.6)
            sizes = []
            for model in [*(name for name in baselines if name in error), *_members(error, name)]:
                line = {**look[model].line(), "linewidth": 0.8} if style.is_baseline(model) else _law_line(model, look)
                panel.plot(record.t[show], error[model][show], **line)
                if not style.is_baseline(model):
                    sizes.append(f"{_SHORT[style.drag(model)]} {rms(error[model][record.scored]):{form}}")
            panel.set_title(", ".join(sizes), loc="right", fontsize=7.5)
            style.few_ticks(panel.yaxis, 4)
        _limit(panels[0], [values[record.scored] for values in error.values()])
        panels[-1].set_xlabel("Time, s")
    for panel, name in zip(axes[:, 0], names, strict=True):
        panel.set_title(name, fontweight="bold")
    axes[0, 0].set_xlim(record.t[show][0], record.t[show][-1])
    for column, words in enumerate(("Velocity error, m/s", "Position error, m")):
        _side_label(made, axes[:, column], words)
    _key(made, [*_laws(record.models), *((name, look[name].line()) for name in baselines)])
    return made


def velocities(record: RecordSeries, *, observed: str = "observed") -> Figure:
    """Observed vehicle velocity and the models' over the scored window, one panel a group."""
    names = style.groups(record.model_velocity)
    look = style.looks(record.models)
    rows = (len(names) + 1) // 2
    made, axes = style.fixed_grid(1.15, rows, 2, sharex=True, sharey=True)
    t, own = record.t[record.scored], record.vehicle_velocity[record.scored]
    truth: dict[str, Any] = {"color": style.BLACK, "linewidth": 1.0}
    for panel, name in zip(axes.flat, names, strict=False):
        panel.plot(t, own, **truth)
        for model in _members(record.model_velocity, name):
            panel.plot(t, record.model_velocity[model][record.scored], **_law_line(model, look))
        panel.set_title(name, fontweight="bold")
        style.few_ticks(panel.yaxis, 5)
    for panel in list(axes.flat)[len(names) :]:
        panel.set_axis_off()
    axes[0, 0].set_xlim(t[0], t[-1])
    for panel in axes[-1]:
        panel.set_xlabel("Time, s")
    _side_label(made, axes[:, 0], "Velocity along the axis, m/s")
    _key(made, [(observed, truth), *_laws(record.model_velocity)])
    return made


def tracks(
    record: RecordSeries,
    ship_track: Floats,
    vehicle_track: Floats,
    *,
    depth: Floats | None = None,
    slant_range: Floats | None = None,
) -> Figure:
    """A recorded tow: plan view left; along the axis and in depth against time right.

    Parameters
    ----------
    record
        Motion along the axis; the scored window is shaded.
    ship_track, vehicle_track
        (n, 2) east and north [m] in a local origin.
    depth, slant_range
        (n,) [m], where known.
    """
    below = {name: values for name, values in (("depth", depth), ("slant range", slant_range)) if values is not None}
    made = Figure(figsize=(style.WIDTH, 3.6), dpi=style.DPI, layout="constrained")
    grid = made.add_gridspec(2, 2, width_ratios=(1.0, 1.15))
    plan = made.add_subplot(grid[:, 0])
    along = made.add_subplot(grid[0, 1] if below else grid[:, 1])
    ship: dict[str, Any] = {"color": style.GREY, "linewidth": 0.9}
    vehicle: dict[str, Any] = {"color": style.BLUE, "linewidth": 1.4}
    for track, line, label in ((ship_track, ship, "ship"), (vehicle_track, vehicle, "vehicle")):
        plan.plot(track[:, 0], track[:, 1], **line, label=label)
        first = track[np.isfinite(track).all(axis=1)][0]
        plan.plot(first[0], first[1], color=line["color"], marker="o", linestyle="none")
    _square(plan, np.concatenate([ship_track, vehicle_track]))
    plan.set_xlabel("East, m")
    plan.set_ylabel("North, m")
    _legend_above(plan)
    along.plot(record.t, record.ship_position, **ship)
    along.plot(record.t, record.vehicle_position, **vehicle)
    along.set_ylabel("Along the axis, m")
    panels = [along]
    if below:
        deep = made.add_subplot(grid[1, 1], sharex=along)
        for (name, values), color, dash in zip(
            below.items(), (style.VERMILION, style.GREEN), ("-", "--"), strict=False
        ):
            deep.plot(record.t, values, color=color, linestyle=dash, label=name)
        deep.set_ylabel("Depth and range, m" if len(below) == 2 else f"{next(iter(below)).capitalize()}, m")
        deep.invert_yaxis()
        along.tick_params(labelbottom=False)
        _legend_above(deep)
        panels.append(deep)
    for panel in panels:
        panel.axvspan(record.scored_from, record.t[-1], color=style.PALE, zorder=0, linewidth=0.0)
        style.few_ticks(panel.xaxis, 5)
        style.few_ticks(panel.yaxis, 5)
    panels[-1].set_xlabel("Time, s (scored part shaded)")
    along.set_xlim(record.t[0], record.t[-1])
    return made


def _square(panel: Axes, track: Floats) -> None:
    """Equal scales and a square of the plan that holds the whole track."""
    low, high = np.nanmin(track, axis=0), np.nanmax(track, axis=0)
    half = 0.54 * float(np.max(high - low))
    centre = 0.5 * (low + high)
    panel.set_xlim(centre[0] - half, centre[0] + half)
    panel.set_ylim(centre[1] - half, centre[1] + half)
    panel.set_aspect("equal")
    style.few_ticks(panel.xaxis, 4)
    style.few_ticks(panel.yaxis, 5)


def _members(models: Iterable[str], name: str) -> list[str]:
    """The models of a group, linear before quadratic, so that the better one is drawn on top."""
    return sorted((model for model in models if style.group(model) == name), key=style.drag)


def _law_line(model: str, look: Mapping[str, style.Look]) -> dict[str, Any]:
    """How a model is drawn in a panel of its own group: the colour is the group's, the dash the drag law's."""
    return {"color": look[model].color, **_LAW_LINES[style.drag(model)]}


def _laws(models: Iterable[str]) -> list[tuple[str, dict[str, Any]]]:
    """The drag laws among the models, for a key without colour."""
    present = {style.drag(model) for model in models}
    return [(law, {"color": style.GREY, **line}) for law, line in _LAW_LINES.items() if law in present]


def _side_label(made: Figure, panels: Sequence[Axes], words: str) -> None:
    """One label for a column of panels, left of its tick labels, midway up."""
    first, last = panels[0].get_position(), panels[-1].get_position()
    middle = 0.5 * (first.y1 + last.y0)
    made.text(first.x0 - 0.55 / style.WIDTH, middle, words, rotation=90, ha="center", va="center", fontsize=8.5)


#: Characters of a key that fit in one line across the page.
_KEY_LENGTH = 75


def _key(made: Figure, entries: Sequence[tuple[str, dict[str, Any]]]) -> None:
    """One legend for the whole figure, below it."""
    handles = [Line2D([], [], **line, label=label) for label, line in entries]
    short = sum(len(label) for label, _ in entries) <= _KEY_LENGTH
    made.legend(handles=handles, loc="lower right", ncols=len(handles) if short else 3, borderaxespad=0.2)


def _limit(panel: Axes, values: Sequence[Floats]) -> None:
    """Limits that hold the given values and zero."""
    finite = np.concatenate([part[np.isfinite(part)] for part in values]) if values else np.empty(0)
    if finite.size:
        low, high = min(0.0, float(finite.min())), max(0.0, float(finite.max()))
        margin = 0.06 * (high - low) or 1.0
        panel.set_ylim(low - margin, high + margin)


def _legend_above(panel: Axes) -> None:
    """A one-line legend above the panel's right end, clear of the data."""
    handles, labels = panel.get_legend_handles_labels()
    panel.legend(
        handles,
        labels,
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=len(handles),
        borderaxespad=0.1,
        handlelength=1.8,
    )
