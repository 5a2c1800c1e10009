"""Sections that several pages share: configuration, score tables, parameters, how the searches ended, manifest."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from reports import findings
from reports.markdown import Page, exact

PARAMETER_HEADINGS = {
    "model": "model",
    "record": "record",
    "parameter": "parameter",
    "symbol": "symbol",
    "unit": "unit",
    "mapped": "mapped",
    "identified": "identified",
    "change_percent": "change, %",
    "low": "low",
    "high": "high",
    "determined": "determined",
}


def configuration(
    page: Page, table: pd.DataFrame, left_out: Sequence[tuple[str, str]], unused: Sequence[tuple[str, str]]
) -> None:
    """The settings with guesses marked, what the scene leaves out and why, and the settings that it does not use."""
    page.heading("Configuration")
    shown = table.copy()
    if "guess" in shown.columns:
        flags = shown["guess"].astype(bool)
        shown["guess"] = ["guess" if flag else " " for flag in flags]
        if flags.any():
            page.paragraph(
                f"{findings.count(int(flags.sum()), 'value').capitalize()} of {len(shown)} "
                f"{'is a guess' if flags.sum() == 1 else 'are guesses'}, marked in the last column: "
                "nothing below is better than they are."
            )
        else:
            shown = shown.drop(columns="guess")
    headings = {"part": "part", "setting": "setting", "value": "value", "unit": "unit", "note": "note", "guess": " "}
    page.table(shown, headings, exactly=("value",))
    page.heading("What the scene leaves out", 3)
    if left_out:
        page.bullets(f"**{term}**: {why}" for term, why in left_out)
    else:
        page.paragraph("Nothing that this program can include.")
    if unused:
        page.heading("Settings that this scene does not use", 3)
        page.bullets(f"`{setting}`: {why}" for setting, why in unused)


def score_tables(page: Page, scores: pd.DataFrame, thesis: pd.DataFrame) -> None:
    """RMS velocity error, RMS position error and fit percent, models down and records across (T 6-I, 6-II)."""
    printed = " The columns headed thesis are tables 6-I and 6-II of the thesis." if len(thesis) else ""
    page.heading("Velocity error", 3)
    page.paragraph(f"RMS velocity error in m/s over the scored window.{printed}")
    page.paragraph(*findings.against_thesis(scores, thesis))
    _across(page, scores, "rms_velocity_m_s", ".4f", thesis)
    page.heading("Position error", 3)
    page.paragraph("RMS position error in m; it was not fitted.")
    _across(page, scores, "rms_position_m", ".1f", thesis)
    page.paragraph("The same without its constant offset:")
    _across(page, scores, "rms_position_offset_removed_m", ".1f")
    page.heading("Fit", 3)
    page.paragraph(
        "Fit of the velocity in percent, `100 (1 - |y - yhat| / |y - mean y|)`; 100 is perfect, 0 is a constant."
    )
    _across(page, scores, "fit_percent", ".1f")


def _across(page: Page, scores: pd.DataFrame, column: str, form: str, thesis: pd.DataFrame | None = None) -> None:
    """A table with a row a model and a column a record, the thesis's value as printed beside it."""
    models = findings.models_of(scores)
    table = pd.DataFrame({"model": models})
    formats, printed = {}, []
    for record in findings.records_of(scores):
        table[record] = findings.by_model(scores, record, column, models)
        formats[record] = form
        if thesis is not None and column in thesis.columns:
            goal = findings.by_model(thesis, record, column, models)
            if goal.notna().any():
                printed.append(f"thesis, {record}")
                table[printed[-1]] = goal
    page.table(table, formats=formats, exactly=printed)


def run_times(page: Page, scores: pd.DataFrame, first: str, second: str | None) -> None:
    """Size, cost and error of every model, cheapest first."""
    table = findings.without_baselines(scores).drop_duplicates("model").copy()
    columns = {"error_first": f"{first}, m/s", "error_second": f"{second}, m/s"}
    for name, record in zip(columns, (first, second), strict=True):
        if record is not None:
            table[name] = findings.by_model(scores, record, "rms_velocity_m_s", table["model"].tolist()).to_numpy()
    table["simulation_ms"] = 1e3 * table["simulation_s_per_hour"]
    headings = {
        "model": "model",
        "states": "states",
        "parameters": "parameters",
        "simulation_ms": "one hour, ms",
        "identification_s": "identification, s",
        "simulations": "simulations",
        **(columns if second else {"error_first": columns["error_first"]}),
    }
    page.table(
        table.sort_values("simulation_ms", kind="stable"),
        headings,
        {"error_first": ".4f", "error_second": ".4f", "states": ".0f", "parameters": ".0f", "simulations": ".0f"},
    )


def parameters(page: Page, table: pd.DataFrame) -> None:
    """Mapped and identified parameters with their intervals (T table 6-III)."""
    page.paragraph(
        "Mapped values come from sectioning the cable's continuous quantities; low and high bound the 95 % interval of "
        "the identified value, autocorrelated residuals allowed for."
    )
    names = table["parameter"].map(lambda name: findings.spoken(str(name)))
    page.table(table.assign(parameter=names), PARAMETER_HEADINGS, {"change_percent": "+.1f"})


def endings(page: Page, ends: pd.DataFrame) -> None:
    """Why every search stopped; those that did not converge are called out first."""
    page.heading("How the searches ended")
    missed = findings.not_converged(ends)
    if missed:
        page.paragraph(
            f"{findings.in_words(len(missed)).capitalize()} of {findings.in_words(len(ends))} did not converge:"
        )
        page.bullets(missed)
    else:
        page.paragraph("Every search converged.")
    page.table(ends, {"record": "record", "model": "model", "outcome": "outcome", "reason": "reason"})


def manifest(page: Page, content: Mapping[str, Any], configuration_text: str) -> None:
    """Versions, seeds and machine as a table; the configuration as used below it."""
    if not content and not configuration_text:
        return
    page.heading("Manifest")
    told = {key: value for key, value in content.items() if value != configuration_text}
    rows = [(item, value if isinstance(value, str) else exact(value)) for item, value in _flat(told)]
    if rows:
        page.table(pd.DataFrame(rows, columns=["item", "value"]))
    if configuration_text:
        page.paragraph("The configuration as used:")
        page.code(configuration_text, "toml")


def _flat(content: Mapping[str, Any], before: str = "") -> list[tuple[str, Any]]:
    """Nested mappings as ``outer: inner`` rows."""
    rows: list[tuple[str, Any]] = []
    for key, value in content.items():
        name = f"{before}{key}"
        if isinstance(value, Mapping):
            rows += _flat(value, f"{name}: ")
        else:
            rows.append((name, value))
    return rows
