"""Motions of the ship: the identification input, the forcing functions, the recorded-style manoeuvres."""

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

__all__ = [
    "FewSinusoids",
    "FirstOrder",
    "Ramps",
    "SharpTransients",
    "Sinusoids",
    "StandardInput",
    "StartsAndStops",
    "Step",
    "few_sinusoids",
    "first_order",
    "ramps",
    "sample_times",
    "sharp_transients",
    "sinusoids",
    "standard_input",
    "starts_and_stops",
    "step",
    "superpose",
]
