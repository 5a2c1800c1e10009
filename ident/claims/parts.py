"""W's claims of several parts, U-turns and snap loads."""

import math

import pandas as pd

from data_synth.ships import KNOT
from ident.claims.view import (
    AGREES,
    DISAGREES,
    FLAT,
    PARTLY,
    UNKNOWN,
    View,
    claim,
    ends,
    exponent,
    power,
    trend,
)
from reports.markdown import significant

#: A body that comes up again by less than this share of its fall falls steadily.
STEADY = 0.02


def _second_part(view: View) -> dict[str, str]:
    upper, lower, alone = view.body(2, 0), view.body(2, 1), view.body(1, 0)
    paper = "the second part attenuates the vibration of a full turn"
    if upper is None or lower is None or alone is None:
        return claim("Second part", paper, "", UNKNOWN, "no such run is known")
    ratio = float(lower["rise_m"]) / float(upper["rise_m"]) if upper["rise_m"] else math.nan
    return claim(
        "Second part",
        paper,
        f"after falling the first body comes up again by {significant(float(upper['rise_m']))} m, the second by "
        f"{significant(float(lower['rise_m']))} m: {significant(ratio, 2)} of it",
        UNKNOWN if math.isnan(ratio) else AGREES if ratio < 1.0 - FLAT else DISAGREES,
        f"the first body alone comes up by {significant(float(alone['rise_m']))} m",
    )


def _third_part(view: View) -> dict[str, str]:
    bodies = [view.body(3, place) for place in range(3)]
    paper = "the third part has a stable falling history; with three parts heave is totally damped"
    if any(row is None for row in bodies):
        return claim("Third part", paper, "", UNKNOWN, "no such run is known")
    rises = [float(row["rise_m"]) for row in bodies if row is not None]
    last = bodies[-1]
    assert last is not None
    fall = float(last["deepest_m"] - last["start_depth_m"])
    return claim(
        "Third part",
        paper,
        f"after falling the bodies come up again by {', '.join(significant(rise) for rise in rises)} m; the third has "
        f"fallen by {significant(fall)} m",
        UNKNOWN if math.isnan(rises[-1] / fall) else AGREES if rises[-1] < STEADY * fall else DISAGREES,
        f"what it comes up by is {significant(100.0 * rises[-1] / fall, 2)} % of its fall",
    )


def under_ship_heave(heave: pd.DataFrame) -> dict[str, str]:
    """The claim of isolation, judged by the tow of the most parts."""
    paper = "the design isolates the vibration of the ship from three parts on"
    if heave.empty:
        return claim("Ship heave", paper, "", UNKNOWN, "no tow under ship heave was run")
    most = heave[heave["parts"] == heave["parts"].max()]
    told = [
        f"{', '.join(significant(value) for value in rows['of_ship'])} of the ship's at {period:g} s"
        for period, rows in most.groupby("period_s")
    ]
    below = most[most["body"] != most["body"].iloc[0]]
    if below.empty:
        return claim("Ship heave", paper, "; ".join(told), UNKNOWN, "the configuration has one part")
    kept = below.groupby("period_s")["of_above"].max()
    return claim(
        "Ship heave",
        paper,
        f"heave from body to body {'; '.join(told)}",
        AGREES if (kept < 1.0 - FLAT).all() else PARTLY if (kept < 1.0 - FLAT).any() else DISAGREES,
        "most that a body takes over from the one above: "
        + ", ".join(f"{value:.2f} at {period:g} s" for period, value in kept.items()),
    )


def _u_turn_period(view: View) -> dict[str, str]:
    by_radius = dict(list(view.u_turns.groupby("radius_m")))
    powers = {radius: exponent(rows["speed_m_s"], rows["dip_s"]) for radius, rows in by_radius.items()}
    verdicts = {trend(p, 1.0) for p in powers.values()}
    told = [f"R = {radius:g} m: {ends(rows, 'speed_m_s', 'dip_s', ' kn', KNOT)}" for radius, rows in by_radius.items()]
    return claim(
        "U-turn: period against speed",
        "from 2 to 4 to 6 knots the averaged heave period becomes larger",
        f"time below half of the dip, s: {'; '.join(told)}",
        verdicts.pop() if len(verdicts) == 1 else PARTLY,
        "there is one dip and no period, so its duration is compared: "
        + ", ".join(f"at R = {radius:g} m it {power(p, 'speed')}" for radius, p in powers.items()),
    )


def _u_turn_impacts(view: View) -> dict[str, str]:
    dips = {radius: [int(n) for n in rows["dips"].dropna()] for radius, rows in view.u_turns.groupby("radius_m")}
    wide, tight = (dips.get(radius, []) for radius in (500.0, 250.0))
    return claim(
        "U-turn at R = 500 m",
        "only one heave impact on the main cable",
        f"dips at 2, 4 and 6 kn: {', '.join(map(str, wide)) or 'no figure'}",
        UNKNOWN if not wide else AGREES if set(wide) == {1} else DISAGREES,
        f"at R = 250 m: {', '.join(map(str, tight)) or 'no figure'}",
    )


def _u_turn_size(view: View) -> dict[str, str]:
    rows = view.u_turns.assign(fall=view.u_turns["deepest_m"] - view.u_turns["start_depth_m"])
    table = rows.pivot(index="speed_m_s", columns="radius_m", values="fall")
    told = "; ".join(
        f"R = {radius:g} m: {', '.join(significant(value) for value in table[radius])}" for radius in table.columns
    )
    wider = bool((table.iloc[:, -1] < table.iloc[:, 0]).all())
    faster = bool((table.diff().iloc[1:] < 0.0).all(axis=None))
    verdict = UNKNOWN if table.isna().any(axis=None) else (DISAGREES, PARTLY, AGREES)[wider + faster]
    return claim(
        "U-turn: size of the heave",
        "the heave decreases with turning radius and with turning speed",
        f"fall at 2, 4, 6 kn, m: {told}",
        verdict,
        f"{'smaller' if wider else 'not smaller'} at the larger radius, "
        f"{'smaller' if faster else 'not smaller'} at every higher speed",
    )


def _snap(view: View) -> dict[str, str]:
    rows, alone = view.all_parts, view.radii["slack_events"].dropna()
    tight, wide = rows.iloc[0], rows.iloc[-1]
    told = [
        f"{significant(n, 1)} at R = {radius:g} m"
        for n, radius in zip(rows["slack_events"], rows["radius_m"], strict=True)
    ]
    ratio = float(tight["snap_peak_N"] / tight["tension_start_N"])
    slack_when_tight = tight["slack_events"] > 0 and wide["slack_events"] == 0
    if math.isnan(tight["slack_events"]):
        verdict = UNKNOWN
    elif not slack_when_tight:
        verdict = DISAGREES
    else:
        verdict = AGREES if ratio > 1.0 else PARTLY
    after = f"{significant(1e-3 * float(tight['snap_peak_N']))} kN, {significant(ratio)} times that of the straight tow"
    return claim(
        "Snap loads",
        "snap in the main cable is significant at small R/L, in a tow of several parts",
        f"with {int(tight['parts'])} parts the times that the main cable goes slack: {', '.join(told)}; largest "
        f"tension within 10 s of being taut again: {after if ratio > 0.0 else 'none'}",
        verdict,
        f"with one part it goes slack {int(alone.sum())} times in {len(alone)} turns; a snap counts as significant "
        "where it pulls more than the straight tow",
    )


CLAIMS = (_second_part, _third_part, _u_turn_period, _u_turn_impacts, _u_turn_size, _snap)
