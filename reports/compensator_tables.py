"""Tables on the page of a compensator study, two of them beside those that the paper prints."""

import pandas as pd

from reports.markdown import Page

#: Rows of the paper's Table IV: words, unit and the factor to it.
_ROWS = {
    "H_third_m": ("waves, significant height", "m", 1.0),
    "D_third_m": ("vessel heave, significant height", "m", 1.0),
    "p_n_third_m": ("cable top, significant height", "m", 1.0),
    "R_third_m": ("compensator, significant height", "m", 1.0),
    "Q_third_m": ("towed body, significant height", "m", 1.0),
    "R_thousandth_m": ("compensator, 1/1000 height", "m", 1.0),
    "T_1_thousandth_N": ("tension at the body, 1/1000 amplitude", "kN", 1e-3),
    "T_1_N": ("static tension at the body", "kN", 1e-3),
    "T_n_thousandth_N": ("tension at the top, 1/1000 amplitude", "kN", 1e-3),
    "T_n_N": ("static tension at the top", "kN", 1e-3),
}
_SETTINGS = {
    "setting": "setting",
    "stiffness_N_m": "stiffness, N/m",
    "damping_N_s_m": "damping, N s/m",
    "relative": "|R/D|",
    "top": "|p_n/D|",
}
_THREE = {
    "quantity": "quantity",
    "printed": "printed",
    "at_inferred_peak": "ours at the inferred peak",
    "off_percent": "off, %",
    "at_peak": "ours at this vessel's peak",
    "peak_off_percent": "off, %",
}
_FOUR = {
    "strategy": "strategy",
    "quantity": "quantity",
    "printed": "printed",
    "at_printed_settings": "ours, its settings",
    "off_percent": "off, %",
    "at_our_settings": "ours, our settings",
    "our_off_percent": "off, %",
}
_TRUST = {
    "strategy": "strategy",
    "slack_probability_bottom": "slack at the body, share of cycles",
    "slack_probability_worst": "slack anywhere",
    "heave_crossing_s": "heave period, s",
    "iterations": "iterations",
    "mesh_error_share": "error of the mesh",
}


def settings(page: Page, table: pd.DataFrame) -> None:
    """What the linear analysis expects of each setting."""
    page.table(
        table,
        _SETTINGS,
        {"relative": ".3f", "top": ".3f", "stiffness_N_m": ".0f", "damping_N_s_m": ".0f"},
    )


def table_three(page: Page, table: pd.DataFrame, peak: float) -> None:
    """The paper's Table III beside ours, the columns of ``table-3.csv``; `peak` is that of the vessel [rad/s]."""
    at = float(table["inferred_peak_rad_s"].iloc[0])
    page.heading("Beside the paper's Table III", 3)
    page.paragraph(
        f"The paper does not print at which frequency its values hold. The frequency where the largest deviation "
        f"of the three is least is {at:.3f} rad/s; beside it, the values at the peak of this vessel's heave, "
        f"{peak:.3f} rad/s."
    )
    page.table(
        table,
        _THREE,
        {
            "printed": ".0f",
            "at_inferred_peak": ".0f",
            "at_peak": ".0f",
            "off_percent": "+.1f",
            "peak_off_percent": "+.1f",
        },
    )


def strategies(page: Page, details: pd.DataFrame) -> None:
    """What Table IV has, a row a quantity and a column a strategy, from the columns of ``tuning-details.csv``."""
    table: dict[str, list[str]] = {"quantity": [f"{words}, {unit}" for words, unit, _ in _ROWS.values()]}
    for row in details.to_dict("records"):
        values = [f"{scale * float(row[column]):.2f}" for column, (_, _, scale) in _ROWS.items()]
        table[str(row["strategy"])] = values
    page.table(pd.DataFrame(table))


def trust(page: Page, details: pd.DataFrame) -> None:
    """Slack, and how well each strategy is resolved; a chance below one in a million is none."""
    chances = ["slack_probability_bottom", "slack_probability_worst"]
    page.table(
        details.assign(**{name: details[name].where(details[name] >= 1e-6, 0.0) for name in chances}),
        _TRUST,
        {
            "slack_probability_bottom": ".2g",
            "slack_probability_worst": ".2g",
            "heave_crossing_s": ".1f",
            "mesh_error_share": ".1e",
            "iterations": ".0f",
        },
    )


def table_four(page: Page, table: pd.DataFrame, *, assumed: bool) -> None:
    """The paper's Table IV beside ours, the columns of ``table-4.csv``."""
    page.heading("Beside the paper's Table IV", 3)
    shown = table.copy()
    off = shown["off_percent"].abs().max()
    page.paragraph(
        f"With the settings that the paper prints, the random sea comes to within {off:.1f} % of its Table IV, "
        f"although the vessel is {'an assumed one' if assumed else 'another'}; the rest is due to the other settings."
    )
    scales = [_ROWS[str(name)][2] for name in shown["quantity"]]
    for name in ("printed", "at_printed_settings", "at_our_settings"):
        shown[name] *= scales
    shown["quantity"] = [", ".join(_ROWS[str(name)][:2]) for name in shown["quantity"]]
    formats = {"printed": ".2f", "at_printed_settings": ".2f", "at_our_settings": ".2f"}
    page.table(shown, _FOUR, formats | {"off_percent": "+.1f", "our_off_percent": "+.1f"})
