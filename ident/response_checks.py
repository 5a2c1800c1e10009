"""What a response depends on beside the system itself: conventions of the drag, segments, and the way to solve it."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ident.response_peaks import highest
from ident.response_tables import UNITS, answers, peaks_of
from models.cable import Cable, TangentialArea
from models.current import Current
from models.quantity import InvalidInput, NumericalFailure
from models.tow import Tow
from models.transfer_matrix import Response, UniformDamping, frequency_response, product_digits
from models.vehicle import Towfish

Floats = NDArray[np.float64]

#: The amplitude that the almost undamped cable is damped for [m].
SMALL = 0.01
#: What the run without the current is called.
NO_CURRENT = f"{SMALL:g} m, no current"
#: Shares of the segments that the refinement takes, the fewest a section, and at how many frequencies it is looked at.
_COARSER, _FINEST, _FEWEST, _FREQUENCIES = (8, 4, 2, 1), 4, 4, 25
#: The current in which a cable that hangs still is looked at for the product's digits [m/s].
FLOW = 0.5
#: Multiples of the upper cable's length, of a cable with sections and without, and of the normal drag coefficient;
#: segments of the map; frequencies of the map and of the line below it.
_LENGTHS_OF_PARTS, _LENGTHS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0), (0.125, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0)
MAP_SEGMENTS = 200
_DRAGS, _MAP_FREQUENCIES, _LINE_FREQUENCIES = (0.5, 1.0, 2.0), 24, 40
#: What two solves are compared by, iterated to rounding, and the relative step in frequency that shows rounding alone.
_COMPARED, _TIGHT, _STEP = ("heave", "tension_bottom", "tension_top"), 1e-28, 1e-10


def other_area(tow: Tow) -> tuple[Tow, TangentialArea]:
    """The tow with the tangential drag of all its cables on the other reference area, and which that is."""
    other: TangentialArea = "circumference" if tow.cable.tangential_area == "diameter" else "diameter"
    sections = tuple(replace(cable, tangential_area=other) for cable in tow.sections)
    return replace(tow, cable=replace(tow.cable, tangential_area=other), sections=sections), other


def almost_undamped(tow: Tow, omega: Floats, *, at: float, **settings: Any) -> Response:
    """The response with the damping of a centimetre of motion at the frequency `at`, without the current's share.

    The static shape stays that of the current; all sections have the damping of the upper cable.
    """
    speed = SMALL * at
    share, rho, body = 8.0 / (3.0 * math.pi) * speed, tow.water_density, tow.vehicle
    drag, turning = body.drag(rho), 0.0
    if isinstance(body, Towfish):
        # Turning as fast as a centimetre of motion at its ends, H (17).
        turning = 0.5 * rho * body.drag_coefficient * max(body.area_p, body.area_q) * body.length**3 / 32.0
        turning *= share / (0.5 * body.length)
    damping = UniformDamping(
        axial=share * tow.cable.tangential_drag(rho),
        normal=share * tow.cable.normal_drag(rho),
        surge=share * drag,
        heave=share * drag,
        pitch=turning,
    )
    return frequency_response(tow, omega, **{**settings, "drag": "printed", "damping": damping})


def without_current(tow: Tow, omega: Floats, **settings: Any) -> Response | None:
    """The response to a centimetre of motion in still water, in the shape that is left there; None without one."""
    if tow.current is None or tow.speed != 0.0:
        return None
    try:
        return frequency_response(replace(tow, current=None), omega, **{**settings, "amplitude": SMALL})
    except (InvalidInput, NumericalFailure):
        return None


def conventions_table(runs: Sequence[tuple[str, Response]]) -> pd.DataFrame:
    """A row a run: its highest peaks of surge and heave, its first peaks of tension, its iterations."""
    rows = []
    for label, response in runs:
        row: dict[str, object] = {"run": label}
        for name, unit in UNITS.items():
            found = peaks_of(response, name)
            peak = (found[0] if found else None) if unit == "N" else highest(found)
            row[f"{name}_rad_s"] = math.nan if peak is None else peak.omega
            if unit == "N":
                row[f"{name}_N"] = math.nan if peak is None else peak.level
            else:
                row[f"{name}_db"] = math.nan if peak is None else peak.decibels
        rows.append({**row, "iterations": int(response.iterations.max())})
    return pd.DataFrame(rows)


def shares(sizes: Mapping[str, Floats], over: Response) -> dict[str, float]:
    """The largest of `sizes` (k,) of each quantity over the largest amplitude in `over`; both motions in the plane
    over the larger of them.
    """
    most = {name: float(np.abs(getattr(over, name)).max()) for name in UNITS}
    most["surge"] = most["heave"] = max(most["surge"], most["heave"])
    return {name: float(np.max(size)) / most[name] for name, size in sizes.items() if answers(over, name)}


def refinement_table(tow: Tow, response: Response, settings: dict[str, Any]) -> pd.DataFrame:
    """Errors of coarser runs against one of four times the segments, as shares of the largest amplitude.

    Columns ``segments``, one for each quantity, their largest ``error``, and the ``order`` since the run before.
    """
    n = response.shape.s.size - 1
    omega = np.linspace(response.omega[0], response.omega[-1], _FREQUENCIES)

    def run(segments: int) -> Response:
        return frequency_response(tow, omega, **{**settings, "segments": segments, "companion": False})

    finest, rows = run(_FINEST * n), []
    for share in _COARSER:
        if n // share < _FEWEST * len(tow.cables):
            continue
        coarse = run(n // share)
        apart = {name: np.abs(getattr(coarse, name) - getattr(finest, name)) for name in UNITS}
        found = shares(apart, finest)
        rows.append({"segments": coarse.shape.s.size - 1, **found, "error": max(found.values())})
    table = pd.DataFrame(rows)
    if len(table):
        fall = -np.diff(np.log(table["error"])) / np.diff(np.log(table["segments"]))
        table["order"] = np.concatenate([[np.nan], fall])
    return table


def in_flow(tow: Tow) -> Tow:
    """The tow where water passes it: itself, or in a current where it hangs still.

    A cable that hangs straight keeps lateral and axial motion apart, and the product then loses nothing.
    """
    still = tow.speed == 0.0 and (tow.current is None or not np.any(tow.current.speed))
    return replace(tow, current=Current.uniform(FLOW)) if still else tow


def digits_table(tow: Tow, omega: Floats, settings: dict[str, Any]) -> pd.DataFrame:
    """Digits that the product keeps over the upper cable's length, frequency and normal drag.

    Columns ``length_m`` of the upper cable, ``coefficient`` of its normal drag, ``omega_rad_s``, ``digits``; NaN where
    the changed tow has no static shape.
    """
    grid = np.linspace(omega[0], omega[-1], _MAP_FREQUENCIES)
    parts = []
    for changed in _changed(tow):
        try:
            kept = product_digits(changed, grid, segments=MAP_SEGMENTS, **settings)
        except (InvalidInput, NumericalFailure):
            kept = np.full(grid.size, np.nan)
        cable = changed.cable
        columns = {"length_m": cable.length, "coefficient": cable.normal_drag_coefficient}
        parts.append(pd.DataFrame({**columns, "omega_rad_s": grid, "digits": kept}))
    return pd.concat(parts, ignore_index=True)


def _changed(tow: Tow) -> Iterator[Tow]:
    """The tow with every length of the upper cable and every normal drag of the map."""

    def dragged(cable: Cable, times: float) -> Cable:
        return replace(cable, normal_drag_coefficient=times * cable.normal_drag_coefficient)

    for times in _DRAGS:
        sections = tuple(dragged(cable, times) for cable in tow.sections)
        for share in _LENGTHS_OF_PARTS if tow.sections else _LENGTHS:
            cable = replace(dragged(tow.cable, times), length=share * tow.cable.length)
            yield replace(tow, cable=cable, sections=sections)


def agreement_table(tow: Tow, omega: Floats, nodes: Floats, settings: dict[str, Any]) -> pd.DataFrame:
    """Digits that the product keeps by its own growth, those of the stable solve by its own rounding, and the shared.

    Columns ``omega_rad_s, digits, stable, agreement``; the last is NaN at a frequency that the product refuses. The
    rounding of a solve is how far it strays from a straight line over a step in frequency that is too small to bend.
    """
    omega = np.linspace(omega[0], omega[-1], _LINE_FREQUENCIES)
    kept = product_digits(tow, omega, segments=nodes.size - 1, **settings)
    tight = {**settings, "tolerance": _TIGHT, "companion": False, "nodes": nodes}
    near = frequency_response(tow, (omega[:, None] * (1.0 + _STEP * np.array([-1.0, 0.0, 1.0]))).ravel(), **tight)
    strays, found = np.zeros(omega.size), {}
    for name in _COMPARED:
        below, found[name], above = getattr(near, name).reshape(-1, 3).T
        strays = np.maximum(strays, np.abs(below - 2.0 * found[name] + above) / np.abs(found[name]))
    apart = np.full(omega.size, np.nan)
    for i in range(omega.size):
        try:
            product = frequency_response(tow, omega[i : i + 1], solver="product", **tight)
        except NumericalFailure:
            continue
        apart[i] = max(abs(getattr(product, name)[0] / found[name][i] - 1.0) for name in _COMPARED)
    columns = {"stable": -np.log10(np.maximum(strays, 1e-16)), "agreement": -np.log10(np.maximum(apart, 1e-16))}
    return pd.DataFrame({"omega_rad_s": omega, "digits": kept, **columns})
