"""Synthetic records: any input of the ship and the winch, answered by the simulator that it needs."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from data_synth import inputs
from data_synth.records import Record, join, read_record, write_record
from data_synth.ships import sample_times, superpose
from ident.configuration import Configuration
from ident.places import new_file
from ident.sections import INPUTS
from ident.settings import Winch, WinchDepth
from ident.simulators import Reference, answer, describe_chain, ends, needed, recorded
from ident.truth import INPUT, fixes, stream, towed, verification
from models.drive import Start
from models.quantity import InvalidInput
from models.spectral import DepthWinch, Payout
from models.trace import Trace

#: Kinds beside those of the configuration's [inputs] sections.
STANDARD, RECORDED_STYLE = "standard", "recorded-style"
KNOWN = (STANDARD, RECORDED_STYLE, *INPUTS)
#: Kinds of a ship that is under way from the first instant.
UNDER_WAY = {"straight", "full-turn", "u-turn", "speed-changes", "zig-zag", "waypoints"}
_WINCHES = {"winch", "winch-depth"}


def record(
    configuration: Configuration,
    *,
    kind: str,
    duration: float | None,
    sensor: bool,
    seed: int,
    out: Path,
    reference: Reference | None,
) -> str:
    """Make a record and write it; says in a sentence what was done.

    Parameters
    ----------
    kind
        Kinds of input or files of ship tracks, joined by ``+``.
    duration
        Length of every made input [s], as configured when left out.
    sensor
        Write what the sensor sees of the vehicle instead of its true track.
    reference
        The simulator; by what the input needs when left out: the link-joint chain for manoeuvres under way, tracks off
        a plane and systems of several parts, the spectral simulator for the rest.

    Raises
    ------
    InvalidInput
        An unknown kind, two winches, a duration for a kind that has none, or a place that cannot be written.
    NumericalFailure
        The simulation fails.
    """
    with new_file(out) as temporary:
        if kind == RECORDED_STYLE:
            found, words = _truth(configuration, duration, seed, reference)
        else:
            kinds = [kind] if Path(kind).is_file() else kind.split("+")
            ship, winch = _motion(configuration, kinds, duration, seed)
            # A file's ship is under way too; to the motions of the other kinds the tow's own way is added.
            under_way = not set(kinds) <= set(KNOWN) - UNDER_WAY
            track = Record(name=kind, ship=ship if under_way else towed(configuration.tow, ship))
            chosen = reference or ("link-joint" if UNDER_WAY & set(kinds) else needed(configuration, track))
            start: Start = "steady" if under_way else "rest"
            found, words = answer(configuration, track, chosen, start=start, winch=winch)
        if sensor:
            assert found.vehicle is not None
            seen = fixes(configuration, found.vehicle, seed)
            found = join(configuration.name, found.ship, seen)
            words = f"fixes every {configuration.sensor.fix_interval:g} s of {words}"
        write_record(found, temporary)
    return f"{out} written (seed {seed}): {words}"


def _truth(
    configuration: Configuration, duration: float | None, seed: int, reference: Reference | None
) -> tuple[Record, str]:
    """The verification's truth, as a run makes it."""
    if reference == "spectral":
        raise InvalidInput(
            f"The input {RECORDED_STYLE} alone is the truth of a verification, which the link-joint simulator makes; "
            "leave out --reference spectral."
        )
    if duration is not None:
        configuration = replace(configuration, manoeuvre=replace(configuration.manoeuvre, duration=duration))
    check = verification(configuration, seed)
    words = f"the truth of the verification, {check.changed}, by the link-joint simulator with "
    bodies = ends(configuration, check.chain)
    return recorded(configuration.name, check.ship, bodies), words + describe_chain(check.chain)


def _motion(
    configuration: Configuration, kinds: list[str], duration: float | None, seed: int
) -> tuple[Trace, Payout | DepthWinch | None]:
    """The sum of all inputs: the ship's track, and the winch where one is asked for."""
    tracks: list[Trace] = []
    winches: list[Payout | DepthWinch] = []
    sample: float | None = None
    for place, kind in enumerate(kinds):
        if kind in _WINCHES:
            settings = _lasting(kind, configuration.inputs[kind], duration)
            winches.append(_winch(settings))
            sample = settings.sample
            length = settings.duration
        elif kind in KNOWN:
            settings = {STANDARD: configuration.input, RECORDED_STYLE: configuration.manoeuvre}.get(kind)
            settings = configuration.inputs[kind] if settings is None else settings
            rng = stream(seed, INPUT) if place == 0 else np.random.default_rng([seed, INPUT, place])
            tracks.append(inputs.ship_trace(_lasting(kind, settings, duration), rng))
        elif kind and Path(kind).exists():
            tracks.append(_track(Path(kind), duration))
        else:
            raise InvalidInput(
                f"The input {kind!r} is neither a file nor one of {', '.join(KNOWN)}; join several with +."
            )
    if len(winches) > 1:
        raise InvalidInput("A record has one winch, but winch and winch-depth were both given; drop one.")
    if not tracks:
        assert sample is not None
        t = sample_times(length, sample)
        tracks.append(Trace.along_x(t, np.zeros(t.size)))
    ship = tracks[0] if len(tracks) == 1 else superpose(*tracks)
    return ship, winches[0] if winches else None


def _lasting(kind: str, settings: Any, duration: float | None) -> Any:
    """The settings with another duration."""
    if duration is None:
        return settings
    if not any(field.name == "duration" for field in fields(settings)):
        raise InvalidInput(
            f"The input {kind} has no duration: it lasts as long as its way takes. Leave out --duration, or change "
            f"[inputs.{kind}]."
        )
    return replace(settings, duration=duration)


def _winch(settings: Winch | WinchDepth) -> Payout | DepthWinch:
    times = np.asarray(settings.times, dtype=float)
    if isinstance(settings, WinchDepth):
        return DepthWinch(
            t=times,
            change=np.asarray(settings.depth_changes, dtype=float),
            proportional=settings.proportional_gain,
            integral=settings.integral_gain,
            rate_limit=settings.rate_limit,
            acceleration_limit=settings.acceleration_limit,
        )
    ends = np.append(times, max(settings.duration, times[-1] + 1.0))
    lengths = np.concatenate([[0.0], np.cumsum(np.asarray(settings.rates, dtype=float) * np.diff(ends))])
    if ends[0] > 0.0:
        ends, lengths = np.concatenate([[0.0], ends]), np.concatenate([[0.0], lengths])
    return Payout(t=ends, length=lengths)


def _track(path: Path, duration: float | None) -> Trace:
    """A ship's track from a file, from its start and as long as asked."""
    ship = read_record(path).ship
    if duration is None:
        return ship
    lasts = float(ship.t[-1] - ship.t[0])
    if duration > lasts:
        raise InvalidInput(f"{path} lasts {lasts:g} s, less than the --duration of {duration:g} s; ask for less.")
    keep = ship.t - ship.t[0] <= duration
    return Trace(t=ship.t[keep], position=ship.position[keep])
