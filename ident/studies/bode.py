"""Frequency responses: the reference simulator's at several amplitudes, and those of the reduced models."""

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from ident.linear import frequency_response
from models import reduced, spectral
from models.quantity import NumericalFailure
from models.reduced import ReducedModel
from models.tow import Tow
from models.trace import Trace

_COLUMNS = ["amplitude_m", "omega_rad_s", "gain_db", "phase_deg"]
#: Periods that settle before the last two are read, samples a period, and the share of the motion that the
#: simulator may err by.
_SETTLING, _READ, _SAMPLES, _SHARE = 3, 2, 48, 2e-3
#: Frequencies of a reduced model's curve.
_POINTS = 60


def reference_response(tow: Tow, amplitude: float, omega: float) -> tuple[float, float]:
    """Gain [1] and phase [rad] of the vehicle's fundamental behind a sinusoid of the ship."""
    period = 2.0 * math.pi / omega
    t = np.arange((_SETTLING + _READ) * _SAMPLES + 1) * (period / _SAMPLES)
    # From rest: a raised cosine over the first period, whose speed does not jump.
    ease = np.where(t < period, 0.5 - 0.5 * np.cos(0.5 * omega * np.minimum(t, period)), 1.0)
    ship = Trace.along_x(t, tow.speed * t + amplitude * ease * np.sin(omega * t))
    tolerance = max(_SHARE * amplitude * omega, 1e-9)
    run = spectral.simulate(tow, ship, tolerance=tolerance)
    late = slice(_SETTLING * _SAMPLES, None)
    motion = run.vehicle.position[late, 0] - tow.speed * t[late]
    basis = np.column_stack([np.sin(omega * t[late]), np.cos(omega * t[late]), np.ones(motion.size), t[late]])
    s, c = np.linalg.lstsq(basis, motion, rcond=None)[0][:2] / amplitude
    return math.hypot(s, c), math.atan2(c, s)


def reference_points(tow: Tow, amplitudes: Sequence[float], omegas: Sequence[float]) -> tuple[pd.DataFrame, list[str]]:
    """The reference simulator's response at every amplitude and frequency, phases continuous.

    A point that cannot be simulated is left out; the second result says which and why.
    """
    rows, missing = [], []
    for amplitude in amplitudes:
        found = {}
        for omega in sorted(omegas):
            try:
                found[omega] = reference_response(tow, amplitude, omega)
            except NumericalFailure as failure:
                missing.append(f"{amplitude:g} m at {omega:g} rad/s is left out: {failure}")
        phases = np.unwrap([phase for _, phase in found.values()])
        rows += [
            (amplitude, omega, 20.0 * math.log10(max(gain, 1e-12)), math.degrees(phase))
            for (omega, (gain, _)), phase in zip(found.items(), phases, strict=True)
        ]
    return pd.DataFrame(rows, columns=_COLUMNS), missing


def reduced_curves(
    models: Sequence[ReducedModel], amplitudes: Sequence[float], omegas: Sequence[float]
) -> pd.DataFrame:
    """Curves of the reduced models; a quadratic one is linearised anew at every amplitude and frequency."""
    omega = np.geomspace(min(omegas), max(omegas), _POINTS)
    parts = []
    for model in models:
        about = reduced.info(model)
        for amplitude in amplitudes if about.drag == "quadratic" else (math.nan,):
            if about.drag == "quadratic":
                at = [
                    frequency_response(reduced.linearise(model, ship_amplitude=amplitude, omega=w), [w]) for w in omega
                ]
                gain = np.array([float(point.magnitude[0]) for point in at])
                phase = np.unwrap([float(point.phase[0]) for point in at])
            else:
                response = frequency_response(reduced.linearise(model), omega)
                gain, phase = response.magnitude, response.phase
            parts.append(
                pd.DataFrame(
                    {
                        "model": about.model,
                        "amplitude_m": amplitude,
                        "omega_rad_s": omega,
                        "gain_db": 20.0 * np.log10(np.maximum(gain, 1e-12)),
                        "phase_deg": np.degrees(phase),
                    }
                )
            )
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame(columns=["model", *_COLUMNS])
