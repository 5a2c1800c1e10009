"""What two simulators differ by against speed and against the angle of the cable (both logarithmic)."""

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from reports import style

#: Letters of labels that a row of the legend has room for.
_LEGEND = 90


@dataclass(frozen=True, slots=True, kw_only=True)
class Ladder:
    """One system over a ladder of speeds.

    Parameters
    ----------
    label
        In the legend.
    speed, angle
        [m/s], [deg].
    difference, stated
        RMS difference, and the error that the first simulator estimates for itself [m/s].
    marks
        (speed, angle, difference) where thresholds are passed.
    """

    label: str
    speed: Sequence[float]
    angle: Sequence[float]
    difference: Sequence[float]
    stated: Sequence[float]
    marks: Sequence[tuple[float, float, float]]


def differences(ladders: Sequence[Ladder], limits: Sequence[float], share: float) -> Figure:
    """Difference against speed and against angle, with `limits` [m/s] and the `share` of the speed; dots are errors."""
    made, grid = style.figure(3.4, columns=2, sharey=True)
    for place, axes in enumerate(grid[0]):
        for i, ladder in enumerate(ladders):
            across = (ladder.speed, ladder.angle)[place]
            look = {"color": style.SEQUENCE[i % 7], "marker": style.MARKERS[i % 7], "markersize": 3.5}
            axes.plot(across, ladder.difference, linestyle=style.DASHES[i % 6], label=ladder.label, **look)
            axes.plot(across, ladder.stated, linestyle="none", alpha=0.5, **(look | {"markersize": 1.8}))
            for mark in ladder.marks:
                axes.plot(mark[place], mark[2], marker="o", markersize=8.0, markerfacecolor="none", color=look["color"])
        for limit in limits:
            axes.axhline(limit, color=style.GREY, linewidth=0.9, linestyle=":")
        axes.set(xscale="log", yscale="log")
    if ladders:
        ends = [min(ladders[0].speed), max(ladders[0].speed)]
        label = f"{100.0 * share:g} % of the speed"
        grid[0, 0].plot(ends, [share * end for end in ends], color=style.GREY, linewidth=0.9, label=label)
    grid[0, 0].set(xlabel="Change of speed, m/s", ylabel="RMS velocity difference, m/s")
    style.plain_log(grid[0, 0].xaxis)
    style.plain_log(grid[0, 1].xaxis, (1.0,))
    grid[0, 1].set_xlabel("Largest turn of the cable, degrees")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    abreast = max(1, min(4, len(labels), _LEGEND // max(map(len, labels), default=1)))
    made.legend(handles, labels, loc="outside upper right", ncols=abreast)
    return made
