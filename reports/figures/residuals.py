"""Whether a model leaves structure in its residuals: autocorrelation, and correlation with the ship's velocity."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from reports import style

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ResidualCurves:
    """Correlations of one model's velocity residuals.

    Parameters
    ----------
    model
        Its name.
    lag
        (k,) [s], from 0, of the autocorrelation.
    autocorrelation
        (k,) from -1 to 1.
    cross_lag
        (j,) [s], negative and positive: how far the residual comes after the ship's velocity.
    cross_correlation
        (j,) from -1 to 1.
    band, cross_band
        Half width of the 95 % bands of no correlation.
    """

    model: str
    lag: Floats
    autocorrelation: Floats
    cross_lag: Floats
    cross_correlation: Floats
    band: float
    cross_band: float


def residual_tests(tests: Sequence[ResidualCurves]) -> Figure:
    """Autocorrelation left, correlation with the input right, one row a model, 95 % bands shaded."""
    made, axes = style.figure(0.7 + 1.05 * len(tests), rows=len(tests), columns=2, sharex="col", sharey="col")
    look = style.looks([test.model for test in tests])
    for row, test in enumerate(tests):
        sides = (
            (test.lag, test.autocorrelation, test.band),
            (test.cross_lag, test.cross_correlation, test.cross_band),
        )
        for panel, (lag, values, band) in zip(axes[row], sides, strict=True):
            panel.axhspan(-band, band, color="#DDDDDD", zorder=0, linewidth=0.0)
            panel.axhline(0.0, color="#444444", linewidth=0.6)
            panel.plot(lag, values, color=look[test.model].color, linewidth=1.2)
            panel.set_xlim(lag[0], lag[-1])
        axes[row, 0].set_title(test.model, fontweight="bold")
    axes[0, 0].set_ylim(top=1.05)
    axes[-1, 0].set_xlabel("Lag of the residual with itself, s")
    axes[-1, 1].set_xlabel("Lag behind the ship's velocity, s")
    made.supylabel("Correlation (no unit)", fontsize=8.5)
    return made
