"""What the page of a response shows of the tow itself: its static state, its parts, the cable where it peaks."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from ident.configuration import Configuration
from ident.response_checks import shares
from ident.response_peaks import MODE
from ident.response_tables import bends_table
from models.statics import StaticShape
from models.tow import Tow
from models.transfer_matrix import Response
from models.vehicle import Towfish
from reports.figures.cable_motion import CableMotion, Towed

#: Most peaks whose shapes are shown (H figure 9), how near two of them are one [share], and how far below the highest
#: one is nothing to look at [dB].
_SHOWN, _SAME, _WEAK = 4, 0.06, 40.0
#: A cable whose least radius of curvature is this many lengths is straight.
_STRAIGHT = 1e3


def modes(peaks: pd.DataFrame) -> list[tuple[str, float]]:
    """What peaks at which frequency [rad/s], from the lowest: surge and heave as modes do, else whatever does."""
    chosen = peaks[peaks["quantity"].isin(["surge", "heave"]) & (peaks["prominence_db"] >= MODE)]
    chosen = chosen[chosen["level_db"] >= chosen["level_db"].max() - _WEAK]
    if chosen.empty:
        chosen = peaks.sort_values("prominence_db", ascending=False).drop_duplicates("quantity")
    found: list[tuple[str, float]] = []
    for row in chosen.sort_values("omega_rad_s").to_dict("records"):
        name, omega = str(row["quantity"]).replace("_", ", "), float(row["omega_rad_s"])
        if found and omega <= (1.0 + _SAME) * found[-1][1]:
            if name not in found[-1][0]:
                found[-1] = (f"{found[-1][0]} and {name}", found[-1][1])
            continue
        found.append((name, omega))
    return found[:_SHOWN]


def motions(response: Response, names: Sequence[str]) -> list[CableMotion]:
    """The cable at each frequency, called after what peaks there."""
    shape = response.shape
    return [
        CableMotion(
            label=f"{name}, {response.omega[i]:.3f} rad/s",
            omega=float(response.omega[i]),
            s=shape.s,
            x=shape.x,
            z=shape.z,
            angle=shape.phi,
            static_tension=shape.T,
            axial=response.axial[i],
            normal=response.normal[i],
            tension=response.tension[i],
        )
        for i, name in enumerate(names)
    ]


def state(tow: Tow, shape: StaticShape, *, changed: bool) -> pd.DataFrame:
    """The static state in numbers."""
    rows = [
        ("depth of the cable's lower end", shape.depth, "m"),
        ("x of the cable's lower end, from the top", float(shape.x[0]) + 0.0, "m"),
        ("length of the cable" + (", for the depth asked for" if changed else ""), tow.length, "m"),
        ("tension at the vehicle", float(shape.T[0]), "N"),
        ("tension at the top", float(shape.T[-1]), "N"),
        ("least tension", float(shape.T.min()), "N"),
        ("angle at the vehicle, from the horizontal", float(np.degrees(shape.phi[0])), "degrees"),
        ("angle at the top", float(np.degrees(shape.phi[-1])), "degrees"),
    ]
    if isinstance(tow.vehicle, Towfish):
        rows.append(("pitch of the vehicle", float(np.degrees(shape.pitch)), "degrees"))
    bends = bends_table(shape)
    radius = float((bends["segment_m"] / np.radians(bends["turn_deg"].clip(lower=1e-9))).min())
    if radius < _STRAIGHT * tow.length:
        rows.append(("least radius of curvature", radius, "m"))
    return pd.DataFrame(rows, columns=["quantity", "value", "unit"])


def towed(tow: Tow, shape: StaticShape) -> Towed:
    """The vehicle as the picture draws it."""
    length = tow.vehicle.length if isinstance(tow.vehicle, Towfish) else 0.0
    return Towed(length=length, pitch=shape.pitch, flow=float(shape.flow[0]))


def parts(tow: Tow) -> list[tuple[str, float, float]]:
    """Each length of cable from the vehicle up, called after its weight in water."""
    found, begin = [], 0.0
    for cable in tow.cables:
        weight = cable.weight_in_water
        name = f"{cable.length:g} m, {abs(weight):.3g} N/m {'buoyant' if weight < 0.0 else 'heavy'}"
        found.append((name, begin, begin + cable.length))
        begin += cable.length
    return found


def errors(own: Response) -> pd.DataFrame:
    """The estimated error of each quantity over frequency, as a share of its largest amplitude."""
    found = {"omega_rad_s": own.omega}
    for name, most in shares(own.error, own).items():
        size = own.error[name]
        found[name] = size * (most / float(size.max())) if most > 0.0 else size
    return pd.DataFrame(found)


def left_out(configuration: Configuration) -> list[tuple[str, str]]:
    """The effects that the matrix method is without, each with why."""
    missing = [
        ("large motions", "everything is linear about the static shape; only the drag knows the amplitude"),
        ("slack", "the tension is counted on below zero; the page says from where on"),
        ("third dimension", "the cable lies in the plane of X and Z"),
        ("bending and torsion of the cable", "small beside the tension"),
        ("waves in the water", "the water moves as the steady current alone"),
        ("strumming", "no drag amplification is asked for"),
        ("compensator", "the cable's top moves as it is told; see the compensator study"),
    ]
    if configuration.tails:
        names = ", ".join(part.name for part in configuration.tails)
        missing.append(("parts behind the vehicle", f"this study tows the first part alone, without {names}"))
    if configuration.tow.current is None and configuration.tow.speed == 0.0:
        missing.append(("current", "the configuration has neither [current] nor [tow] speed"))
    return missing
