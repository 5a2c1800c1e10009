"""What a simulation costs and how exact it is: the reference and the reduced models on the standard input."""

import math
import time
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import pandas as pd

from ident.configuration import Configuration
from ident.truth import identification_ship, start_of
from models import reduced, spectral
from models.drive import MAX_STEP, Drive
from models.statics import static_shape

_COLUMNS = ["configuration", "simulator", "seed", "ms_an_hour", "error_m_s"]
#: Steps of the solutions that errors are counted from, as a share of the usual ones, and repetitions of a timing.
_FINER, _REPEATS = 1.0 / 16.0, 7


def costs(configuration: Configuration, seeds: Sequence[int]) -> pd.DataFrame:
    """Median wall time for an hour of record [ms] and RMS velocity error against a much finer solution [m/s].

    The reduced models have their first guess for parameters; the linear ones are exact and count as such.
    """
    tow = configuration.tow
    shape = static_shape(tow)
    start = start_of(tow)
    rows = []
    for seed in seeds:
        ship = identification_ship(configuration, seed)
        hours = float(ship.t[-1] - ship.t[0]) / 3600.0
        tolerance = configuration.spectral.tolerance
        usual = spectral.simulate(tow, ship, tolerance=tolerance)
        exact = spectral.simulate(tow, ship, tolerance=0.01 * tolerance, harmonics=3 * usual.harmonics, companion=False)
        assert usual.vehicle.velocity is not None
        assert exact.vehicle.velocity is not None
        error = _rms(usual.vehicle.velocity[:, 0] - exact.vehicle.velocity[:, 0])
        reference = partial(spectral.simulate, tow, ship, tolerance=tolerance)
        rows.append((configuration.name, "spectral", seed, _milliseconds(reference) / hours, error))
        drive = Drive.from_trace(ship, start=start)
        fine = Drive.from_trace(ship, start=start, max_step=_FINER * MAX_STEP)
        for name in configuration.identification.models:
            model = reduced.section(name, tow, shape)
            off = math.nan
            if model.drag == "quadratic":
                off = _rms(reduced.respond(model, drive).velocity - reduced.respond(model, fine).velocity)
            simulation = partial(reduced.respond, model, drive)
            rows.append((configuration.name, name, seed, _milliseconds(simulation) / hours, off))
    return pd.DataFrame(rows, columns=_COLUMNS)


def cost_summary(table: pd.DataFrame) -> pd.DataFrame:
    """Medians over the seeds, and the worst error, a row a configuration and simulator."""
    groups = table.groupby(["configuration", "simulator"], sort=False)
    summary = groups.agg(
        ms_an_hour=("ms_an_hour", "median"), error=("error_m_s", "median"), worst_error=("error_m_s", "max")
    )
    return summary.reset_index()


def _milliseconds(work: Callable[[], object]) -> float:
    work()
    times = []
    for _ in range(_REPEATS):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return 1e3 * float(np.median(times))


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))
