"""The matrix method in a random sea against the nonlinear chain in the time domain, as in H Table V.

The chain's body is a joint without pitch, towed at its centre of mass. What that is worth is told by a second solve of
the matrix method, for a body that stays level: its tow point and its centres of drag and added mass at its centre of
mass. In a flow the drag of a moving towfish still differs, |u| (A_P u_P, A_Q u_Q) of the chain's body and
(A_P |u_P| + A_Q |u_Q|) u of H (15)-(16).

What the chain does slower than the slowest wave is told apart. Drag grows with the square of the speed, so that groups
of high waves shift the whole tow; a linear method has nothing there.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from data_synth.rao import Rao
from data_synth.spectra import Spectrum
from ident.chain_record import QUANTITIES, ChainRecord, ChainSetting, chain_record, moves, resolved
from ident.sea_drawing import Drawing, between, draw, imposed_motion, sampling_error
from ident.timing import interleaved
from models.response_statistics import Extreme
from models.tow import Tow
from models.transfer_matrix import Direction, DragForm, SeaResponse, sea_response
from models.vehicle import Towfish

#: Duration of the record unless given, as that of the extremes of a sea study, and what sets in before it [s].
DURATION, RUN_IN = 3.0 * 3600.0, 3600.0
#: Share of each quantity that the errors of both methods are to stay below.
ACCURATE = 5e-3
#: H's number of frequencies, and where the search for the fewest segments that do begins and ends, a length of cable.
_FREQUENCIES, _SEGMENTS, _MOST_SEGMENTS = 40, 8, 1024
#: A mean below this share of the motion is rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SeaCheck:
    """Both methods in the same sea.

    Parameters
    ----------
    table
        As of `comparison`.
    costs
        A row a way to compute: ``method, settings, error_percent`` (the largest), ``cpu_s`` of its one thread, and
        ``ratio`` of the chain's to it.
    drawing, chain
        The sea that was drawn, and the chain's record in it.
    """

    table: pd.DataFrame
    costs: pd.DataFrame
    drawing: Drawing
    chain: ChainRecord


def check_sea(
    tow: Tow,
    spectrum: Spectrum,
    *,
    rao: Rao | None = None,
    direction: Direction = "heave",
    drag: DragForm = "consistent",
    duration: float = DURATION,
    run_in: float = RUN_IN,
    setting: ChainSetting | None = None,
    seed: int = 1,
) -> SeaCheck:
    """Simulate the chain in a drawn sea and compare it with the matrix method.

    Parameters
    ----------
    rao, direction, drag
        As of `ident.studies.sea`.
    duration, run_in
        Of the record and of what is dropped before it [s].
    setting
        Of the chain; left out, its links are doubled on a short record until their error is below `ACCURATE`.
    seed
        Of the phases.

    Raises
    ------
    InvalidInput
        The record is too short, or the chain does not know the body.
    NumericalFailure
        Either method fails.
    """

    def solve(of: Tow, over: Spectrum = spectrum, segments: int | None = None, companion: bool = True) -> SeaResponse:
        motion = None if rao is None else rao.motion(over.omega)
        return sea_response(
            of,
            over.omega,
            over.density,
            motion=motion,
            direction=direction,
            drag=drag,
            segments=segments,
            companion=companion,
        )

    response = solve(tow)
    angle = float(response.response.shape.phi[-1])

    def record(over: Drawing, links: int, share: float, before: float) -> ChainRecord:
        position = over.series(imposed_motion(over.omega, direction, rao, angle))
        return chain_record(tow, over, position, angle, links=links, share=share, run_in=before)

    rng, slowest = np.random.default_rng(seed), float(spectrum.omega[0])
    if setting is None:
        setting = resolved(record, lambda period: draw(spectrum, period, rng), slowest, duration + run_in, ACCURATE)
    drawing = draw(spectrum, duration, rng)
    chain = record(drawing, setting.links, setting.share, run_in)
    still = level(tow)
    table = comparison(drawing, chain, response, setting, slowest, None if still is None else solve(still))
    costs = cost_table(lambda over, segments, companion: solve(tow, over, segments, companion), spectrum, table, chain)
    return SeaCheck(table=table.drop(columns="compared"), costs=costs, drawing=drawing, chain=chain)


def level(tow: Tow) -> Tow | None:
    """The tow with a towfish that never pitches, as the chain's body; None where the body is a point already."""
    body = tow.vehicle
    if not isinstance(body, Towfish):
        return None
    # The buoyancy above the centre of mass keeps it upright; no force has a lever to turn it.
    centred = replace(
        body,
        buoyancy_centre_p=0.0,
        buoyancy_centre_q=max(body.buoyancy_centre_q, 0.01 * body.length),
        added_mass_centre_p=0.0,
        added_mass_centre_q=0.0,
        tow_point_p=0.0,
        tow_point_q=0.0,
        drag_centre_p=0.0,
        drag_centre_q=0.0,
    )
    return replace(tow, vehicle=centred)


def comparison(
    drawing: Drawing,
    chain: ChainRecord,
    response: SeaResponse,
    setting: ChainSetting,
    slowest: float,
    upright: SeaResponse | None = None,
) -> pd.DataFrame:
    """A row for each series of the chain, in its ``unit``.

    ``rms`` of the chain from the slowest wave [rad/s] up, and ``sigma`` of the matrix method, with the
    ``difference_percent`` of the first from the second; the same with ``level`` for the response `upright`;
    ``sampling_percent`` of the RMS of a record so long, had its amplitudes been drawn too; ``crests`` in it; the
    ``largest`` amplitude and the ``expected`` one; ``slow_rms`` and ``mean`` of what the chain does below the waves'
    frequencies; ``chain_error_percent`` and ``matrix_error_percent`` of RMS and sigma. Whether a quantity is
    ``compared``: of one that hardly moves the shares are left out.
    """
    rows = []
    for name, series in chain.series.items():
        sigma, waves = response.sigma[name], between(series, drawing.sample, slowest)
        rms = float(np.std(waves))
        row: dict[str, object] = {"quantity": name, "unit": QUANTITIES[name], "rms": rms}
        row["compared"] = compared = moves(name, rms, chain) and moves(name, sigma, chain)
        row["sampling_percent"] = 100.0 * sampling_error(response, name, drawing.period) if compared else math.nan
        row["sigma"] = sigma
        row["difference_percent"] = 100.0 * (rms / sigma - 1.0) if compared else math.nan
        if upright is not None:
            row["sigma_level"] = beside = upright.sigma[name]
            row["difference_level_percent"] = 100.0 * (rms / beside - 1.0) if compared else math.nan
        row["crests"] = int(np.count_nonzero((waves[:-1] < 0.0) & (waves[1:] >= 0.0)))
        row["largest"] = float(np.abs(waves).max())
        extreme = Extreme.over(drawing.period, sigma=sigma, rate=response.rate[name]) if compared else None
        row["expected"] = math.nan if extreme is None else extreme.expected
        row["slow_rms"] = float(np.std(between(series, drawing.sample, 0.0, slowest)))
        mean = float(np.mean(series))
        row["mean"] = mean if abs(mean) > _ROUNDING * float(np.std(series)) else 0.0
        row["chain_error_percent"] = 100.0 * setting.error.get(name, math.nan)
        row["matrix_error_percent"] = 100.0 * response.error[name] / sigma if compared else math.nan
        rows.append(row)
    return pd.DataFrame(rows)


def cost_table(
    solve: Callable[[Spectrum, int | None, bool], SeaResponse],
    spectrum: Spectrum,
    table: pd.DataFrame,
    chain: ChainRecord,
) -> pd.DataFrame:
    """The chain's run, the matrix method as the study asks for it, and as cheap as it may be with errors `ACCURATE`.

    `solve` takes the spectrum, the number of segments and whether to estimate its error.
    """
    compared = table[table["compared"]]

    def error(made: SeaResponse) -> float:
        sigma = compared["quantity"].map(made.sigma)
        return float((sigma / compared["sigma"] - 1.0).abs().max())

    few, response = _thinned(spectrum, _FREQUENCIES), solve(spectrum, None, True)
    parts = len(chain.links)
    count = _SEGMENTS * parts
    while error(once := solve(few, count, False)) > ACCURATE and count < _MOST_SEGMENTS * parts:
        count *= 2
    full, lean = interleaved([lambda: solve(spectrum, None, True), lambda: solve(few, count, False)], 3)
    links = "+".join(str(each) for each in chain.links)
    rows = [
        (
            "chain",
            f"{links} links, {chain.tolerance:.2g} m/s, {chain.steps} steps",
            float(compared["chain_error_percent"].max()),
            chain.cpu,
        ),
        (
            "matrix, with its error",
            f"{spectrum.omega.size} frequencies, {response.response.shape.s.size - 1} segments",
            float(compared["matrix_error_percent"].max()),
            full.seconds,
        ),
        ("matrix, once", f"{_FREQUENCIES} frequencies, {count} segments", 100.0 * error(once), lean.seconds),
    ]
    made = pd.DataFrame(rows, columns=["method", "settings", "error_percent", "cpu_s"])
    return made.assign(ratio=chain.cpu / made["cpu_s"])


def _thinned(spectrum: Spectrum, points: int) -> Spectrum:
    """The spectrum at fewer frequencies, with the same variance."""
    omega = np.geomspace(spectrum.omega[0], spectrum.omega[-1], points)
    thin = Spectrum(omega=omega, density=spectrum.at(omega))
    return Spectrum(omega=omega, density=thin.density * (spectrum.moment(0) / thin.moment(0)))
