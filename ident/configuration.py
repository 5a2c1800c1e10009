"""A configuration: one cable with its vehicle, water and settings, read from TOML and checked key by key."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

from data_synth import sensors, ships
from data_synth.inputs import ShipInput
from ident.builtin import builtin_names, builtin_text, find, template
from ident.reading import ConfigurationFile
from ident.sections import INPUTS, MANOEUVRES, SECTIONS, without_number
from ident.settings import (
    BodeSettings,
    CompensatorSettings,
    Heading,
    IdentificationSettings,
    LinkJointSettings,
    ScoringSettings,
    SpectralSettings,
    StepSettings,
    VerificationSettings,
    Winch,
    WinchDepth,
)
from ident.tow import read_tails, read_tow
from models.quantity import InvalidInput
from models.tow import Tow
from models.towed_system import Part, TowedSystem

__all__ = ["Configuration", "builtin_names", "builtin_text", "load", "template"]

Manoeuvre = ships.StartsAndStops | ships.SharpTransients | ships.FewSinusoids
InputSettings = ShipInput | Winch | WinchDepth

#: The sections that ``cable-ident run`` has no use for, and keys of others: its chain is resolved by [verification].
_NOT_IN_RUN = ("step", "compensator", *(f"inputs.{kind}" for kind in INPUTS))
_IDLE_IN_RUN = ("link-joint.links", "link-joint.tolerance_m_s", "link-joint.step_s")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Configuration:
    """All that a command needs to know.

    `text` is the TOML as used, from which `from_text` makes the same configuration again; `given` and `guesses`
    are dotted keys such as ``cable.length_m``, those in the text and those of them that nobody measured. `tow` is the
    first part of the system alone, `tails` are the parts after it.
    """

    name: str
    source: str
    text: str
    given: tuple[str, ...]
    description: str
    guesses: tuple[str, ...]
    tow: Tow
    tails: tuple[Part, ...]
    compensator: CompensatorSettings
    spectral: SpectralSettings
    link_joint: LinkJointSettings
    input: ships.StandardInput
    scoring: ScoringSettings
    verification: VerificationSettings
    manoeuvre: Manoeuvre
    sensor: sensors.SensorModel
    identification: IdentificationSettings
    step: StepSettings
    bode: BodeSettings
    inputs: Mapping[str, InputSettings]

    @classmethod
    def from_text(cls, text: str, name: str, source: str) -> Self:
        """Read and check a configuration.

        Parameters
        ----------
        text
            The TOML.
        name
            What results are called after.
        source
            Where the text came from, the beginning of every message.

        Raises
        ------
        InvalidInput
            Malformed TOML; an unknown or missing key; a value of the wrong type, not finite or out of bounds; parts
            that contradict each other.
        """
        file = ConfigurationFile(text, source)
        heading = file.fill("", Heading)
        tow = read_tow(file)
        made = cls(
            name=name,
            source=source,
            text=text,
            given=file.given,
            description=heading.description,
            guesses=file.checked_guesses(heading.guesses),
            tow=tow,
            tails=read_tails(file, tow.water_density),
            compensator=file.fill("compensator", CompensatorSettings),
            spectral=file.fill("spectral", SpectralSettings),
            link_joint=file.fill("link-joint", LinkJointSettings),
            input=file.fill("input", ships.StandardInput),
            scoring=file.fill("input", ScoringSettings),
            verification=(verification := file.fill("verification", VerificationSettings)),
            manoeuvre=file.fill("verification", MANOEUVRES[verification.kind]),
            sensor=file.fill("sensor", sensors.SensorModel),
            identification=_identification(file),
            step=file.fill("step", StepSettings),
            bode=file.fill("bode", BodeSettings),
            inputs={kind: file.fill(f"inputs.{kind}", settings) for kind, settings in INPUTS.items()},
        )
        if made.tails:
            made.system_of()  # what is wrong with the parts together is said here, not in the middle of a study
        return made

    def system_of(self, parts: int | None = None) -> TowedSystem:
        """The towed system in three dimensions, or its first `parts`.

        Raises
        ------
        InvalidInput
            There are not as many parts, or they do not make a system.
        """
        count = 1 + len(self.tails)
        if parts is not None and not 1 <= parts <= count:
            given = "1 part" if count == 1 else f"1 to {count} parts"
            raise InvalidInput(f"{self.source} can be towed with {given}, but {parts} were asked for.")
        chain = self.link_joint
        try:
            return replace(
                TowedSystem.from_tow(self.tow, self.tails[: None if parts is None else parts - 1]),
                drag_law=chain.drag_law,
                strumming=chain.strumming,
                strumming_damping=chain.strumming_damping,
            )
        except InvalidInput as error:
            raise InvalidInput(f"{self.source}: {error}") from error

    @property
    def system(self) -> TowedSystem:
        """All parts of the towed system."""
        return self.system_of()

    @property
    def unused(self) -> tuple[str, ...]:
        """The given keys that ``cable-ident run`` does not use."""
        return self.unused_beside(set(SECTIONS) - set(_NOT_IN_RUN), idle=_IDLE_IN_RUN)

    def unused_beside(self, used: Collection[str], idle: Sequence[str] = ()) -> tuple[str, ...]:
        """The given keys outside the sections that a study uses, the `idle` ones, and a delay that no model has."""
        delayed = any(name.startswith(("second-order", "first-order")) for name in self.identification.models)
        idle = (*idle, *(() if delayed else ("identification.delay",)))
        return tuple(key for key in self.given if without_number(key.rpartition(".")[0]) not in used or key in idle)


def load(name_or_path: str) -> Configuration:
    """The configuration of a built-in name, else of a file; ``./NAME`` is always a file.

    Raises
    ------
    InvalidInput
        No such name or file, or the file is not a valid configuration.
    """
    source = find(name_or_path)
    return Configuration.from_text(source.text, source.name, source.origin)


def model_names(names: Sequence[str]) -> tuple[str, ...]:
    """Names of reduced models in full, such as ``inertial-4-linear`` for ``inertial-linear``.

    Raises
    ------
    InvalidInput
        A name is not that of a model, or a model is there twice.
    """
    from models.reduced import parse_name

    full: list[str] = []
    for name in names:
        if parse_name(name) in full:
            raise InvalidInput(f"models must differ, but {name} is there twice; drop one.")
        full.append(parse_name(name))
    return tuple(full)


def _identification(file: ConfigurationFile) -> IdentificationSettings:
    settings = file.fill("identification", IdentificationSettings)
    return replace(settings, models=file.build("identification", model_names, {"names": settings.models}))
