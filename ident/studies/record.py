"""Synthetic records: any input of the ship and the winch, answered by the reference simulator."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from data_synth import inputs
from data_synth.records import join, read_record, write_record
from data_synth.ships import sample_times, superpose
from ident.configuration import Configuration
from ident.places import new_file
from ident.sections import INPUTS
from ident.settings import Winch, WinchDepth
from ident.studies.simulate import describe
from ident.truth import INPUT, fixes, reference_run, stream, towed, verification
from models.quantity import InvalidInput
from models.spectral import DepthWinch, Payout
from models.trace import Trace

#: Kinds beside those of the configuration's [inputs] sections.
STANDARD, RECORDED_STYLE = "standard", "recorded-style"
_WINCHES = {"winch", "winch-depth"}


def record(
    configuration: Configuration, *, kind: str, duration: float | None, sensor: bool, seed: int, out: Path
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

    Raises
    ------
    InvalidInput
        An unknown kind, two winches, or a place that cannot be written.
    NumericalFailure
        The simulation fails.
    """
    with new_file(out) as temporary:
        if kind == RECORDED_STYLE and duration is not None:
            configuration = replace(configuration, manoeuvre=replace(configuration.manoeuvre, duration=duration))
        if kind == RECORDED_STYLE:
            check = verification(configuration, seed)
            ship, vehicle = check.ship, check.truth
            changes = ", ".join(f"{name} {100.0 * (factor - 1.0):+.0f} %" for name, factor in check.changes.items())
            maker = "the spectral simulator" if check.links is None else f"a fine chain of {check.links} links"
            words = f"the truth of the verification, {maker} with {changes}."
        else:
            kinds = [kind] if Path(kind).is_file() else kind.split("+")
            ship, winch = _motion(configuration, kinds, duration, seed)
            result = reference_run(configuration, ship, winch=winch)
            vehicle, words = result.vehicle, describe(result)
        if sensor:
            vehicle = fixes(configuration, vehicle, seed)
            words = f"fixes every {configuration.sensor.fix_interval:g} s of " + words
        write_record(join(configuration.name, ship, vehicle), temporary)
    return f"{out} written (seed {seed}): {words}"


def _motion(
    configuration: Configuration, kinds: list[str], duration: float | None, seed: int
) -> tuple[Trace, Payout | DepthWinch | None]:
    """The sum of all inputs: the ship's track, and the winch where one is asked for."""
    known = (STANDARD, RECORDED_STYLE, *INPUTS)
    tracks: list[Trace] = []
    winches: list[Payout | DepthWinch] = []
    sample: float | None = None
    for place, kind in enumerate(kinds):
        if kind in _WINCHES:
            settings = _lasting(configuration.inputs[kind], duration)
            winches.append(_winch(settings))
            sample = settings.sample
            length = settings.duration
        elif kind in known:
            settings = {STANDARD: configuration.input, RECORDED_STYLE: configuration.manoeuvre}.get(kind)
            settings = configuration.inputs[kind] if settings is None else settings
            rng = stream(seed, INPUT) if place == 0 else np.random.default_rng([seed, INPUT, place])
            tracks.append(inputs.ship_trace(_lasting(settings, duration), rng))
        elif kind and Path(kind).exists():
            tracks.append(_track(Path(kind), duration))
        else:
            raise InvalidInput(
                f"The input {kind!r} is neither a file nor one of {', '.join(known)}; join several with +."
            )
    if len(winches) > 1:
        raise InvalidInput("A record has one winch, but winch and winch-depth were both given; drop one.")
    if not tracks:
        assert sample is not None
        t = sample_times(length, sample)
        tracks.append(Trace.along_x(t, np.zeros(t.size)))
    ship = tracks[0] if len(tracks) == 1 else superpose(*tracks)
    return towed(configuration.tow, ship), winches[0] if winches else None


def _lasting(settings: Any, duration: float | None) -> Any:
    has = any(field.name == "duration" for field in fields(settings))
    return replace(settings, duration=duration) if duration is not None and has else settings


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
    """A ship's track from a file, from its start and as long as asked, in a plane."""
    ship = read_record(path).ship
    if np.ptp(ship.position[:, 1]) > 1e-6:
        raise InvalidInput(f"{path}: a record is made along x, but this track has y too; use `simulate` for it.")
    if duration is None:
        return ship
    lasts = float(ship.t[-1] - ship.t[0])
    if duration > lasts:
        raise InvalidInput(f"{path} lasts {lasts:g} s, less than the --duration of {duration:g} s; ask for less.")
    keep = ship.t - ship.t[0] <= duration
    return Trace(t=ship.t[keep], position=ship.position[keep])
