"""Tables and manifests as files: the same content gives the same bytes, and every file ends with a line feed."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

SCORE_COLUMNS = (
    "model",
    "drag",
    "links",
    "states",
    "parameters",
    "record",
    "rms_velocity_m_s",
    "rms_position_m",
    "rms_position_offset_removed_m",
    "fit_percent",
    "vehicle_rms_velocity_m_s",
    "simulation_s_per_hour",
    "identification_s",
    "simulations",
    "outcome",
)
PARAMETER_COLUMNS = (
    "model",
    "parameter",
    "symbol",
    "unit",
    "mapped",
    "identified",
    "change_percent",
    "low",
    "high",
    "determined",
)


def write_table(path: Path, frame: pd.DataFrame, columns: Sequence[str] | None = None, *, digits: int = 9) -> None:
    """Write a table as CSV.

    Parameters
    ----------
    path
        The file; its folder is made when needed.
    frame
        One row a line; NaN becomes an empty cell, flags become ``true`` and ``false``.
    columns
        The columns and their order; all of them when left out.
    digits
        Significant digits of the numbers.
    """
    chosen = frame if columns is None else frame.loc[:, list(columns)]
    lines = [",".join(_text(str(name), digits) for name in chosen.columns)]
    texts = [[_text(value, digits) for value in chosen[name].tolist()] for name in chosen.columns]
    lines += [",".join(row) for row in zip(*texts, strict=True)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def write_scores(path: Path, scores: pd.DataFrame) -> None:
    """Write scores.csv: one row a model and record."""
    write_table(path, scores, SCORE_COLUMNS, digits=6)


def write_parameters(path: Path, parameters: pd.DataFrame) -> None:
    """Write parameters.csv: one row a model and parameter."""
    write_table(path, parameters, PARAMETER_COLUMNS, digits=6)


def write_traces(folder: Path, traces: Mapping[str, pd.DataFrame]) -> None:
    """Write each table to ``folder/name.csv``."""
    for name, frame in traces.items():
        write_table(folder / f"{name}.csv", frame)


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write a manifest or another mapping as indented JSON; NaN and infinity become null."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8", newline="\n")


def _text(value: Any, digits: int) -> str:
    """One CSV cell, quoted where needed."""
    if value is None or value is pd.NA or value is pd.NaT:
        return ""
    if isinstance(value, bool | np.bool_):
        return "true" if value else "false"
    if isinstance(value, float | np.floating):
        return "" if math.isnan(value) else f"{float(value) + 0.0:.{digits}g}"
    text = str(value)
    return '"' + text.replace('"', '""') + '"' if any(mark in text for mark in ',"\r\n') else text


def _plain(value: Any) -> Any:
    """The value in the types that JSON knows."""
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value))
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, bool | int | str):
        return value
    return str(value)
