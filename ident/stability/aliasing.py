"""The aliasing of T 2.6.2 as a map: how far too few stations for the harmonics lead the spectral simulator astray."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from data_synth.ships import StandardInput, standard_input
from ident.stability.planar import Floats, mangus, rms
from models.quantity import NumericalFailure
from models.spectral import simulate
from models.spectral.basis import smallest_stations
from models.trace import Trace

#: Resolutions of the map, and of its reduced form.
HARMONICS = (2, 4, 6, 8, 10, 12, 16, 20, 24, 30)
STATIONS = (4, 6, 8, 10, 12, 14, 17, 20, 23, 26, 30, 36, 42, 52)
FEW_HARMONICS, FEW_STATIONS = (4, 10, 16), (6, 10, 20, 30)
#: A pair counts as unstable where its velocity is off by more than this share of the RMS velocity.
LIMIT = 0.02
#: Stations of the run that a pair is held against, over the fewest that the simulator accepts.
_AMPLE = 3


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AliasingMap:
    """RMS error of the vehicle's velocity by what the stations leave out, a share of the RMS velocity.

    `error` (n, m) for `harmonics` (n,) and `stations` (m,), infinite where the run fails; `accepted` (n, m) where the
    simulator takes the pair without being told to.
    """

    harmonics: tuple[int, ...]
    stations: tuple[int, ...]
    error: Floats
    accepted: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    @property
    def stable(self) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """(n, m) whether the error is at most `LIMIT`."""
        return np.asarray(self.error <= LIMIT)


@cache
def aliasing_map(*, few: bool = False) -> AliasingMap:
    """Ten minutes of the standard input on mangus-740, every pair against as many harmonics on ample stations.

    It is made once, for the case that it belongs to and for the page.
    """
    harmonics, stations = (FEW_HARMONICS, FEW_STATIONS) if few else (HARMONICS, STATIONS)
    error = np.array([_errors(N, stations) for N in harmonics])
    accepted = np.array([[smallest_stations(N) <= J for J in stations] for N in harmonics])
    error.setflags(write=False)
    accepted.setflags(write=False)
    return AliasingMap(harmonics=harmonics, stations=stations, error=error, accepted=accepted)


def aliasing_error(harmonics: int, stations: int) -> float:
    """The error of one pair, as in `AliasingMap`."""
    return _errors(harmonics, (stations,))[0]


def _errors(harmonics: int, stations: Sequence[int]) -> list[float]:
    ample = _surge(harmonics, _AMPLE * smallest_stations(harmonics))
    found = []
    for J in stations:
        try:
            found.append(rms(_surge(harmonics, J) - ample) / rms(ample))
        except NumericalFailure:
            found.append(float("inf"))
    return found


def _surge(harmonics: int, stations: int) -> Floats:
    run = simulate(
        mangus(), _ship(), harmonics=harmonics, stations=stations, tolerance=1e-4, allow_aliasing=True, companion=False
    )
    return run.vehicle.rates()[:, 0]


def _ship() -> Trace:
    return standard_input(StandardInput(duration=600.0), np.random.default_rng(1))
