"""The response study: motions and tensions of a tow over frequency by the matrix method (H sections II and IV)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ident import response_scene, scene
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.places import new_folder
from ident.printed_responses import AMPLITUDE, beside_paper, explanation, printed_marks
from ident.response_checks import (
    FLOW,
    MAP_SEGMENTS,
    NO_CURRENT,
    SMALL,
    agreement_table,
    almost_undamped,
    conventions_table,
    digits_table,
    in_flow,
    other_area,
    refinement_table,
    without_current,
)
from ident.response_tables import (
    bends_table,
    details_table,
    peaks_table,
    response_table,
    slack_ratio,
    statics_table,
)
from ident.slow_motion import slow_table
from ident.terminal import Progress
from models.quantity import InvalidInput
from models.statics import StaticShape, length_for_depth
from models.tow import Tow
from models.transfer_matrix import COARSE, Direction, DragForm, Response, Solver, frequency_response
from reports.figures.cable_motion import CableMotion
from reports.files import write_json, write_table
from reports.response_material import ResponseMaterial
from reports.response_page import write_response_page

#: Fewest frequencies that a peak can be found among, and the most.
_LEAST, _MOST = 3, 20_000
_WORDS = {"axial": "along itself", "heave": "up and down", "surge": "to and fro"}
_AREAS = {"diameter": "on d", "circumference": "on pi d"}
#: Sections that the study reads; what else the file gives is listed as unused.
_USED = ("", "water", "cable", "section", "vehicle", "towfish", "tow", "current")


@dataclass(frozen=True, kw_only=True)
class ResponseResult:
    """Where the page is, and the peaks for the terminal."""

    folder: Path
    table: list[dict[str, str]]
    notes: tuple[str, ...]


def response(
    configuration: Configuration,
    *,
    amplitude: float,
    low: float,
    high: float,
    points: int = 100,
    direction: Direction = "axial",
    drag: DragForm = "consistent",
    solver: Solver = "stable",
    segments: int | None = None,
    depth: float | None = None,
    tolerance: float = 1e-10,
    out: Path,
    progress: Progress,
) -> ResponseResult:
    """Compute the response to harmonic motion of the cable's top and write the page.

    Parameters
    ----------
    amplitude
        Of the top's motion [m].
    low, high, points
        Equally spaced frequencies, both ends among them [rad/s].
    depth
        The upper cable gets the length that puts the vehicle there [m]; as configured when left out.
    segments
        Of the cable, spread by its shape; as the method sees fit when left out.
    tolerance
        Of the iteration of the damping, the paper's norm.

    Raises
    ------
    InvalidInput
        The place cannot be written, or a value is out of bounds.
    NumericalFailure
        There is no static shape, or the solve fails.
    """
    omega = _frequencies(low, high, points)
    tow = configuration.tow if depth is None else length_for_depth(configuration.tow, depth)
    settings: dict[str, Any] = {
        "amplitude": amplitude,
        "direction": direction,
        "drag": drag,
        "tolerance": tolerance,
    }
    with new_folder(out) as folder:
        progress("response", 0.0)
        own = frequency_response(tow, omega, solver=solver, segments=segments, **settings)
        again = {**settings, "nodes": own.shape.s, "companion": False}
        progress("other conventions", 0.2)
        others = _others(tow, omega, again)
        still = others[-1][1]
        progress("mode shapes", 0.4)
        peaks = peaks_table(own)
        modes = response_scene.modes(peaks_table(still))
        motions = [_motions(tow, modes, again), _motions(tow, modes, again, at=_middle(omega))]
        progress("segments", 0.5)
        refinement = refinement_table(tow, own, settings)
        progress("product of matrices", 0.7)
        passed, plain = in_flow(tow), {name: settings[name] for name in ("amplitude", "direction", "drag")}
        kept = digits_table(passed, omega, plain)
        agreement = agreement_table(passed, omega, own.shape.s, plain)
        slow = slow_table(tow)
        progress("drawing the page", 0.9)
        runs = [(f"C_t {_AREAS[tow.cable.tangential_area]} (this run)", own), *others]
        name = configuration.name if depth is None else ""
        paper = amplitude == AMPLITUDE and (direction == "axial" or (direction == "heave" and _hangs(own.shape)))
        made = manifest(
            "response",
            configuration,
            None,
            **settings,
            low=low,
            high=high,
            points=points,
            solver=solver,
            segments=own.shape.s.size - 1,
            depth=depth,
        )
        details, table = details_table(own), conventions_table(runs)
        printed = beside_paper(name, runs, dynamic=paper)
        write_response_page(
            folder,
            ResponseMaterial(
                title=f"{configuration.name}: response",
                description=configuration.description,
                amplitude=amplitude,
                direction=_WORDS[direction],
                statics=statics_table(own.shape),
                state=response_scene.state(tow, own.shape, changed=depth is not None),
                towed=response_scene.towed(tow, own.shape),
                parts=response_scene.parts(tow),
                curves=[(f"{amplitude:g} m", details), ("almost undamped", details_table(still))],
                peaks=peaks,
                conventions=table,
                conventions_words=_conventions_words(tow, omega),
                printed=printed,
                printed_marks=printed_marks(name, dynamic=paper),
                printed_words=explanation(printed),
                modes=motions[0],
                still_modes=motions[1],
                at_peaks=_motions(tow, response_scene.modes(peaks) or _spread(omega), again),
                slack_omega=own.omega,
                slack_s=own.shape.s,
                slack_ratio=slack_ratio(own),
                bends=bends_table(own.shape),
                errors=response_scene.errors(own),
                refinement=refinement,
                kept=kept,
                agreement=agreement,
                lengths_of="Cable" if not tow.sections else "Upper cable",
                flow=0.0 if passed is tow else FLOW,
                slow=slow,
                map_segments=MAP_SEGMENTS,
                configuration=scene.configuration_table(configuration),
                configuration_text=configuration.text,
                left_out=response_scene.left_out(configuration),
                unused=scene.unused(configuration, configuration.unused_beside(_USED)),
                manifest=made,
            ),
        )
        write_table(folder / "response.csv", response_table(own))
        write_table(folder / "response-details.csv", details)
        write_table(folder / "statics.csv", statics_table(own.shape))
        write_table(folder / "peaks.csv", peaks)
        write_table(folder / "conventions.csv", table)
        write_table(folder / "segments.csv", refinement)
        write_table(folder / "digits.csv", kept)
        write_table(folder / "slow-motion.csv", slow)
        if len(printed):
            write_table(folder / "printed.csv", printed)
        write_json(folder / "manifest.json", made)
        progress("done", 1.0)
    return ResponseResult(folder=out, table=_terminal(peaks), notes=_notes(own))


def _frequencies(low: float, high: float, points: int) -> np.ndarray:
    if not (0.0 < low < high < np.inf):
        raise InvalidInput(
            f"The frequencies must go from one above 0 rad/s to a higher one, but they are to go from {low:g} to "
            f"{high:g} rad/s. At rest there is no response: take a small frequency for its limit."
        )
    if not _LEAST <= points <= _MOST:
        raise InvalidInput(f"A response needs {_LEAST} to {_MOST} frequencies, but {points} were asked for.")
    return np.linspace(low, high, points)


def _others(tow: Tow, omega: np.ndarray, settings: dict[str, Any]) -> list[tuple[str, Response]]:
    """The response with other conventions and smaller motion; the almost undamped one last."""
    amplitude, form = settings["amplitude"], settings["drag"]
    turned, area = other_area(tow)
    runs = [(f"C_t {_AREAS[area]}", frequency_response(turned, omega, **settings))]
    if tow.speed != 0.0 or tow.current is not None:
        other = "printed" if form == "consistent" else "consistent"
        runs.append((f"drag as {other}", frequency_response(tow, omega, **{**settings, "drag": other})))
    small = 0.1 * amplitude
    runs.append((f"{small:g} m", frequency_response(tow, omega, **{**settings, "amplitude": small})))
    without = without_current(tow, omega, **settings)
    if without is not None:
        runs.append((NO_CURRENT, without))
    return [*runs, ("almost undamped", almost_undamped(tow, omega, at=_middle(omega), **settings))]


def _conventions_words(tow: Tow, omega: np.ndarray) -> str:
    """What tells the runs apart."""
    words = (
        "The tangential drag's coefficient is on the diameter d as the paper prints it, or on the circumference pi d. "
        f"The almost undamped cable has everywhere the damping of {SMALL:g} m of motion at {_middle(omega):.2g} rad/s"
    )
    if tow.speed == 0.0 and tow.current is None:
        return words + "."
    return (
        f"{words} and none from the current, in the static shape that the current gives it. Drag as printed sees the "
        "static angle of the cable instead of the moved one. The run without current, where there is one, has the "
        "shape that is left then."
    )


def _motions(
    tow: Tow, modes: Sequence[tuple[str, float]], settings: dict[str, Any], *, at: float | None = None
) -> list[CableMotion]:
    """The cable at some frequencies, solved there; almost undamped as at the frequency `at` where that is given."""
    if not modes:
        return []
    omega = np.array([frequency for _, frequency in modes])
    solve = frequency_response if at is None else partial(almost_undamped, at=at)
    return response_scene.motions(solve(tow, omega, **settings), [name for name, _ in modes])


def _spread(omega: np.ndarray) -> list[tuple[str, float]]:
    """Frequencies to look at where nothing peaks."""
    places = {"lowest": 0, "middle": omega.size // 2, "highest": -1}
    return [(name, float(omega[i])) for name, i in places.items()]


def _middle(omega: np.ndarray) -> float:
    """The frequency whose motion the almost undamped cable is damped for."""
    return float(np.sqrt(omega[0] * omega[-1]))


def _hangs(shape: StaticShape) -> bool:
    """Whether up and down is along the cable at its top."""
    return abs(float(np.cos(shape.phi[-1]))) < 1e-6


def _notes(own: Response) -> tuple[str, ...]:
    """What the user should know although the study ended well."""
    notes = []
    missed = own.omega[~own.converged]
    if missed.size:
        notes.append(
            f"The damping did not settle at {missed.size} of {own.omega.size} frequencies, the first at "
            f"{missed[0]:.3g} rad/s; see `change` in response-details.csv."
        )
    coarse = {name: share for name, share in own.shares.items() if share > COARSE}
    if coarse:
        worst = max(coarse, key=lambda name: coarse[name])
        notes.append(
            f"The mesh of {own.shape.s.size - 1} segments is too coarse: with half as many the "
            f"{worst.replace('_', ' ')} differs by {300.0 * coarse[worst]:.2g} % of its largest amplitude. Leave out "
            "--segments, or give more."
        )
    loose = own.omega[slack_ratio(own).max(axis=1) >= 1.0]
    if loose.size:
        notes.append(f"The cable goes slack from {loose[0]:.3g} rad/s on: the dynamic tension exceeds the static one.")
    return tuple(notes)


def _terminal(peaks: pd.DataFrame) -> list[dict[str, str]]:
    """The peaks as text."""
    return [
        {
            "quantity": str(row["quantity"]),
            "omega_rad_s": f"{row['omega_rad_s']:.4f}",
            "level": f"{row['level']:.4g} {row['unit']}",
            "level_db": "" if row["level_db"] != row["level_db"] else f"{row['level_db']:+.2f}",
        }
        for row in peaks.to_dict("records")
    ]
