"""Motions of the ship: the identification input, the forcing functions, the recorded-style manoeuvres, the turns."""

from data_synth.ships.forcing import FirstOrder, Ramps, Sinusoids, Step, first_order, ramps, sinusoids, step
from data_synth.ships.manoeuvres import (
    FewSinusoids,
    SharpTransients,
    StartsAndStops,
    few_sinusoids,
    sharp_transients,
    starts_and_stops,
)
from data_synth.ships.motion import sample_times, superpose
from data_synth.ships.standard import StandardInput, standard_input
from data_synth.ships.turning import (
    KNOT,
    FullTurn,
    SpeedChanges,
    StraightTow,
    UTurn,
    ZigZag,
    full_turn,
    speed_changes,
    straight_tow,
    u_turn,
    zig_zag,
)
from data_synth.ships.waypoints import Waypoints, waypoints

__all__ = [
    "KNOT",
    "FewSinusoids",
    "FirstOrder",
    "FullTurn",
    "Ramps",
    "SharpTransients",
    "Sinusoids",
    "SpeedChanges",
    "StandardInput",
    "StartsAndStops",
    "Step",
    "StraightTow",
    "UTurn",
    "Waypoints",
    "ZigZag",
    "few_sinusoids",
    "first_order",
    "full_turn",
    "ramps",
    "sample_times",
    "sharp_transients",
    "sinusoids",
    "speed_changes",
    "standard_input",
    "starts_and_stops",
    "step",
    "straight_tow",
    "superpose",
    "u_turn",
    "waypoints",
    "zig_zag",
]
