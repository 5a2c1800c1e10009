"""Point labels that overlap neither each other nor the data, for a handful of points.

Boxes are arrays (..., 4) of left, bottom, right, top in points.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_ANGLES = tuple(np.deg2rad([0.0, 180.0, 90.0, -90.0, 30.0, -30.0, 150.0, -150.0, 60.0, -60.0, 120.0, -120.0]).tolist())
_DISTANCES = (6.0, 13.0, 20.0, 27.0, 36.0, 46.0, 58.0)
_LEADER_SHARES = np.linspace(0.3, 0.95, 8)
#: How much worse it is to cover other words than to cover data, per area.
_WORDS = 20.0


def label_points(
    figure: Figure,
    axes: Axes,
    anchors: Sequence[Floats],
    texts: Sequence[str],
    colors: Sequence[str],
    *,
    obstacles: Floats,
    size: float = 7.5,
) -> None:
    """Write a text beside one of its points, with a thin leader where it had to move away.

    Parameters
    ----------
    figure, axes
        The figure with everything else drawn, limits set; its layout is fixed here.
    anchors
        (k, 2) data coordinates for each text: the points that it may stand beside.
    texts, colors
        n labels and their colours.
    obstacles
        (m, 2) data coordinates that labels should not cover.
    size
        [pt].
    """
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")
    scale = figure.dpi / 72.0
    limits = np.array(axes.get_window_extent().extents) / scale
    marks = _around(axes.transData.transform(obstacles) / scale, 4.0)
    words = np.empty((0, 4))
    places = [axes.transData.transform(points) / scale for points in anchors]
    for i in sorted(range(len(texts)), key=lambda i: -float(places[i][:, 1].max())):
        drawn = axes.text(0.0, 0.0, texts[i], fontsize=size)
        extent = drawn.get_window_extent()
        drawn.remove()
        size_drawn = extent.width / scale + 1.0, extent.height / scale + 1.0
        choices = [
            _choice(point, place, distance, angle, size_drawn, limits, marks, words)
            for point, place in zip(anchors[i], places[i], strict=True)
            for distance in _DISTANCES
            for angle in _ANGLES
        ]
        best = min(choices, key=lambda choice: choice.cost)
        words = np.vstack([words, best.boxes])
        axes.annotate(
            texts[i],
            xy=(float(best.point[0]), float(best.point[1])),
            xytext=best.offset,
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=size,
            color=colors[i],
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": colors[i], "shrinkA": 0.0, "shrinkB": 3.0}
            if len(best.boxes) > 1
            else None,
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Choice:
    """One place for a label, lower cost is better; `boxes` are its own and those along its leader."""

    cost: float
    point: Floats
    offset: tuple[float, float]
    boxes: Floats


def _choice(
    point: Floats,
    place: Floats,
    distance: float,
    angle: float,
    extent: tuple[float, float],
    limits: Floats,
    marks: Floats,
    words: Floats,
) -> _Choice:
    """The label whose nearest edge lies `distance` [pt] from the point in the direction of `angle`."""
    size = np.array(extent)
    across, up = float(np.cos(angle)), float(np.sin(angle))
    offset = distance * np.array([across, up]) + 0.5 * size * np.array([min(1.0, max(-1.0, 1.5 * across)), up])
    centre = place + offset
    box = np.concatenate([centre - 0.5 * size, centre + 0.5 * size])[None]
    outside = float(size.prod() - _overlaps(box, limits[None]).sum())
    cost = 1.2 * distance + 4.0 * outside + float(_overlaps(box, marks).sum() + _WORDS * _overlaps(box, words).sum())
    boxes = box
    if distance > _DISTANCES[0]:
        end = np.clip(place, box[0, :2], box[0, 2:])
        leader = _around(place + _LEADER_SHARES[:, None] * (end - place), 1.5)
        cost += _WORDS * float(_overlaps(leader, words).sum()) + float(_overlaps(leader, marks).sum())
        boxes = np.vstack([box, leader])
    return _Choice(cost, point, (float(offset[0]), float(offset[1])), boxes)


def _around(points: Floats, half: float) -> Floats:
    """(m, 4) squares about (m, 2) points."""
    squares: Floats = np.hstack([points - half, points + half])
    return squares


def _overlaps(boxes: Floats, others: Floats) -> Floats:
    """(j, k) shared areas of (j, 4) and (k, 4) boxes."""
    low = np.maximum(boxes[:, None, :2], others[None, :, :2])
    high = np.minimum(boxes[:, None, 2:], others[None, :, 2:])
    shared: Floats = np.maximum(0.0, high - low).prod(axis=2)
    return shared
