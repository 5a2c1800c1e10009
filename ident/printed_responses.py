"""What H prints of its two examples, beside which a response sets its own figures (H sections IV-B and IV-C)."""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from ident.response_checks import NO_CURRENT
from ident.response_peaks import MODE, decibels, highest
from ident.response_tables import peaks_of, top_motion
from models.transfer_matrix import Response
from reports.findings import in_words

#: Amplitude of the paper's excitation, along the cable [m].
AMPLITUDE = 1.0
#: The modes of the S-shape [rad/s]; a peak farther than this share from the nearest of them is another.
_MODES, _NEAR = (0.280, 0.435, 0.550), 0.25

Find = Callable[[Response], float]
#: What is compared to its row of the table.
Rows = Mapping[str, Mapping[Hashable, Any]]


class _Printed(NamedTuple):
    """One printed number: what it is of, the quantity of the figures, its unit, the number, and how to find ours.

    `omega` is the frequency that a level is printed for; what is not `dynamic` does not depend on the excitation.
    """

    what: str
    quantity: str
    unit: str
    value: float
    find: Find
    omega: float = math.nan
    dynamic: bool = True


def _highest_peak(name: str, *, level: bool) -> Find:
    def find(response: Response) -> float:
        peak = highest(peaks_of(response, name))
        return math.nan if peak is None else peak.decibels if level else peak.omega

    return find


def _first_peak(name: str) -> Find:
    def find(response: Response) -> float:
        found = peaks_of(response, name)
        return found[0].omega if found else math.nan

    return find


def _mode(names: Sequence[str], omega: float) -> Find:
    def find(response: Response) -> float:
        found = [peak for name in names for peak in peaks_of(response, name) if peak.prominence >= MODE]
        own = [peak.omega for peak in found if min(_MODES, key=lambda each: abs(each - peak.omega)) == omega]
        near = [each for each in own if abs(each - omega) <= _NEAR * omega]
        return min(near, key=lambda each: abs(each - omega), default=math.nan)

    return find


def _level(name: str, omega: float, scale: Callable[[np.ndarray], np.ndarray]) -> Find:
    def find(response: Response) -> float:
        size = scale(np.abs(getattr(response, name)) / top_motion(response))
        return float(np.interp(omega, response.omega, size, left=math.nan, right=math.nan))

    return find


def _static(find: Find, what: str, unit: str, value: float) -> _Printed:
    return _Printed(what, "", unit, value, find, dynamic=False)


_SWATH = (
    _Printed("heave peak", "heave", "dB", 5.25, _highest_peak("heave", level=True), 0.90),
    _Printed("frequency of the heave peak", "", "rad/s", 0.90, _highest_peak("heave", level=False)),
    _Printed("first tension peak at the vehicle", "tension_bottom", "rad/s", 1.19, _first_peak("tension_bottom")),
    _Printed("first tension peak at the top", "tension_top", "rad/s", 1.19, _first_peak("tension_top")),
)
_S_SHAPE = (
    _static(lambda response: response.shape.depth, "depth", "m", 100.0),
    _static(lambda response: float(response.shape.T[0]), "static tension at the vehicle", "N", 530.0),
    _static(lambda response: float(response.shape.T[-1]), "static tension at the top", "N", 840.0),
    _static(lambda response: abs(math.degrees(response.shape.pitch)), "static pitch", "degrees", 8.0),
    _Printed("surge mode", "surge", "rad/s", 0.280, _mode(("surge",), _MODES[0])),
    _Printed("heave mode", "heave", "rad/s", 0.435, _mode(("heave",), _MODES[1])),
    _Printed("third mode", "surge", "rad/s", 0.550, _mode(("surge", "heave"), _MODES[2])),
    _Printed("heave at 0.80 rad/s", "heave", "dB", -40.0, _level("heave", 0.80, decibels), 0.80),
    _Printed("pitch at 1.25 rad/s", "pitch", "degrees", 6.0, _level("pitch", 1.25, np.degrees), 1.25),
)
_PRINTED = {"swath-4000": _SWATH, "s-shape-205": _S_SHAPE, "s-shape-205-thrust": _S_SHAPE}


def beside_paper(name: str, runs: Sequence[tuple[str, Response]], *, dynamic: bool) -> pd.DataFrame:
    """Columns ``what, unit, printed``, one for each run, and how far the first, or else the last, is off.

    Empty for a tow that the paper does not have; what depends on the excitation is left out unless `dynamic`.
    """
    rows = []
    for printed in _PRINTED.get(name, ()):
        if printed.dynamic and not dynamic:
            continue
        found = {label: printed.find(response) for label, response in runs}
        first, last = found[runs[0][0]], found[runs[-1][0]]
        off = f"{_off(printed, last)} ({runs[-1][0]})" if math.isnan(first) > math.isnan(last) else _off(printed, first)
        rows.append({"what": printed.what, "unit": printed.unit, "printed": printed.value, **found, "off by": off})
    return pd.DataFrame(rows)


def printed_marks(name: str, *, dynamic: bool) -> pd.DataFrame:
    """What the figures mark: ``quantity, omega_rad_s, level_db, level`` [N], missing where nothing is printed."""
    rows = []
    for printed in _PRINTED.get(name, ()):
        if not printed.quantity or not dynamic:
            continue
        levels = {"dB": printed.value, "degrees": float(decibels(math.radians(printed.value)))}
        omega = printed.value if printed.unit == "rad/s" else printed.omega
        rows.append((printed.quantity, omega, levels.get(printed.unit, math.nan), math.nan))
    return pd.DataFrame(rows, columns=["quantity", "omega_rad_s", "level_db", "level"])


def explanation(table: pd.DataFrame) -> str:
    """What is to be said of the differences in a table of `beside_paper`; empty where there is nothing."""
    if table.empty:
        return ""
    found = {str(row["what"]): row for row in table.to_dict("records")}
    runs = [str(name) for name in table.columns[3:-1]]
    return _of_heave(found, runs) if "heave peak" in found else _of_modes(found, runs)


def _of_heave(found: Rows, runs: Sequence[str]) -> str:
    """Of swath-4000: what the heave peak hangs on."""
    first, other = (float(found["heave peak"][run]) for run in runs[:2])
    if math.isnan(first + other):
        return ""
    return (
        "How high the heave peaks hangs on the area that the tangential drag's coefficient is on, in the paper's (1) "
        f"the diameter: {first:.2f} dB with {runs[0]}, {other:.2f} dB with {runs[1]}. The paper prints one frequency "
        "for the dynamic tensions; here the two ends peak apart."
    )


def _of_modes(found: Rows, runs: Sequence[str]) -> str:
    """Of the S-shape: that the printed modes are those of a cable with little damping."""
    modes = [found[what] for what in ("surge mode", "heave mode", "third mode") if what in found]
    still = [row for row in modes if not math.isnan(float(row[runs[-1]]))]
    damped = [row for row in modes if not math.isnan(float(row[runs[0]]))]
    if not still or len(damped) >= len(still):
        return ""
    apart = max(abs(float(row[runs[-1]]) / float(row["printed"]) - 1.0) for row in still)
    seen = in_words(len(damped)) if damped else "none"
    words = (
        f"With the damping that this motion and the current make, {seen} of the {in_words(len(modes))} modes stands "
        f"out as a peak by {MODE:g} dB; in the almost undamped cable {in_words(len(still))} do, within "
        f"{100.0 * apart:.1f} % of the printed frequencies. The printed peaks fit a cable damped far less than the "
        "linearised drag of one metre and of the current makes it: compare their frequencies, not levels."
    )
    if NO_CURRENT in runs:
        off = max(abs(float(row[NO_CURRENT]) / float(row["printed"]) - 1.0) for row in modes)
        if not math.isnan(off):
            words += (
                f" Without the current, in the shape that the ROV's thrust alone gives the cable, they come within "
                f"{100.0 * off:.1f} %."
            )
    pitch = found["pitch at 1.25 rad/s"]
    full, little, printed = (float(pitch[name]) for name in (runs[0], runs[-1], "printed"))
    if abs(math.log(little / printed)) < abs(math.log(full / printed)):
        words += (
            f" The printed pitch of {printed:g} degrees, too, is nearer to the {little:.3g} degrees of the almost "
            f"undamped cable than to the {full:.2g} degrees of the full damping."
        )
    return words


def _off(printed: _Printed, value: float) -> str:
    if math.isnan(value):
        return ""
    if printed.unit == "dB":
        return f"{value - printed.value:+.1f} dB"
    return f"{100.0 * (value / printed.value - 1.0):+.1f} %"
