"""Responses to a step of ship velocity and to the random input, for several cables (T figures 4-1 to 4-3)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from reports import style

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StepResponse:
    """The vehicle after a step of ship velocity.

    Parameters
    ----------
    label
        For the legend, such as ``1000 m``.
    length
        Cable length [m].
    weight
        Vehicle weight in water [N].
    t, velocity
        (n,) [s] from the step, (n,) vehicle velocity [m/s].
    delay_measured, delay_midpoint, delay_front
        [s]: measured on the response; L / sqrt(T_mid / m); int ds / sqrt(T / (m + m_a)).
    delay_thesis
        [s] as printed in T 4.1, NaN where there is none.
    """

    label: str
    length: float
    weight: float
    t: Floats
    velocity: Floats
    delay_measured: float
    delay_midpoint: float
    delay_front: float
    delay_thesis: float = float("nan")


def step_responses(responses: Sequence[StepResponse], step: float) -> Figure:
    """Vehicle velocity after the step; the three delays of each response are marked below it.

    Parameters
    ----------
    responses
        In the order of the legend.
    step
        Ship velocity after the step [m/s].
    """
    made, grid = style.figure(
        4.2, rows=2, sharex=True, gridspec_kw={"height_ratios": (4.0, 0.3 + 0.3 * len(responses))}
    )
    axes, marks = grid[:, 0]
    last = 0.0
    for i, response in enumerate(responses):
        line = {"color": style.SEQUENCE[i % 7], "linestyle": style.DASHES[i % 6]}
        axes.plot(response.t, response.velocity, label=response.label, linewidth=1.3, **line)
        axes.plot(
            response.delay_measured,
            float(np.interp(response.delay_measured, response.t, response.velocity)),
            "o",
            color=line["color"],
            zorder=5,
        )
        delays = (response.delay_midpoint, response.delay_front, response.delay_measured)
        marks.plot([min(delays), max(delays)], [-i, -i], color=line["color"], linewidth=0.8)
        for delay, shape in zip(delays, ("|", "D", "o"), strict=True):
            marks.plot(
                delay, -i, shape, color=line["color"], markersize=8 if shape == "|" else 4.5, markeredgewidth=1.3
            )
        last = max(last, float(response.t[-1]))
    axes.axhline(step, color=style.GREY, linewidth=0.8, linestyle=":")
    axes.annotate(
        f"ship, {step:g} m/s",
        (last, step),
        xytext=(0, -3),
        textcoords="offset points",
        ha="right",
        va="top",
        fontsize=7.5,
    )
    axes.set_ylabel("Vehicle velocity, m/s")
    axes.set_ylim(top=1.06 * step)
    marks.set_yticks([-i for i in range(len(responses))], [response.label for response in responses])
    marks.set_ylim(-len(responses) + 0.4, 0.6)
    marks.set_xlim(0.0, last)
    marks.set_xlabel("Time after the step, s")
    marks.set_ylabel("Delay")
    made.legend(*axes.get_legend_handles_labels(), loc="outside upper right", ncols=min(6, len(responses)))
    kinds = (("|", "midpoint tension, no added mass"), ("D", "wave front, with added mass"), ("o", "measured"))
    made.legend(
        handles=[
            Line2D([], [], color=style.GREY, marker=shape, linestyle="none", markeredgewidth=1.3, label=name)
            for shape, name in kinds
        ],
        loc="outside lower center",
        ncols=3,
    )
    return made


def random_responses(t: Floats, ship_velocity: Floats, vehicles: Mapping[str, Floats]) -> Figure:
    """Vehicle velocity under the same random ship input for several cables (T figure 4-2).

    Parameters
    ----------
    t, ship_velocity
        (n,) [s], [m/s].
    vehicles
        Label to (n,) [m/s].
    """
    made, grid = style.figure(3.2)
    axes = grid[0, 0]
    axes.plot(t, ship_velocity, color="#BBBBBB", linewidth=0.9, label="ship")
    for i, (label, velocity) in enumerate(vehicles.items()):
        axes.plot(t, velocity, color=style.SEQUENCE[i % 7], linestyle=style.DASHES[i % 6], linewidth=1.3, label=label)
    axes.set_xlim(t[0], t[-1])
    axes.set_xlabel("Time, s")
    axes.set_ylabel("Velocity, m/s")
    made.legend(loc="outside upper right", ncols=len(vehicles) + 1)
    return made
