"""A heave compensator: response maps over stiffness and damping, spectra, and what tuning does in a random sea."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from reports import style
from reports.series import Floats

#: Colours of a map by the value over the one that divides good from bad: blues below it, reds above.
_BOUNDS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0)
_COLOURS = ("#6BAED6", "#8FC3E1", "#B1D5EA", "#D0E5F2", "#EDF4F9", "#FCE3D6", "#F7BFA4", "#EC9376", "#DA6A55")
#: The looks of the strategies by their places.
_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": style.BLACK, "linestyle": "-"},
    {"color": style.VERMILION, "linestyle": style.DASHES[1]},
    {"color": style.BLUE, "linestyle": style.DASHES[2]},
    {"color": style.GREEN, "linestyle": style.DASHES[3]},
)
#: Where the lines of a map are labelled, as a share of the way across it.
_LABELS = 0.12
#: Values of a map that are too near to its edge for a label.
_EDGE = 4
_PEAK = {"color": style.GREY, "linewidth": 0.8, "linestyle": ":"}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ResponseMap:
    """Amplitudes over stiffness and damping at one frequency, for one metre of motion of the vessel.

    Parameters
    ----------
    stiffness, damping
        (n,) [N/m], (m,) [N s/m], increasing.
    amplitudes
        Quantity to (n, m), named as in `MAPPED`.
    locked
        Each quantity with the compensator locked.
    limit
        |R/D| that the stroke allows.
    critical
        k_crit [N/m]; infinite for none.
    marks
        What is marked: label to (stiffness, damping); what is not finite is left out.
    """

    stiffness: Floats
    damping: Floats
    amplitudes: Mapping[str, Floats]
    locked: Mapping[str, float]
    limit: float
    critical: float
    marks: Mapping[str, tuple[float, float]]


#: Quantity of a map to its title and the factor to its unit.
MAPPED = {
    "bottom": ("Towed body, $|p_1/D|$", 1.0),
    "relative": ("Compensator, $|R/D|$", 1.0),
    "tension_bottom": ("Tension at the body, $|T_1/D|$, kN/m", 1e-3),
    "tension_top": ("Tension at the top, $|T_n/D|$, kN/m", 1e-3),
}


def maps(response: ResponseMap, names: Sequence[str]) -> Figure:
    """Amplitudes over stiffness and damping, a panel for each name (H figures 3 and 4).

    The colour is the amplitude over that of the locked compensator, of the relative motion over the stroke's limit.
    """
    made, grid = style.figure(3.45, columns=len(names), sharey=True)
    norm, colours = BoundaryNorm(_BOUNDS, len(_COLOURS), extend="max"), ListedColormap(list(_COLOURS))
    for axes, name in zip(grid[0], names, strict=True):
        title, scale = MAPPED[name]
        own = response.amplitudes[name].T
        whole = response.limit if name == "relative" else response.locked[name]
        ratio = own / whole if whole > 0.0 else np.full(own.shape, np.inf)
        axes.contourf(
            response.stiffness,
            response.damping,
            np.minimum(ratio, 1e3),
            levels=_BOUNDS,
            colors=list(_COLOURS),
            extend="max",
        )
        lines = axes.contour(
            response.stiffness, response.damping, scale * own, levels=_levels(scale * own), colors="#444444"
        )
        lines.set(linewidth=0.5)
        places = _label_places(response, scale * own, lines.levels)
        axes.set(xscale="log", yscale="log")
        axes.clabel(lines, fontsize=6.5, fmt="%g", inline_spacing=2, manual=places, colors=style.BLACK)
        if response.limit > 0.0:
            axes.contour(
                response.stiffness,
                response.damping,
                response.amplitudes["relative"].T / response.limit,
                levels=[1.0],
                colors=style.BLACK,
                linewidths=1.5,
            )
        if np.isfinite(response.critical):
            axes.axvline(response.critical, color=style.BLACK, linewidth=1.0, linestyle=(0, (4, 2)))
        _marks(axes, response)
        axes.set_title(title)
        axes.set_xlabel("Stiffness, N/m")
        axes.grid(visible=False)
    grid[0, 0].set_ylabel("Damping, N s/m")
    of = "the limit" if set(names) == {"relative"} else "locked (left), the limit (right)"
    bar = made.colorbar(ScalarMappable(norm, colours), ax=grid[0].tolist(), aspect=30, pad=0.02)
    bar.set_label(f"Over {of}" if "relative" in names else "Over locked")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    if response.limit > 0.0:
        handles.append(grid[0, 0].plot([], [], color=style.BLACK, linewidth=1.5)[0])
        labels.append(f"stroke, |R/D| = {response.limit:.2f}")
    if np.isfinite(response.critical):
        handles.append(grid[0, 0].plot([], [], color=style.BLACK, linewidth=1.0, linestyle=(0, (4, 2)))[0])
        labels.append(f"$k_{{crit}}$ = {response.critical:.0f} N/m")
    made.legend(handles, labels, loc="outside upper left", ncols=5, columnspacing=1.0, handlelength=1.8)
    return made


def _levels(values: Floats) -> list[float]:
    """Round numbers that a map's lines are drawn at: three to the decade, in that of the largest value and below."""
    most = float(values.max())
    decade = 10.0 ** np.floor(np.log10(most))
    steps = [factor * share * decade for share in (0.1, 1.0) for factor in (1.0, 2.0, 5.0)]
    return [step for step in steps if float(values.min()) < step < most]


def _label_places(response: ResponseMap, values: Floats, levels: Iterable[float]) -> list[tuple[float, float]]:
    """Where each line is labelled: low down where it crosses a damping, else far left where it crosses a stiffness."""
    row, column = (round(_LABELS * (count - 1)) for count in values.shape)
    places = []
    for level in levels:
        across = np.flatnonzero(np.diff(np.sign(values[row] - level))[_EDGE:]) + _EDGE
        up = np.flatnonzero(np.diff(np.sign(values[:, column] - level))[_EDGE:]) + _EDGE
        if across.size:
            places += [(float(response.stiffness[i]), float(response.damping[row])) for i in across[:1]]
        else:
            places += [(float(response.stiffness[column]), float(response.damping[i])) for i in up[:1]]
    return places


def _marks(axes: Axes, response: ResponseMap) -> None:
    """The tuned settings, each with its marker."""
    for i, (label, (stiffness, damping)) in enumerate(response.marks.items()):
        if np.isfinite(stiffness) and np.isfinite(damping):
            axes.plot(
                stiffness,
                damping,
                style.MARKERS[i],
                color="white",
                markeredgecolor=style.BLACK,
                markeredgewidth=1.1,
                markersize=6.5,
                label=label,
                linestyle="none",
                zorder=6,
            )


def sea_and_vessel(table: pd.DataFrame, peak: float) -> Figure:
    """The wave's spectrum and that of the vessel's heave (H figure 5).

    Parameters
    ----------
    table
        ``omega_rad_s``, ``wave_m2_s``, ``vessel_m2_s``.
    peak
        Of the vessel's heave [rad/s].
    """
    made, grid = style.figure(2.3)
    axes = grid[0, 0]
    axes.plot(table["omega_rad_s"], table["wave_m2_s"], color=style.GREY, linestyle=style.DASHES[1], label="wave")
    axes.plot(table["omega_rad_s"], table["vessel_m2_s"], color=style.BLUE, linewidth=1.5, label="vessel heave")
    axes.axvline(peak, **_PEAK, label=f"peak of the heave, {peak:.3f} rad/s")
    axes.set_ylim(bottom=0.0)
    axes.set_xlim(*_band(table, "wave_m2_s", 0.985))
    axes.set_xlabel("Angular frequency, rad/s")
    axes.set_ylabel("Density, m²s/rad")
    axes.legend(loc="upper right")
    return made


#: Spectra of the strategies: column's ending to the label of its axis and the factor to its unit.
_SPECTRA = {
    "top_m2_s": ("Cable top, m²s/rad", 1.0),
    "relative_m2_s": ("Compensator, m²s/rad", 1.0),
    "heave_m2_s": ("Towed body, m²s/rad", 1.0),
    "tension_top_N2_s": ("Top tension, kN²s/rad", 1e-6),
}


def strategy_spectra(table: pd.DataFrame, strategies: Sequence[str], peak: float) -> Figure:
    """Response spectra of the strategies, a panel for each quantity.

    Parameters
    ----------
    table
        ``omega_rad_s`` and, for each strategy, ``NAME_top_m2_s`` and so on.
    strategies
        Names in the order of their looks.
    peak
        At which the compensator is tuned [rad/s].
    """
    made, grid = style.figure(4.2, rows=2, columns=2, sharex=True)
    for axes, (ending, (label, scale)) in zip(grid.flat, _SPECTRA.items(), strict=True):
        for i, name in enumerate(strategies):
            axes.plot(table["omega_rad_s"], scale * table[f"{name}_{ending}"], label=name, **_LOOKS[i % 4])
        axes.axvline(peak, **_PEAK)
        axes.set_xlim(*_band(table, "vessel_m2_s", 0.9995))
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel(label)
    for axes in grid[1]:
        axes.set_xlabel("Angular frequency, rad/s")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    made.legend(handles, labels, loc="outside upper left", ncols=4)
    return made


#: What a sweep shows: column to the label of its axis and the factor to its unit.
_SWEPT = {
    "R_thousandth_m": ("Compensator, m", 1.0),
    "Q_third_m": ("Towed body, m", 1.0),
    "T_n_thousandth_N": ("Top tension, kN", 1e-3),
}


def sweeps(table: pd.DataFrame, stroke: float, tuned: Mapping[str, float]) -> Figure:
    """What damping and stiffness do in the random sea, one column each, the other at its least.

    Parameters
    ----------
    table
        ``swept`` (``damping`` or ``stiffness``), ``value`` [N s/m or N/m] and the columns of the panels; the row
        ``locked`` of ``swept`` is the level of the locked compensator.
    stroke
        [m]
    tuned
        ``damping`` and ``stiffness`` to the value of the tuning rule.
    """
    made, grid = style.figure(5.4, rows=len(_SWEPT), columns=2, sharex="col", sharey="row")
    locked = table[table["swept"] == "locked"].iloc[0]
    titles = {"damping": "Damping, N s/m", "stiffness": "Stiffness, N/m"}
    for column, (swept, label) in enumerate(titles.items()):
        own = table[table["swept"] == swept].sort_values("value")
        for axes, (name, (words, scale)) in zip(grid[:, column], _SWEPT.items(), strict=True):
            axes.plot(own["value"], scale * own[name], "o-", color=style.BLUE, label="in the random sea")
            if name == "R_thousandth_m":
                axes.axhline(stroke, color=style.BLACK, linestyle=(0, (4, 2)), linewidth=1.0, label="stroke")
            else:
                axes.axhline(scale * float(locked[name]), color=style.GREY, linewidth=1.0, label="locked")
            axes.axvline(tuned[swept], color=style.VERMILION, linewidth=1.0, linestyle=":", label="tuned at the peak")
            axes.set_xscale("log")
            if column == 0:
                axes.set_ylabel(words)
        grid[-1, column].set_xlabel(label)
    for axes in grid[:, 0]:  # both columns are drawn by now, and share it
        axes.set_ylim(0.0, axes.get_ylim()[1])
    found: dict[str, Any] = {}
    for axes in grid[:2, 0]:
        handles, labels = axes.get_legend_handles_labels()
        found |= dict(zip(labels, handles, strict=True))
    made.legend(found.values(), found.keys(), loc="outside upper left", ncols=4)
    return made


def _band(table: pd.DataFrame, column: str, share: float) -> tuple[float, float]:
    """From the lowest frequency on, those that hold so much of a column's variance."""
    omega, density = table["omega_rad_s"].to_numpy(dtype=float), table[column].to_numpy(dtype=float)
    held = np.cumsum(density * np.gradient(omega))
    return float(omega[0]), float(omega[np.searchsorted(held, share * held[-1])])
