"""The part of the benchmark's page on the matrix method, which is timed by the run, not by the hour."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import pandas as pd

from reports.figures import bench
from reports.figures.bench import Curve, Sizes
from reports.markdown import Page
from reports.style import Album


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MatrixMaterial:
    """What the part shows; what is left empty is left out.

    Parameters
    ----------
    words
        What is run, in a sentence.
    paper_words
        The paper's run beside ours, in a sentence.
    parts
        Columns ``part, seconds, spread`` of that run.
    costs
        Columns ``part, printed, printed_per_node, counted, counted_per_node, nanoseconds_per_node, nanoseconds``.
    cost_words
        How operations were counted, and where most of them are.
    tolerances
        Columns ``tolerance, solves, share, velocity_error_m_s, seconds``.
    curves
        Error against time, ``tow`` being the configuration.
    converged
        Columns ``configuration, start_s, uncertainty_m_s, uncertainty_share, enough``: time of mesh and steady shape,
        the converged run's own errors, and the fewest segments that err by less than 1 % of every amplitude.
    sizes
        Time against segments and against frequencies.
    solvers
        Columns ``configuration, solver, seconds, apart, digits``.
    simulated
        Columns ``configuration, method, settings, error_percent, difference_percent, cpu_s, ratio``.
    simulated_words
        Which sea that is, in a sentence.
    """

    words: str
    paper_words: str = ""
    parts: pd.DataFrame = field(default_factory=pd.DataFrame)
    costs: pd.DataFrame = field(default_factory=pd.DataFrame)
    cost_words: str = ""
    tolerances: pd.DataFrame = field(default_factory=pd.DataFrame)
    curves: Sequence[Curve] = ()
    converged: pd.DataFrame = field(default_factory=pd.DataFrame)
    sizes: Sequence[Sizes] = ()
    solvers: pd.DataFrame = field(default_factory=pd.DataFrame)
    simulated: pd.DataFrame = field(default_factory=pd.DataFrame)
    simulated_words: str = ""


_PARTS = {"part": "part", "milliseconds": "CPU time, ms", "spread": "spread"}
_COSTS = {
    "part": "part",
    "printed": "H, operations",
    "printed_per_node": "H, a node",
    "counted": "here, operations",
    "counted_per_node": "here, a node",
    "nanoseconds_per_node": "a node, ns",
    "nanoseconds": "time, ns",
}
_TOLERANCES = {
    "tolerance": "tolerance",
    "solves": "solves a frequency",
    "percent": "error, % of the largest amplitude",
    "velocity_error_m_s": "RMS velocity error, m/s",
    "milliseconds": "solves, ms",
}
_CONVERGED = {
    "configuration": "configuration",
    "start_ms": "mesh and steady shape, ms",
    "uncertainty_m_s": "converged run's own error, m/s",
    "uncertainty_percent": "the same, % of the largest amplitude",
    "enough": "fewest segments within 1 %",
}
_SOLVERS = {
    "configuration": "configuration",
    "solver": "solver",
    "milliseconds": "one solve of all, ms",
    "apart": "from the band matrix",
    "digits": "fewest digits kept",
}
_SIMULATED = {
    "configuration": "configuration",
    "method": "method",
    "settings": "settings",
    "error_percent": "own error, %",
    "difference_percent": "from the chain, %",
    "cpu_s": "CPU time, s",
    "ratio": "chain's time over it",
}


def write(page: Page, album: Album, material: MatrixMaterial) -> None:
    """Add the part to a page."""
    page.heading("Matrix method")
    page.paragraph(material.words)
    if len(material.parts):
        page.heading("The run of the paper", 3)
        page.paragraph(material.paper_words)
        page.table(_milliseconds(material.parts), _PARTS, {"spread": ".2f"})
    if len(material.costs):
        page.heading("Operations of one iteration at one frequency", 3)
        page.paragraph(material.cost_words)
        whole = {"printed": ".0f", "printed_per_node": ".0f", "counted": ".0f", "counted_per_node": ".0f"}
        page.table(material.costs, _COSTS, whole | {"nanoseconds_per_node": ".0f", "nanoseconds": ".0f"})
    if len(material.tolerances):
        page.heading("What the tolerance leaves", 3)
        page.paragraph(
            "H's norm is the mean square change of the deflection in one iteration over that of the top; errors are "
            "against the same mesh with a drag that stands, those in percent of a motion of the body or of an end "
            "tension over its largest amplitude."
        )
        shown = _milliseconds(material.tolerances).assign(percent=100.0 * material.tolerances["share"])
        page.table(shown, _TOLERANCES, exactly=["tolerance"])
    if material.curves:
        page.heading("Error of the mesh against run time", 3)
        page.figure(
            album.draw("matrix-precision", bench.work_precision, material.curves, "CPU time of a run, s"),
            "RMS of the error of the body's velocity over time and over the frequencies, against a run with many times "
            "the segments, over the CPU time of the run: the solves alone, and with mesh and steady shape.",
        )
        converged = material.converged
        shown = converged.assign(
            start_ms=1e3 * converged["start_s"], uncertainty_percent=100.0 * converged["uncertainty_share"]
        )
        page.table(shown, _CONVERGED, {"enough": ".0f"})
    if material.sizes:
        page.heading("Growth of the matrix method", 3)
        solves = [
            f"Solves a frequency against {panel.what}: {', '.join(f'{each:.1f}' for each in panel.iterations)}."
            for panel in material.sizes
        ]
        page.figure(
            album.draw("matrix-growth", bench.growth, material.sizes),
            "CPU time of the solves. The power is fitted to the larger half of the sizes. " + " ".join(solves),
        )
    if len(material.solvers):
        page.heading("Three solvers of the same equations", 3)
        page.paragraph(
            "All frequencies once, with the same drag. The band matrix is written down apart from the kernels and "
            "solved by LAPACK with row exchanges, its assembly in numpy included; the difference is that of the states "
            "over the largest. The product of matrices tells its digits by the terms that cancel in it.",
        )
        page.table(_milliseconds(material.solvers), _SOLVERS, {"digits": ".1f"})
    if len(material.simulated):
        page.heading("Against the simulation that it replaces", 3)
        page.paragraph(material.simulated_words)
        page.table(material.simulated, _SIMULATED)


def _milliseconds(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(milliseconds=1e3 * table["seconds"])
