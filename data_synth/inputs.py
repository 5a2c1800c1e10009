"""Every kind of ship input by its name."""

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np

from data_synth import seas, ships
from models.trace import Trace

ShipInput: TypeAlias = (
    ships.StandardInput
    | ships.Sinusoids
    | ships.Ramps
    | ships.FirstOrder
    | ships.Step
    | ships.StartsAndStops
    | ships.SharpTransients
    | ships.FewSinusoids
    | ships.StraightTow
    | ships.FullTurn
    | ships.UTurn
    | ships.SpeedChanges
    | ships.ZigZag
    | ships.Waypoints
    | seas.RandomSea
)

#: Name of a kind, as on the command line and in configuration files, to the type of its settings.
KINDS: Mapping[str, type[ShipInput]] = {
    "standard": ships.StandardInput,
    "sinusoids": ships.Sinusoids,
    "ramps": ships.Ramps,
    "first-order": ships.FirstOrder,
    "step": ships.Step,
    "starts-and-stops": ships.StartsAndStops,
    "sharp-transients": ships.SharpTransients,
    "few-sinusoids": ships.FewSinusoids,
    "straight": ships.StraightTow,
    "full-turn": ships.FullTurn,
    "u-turn": ships.UTurn,
    "speed-changes": ships.SpeedChanges,
    "zig-zag": ships.ZigZag,
    "waypoints": ships.Waypoints,
    "sea": seas.RandomSea,
}

_DRAWN: Mapping[type, Callable[[Any, np.random.Generator], Trace]] = {
    ships.StandardInput: ships.standard_input,
    seas.RandomSea: seas.random_sea,
}
_FIXED: Mapping[type, Callable[[Any], Trace]] = {
    ships.Sinusoids: ships.sinusoids,
    ships.Ramps: ships.ramps,
    ships.FirstOrder: ships.first_order,
    ships.Step: ships.step,
    ships.StartsAndStops: ships.starts_and_stops,
    ships.SharpTransients: ships.sharp_transients,
    ships.FewSinusoids: ships.few_sinusoids,
    ships.StraightTow: ships.straight_tow,
    ships.FullTurn: ships.full_turn,
    ships.UTurn: ships.u_turn,
    ships.SpeedChanges: ships.speed_changes,
    ships.ZigZag: ships.zig_zag,
    ships.Waypoints: ships.waypoints,
}


def ship_trace(settings: ShipInput, rng: np.random.Generator) -> Trace:
    """The ship's motion for any settings; kinds without chance leave `rng` alone."""
    kind = type(settings)
    return _DRAWN[kind](settings, rng) if kind in _DRAWN else _FIXED[kind](settings)
