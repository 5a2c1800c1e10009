"""The plain arrays of one record, as the figures need them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from models.quantity import InvalidInput

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RecordSeries:
    """One record along the axis of motion: the ship, the true or observed vehicle, and what each model makes of it.

    Parameters
    ----------
    record
        Name as in the score table's column ``record``.
    t
        (n,) [s].
    ship_position, ship_velocity
        (n,) [m], [m/s].
    vehicle_position, vehicle_velocity
        (n,) [m], [m/s] of the truth or the observation; NaN where there is none.
    model_position, model_velocity
        Model name to (n,) [m], [m/s], comparable with the vehicle's (through the same sensor operator where
        there is one). A baseline may have a position alone.
    scored_from
        [s] start of the scored window; it ends with the record.
    description
        What the record is, in a sentence or two.
    vehicle_label
        What the vehicle's series is, for legends.

    Raises
    ------
    InvalidInput
        An array has not the length of `t`.
    """

    record: str
    t: Floats
    ship_position: Floats
    ship_velocity: Floats
    vehicle_position: Floats
    vehicle_velocity: Floats
    model_position: Mapping[str, Floats] = field(default_factory=dict)
    model_velocity: Mapping[str, Floats] = field(default_factory=dict)
    scored_from: float = 0.0
    description: str = ""
    vehicle_label: str = "vehicle, reference"

    def __post_init__(self) -> None:
        arrays = {
            "ship_position": self.ship_position,
            "ship_velocity": self.ship_velocity,
            "vehicle_position": self.vehicle_position,
            "vehicle_velocity": self.vehicle_velocity,
            **{f"model_position[{name}]": value for name, value in self.model_position.items()},
            **{f"model_velocity[{name}]": value for name, value in self.model_velocity.items()},
        }
        for name, value in arrays.items():
            if value.shape != self.t.shape:
                raise InvalidInput(
                    f"RecordSeries {self.record} needs {name} of the shape {self.t.shape} of t, "
                    f"but it has {value.shape}."
                )

    @property
    def models(self) -> list[str]:
        """Names of the models and baselines, in order."""
        return list(dict.fromkeys([*self.model_velocity, *self.model_position]))

    @property
    def scored(self) -> NDArray[np.bool_]:
        """(n,) whether the sample lies in the scored window."""
        return self.t >= self.scored_from


def require_columns(frame: pd.DataFrame, columns: Sequence[str], what: str) -> None:
    """Raise `InvalidInput` when a table that is not empty lacks a column."""
    missing = [name for name in columns if name not in frame.columns]
    if len(frame) and missing:
        raise InvalidInput(
            f"{what} needs the columns {', '.join(columns)}, but {', '.join(missing)} "
            f"{'is' if len(missing) == 1 else 'are'} missing from {', '.join(map(str, frame.columns))}."
        )
