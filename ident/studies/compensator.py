"""The compensator study: tuning a passive heave compensator for a sea state, and what that does (H section IV)."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from data_synth.rao import read_rao
from data_synth.spectra import sea_state as known_sea_state
from ident import compensator_seas as seas
from ident import compensator_tuning as tuning
from ident import printed_compensators as paper
from ident import scene
from ident import time_domain as simulated
from ident.configuration import Configuration
from ident.manifest import manifest
from ident.places import new_folder
from ident.terminal import Progress
from models.compensator import Setting, Tuning, largest_free_height
from models.quantity import InvalidInput
from models.response_statistics import significant
from models.transfer_matrix import SeaResponse
from reports.compensator_page import CompensatorMaterial, write_compensator_page
from reports.files import write_json, write_table

#: The vessel unless another is given: an assumed shape, see the file.
VESSEL = Path(__file__).parents[1] / "vessels" / "swath.csv"
COLUMNS = ("sea_state", "strategy", "stiffness_N_m", "damping_N_s_m", "k_crit_N_m", *paper.ROWS)
#: Columns for the terminal.
_SHOWN = (
    "strategy",
    "stiffness_N_m",
    "damping_N_s_m",
    "p_n_third_m",
    "Q_third_m",
    "R_thousandth_m",
    "T_1_thousandth_N",
    "T_n_thousandth_N",
)
#: Sections that the study reads; what else the file gives is listed as unused.
_USED = ("", "water", "cable", "section", "vehicle", "towfish", "tow", "current", "compensator")


@dataclass(frozen=True, kw_only=True)
class CompensatorResult:
    """Where the page is, and the strategies for the terminal."""

    folder: Path
    table: list[dict[str, str]]
    notes: tuple[str, ...]


def compensator(
    configuration: Configuration,
    *,
    sea_state: int,
    stroke: float | None = None,
    rao: Path | None = None,
    segments: int | None = None,
    time_domain: bool = False,
    seed: int = 0,
    out: Path,
    progress: Progress,
) -> CompensatorResult:
    """Tune the compensator for a sea state, compare the strategies in the random sea and write the page.

    Parameters
    ----------
    sea_state
        One of `data_synth.spectra.SEA_STATES`, as a sea of Bretschneider's form.
    stroke
        Distance between the compensator's stops [m]; as configured when left out, 0 for a locked one.
    rao
        A table of the vessel's heave; the assumed vessel when left out.
    segments
        Of the cable; as the method sees fit when left out.
    time_domain, seed
        Also a simulation of the strategies in a sea drawn with this seed.

    Raises
    ------
    InvalidInput
        The place cannot be written, the sea state is unknown, the RAO leaves out part of the sea, a value is out of
        bounds, or the cable has several sections.
    NumericalFailure
        A solve fails.
    """
    state, vessel = known_sea_state(sea_state), read_rao(VESSEL if rao is None else rao)
    spectrum = state.spectrum()
    vessel.check(spectrum)
    stroke = configuration.compensator.stroke if stroke is None else stroke
    sea = seas.Seaway(
        configuration=configuration, height=state.height, spectrum=spectrum, rao=vessel, segments=segments
    )
    if not sea.sigma > 0.0:
        raise InvalidInput(f"The vessel of {rao or VESSEL} does not heave in sea state {sea_state}; give another RAO.")
    tuned = tuning.tuned(configuration, sea.peak, sea.sigma, stroke)
    with new_folder(out) as folder:
        progress("resolving the cable", 0.0)
        sea = _resolved(sea, tuned)
        settings = _settings(sea, tuned, stroke, progress)
        runs = {}
        for i, (name, setting) in enumerate(settings.items()):
            progress(f"random sea, {name}", 0.3 + 0.2 * i / len(settings))
            runs[name] = sea.response(setting)
        details = _details(sea, sea_state, tuned, settings, runs)
        table = details[details["strategy"].isin(paper.STRATEGIES)][list(COLUMNS)].reset_index(drop=True)
        progress("sweeps", 0.5)
        swept = _sweeps(sea, tuned, details)
        progress("response maps", 0.6)
        shown = tuning.response_map(configuration, tuned, sea.sigma)
        spectra = seas.spectra_table(sea, ((name, runs[name]) for name in paper.STRATEGIES if name in runs))
        three, four = pd.DataFrame(), pd.DataFrame()
        if _is_printed(configuration, sea_state, stroke):
            three = _table_three(configuration, sea, sea_state, stroke, tuned)
            four = _table_four(sea, sea_state, details)
        check = None
        if time_domain:
            check = simulated.of_compensator(sea, settings, seed=seed, progress=progress, share=(0.65, 0.9))
        progress("drawing the page", 0.9)
        made = manifest(
            "compensator",
            configuration,
            seed if time_domain else None,
            sea_state=sea_state,
            stroke=stroke,
            rao=str(rao) if rao else VESSEL.name,
            segments=sea.segments,
        )
        write_compensator_page(
            folder,
            CompensatorMaterial(
                title=f"{configuration.name}: heave compensator in sea state {sea_state}",
                description=configuration.description,
                sea_state=sea_state,
                height=state.height,
                peak_period=state.peak_period,
                heave=float(significant(sea.sigma)),
                peak=sea.peak,
                vessel=rao.name if rao else VESSEL.name,
                assumed=rao is None,
                stroke=stroke,
                mass=configuration.compensator.mass,
                advice=tuned.advice,
                why=tuned.why,
                limit=tuned.limit,
                critical=tuned.critical,
                top_tuned=tuned.top(tuned.by_damping) if tuned.strict else math.nan,
                free_heave=largest_free_height(stroke, tuned.relative(tuned.softest)),
                settings=tuning.settings_table(tuned),
                details=details,
                table_three=three,
                table_four=four,
                spectra=spectra,
                shown=shown,
                swept=swept,
                check=check,
                tuned={"damping": tuned.by_damping.damping, "stiffness": tuned.by_stiffness.stiffness},
                configuration=scene.configuration_table(configuration),
                configuration_text=configuration.text,
                left_out=_left_out(configuration),
                unused=scene.unused(configuration, configuration.unused_beside(_USED)),
                manifest=made,
            ),
        )
        write_table(folder / "tuning.csv", table)
        write_table(folder / "tuning-details.csv", details)
        write_table(folder / "spectra.csv", spectra)
        write_table(folder / "maps.csv", tuning.map_table(shown), digits=6)
        for name, rows in (("sweeps", swept), ("table-3", three), ("table-4", four)):
            if len(rows):
                write_table(folder / f"{name}.csv", rows)
        if check is not None:
            simulated.write_files(folder, check)
        write_json(folder / "manifest.json", made)
        progress("done", 1.0)
    described = any(key.startswith("compensator.") for key in configuration.given)
    return CompensatorResult(folder=out, table=_terminal(table), notes=_notes(tuned, details, stroke, rao, described))


def _resolved(sea: seas.Seaway, tuned: Tuning) -> seas.Seaway:
    """The sea with one mesh for all strategies, that of the tuned damping, which moves everything."""
    if sea.segments is not None:
        return sea
    setting = tuned.by_damping if math.isfinite(tuned.by_damping.damping) else tuned.softest
    return replace(sea, segments=sea.response(setting).sigma_tension.size - 1)


def _settings(sea: seas.Seaway, tuned: Tuning, stroke: float, progress: Progress) -> dict[str, Setting]:
    """Strategy to its setting: those of H Table IV, the softest, and the damping that fills the stroke in this sea."""
    found = {"locked": seas.LOCKED}
    if math.isfinite(tuned.by_damping.damping):
        found |= {"tuned-stiffness": tuned.by_stiffness, "tuned-damping": tuned.by_damping}
    if tuned.by_damping != tuned.softest:
        found["softest"] = tuned.softest
    if tuned.advice == "damp":
        progress("damping that fills the stroke", 0.1)
        damping = seas.filling_damping(sea, tuned.by_damping, stroke)
        if damping >= tuned.softest.damping:
            found["filled-stroke"] = replace(tuned.by_damping, damping=damping)
    return found


def _details(
    sea: seas.Seaway, number: int, tuned: Tuning, settings: dict[str, Setting], runs: dict[str, SeaResponse]
) -> pd.DataFrame:
    """A row a strategy: the columns of ``tuning.csv``, what the linear analysis expected, and `seas.details_row`."""
    rows = []
    for name, setting in settings.items():
        locked = setting == seas.LOCKED
        rows.append(
            {
                "sea_state": number,
                "strategy": name,
                "stiffness_N_m": math.nan if locked else setting.stiffness,
                "damping_N_s_m": math.nan if locked else setting.damping,
                "k_crit_N_m": tuned.critical,
                **seas.table_row(sea, runs[name]),
                "omega_rad_s": tuned.omega,
                "limit": tuned.limit,
                "relative_at_peak": tuned.relative(setting),
                "top_at_peak": tuned.top(setting),
                **seas.details_row(runs[name]),
            }
        )
    return pd.DataFrame(rows)


def _sweeps(sea: seas.Seaway, tuned: Tuning, details: pd.DataFrame) -> pd.DataFrame:
    """Both sweeps and the locked compensator; empty where nothing is tuned."""
    if tuned.advice == "soft" or not math.isfinite(tuned.by_damping.damping):
        return pd.DataFrame()
    locked = details[details["strategy"] == "locked"].iloc[0]
    rows: list[dict[str, object]] = [
        {"swept": "locked", "value": math.nan, **{name: float(locked[name]) for name in paper.ROWS}}
    ]
    rows += seas.sweep(sea, tuned.softest, tuned.by_damping, "damping")
    rows += seas.sweep(sea, tuned.softest, tuned.by_stiffness, "stiffness")
    return pd.DataFrame(rows)


def _is_printed(configuration: Configuration, sea_state: int, stroke: float) -> bool:
    """Whether H's Tables III and IV are of this case."""
    device = configuration.compensator
    return paper.printed(
        configuration.name, sea_state, stroke=stroke, stiffness=device.least_stiffness, damping=device.least_damping
    )


def _table_three(
    configuration: Configuration, sea: seas.Seaway, sea_state: int, stroke: float, tuned: Tuning
) -> pd.DataFrame:
    """H Table III beside ours at the inferred and at this vessel's peak."""
    at = tuning.inferred(configuration, sea_state, sea.sigma, stroke)
    printed, inferred, own = paper.TABLE_THREE[sea_state], tuning.of_table_three(at), tuning.of_table_three(tuned)
    return pd.DataFrame(
        {
            "quantity": ("tuned damping, N s/m", "tuned stiffness, N/m", "k_crit, N/m"),
            "printed": printed,
            "inferred_peak_rad_s": at.omega,
            "at_inferred_peak": inferred,
            "off_percent": 100.0 * (np.array(inferred) / printed - 1.0),
            "peak_rad_s": tuned.omega,
            "at_peak": own,
            "peak_off_percent": 100.0 * (np.array(own) / printed - 1.0),
        }
    )


def _table_four(sea: seas.Seaway, sea_state: int, details: pd.DataFrame) -> pd.DataFrame:
    """H Table IV beside ours, with its settings and with ours: what the tuning changes, and what the sea."""
    ours = {str(row["strategy"]): {name: float(row[name]) for name in paper.ROWS} for row in details.to_dict("records")}
    at_printed = {"locked": ours["locked"]} | {
        name: seas.table_row(sea, sea.response(setting, companion=False))
        for name, setting in paper.settings(sea_state).items()
    }
    return paper.beside_table_four(sea_state, ours, at_printed)


def _left_out(configuration: Configuration) -> list[tuple[str, str]]:
    """The effects that the study is made without, each with why."""
    missing = [
        ("angle between heave and cable", "the vessel's heave acts along the cable's top, as in H (IV-A)"),
        ("surge and pitch of the vessel", "what moves the cable sideways is damped away within a short length of it"),
        ("stops and gas springs", "the compensator is a linear spring and dashpot about its mean position"),
        ("slack cable", "linear: a tension amplitude above the static tension is one of a cable that could push"),
    ]
    if configuration.tow.speed != 0.0 or configuration.tow.current is not None:
        missing.append(
            ("flow past the cable in the tuning", "its closed form has the drag of still water; the random sea has it")
        )
    return missing


def _notes(tuned: Tuning, details: pd.DataFrame, stroke: float, rao: Path | None, described: bool) -> tuple[str, ...]:
    """What to do, how far the rule holds in the random sea, and what was assumed."""
    words = {"soft": "leave the compensator soft", "damp": "raise the damping", "lock": "lock the compensator"}
    notes = [f"{words[tuned.advice]}: {tuned.why}"]
    damped = details[details["strategy"] == "tuned-damping"]
    filled = details[details["strategy"] == "filled-stroke"]
    reached = float(damped["R_thousandth_m"].iloc[0]) if len(damped) else 0.0
    if len(filled):
        notes.append(
            f"in the random sea the tuned damping lets one motion in a thousand exceed {reached:.2f} m; "
            f"{float(filled['damping_N_s_m'].iloc[0]):.0f} N s/m fills the stroke of {stroke:g} m"
        )
    elif tuned.advice == "soft" and reached > stroke:
        notes.append(
            f"in the random sea the softest compensator lets one motion in a thousand exceed {reached:.2f} m, more "
            f"than the stroke of {stroke:g} m"
        )
    stiff = details[details["strategy"] == "tuned-stiffness"]
    over = float(stiff["R_thousandth_m"].iloc[0]) if len(stiff) else 0.0
    if over > stroke:
        notes.append(f"the tuned stiffness lets one motion in a thousand exceed {over:.2f} m of {stroke:g} m")
    if not described:
        notes.append(
            "the configuration has no [compensator]: its mass and the least stiffness and damping are defaults of ours"
        )
    if tuned.strict:
        notes.append(
            f"the rule is stricter than need be: the tuned damping lets {tuned.top(tuned.by_damping):.2f} of the "
            "vessel's motion through at the peak"
        )
    if rao is None:
        notes.append(f"the vessel is an assumed shape ({VESSEL.name}); give a table of your own")
    return tuple(notes)


def _terminal(table: pd.DataFrame) -> list[dict[str, str]]:
    """The columns of the table that tell the strategies apart, as text."""
    return [
        {
            name: value if isinstance(value, str) else "" if value != value else f"{float(value):.5g}"
            for name in _SHOWN
            for value in [row[name]]
        }
        for row in table.to_dict("records")
    ]
