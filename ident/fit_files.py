"""FIT.json: fitted models with the configuration they belong to, enough to simulate and score them again."""

import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ident.learning import Fit
from ident.manifest import versions
from models import reduced
from models.delayed import FirstOrder, SecondOrder
from models.drive import Start
from models.quantity import InvalidInput
from models.reduced import ReducedModel
from models.statics import StaticShape
from models.tow import Tow

#: What the file calls itself, and the version of its layout.
KIND, LAYOUT = "cable-ident fit", 1


@dataclass(frozen=True, slots=True, kw_only=True)
class SavedFit:
    """One fitted model as the file holds it.

    `values` and `mapped` are by parameter name, SI; `fixed` names those that were not searched. A fixed delay
    that is no parameter of its model has no value: it is the travel time of the tow.
    """

    model: str
    values: Mapping[str, float]
    mapped: Mapping[str, float]
    fixed: tuple[str, ...]
    records: tuple[str, ...]
    rms_velocity: float
    identification_s: float
    simulations: int
    outcome: str
    reason: str

    def rebuild(self, tow: Tow, shape: StaticShape) -> ReducedModel:
        """The fitted model, for the tow of the configuration that is in the file.

        Raises
        ------
        InvalidInput
            The file's values are not those of the model.
        """
        model = reduced.section(self.model, tow, shape)
        if isinstance(model, SecondOrder | FirstOrder) and "delay" not in self.values:
            model = replace(model, delay_fixed=True)
        names = [p.name for p in reduced.parameters(model)]
        if set(names) != set(self.values):
            raise InvalidInput(
                f"A fit of {self.model} needs the values {', '.join(names)}, but its file has "
                f"{', '.join(sorted(self.values))}."
            )
        return reduced.with_values(model, [self.values[name] for name in names])


@dataclass(frozen=True, slots=True, kw_only=True)
class FitFile:
    """The configuration as used, its name, how the records were read, and the fits.

    `start` is where simulations started, `window` the differentiator's [s], 0 for records without noise.
    """

    configuration_name: str
    configuration_text: str
    start: Start
    window: float
    fits: tuple[SavedFit, ...]


def write_fits(
    path: Path,
    fits: Sequence[Fit],
    *,
    configuration_name: str,
    configuration_text: str,
    start: Start = "rest",
    window: float = 0.0,
) -> None:
    """Write fits to a file, whole or not at all: a temporary sibling is moved into place.

    Raises
    ------
    OSError
        The place cannot be written.
    """
    content = {
        "kind": KIND,
        "layout": LAYOUT,
        "configuration_name": configuration_name,
        "configuration": configuration_text,
        "start": start,
        "differentiator_s": window,
        "fits": [_as_mapping(fit) for fit in fits],
        "versions": versions(),
    }
    sibling = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        sibling.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")
        sibling.replace(path)
    finally:
        sibling.unlink(missing_ok=True)


def read_fits(path: Path) -> FitFile:
    """Read a file that `write_fits` wrote.

    Raises
    ------
    InvalidInput
        There is no such file, or it is not a fit file: not JSON, of another kind or layout, a key missing or of
        the wrong type, an unknown model.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidInput(f"{path}: the fit file cannot be read ({error.strerror}).") from error
    except ValueError as error:
        raise InvalidInput(f"{path}: a fit file is JSON as `cable-ident fit` writes it, but this is not.") from error
    if not isinstance(content, dict) or content.get("kind") != KIND:
        raise InvalidInput(f"{path}: this is not a fit file; write one with `cable-ident fit`.")
    if content.get("layout") != LAYOUT:
        raise InvalidInput(
            f"{path}: the fit file has layout {content.get('layout')!r}, but this version reads {LAYOUT}; fit again."
        )
    where = str(path)
    fits = _entry(content, "fits", list, where)
    if not fits:
        raise InvalidInput(f"{path}: a fit file needs at least one fit, but it has none.")
    return FitFile(
        configuration_name=_entry(content, "configuration_name", str, where),
        configuration_text=_entry(content, "configuration", str, where),
        start=_start(content, where),
        window=_number(content.get("differentiator_s"), f"{where}: differentiator_s"),
        fits=tuple(_saved(fit, f"{path}: fits[{i}]") for i, fit in enumerate(fits)),
    )


def _as_mapping(fit: Fit) -> dict[str, object]:
    intervals = () if fit.identifiability is None else fit.identifiability.intervals
    return {
        "model": reduced.info(fit.model).model,
        "values": {p.name: p.value for p in reduced.parameters(fit.model)},
        "mapped": {p.name: p.value for p in reduced.parameters(fit.start)},
        "units": {p.name: p.unit for p in reduced.parameters(fit.model)},
        "fixed": [p.name for p in reduced.parameters(fit.model) if p.name not in fit.names],
        "intervals": {p.name: {"low": p.low, "high": p.high, "determined": p.verdict} for p in intervals},
        "records": list(fit.records),
        "rms_velocity_m_s": fit.rms if math.isfinite(fit.rms) else None,
        "step_error_m_s": fit.step_error if math.isfinite(fit.step_error) else None,
        "identification_s": fit.seconds,
        "simulations": fit.simulations,
        "outcome": fit.outcome,
        "reason": fit.reason,
    }


def _saved(entry: Any, where: str) -> SavedFit:
    if not isinstance(entry, dict):
        raise InvalidInput(f"{where} must be an object, but it is {entry!r}.")
    rms = entry.get("rms_velocity_m_s")
    try:
        model = reduced.parse_name(_entry(entry, "model", str, where))
    except InvalidInput as error:
        raise InvalidInput(f"{where}: {error}") from error
    return SavedFit(
        model=model,
        values=_numbers(entry, "values", where),
        mapped=_numbers(entry, "mapped", where),
        fixed=tuple(str(name) for name in _entry(entry, "fixed", list, where)),
        records=tuple(str(name) for name in _entry(entry, "records", list, where)),
        rms_velocity=math.inf if rms is None else _number(rms, f"{where}.rms_velocity_m_s"),
        identification_s=_number(entry.get("identification_s"), f"{where}.identification_s"),
        simulations=_entry(entry, "simulations", int, where),
        outcome=_entry(entry, "outcome", str, where),
        reason=_entry(entry, "reason", str, where),
    )


def _start(content: Mapping[str, Any], where: str) -> Start:
    start: str = _entry(content, "start", str, where)
    if start == "rest":
        return "rest"
    if start == "steady":
        return "steady"
    raise InvalidInput(f"{where}: 'start' must be rest or steady, but it is {start!r}.")


def _entry(content: Mapping[str, Any], key: str, kind: type, where: str) -> Any:
    if key not in content:
        raise InvalidInput(f"{where}: the key {key!r} is missing from the fit file.")
    value = content[key]
    if not isinstance(value, kind):
        raise InvalidInput(f"{where}: {key!r} must be of type {kind.__name__}, but it is {value!r}.")
    return value


def _numbers(content: Mapping[str, Any], key: str, where: str) -> Mapping[str, float]:
    entries = _entry(content, key, dict, where)
    return {str(name): _number(value, f"{where}.{key}.{name}") for name, value in entries.items()}


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InvalidInput(f"{where} must be a finite number, but it is {value!r}.")
    return float(value)
