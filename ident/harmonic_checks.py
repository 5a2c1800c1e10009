"""The matrix method at single frequencies against the first harmonic of the nonlinear chain's periodic state."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd

from ident.chain_record import QUANTITIES, chain_record, moves
from ident.sea_checks import level
from ident.sea_drawing import Drawing, imposed_motion
from models.tow import Tow
from models.trace import Floats
from models.transfer_matrix import Direction, DragForm, frequency_response

#: Samples of a cycle, cycles that are looked at, and cycles before them.
_SAMPLES, _CYCLES, _BEFORE = 48, 4, 40


def check_harmonics(
    tow: Tow,
    omega: Sequence[float],
    *,
    amplitude: float = 1.0,
    direction: Direction = "heave",
    drag: DragForm = "consistent",
    links: int = 48,
    share: float = 5e-4,
    cycles_before: int = _BEFORE,
) -> pd.DataFrame:
    """Both methods under a sinusoidal motion of the cable's top, one frequency after the other.

    Parameters
    ----------
    omega
        Frequencies, increasing [rad/s].
    amplitude
        Of the motion [m].
    links, share
        As of `chain_record`.
    cycles_before
        Cycles after which the chain is taken to be periodic.

    Returns
    -------
    pd.DataFrame
        A row a frequency and quantity: ``omega_rad_s, amplitude_m, quantity, unit``, ``chain`` and ``matrix``
        (amplitudes of the first harmonic), ``difference_percent``, ``phase_rad`` (of the chain ahead of the matrix
        method), ``level`` (of the matrix method with a body that stays level), ``chain_error_percent`` (by half the
        links),
        ``harmonics_percent`` (size of the higher harmonics), ``unsettled_percent`` (change of the
        first harmonic from the first half of the record to the second), ``cpu_s`` of the chain. Shares are of
        ``matrix``, and left out for what hardly moves.

    Raises
    ------
    InvalidInput
        A frequency is not above zero, or the chain does not know the body.
    NumericalFailure
        Either method fails.
    """
    response = frequency_response(tow, omega, amplitude=amplitude, direction=direction, drag=drag)
    still = level(tow)
    upright = (
        None if still is None else frequency_response(still, omega, amplitude=amplitude, direction=direction, drag=drag)
    )
    angle = float(response.shape.phi[-1])
    rows = []
    for k, each in enumerate(response.omega.tolist()):
        drawing = _cycles(each, amplitude)
        position = drawing.series(imposed_motion(drawing.omega, direction, None, angle))

        run_in = cycles_before * 2.0 * math.pi / each
        record = partial(chain_record, tow, drawing, position, angle, run_in=run_in)
        fine, coarse = record(links=links, share=share), record(links=links // 2, share=8.0 * share)
        for name in fine.series:
            first, matrix = _first(fine.series[name], _CYCLES), complex(getattr(response, name)[k])
            compared = moves(name, abs(first), fine) and moves(name, abs(matrix), fine)
            half = fine.series[name].size // 2
            halves = [_first(part, _CYCLES // 2) for part in np.split(fine.series[name], [half])]
            row = {
                "omega_rad_s": each,
                "amplitude_m": amplitude,
                "quantity": name,
                "unit": QUANTITIES[name],
                "chain": abs(first),
                "matrix": abs(matrix),
            }
            if upright is not None:
                row["level"] = abs(getattr(upright, name)[k])
            shares = {
                "difference": abs(first) - abs(matrix),
                "chain_error": abs(_first(coarse.series[name], _CYCLES) - first) / 3.0,
                "harmonics": _higher(fine.series[name], _CYCLES),
                "unsettled": abs(halves[1] - halves[0]),
            }
            over = abs(matrix) if compared else math.nan
            row |= {f"{key}_percent": 100.0 * value / over for key, value in shares.items()}
            row["phase_rad"] = float(np.angle(first / matrix)) if compared else math.nan
            rows.append(row | {"cpu_s": fine.cpu})
    return pd.DataFrame(rows)


def _cycles(omega: float, amplitude: float) -> Drawing:
    """A record of whole cycles."""
    count = _SAMPLES * _CYCLES
    sample = 2.0 * math.pi / (omega * _SAMPLES)
    wave = np.zeros(count, dtype=complex)
    wave[_CYCLES] = amplitude
    frequencies = np.asarray(2.0 * math.pi * np.fft.fftfreq(count, sample), dtype=float)
    return Drawing(t=np.asarray(sample * np.arange(count), dtype=float), omega=frequencies, wave=wave)


def _first(series: Floats, cycles: int) -> complex:
    """Complex amplitude of the first harmonic of a record of whole cycles."""
    return complex(2.0 * np.fft.rfft(series)[cycles] / series.size)


def _higher(series: Floats, cycles: int) -> float:
    """Root of the summed squared amplitudes of the higher harmonics."""
    found = 2.0 * np.abs(np.fft.rfft(series)[2 * cycles :: cycles]) / series.size
    return float(np.sqrt(np.sum(found**2)))
