"""A random sea and what becomes of it: spectra, tension along the cable, and extremes over a duration."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports import style

#: Share of its largest value below which the end of a spectrum is not shown.
_SHOWN = 5e-3
#: Lowest chance that a logarithmic axis goes down to.
_RARE = 1e-12
_NAMES = {
    "wave_m2_s": "wave",
    "vessel_heave_m2_s": "vessel, heave",
    "vessel_surge_m2_s": "vessel, surge",
    "top_m2_s": "Cable's top",
    "heave_m2_s": "Heave",
    "surge_m2_s": "Surge",
    "pitch_rad2_s": "Pitch",
    "tension_bottom_N2_s": "At the vehicle",
    "tension_top_N2_s": "At the top",
}
_TITLES = {"tension_bottom": "Tension at the vehicle", "tension_top": "Tension at the top"}
#: Below this largest value a tension is drawn in N instead of kN.
_SMALL = 2000.0


def sea(spectra: pd.DataFrame, rao: pd.DataFrame) -> Figure:
    """The spectrum of the sea, of the vessel in it, and the vessel's response between them.

    Parameters
    ----------
    spectra
        As ``spectra.csv``.
    rao
        ``omega_rad_s, heave_m_m`` and perhaps ``surge_m_m`` at the same frequencies; empty for none.
    """
    made, grid = style.figure(2.5 if rao.empty else 4.2, rows=1 if rao.empty else 2, sharex=True)
    shown = [name for name in ("wave_m2_s", "vessel_heave_m2_s", "vessel_surge_m2_s") if name in spectra]
    for i, name in enumerate(shown):
        grid[0, 0].plot(spectra["omega_rad_s"], spectra[name], label=_NAMES[name], **_look(i))
    if len(shown) > 1:
        grid[0, 0].legend()
    _upward(grid[0, 0], "Spectrum, m² s")
    if not rao.empty:
        for i, name in enumerate(("heave", "surge")):
            if f"{name}_m_m" in rao:
                grid[1, 0].plot(rao["omega_rad_s"], rao[f"{name}_m_m"], label=name, **_look(i + 1))
        if "surge_m_m" in rao:
            grid[1, 0].legend()
        _upward(grid[1, 0], "RAO, m/m")
    _frequencies(grid[-1, 0], spectra, shown)
    return made


def motions(spectra: pd.DataFrame) -> Figure:
    """Spectra of the cable's top and of those of the vehicle's motions that there are, a panel each."""
    names = ("top_m2_s", "heave_m2_s", "surge_m2_s", "pitch_rad2_s")
    panels = [name for name in names if name in spectra and spectra[name].any()]
    made, grid = style.figure(0.5 + 1.45 * len(panels), rows=len(panels), sharex=True)
    for i, (axes, name) in enumerate(zip(grid[:, 0], panels, strict=True)):
        unit, scale = "m² s", 1.0
        if name.endswith("rad2_s"):
            unit, scale = "deg² s", np.degrees(1.0) ** 2
        elif spectra[name].max() < 0.1:
            unit, scale = "cm² s", 1e4
        axes.plot(spectra["omega_rad_s"], scale * spectra[name], **_look(i))
        _upward(axes, f"{_NAMES[name]}, {unit}")
    _frequencies(grid[-1, 0], spectra, panels)
    return made


def tensions(spectra: pd.DataFrame) -> Figure:
    """Spectra of the dynamic tension at both ends of the cable, a panel each."""
    panels = ["tension_bottom_N2_s", "tension_top_N2_s"]
    made, grid = style.figure(3.4, rows=2, sharex=True)
    for i, (axes, name) in enumerate(zip(grid[:, 0], panels, strict=True)):
        small = float(spectra[name].max()) < _SMALL**2
        unit, scale = ("N² s", 1.0) if small else ("kN² s", 1e-6)
        axes.plot(spectra["omega_rad_s"], scale * spectra[name], **_look(i))
        _upward(axes, f"{_NAMES[name]}, {unit}")
    _frequencies(grid[-1, 0], spectra, panels)
    return made


def along(cable: pd.DataFrame) -> Figure:
    """Static tension, its dynamic range and the chance of slack over the distance from the vehicle.

    Parameters
    ----------
    cable
        As ``cable.csv``.
    """
    made, grid = style.figure(2.9, columns=2, sharey=True)
    left, right = grid[0]
    s = cable["s_m"].to_numpy()
    unit, scale = _tension(float((cable["static_N"] + cable["one_in_1000_N"]).max()))
    static, sigma, reach = (scale * cable[name] for name in ("static_N", "sigma_N", "one_in_1000_N"))
    shade = {"linewidth": 0.0}
    left.fill_betweenx(s, static - reach, static + reach, color=style.SKY, alpha=0.35, label="± 1 in 1000", **shade)
    left.fill_betweenx(s, static - sigma, static + sigma, color=style.BLUE, alpha=0.45, label="± sigma", **shade)
    left.plot(static, s, color=style.BLACK, linewidth=1.2, label="static")
    left.axvline(0.0, color=style.VERMILION, linewidth=0.9, linestyle=":")
    left.set_xlabel(f"Tension, {unit}")
    left.set_ylabel("From the vehicle, m")
    left.set_ylim(0.0, float(s[-1]))
    style.few_ticks(left.yaxis, 6)
    style.few_ticks(left.xaxis, 6)
    left.legend(loc="best")
    right.plot(np.maximum(cable["slack_probability"], _RARE), s, color=style.VERMILION)
    right.set_xscale("log")
    right.set_xlim(_RARE, 2.0)
    right.set_xlabel("Chance of slack in a cycle")
    right.set_xticks(10.0 ** np.arange(-12, 1, 3))
    right.minorticks_off()
    return made


def growth(durations: pd.DataFrame, duration: float) -> Figure:
    """Largest dynamic tension over longer and longer stays in the sea.

    Parameters
    ----------
    durations
        As ``durations.csv``.
    duration
        The one that the table is of, marked [s].
    """
    names = list(dict.fromkeys(durations["quantity"]))
    made, grid = style.figure(2.9, columns=len(names))
    lines = {"one_in_100_N": "exceeded in 1 of 100", "expected_N": "expected", "most_probable_N": "most probable"}
    found: dict[str, Any] = {}
    for axes, name in zip(grid[0], names, strict=True):
        own = durations[durations["quantity"] == name]
        static, high = float(own["static_N"].iloc[0]), float(own["one_in_100_N"].max())
        near = static <= 1.5 * high
        high = max(high, static) if near else high
        unit, scale = _tension(high)
        for i, (column, label) in enumerate(lines.items()):
            axes.plot(own["duration_s"] / 3600.0, scale * own[column], label=label, **_look(2 - i))
        if near:
            axes.axhline(scale * static, color=style.BLACK, linewidth=0.9, linestyle=":", label="static: slack above")
        axes.axvline(duration / 3600.0, color=style.GREY, linewidth=0.8)
        axes.set_xscale("log")
        style.plain_log(axes.xaxis)
        axes.set_ylim(0.0, 1.1 * scale * high)
        style.few_ticks(axes.yaxis, 6)
        axes.set_title(f"{_TITLES[name]}, {unit}")
        axes.set_xlabel("Hours in the sea")
        handles, labels = axes.get_legend_handles_labels()
        found |= dict(zip(labels, handles, strict=True))
    grid[0, 0].set_ylabel("Largest dynamic tension")
    made.legend(found.values(), found.keys(), loc="outside upper right", ncols=4)
    return made


def _look(place: int) -> dict[str, Any]:
    """The look of a line by its place."""
    return {"color": style.SEQUENCE[place % 7], "linestyle": style.DASHES[place % 6]}


def _tension(largest: float) -> tuple[str, float]:
    """The unit of a tension and what turns newtons into it."""
    return ("N", 1.0) if largest < _SMALL else ("kN", 1e-3)


def _upward(axes: Axes, label: str) -> None:
    """An axis of values from zero, its ticks fixed in number so that the layout does not depend on its height."""
    axes.set_ylim(bottom=0.0)
    style.few_ticks(axes.yaxis, 4)
    axes.set_ylabel(label)


def _frequencies(axes: Axes, spectra: pd.DataFrame, columns: Sequence[str]) -> None:
    """Frequencies from the lowest to where all of the spectra have died out."""
    share = (spectra[list(columns)] / spectra[list(columns)].max()).max(axis=1)
    omega = spectra["omega_rad_s"]
    axes.set_xlim(float(omega.iloc[0]), float(omega[share > _SHOWN].max()))
    axes.set_xlabel("Angular frequency, rad/s")
