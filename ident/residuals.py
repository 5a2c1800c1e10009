"""What the residuals of a fit still hold: memory, and a trace of the input.

A learning model does not whiten its residuals, so their autocorrelation is expected; a cross-correlation
with the ship's motion outside its band means that the model misses something the input does.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.signal import correlate

from ident.cases import Case, Floats

#: Width of a 95 % band in standard deviations.
BAND = 1.96

#: Longest lag of the correlations [s].
LONGEST_LAG = 600.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ResidualTest:
    """Correlations of one record's residuals.

    Parameters
    ----------
    lag, autocorrelation, band
        (k,) [s] from 0, (k,) [1], and the 95 % band of white residuals.
    cross_lag, cross_correlation, cross_band
        (j,) [s] how far the residual comes after the ship's velocity, (j,) [1], and the 95 % band, which
        allows for the memory of both (Bartlett's formula).
    """

    record: str
    lag: Floats = field(repr=False)
    autocorrelation: Floats = field(repr=False)
    band: float
    cross_lag: Floats = field(repr=False)
    cross_correlation: Floats = field(repr=False)
    cross_band: float

    @property
    def memory(self) -> float:
        """The first lag at which the autocorrelation is inside its band [s]."""
        inside = np.flatnonzero(np.abs(self.autocorrelation) < self.band)
        return float(self.lag[inside[0]] if inside.size else self.lag[-1])

    @property
    def cross_peak(self) -> tuple[float, float]:
        """The largest cross-correlation in size, and its lag [s]."""
        k = int(np.argmax(np.abs(self.cross_correlation)))
        return float(self.cross_correlation[k]), float(self.cross_lag[k])

    @property
    def cross_outside(self) -> float:
        """The share of lags with a cross-correlation outside its band; 0.05 when there is none."""
        return float(np.mean(np.abs(self.cross_correlation) > self.cross_band))


def autocovariance(values: Floats) -> Floats:
    """(m,) biased autocovariance at lags 0 to m - 1 of values (m,) taken with mean zero."""
    full: Floats = correlate(values, values, mode="full", method="fft")
    return full[values.size - 1 :] / values.size


def memory_length(autocorrelation: Floats, samples: int) -> int:
    """The first lag from which the autocorrelation stays inside its band for a while.

    Politis (2003), Adaptive bandwidth choice, J. Nonparametric Statistics 15: inside
    ``2 sqrt(log10(m)/m)`` over five lags or the log10 of the length in a row.
    """
    inside = np.abs(autocorrelation) < 2.0 * math.sqrt(math.log10(samples) / samples)
    run = max(5, math.ceil(math.log10(samples)))
    count = np.convolve(inside[1:], np.ones(run), mode="valid")
    found = np.flatnonzero(count >= run)
    return int(found[0]) if found.size else autocorrelation.size // 4


def examine_residuals(case: Case, residual: Floats) -> ResidualTest:
    """Autocorrelation and input cross-correlation of a record's residuals (m,), on an even grid of times."""
    step = float(np.median(np.diff(case.time)))
    grid = np.arange(case.time[0], case.time[-1] + 0.5 * step, step)
    e = np.interp(grid, case.time, residual)
    u = np.interp(grid, case.drive.t, case.drive.rates[:, 0])
    e, u = e - e.mean(), u - u.mean()
    m = grid.size
    e_covariance, u_covariance = autocovariance(e), autocovariance(u)
    tiny = np.finfo(float).tiny
    rho_e, rho_u = e_covariance / max(e_covariance[0], tiny), u_covariance / max(u_covariance[0], tiny)
    memory = max(m // 4, 2)
    variance = (1.0 + 2.0 * float(rho_e[1:memory] @ rho_u[1:memory])) / m
    shown = min(int(LONGEST_LAG / step), memory)
    cross = correlate(e, u, mode="full", method="fft")[m - 1 - shown : m + shown]
    return ResidualTest(
        record=case.name,
        lag=step * np.arange(shown + 1, dtype=float),
        autocorrelation=rho_e[: shown + 1],
        band=BAND / math.sqrt(m),
        cross_lag=step * np.arange(-shown, shown + 1, dtype=float),
        cross_correlation=cross / (m * math.sqrt(max(e_covariance[0] * u_covariance[0], tiny))),
        cross_band=BAND * math.sqrt(max(variance, 1.0 / m)),
    )
