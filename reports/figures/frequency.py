"""Amplitude and phase from ship to vehicle, reduced models over the reference simulator (T figures 3-6, 3-7)."""

import pandas as pd
from matplotlib.figure import Figure

from reports import style


def bode(points: pd.DataFrame, curves: pd.DataFrame) -> Figure:
    """Reference points and model curves: amplitude above, phase below, one column a ship amplitude.

    Parameters
    ----------
    points
        Columns amplitude_m, omega_rad_s, gain_db, phase_deg: the reference simulator.
    curves
        The same columns and model; NaN amplitude_m for a model that does not depend on it.
    """
    amplitudes = sorted(points["amplitude_m"].unique())
    made, axes = style.figure(4.6, rows=2, columns=len(amplitudes), sharex=True, sharey="row")
    look = style.looks(curves["model"])
    for column, amplitude in enumerate(amplitudes):
        measured = points[points["amplitude_m"] == amplitude].sort_values("omega_rad_s")
        here = curves[(curves["amplitude_m"] == amplitude) | curves["amplitude_m"].isna()]
        for row, quantity in enumerate(("gain_db", "phase_deg")):
            panel = axes[row, column]
            for model, curve in here.groupby("model", sort=False):
                line = curve.sort_values("omega_rad_s")
                panel.plot(line["omega_rad_s"], line[quantity], label=str(model), **look[str(model)].line())
            panel.plot(
                measured["omega_rad_s"],
                measured[quantity],
                "o",
                color=style.BLACK,
                markersize=4.5,
                zorder=5,
                label="reference",
            )
            panel.set_xscale("log")
            style.plain_log(panel.xaxis)
        axes[0, column].set_title(f"Ship amplitude {amplitude:g} m")
        axes[1, column].set_xlabel("Angular frequency, rad/s")
    axes[0, 0].set_ylabel("Amplitude ratio, dB")
    axes[1, 0].set_ylabel("Phase, degrees")
    for panel, quantity in zip(axes[:, 0], ("gain_db", "phase_deg"), strict=True):
        reach = pd.concat([points[quantity], curves[quantity]])
        low = max(float(reach.min()), float(points[quantity].min()) - (20.0 if quantity == "gain_db" else 120.0))
        high = min(float(reach.max()), float(points[quantity].max()) + (10.0 if quantity == "gain_db" else 60.0))
        pad = 0.05 * (high - low)
        panel.set_ylim(low - pad, high + pad)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    made.legend(handles, labels, loc="outside lower center", ncols=3)
    return made
