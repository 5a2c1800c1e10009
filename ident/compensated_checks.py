"""The matrix method with a heave compensator against the nonlinear chain in the time domain, as in H Table V.

The chain takes the motion p of its top as given, so the balance of the compensator below the deck's motion D,

    m p'' + T~_n + b (p' - D') + k (p - D) = 0,

is solved by iterating whole records of a sea that repeats: the chain gives the tension of a motion p, and what is out
of balance, r, corrects the motion by -r/(c + i omega b + k) at each frequency, c = T_n/p_n - omega^2 m of the matrix
method. The first p is the linear answer.

Only frequencies up to the highest at which the deck moves are corrected. Above it there is little but what quadratic
drag and slack make of the waves, at frequencies near those of the cable itself, where half a percent in c changes its
sign; p keeps its linear answer there, and what that is worth is told.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from data_synth.spectra import Spectrum
from ident.chain_record import BUDGET, ChainRecord, ChainSetting, chain_record, resolved
from ident.compensator_seas import Seaway
from ident.sea_checks import ACCURATE, DURATION, comparison, cost_table
from ident.sea_drawing import Drawing, draw
from models.compensator import Setting
from models.quantity import InvalidInput
from models.trace import Floats
from models.transfer_matrix import Compensator, SeaResponse, sea_response

Complexes = NDArray[np.complex128]

#: What is dropped before the record [s]: the motion along a cable sets in within a minute.
RUN_IN = 600.0
#: Correction at which the motion is taken as found, over the motion; the most runs of the chain, and how many it takes.
SETTLED, MOST_RUNS, _USUAL_RUNS = 0.01, 12, 5
#: The deck moves where its spectrum is above this share of its peak.
_MOVES = 1e-5
#: Frequencies below those of the sea at which the cable is solved too, and the lowest over the sea's lowest.
_SLOW, _SLOWEST = 20, 0.05


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CompensatedCheck:
    """Both methods with a compensator in the same sea.

    Parameters
    ----------
    table, costs, chain
        As of `ident.sea_checks.SeaCheck`; one run of the chain in `costs`, whatever the iteration takes.
    history
        A row a run of the chain: ``run``, ``correction_percent`` of the motion that it asks for, ``residual_percent``
        of the tension that is out of balance where it is corrected, ``slack``, ``cpu_s``.
    settled
        Whether the last correction was below `SETTLED`.
    left_percent
        The correction that the frequencies above the deck's would ask for, of the motion.
    """

    table: pd.DataFrame
    costs: pd.DataFrame
    history: pd.DataFrame
    chain: ChainRecord
    settled: bool
    left_percent: float


def check_compensated(
    sea: Seaway,
    setting: Setting,
    *,
    duration: float = DURATION,
    run_in: float = RUN_IN,
    chain_setting: ChainSetting | None = None,
    seed: int = 1,
) -> CompensatedCheck:
    """Simulate the chain below a compensator in a drawn sea and compare it with the matrix method.

    Parameters
    ----------
    setting
        Of the compensator, not locked: a locked one is `ident.sea_checks.check_sea` with the direction ``axial``.
    duration, run_in, chain_setting, seed
        As of `check_sea`.

    Raises
    ------
    InvalidInput
        The compensator is locked, the record is too short, or the chain does not know the body.
    NumericalFailure
        Either method fails.
    """
    if math.isinf(setting.stiffness) or math.isinf(setting.damping):
        raise InvalidInput("A locked compensator has nothing to solve for; check the tow itself along the cable.")
    tow = sea.configuration.tow
    device = Compensator(mass=sea.configuration.compensator.mass, stiffness=setting.stiffness, damping=setting.damping)
    response = sea.response(setting)
    cable = _cable(sea, device)
    angle, slowest = float(response.response.shape.phi[-1]), float(sea.spectrum.omega[0])

    def record(over: Drawing, links: int, share: float, before: float) -> ChainRecord:
        loop = _Loop(over, sea, device, cable)
        return chain_record(tow, over, _along(loop.linear, angle), angle, links=links, share=share, run_in=before)

    rng = np.random.default_rng(seed)
    if chain_setting is None:
        chain_setting = resolved(
            record,
            lambda period: draw(sea.spectrum, period, rng),
            slowest,
            duration + run_in,
            ACCURATE,
            BUDGET / _USUAL_RUNS,
        )
    loop = _Loop(draw(sea.spectrum, duration, rng), sea, device, cable)
    motion = loop.linear
    rows: list[tuple[int, float, float, int, float]] = []
    while True:
        chain = chain_record(
            tow, loop.drawing, _along(motion, angle), angle,
            links=chain_setting.links, share=chain_setting.share, run_in=run_in,
        )  # fmt: skip
        correction, left, residual = loop.correction(motion, chain.series["tension_top"])
        share = float(np.std(correction) / np.std(motion))
        rows.append((len(rows) + 1, 100.0 * share, 100.0 * residual, chain.slack, chain.cpu))
        if share <= SETTLED or len(rows) == MOST_RUNS:
            break
        motion = motion + correction
    chain = replace(chain, series={**chain.series, "relative": motion - loop.deck})
    table = comparison(loop.drawing, chain, response, chain_setting, slowest)

    def solve(over: Spectrum, segments: int | None, companion: bool) -> SeaResponse:
        return replace(sea, spectrum=over, segments=segments).response(setting, companion=companion)

    return CompensatedCheck(
        table=table.drop(columns="compared"),
        costs=cost_table(solve, sea.spectrum, table, chain),
        history=pd.DataFrame(rows, columns=["run", "correction_percent", "residual_percent", "slack", "cpu_s"]),
        chain=chain,
        settled=share <= SETTLED,
        left_percent=100.0 * left / float(np.std(motion)),
    )


class _Loop:
    """The compensator's balance in one drawn sea, by real FFTs of the record.

    `deck` and `linear` (n,) are D and the linear answer p [m].
    """

    def __init__(self, drawing: Drawing, sea: Seaway, device: Compensator, cable: "_Cable") -> None:
        self.drawing, n = drawing, drawing.t.size
        omega = 2.0 * math.pi * np.fft.rfftfreq(n, drawing.sample)
        self.deck = drawing.series(sea.rao.motion(drawing.omega)[:, 1])
        self._link = device.stiffness + 1j * omega * device.damping
        self._mass = device.mass * omega**2
        c = np.interp(omega, cable.omega, cable.c.real) + 1j * np.interp(omega, cable.omega, cable.c.imag)
        self._whole = c + self._link
        moving = sea.spectrum.omega[sea.heave_density > _MOVES * sea.heave_density.max()]
        self._corrected = (omega > 0.0) & (omega <= moving[-1])
        self._deck = np.fft.rfft(self.deck)
        self.linear = np.asarray(np.fft.irfft(self._link / self._whole * self._deck, n), dtype=float)

    def correction(self, motion: Floats, tension: Floats) -> tuple[Floats, float, float]:
        """(n,) what to add to the motion, the RMS of what is not corrected [m], and the residual over the tension."""
        p, T = np.fft.rfft(motion), np.fft.rfft(tension)
        residual = -self._mass * p + T + self._link * (p - self._deck)
        change = -residual / self._whole
        change[0] = residual[0] = 0.0

        def of(values: Complexes) -> Floats:
            return np.asarray(np.fft.irfft(values, motion.size), dtype=float)

        left = float(np.std(of(np.where(self._corrected, 0.0, change))))
        size = float(np.std(of(np.where(self._corrected, residual, 0.0))) / np.std(tension))
        return of(np.where(self._corrected, change, 0.0)), left, size


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Cable:
    """c = T_n/p_n - omega^2 m [N/m] of the cable with the drag of this sea, at frequencies from far below it."""

    omega: Floats
    c: Complexes


def _cable(sea: Seaway, device: Compensator) -> _Cable:
    slow = np.geomspace(_SLOWEST * sea.spectrum.omega[0], sea.spectrum.omega[0], _SLOW, endpoint=False)
    omega = np.concatenate([slow, sea.spectrum.omega])
    # The deck's own spectrum in the place of the waves': every frequency is answered, also where the deck is still.
    density = np.concatenate([np.zeros(_SLOW), sea.heave_density])
    made = sea_response(
        sea.configuration.tow, omega, density, direction="axial", segments=sea.segments, compensator=device
    ).response
    return _Cable(omega=omega, c=made.tension_top / made.top - device.mass * omega**2)


def _along(motion: Floats, angle: float) -> Floats:
    """(n, 2) horizontal and vertical motion of the cable's top by a motion along it."""
    return np.outer(motion, [math.cos(angle), math.sin(angle)])
