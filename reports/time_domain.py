"""A section of a page: the same sea through the chain in the time domain, beside the matrix method."""

from dataclasses import dataclass, field

import pandas as pd

from reports import findings
from reports.markdown import Page, listed, significant

#: The largest difference in the paper's Table V [%].
PRINTED = 15.8
#: Share of the largest motion below which slow motion is not told of.
_HARDLY = 0.01
_NAMES = {
    "top": "cable's top, along it",
    "relative": "compensator",
    "horizontal": "vehicle, horizontal",
    "vertical": "vehicle, vertical",
    "tension_bottom": "tension at the vehicle",
    "tension_top": "tension at the top",
}
_TABLE = {
    "strategy": "strategy",
    "quantity": "quantity",
    "unit": "unit",
    "rms": "RMS of the chain",
    "sigma": "sigma",
    "difference_percent": "chain above sigma, %",
    "sigma_level": "sigma of a level body",
    "difference_level_percent": "chain above it, %",
    "crests": "crests",
    "largest": "largest",
    "expected": "expected of sigma",
}
_DETAILS = {
    "strategy": "strategy",
    "quantity": "quantity",
    "unit": "unit",
    "sampling_percent": "scatter of such an RMS, %",
    "chain_error_percent": "error of the chain, %",
    "matrix_error_percent": "error of the matrix method, %",
    "slow_rms": "RMS below the waves",
    "mean": "mean shift",
}
_COSTS = {
    "strategy": "strategy",
    "method": "method",
    "settings": "settings",
    "error_percent": "largest error, %",
    "cpu_s": "CPU time, s",
    "ratio": "chain over it",
}
_HARMONICS = {
    "omega_rad_s": "frequency, rad/s",
    "quantity": "quantity",
    "unit": "unit",
    "chain": "chain",
    "matrix": "matrix",
    "difference_percent": "chain above, %",
    "phase_rad": "and ahead, rad",
    "level": "level body",
    "harmonics_percent": "higher harmonics, %",
    "chain_error_percent": "error of the chain, %",
}
_RUNS = {
    "strategy": "strategy",
    "runs": "runs",
    "correction_percent": "last correction, %",
    "residual_percent": "out of balance, %",
    "left_percent": "left at high frequencies, %",
    "settled": "settled",
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeDomain:
    """What the section shows.

    Parameters
    ----------
    duration, run_in
        Of the record, and of what is dropped before it [s].
    seed
        Of the phases.
    table, costs
        As of `ident.sea_checks.SeaCheck`, with a ``strategy`` where there are several.
    slack
        Times that the chain fell slack in each run of the table.
    runs
        How the compensator's balance was found: ``strategy, runs, correction_percent, residual_percent,
        left_percent, settled``.
    harmonics
        As of `ident.harmonic_checks.check_harmonics`, with an RMS motion of the top as that of the sea.
    """

    duration: float
    run_in: float
    seed: int
    table: pd.DataFrame
    costs: pd.DataFrame
    slack: int
    runs: pd.DataFrame = field(default_factory=pd.DataFrame)
    harmonics: pd.DataFrame = field(default_factory=pd.DataFrame)


def section(page: Page, shown: TimeDomain) -> None:
    """Append the section."""
    table = _moving(shown.table.assign(quantity=shown.table["quantity"].map(_NAMES)))
    compared = table[table["difference_percent"].notna()]
    page.heading("Against the time domain")
    page.paragraph(
        f"The same sea through the nonlinear link-joint chain: {shown.duration / 3600.0:g} h after "
        f"{shown.run_in / 60.0:.0f} min that are dropped, phases drawn with the seed {shown.seed}. The sea has the "
        "spectrum's own amplitudes and repeats after its record, so that a linear answer has an RMS of sigma whatever "
        "the phases; with drawn amplitudes an RMS of such a record would scatter by "
        f"{significant(float(compared['sampling_percent'].min()), 2)} to "
        f"{significant(float(compared['sampling_percent'].max()), 2)} %."
    )
    page.paragraph(*_findings(compared, shown))
    page.table(table, _TABLE, {"difference_percent": "+.1f", "difference_level_percent": "+.1f"})
    page.paragraph(*_apart(table))
    page.table(
        table, _DETAILS, {"sampling_percent": ".1f", "chain_error_percent": ".2f", "matrix_error_percent": ".2g"}
    )
    if len(shown.runs):
        page.paragraph(
            "The chain takes the motion of its top as given; the compensator's balance is solved by running it over "
            "again, each time with a motion corrected by what is out of balance, until a correction is below 1 % of "
            "the motion. Above the frequencies at which the deck moves the motion keeps its linear answer; what is out "
            "of balance there would move the top by what the last but one column says."
        )
        page.table(shown.runs, _RUNS, {"correction_percent": ".2f", "residual_percent": ".2f", "left_percent": ".2g"})
    if len(shown.harmonics):
        _harmonics(page, shown.harmonics)
    page.paragraph(
        "Run times of one thread. The matrix method is timed as this page asks for it, with the error of its segments, "
        "and once with the fewest segments and the paper's 40 frequencies that keep every sigma within half a percent."
    )
    page.table(shown.costs, _COSTS, {"error_percent": ".2g", "ratio": ".0f"})


def _harmonics(page: Page, harmonics: pd.DataFrame) -> None:
    """The table of single frequencies."""
    shown = harmonics[harmonics["difference_percent"].notna() & (harmonics["quantity"] != "top")]
    amplitude = float(harmonics["amplitude_m"].iloc[0])
    page.paragraph(
        "A single frequency at a time, with the sea's RMS motion of the cable's top, "
        f"an amplitude of {significant(amplitude)} m: amplitudes of the chain's first harmonic, once it is periodic, "
        "beside those of the matrix method. Drag is linearised for one sinusoid here, so that what differs more in the "
        "sea is the linearisation for a normal process."
    )
    formats = {
        "difference_percent": "+.2f",
        "phase_rad": "+.3f",
        "harmonics_percent": ".1f",
        "chain_error_percent": ".2f",
    }
    page.table(shown.assign(quantity=shown["quantity"].map(_NAMES)), _HARMONICS, formats)


def _findings(compared: pd.DataFrame, shown: TimeDomain) -> list[str]:
    """The result in words made from the numbers."""
    moved = compared[compared["quantity"] != _NAMES["top"]] if shown.runs.empty else compared
    sentences = []
    if len(moved):
        # Where the matrix method knows the level body that the chain has, like is compared with like.
        column = "difference_level_percent" if "difference_level_percent" in moved else "difference_percent"
        worst = moved.iloc[int(moved[column].abs().fillna(0.0).to_numpy().argmax())]
        of = f" ({worst['strategy']})" if "strategy" in worst else ""
        size = abs(float(worst[column]))
        sentences.append(
            f"RMS and sigma differ by up to {size:.1f} %, for the {worst['quantity']}{of}"
            + (", both with a level body" if column != "difference_percent" else "")
            + (f"; the paper's Table V has up to {PRINTED} %." if not shown.slack else "; the chain went slack.")
        )
        peaks = moved.iloc[int((moved["largest"] / moved["expected"]).to_numpy().argmax())]
        times = float(peaks["largest"]) / float(peaks["expected"])
        if times > 1.2:
            sentences.append(
                f"Peaks differ more: the largest amplitude of the {peaks['quantity']} is {times:.1f} times what sigma "
                "lets expect."
            )
    if shown.slack:
        sentences.append(
            f"The chain fell slack {findings.count(shown.slack, 'time')}; snaps make tension peaks that no linear "
            "method has, and the sharper the finer the links are."
        )
    return sentences


def _moving(table: pd.DataFrame) -> pd.DataFrame:
    """The rows of what moves, with the waves or slower."""
    slow = (table["unit"] == "m") & (table["slow_rms"] > _HARDLY * _largest(table))
    return table[table["difference_percent"].notna() | slow]


def _largest(table: pd.DataFrame) -> float:
    """RMS of the largest motion [m]."""
    return float(table.loc[table["unit"] == "m", "rms"].max())


def _apart(table: pd.DataFrame) -> list[str]:
    """What each method knows alone."""
    sentences = ["RMS values are of what is as fast as the slowest wave and above."]
    slow = (table["slow_rms"] > table["rms"]) & (table["slow_rms"] > _HARDLY * _largest(table))
    motions = table[slow & (table["unit"] == "m")]
    if len(motions):
        words = listed(
            [f"{significant(float(row['slow_rms']), 2)} m ({row['quantity']})" for _, row in motions.iterrows()]
        )
        sentences.append(
            f"Below, the chain moves more than with the waves, by {words}: drag grows with the square of the speed, so "
            "that groups of high waves shift the tow, which a linear method does not know."
        )
    if "sigma_level" in table:
        sentences.append(
            "The chain's body has no pitch and is towed at its centre of mass, as the level body of the matrix method. "
            "In a flow their drag still differs: the matrix method has that of H (15)-(16), in which each area "
            "counts for all directions, the chain's body has each area for its own direction."
        )
    return sentences
