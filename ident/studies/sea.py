"""The sea study: what a random sea does to the vehicle and the cable, by the matrix method (H sections III and IV)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from data_synth.rao import Rao
from data_synth.spectra import POINTS, Spectrum
from ident import scene
from ident import time_domain as simulated
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.places import new_folder
from ident.sea_input import ChosenSea, choose_sea, choose_vessel, top_motion
from ident.sea_tables import (
    COLUMNS,
    cable_table,
    durations_table,
    extremes_table,
    rows,
    sea_table,
    spectra_table,
)
from ident.terminal import Progress
from models.transfer_matrix import COARSE, Direction, DragForm, SeaResponse, sea_response
from models.vehicle import Towfish
from reports.files import write_json, write_table
from reports.sea_page import SeaMaterial, write_sea_page

#: Duration that extremes are told of unless given [s].
DURATION = 3.0 * 3600.0
#: Share of slack cycles from which the linear tensions are not to be believed.
_SLACK = 1e-3
#: Percent of a variance in the last tenth of the frequencies from which the spectrum is too short.
_TAIL = 2.0
#: Sections that the study reads; what else the file gives is listed as unused.
_USED = ("", "water", "cable", "section", "vehicle", "towfish", "tow", "current")
#: What the columns mean, for those who see the table alone.
_MEANING = (
    "significant and one_in_10 are averages of the highest third and tenth, one_in_1000 is what one in a thousand "
    "exceeds; of motions these are heights, of tensions amplitudes."
)


@dataclass(frozen=True, kw_only=True)
class SeaResult:
    """Where the page is, and the main figures for the terminal."""

    folder: Path
    table: list[dict[str, str]]
    notes: tuple[str, ...]


def sea(
    configuration: Configuration,
    *,
    spectrum: str,
    height: float | None = None,
    peak_period: float | None = None,
    record: str | None = None,
    rao: Path | None = None,
    direction: Direction = "heave",
    duration: float = DURATION,
    points: int = POINTS,
    segments: int | None = None,
    drag: DragForm = "consistent",
    time_domain: bool = False,
    seed: int = 0,
    out: Path,
    progress: Progress,
) -> SeaResult:
    """Compute the response to a random sea and write the page.

    Parameters
    ----------
    spectrum
        ``bretschneider`` or ``jonswap`` with `height` and `peak_period`, else a file (`read_spectrum`).
    height, peak_period
        Significant height [m] and period of the peak [s].
    record
        Which spectrum of a file that has several; the highest when left out.
    rao
        Table of the vessel's response (`data_synth.rao`); left out, the cable's top follows the wave itself.
    direction
        Of the top's motion without an RAO. With one, ``heave`` is as the vessel moves, and ``axial`` takes its heave
        along the cable.
    duration
        That the extremes are told of [s].
    points
        Frequencies.
    segments
        Of the cable; as the method sees fit when left out.
    time_domain, seed
        Also a simulation in a sea drawn with this seed, of `duration` or three hours, the shorter.

    Raises
    ------
    InvalidInput
        The place cannot be written, a value is out of bounds, the spectrum is none, the RAO does not cover it, or the
        duration holds too few waves.
    NumericalFailure
        There is no static shape, or the solve fails.
    """
    made_sea = choose_sea(spectrum, height, peak_period, record, points)
    vessel = choose_vessel(rao, direction, made_sea.spectrum)
    tow = configuration.tow
    with new_folder(out) as folder:
        progress("response to the sea", 0.1)
        omega = made_sea.spectrum.omega
        response = sea_response(
            tow,
            omega,
            made_sea.spectrum.density,
            motion=None if vessel is None else vessel.motion(omega),
            direction=direction,
            segments=segments,
            drag=drag,
        )
        found = rows(response, vessel, pitching=isinstance(tow.vehicle, Towfish))
        table, extremes, along = sea_table(found), extremes_table(found, duration), cable_table(response)
        spectra, durations, check = spectra_table(found), durations_table(found), None
        if time_domain:
            progress("time domain", 0.2)
            check = simulated.of_sea(
                tow,
                made_sea.spectrum,
                rao=vessel,
                direction=direction,
                drag=drag,
                seed=seed,
                duration=min(duration, DURATION),
            )
        progress("drawing the page", 0.8)
        made = manifest(
            "sea",
            configuration,
            seed if time_domain else None,
            spectrum=spectrum,
            height=height,
            peak_period=peak_period,
            record=record,
            rao=None if rao is None else rao.name,
            direction=direction,
            duration=duration,
            points=points,
            segments=segments,
            drag=drag,
        )
        write_sea_page(
            folder,
            SeaMaterial(
                title=f"{configuration.name}: random sea",
                description=configuration.description,
                sea=made_sea.label,
                sea_notes=made_sea.notes,
                top=top_motion(rao, direction),
                state=_state(made_sea.spectrum),
                table=table,
                spectra=spectra,
                rao=_rao_table(vessel, made_sea.spectrum),
                cable=along,
                extremes=extremes,
                durations=durations,
                check=check,
                iterations=response.iterations,
                change=response.change,
                segments=response.response.shape.s.size - 1,
                configuration=scene.configuration_table(configuration),
                configuration_text=configuration.text,
                left_out=_left_out(configuration),
                unused=scene.unused(configuration, configuration.unused_beside(_USED)),
                manifest=made,
            ),
        )
        write_table(folder / "sea.csv", table[list(COLUMNS)])
        write_table(folder / "sea-details.csv", table)
        write_table(folder / "spectra.csv", spectra)
        write_table(folder / "extremes.csv", extremes)
        write_table(folder / "durations.csv", durations)
        write_table(folder / "cable.csv", along)
        if check is not None:
            simulated.write_files(folder, check)
        write_json(folder / "manifest.json", made)
        progress("done", 1.0)
    return SeaResult(folder=out, table=_terminal(table), notes=_notes(made_sea, response, table, along))


def _state(spectrum: Spectrum) -> pd.DataFrame:
    """The sea in numbers."""
    rows = [
        ("significant height, 4 sigma", spectrum.significant_height, "m"),
        ("period of the peak", 2.0 * np.pi / spectrum.peak, "s"),
        ("mean zero-crossing period", spectrum.zero_crossing_period, "s"),
        ("energy period", spectrum.energy_period, "s"),
        ("lowest frequency", float(spectrum.omega[0]), "rad/s"),
        ("highest frequency", float(spectrum.omega[-1]), "rad/s"),
    ]
    return pd.DataFrame(rows, columns=["quantity", "value", "unit"])


def _rao_table(vessel: Rao | None, spectrum: Spectrum) -> pd.DataFrame:
    """Amplitudes of the vessel's response at the frequencies of the sea."""
    if vessel is None:
        return pd.DataFrame()
    motion = np.abs(vessel.motion(spectrum.omega))
    columns = {"omega_rad_s": spectrum.omega, "heave_m_m": motion[:, 1]}
    return pd.DataFrame(columns | ({"surge_m_m": motion[:, 0]} if vessel.surges else {}))


def _left_out(configuration: Configuration) -> list[tuple[str, str]]:
    """The effects that the response to a sea is without, each with why."""
    missing = [
        ("large motions", "everything is linear about the static shape; only the drag knows how large the sea is"),
        ("slack and snap", "the tension is counted on below zero; its chance is told instead"),
        (
            "peaks of another law",
            "with linearised drag all is Gaussian; true quadratic drag bends the tails",
        ),
        ("third dimension", "the sea comes from ahead, and the cable lies in the plane of X and Z"),
        ("bending and torsion of the cable", "small beside the tension"),
        ("waves on the cable", "the water moves as the steady current alone: their motion dies a wavelength down"),
        ("compensator", "the cable hangs from the deck itself; see the compensator study"),
    ]
    if not isinstance(configuration.tow.vehicle, Towfish):
        missing.append(("pitch of the vehicle", "the configuration has a point [vehicle], no [towfish]"))
    if configuration.tails:
        names = ", ".join(part.name for part in configuration.tails)
        missing.append(("parts behind the vehicle", f"this study tows the first part alone, without {names}"))
    if configuration.tow.current is None and configuration.tow.speed == 0.0:
        missing.append(("current", "the configuration has neither [current] nor [tow] speed"))
    return missing


def _notes(made: ChosenSea, response: SeaResponse, table: pd.DataFrame, along: pd.DataFrame) -> tuple[str, ...]:
    """What the user should know although the study ended well."""
    notes = [*made.notes, _MEANING]
    if not response.converged:
        notes.append(
            f"The damping did not settle in {response.iterations} iterations; the last change is {response.change:.2g}."
        )
    coarse = {name: share for name, share in response.shares.items() if share > COARSE}
    if coarse:
        name = max(coarse, key=lambda each: coarse[each])
        notes.append(
            f"The mesh of {response.sigma_tension.size - 1} segments is too coarse: with half as many sigma of the "
            f"{name.replace('_', ' ')} differs by {300.0 * coarse[name]:.2g} %. Leave out --segments, or give more."
        )
    worst = along.iloc[int(along["slack_probability"].to_numpy().argmax())]
    if worst["slack_probability"] >= _SLACK:
        notes.append(
            f"The cable goes slack in {100.0 * worst['slack_probability']:.2g} % of the cycles, likeliest at s = "
            f"{worst['s_m']:.0f} m from the vehicle; dynamic tensions beyond the static one are not to be believed."
        )
    for row in table[table["tail_percent"] >= _TAIL].to_dict("records"):
        notes.append(
            f"{row['tail_percent']:.2g} % of the variance of {row['quantity']} lies in the last tenth of the "
            "spectrum's frequencies: a spectrum that goes further would give more."
        )
    return tuple(notes)


def _terminal(table: pd.DataFrame) -> list[dict[str, str]]:
    """The table as text."""
    return [
        {
            name: value if isinstance(value, str) else "" if value != value else f"{value:.4g}"
            for name in COLUMNS
            for value in [row[name]]
        }
        for row in table.to_dict("records")
    ]
