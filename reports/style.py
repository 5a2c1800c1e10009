"""One look for every figure: page width, fonts, palette, and a fixed line style for each reduced model.

The colours are those of Okabe and Ito, told apart with any colour vision; dashes, markers and line weights carry
the same distinction into grey prints. A group is a model without its drag law, such as ``inertial-4``; its
quadratic and its linear form share a colour.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogFormatterSciNotation, LogLocator, MaxNLocator, NullFormatter
from PIL import Image

#: Width of every figure [in]: 157 mm on paper, 930 px on a screen.
WIDTH = 6.2
DPI = 150
_COLORS = 128

BLACK = "#000000"
BLUE = "#0072B2"
SKY = "#56B4E9"
GREEN = "#009E73"
ORANGE = "#E69F00"
VERMILION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#7F7F7F"
PALE = "#EDEDED"

#: For things that have an order of their own (cable lengths, weights, towed records).
SEQUENCE = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK)
DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (5, 1.5, 1, 1.5)), (0, (1, 1)), (0, (8, 2, 2, 2)), (0, (3, 1)))
MARKERS = ("o", "s", "^", "D", "v", "P", "X")

SETTINGS: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.labelsize": 8.5,
    "axes.titlesize": 8.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 4.0,
    "axes.labelpad": 3.0,
    "axes.linewidth": 0.7,
    "axes.edgecolor": "#444444",
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "axes.unicode_minus": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "lines.linewidth": 1.1,
    "lines.markersize": 4.5,
    "legend.fontsize": 7.5,
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "legend.borderpad": 0.25,
    "legend.handlelength": 2.4,
    "legend.labelspacing": 0.3,
    "legend.columnspacing": 1.4,
    "hatch.linewidth": 0.6,
    "figure.dpi": DPI,
    "savefig.dpi": DPI,
    "figure.constrained_layout.h_pad": 0.05,
    "figure.constrained_layout.w_pad": 0.05,
}


@dataclass(frozen=True, slots=True)
class Look:
    """How one model is drawn: the same in every figure of a page."""

    color: str
    dash: Any
    marker: str
    width: float

    def line(self) -> dict[str, Any]:
        """Keywords of `Axes.plot` where several groups share one panel."""
        return {"color": self.color, "linestyle": self.dash, "linewidth": self.width}


_USUAL = {"inertial-4": 0, "massless-4": 1, "second-order": 2, "first-order": 3}


def is_baseline(model: str) -> bool:
    """Whether the name is that of a trivial predictor, not of a model."""
    return model.startswith("baseline")


def group(model: str) -> str:
    """The model without its drag law: ``massless-4-quadratic`` is of the group ``massless-4``."""
    return model.removesuffix("-quadratic").removesuffix("-linear")


def drag(model: str) -> str:
    """``linear`` or ``quadratic``, or an empty string for a baseline."""
    law = model.rsplit("-", 1)[-1]
    return law if law in ("linear", "quadratic") else ""


def groups(models: Iterable[str]) -> list[str]:
    """The groups in order of first appearance, baselines left out."""
    return list(dict.fromkeys(group(model) for model in models if not is_baseline(model)))


def looks(models: Iterable[str]) -> dict[str, Look]:
    """A look for each model: the usual groups keep theirs, others take what is left, baselines are grey."""
    names = list(dict.fromkeys(models))
    taken = {name: _USUAL[name] for name in groups(names) if name in _USUAL}
    free = cycle([i for i in range(len(SEQUENCE)) if i not in taken.values()] or range(len(SEQUENCE)))
    for name in groups(names):
        if name not in taken:
            taken[name] = next(free)
    found = {}
    for i, name in enumerate(name for name in names if is_baseline(name)):
        found[name] = Look((BLACK, GREY, BLACK)[i % 3], (DASHES[1], DASHES[3], "-")[i % 3], "x", (1.0, 1.0, 0.6)[i % 3])
    for name in names:
        if not is_baseline(name):
            k = taken[group(name)]
            found[name] = Look(SEQUENCE[k], DASHES[k % len(DASHES)], MARKERS[k], 0.8 if drag(name) == "linear" else 1.6)
    return found


def figure(height: float, rows: int = 1, columns: int = 1, **keywords: Any) -> tuple[Figure, Any]:
    """A page-wide figure with constrained layout, and its (rows, columns) array of axes; `height` in inches."""
    made = Figure(figsize=(WIDTH, height), dpi=DPI, layout="constrained")
    return made, made.subplots(rows, columns, squeeze=False, **keywords)


def fixed_grid(panel: float, rows: int, columns: int, **keywords: Any) -> tuple[Figure, Any]:
    """A page-wide grid of panels `panel` inches high with fixed margins: for many like panels, where a
    constrained layout would cost as much as the drawing. Tick labels of five characters and one line above
    each panel fit.
    """
    left, right, bottom, top, beside, between = 0.68, 0.06, 0.72, 0.24, 0.70, 0.30
    height = bottom + top + rows * panel + (rows - 1) * between
    width = (WIDTH - left - right - (columns - 1) * beside) / columns
    made = Figure(figsize=(WIDTH, height), dpi=DPI)
    axes = made.subplots(rows, columns, squeeze=False, **keywords)
    made.subplots_adjust(
        left=left / WIDTH,
        right=1.0 - right / WIDTH,
        bottom=bottom / height,
        top=1.0 - top / height,
        wspace=beside / width,
        hspace=between / panel,
    )
    return made, axes


def few_ticks(axis: Any, most: int) -> None:
    """At most so many intervals, at round numbers."""
    axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]))


def plain_log(axis: Any, numbers: tuple[float, ...] = (1.0, 2.0, 5.0)) -> None:
    """Plain numbers at 1, 2 and 5 of each decade on a logarithmic axis."""
    axis.set_major_locator(LogLocator(subs=numbers, numticks=30))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def few_log(*axes: Any) -> None:
    """Numbers that do not touch on logarithmic axes: powers of ten, or 1, 2 and 5 where hardly one is in sight."""
    for axis in axes:
        low, high = sorted(axis.get_view_interval())
        if high < 10.0**1.5 * low:
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=30))
        axis.set_major_formatter(LogFormatterSciNotation(labelOnlyBase=False))
        axis.set_minor_formatter(NullFormatter())


def shade_unscored(axes: Axes, start: float, scored_from: float) -> None:
    """Shade the stretch before the scored window."""
    if scored_from > start:
        axes.axvspan(start, scored_from, color=PALE, zorder=0, linewidth=0.0)


class Album:
    """The folder of a page's figures: draws each in the common style and hands back its link.

    Parameters
    ----------
    page_folder
        Where the page lies; the pictures go to its ``figures`` folder, made when needed.
    """

    def __init__(self, page_folder: Path) -> None:
        self._folder = page_folder / "figures"
        self._folder.mkdir(parents=True, exist_ok=True)

    def draw(self, name: str, build: Any, *arguments: Any, **keywords: Any) -> str:
        """Call ``build(*arguments, **keywords) -> Figure``, save it, and return the link relative to the page.

        The picture is reduced to a palette, a third of the size; the file carries neither date nor version, so
        that drawing it again gives the same bytes.
        """
        with rc_context(SETTINGS):
            made: Figure = build(*arguments, **keywords)
            canvas: Any = FigureCanvasAgg(made)
            canvas.draw()
        picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])
        palette = picture.quantize(_COLORS, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
        palette.save(self._folder / f"{name}.png", dpi=(DPI, DPI))
        return f"figures/{name}.png"
