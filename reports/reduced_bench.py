"""The part of the benchmark's page on the reduced models: error against run time, libraries, growth, identification."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import pandas as pd

from reports.figures import reduced_bench as figures
from reports.figures.bench import Curve
from reports.figures.reduced_bench import Found, Grown
from reports.markdown import Page
from reports.style import Album


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReducedMaterial:
    """What the part shows; what is left empty is left out.

    Parameters
    ----------
    words
        What is run, in a sentence.
    curves
        Error against run time of the quadratic models, ``tow`` being the configuration.
    precision
        Columns ``model, step_s, error_m_s, uncertainty_m_s, order, milliseconds, spread``: every model at its usual
        step, the worst error and the median time of the configurations.
    libraries
        Columns ``configuration, model, model_error_m_s, method, derivatives, tolerance, error_m_s, milliseconds,
        model_milliseconds, ratio, note``.
    library_words
        How the libraries' tolerances were found, in sentences.
    ratios
        Columns ``configuration, model, step_s, error_m_s, ratio``: the fastest library's time over the model's, at
        the error of every step.
    library_curves
        Error against run time of models and integrators, ``tow`` being the model.
    library_tow
        The configuration that `library_curves` are of.
    grown
        Time against links and against the length of the record.
    grown_tow
        The configuration that they are of.
    found
        Best error against simulations, of every search.
    searches
        Columns ``configuration, model, start, search, start_m_s, found_m_s, simulations, restarts, seconds, ended``.
    search_words
        What is searched, in sentences.
    """

    words: str
    curves: Sequence[Curve] = ()
    precision: pd.DataFrame = field(default_factory=pd.DataFrame)
    libraries: pd.DataFrame = field(default_factory=pd.DataFrame)
    library_words: str = ""
    ratios: pd.DataFrame = field(default_factory=pd.DataFrame)
    library_curves: Sequence[Curve] = ()
    library_tow: str = ""
    grown: Sequence[Grown] = ()
    grown_tow: str = ""
    found: Sequence[Found] = ()
    searches: pd.DataFrame = field(default_factory=pd.DataFrame)
    search_words: str = ""


_PRECISION = {
    "model": "model",
    "step_s": "usual step, s",
    "error_m_s": "worst error, m/s",
    "uncertainty_m_s": "converged run's own, m/s",
    "order": "observed order",
    "milliseconds": "median CPU time of an hour, ms",
    "spread": "spread",
}
_LIBRARIES = {
    "configuration": "configuration",
    "model": "model",
    "model_error_m_s": "model's error, m/s",
    "model_milliseconds": "its time, ms",
    "method": "integrator",
    "derivatives": "derivatives",
    "tolerance": "tolerance",
    "error_m_s": "error, m/s",
    "milliseconds": "time, ms",
    "ratio": "ratio",
    "note": "note",
}
_RATIOS = {
    "configuration": "configuration",
    "model": "model",
    "step_s": "step, s",
    "error_m_s": "error, m/s",
    "ratio": "fastest library's time over the model's",
}
_SEARCHES = {
    "configuration": "configuration",
    "model": "model",
    "start": "start",
    "search": "search",
    "start_m_s": "error at the start, m/s",
    "found_m_s": "best error, m/s",
    "simulations": "simulations",
    "restarts": "restarts",
    "seconds": "CPU time, s",
    "ended": "came to its end",
}


def write(page: Page, album: Album, material: ReducedMaterial) -> None:
    """Add the part to a page."""
    page.heading("Reduced models")
    page.paragraph(material.words)
    if material.curves:
        page.figure(
            album.draw("reduced-precision", figures.precision, material.curves),
            "Error against CPU time of the quadratic models over their steps; the large point is the usual step. The "
            "linear models are exact for the ship's spline and stand in the table alone; `bench.csv` has every point.",
        )
    if len(material.precision):
        whole = {"milliseconds": ".2f", "spread": ".2f", "order": ".2f"}
        page.table(material.precision, _PRECISION, whole, exactly=["step_s"])
    if len(material.libraries):
        page.heading("Against the integrators of a library", 3)
        page.paragraph(material.library_words)
        if material.library_curves:
            page.figure(
                album.draw("reduced-libraries", figures.libraries, material.library_curves),
                f"{material.library_tow}: error against CPU time of the models and of SciPy's integrators on the same "
                "equations. Every point is a run; the line joins those that no other run of its method beats in both.",
            )
        whole = {"milliseconds": ".1f", "model_milliseconds": ".2f", "ratio": ".0f"}
        page.table(material.libraries, _LIBRARIES, whole)
    if len(material.ratios):
        page.paragraph("At the error of every step, the libraries' time between their runs by interpolation:")
        page.table(material.ratios, _RATIOS, {"ratio": ".0f"}, exactly=["step_s"])
    if material.grown:
        page.heading("Growth of the reduced models", 3)
        page.figure(
            album.draw("reduced-growth", figures.growth, material.grown),
            f"{material.grown_tow}: CPU time of a run, at the usual step. The power is fitted to the larger half of "
            "the sizes.",
        )
    if len(material.searches):
        page.heading("What an identification costs", 3)
        page.paragraph(material.search_words)
        if material.found:
            page.figure(
                album.draw("reduced-identification", figures.identification, material.found),
                "The lowest RMS velocity error so far against simulations. A ring marks where a fresh simplex begins: "
                "up to the first one it is the search without restart.",
            )
        form = {"start_m_s": ".5f", "found_m_s": ".6f", "seconds": ".2f"}
        page.table(material.searches, _SEARCHES, form)
