"""The cable seen from the side: the static shape and snapshots of it in motion (T figure 4-4)."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from reports import style

Floats = NDArray[np.float64]


def snapshots(static_x: Floats, static_z: Floats, taken: Sequence[tuple[float, Floats, Floats]]) -> Figure:
    """Static shape and snapshots; the horizontal scale is stretched.

    Parameters
    ----------
    static_x, static_z
        (n,) [m], z up from the surface.
    taken
        (time [s], x (k,) [m], z (k,) [m]) of each snapshot.
    """
    made, grid = style.figure(3.8)
    axes = grid[0, 0]
    axes.plot(static_x, static_z, color=style.BLACK, linewidth=1.4, linestyle="--", label="static shape")
    across = np.concatenate([static_x, *(x for _, x, _ in taken)])
    width, labelled = float(np.ptp(across)), -np.inf
    for i, (time, x, z) in enumerate(taken):
        shade = 0.4 + 0.6 * (i + 1) / len(taken)
        color = _mixed(style.BLUE, shade)
        lower = int(np.argmin(z))
        axes.plot(x, z, color=color, linewidth=1.0)
        axes.plot(x[lower], z[lower], "o", color=color, markersize=4.0)
        if abs(float(x[lower]) - labelled) > 0.05 * width:
            labelled = float(x[lower])
            axes.annotate(
                f"{time:g}",
                (float(x[lower]), float(z[lower])),
                xytext=(0, -6),
                textcoords="offset points",
                ha="center",
                va="top",
                fontsize=7.0,
                color=color,
            )
    axes.axhline(0.0, color=style.SKY, linewidth=1.0)
    depth = -min(float(np.min(static_z)), *(float(np.min(z)) for _, _, z in taken)) if taken else -float(static_z.min())
    axes.set_ylim(-1.1 * depth, 0.04 * depth)
    axes.margins(x=0.06)
    axes.set_xlabel("Horizontal position, m (stretched)")
    axes.set_ylabel("Height above the surface, m")
    if taken:
        axes.plot(
            [], [], color=style.BLUE, marker="o", markersize=4.0, linewidth=1.0, label="snapshots, time in s below"
        )
    made.legend(loc="outside upper right", ncols=2)
    return made


def _mixed(color: str, share: float) -> tuple[float, float, float]:
    """The colour mixed with white."""
    channels = [int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    red, green, blue = (1.0 - share * (1.0 - channel) for channel in channels)
    return red, green, blue
