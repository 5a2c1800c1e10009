"""Responses over frequency: motion and tension of the ends, where they peak, and how much of them to trust."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from reports import style
from reports.series import Floats

#: Quantity to the label of its axis, motions in decibels of the amplitude of the input.
_MOTIONS = {"surge": "Surge, dB", "heave": "Heave, dB", "pitch": "Pitch, dB re 1 rad/m"}
_ENDS = {"tension_bottom": "At the vehicle", "tension_top": "At the top"}
#: Least range of a panel and what is never shown, however low a response falls [dB].
_LEAST_RANGE, _FLOOR = 6.0, 100.0
#: Digits of a number in double precision, and the colours of losing them.
_DIGITS = 16
_LOST = ("#7A1200", "#D55E00", "#E69F00", "#F0E442", "#B9D98E", "#56B4E9", "#2E86C1", "#08519C")


def levels(curves: Sequence[tuple[str, pd.DataFrame]], peaks: pd.DataFrame, printed: pd.DataFrame) -> Figure:
    """Surge, heave and pitch over the amplitude of the input (H figures 2 and 7), a panel each.

    Parameters
    ----------
    curves
        (label, table) with the columns ``omega_rad_s`` and ``surge_db`` and so on; the first is the one asked for.
    peaks
        Of the first curve: ``quantity, omega_rad_s, level_db``.
    printed
        What the paper prints: ``quantity, omega_rad_s, level_db``, either of the last two missing where it is not said.
    """
    moving = [name for name in _MOTIONS if np.isfinite(curves[0][1][f"{name}_db"]).any()]
    made, grid = style.figure(0.5 + 1.65 * len(moving), rows=len(moving), sharex=True)
    for axes, name in zip(grid[:, 0], moving, strict=True):
        reach = []
        for i, (label, table) in enumerate(curves):
            look = {
                "color": style.SEQUENCE[i % 7],
                "linestyle": style.DASHES[i % 6],
                "linewidth": 1.5 if i == 0 else 0.9,
            }
            axes.plot(table["omega_rad_s"], table[f"{name}_db"], label=label, zorder=3 - 0.1 * i, **look)
            reach.append(table[f"{name}_db"].to_numpy(dtype=float))
        own = peaks[peaks["quantity"] == name]
        axes.plot(own["omega_rad_s"], own["level_db"], "o", color=style.SEQUENCE[0], zorder=4)
        _printed(axes, printed[printed["quantity"] == name], "level_db")
        _decibels(axes, np.concatenate(reach))
        axes.set_ylabel(_MOTIONS[name])
    _frequencies(grid[-1, 0], curves[0][1])
    _legend(made, grid[:, 0])
    return made


def tensions(
    curves: Sequence[tuple[str, pd.DataFrame]], static: tuple[float, float], peaks: pd.DataFrame, printed: pd.DataFrame
) -> Figure:
    """Dynamic tension at both ends beside the static one, above which the cable goes slack (H figures 2 and 8).

    Parameters
    ----------
    curves, peaks, printed
        As of `levels`, with ``tension_bottom_N``, ``tension_top_N`` and ``level`` [N].
    static
        At the vehicle and at the top [N].
    """
    most = max(float(curves[0][1][f"{name}_N"].max()) for name in _ENDS)
    unit, scale = ("kN", 1e-3) if most >= 2000.0 else ("N", 1.0)
    made, grid = style.figure(3.9, rows=2, sharex=True)
    for axes, (name, place), steady in zip(grid[:, 0], _ENDS.items(), static, strict=True):
        for i, (label, table) in enumerate(curves):
            look = {
                "color": style.SEQUENCE[i % 7],
                "linestyle": style.DASHES[i % 6],
                "linewidth": 1.5 if i == 0 else 0.9,
            }
            axes.plot(table["omega_rad_s"], scale * table[f"{name}_N"], label=label, zorder=3 - 0.1 * i, **look)
        own = peaks[peaks["quantity"] == name]
        axes.plot(own["omega_rad_s"], scale * own["level"], "o", color=style.SEQUENCE[0], zorder=4)
        high = 1.12 * scale * float(curves[0][1][f"{name}_N"].max())
        if scale * steady <= 3.0 * high:
            axes.axhline(scale * steady, color=style.BLACK, linewidth=0.9, linestyle=":", label="static tension")
            high = max(high, 1.12 * scale * steady)
        axes.set_ylim(0.0, high)
        _printed(axes, printed[printed["quantity"] == name], "level")
        axes.set_ylabel(f"{place}, {unit}")
    _frequencies(grid[-1, 0], curves[0][1])
    _legend(made, grid[:, 0])
    return made


def segments(bends: pd.DataFrame, errors: pd.DataFrame, refinement: pd.DataFrame) -> Figure:
    """How fine the segments are: length and turn of each, the estimated error, and how it falls with their number.

    Parameters
    ----------
    bends
        ``s_m, segment_m, turn_deg`` of every segment: its length, and times the curvature.
    errors
        ``omega_rad_s`` and, for each quantity, the estimated error as a share of its largest amplitude.
    refinement
        ``segments, error``: the largest such share against the finest run.
    """
    made, grid = style.figure(4.4, rows=2, columns=2)
    (length, turn), (error, order) = grid
    for axes, name, label in ((length, "segment_m", "Segment, m"), (turn, "turn_deg", "Turn of a segment, degrees")):
        axes.plot(bends["s_m"], bends[name], color=style.BLUE, drawstyle="steps-mid")
        axes.set_ylim(0.0, 1.1 * max(float(bends[name].max()), 1e-2))
        axes.set_xlim(0.0, float(bends["s_m"].iloc[-1]))
        axes.set_xlabel("s from the vehicle, m")
        axes.set_ylabel(label)
    for i, name in enumerate(name for name in errors.columns if name != "omega_rad_s"):
        look = {"color": style.SEQUENCE[i % 7], "linestyle": style.DASHES[i % 6]}
        error.semilogy(errors["omega_rad_s"], errors[name].replace(0.0, np.nan), label=name.replace("_", ", "), **look)
    error.set_ylabel("Estimated error, share")
    _frequencies(error, errors)
    order.loglog(refinement["segments"], refinement["error"], "o-", color=style.BLUE, label="largest error")
    n, last = refinement["segments"].to_numpy(dtype=float), float(refinement["error"].iloc[-1])
    order.loglog(n, last * (n[-1] / n) ** 2, color=style.GREY, linestyle=":", label="second order")
    order.set_xlabel("Segments")
    order.set_ylabel("Error, share")
    style.plain_log(order.xaxis)
    order.legend()
    made.legend(*error.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return made


def digits(kept: pd.DataFrame, own: pd.DataFrame, label: str) -> Figure:
    """Digits that the product of matrices keeps, over length and frequency for each normal drag coefficient.

    Parameters
    ----------
    kept
        ``length_m, coefficient, omega_rad_s, digits`` on a full grid; NaN where there is no static shape.
    own
        At the length and drag of the configuration: ``omega_rad_s``, ``digits`` of the product by its growth,
        ``stable`` those of the stable solve by its rounding, ``agreement`` those that both share, NaN if refused.
    label
        What the lengths are of.
    """
    coefficients = sorted(kept["coefficient"].unique())
    made = Figure(figsize=(style.WIDTH, 4.3), dpi=style.DPI, layout="constrained")
    above, below = made.subfigures(2, 1, squeeze=False, height_ratios=[1.15, 1.0])[:, 0]
    norm = BoundaryNorm(np.arange(0, _DIGITS + 1, 2), len(_LOST))
    panels = above.subplots(1, len(coefficients), squeeze=False, sharey=True)[0]
    mesh: Any = None
    for axes, coefficient in zip(panels, coefficients, strict=True):
        grid = kept[kept["coefficient"] == coefficient].pivot(index="length_m", columns="omega_rad_s", values="digits")
        shown = np.clip(grid.to_numpy(dtype=float), 0.0, _DIGITS - 1e-9)
        mesh = axes.pcolormesh(
            _edges(grid.columns.to_numpy(dtype=float)),
            _edges(grid.index.to_numpy(dtype=float)),
            np.ma.masked_invalid(shown),
            norm=norm,
            cmap=ListedColormap(list(_LOST)),
        )
        axes.set_yscale("log")
        style.plain_log(axes.yaxis)
        axes.set_facecolor("#D0D0D0")
        axes.grid(visible=False)
        axes.set_title(f"$C_n$ = {coefficient:g}")
        axes.set_xlabel("Frequency, rad/s")
        style.few_ticks(axes.xaxis, 4)
    panels[0].set_ylabel(f"{label}, m")
    above.colorbar(mesh, ax=list(panels), label="Digits kept", pad=0.02)
    line = below.subplots()
    at = own["omega_rad_s"]
    line.plot(at, own["stable"], color=style.GREEN, linestyle=style.DASHES[1], label="stable solve")
    line.plot(at, own["digits"], color=style.BLUE, label="product")
    line.plot(at, own["agreement"], "o", color=style.VERMILION, markersize=3.0, label="shared by both")
    line.set_ylim(-0.5, 17.0)
    line.set_ylabel("Digits")
    _frequencies(line, own)
    below.legend(loc="outside upper right", ncols=3)
    return made


def _edges(centres: Floats) -> Floats:
    """Edges of cells about increasing positive centres, half way by ratio."""
    middle = np.sqrt(centres[1:] * centres[:-1])
    edges: Floats = np.concatenate([[centres[0] ** 2 / middle[0]], middle, [centres[-1] ** 2 / middle[-1]]])
    return edges


def _printed(axes: Axes, rows: pd.DataFrame, level: str) -> None:
    """A cross where frequency and level are printed, a line where only the frequency is."""
    whole = rows[rows["omega_rad_s"].notna() & rows[level].notna()]
    if len(whole):
        axes.plot(whole["omega_rad_s"], whole[level], "x", color=style.BLACK, markersize=7.0, zorder=5, label="printed")
    for omega in rows.loc[rows["omega_rad_s"].notna() & rows[level].isna(), "omega_rad_s"]:
        axes.axvline(float(omega), color=style.GREY, linewidth=0.9, linestyle="-.", zorder=1, label="peak as printed")


def _decibels(axes: Axes, values: Floats) -> None:
    """Limits about all levels, but not farther down than is of use."""
    found = values[np.isfinite(values)]
    high = float(found.max())
    low = max(float(found.min()), high - _FLOOR)
    middle, half = 0.5 * (high + low), 0.5 * max(high - low, _LEAST_RANGE)
    axes.set_ylim(middle - 1.08 * half, middle + 1.1 * half)


def _frequencies(axes: Axes, table: pd.DataFrame) -> None:
    axes.set_xlabel("Frequency, rad/s")
    axes.set_xlim(float(table["omega_rad_s"].min()), float(table["omega_rad_s"].max()))
    style.few_ticks(axes.xaxis, 6)


def _legend(made: Figure, panels: Sequence[Axes]) -> None:
    """One legend of all panels, above them."""
    found: dict[str, Any] = {}
    for axes in panels:
        handles, labels = axes.get_legend_handles_labels()
        found = dict(zip(labels, handles, strict=True)) | found
    made.legend(found.values(), found.keys(), loc="outside upper right", ncols=4)
