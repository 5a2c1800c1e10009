"""The comparison of the reference simulators: from which speed and angle on small deflections are not small.

The ship goes from rest, or from the steady tow, to a ladder of speeds. On the same track run the spectral simulator,
linear in the shape of the cable, and the link-joint chain, right at any angle; what they differ by beyond the
numerical errors of both is the spectral model's own error.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd

from data_synth.ships import SpeedChanges, speed_changes
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.places import new_folder
from ident.terminal import Progress
from ident.truth import reference_run
from models import link_joint
from models.link_joint import LinkJointResult
from models.link_joint.steady import equilibrium
from models.quantity import InvalidInput, NumericalFailure
from models.spectral import SpectralResult
from models.tow import Tow, refuse_sections_and_thrust
from models.towed_system import TowedSystem
from models.trace import Floats, Trace
from models.vehicle import Towfish
from reports.compare_page import CompareMaterial, Series, Threshold, write_compare_page
from reports.files import write_json, write_table
from reports.markdown import significant

_T = TypeVar("_T")

#: What the ship's speed is changed by [m/s], and over how long [s].
SPEEDS = (0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
RISE = 60.0
#: How long a configuration is followed [s]: the first time after which the vehicle has this share of every change.
DURATIONS, FOLLOWED = (1800.0, 2700.0, 3600.0, 5400.0, 7200.0), 0.95
#: The share of the speed that is a threshold beside the stated error.
SHARE = 0.01
#: The chain is refined over these links, its tolerance [m/s] with their square, until its own error is this share of
#: the difference.
_LINKS, _TOLERANCE, _OWN = (48, 96, 192, 384), 1e-5, 0.1
_LOOK = 10.0
COLUMNS = (
    "configuration",
    "tow_speed_m_s",
    "speed_m_s",
    "duration_s",
    "angle_rad",
    "travel_angle_rad",
    "followed_share",
    "difference_rms_velocity_m_s",
    "difference_rms_position_m",
    "difference_share",
    "spectral_error_m_s",
    "chain_error_m_s",
    "chain_links",
    "spectral_s",
    "chain_s",
    "note",
)


@dataclass(frozen=True, kw_only=True)
class CompareResult:
    """Where the page is, and the thresholds for the terminal."""

    folder: Path
    table: list[dict[str, str]]


def compare(
    configurations: Sequence[Configuration],
    *,
    out: Path,
    progress: Progress,
    speeds: Sequence[float] = SPEEDS,
    durations: Sequence[float] = DURATIONS,
) -> CompareResult:
    """Run both simulators over the ladder of speeds and write the page and the tables.

    A configuration with a [tow] speed is towed from rest and from that speed.

    Raises
    ------
    InvalidInput
        The place cannot be written, two configurations are called the same, a cable has sections, or a body is a
        towfish.
    """
    names = [each.name for each in configurations]
    if len(set(names)) < len(names):
        raise InvalidInput(f"The configurations to compare on must differ in name, but they are {', '.join(names)}.")
    for each in configurations:
        refuse_sections_and_thrust(each.tow, "The comparison of the simulators")
        if isinstance(each.tow.vehicle, Towfish):
            raise InvalidInput(
                f"{each.source} has a [towfish], which pitches in the spectral simulator but not in the chain; give a "
                "[vehicle] instead."
            )
    cases = [(each, start) for each in configurations for start in dict.fromkeys((0.0, each.tow.speed))]
    with new_folder(out) as folder:
        progress("compiling", 0.0)
        _row(*cases[0], speeds[-1], durations[0])
        series = []
        for i, (configuration, start) in enumerate(cases):

            def tell(what: str, share: float, i: int = i) -> None:
                progress(what, 0.02 + 0.95 * (i + share) / len(cases))

            series.append(_series(configuration, _ladder(configuration, start, speeds, durations, tell)))
        progress("drawing the page", 0.98)
        told: dict[str, Any] = manifest("compare", configurations[0], None, speeds=list(speeds))
        for key in ("configuration_name", "configuration"):
            del told[key]
        write_compare_page(
            folder,
            CompareMaterial(
                series=series,
                rise=RISE,
                followed=FOLLOWED,
                share=SHARE,
                left_out=[note for each in configurations for note in _left_out(each)],
                manifest=told,
            ),
        )
        write_table(folder / "compare.csv", pd.concat([each.table for each in series]))
        thresholds = pd.DataFrame([_threshold_row(each, one) for each in series for one in each.thresholds])
        write_table(folder / "thresholds.csv", thresholds, digits=4)
        write_json(
            folder / "manifest.json", told | {"configurations": {each.name: each.text for each in configurations}}
        )
        progress("done", 1.0)
    shown = thresholds.map(lambda value: value if isinstance(value, str) else significant(value)).to_dict("records")
    return CompareResult(folder=out, table=[{str(name): text for name, text in row.items()} for row in shown])


def crossing(table: pd.DataFrame, column: str, limit: float) -> tuple[float, float, str]:
    """Speed [m/s] and angle [rad] from which a column stays above a limit, between rows by a power law.

    NaN where the rows do not enclose it, and then why in words.
    """
    rows = table[table[column].notna()]
    values, speed, angle = (rows[name].to_numpy(dtype=float) for name in (column, "speed_m_s", "angle_rad"))
    if values.size == 0:
        return math.nan, math.nan, "nothing to compare"
    if values[-1] <= limit:
        return math.nan, math.nan, f"not passed up to {speed[-1]:g} m/s"
    below = np.flatnonzero(values <= limit)
    if below.size == 0:
        return math.nan, math.nan, f"passed below {speed[0]:g} m/s"
    i = int(below[-1])
    part = math.log(limit / values[i]) / math.log(values[i + 1] / values[i])
    found = [float(each[i] * (each[i + 1] / each[i]) ** part) for each in (speed, angle)]
    return found[0], found[1], ""


def _ladder(
    configuration: Configuration, start: float, speeds: Sequence[float], durations: Sequence[float], progress: Progress
) -> pd.DataFrame:
    """Rows of compare.csv over the speeds, all as long as it takes the vehicle to follow, or the longest."""
    for duration in durations:
        rows = []
        for k, speed in enumerate(speeds):
            progress(f"{configuration.name}: from {start:g} m/s by {speed:g} m/s in {duration:g} s", k / len(speeds))
            rows.append(_row(configuration, start, speed, duration))
            if rows[-1]["followed_share"] < FOLLOWED and duration != durations[-1]:
                break
        else:
            break
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _series(configuration: Configuration, table: pd.DataFrame) -> Series:
    """The ladder of one configuration with its thresholds."""
    stated = configuration.spectral.tolerance
    limits = (
        (f"stated error {stated:g} m/s", "difference_rms_velocity_m_s", stated),
        (f"{100.0 * SHARE:g} % of the speed", "difference_share", SHARE),
    )
    found = []
    for name, column, limit in limits:
        speed, angle, note = crossing(table, column, limit)
        difference = limit if column != "difference_share" else limit * speed
        found.append(Threshold(name=name, speed=speed, angle=angle, difference=difference, note=note))
    return Series(
        configuration=configuration.name,
        tow_speed=float(table["tow_speed_m_s"].iloc[0]),
        duration=float(table["duration_s"].iloc[0]),
        stated=stated,
        table=table,
        thresholds=found,
    )


def _threshold_row(series: Series, threshold: Threshold) -> dict[str, Any]:
    return {
        "configuration": series.configuration,
        "tow_speed_m_s": series.tow_speed,
        "threshold": threshold.name,
        "speed_m_s": threshold.speed,
        "angle_rad": threshold.angle,
        "note": threshold.note,
    }


def _row(configuration: Configuration, start: float, change: float, duration: float) -> dict[str, Any]:
    """A row of compare.csv; what fails leaves its cells empty and its reason as the note."""
    tow = replace(configuration.tow, speed=start)
    ship = speed_changes(
        SpeedChanges(duration=duration, sample=1.0, times=(0.0,), speeds=(start, start + change), rise=RISE)
    )
    row: dict[str, Any] = dict.fromkeys(COLUMNS, math.nan)
    row |= {"configuration": configuration.name, "tow_speed_m_s": start, "speed_m_s": change}
    row |= {"duration_s": duration, "note": ""}
    spectral: SpectralResult | None = None
    try:
        done, row["spectral_s"] = _timed(lambda: reference_run(replace(configuration, tow=tow), ship))
        spectral, row["spectral_error_m_s"] = done, math.nan if done.error is None else done.error
    except NumericalFailure as failure:
        row["note"] = str(failure)
    try:
        chain, taken, apart = _refined(tow, ship, spectral)
        steady, travel = _angles(chain, start, start + change)
    except NumericalFailure as failure:
        return row | {"note": " ".join(filter(None, (row["note"], str(failure))))}
    followed = (float(chain.vehicle.rates()[-1, 0]) - start) / change
    row |= {"angle_rad": steady, "travel_angle_rad": travel, "followed_share": followed}
    row |= {"chain_error_m_s": chain.error, "chain_links": chain.links[0], "chain_s": taken}
    if spectral is not None:
        row["difference_rms_velocity_m_s"], row["difference_share"] = apart, apart / change
        row["difference_rms_position_m"] = _rms(chain.vehicle.position - spectral.vehicle.position)
    return row


def _refined(tow: Tow, ship: Trace, spectral: SpectralResult | None) -> tuple[LinkJointResult, float, float]:
    """The chain, fine enough for the difference; its CPU time [s], the RMS velocity difference [m/s], NaN of none."""
    system = TowedSystem.from_tow(tow)
    looks = np.append(np.arange(ship.t[0], ship.t[-1], _LOOK), ship.t[-1])

    def run(links: int) -> Callable[[], LinkJointResult]:
        tolerance = _TOLERANCE * (_LINKS[0] / links) ** 2
        return lambda: link_joint.simulate(
            system, ship, links=links, tolerance=tolerance, start="rest", shapes_at=looks
        )

    for links in _LINKS:
        chain, taken = _timed(run(links))
        apart = math.nan if spectral is None else _rms(chain.vehicle.rates() - spectral.vehicle.rates())
        assert chain.error is not None
        if spectral is None or chain.error <= _OWN * apart:
            break
    return chain, taken, apart


def _angles(chain: LinkJointResult, start: float, end: float) -> tuple[float, float]:
    """How far the links have turned at most from where they began [rad]: in the steady tow at the end, on the way.

    From rest in still water that is their angle from the vertical.
    """
    began = _inclination(equilibrium(chain.layout, (start, 0.0, 0.0))[0])
    steady = _inclination(equilibrium(chain.layout, (end, 0.0, 0.0))[0])
    travel = max(float(np.abs(_inclination(shape) - began).max()) for shape in chain.shapes)
    return float(np.abs(steady - began).max()), travel


def _inclination(nodes: Floats) -> Floats:
    """(links,) angle of each link from the vertical [rad], ahead positive, of nodes (links + 1, 3) in the plane."""
    steps = np.diff(nodes, axis=0)
    return np.arctan2(steps[:, 0], steps[:, 2])


def _left_out(configuration: Configuration) -> list[str]:
    """What a configuration has that the comparison does without."""
    found, chain = [], configuration.link_joint
    if configuration.tails:
        found.append(f"the parts behind the vehicle, {', '.join(part.name for part in configuration.tails)}")
    if chain.strumming:
        found.append("strumming")
    if chain.drag_law != "quadratic":
        found.append(f"the {chain.drag_law} drag law")
    return [f"{configuration.name}: {what}, which the spectral simulator does not have" for what in found]


def _timed(work: Callable[[], _T]) -> tuple[_T, float]:
    """What a call returns, and its CPU time on this thread [s]."""
    began = time.thread_time()
    result = work()
    return result, time.thread_time() - began


def _rms(vectors: Floats) -> float:
    """Root mean square length of (n, 3) vectors."""
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))
