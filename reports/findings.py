"""Sentences that follow from the tables: which model is best, what it costs, and how far to trust it."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from reports.markdown import listed, significant
from reports.style import is_baseline

#: Outcomes of a search in words; only the first counts as converged.
OUTCOMES: Mapping[str, str] = {
    "converged": "converged",
    "bound": "ended at a bound",
    "budget": "ran out of its budget of simulations",
    "flat": "lies on a flat floor",
    "failed": "failed",
}
_COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")
_HIGH_CORRELATION = 0.95


def in_words(number: int) -> str:
    """A small count as a word."""
    return _COUNTS[number] if number < len(_COUNTS) else str(number)


def count(number: int, noun: str) -> str:
    """A count with its noun: ``one model``, ``eight models``, ``23 models``."""
    return f"{in_words(number)} {noun}{'' if number == 1 else 's'}"


def spoken(name: str) -> str:
    """A parameter's name as a reader would say it."""
    return name.replace("_", " ")


def is_determined(verdict: object) -> bool:
    """Whether a verdict, a flag or words such as ``no (wide)``, says that the record determines a parameter."""
    return verdict.lower().startswith(("yes", "true")) if isinstance(verdict, str) else bool(verdict)


def run_time(seconds: float) -> str:
    """A cost in the unit that reads best."""
    return f"{significant(1e3 * seconds)} ms" if seconds < 1.0 else f"{significant(seconds)} s"


def without_baselines(table: pd.DataFrame) -> pd.DataFrame:
    """The rows that belong to models."""
    return table[~table["model"].map(is_baseline).astype(bool)] if len(table) else table


def models_of(table: pd.DataFrame) -> list[str]:
    """Models in order of first appearance."""
    return [str(name) for name in dict.fromkeys(table["model"])] if len(table) else []


def records_of(scores: pd.DataFrame) -> list[str]:
    """Records in order of first appearance."""
    return [str(name) for name in dict.fromkeys(scores["record"])]


def by_model(table: pd.DataFrame, record: str, column: str, models: Sequence[str]) -> "pd.Series[float]":
    """One column of a score table on one record, a value a model in the given order, NaN where there is none."""
    rows = table[table["record"] == record].drop_duplicates("model").set_index("model")[column]
    return rows.reindex(list(models)).astype(float).reset_index(drop=True)


def verification_record(scores: pd.DataFrame) -> str | None:
    """The record that models are ranked on: the true verification where there is one, else any that was not fitted."""
    names = records_of(scores)
    for wanted in ("verification-truth", "verification-measured"):
        if wanted in names:
            return wanted
    return next((name for name in names if name != "identification"), None)


def ranked(scores: pd.DataFrame, record: str, column: str = "rms_velocity_m_s") -> pd.DataFrame:
    """The record's rows with a finite error, best first."""
    rows = scores[(scores["record"] == record) & (scores["outcome"] != "failed")]
    rows = rows[pd.to_numeric(rows[column]).notna()]
    return rows.sort_values(column, kind="stable")


#: Fit percent from which a response is worth trusting although its parameters are not determined.
_TRUSTED_FIT = 50.0


def verdict(scores: pd.DataFrame, parameters: pd.DataFrame) -> list[str]:
    """The result of a run in a few sentences: the best model, its errors and its cost, and what they are worth.

    Parameters
    ----------
    scores
        As scores.csv; baselines are left out of the count.
    parameters
        As parameters.csv.
    """
    table = without_baselines(scores)
    seen = verification_record(table)
    order = ranked(table, seen or "identification")
    if order.empty:
        return ["No model could be scored."]
    best = order.iloc[0]
    name = str(best["model"])
    fitted = ranked(table, "identification")
    own = fitted[fitted["model"] == name]
    where = "on the record it has not seen" if seen else "on the record it was fitted to"
    tried = len(models_of(table))
    subject = f"Of {count(tried, 'reduced model')}, **{name}** comes nearest" if tried > 1 else f"**{name}** was tried"
    sentences = []
    sentences.append(
        f"{subject} {where}: its velocity error there is {best['rms_velocity_m_s']:.4f} m/s RMS{_relative(best)}, "
        f"its position error {significant(best['rms_position_m'])} m "
        f"({significant(best['rms_position_offset_removed_m'])} m without its constant offset)."
    )
    if seen and len(own):
        sentences.append(
            f"On the record it was fitted to the velocity error is {own.iloc[0]['rms_velocity_m_s']:.4f} m/s."
        )
    sentences.append(f"It simulates an hour in {run_time(best['simulation_s_per_hour'])}.")
    sentences.append(_cheaper(order))
    sentences.append(_growth(best, own, seen))
    sentences.append(_ending(best))
    sentences.append(_determined(best, parameters))
    return [sentence for sentence in sentences if sentence]


def _relative(row: "pd.Series[Any]") -> str:
    """The error beside what the vehicle's motion about its mean holds."""
    fit = float(row.get("fit_percent", math.nan))
    return f", a fit of {fit:.1f} %" if math.isfinite(fit) else ""


def _cheaper(order: pd.DataFrame) -> str:
    """The cheapest model that errs at most half as much again as the best."""
    best = order.iloc[0]
    near = order[order["rms_velocity_m_s"] <= 1.5 * best["rms_velocity_m_s"]].sort_values("simulation_s_per_hour")
    cheapest = near.iloc[0]
    if cheapest["model"] == best["model"] or cheapest["simulation_s_per_hour"] > 0.8 * best["simulation_s_per_hour"]:
        return ""
    times = best["simulation_s_per_hour"] / cheapest["simulation_s_per_hour"]
    return (
        f"The cheapest within half as much error again is {cheapest['model']}: {cheapest['rms_velocity_m_s']:.4f} m/s, "
        f"{times:.1f} times faster."
    )


def _growth(best: "pd.Series[Any]", own: pd.DataFrame, seen: str | None) -> str:
    """What the step from one record to the other does to the error."""
    if seen is None:
        return "No other record was tried, so this says how well the model was fitted, not how well it predicts."
    if own.empty or not own.iloc[0]["rms_velocity_m_s"] > 0.0:
        return ""
    times = best["rms_velocity_m_s"] / own.iloc[0]["rms_velocity_m_s"]
    if times <= 1.05:
        return "The error does not grow from the one record to the other."
    return f"Between the two records the error grows by a factor of {times:.1f}: expect the larger one in use."


def _ending(row: "pd.Series[Any]") -> str:
    outcome = str(row["outcome"])
    if outcome == "converged":
        return "Its search converged."
    return f"Its search did **not** converge: it {OUTCOMES.get(outcome, outcome)}."


def _determined(best: "pd.Series[Any]", parameters: pd.DataFrame) -> str:
    """How many of a model's parameters its record determines, and whether the response stands all the same."""
    model = str(best["model"])
    if parameters.empty or not (parameters["model"] == model).any():
        return ""
    rows = parameters[parameters["model"] == model]
    loose = _loose(rows)
    if not loose:
        words = "its one parameter" if len(rows) == 1 else f"all {in_words(len(rows))} of its parameters"
        return f"The record determines {words}."
    words = f"The record does not determine its {listed(loose)}"
    far_off = float(best.get("fit_percent", math.nan)) < _TRUSTED_FIT
    if far_off or str(best["outcome"]) not in ("converged", "flat"):
        return f"{words}, and its response is too far off, or its search not at an optimum, to be trusted without."
    values = "that value" if len(loose) == 1 else "those values"
    return f"{words}: the response can be trusted as far as the errors above go, {values} alone cannot."


def _loose(rows: pd.DataFrame) -> list[str]:
    """The parameters that the record does not determine, with the reason where the verdict gives one."""
    return [
        spoken(str(row["parameter"])) + (str(row["determined"])[2:] if isinstance(row["determined"], str) else "")
        for row in rows.to_dict("records")
        if not is_determined(row["determined"])
    ]


def not_converged(ends: pd.DataFrame) -> list[str]:
    """One sentence for each search that did not converge, saying so."""
    rows = ends[ends["outcome"] != "converged"]
    return [
        f"**{row['model']}** {OUTCOMES.get(str(row['outcome']), str(row['outcome']))}"
        f"{_of(row)}; its values are where the search stopped, not an optimum."
        for row in rows.to_dict("records")
    ]


def _of(row: Mapping[Any, Any]) -> str:
    return f" on {row['record']}" if row.get("record") else ""


def against_thesis(scores: pd.DataFrame, thesis: pd.DataFrame) -> list[str]:
    """How many of the thesis's velocity errors are met, and which are not."""
    if thesis.empty:
        return []
    both = thesis.merge(scores, on=["model", "record"], suffixes=("_thesis", ""))
    both = both[both["rms_velocity_m_s_thesis"].notna()]
    if both.empty:
        return []
    missed = both[~(both["rms_velocity_m_s"] <= both["rms_velocity_m_s_thesis"])]
    met = in_words(len(both) - len(missed)).capitalize() if len(missed) < len(both) else "None"
    sentence = f"{met} of the {in_words(len(both))} velocity errors that the thesis prints are met or bettered."
    words = [
        f"{row['model']} on {row['record']} "
        f"({significant(row['rms_velocity_m_s'], 4)} against {row['rms_velocity_m_s_thesis']:g} m/s)"
        for row in missed.to_dict("records")
    ]
    return [sentence, f"Not met: {listed(words)}." if words else ""]


def identifiable(parameters: pd.DataFrame) -> list[str]:
    """For each model, which parameters its record determines."""
    lines = []
    for model in models_of(parameters):
        rows = parameters[parameters["model"] == model]
        fixed = [spoken(name) for name in rows.loc[rows["determined"].map(is_determined).astype(bool), "parameter"]]
        loose = _loose(rows)
        if not loose:
            words = f"determines {listed(fixed)}."
        elif not fixed:
            words = f"determines none of {listed(loose)}."
        else:
            words = f"determines {listed(fixed)}, but not {listed(loose)}."
        lines.append(f"**{model}**: the record {words}")
    return lines


def strong_correlations(tables: Mapping[str, pd.DataFrame]) -> list[str]:
    """Pairs of parameters that stand in for one another."""
    lines = []
    for model, table in tables.items():
        names = [str(name) for name in table.columns]
        values = table.to_numpy(dtype=float)
        pairs = [
            f"{names[i]} and {names[j]} ({values[i, j]:+.3f})"
            for i in range(len(names))
            for j in range(i)
            if abs(values[i, j]) >= _HIGH_CORRELATION
        ]
        if pairs:
            lines.append(f"**{model}**: {listed(pairs)}.")
    return lines


def against_baselines(scores: pd.DataFrame, record: str) -> str:
    """How the best model of a tow compares with the best trivial predictor, in position."""
    order = ranked(scores, record, "rms_position_m")
    trivial = order[order["model"].map(is_baseline).astype(bool)]
    models = without_baselines(order)
    if models.empty:
        return f"On {record} no model could be scored."
    best = models.iloc[0]
    words = f"On {record} the best model, **{best['model']}**, misses by {significant(best['rms_position_m'])} m RMS"
    if trivial.empty:
        return f"{words}."
    simple = trivial.iloc[0]
    change = 100.0 * (1.0 - best["rms_position_m"] / simple["rms_position_m"])
    comparison = "better" if change >= 0.0 else "**worse**"
    beaten = int((models["rms_position_m"] < simple["rms_position_m"]).sum())
    return (
        f"{words}; the best trivial predictor, {simple['model']}, by {significant(simple['rms_position_m'])} m: "
        f"the model is {abs(change):.0f} % {comparison}. "
        f"{_of_all(beaten, len(models)).capitalize()} beat{'s' if beaten < 2 else ''} it."
    )


def against_baselines_in_velocity(scores: pd.DataFrame, record: str) -> str:
    """How the best model of a tow compares with each baseline in velocity, which is what was fitted."""
    order = ranked(scores, record, "rms_velocity_m_s")
    models = without_baselines(order)
    trivial = order[order["model"].map(is_baseline).astype(bool)]
    if models.empty or trivial.empty:
        return ""
    best = models.iloc[0]
    others = [f"{row['model']} {row['rms_velocity_m_s']:.4f}" for row in trivial.to_dict("records")]
    beaten = int((trivial["rms_velocity_m_s"] > best["rms_velocity_m_s"]).sum())
    won = in_words(beaten) if beaten else "none"
    return (
        f"In velocity, which is what was fitted, {best['model']} is the best model with "
        f"{best['rms_velocity_m_s']:.4f} m/s, beside {listed(others)}: it beats {won} of "
        f"{count(len(trivial), 'baseline')}."
    )


def _of_all(some: int, everything: int) -> str:
    """A share of the models in words."""
    if some == everything > 1:
        return f"all {count(everything, 'model')}"
    return f"{in_words(some) if some else 'none'} of {count(everything, 'model')}"


def tows_in_words(scores: pd.DataFrame, names: Sequence[str]) -> list[str]:
    """Over all tows: how often any model beats the best baseline, and which model is best on the whole."""
    won = 0
    for name in names:
        order = ranked(scores, name, "rms_position_m")
        if len(order) and not is_baseline(str(order.iloc[0]["model"])):
            won += 1
    share = f"{in_words(won) if won else 'none'} of {count(len(names), 'tow')}"
    sentences = [f"On {share} the best predictor of position is a model, not a baseline."]
    middle = scores.groupby("model", sort=False)["rms_position_m"].median().dropna().sort_values(kind="stable")
    if len(middle) and len(names) > 1:
        first, size = middle.index[0], significant(float(middle.iloc[0]))
        following = f", {middle.index[1]} the next, {significant(float(middle.iloc[1]))} m" if len(middle) > 1 else ""
        sentences.append(f"Over all of them {first} has the smallest median position error, {size} m{following}.")
    return sentences
