"""Sentences on a response: what the vehicle answers to most, and where the cable goes slack."""

import numpy as np
import pandas as pd

from reports.markdown import listed, significant
from reports.response_material import ResponseMaterial

#: A peak in the summary stands out by this much; a motion in the plane this far below the other is nothing [dB].
CLEAR, WEAK = 1.0, 40.0
#: Dynamic over static tension below this is rounding.
STEADY = 1e-9


def result(material: ResponseMaterial) -> list[str]:
    """What is found, in words made from the numbers."""
    table = material.curves[0][1]
    low, high = float(table["omega_rad_s"].iloc[0]), float(table["omega_rad_s"].iloc[-1])
    top = f"The cable's top moves by {material.amplitude:g} m {material.direction}"
    sentences = [f"{top}, at {significant(low)} to {significant(high)} rad/s."]
    told = []
    peaks = shown(material.peaks)
    for name in ("heave", "surge"):
        own = peaks[(peaks["quantity"] == name) & (peaks["prominence_db"] >= CLEAR)]
        if len(own):
            omega, level = max(zip(own["omega_rad_s"], own["level_db"], strict=True), key=lambda pair: pair[1])
            told.append(f"{name} at {omega:.3f} rad/s with {level:+.2f} dB")
    if told:
        sentences.append(f"The vehicle answers most in {listed(told)} of the input.")
    else:
        sentences.append(f"Neither heave nor surge has a peak that stands out by {CLEAR:g} dB.")
    for name in ("heave", "surge"):
        level = table[f"{name}_db"]
        if not told and level.notna().all():
            begin, end = float(level.iloc[0]), float(level.iloc[-1])
            sentences.append(
                f"{name.capitalize()} goes from {begin:.1f} dB at the lowest to {end:.1f} dB at the highest."
            )
    return [*sentences, _slack(material)]


def shown(peaks: pd.DataFrame) -> pd.DataFrame:
    """The peaks without those of a motion in the plane that is nothing beside the other."""
    plane = peaks["quantity"].isin(["surge", "heave"])
    weak = plane & (peaks["level_db"] < peaks.loc[plane, "level_db"].max() - WEAK)
    kept: pd.DataFrame = peaks.loc[~weak]
    return kept


def _slack(material: ResponseMaterial) -> str:
    """From which frequency on the cable goes slack, and where."""
    most = material.slack_ratio.max(axis=1)
    nearest = material.slack_s[material.slack_ratio.argmax(axis=1)]
    if most.max() < STEADY:
        return "To first order the tension does not change."
    loose = np.flatnonzero(most >= 1.0)
    if loose.size:
        i = int(loose[0])
        least = ", the lowest frequency," if i == 0 else ""
        return (
            f"The cable goes slack from {material.slack_omega[i]:.3g} rad/s{least} on, first "
            f"{_place(float(nearest[i]), material)}: the dynamic tension exceeds the static one there, and what is "
            "computed beyond is that of a cable that could push."
        )
    i = int(most.argmax())
    return (
        f"The cable stays taut: the dynamic tension is at most {100.0 * most[i]:.0f} % of the static one, at "
        f"{material.slack_omega[i]:.3g} rad/s, {_place(float(nearest[i]), material)}; at the same damping it would go "
        f"slack at {significant(material.amplitude / float(most[i]))} m of motion."
    )


def _place(s: float, material: ResponseMaterial) -> str:
    """A place along the cable in words."""
    length = float(material.slack_s[-1])
    if s <= 0.01 * length:
        return "at the vehicle"
    return "at the top" if s >= 0.99 * length else f"{s:.0f} m from the vehicle"
