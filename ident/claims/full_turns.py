"""W's claims of full turns: period, damping and duration against radius, speed, length and sigma."""

import math

import numpy as np

from data_synth.ships import KNOT
from ident.claims.view import AGREES, DISAGREES, PARTLY, UNKNOWN, View, claim, ends, exponent, power, trend
from reports.markdown import significant

#: W's heave period [s], and how near a figure must come to it.
PERIOD, NEAR = 523.0, 0.02
#: A proportion has an exponent within this of one.
LAW = 0.3
#: W's "2nd order linear system" must explain this share of the velocity [%] to be found.
EXPLAINED = 80.0


def _period(view: View) -> dict[str, str]:
    row = view.body(1, 0)
    assert row is not None
    gap, circle = float(row["peak_gap_s"]), float(row["circle_s"])
    verdict = UNKNOWN if math.isnan(gap) else AGREES if abs(gap / PERIOD - 1.0) < NEAR else DISAGREES
    ratios = view.lengths["peak_gap_s"] / view.lengths["circle_s"]
    return claim(
        "Heave period at R/L = 0.114",
        "8 minutes 43 seconds (523 s)",
        f"second peak gap {significant(gap)} s, fitted period {significant(float(row['period_s']))} s",
        verdict,
        f"but the circle itself takes {circle:.0f} s, and the gap is {ratios.min():.2f} to {ratios.max():.2f} circles "
        "on every length: the period proves little",
    )


def _radius_period(view: View) -> dict[str, str]:
    rows = view.radii.assign(
        ratio=view.radii["radius_m"] / view.radii["length_m"],
        gap=view.radii["peak_gap_s"] / view.radii["circle_s"],
    )
    p = exponent(rows["ratio"], rows["rise_m"])
    return claim(
        "Heave period against R/L",
        "the motion is amplified to a periodical oscillation as R/L goes from 0.114 to 0.682",
        f"second gap in circles {ends(rows, 'ratio', 'gap', '')}; farthest that the body comes up again, m: "
        f"{ends(rows, 'ratio', 'rise_m', '')}",
        trend(p, 1.0),
        f"how far it comes up {power(p, 'R/L')}, and without a second gap there is no period",
    )


def _radius_decay(view: View) -> dict[str, str]:
    rows = view.radii
    p = exponent(rows["radius_m"], rows["damping_ratio"])
    return claim(
        "Persistence at small R/L",
        "for a small ratio heave has a relatively small amplitude attenuation",
        f"damping ratio {ends(rows, 'radius_m', 'damping_ratio', ' m')}; height of a peak over that of the one "
        f"before {ends(rows, 'radius_m', 'decay_per_turn', ' m')}",
        trend(p, 1.0),
        f"the damping ratio {power(p, 'R')}",
    )


def _radius_fall(view: View) -> dict[str, str]:
    rows = view.radii.assign(fall=view.radii["deepest_m"] - view.radii["start_depth_m"])
    p = exponent(rows["radius_m"], rows["fall"])
    return claim(
        "Heave at large R/L",
        "a large R/L shows a better performance in heave motion",
        f"fall below the straight tow, m: {ends(rows, 'radius_m', 'fall', ' m')}",
        trend(p, -1.0),
        f"the fall {power(p, 'R')}",
    )


def _speed_damping(view: View) -> dict[str, str]:
    rows = view.speeds
    p = exponent(rows["speed_m_s"], rows["damping_ratio"])
    return claim(
        "Damping against speed",
        "damping ratios increase with towing speed",
        f"damping ratio {ends(rows, 'speed_m_s', 'damping_ratio', ' kn', KNOT)}; height of a peak over that of the "
        f"one before {ends(rows, 'speed_m_s', 'decay_per_turn', ' kn', KNOT)}",
        trend(p, 1.0),
        f"the damping ratio {power(p, 'speed')}; a slower circle leaves the swing more time to die in",
    )


def _sigma_period(view: View) -> dict[str, str]:
    rows = view.lengths
    p = exponent(rows["sigma"], rows["peak_gap_s"])
    return claim(
        "Period against length and sigma",
        "the heave period is in reverse ratio to sigma",
        f"second gap, s: {ends(rows, 'sigma', 'peak_gap_s', '')}",
        UNKNOWN if math.isnan(p) else AGREES if abs(p + 1.0) < LAW else DISAGREES,
        f"the gap {power(p, 'sigma')}: it is that of the ship's circle on every length",
    )


def _sigma_damping(view: View) -> dict[str, str]:
    rows = view.lengths
    p = exponent(rows["sigma"], rows["damping_ratio"])
    return claim(
        "Damping against sigma",
        "the damp effort decreases with sigma",
        f"damping ratio {ends(rows, 'sigma', 'damping_ratio', '')}",
        trend(p, -1.0),
        f"the damping ratio {power(p, 'sigma')}",
    )


def _sigma_duration(view: View) -> dict[str, str]:
    rows = view.lengths
    om = 2.0 * math.pi / rows["period_s"] / np.sqrt(1.0 - rows["damping_ratio"] ** 2)
    rows = rows.assign(duration=1.0 / (rows["damping_ratio"] * om))
    p, q = exponent(rows["sigma"], rows["duration"]), exponent(rows["sigma"], rows["relaxation_s"])
    grows = trend(p, 1.0)
    return claim(
        "Duration against sigma",
        "the duration of oscillation is proportional to sigma",
        f"time for the swing to fall to 1/e, s: {ends(rows, 'sigma', 'duration', '')}; time constant of the sinking, "
        f"s: {ends(rows, 'sigma', 'relaxation_s', '')}",
        PARTLY if grows == AGREES and abs(p - 1.0) > LAW else grows,
        f"the swing's time {power(p, 'sigma')}, the sinking's {power(q, 'sigma')}",
    )


def _second_order(view: View) -> dict[str, str]:
    row = view.body(1, 0)
    assert row is not None
    plain, with_sinking = float(row["plain_fit_percent"]), float(row["fit_percent"])
    return claim(
        "Second-order system",
        "in full turns a second-order linear system is found in the heave history",
        f"it explains {significant(plain, 2)} % of the heave velocity, and {significant(with_sinking, 2)} % where the "
        "depth that it swings about may sink",
        UNKNOWN if math.isnan(plain) else AGREES if plain > EXPLAINED else DISAGREES,
        "the fall to the depth of the steady circle is larger than the swing and has a time constant of its own",
    )


CLAIMS = (
    _period,
    _radius_period,
    _radius_decay,
    _radius_fall,
    _speed_damping,
    _sigma_period,
    _sigma_damping,
    _sigma_duration,
    _second_order,
)
