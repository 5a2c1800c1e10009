"""The page of one run: from the configuration to how far the identified models can be trusted."""

from pathlib import Path

from reports import findings, leaving_out, sections
from reports.figures import frequency, identifiability, records, residuals, scores, shapes
from reports.markdown import Page, significant
from reports.run_material import RunMaterial
from reports.series import RecordSeries
from reports.style import Album

__all__ = ["RunMaterial", "write_run_page"]


def write_run_page(folder: Path, material: RunMaterial) -> None:
    """Write ``report.md`` and its ``figures`` into an existing folder."""
    page, album = Page(material.title), Album(folder)
    page.paragraph(material.description)
    page.paragraph(*findings.verdict(material.scores, material.parameters))
    sections.configuration(page, material.configuration, material.left_out, material.unused)
    leaving_out.suggest(page, material.needless)
    _cable(page, album, material)
    _input(page, album, material)
    _scores(page, album, material)
    _run_time(page, album, material)
    sections.endings(page, material.ends)
    if material.histories:
        link = album.draw("searches", scores.searches, material.histories, material.starts)
        page.figure(link, "Best error so far against the number of simulations, one line a model.")
    _parameters(page, material)
    _identifiability(page, album, material)
    _verification(page, album, material)
    _bode(page, album, material)
    sections.manifest(page, material.manifest, material.configuration_text)
    page.write(folder / "report.md")


_RESIDUAL_HEADINGS = {
    "model": "model",
    "record": "record",
    "memory_s": "memory, s",
    "cross_peak": "largest correlation with the ship",
    "cross_lag_s": "at lag, s",
    "cross_band": "95 % band",
    "cross_outside": "share of lags outside",
}


def _cable(page: Page, album: Album, material: RunMaterial) -> None:
    if material.static_shape is not None:
        page.heading("The cable")
        link = album.draw("cable", shapes.snapshots, *material.static_shape, material.snapshots)
        page.figure(link, f"The cable from the side. {material.snapshots_note}")


def _input(page: Page, album: Album, material: RunMaterial) -> None:
    page.heading("Input and responses")
    page.paragraph(material.input_note)
    for record in material.records[:1]:
        _record(page, album, record)


def _record(page: Page, album: Album, record: RecordSeries) -> None:
    """A record's description, its response and the errors of the models on it."""
    page.paragraph(record.description)
    window = (
        f" Grey: before the scored window, which starts at {record.scored_from:g} s."
        if record.scored_from > record.t[0]
        else ""
    )
    link = album.draw(f"{record.record}-response", records.response, record)
    page.figure(link, f"Ship and vehicle, {record.record}.{window}")
    if record.models:
        link = album.draw(f"{record.record}-errors", records.errors, record)
        page.figure(
            link,
            f"Velocity and position errors of every model, {record.record}. RMS of the scored window above each panel.",
        )


def _scores(page: Page, album: Album, material: RunMaterial) -> None:
    page.heading("Scores")
    sections.score_tables(page, material.scores, material.thesis)
    floors = (
        dict(zip(material.floors["record"], material.floors["rms_velocity_m_s"], strict=True))
        if len(material.floors)
        else {}
    )
    names = findings.records_of(material.scores)
    link = album.draw("scores", scores.bars, material.scores, names, thesis=material.thesis, floors=floors)
    marks = " Black ticks: the thesis." if len(material.thesis) else ""
    marks += " Dotted: what the sensors alone make of a motion known exactly." if floors else ""
    page.figure(link, f"RMS velocity error of every model on every record.{marks}")


def _run_time(page: Page, album: Album, material: RunMaterial) -> None:
    page.heading("Error against run time")
    second = findings.verification_record(material.scores)
    sections.run_times(page, material.scores, "identification", second)
    page.paragraph(material.step_note)
    shown = ["identification", *([second] if second else [])]
    link = album.draw("error-run-time", scores.error_against_run_time, material.scores, shown)
    page.figure(
        link, "Error against the time that an hour of record takes, every model. Down and to the left is better."
    )


def _parameters(page: Page, material: RunMaterial) -> None:
    page.heading("Parameters")
    sections.parameters(page, material.parameters)
    if len(material.drag_over_spring):
        page.heading("Drag over spring", 3)
        page.paragraph(
            "b/k in s2/m: predicted as the drag of the vehicle and the lower half of the cable over the spring of the "
            "tension at midpoint, and as the single-node models find it (T 6.7)."
        )
        table = material.drag_over_spring.assign(
            change=100.0 * (material.drag_over_spring["identified"] / material.drag_over_spring["predicted"] - 1.0)
        )
        headings = {
            "model": "model",
            "predicted": "predicted",
            "identified": "identified",
            "change": "change, %",
            "thesis_predicted": "thesis, predicted",
            "thesis_identified": "thesis, identified",
        }
        page.table(table, headings, {"change": "+.1f", "thesis_predicted": ".0f", "thesis_identified": ".0f"})
    if len(material.total_drag):
        page.heading("Total drag", 3)
        page.paragraph(
            "Drag of the whole system in N s2/m2. A record like this determines the sum well and its split between "
            "cable and vehicle badly, so compare the totals."
        )
        table = material.total_drag.assign(
            change=100.0 * (material.total_drag["total"] / material.total_drag["mapped_total"] - 1.0)
        )
        headings = {
            "model": "model",
            "cable": "cable",
            "vehicle": "vehicle",
            "total": "total",
            "low": "low",
            "high": "high",
            "mapped_total": "mapped total",
            "change": "change, %",
        }
        page.table(table, headings, {"change": "+.1f"})


def _identifiability(page: Page, album: Album, material: RunMaterial) -> None:
    page.heading("Identifiability")
    page.bullets(findings.identifiable(material.parameters))
    if (material.parameters["mapped"].abs() > 0.0).any():
        link = album.draw("intervals", identifiability.intervals, material.parameters)
        page.figure(
            link, "Identified values over mapped values with their 95 % intervals. An arrow head: the interval goes on."
        )
    pairs = findings.strong_correlations(material.correlations)
    if pairs:
        page.paragraph("Pairs that stand in for one another (correlation 0.95 or more either way):")
        page.bullets(pairs)
    if any(len(table) > 1 for table in material.correlations.values()):
        page.figure(
            album.draw("correlations", identifiability.correlations, material.correlations),
            "Correlations of the estimates.",
        )
    if material.combinations:
        page.paragraph("Combinations that the record determines better than their parts:")
        page.bullets(f"**{model}**: {words}" for model, words in material.combinations)
    if material.twins:
        page.heading("Indistinguishable parameter sets", 3)
        page.bullets(f"**{model}**: {words}" for model, words in material.twins)
    if len(material.residual_numbers) or material.residual_tests:
        page.heading("Residuals", 3)
    if len(material.residual_numbers):
        page.paragraph(
            "What the velocity residuals still hold: how long they remember themselves, and their largest correlation "
            "with the ship's velocity. A learning model leaves memory; a correlation beyond its band is motion that "
            "the model misses."
        )
        page.table(material.residual_numbers, _RESIDUAL_HEADINGS, {"memory_s": ".0f", "cross_lag_s": ".0f"})
    if material.residual_tests:
        link = album.draw("residuals", residuals.residual_tests, material.residual_tests)
        page.figure(
            link,
            "Autocorrelation of the velocity residuals and their correlation with the ship's velocity. "
            "Grey: 95 % band of no correlation. What leaves the band at the right is motion that the model misses.",
        )


def _verification(page: Page, album: Album, material: RunMaterial) -> None:
    if len(material.records) < 2:
        return
    page.heading("Verification")
    page.paragraph(material.truth_note)
    if len(material.floors):
        words = [
            f"{row['record']}: {significant(row['rms_velocity_m_s'])} m/s and {significant(row['rms_position_m'])} m"
            for row in material.floors.to_dict("records")
        ]
        page.paragraph(
            "Sensor floor, the error that the sensors and the differentiator make of a motion known exactly:",
            f"{'; '.join(words)}. A perfect model would score about that.",
        )
    for record in material.records[1:]:
        page.heading(record.record, 3)
        _record(page, album, record)


def _bode(page: Page, album: Album, material: RunMaterial) -> None:
    if len(material.bode_points) and len(material.bode_curves):
        page.heading("Frequency response")
        page.paragraph(material.bode_note)
        link = album.draw("bode", frequency.bode, material.bode_points, material.bode_curves)
        page.figure(link, "From ship to vehicle: the reference simulator's points and the reduced models' curves.")
