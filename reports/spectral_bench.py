"""The part of the benchmark's page on the spectral simulator: its steppers, library integrators, and its growth."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import pandas as pd

from reports.figures import bench
from reports.figures.bench import Curve, Sizes
from reports.markdown import Page
from reports.style import Album


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpectralMaterial:
    """What the part shows; what is left empty is left out.

    Parameters
    ----------
    words, library_words, kept_words
        What is run, in sentences: by the steppers, by the library, by the defaults.
    curves
        Error against time of every stepper, ``tow`` being the configuration.
    converged
        Columns ``configuration, harmonics, steps, uncertainty_m_s``.
    stations
        Columns ``configuration, harmonics, stations, error_m_s, seconds_per_hour``.
    equal
        Error of the steps alone against time, of the steppers and of the library's integrators.
    libraries
        Columns ``configuration, method, jacobian, error_m_s, seconds_per_hour, ratio``.
    kept
        Columns ``configuration, simulator, unit, asked, estimated, found, met``.
    sizes
        Time against harmonics, stations and the length of the record.
    sized
        The configuration that `sizes` are of.
    """

    words: str
    library_words: str = ""
    kept_words: str = ""
    curves: Sequence[Curve] = ()
    converged: pd.DataFrame = field(default_factory=pd.DataFrame)
    stations: pd.DataFrame = field(default_factory=pd.DataFrame)
    equal: Sequence[Curve] = ()
    libraries: pd.DataFrame = field(default_factory=pd.DataFrame)
    kept: pd.DataFrame = field(default_factory=pd.DataFrame)
    sizes: Sequence[Sizes] = ()
    sized: str = ""


_CONVERGED = {
    "configuration": "configuration",
    "harmonics": "harmonics",
    "steps": "steps",
    "uncertainty_m_s": "own error, m/s",
}
_STATIONS = {
    "configuration": "configuration",
    "harmonics": "harmonics",
    "stations": "stations",
    "error_m_s": "error, m/s",
    "seconds_per_hour": "CPU time, s an hour",
}
_LIBRARIES = {
    "configuration": "configuration",
    "method": "method",
    "jacobian": "Jacobian",
    "error_m_s": "error, m/s",
    "seconds_per_hour": "CPU time, s an hour",
    "ratio": "time over the stepper's",
}
_KEPT = {
    "configuration": "configuration",
    "simulator": "simulator",
    "unit": "in",
    "asked": "asked",
    "estimated": "own estimate",
    "found": "error",
    "met": "met",
}


def write(page: Page, album: Album, material: SpectralMaterial) -> None:
    """Add the part to a page."""
    page.heading("Spectral simulator")
    page.paragraph(material.words)
    if material.curves:
        page.figure(
            album.draw("spectral-precision", bench.work_precision, material.curves),
            "Error against CPU time. Every small point is a setting; the line joins those that no other setting of the "
            "same stepper beats in both. Where points stand one above the other the series is the error, not the step.",
        )
        page.table(material.converged, _CONVERGED)
    if len(material.stations):
        page.heading("Stations", 3)
        page.paragraph("From the fewest that the harmonics do not alias with; the tightest tolerance of the diagram.")
        page.table(material.stations, _STATIONS)
    if material.equal:
        page.heading("Library integrators on the same equations", 3)
        page.paragraph(material.library_words)
        page.figure(
            album.draw("spectral-libraries", bench.work_precision, material.equal),
            "Error of the steps alone against CPU time; every tolerance that was tried is a point.",
        )
        page.table(material.libraries, _LIBRARIES, {"ratio": ".1f"})
    if len(material.kept):
        page.heading("What the defaults keep", 3)
        page.paragraph(material.kept_words)
        page.table(material.kept, _KEPT, exactly=["asked"])
    if material.sizes:
        page.heading("Growth of the spectral simulator", 3)
        page.paragraph(f"{material.sized}, Newmark's method at a fixed step.")
        evaluations = [
            f"Evaluations a step against {panel.what}: {', '.join(f'{each:.1f}' for each in panel.iterations)}."
            for panel in material.sizes
        ]
        page.figure(
            album.draw("spectral-growth", bench.growth, material.sizes),
            "CPU time of a run. The power is fitted to the larger half of the sizes. " + " ".join(evaluations),
        )
