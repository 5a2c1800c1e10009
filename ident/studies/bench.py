"""The benchmark: error against run time of the link-joint simulator and of the matrix method, and how it grows."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from ident import chain_bench, matrix_record, peer_bench, peers, tows_compared, transfer_bench
from ident.bench_record import COLUMNS, FREQUENCY_COLUMNS, HOUR, Record
from ident.chain_bench import FULL, ChainTow, Effort
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.peer_bench import PeerTow
from ident.peers import velocity_error
from ident.places import new_folder
from ident.terminal import Progress
from ident.timing import Timing, front
from models.quantity import InvalidInput, NumericalFailure
from models.tow import refuse_sections_and_thrust
from models.towed_system import TowedSystem
from models.trace import Trace
from reports.bench_page import BenchMaterial, Diagram, write_bench_page
from reports.figures.bench import Curve, Sizes
from reports.files import write_json, write_table
from reports.markdown import significant

#: Wall time of the whole benchmark [s]; what would go past it is left out and listed.
BUDGET = 240.0
_CHAIN, _PEER = "link-joint", "MoorDyn"
#: What is expected to take so long [s]: the peer on one tow, the turn of one system, growth, the dense form.
_PEER_TAKES, _TURN_TAKES, _GROWTH_TAKES, _DENSE_TAKES = 15.0, 6.0, 12.0, 8.0
#: Figures to reach: ratio to the peer at equal error, growth over a doubling, time, depth and track error of the turn
#: with its first part alone, ratio to the dense form at a number of links.
_TIMES_PEER, _DOUBLING, _TURN, _TIMES_DENSE = 20.0, 2.2, (0.2, 1e-3, 0.5), {64: 60.0, 256: 500.0}


@dataclass(frozen=True, kw_only=True)
class BenchResult:
    """Where the page is, and the targets for the terminal."""

    folder: Path
    table: list[dict[str, str]]


def bench(
    configurations: Sequence[Configuration],
    *,
    out: Path,
    progress: Progress,
    budget: float = BUDGET,
    effort: Effort = FULL,
    frequencies: transfer_bench.Effort = transfer_bench.FULL,
) -> BenchResult:
    """Measure and write the page, its figures and the tables.

    Parameters
    ----------
    configurations
        The first of them also gives the cable for growth and for the dense form.
    budget
        Wall time [s]; what would go past it is left out and listed.
    effort, frequencies
        How much is run of the chain, and of the matrix method.

    Raises
    ------
    InvalidInput
        The place cannot be written, or a cable has sections.
    NumericalFailure
        A simulation of the chain fails on a tow.
    """
    for each in configurations:
        refuse_sections_and_thrust(each.tow, "The benchmark")
    run = Record(progress=progress, budget=budget)
    first = configurations[0]
    with new_folder(out) as folder:
        progress("compiling", 0.0)
        system = first.system_of(1)
        run.compiled(_CHAIN, chain_bench.first_call(system))
        sizes, dense = _growth(run, effort, first, system), _dense(run, effort, first, system)
        matrix = matrix_record.measure(run, frequencies, configurations)
        turns = pd.DataFrame([row for each in configurations for row in _turns(run, effort, each)])
        diagrams = [_diagram(run, effort, each) for each in configurations]
        matrix = matrix_record.simulated(run, frequencies, matrix)
        matrix = matrix_record.compiled_anew(run, frequencies, matrix)
        names = [each.name for each in configurations]
        told = manifest("bench", first, None, configurations=names, moordyn=peers.version() or "not installed")
        progress("drawing the page", 0.99)
        material = BenchMaterial(
            diagrams=diagrams,
            tows=tows_compared.WORDS,
            targets=pd.DataFrame(run.targets),
            sizes=sizes,
            sized=first.name,
            dense=dense,
            turns=turns,
            turn_words=f"Circles of {tows_compared.RADIUS:g} m from the steady tow, at its speed, for "
            f"{effort.turn_duration:g} s, against a run with {chain_bench.FINER} times the links: the largest error "
            "of any body at any time.",
            peer_note=_peer_note(),
            matrix=matrix,
            compile_s=run.compile_s[_CHAIN],
            cut=run.cut,
            configuration_text=first.text,
            manifest=told,
        )
        write_bench_page(folder, material)
        write_table(folder / "bench.csv", pd.DataFrame(run.rows, columns=list(COLUMNS)))
        frequency = pd.DataFrame(run.frequency_rows, columns=list(FREQUENCY_COLUMNS))
        for name, table in (("turn", turns), ("dense", dense), ("frequency", frequency)):
            if len(table):
                write_table(folder / f"{name}.csv", table)
        write_json(
            folder / "manifest.json", told | {"configurations": {each.name: each.text for each in configurations}}
        )
        progress("done", 1.0)
    shown = [{key: _text(value) for key, value in row.items()} for row in run.targets]
    return BenchResult(folder=out, table=shown)


def _text(value: object) -> str:
    return ("no", "yes")[value] if isinstance(value, bool) else str(value)


def _peer_note() -> str:
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


def _diagram(run: Record, effort: Effort, configuration: Configuration) -> Diagram:
    """Every tow of one configuration's first part."""
    name, system = configuration.name, configuration.system_of(1)
    curves: list[Curve] = []
    converged: list[dict[str, Any]] = []
    compared: list[dict[str, Any]] = []
    for tow, ship in tows_compared.tows(effort.scale).items():
        run.tell(f"{name}: {tow}")
        chain = chain_bench.work_precision(system, tow, ship, effort)
        every = [(point.error, HOUR * point.timing.seconds) for point in chain.points]
        best = front(every, lambda point: point)
        curves.append(Curve(tow=tow, label=_CHAIN, every=every, best=best))
        converged.append(_converged(tow, _CHAIN, chain.uncertainty, math.nan))
        kind = f"against {chain_bench.FINER} times the most links and {chain_bench.TIGHTER:g} of the tolerance"
        for point in chain.points:
            setting = f"{tow}: {point.links} links, {point.tolerance:g} m/s"
            run.row(name, _CHAIN, setting, kind, point.error, point.timing)
        peer = _peer(run, effort, name, system, tow, ship)
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


def _growth(run: Record, effort: Effort, configuration: Configuration, system: TowedSystem) -> list[Sizes]:
    """Time against links and against the record; rows of bench.csv without an error."""
    if not run.has_time("growth", _GROWTH_TAKES * effort.scale):
        return []
    ship = tows_compared.tows()["circle"]
    speed, radius = tows_compared.SPEED, tows_compared.RADIUS
    by_links = chain_bench.growth_by_links(system, ship, effort)
    by_length = chain_bench.growth_by_length(system, speed, radius, effort)
    for growth in (by_links, by_length):
        for size, seconds, spread in zip(growth.sizes, growth.seconds, growth.spread, strict=True):
            duration = chain_bench.DURATION if growth is by_links else size
            timing = Timing(seconds / duration, spread, growth.repetitions)
            setting = f"fixed step of {chain_bench.STEP:g} s, {growth.what} {size:g}"
            run.row(configuration.name, _CHAIN, setting, "growth, no error", math.nan, timing)
    doubling = by_links.doubling
    run.target(
        "growth of the time over a doubling of the links",
        f"at most {_DOUBLING:g}",
        f"{doubling:.2f}",
        doubling <= _DOUBLING,
    )
    return [
        Sizes(
            what=growth.what,
            sizes=growth.sizes,
            seconds=growth.seconds,
            iterations=growth.iterations,
            exponent=growth.exponent,
        )
        for growth in (by_links, by_length)
    ]


def _dense(run: Record, effort: Effort, configuration: Configuration, system: TowedSystem) -> pd.DataFrame:
    if not run.has_time("the dense form", _DENSE_TAKES * effort.scale):
        return pd.DataFrame()
    rows = []
    for each in chain_bench.dense_form(system, tows_compared.tows()["circle"], effort):
        ratio = each.evaluation / each.step
        rows.append((each.links, each.evaluation, each.step, ratio, 2.0 * ratio))
        asked = _TIMES_DENSE.get(each.links)
        if asked is not None:
            what = (
                f"{configuration.name}: the dense form's time over the chain's, a second-order step, {each.links} links"
            )
            run.target(what, f"{asked:g}", f"{2.0 * ratio:.0f}", 2.0 * ratio >= asked)
    return pd.DataFrame(rows, columns=["links", "evaluation_s", "step_s", "ratio", "same_order"])


def _turns(run: Record, effort: Effort, configuration: Configuration) -> list[dict[str, Any]]:
    """The turn with one part, with two, and so on; none where the configuration has no speed to turn at."""
    name, speed, found = configuration.name, configuration.tow.speed, []
    for parts in range(1, 2 + len(configuration.tails) if speed > 0.0 else 1):
        what = f"{name}: the turn with {parts} part{'s' * (parts > 1)}"
        if not run.has_time(what, _TURN_TAKES * effort.scale):
            continue
        try:
            turns = chain_bench.turn(configuration.system_of(parts), speed, tows_compared.RADIUS, effort)
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
            for each in turns
        ]
        if parts == 1:
            best = turns[-1]
            shown = (best.timing.seconds, best.depth_error, best.track_error)
            run.target(
                f"{name}: the turn with one part, {best.links} links at {best.tolerance:g} m/s",
                f"{_TURN[0]:g} s, {100.0 * _TURN[1]:g} % of depth, {_TURN[2]:g} m",
                f"{shown[0]:.3f} s, {100.0 * shown[1]:.3f} %, {shown[2]:.2f} m",
                all(value <= limit for value, limit in zip(shown, _TURN, strict=True)),
            )
    return found
