"""The cable that moves: its static shape with what hangs on it, mode shapes, and motion and tension along it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

from reports import style
from reports.series import Floats

Complex = NDArray[np.complex128]

#: Share of the picture that the largest deflection takes, and the rounded magnifications that are tried.
_SHARE, _MAGNIFICATIONS = 0.08, (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
#: Share of the largest below which a deflection or a tension is rounding.
_ROUNDING = 1e-9
#: What the paper magnifies its mode shapes by (H figure 9): taken where it is readable.
_PAPER = 5.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CableMotion:
    """The cable at one frequency.

    Parameters
    ----------
    label
        What tells it from the others.
    omega
        [rad/s].
    s, x, z, angle, static_tension
        (n + 1,) the static shape from the vehicle up [m], [rad], [N].
    axial, normal
        (n + 1,) complex deflection along and across the cable [m].
    tension
        (n + 1,) complex dynamic tension [N].
    """

    label: str
    omega: float
    s: Floats
    x: Floats
    z: Floats
    angle: Floats
    static_tension: Floats
    axial: Complex
    normal: Complex
    tension: Complex

    def displaced(self, lag: float, magnified: float) -> tuple[Floats, Floats]:
        """Horizontal and vertical position [m] at so many radians after the crest of the input."""
        turn = np.exp(1j * lag)
        p, q = magnified * np.real(self.axial * turn), magnified * np.real(self.normal * turn)
        cosine, sine = np.cos(self.angle), np.sin(self.angle)
        return self.x + p * cosine - q * sine, self.z + p * sine + q * cosine

    @property
    def deflection(self) -> float:
        """Largest amplitude of the deflection along the cable [m]."""
        return float(np.hypot(np.abs(self.axial), np.abs(self.normal)).max())

    @property
    def largest(self) -> float:
        """Largest deflection a quarter of a period after the crest of the input [m]."""
        return float(np.hypot(self.axial.imag, self.normal.imag).max())


@dataclass(frozen=True, slots=True, kw_only=True)
class Towed:
    """What hangs on the cable: its length [m] and pitch [rad], and the water's speed at its depth [m/s]."""

    length: float
    pitch: float
    flow: float


def static_picture(statics: pd.DataFrame, towed: Towed, parts: Sequence[tuple[str, float, float]]) -> Figure:
    """The static shape to scale, with its sections, the vehicle and the water that passes it (H figure 6).

    Parameters
    ----------
    statics
        ``s_m, x_m, z_m, tension_N, angle_rad`` from the vehicle up.
    parts
        (name, from, to) of each section [m] of unstretched length from the vehicle.
    """
    made, grid = style.figure(4.2, columns=2, width_ratios=[1.7, 1.0])
    axes, along = grid[0]
    s, x, z = (statics[name].to_numpy(dtype=float) for name in ("s_m", "x_m", "z_m"))
    for i, (name, low, high) in enumerate(parts):
        own = (s >= low - 1e-9) & (s <= high + 1e-9)
        look = {"color": style.SEQUENCE[i % 7], "linewidth": 1.8, "solid_capstyle": "butt"}
        axes.plot(x[own], z[own], label=name, **look)
        along.plot(statics.loc[own, "tension_N"], s[own], **look)
    reach = max(float(np.ptp(x)), float(np.ptp(z)))
    axes.axhline(0.0, color=style.SKY, linewidth=1.2)
    axes.plot(x[-1], 0.0, marker=7, color=style.BLACK, markersize=8.0)
    body = max(towed.length, 0.03 * reach)
    axes.add_patch(
        Ellipse((x[0], z[0]), body, 0.4 * body, angle=math.degrees(towed.pitch), color=style.BLACK, zorder=4)
    )
    if towed.flow != 0.0:
        _arrow(axes, x, z, towed.flow, reach)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.12)
    axes.set_xlabel("x, m")
    axes.set_ylabel("Height above the surface, m")
    along.set_xlabel("Static tension, N")
    along.set_ylabel("s from the vehicle, m")
    along.set_xlim(left=0.0)
    along.set_ylim(0.0, float(s[-1]))
    for panel in (axes, along):
        style.few_ticks(panel.xaxis, 4)
    made.legend(loc="outside upper right", ncols=3)
    return made


def mode_shapes(rows: Sequence[tuple[str, Sequence[CableMotion]]]) -> Figure:
    """Static shape dotted, the cable 90 and 270 degrees after the crest of the input (H figure 9), all to scale.

    A mode answers a quarter of a period late, so that the part of the motion that follows the input is not in it.

    Parameters
    ----------
    rows
        (label, motions) of each row of panels; the title says how much the deflection is magnified.
    """
    columns = max(len(motions) for _, motions in rows)
    extent = rows[0][1][0]
    tall = float(np.ptp(extent.z)) / max(float(np.ptp(extent.x)), 0.25 * float(np.ptp(extent.z)))
    made, grid = style.figure(
        0.5 + (0.5 + min(2.2, 1.25 * tall)) * len(rows), rows=len(rows), columns=columns, sharex=True, sharey=True
    )
    for i, (label, motions) in enumerate(rows):
        for axes in grid[i, len(motions) :]:
            axes.set_axis_off()
        for axes, motion in zip(grid[i], motions, strict=False):
            times = magnification(motion)
            axes.plot(motion.x, motion.z, color=style.BLACK, linestyle=":", linewidth=1.0)
            for lag, color in ((0.5 * math.pi, style.BLUE), (1.5 * math.pi, style.VERMILION)):
                axes.plot(*motion.displaced(lag, times), color=color, linewidth=1.1)
            axes.set_title(f"{motion.omega:.3f} rad/s, x {times:g}", fontsize=7.5)
            axes.set_aspect("equal", adjustable="box")
            style.few_ticks(axes.xaxis, 3)
        grid[i, 0].set_ylabel(f"{label}\nz, m")
    for axes in grid[-1]:
        axes.set_xlabel("x, m")
    return made


def magnification(motion: CableMotion) -> float:
    """The paper's five where that can be read, else the round number that makes the deflection readable."""
    extent = max(float(np.ptp(motion.x)), float(np.ptp(motion.z)))
    wanted = _SHARE * extent / max(motion.largest, 1e-12)
    if 0.4 * wanted <= _PAPER <= 2.5 * wanted:
        return _PAPER
    return min(_MAGNIFICATIONS, key=lambda times: abs(math.log(times / wanted)))


def along_cable(motions: Sequence[CableMotion]) -> Figure:
    """Deflection along and across the cable and dynamic tension from the vehicle up, a line for each frequency.

    What is but rounding has no panel.
    """
    static = motions[0].static_tension
    deflection = max(motion.deflection for motion in motions)
    most = max(float(np.abs(motion.tension).max()) for motion in motions)
    shown = {
        name: label
        for name, label, least in (
            ("axial", "Along the cable, m", _ROUNDING * deflection),
            ("normal", "Across the cable, m", _ROUNDING * deflection),
            ("tension", "Dynamic tension, N", _ROUNDING * float(static.max())),
        )
        if max(float(np.abs(getattr(motion, name)).max()) for motion in motions) > least
    }
    made, grid = style.figure(0.5 + 1.5 * len(shown), rows=len(shown), sharex=True)
    for axes, (name, label) in zip(grid[:, 0], shown.items(), strict=True):
        for i, motion in enumerate(motions):
            look = {"color": style.SEQUENCE[i % 7], "linestyle": style.DASHES[i % 6]}
            axes.plot(motion.s, np.abs(getattr(motion, name)), label=motion.label, **look)
        high = axes.get_ylim()[1]
        if name == "tension" and static.min() <= 2.0 * most:
            axes.plot(motions[0].s, static, color=style.BLACK, linestyle=":", label="static tension")
            high = max(high, 1.15 * min(float(static.max()), 1.5 * most))
        axes.set_ylim(0.0, high)
        axes.set_ylabel(label)
    grid[-1, 0].set_xlabel("s from the vehicle, m")
    grid[-1, 0].set_xlim(motions[0].s[0], motions[0].s[-1])
    made.legend(*grid[-1, 0].get_legend_handles_labels(), loc="outside upper right", ncols=4)
    return made


def slack_map(omega: Floats, s: Floats, ratio: Floats) -> Figure:
    """Dynamic over static tension (k, n + 1) along the cable against frequency; beyond the line it goes slack."""
    made, grid = style.figure(2.9)
    axes = grid[0, 0]
    bounds = _bounds(float(ratio.max()))
    mesh = axes.contourf(omega, s, ratio.T, levels=bounds, cmap="YlOrRd", extend="max")
    if ratio.max() >= 1.0 > ratio.min():
        axes.contour(omega, s, ratio.T, levels=[1.0], colors=style.BLACK, linewidths=1.4)
    worst = ratio.argmax(axis=1)
    axes.plot(omega, s[worst], color=style.BLUE, linewidth=1.0, linestyle=":", label="nearest to slack")
    axes.set_xlabel("Frequency, rad/s")
    axes.set_ylabel("s from the vehicle, m")
    axes.set_ylim(float(s[0]), float(s[-1]))
    axes.grid(visible=False)
    made.colorbar(mesh, ax=axes, label="Dynamic over static tension", pad=0.02)
    made.legend(loc="outside upper right")
    return made


def _bounds(most: float) -> Floats:
    """Round steps from 0 to about the largest ratio, with 1 among them where it is reached."""
    step = next((each for each in (0.01, 0.02, 0.05, 0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 5.0) if most / each <= 12.0), 10.0)
    count = min(max(math.ceil(most / step), 2), 20)
    return step * np.arange(count + 1, dtype=float)


def _arrow(axes: Axes, x: Floats, z: Floats, flow: float, reach: float) -> None:
    """The water that passes the vehicle, an arrow beside it."""
    start = float(x[0]) - math.copysign(0.28 * reach, flow)
    axes.annotate(
        "",
        xy=(start + math.copysign(0.16 * reach, flow), float(z[0])),
        xytext=(start, float(z[0])),
        arrowprops={"arrowstyle": "-|>", "color": style.BLUE, "linewidth": 1.2},
    )
    axes.text(
        start,
        float(z[0]) + 0.02 * reach,
        f"{abs(flow):.3g} m/s",
        color=style.BLUE,
        fontsize=7.5,
        ha="left",
        va="bottom",
    )
