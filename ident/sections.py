"""Which dataclass each section of a configuration file fills: the whole list of accepted keys."""

import re
from collections.abc import Mapping
from dataclasses import replace

from data_synth import seas, sensors, ships
from ident.schema import Key, keys_of
from ident.settings import (
    BodeSettings,
    CompensatorSettings,
    CurrentProfile,
    Heading,
    IdentificationSettings,
    LinkJointSettings,
    Material,
    ScoringSettings,
    SpectralSettings,
    StepSettings,
    VerificationSettings,
    Winch,
    WinchDepth,
)
from models.body import Body
from models.cable import Cable
from models.tow import Tow
from models.towed_system import Part
from models.vehicle import Towfish, Vehicle

#: A cable is given by one of these groups of fields, whole.
BY_MATERIAL = ("density", "young_modulus")
BY_LENGTH = ("mass", "weight_in_water", "axial_stiffness")

#: The manoeuvre that each kind of verification record makes.
MANOEUVRES: Mapping[str, type] = {
    "starts-and-stops": ships.StartsAndStops,
    "sharp-transients": ships.SharpTransients,
    "few-sinusoids": ships.FewSinusoids,
}

#: The numbers of each kind of input that ``cable-ident record`` makes, beside the standard and the recorded style.
INPUTS: Mapping[str, type] = {
    "sinusoids": ships.Sinusoids,
    "ramps": ships.Ramps,
    "first-order": ships.FirstOrder,
    "step": ships.Step,
    "straight": ships.StraightTow,
    "full-turn": ships.FullTurn,
    "u-turn": ships.UTurn,
    "speed-changes": ships.SpeedChanges,
    "zig-zag": ships.ZigZag,
    "waypoints": ships.Waypoints,
    "sea": seas.RandomSea,
    "winch": Winch,
    "winch-depth": WinchDepth,
}


def _cable_keys() -> tuple[Key, ...]:
    keys = (*keys_of(Cable, renamed={"mass": "mass_per_length"}), *keys_of(Material))
    return tuple(replace(key, required=key.required and key.field not in BY_MATERIAL + BY_LENGTH) for key in keys)


def _section_keys() -> tuple[Key, ...]:
    """Those of the cable: what a further length of cable does not say, it takes from the cable."""
    return tuple(replace(key, required=key.field == "length") for key in _cable_keys())


#: Section to its keys; the empty name stands for the keys above the first section.
SECTIONS: Mapping[str, tuple[Key, ...]] = {
    "": keys_of(Heading),
    "water": keys_of(Tow, only=("water_density",), renamed={"water_density": "density"}),
    "cable": _cable_keys(),
    "section": _section_keys(),
    "vehicle": keys_of(Vehicle),
    "towfish": keys_of(Towfish),
    "tow": keys_of(Tow, only=("speed",)),
    "current": keys_of(CurrentProfile),
    "tail": keys_of(Part, only=("name", "after")),
    "tail.cable": _cable_keys(),
    "tail.body": keys_of(Body),
    "compensator": keys_of(CompensatorSettings),
    "link-joint": keys_of(LinkJointSettings),
    "spectral": keys_of(SpectralSettings),
    "input": (*keys_of(ships.StandardInput), *keys_of(ScoringSettings)),
    "verification": keys_of(VerificationSettings),
    "sensor": keys_of(sensors.SensorModel, renamed={"window": "differentiator"}),
    "identification": keys_of(IdentificationSettings),
    "step": keys_of(StepSettings),
    "bode": keys_of(BodeSettings),
    **{f"inputs.{kind}": keys_of(settings) for kind, settings in INPUTS.items()},
}


def without_number(section: str) -> str:
    """The name in `SECTIONS` of a section as it is counted in a file: ``tail.cable`` for ``tail.2.cable``."""
    return re.sub(r"^(tail|section)\.\d+", r"\1", section)


def keys_for(section: str, table: Mapping[str, object]) -> tuple[Key, ...]:
    """The keys of a section as it stands in a file: the kind of [verification] brings its manoeuvre's keys."""
    if section != "verification":
        return SECTIONS[without_number(section)]
    manoeuvre = MANOEUVRES.get(str(table.get("kind", VerificationSettings().kind)))
    return (*SECTIONS[section], *(keys_of(manoeuvre) if manoeuvre else ()))
