"""Error against run time of several methods, and run time against size (both logarithmic)."""

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from reports import style


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """One method on one tow: (error [m/s], time [s]) of all its settings, and of those that are best."""

    tow: str
    label: str
    every: Sequence[tuple[float, float]]
    best: Sequence[tuple[float, float]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sizes:
    """Times [s] and iterations, of a step or of a frequency, against a size; the exponent fitted to the larger half."""

    what: str
    sizes: Sequence[float]
    seconds: Sequence[float]
    iterations: Sequence[float]
    exponent: float


def work_precision(curves: Sequence[Curve], time: str = "CPU time for an hour, s") -> Figure:
    """A panel for each tow: every setting a point, the best of each method joined by a line."""
    tows = list(dict.fromkeys(curve.tow for curve in curves))
    labels = list(dict.fromkeys(curve.label for curve in curves))
    made, grid = style.figure(2.9, columns=len(tows), sharey=True)
    for axes, tow in zip(grid[0], tows, strict=True):
        for curve in curves:
            if curve.tow != tow:
                continue
            i = labels.index(curve.label)
            look = {"color": style.SEQUENCE[i % 7], "marker": style.MARKERS[i % 7]}
            axes.plot(*zip(*curve.every, strict=True), linestyle="none", markersize=2.0, alpha=0.5, **look)
            axes.plot(*zip(*curve.best, strict=True), linestyle=style.DASHES[i % 6], label=curve.label, **look)
        axes.set(xscale="log", yscale="log", title=tow, xlabel="RMS velocity error, m/s")
        style.few_log(axes.xaxis, axes.yaxis)
    grid[0, 0].set_ylabel(time)
    handles = [each.get_legend_handles_labels() for each in grid[0]]
    named = dict(pair for lines, texts in handles for pair in zip(texts, lines, strict=True))
    made.legend(list(named.values()), list(named), loc="outside lower center", ncols=min(4, len(named)))
    return made


def growth(panels: Sequence[Sizes]) -> Figure:
    """A panel for each size: times, and the power law fitted to the larger half."""
    made, grid = style.figure(2.5, columns=len(panels))
    for axes, panel in zip(grid[0], panels, strict=True):
        axes.plot(panel.sizes, panel.seconds, color=style.BLUE, marker="o", linestyle="none")
        larger = panel.sizes[-max(2, len(panel.sizes) // 2) :]
        fitted = [panel.seconds[-1] * (size / panel.sizes[-1]) ** panel.exponent for size in larger]
        label = f"power {panel.exponent:.2f}"
        axes.plot(larger, fitted, color=style.VERMILION, linestyle=style.DASHES[1], label=label)
        axes.set(xscale="log", yscale="log", xlabel=panel.what, ylabel="CPU time, s")
        axes.set_xticks(list(panel.sizes), [f"{size:g}" for size in panel.sizes])
        axes.minorticks_off()
        style.plain_log(axes.yaxis)
        axes.legend(loc="upper left")
    return made
