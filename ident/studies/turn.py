"""The turning study: heave, depth, track and tension of one to three parts in full turns and U-turns (W 3.2)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

import pandas as pd

from ident import scene
from ident.claims import Group, claims, groups
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.places import new_folder
from ident.terminal import Progress
from ident.turning import Turning, TurnRun, run_all, ship_heave
from models.quantity import InvalidInput, NumericalFailure
from models.strumming import strouhal_frequency
from models.tow import refuse_sections_and_thrust
from reports.files import write_json, write_table
from reports.turn_page import TurnGroup, TurnMaterial, write_turn_page

#: Turned by a sweep that does not say: radius [m] and circles.
RADIUS, TURNS = 250.0, 6.0
#: The ship's heave on the straight tow [m] and its periods [s], unless given.
HEAVE, PERIODS = 1.0, (10.0, 60.0)
COLUMNS = (
    "parts",
    "body",
    "length_m",
    "radius_m",
    "speed_m_s",
    "sigma",
    "circle_s",
    "peak_gap_s",
    "period_s",
    "damping_ratio",
    "amplitude_m",
    "depth_m",
    "tow_radius_m",
    "tension_max_N",
    "slack_events",
    "manoeuvre",
    "turns",
    "decay_per_turn",
    "dips",
    "rise_m",
    "dip_s",
    "start_depth_m",
    "deepest_m",
    "drop_m",
    "relaxation_s",
    "fit_percent",
    "plain_fit_percent",
    "tension_start_N",
    "tension_least_N",
    "tension_rate_N_s",
    "snap_peak_N",
    "error_m_s",
    "position_error_m",
    "note",
)
#: The first of them are those of turn.csv; turn-details.csv has them all.
MAIN = 15
_RUN = ("parts", "length_m", "radius_m", "speed_m_s", "manoeuvre", "turns")
PEAK_COLUMNS = (*_RUN, "body", "peak", "t_s", "depth_m", "gap_s", "height_m", "decay")
#: Sections that the study reads; what else the file gives is listed as unused.
_USED = ("", "water", "cable", "vehicle", "towfish", "tow", "current", "tail", "tail.cable", "tail.body", "link-joint")


@dataclass(frozen=True, kw_only=True)
class TurnResult:
    """Where the page is, and the main figures for the terminal."""

    folder: Path
    table: list[dict[str, str]]
    notes: tuple[str, ...]


def turn(
    configuration: Configuration,
    *,
    speeds: Sequence[float] | None = None,
    radii: Sequence[float] | None = None,
    turns: Sequence[float] | None = None,
    u_turn: bool = False,
    parts: Sequence[int] | None = None,
    lengths: Sequence[float] | None = None,
    heave_periods: Sequence[float] = (),
    heave: float = HEAVE,
    out: Path,
    progress: Progress,
) -> TurnResult:
    """Simulate every combination of the lists and write the page; what is left out is as configured.

    Parameters
    ----------
    speeds, radii, lengths
        [m/s], [m], [m].
    turns
        Circles of a full turn; not beside `u_turn`.
    parts
        How many parts are towed.
    heave_periods, heave
        Also a straight tow under ship heave of these periods [s] and this size [m].

    Raises
    ------
    InvalidInput
        The place cannot be written, there is no speed, a value is out of bounds, there are not as many parts, or the
        cable has sections.
    NumericalFailure
        Every simulation fails, or one under ship heave.
    """
    refuse_sections_and_thrust(configuration.tow, "The study of turns")
    for period in heave_periods:
        if not 1.0 <= period <= 3600.0:
            raise InvalidInput(
                f"A period of the ship's heave must be at least 1 s and at most 3600 s, but it is {period:g} s."
            )
    if u_turn and turns:
        raise InvalidInput("A U-turn is half a circle; leave out either the number of turns or the U-turn.")
    if not speeds and configuration.tow.speed == 0.0:
        raise InvalidInput(f"{configuration.source} has no [tow] speed; give the speed of the turn.")
    turnings = tuple(
        Turning(parts=n, length=length, radius=radius, speed=speed, turns=circles)
        for n, length, radius, speed, circles in product(
            parts or (1 + len(configuration.tails),),
            lengths or (configuration.tow.cable.length,),
            radii or (RADIUS,),
            speeds or (configuration.tow.speed,),
            (0.5,) if u_turn else turns or (TURNS,),
        )
    )
    chosen = (Group(title="Turns", turnings=turnings),)
    counts = sorted({turning.parts for turning in turnings})
    shakes = [(n, turnings[0].speed, heave, period) for n in counts for period in heave_periods]
    return _study(configuration, chosen, shakes, answer=False, out=out, progress=progress)


def answer_claims(
    configuration: Configuration,
    *,
    heave_periods: Sequence[float] = PERIODS,
    heave: float = HEAVE,
    out: Path,
    progress: Progress,
) -> TurnResult:
    """Simulate the sweeps of `ident.claims` and set what W says beside what they show.

    Raises
    ------
    InvalidInput
        The place cannot be written.
    NumericalFailure
        Every simulation fails, or one under ship heave.
    """
    chosen = groups(configuration)
    speed = chosen[0].turnings[0].speed
    counts = [turning.parts for turning in chosen[0].turnings]
    shakes = [(n, speed, heave, period) for n in counts for period in heave_periods]
    return _study(configuration, chosen, shakes, answer=True, out=out, progress=progress)


def _study(
    configuration: Configuration,
    chosen: Sequence[Group],
    shakes: Sequence[tuple[int, float, float, float]],
    *,
    answer: bool,
    out: Path,
    progress: Progress,
) -> TurnResult:
    """Run all turns once, whatever the number of groups that show them, and write page and tables."""
    for count in {turning.parts for group in chosen for turning in group.turnings}:
        configuration.system_of(count)
    with new_folder(out) as folder:
        wanted = tuple(dict.fromkeys(turning for group in chosen for turning in group.turnings))
        runs = dict(zip(wanted, run_all(configuration, wanted, progress, 0.0, 0.8), strict=True))
        if all(run.history is None for run in runs.values()):
            raise NumericalFailure(str(runs[wanted[0]].rows[0]["note"]))
        table = _frame([row for run in runs.values() for row in run.rows], COLUMNS)
        peaks = _frame([row for run in runs.values() for row in run.peaks], PEAK_COLUMNS)
        shaken: list[dict[str, object]] = []
        for i, (count, speed, size, period) in enumerate(shakes):
            progress(f"ship heave of {period:g} s", 0.8 + 0.1 * i / len(shakes))
            shaken += ship_heave(configuration, parts=count, speed=speed, amplitude=size, period=period)
        heave = pd.DataFrame(shaken)
        verdicts = claims(configuration, table, heave) if answer else pd.DataFrame()
        progress("drawing the page", 0.9)
        made = manifest("turn", configuration, None)
        write_turn_page(
            folder,
            TurnMaterial(
                title=f"{configuration.name}: turning study",
                description=configuration.description,
                groups=[_group(group, runs) for group in chosen],
                claims=verdicts,
                ship_heave=heave,
                configuration=scene.configuration_table(configuration),
                configuration_text=configuration.text,
                left_out=_left_out(configuration),
                unused=scene.unused(configuration, configuration.unused_beside(_USED)),
                manifest=made,
            ),
        )
        write_table(folder / "turn.csv", table[list(COLUMNS[:MAIN])])
        write_table(folder / "turn-details.csv", table)
        write_table(folder / "peaks.csv", peaks)
        if len(heave):
            write_table(folder / "ship-heave.csv", heave)
        if len(verdicts):
            write_table(folder / "claims.csv", verdicts)
        write_json(folder / "manifest.json", made)
        progress("done", 1.0)
    failed = tuple(str(run.rows[0]["note"]) for run in runs.values() if run.history is None)
    return TurnResult(folder=out, table=_terminal(verdicts if answer else table), notes=failed)


def _left_out(configuration: Configuration) -> list[tuple[str, str]]:
    """The effects that a turn is simulated without, each with why."""
    missing = [
        ("bending and torsion of the cable", "the links are joined freely: nothing is said of twist at a body"),
        ("attitude of the bodies", "each is a joint with three degrees of freedom (W section 2)"),
        ("winch", "the cable keeps its length"),
        ("sea state", "the ship turns at a level height"),
    ]
    if configuration.link_joint.strumming:
        shedding = strouhal_frequency(configuration.tow.cable, configuration.tow.speed)
        missing.append(
            (
                "oscillating part of the strumming drag",
                f"at {shedding:.0f} Hz across the tow it averages out over a step",
            )
        )
    else:
        missing.append(("strumming", "no drag amplification is asked for"))
    if configuration.tow.current is None:
        missing.append(("current", "the configuration has no [current]"))
    return missing


def _frame(rows: list[dict[str, object]], columns: Sequence[str]) -> pd.DataFrame:
    """The rows under the given columns, what a row does not have left empty."""
    return pd.DataFrame(rows, columns=list(columns))


def _group(group: Group, runs: dict[Turning, TurnRun]) -> TurnGroup:
    """The runs of a group under labels that say what tells them apart."""
    labels = _labels(group.turnings)
    own = [runs[turning] for turning in group.turnings]
    rows = [row | {"run": label} for run, label in zip(own, labels, strict=True) for row in run.rows]
    peaks = [row | {"run": label} for run, label in zip(own, labels, strict=True) for row in run.peaks]
    full = [turning for turning in group.turnings if not turning.u_turn]
    swept = {
        "ratio": len({turning.radius for turning in full}) > 1,
        "speed_m_s": len({turning.speed for turning in full}) > 1,
        "length_m": (longer := len({turning.length for turning in full}) > 1),
        "sigma": longer,
    }
    return TurnGroup(
        title=group.title,
        turns=_frame(rows, ("run", *COLUMNS)),
        peaks=_frame(peaks, ("run", *PEAK_COLUMNS)),
        histories=[
            replace(run.history, label=label) for run, label in zip(own, labels, strict=True) if run.history is not None
        ],
        over=tuple(name for name, many in swept.items() if many),
    )


def _labels(turnings: Sequence[Turning]) -> list[str]:
    """What tells each turn from the others; all of it for one alone."""
    told = {
        "parts": lambda turning: f"{turning.parts} part{'' if turning.parts == 1 else 's'}",
        "length": lambda turning: f"{turning.length:g} m",
        "radius": lambda turning: f"R = {turning.radius:g} m",
        "speed": lambda turning: f"{turning.knots:.3g} kn",
        "turns": lambda turning: "U-turn" if turning.u_turn else f"{turning.turns:g} circles",
    }
    differ = [name for name in told if len({getattr(turning, name) for turning in turnings}) > 1] or list(told)
    return [", ".join(told[name](turning) for name in differ) for turning in turnings]


def _terminal(table: pd.DataFrame) -> list[dict[str, str]]:
    """The table as text: claims as they are, of the runs the columns of the paper's quantities."""
    if "verdict" in table:
        return [{key: str(row[key]) for key in ("about", "verdict", "ours")} for row in table.to_dict("records")]
    names = [name for name in COLUMNS[:MAIN] if name not in ("sigma", "amplitude_m")]
    return [
        {
            name: value if isinstance(value, str) else "" if value != value else f"{float(value):.5g}"
            for name in names
            for value in [row[name]]
        }
        for row in table.to_dict("records")
    ]
