"""The benchmark: error against run time of the three simulators and of the reduced models, and how it grows."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from ident import tows_compared
from ident.benchmark import (
    chain_bench,
    compiling,
    leaving_out,
    link_joint_record,
    matrix_record,
    peers,
    reduced_bench,
    reduced_record,
    spectral_bench,
    spectral_record,
    transfer_bench,
)
from ident.benchmark.bench_record import FREQUENCY_COLUMNS, Record
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.places import new_folder
from ident.terminal import Progress
from models.quantity import InvalidInput
from models.tow import refuse_sections_and_thrust
from reports.bench_page import BenchMaterial, write_bench_page
from reports.files import write_json, write_table

#: Wall time of the whole benchmark [s]; what would go past it is left out and listed.
BUDGET = 280.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is run of every part; `anew`: compiling is timed where no machine code is kept."""

    chain: chain_bench.Effort = chain_bench.FULL
    matrix: transfer_bench.Effort = transfer_bench.FULL
    spectral: spectral_bench.Effort = spectral_bench.FULL
    reduced: reduced_bench.Effort = reduced_bench.FULL
    leaving: leaving_out.Effort = leaving_out.FULL
    anew: bool = True


FULL = Effort()
#: Enough to see that everything still runs.
REDUCED = Effort(
    chain=chain_bench.REDUCED,
    matrix=transfer_bench.REDUCED,
    spectral=spectral_bench.REDUCED,
    reduced=reduced_bench.REDUCED,
    leaving=leaving_out.REDUCED,
    anew=False,
)


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
    quick: bool = False,
    effort: Effort | None = None,
) -> BenchResult:
    """Measure and write the page, its figures and the tables.

    Parameters
    ----------
    configurations
        The first of them also gives the cable for growth and for the dense form.
    budget
        Wall time [s]; what would go past it is left out and listed.
    quick
        Run a small part of everything, and judge nothing.
    effort
        How much is run, where it shall be given.

    Raises
    ------
    InvalidInput
        The place cannot be written, or a cable has sections.
    """
    names = [each.name for each in configurations]
    if len(set(names)) < len(names):
        raise InvalidInput(f"Each configuration once: {', '.join(names)} were given.")
    for each in configurations:
        refuse_sections_and_thrust(each.tow, "The benchmark")
    if effort is None:
        effort = REDUCED if quick else FULL
    run = Record(progress=progress, budget=budget, judged=effort != REDUCED)
    first = configurations[0]
    with new_folder(out) as folder:
        progress("compiling", 0.0)
        system = first.system_of(1)
        run.compiled(link_joint_record.METHOD, chain_bench.first_call(system))
        sizes = link_joint_record.growth(run, effort.chain, first, system)
        dense = link_joint_record.dense(run, effort.chain, first, system)
        matrix = matrix_record.measure(run, effort.matrix, configurations)
        planar = _planar(run, configurations)
        reduced = reduced_record.measure(run, effort.reduced, planar) if planar else None
        spectral = spectral_record.measure(run, effort.spectral, planar) if planar else None
        turns = [row for each in configurations for row in link_joint_record.turns(run, effort.chain, each)]
        chains = link_joint_record.measure(run, effort.chain, configurations)
        left_out = leaving_out.record(run, effort.leaving)
        matrix = matrix_record.simulated(run, effort.matrix, matrix)
        compile_s = _compile(run, effort)
        diagrams = [link_joint_record.beside_peer(run, effort.chain, each) for each in chains]
        told = manifest("bench", first, None, configurations=names, moordyn=peers.version() or "not installed")
        progress("drawing the page", 0.99)
        material = BenchMaterial(
            diagrams=diagrams,
            tows=tows_compared.WORDS,
            targets=pd.DataFrame(run.targets),
            judged=run.judged,
            sizes=sizes,
            sized=first.name,
            dense=dense,
            turns=pd.DataFrame(turns),
            turn_words=f"Circles of {tows_compared.RADIUS:g} m from the steady tow, at its speed, for "
            f"{effort.chain.turn_duration:g} s, against a run with {chain_bench.FINER} times the links: the largest "
            "error of any body at any time.",
            peer_note=link_joint_record.peer_note(),
            matrix=matrix,
            reduced=reduced,
            spectral=spectral,
            left_out=left_out,
            compile_s=compile_s,
            cut=run.cut,
            configuration_text=first.text,
            manifest=told,
        )
        write_bench_page(folder, material)
        write_table(folder / "bench.csv", run.table())
        frequency = pd.DataFrame(run.frequency_rows, columns=list(FREQUENCY_COLUMNS))
        tables = {"turn": pd.DataFrame(turns), "dense": dense, "frequency": frequency, "leaving-out": left_out.table}
        if reduced is not None:
            tables |= {"libraries": reduced.libraries, "searches": reduced.searches}
        for name, table in tables.items():
            if len(table):
                write_table(folder / f"{name}.csv", table)
        write_json(
            folder / "manifest.json", told | {"configurations": {each.name: each.text for each in configurations}}
        )
        progress("done", 1.0)
    shown = [{key: _text(value) for key, value in row.items()} for row in run.targets]
    return BenchResult(folder=out, table=shown)


def _planar(run: Record, configurations: Sequence[Configuration]) -> list[Configuration]:
    """Those that the spectral simulator and the reduced models can do; the others are listed."""
    for each in configurations:
        if each.tails:
            what = f"{each.name} by the spectral simulator and the reduced models"
            run.cut.append((what, "they know nothing of parts behind the vehicle"))
    return [each for each in configurations if not each.tails]


def _text(value: object) -> str:
    return ("no", "yes")[value] if isinstance(value, bool) else str(value)


def _compile(run: Record, effort: Effort) -> dict[str, float]:
    """What every method takes to compile where no machine code is kept; nothing where there is no time to see."""
    if not effort.anew or not run.has_time("compiling anew", compiling.TAKES):
        return {}
    found = compiling.compiled_anew()
    for method, seconds in found.items():
        run.compiled(method, seconds)
    for name in {row[1] for row in run.rows} & set(reduced_bench.names(effort.reduced.links)):
        run.compiled(name, found[compiling.REDUCED])
    return found
