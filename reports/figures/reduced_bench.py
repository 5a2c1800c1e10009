"""Error against run time of the reduced models and of library integrators, growth, and the course of searches."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from reports import style
from reports.figures.bench import Curve

#: Panels beside one another.
_ROW = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Grown:
    """CPU times [s] of one model against a size, and the fitted exponent."""

    model: str
    what: str
    sizes: Sequence[float]
    seconds: Sequence[float]
    exponent: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Found:
    """Lowest error so far [m/s] after every simulation of one search, and where its simplexes begin."""

    model: str
    label: str
    best: Sequence[float]
    starts: Sequence[int]


def precision(curves: Sequence[Curve]) -> Figure:
    """A panel for each configuration, a line for each model; `best` holds the point of the usual step."""
    tows = list(dict.fromkeys(curve.tow for curve in curves))
    labels = list(dict.fromkeys(curve.label for curve in curves))
    made, grid = style.figure(3.6, columns=len(tows), sharey=True)
    for axes, tow in zip(grid[0], tows, strict=True):
        for curve in curves:
            if curve.tow != tow:
                continue
            i = labels.index(curve.label)
            look = {"color": style.SEQUENCE[i % 7], "marker": style.MARKERS[i % 7]}
            axes.plot(*zip(*curve.every, strict=True), markersize=2.0, linestyle=style.DASHES[i // 7 % 6], **look)
            axes.plot(*zip(*curve.best, strict=True), linestyle="none", markersize=5.0, **look)
        axes.set(xscale="log", yscale="log", title=tow, xlabel="RMS velocity error, m/s")
    grid[0, 0].set_ylabel("CPU time for an hour, s")
    for i, label in enumerate(labels):
        look = {"color": style.SEQUENCE[i % 7], "marker": style.MARKERS[i % 7], "linestyle": style.DASHES[i // 7 % 6]}
        grid[0, 0].plot([], [], label=label, **look)
    made.legend(loc="outside lower center", ncols=3)
    return made


def libraries(curves: Sequence[Curve]) -> Figure:
    """A panel for each model, a line for each method."""
    models = list(dict.fromkeys(curve.tow for curve in curves))
    labels = list(dict.fromkeys(curve.label for curve in curves))
    made, grid = style.figure(4.4, rows=math.ceil(len(models) / 2), columns=min(2, len(models)))
    for axes, model in zip(grid.flat, models, strict=False):
        for curve in curves:
            if curve.tow != model:
                continue
            i = labels.index(curve.label)
            look = {"color": style.SEQUENCE[i % 7], "marker": style.MARKERS[i % 7]}
            axes.plot(*zip(*curve.every, strict=True), linestyle="none", markersize=2.5, alpha=0.5, **look)
            axes.plot(*zip(*curve.best, strict=True), linestyle=style.DASHES[i % 6], **look)
        axes.set(xscale="log", yscale="log", title=model)
    for axes in grid[-1]:
        axes.set_xlabel("RMS velocity error, m/s")
    for axes in grid[:, 0]:
        axes.set_ylabel("CPU time for an hour, s")
    for i, label in enumerate(labels):
        look = {"color": style.SEQUENCE[i % 7], "marker": style.MARKERS[i % 7], "linestyle": style.DASHES[i % 6]}
        grid[0, 0].plot([], [], label=label, **look)
    for axes in list(grid.flat)[len(models) :]:
        axes.set_visible(False)
    made.legend(loc="outside lower center", ncols=5)
    return made


def growth(grown: Sequence[Grown]) -> Figure:
    """A panel for each size, a line for each model."""
    panels = list(dict.fromkeys(each.what for each in grown))
    made, grid = style.figure(2.9, columns=len(panels))
    for axes, what in zip(grid[0], panels, strict=True):
        lines = [each for each in grown if each.what == what]
        for i, each in enumerate(lines):
            look = {"color": style.SEQUENCE[i % 7], "marker": style.MARKERS[i % 7], "linestyle": style.DASHES[i % 6]}
            axes.plot(each.sizes, each.seconds, label=f"{each.model}: power {each.exponent:.2f}", **look)
        axes.set(xscale="log", yscale="log", xlabel=what, ylabel="CPU time, s")
        axes.set_xticks(list(lines[0].sizes), [f"{size:g}" for size in lines[0].sizes])
        axes.minorticks_off()
        axes.legend(loc="upper left")
        low, high = axes.get_ylim()
        # Room for the legend above the lines.
        axes.set_ylim(low, high * (high / low) ** 0.6)
    return made


def identification(found: Sequence[Found]) -> Figure:
    """A panel for each model, a line for each search; a ring where a fresh simplex begins."""
    models = list(dict.fromkeys(each.model for each in found))
    labels = list(dict.fromkeys(each.label for each in found))
    columns = min(_ROW, len(models))
    rows = math.ceil(len(models) / columns)
    made, grid = style.figure(0.6 + 1.7 * rows, rows=rows, columns=columns)
    for axes, model in zip(grid.flat, models, strict=False):
        for each in found:
            if each.model != model:
                continue
            i = labels.index(each.label)
            look = {"color": style.SEQUENCE[i % 7], "linestyle": style.DASHES[i % 6]}
            axes.plot(range(1, len(each.best) + 1), each.best, **look)
            begun = [start for start in each.starts if 0 < start < len(each.best)]
            at = [each.best[start] for start in begun]
            axes.plot([start + 1 for start in begun], at, "o", color=look["color"], fillstyle="none")
        axes.set(xscale="log", yscale="log")
        axes.set_title(model, fontsize=7.0)
        style.plain_log(axes.yaxis)
        axes.tick_params(which="both", labelsize=6.5)
    for axes in list(grid.flat)[len(models) :]:
        axes.set_visible(False)
    for i, label in enumerate(labels):
        grid[0, 0].plot([], [], color=style.SEQUENCE[i % 7], linestyle=style.DASHES[i % 6], label=label)
    for axes in grid[-1]:
        axes.set_xlabel("simulations")
    for axes in grid[:, 0]:
        axes.set_ylabel("RMS error, m/s")
    made.legend(loc="outside lower center", ncols=4)
    return made
