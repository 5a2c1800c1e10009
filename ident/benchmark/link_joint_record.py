"""What the benchmark records of the link-joint chain, and of MoorDyn beside it: rows, targets, parts of the page."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from ident import tows_compared
from ident.benchmark import chain_bench, peer_bench, peers
from ident.benchmark.bench_record import HOUR, Record
from ident.benchmark.chain_bench import ChainTow, Effort
from ident.benchmark.peer_bench import PeerTow
from ident.benchmark.peers import velocity_error
from ident.configuration import Configuration
from ident.timing import Timing, front
from models.quantity import InvalidInput, NumericalFailure
from models.towed_system import TowedSystem
from models.trace import Trace
from reports.bench_page import Diagram
from reports.figures.bench import Curve, Sizes
from reports.markdown import significant

METHOD, _PEER = "link-joint", "MoorDyn"
#: What is expected to take so long [s]: the chain on the tows of one configuration, the peer on one tow, the turn of
#: one system, growth, the dense form.
_ONE_TAKES, _PEER_TAKES, _TURN_TAKES, _GROWTH_TAKES, _DENSE_TAKES = 15.0, 15.0, 6.0, 12.0, 8.0
#: Figures to reach: ratio to the peer at equal error, growth over a doubling, time, depth and track error of the turn
#: with its first part alone, ratio to the dense form at a number of links.
_TIMES_PEER, _DOUBLING, _TURN, _TIMES_DENSE = 20.0, 2.2, (0.2, 1e-3, 0.5), {64: 60.0, 256: 500.0}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Measured:
    """The chain on the tows of one configuration, by the name of the tow."""

    configuration: Configuration
    chains: dict[str, ChainTow]
    curves: list[Curve]
    converged: list[dict[str, Any]]


def peer_note() -> str:
    found = peers.version()
    if found is None:
        return f"MoorDyn is not installed, so it is not compared with; `{peers.INSTALL}` installs it."
    return (
        f"MoorDyn {found} runs the first part alone, with the same cable and body. Its longest stable steps are found "
        "by bisection, for each of the integrators worth a try, with the axial loss that lets it take the longest: "
        "stable means close to its own finer run, for past the limit a run can stay bounded and be wrong. Both times "
        "are those of the stepping alone; finding the start shape takes the chain a few milliseconds, and MoorDyn, "
        "which lets the line swing to rest, up to hundreds."
    )


def measure(run: Record, effort: Effort, configurations: Sequence[Configuration]) -> list[Measured]:
    """The chain on every tow of each configuration's first part; those without time are left out."""
    found = []
    for each in configurations:
        what = f"{each.name}: the chain on all tows"
        if not run.has_time(what, _ONE_TAKES * effort.scale):
            continue
        try:
            found.append(_chain(run, effort, each))
        except NumericalFailure as error:
            run.cut.append((what, str(error)))
    return found


def _chain(run: Record, effort: Effort, configuration: Configuration) -> Measured:
    name, system = configuration.name, configuration.system_of(1)
    curves: list[Curve] = []
    converged: list[dict[str, Any]] = []
    chains: dict[str, ChainTow] = {}
    for tow, ship in tows_compared.tows(effort.scale).items():
        run.tell(f"{name}: {tow}")
        chain = chains[tow] = chain_bench.work_precision(system, tow, ship, effort)
        every = [(point.error, HOUR * point.timing.seconds) for point in chain.points]
        best = front(every, lambda point: point)
        curves.append(Curve(tow=tow, label=METHOD, every=every, best=best))
        converged.append(_converged(tow, METHOD, chain.uncertainty, math.nan))
        kind = f"against {chain_bench.FINER} times the most links and {chain_bench.TIGHTER:g} of the tolerance"
        for point in chain.points:
            setting = f"{tow}: {point.links} links, {point.tolerance:g} m/s"
            run.row(name, METHOD, setting, kind, point.error, point.timing)
    return Measured(configuration=configuration, chains=chains, curves=curves, converged=converged)


def beside_peer(run: Record, effort: Effort, measured: Measured) -> Diagram:
    """The diagram of one configuration, with the peer on the same tows where it is installed and there is time."""
    name, system = measured.configuration.name, measured.configuration.system_of(1)
    curves, converged = list(measured.curves), list(measured.converged)
    compared: list[dict[str, Any]] = []
    for tow, ship in tows_compared.tows(effort.scale).items():
        chain, peer = measured.chains[tow], _peer(run, effort, name, system, tow, ship)
        if peer is None:
            continue
        points = [(point.error, HOUR * point.timing.seconds) for point in peer.points]
        curves.append(Curve(tow=tow, label=_PEER, every=points, best=points))
        converged.append(_converged(tow, _PEER, peer.uncertainty, velocity_error(peer.converged, chain.converged)))
        compared += _compared(run, name, peer, chain)
    if compared:
        # The chain is not asked for errors below its own finest setting.
        ratios = [row["ratio"] for row in compared if math.isfinite(row["ratio"])]
        text = f"{significant(min(ratios), 2)} to {significant(max(ratios), 2)}" if ratios else "none"
        met = bool(ratios) and min(ratios) >= _TIMES_PEER
        run.target(f"{name}: MoorDyn's CPU time over the chain's at equal error", f"{_TIMES_PEER:g}", text, met)
    return Diagram(configuration=name, curves=curves, converged=pd.DataFrame(converged), peers=pd.DataFrame(compared))


def _peer(run: Record, effort: Effort, name: str, system: TowedSystem, tow: str, ship: Trace) -> PeerTow | None:
    """MoorDyn on one tow, None where it is not installed, cannot, or has no time."""
    what = f"{name}: {tow} with MoorDyn"
    if peers.version() is None or not run.has_time(what, _PEER_TAKES * effort.scale):
        return None
    try:
        return peer_bench.run_tow(system, tow, ship, effort.segments, min(3, effort.repetitions))
    except (InvalidInput, NumericalFailure) as error:
        run.cut.append((what, str(error)))
        return None


def _compared(run: Record, name: str, peer: PeerTow, chain: ChainTow) -> list[dict[str, Any]]:
    best = front([(point.error, point.timing.seconds) for point in chain.points], lambda point: point)
    found = []
    for point, ratio in zip(peer.points, peer_bench.ratios(peer.points, best), strict=True):
        hour, at = HOUR * point.timing.seconds, point.setting
        setting = f"{point.tow}: {at.segments} segments, {at.scheme}, {at.step:.3g} s"
        run.row(name, _PEER, setting, "against its own converged run", point.error, point.timing)
        found.append(
            {
                "tow": point.tow,
                "segments": at.segments,
                "scheme": at.scheme,
                "step_s": at.step,
                "error_m_s": point.error,
                "seconds_per_hour": hour,
                "chain_seconds_per_hour": hour / ratio,
                "ratio": ratio,
            }
        )
    return found


def _converged(tow: str, method: str, uncertainty: float, apart: float) -> dict[str, Any]:
    return {"tow": tow, "method": method, "uncertainty_m_s": uncertainty, "apart_m_s": apart}


def growth(run: Record, effort: Effort, configuration: Configuration, system: TowedSystem) -> list[Sizes]:
    """Time against links and against the record; rows of bench.csv without an error."""
    if not run.has_time("growth", _GROWTH_TAKES * effort.scale):
        return []
    try:
        return _growth(run, effort, configuration, system)
    except NumericalFailure as error:
        run.cut.append(("growth", str(error)))
        return []


def _growth(run: Record, effort: Effort, configuration: Configuration, system: TowedSystem) -> list[Sizes]:
    ship = tows_compared.tows()["circle"]
    speed, radius = tows_compared.SPEED, tows_compared.RADIUS
    by_links = chain_bench.growth_by_links(system, ship, effort)
    by_length = chain_bench.growth_by_length(system, speed, radius, effort)
    for found in (by_links, by_length):
        for size, seconds, spread in zip(found.sizes, found.seconds, found.spread, strict=True):
            duration = chain_bench.DURATION if found is by_links else size
            timing = Timing(seconds / duration, spread, found.repetitions)
            setting = f"fixed step of {chain_bench.STEP:g} s, {found.what} {size:g}"
            run.row(configuration.name, METHOD, setting, "growth, no error", math.nan, timing)
    doubling = by_links.doubling
    run.target(
        "growth of the time over a doubling of the links",
        f"at most {_DOUBLING:g}",
        f"{doubling:.2f}",
        doubling <= _DOUBLING,
    )
    return [
        Sizes(
            what=found.what,
            sizes=found.sizes,
            seconds=found.seconds,
            iterations=found.iterations,
            exponent=found.exponent,
        )
        for found in (by_links, by_length)
    ]


def dense(run: Record, effort: Effort, configuration: Configuration, system: TowedSystem) -> pd.DataFrame:
    if not run.has_time("the dense form", _DENSE_TAKES * effort.scale):
        return pd.DataFrame()
    rows = []
    try:
        forms = chain_bench.dense_form(system, tows_compared.tows()["circle"], effort)
    except NumericalFailure as error:
        run.cut.append(("the dense form", str(error)))
        return pd.DataFrame()
    for each in forms:
        ratio = each.evaluation / each.step
        rows.append((each.links, each.evaluation, each.step, ratio, 2.0 * ratio))
        asked = _TIMES_DENSE.get(each.links)
        if asked is not None:
            what = (
                f"{configuration.name}: the dense form's time over the chain's, a second-order step, {each.links} links"
            )
            run.target(what, f"{asked:g}", f"{2.0 * ratio:.0f}", 2.0 * ratio >= asked)
    return pd.DataFrame(rows, columns=["links", "evaluation_s", "step_s", "ratio", "same_order"])


def turns(run: Record, effort: Effort, configuration: Configuration) -> list[dict[str, Any]]:
    """The turn with one part, with two, and so on; none where the configuration has no speed to turn at."""
    name, speed, found = configuration.name, configuration.tow.speed, []
    for parts in range(1, 2 + len(configuration.tails) if speed > 0.0 else 1):
        what = f"{name}: the turn with {parts} part{'s' * (parts > 1)}"
        if not run.has_time(what, _TURN_TAKES * effort.scale):
            continue
        try:
            circles = chain_bench.turn(configuration.system_of(parts), speed, tows_compared.RADIUS, effort)
        except NumericalFailure as error:
            run.cut.append((what, str(error)))
            continue
        found += [
            {
                "configuration": name,
                "parts": parts,
                "links": each.links,
                "tolerance_m_s": each.tolerance,
                "seconds": each.timing.seconds,
                "steps": each.steps,
                "depth_percent": 100.0 * each.depth_error,
                "track_m": each.track_error,
                "uncertainty_m_s": each.uncertainty,
            }
            for each in circles
        ]
        if parts == 1:
            best = circles[-1]
            shown = (best.timing.seconds, best.depth_error, best.track_error)
            run.target(
                f"{name}: the turn with one part, {best.links} links at {best.tolerance:g} m/s",
                f"{_TURN[0]:g} s, {100.0 * _TURN[1]:g} % of depth, {_TURN[2]:g} m",
                f"{shown[0]:.3f} s, {100.0 * shown[1]:.3f} %, {shown[2]:.2f} m",
                all(value <= limit for value, limit in zip(shown, _TURN, strict=True)),
            )
    return found
