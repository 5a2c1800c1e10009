"""What the benchmark records of the matrix method: rows, targets and the material of the page."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

import pandas as pd

from data_synth.spectra import sea_state
from ident.benchmark import transfer_bench, transfer_costs
from ident.benchmark.bench_record import Record
from ident.benchmark.chain_bench import Growth
from ident.benchmark.transfer_bench import AMPLITUDE, FREQUENCIES, HIGH, LOW, SEGMENTS, TOLERANCE, Effort
from ident.benchmark.transfer_costs import Cost
from ident.chain_record import ChainSetting
from ident.configuration import Configuration, load
from ident.sea_checks import SeaCheck, check_sea
from ident.timing import Timing, front
from models.quantity import InvalidInput, NumericalFailure
from reports.figures.bench import Curve, Sizes
from reports.markdown import significant
from reports.matrix_bench import MatrixMaterial

METHOD = "matrix"
#: The configuration of the paper's run, and the one in a random sea, measured beside those of the whole benchmark.
PAPER, SEA = "s-shape-205", "swath-4000"
#: Figures to reach: CPU time of the paper's run [s], growth over a doubling, the simulation's time over the method's.
_SECONDS, _DOUBLING, _TIMES = 0.06, 2.2, 100.0
#: What is expected to take so long [s]: the paper's run and its parts, one configuration, the sea.
_PAPER_TAKES, _ONE_TAKES, _SEA_TAKES = 8.0, 4.0, 8.0
#: An error of a mesh that is small enough, over the largest amplitude.
_ENOUGH = 1e-2
#: Sea state of the simulation and what is dropped before its record [s]; the chain's links, and the tolerance of its
#: steps over the RMS speed of its top, of a coarser run and a finer.
_STATE, _RUN_IN, _LINKS, _SHARES = 6, 600.0, (12, 24), (0.04, 0.005)
#: Kernels of the sweep by what they do.
_KERNELS = {"A(s)": ("_slopes",), "the steps": ("_segment", "_inverse"), "two states through them": ("_advance",)}


def measure(run: Record, effort: Effort, configurations: Sequence[Configuration]) -> MatrixMaterial:
    """Measure the paper's run, then error against time and the solvers on it and on the other configurations."""
    paper = load(PAPER)
    run.compiled(METHOD, transfer_costs.first_call(paper.tow))
    share = effort.frequencies / FREQUENCIES
    parts: dict[str, Any] = {}
    if run.has_time("the paper's run of the matrix method", _PAPER_TAKES * share):
        parts = _costs(run, effort, paper) | _settings(run, effort, paper)
    names = {PAPER, *(each.name for each in configurations)}
    curves: list[Curve] = []
    converged: list[dict[str, Any]] = []
    solved: list[dict[str, Any]] = []
    for each in (paper, *(load(name) for name in (SEA,) if name not in names), *configurations):
        what = f"{each.name} by the matrix method"
        if not run.has_time(what, _ONE_TAKES * share):
            continue
        try:
            _one(run, effort, each, curves, converged, solved)
        except (InvalidInput, NumericalFailure) as error:
            run.cut.append((what, str(error)))
    return MatrixMaterial(
        words=f"{effort.frequencies} frequencies from {LOW:g} to {HIGH:g} rad/s, {AMPLITUDE:g} m of motion along the "
        "cable's top, every frequency with its own drag. Nothing is simulated for an hour here, so that the rows of "
        "`bench.csv` have no seconds an hour; `frequency.csv` has the seconds of a run. The errors in m/s are the RMS "
        "of the body's velocity over time and over the frequencies.",
        curves=curves,
        converged=pd.DataFrame(converged),
        solvers=pd.DataFrame(solved),
        **parts,
    )


def simulated(run: Record, effort: Effort, material: MatrixMaterial) -> MatrixMaterial:
    """The material with the sea that the chain simulates; as it is where there is no time for that."""
    what = f"{SEA}: the sea that the matrix method replaces"
    if not run.has_time(what, _SEA_TAKES * effort.record / transfer_bench.FULL.record):
        return material
    tow, spectrum = load(SEA).tow, sea_state(_STATE).spectrum()

    def check(links: int, share: float) -> SeaCheck:
        setting = ChainSetting(links=links, share=share, error={})
        return check_sea(tow, spectrum, duration=effort.record, run_in=_RUN_IN, setting=setting)

    coarse, fine = (check(*setting) for setting in zip(_LINKS, _SHARES, strict=True))
    rows = fine.table.set_index("quantity")
    rows = rows[rows["difference_percent"].notna()]
    change = coarse.table.set_index("quantity")["rms"] / rows["rms"] - 1.0
    table = fine.costs.assign(configuration=SEA)
    # Links and steps converge at second order: a third of the difference is left.
    table.loc[table["method"] == "chain", "error_percent"] = 100.0 * float(change.abs().max()) / 3.0
    lines = table.to_dict("records")
    for line in lines:
        run.call(SEA, f"sea state {_STATE}: {line['method']}", Timing(float(line["cpu_s"]), 0.0, 1), line["settings"])
    best, own = max(lines, key=lambda line: float(line["ratio"])), float(lines[0]["error_percent"])
    run.target(
        f"{SEA}: the chain's CPU time over the matrix method's, {effort.record:g} s of sea state {_STATE}",
        f"{_TIMES:g}",
        f"{best['ratio']:.0f}, mesh and frequencies err by {best['error_percent']:.2g} %, the chain by {own:.2g} %",
        bool(best["ratio"] >= _TIMES and best["error_percent"] <= own),
    )
    apart = [f"{str(name).replace('_', ' ')} {each:+.1f}" for name, each in rows["difference_percent"].items()]
    return replace(
        material,
        simulated=table,
        simulated_words=f"{effort.record:g} s of sea state {_STATE}, moved in heave at the cable's top, by the "
        "nonlinear chain and by equivalent linearisation. RMS of the chain over the sigma of the matrix method, less "
        f"1, in percent: {', '.join(apart)}. The RMS of a record so long is itself known within "
        f"{significant(float(rows['sampling_percent'].max()), 2)} %; half of that takes four times the record.",
    )


def _costs(run: Record, effort: Effort, paper: Configuration) -> dict[str, Any]:
    """The paper's run by part, and its operations."""
    parts = transfer_costs.parts(paper.tow, effort)
    for part in parts:
        run.call(
            PAPER, "paper's run", part.timing, part.part, effort.frequencies, SEGMENTS, part.tolerance, part.solves
        )
    taken = {part.part: part.timing.seconds for part in parts}
    whole, given, solves = (taken[each] for each in (transfer_costs.WHOLE, transfer_costs.GIVEN, transfer_costs.SOLVES))
    run.target(
        f"{PAPER}: {effort.frequencies} frequencies at {SEGMENTS + 1} nodes to {TOLERANCE:g}",
        f"{1e3 * _SECONDS:g} ms",
        f"{1e3 * given:.0f} ms, of it {1e3 * solves:.1f} ms to solve; {1e3 * whole:.0f} ms with finding the mesh",
        given <= _SECONDS,
    )
    costs, tally = transfer_costs.costs(paper.tow, effort)
    total = Cost(
        part="one iteration",
        **{name: sum(getattr(each, name) for each in costs) for name in asdict(costs[0]) if name != "part"},
    )
    rounds = next(part.solves for part in parts if part.part == transfer_costs.SOLVES) / effort.frequencies
    times = transfer_costs.PRINTED_SECONDS / FREQUENCIES / (solves / effort.frequencies)
    fewer = transfer_costs.PRINTED_ITERATIONS / rounds
    lighter = transfer_costs.PRINTED_OPERATIONS / total.counted
    return {
        "parts": pd.DataFrame(
            [(each.part, each.timing.seconds, each.timing.spread) for each in parts],
            columns=["part", "seconds", "spread"],
        ),
        "paper_words": (
            f"{transfer_costs.PRINTED_SECONDS:g} s for {FREQUENCIES} frequencies on an HP 705, with about "
            f"{transfer_costs.PRINTED_ITERATIONS} iterations each, against {solves:.2g} s for {effort.frequencies} "
            f"here: {significant(fewer, 2)} times fewer iterations, as each frequency starts from the drag of the one "
            f"before, {significant(lighter, 2)} times fewer operations in each, and {times / fewer / lighter:.0f} "
            "times in the machine and its language."
        ),
        "costs": pd.DataFrame([asdict(each) for each in (*costs, total)]),
        "cost_words": _cost_words(tally),
    }


def _cost_words(tally: Counter[str]) -> str:
    """How operations were counted, and where most of them are."""
    shares = {what: sum(tally[f"solve.{name}"] for name in names) / (SEGMENTS + 1) for what, names in _KERNELS.items()}
    told = ", ".join(f"{share:.0f} for {what}" for what, share in shares.items())
    rest = (tally["solve.sweep"] + tally["solve._weighed"]) / (SEGMENTS + 1)
    return (
        "H Table VI beside the kernels' own source, run on numbers that count: a real addition, multiplication, "
        "division, root or elementary function is one operation, a complex sum 2, a complex product 6, a complex "
        f"quotient 11, a complex times a real 2. Of the first row {told} and {rest:.0f} for keeping both states apart "
        "and going back down, a node. Times are fitted as a + c n to runs of few to many segments, with the drag "
        "brought up to date and without."
    )


def _settings(run: Record, effort: Effort, paper: Configuration) -> dict[str, Any]:
    """What the tolerance leaves, and growth."""
    settings = transfer_bench.tolerances(paper.tow, effort)
    for each in settings:
        run.call(
            PAPER, "tolerance", each.timing, "solves", effort.frequencies, each.segments, each.tolerance, each.solves,
            each.share,
        )  # fmt: skip
    rows = [
        (each.tolerance, each.solves / effort.frequencies, each.share, each.velocity_error, each.timing.seconds)
        for each in settings
    ]
    growths = transfer_bench.growth(paper.tow, effort)
    for growth in growths:
        _grown(run, effort, growth)
    return {
        "tolerances": pd.DataFrame(rows, columns=["tolerance", "solves", "share", "velocity_error_m_s", "seconds"]),
        "sizes": [
            Sizes(
                what=growth.what,
                sizes=growth.sizes,
                seconds=growth.seconds,
                iterations=growth.iterations,
                exponent=growth.exponent,
            )
            for growth in growths
        ],
    }


def _grown(run: Record, effort: Effort, growth: Growth) -> None:
    for size, seconds, spread in zip(growth.sizes, growth.seconds, growth.spread, strict=True):
        by_segments = growth.what == "segments"
        count, segments = (effort.frequencies, int(size)) if by_segments else (int(size), SEGMENTS)
        timing = Timing(seconds, spread, growth.repetitions)
        run.call(PAPER, f"growth with {growth.what}", timing, "solves", count, segments, TOLERANCE)
        setting = f"{count} frequencies, {segments} segments, {TOLERANCE:g}"
        run.untimed(PAPER, METHOD, setting, "growth, no error", math.nan, timing)
    run.target(
        f"matrix method: growth of the time over a doubling of the {growth.what}",
        f"at most {_DOUBLING:g}",
        f"{growth.doubling:.2f}",
        growth.doubling <= _DOUBLING,
    )


def _one(
    run: Record,
    effort: Effort,
    configuration: Configuration,
    curves: list[Curve],
    converged: list[dict[str, Any]],
    solved: list[dict[str, Any]],
) -> None:
    """Error against time, and the solvers, of one configuration."""
    name = configuration.name
    found = transfer_bench.precision(configuration.tow, effort)
    kind = f"body's velocity, 1 m of motion, against {transfer_bench.FINER} times the most segments"
    for point in found.points:
        run.call(
            name, "mesh", point.timing, "solves", effort.frequencies, point.segments, point.tolerance, point.solves,
            point.share,
        )  # fmt: skip
        setting = f"{effort.frequencies} frequencies, {point.segments} segments, {point.tolerance:g}"
        run.untimed(name, METHOD, setting, kind, point.velocity_error, point.timing)
    for panel, more in (("solves alone", 0.0), ("with mesh and steady shape", found.start.seconds)):
        points = [(point.velocity_error, more + point.timing.seconds) for point in found.points]
        curves.append(Curve(tow=panel, label=name, every=points, best=front(points, lambda point: point)))
    converged.append(
        {
            "configuration": name,
            "start_s": found.start.seconds,
            "uncertainty_m_s": found.uncertainty,
            "uncertainty_share": found.share,
            "enough": min((point.segments for point in found.points if point.share <= _ENOUGH), default=math.nan),
        }
    )
    for each in transfer_bench.solvers(configuration.tow, effort):
        run.call(name, "one solve of all", each.timing, each.solver, effort.frequencies, SEGMENTS, share=each.apart)
        solved.append(
            {
                "configuration": name,
                "solver": each.solver,
                "seconds": each.timing.seconds,
                "apart": each.apart,
                "digits": each.digits,
            }
        )
