"""The page of the benchmark: what a run costs at which error, how that grows, and how it compares."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from reports import leaving_out, matrix_bench, reduced_bench, sections, spectral_bench
from reports.figures import bench
from reports.figures.bench import Curve, Sizes
from reports.leaving_out import LeavingOutMaterial
from reports.markdown import Page
from reports.matrix_bench import MatrixMaterial
from reports.reduced_bench import ReducedMaterial
from reports.spectral_bench import SpectralMaterial
from reports.style import Album


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Diagram:
    """Work and precision of one configuration.

    Parameters
    ----------
    configuration
        Its name.
    curves
        The points of every method on every tow.
    converged
        Columns ``tow, method, uncertainty_m_s, apart_m_s``: the converged runs' own errors, and how far the methods'
        converged runs are apart.
    peers
        Columns ``tow, segments, scheme, step_s, error_m_s, seconds_per_hour, chain_seconds_per_hour, ratio``; empty
        where the peer is not installed.
    """

    configuration: str
    curves: Sequence[Curve]
    converged: pd.DataFrame
    peers: pd.DataFrame


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BenchMaterial:
    """Everything that the page of the benchmark shows; what is left empty is left out of the page.

    Parameters
    ----------
    diagrams
        One for each configuration.
    tows
        What the tows are, in a sentence.
    targets
        Columns ``target, asked, found, met``.
    sizes
        Time against links and against the length of the record.
    sized
        The configuration that `sizes` and `dense` are of.
    dense
        Columns ``links, evaluation_s, step_s, ratio, same_order``.
    turns
        Columns ``configuration, parts, links, tolerance_m_s, seconds, steps, depth_percent, track_m,
        uncertainty_m_s``.
    turn_words
        What the turn is, in a sentence.
    peer_note
        The peer's version and how its settings were found, or how to install it.
    matrix, reduced, left_out, spectral
        The parts on the matrix method, on the reduced models, on what scenes leave out, and on the spectral simulator;
        ``None`` where no configuration is theirs.
    judged
        Whether enough was run to be held against the figures to reach.
    cut
        (what, why) was left out.
    compile_s
        CPU time of compiling where no machine code is kept, by method [s]; empty where it was not measured.
    configuration_text, manifest
        As on the page of a run.
    """

    diagrams: Sequence[Diagram]
    tows: str
    targets: pd.DataFrame
    sizes: Sequence[Sizes]
    sized: str
    dense: pd.DataFrame
    turns: pd.DataFrame
    turn_words: str
    peer_note: str
    matrix: MatrixMaterial
    reduced: ReducedMaterial | None
    left_out: LeavingOutMaterial
    spectral: SpectralMaterial | None
    compile_s: Mapping[str, float]
    judged: bool = True
    cut: Sequence[tuple[str, str]] = ()
    configuration_text: str = ""
    manifest: Mapping[str, Any] = field(default_factory=dict)


_PEERS = {
    "tow": "tow",
    "segments": "segments",
    "scheme": "integrator",
    "step_s": "step, s",
    "error_m_s": "error, m/s",
    "seconds_per_hour": "MoorDyn, s an hour",
    "chain_seconds_per_hour": "chain at that error, s an hour",
    "ratio": "ratio",
}
_CONVERGED = {
    "tow": "tow",
    "method": "method",
    "uncertainty_m_s": "own error, m/s",
    "apart_m_s": "from the chain's, m/s",
}
_TURNS = {
    "configuration": "configuration",
    "parts": "parts",
    "links": "links",
    "tolerance_m_s": "tolerance, m/s",
    "seconds": "CPU time, s",
    "steps": "steps",
    "depth_percent": "depth error, %",
    "track_m": "track error, m",
    "uncertainty_m_s": "finer run's own error, m/s",
}
_DENSE = {
    "links": "links",
    "evaluation_s": "dense, one evaluation, s",
    "step_s": "chain, one step, s",
    "ratio": "ratio",
    "same_order": "ratio for a step of the same order",
}
_TARGETS = {"target": "target", "asked": "asked", "found": "found", "met": "met"}


def write_bench_page(folder: Path, material: BenchMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page("Benchmark: error against run time"), Album(folder)
    page.paragraph(
        "Times are CPU time of the one thread that computes, medians of interleaved repetitions; `bench.csv` has their "
        "spread. Errors are the RMS of the lower end's velocity against a converged run of the same code, whose own "
        "error is estimated and shown.",
        _compile_words(material.compile_s),
    )
    if not material.judged:
        page.paragraph("This is a quick run: too small to be held against the figures to reach.")
    if len(material.targets):
        page.table(material.targets, _TARGETS)
    page.heading("Work and precision of the link-joint chain")
    page.paragraph(material.tows, material.peer_note)
    for diagram in material.diagrams:
        _diagram(page, album, diagram)
    if len(material.turns):
        page.heading("The turn")
        page.paragraph(material.turn_words)
        page.table(material.turns, _TURNS, {"depth_percent": ".3f", "track_m": ".2f"}, exactly=["tolerance_m_s"])
    if material.sizes:
        page.heading("Growth")
        page.paragraph(f"The first part of {material.sized}, at a fixed step.")
        iterations = [
            f"Newton iterations a step against {panel.what}: {', '.join(f'{each:.1f}' for each in panel.iterations)}."
            for panel in material.sizes
        ]
        page.figure(
            album.draw("growth", bench.growth, material.sizes),
            "CPU time of a run at a fixed step. The power is fitted to the larger half of the sizes, where the fixed "
            "cost of a run is past. " + " ".join(iterations),
        )
    if len(material.dense):
        page.heading("Against the dense form")
        page.paragraph(
            "One evaluation of the accelerations by full matrices and a pseudo-inverse, as the paper prints it, beside "
            "a whole step of the chain: two implicit stages, output and account of energy included. A step of second "
            "order, as the chain's is, takes the dense form two evaluations; the last column counts both.",
        )
        page.table(material.dense, _DENSE)
    matrix_bench.write(page, album, material.matrix)
    if material.spectral is not None:
        spectral_bench.write(page, album, material.spectral)
    if material.reduced is not None:
        reduced_bench.write(page, album, material.reduced)
    leaving_out.write(page, material.left_out)
    if material.cut:
        page.heading("Left out")
        page.bullets(f"{what}: {why}" for what, why in material.cut)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


def _compile_words(seconds: Mapping[str, float]) -> str:
    """What compiling takes, once an installation."""
    if not seconds:
        return "What compiling takes is not in the times; `bench.csv` has what was left of it before the first run."
    said = [f"{method} {each:.1f}" for method, each in seconds.items()]
    return f"Compiling is not in the times; once an installation it takes, in s of CPU time: {', '.join(said)}."


def _diagram(page: Page, album: Album, diagram: Diagram) -> None:
    """One configuration: the figure, the converged runs, the peer's settings."""
    page.heading(diagram.configuration, 3)
    link = album.draw(f"work-precision-{diagram.configuration}", bench.work_precision, diagram.curves)
    page.figure(
        link,
        "Error against CPU time. Every small point is a setting, of links and tolerance; the line joins those that no "
        "other setting beats in both.",
    )
    page.table(diagram.converged, _CONVERGED)
    if len(diagram.peers):
        page.table(diagram.peers, _PEERS, {"segments": ".0f"})
