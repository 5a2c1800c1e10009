"""A record seen along one line: the ship's principal direction on the map."""

from dataclasses import dataclass

import numpy as np

from data_synth.records.record import Record
from models.trace import Floats, Trace

#: Off-axis by axis RMS above which the projection deserves a warning.
WARN_OFF_AXIS = 0.2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PlanarRecord:
    """A record with x along the ship's principal direction, y = 0 and z up.

    Attributes
    ----------
    record
        The projected record; depth, tension, name and notes are those of the original.
    angle
        Direction of the axis on the map from +x to +y [rad].
    origin
        (3,) [m] the map position of x = 0.
    ship_axis_rms, ship_off_axis_rms, vehicle_axis_rms, vehicle_off_axis_rms
        [m], each track about its own mean; None without a vehicle.
    off_plane
        Largest distance of the ship from the vertical plane through its first position [m].
    warning
        A sentence when a track is off its axis by more than 20 % of its RMS along it.
    """

    record: Record
    angle: float
    origin: Floats
    ship_axis_rms: float
    ship_off_axis_rms: float
    vehicle_axis_rms: float | None
    vehicle_off_axis_rms: float | None
    off_plane: float
    warning: str | None

    def on_map(self, planar: Trace) -> Trace:
        """A planar trace back in the coordinates of the original record."""
        turned = _turn(planar.position, -self.angle) + self.origin
        return Trace(t=planar.t, position=turned, tension=planar.tension)


def planar(record: Record) -> PlanarRecord:
    """Project a record on the ship's principal direction, positive toward where the ship ends up.

    A record whose ship keeps y = 0 is left as it is: no turn, no shift.

    Notes
    -----
    The direction is the first right singular vector of the ship's track about its mean.
    """
    lies_along_x = not record.ship.position[:, 1].any()
    angle = 0.0 if lies_along_x else _principal_angle(record.ship.position[:, :2])
    origin = np.zeros(3) if lies_along_x else record.origin
    ship, ship_off = _project(record.ship, angle, origin)
    vehicle, vehicle_off = (None, None) if record.vehicle is None else _project(record.vehicle, angle, origin)
    ship_rms, ship_off_rms = _spread(ship.position[:, 0]), _spread(ship_off)
    vehicle_rms = None if vehicle is None else _spread(vehicle.position[:, 0])
    vehicle_off_rms = None if vehicle_off is None else _spread(vehicle_off)
    return PlanarRecord(
        record=Record(
            name=record.name,
            ship=ship,
            vehicle=vehicle,
            depth=record.depth,
            tension=record.tension,
            bodies=tuple(_project(body, angle, origin)[0] for body in record.bodies),
            notes=record.notes,
            source=record.source,
        ),
        angle=angle,
        origin=origin,
        ship_axis_rms=ship_rms,
        ship_off_axis_rms=ship_off_rms,
        vehicle_axis_rms=vehicle_rms,
        vehicle_off_axis_rms=vehicle_off_rms,
        off_plane=float(np.abs(ship_off).max()),
        warning=_warning(record.name, ship_rms, ship_off_rms, vehicle_rms, vehicle_off_rms),
    )


def _principal_angle(track: Floats) -> float:
    """Direction [rad] of largest spread of (n, 2) positions, toward the end; 0 for a ship that stays."""
    about_mean = track - track.mean(axis=0)
    if not about_mean.any():
        return 0.0
    axis = np.linalg.svd(about_mean, full_matrices=False)[2][0]
    net = float((track[-1] - track[0]) @ axis)
    if net < 0.0 or (net == 0.0 and axis[0] < 0.0):
        axis = -axis
    return float(np.arctan2(axis[1], axis[0]))


def _turn(vectors: Floats, angle: float) -> Floats:
    """(n, 3) components in axes turned by `angle` about z; those for an angle of 0 are left to the bit."""
    if angle == 0.0:
        return np.array(vectors)
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = vectors.T
    return np.column_stack([c * x + s * y, c * y - s * x, z])


def _project(track: Trace, angle: float, origin: Floats) -> tuple[Trace, Floats]:
    """The track along the axis, and its distance (n,) from the plane."""
    turned = _turn(track.position - origin, angle)
    velocity = None if track.velocity is None else _turn(track.velocity, angle) * np.array([1.0, 0.0, 1.0])
    off = turned[:, 1].copy()
    turned[np.isfinite(off), 1] = 0.0
    return Trace(t=track.t, position=turned, velocity=velocity, tension=track.tension), off


def _spread(values: Floats) -> float:
    """RMS about the mean of the values that are there; 0 where none is."""
    known = values[np.isfinite(values)]
    return float(np.std(known)) if known.size else 0.0


def _warning(name: str, ship: float, ship_off: float, vehicle: float | None, vehicle_off: float | None) -> str | None:
    parts = []
    for body, along, off in (("ship", ship, ship_off), ("vehicle", vehicle, vehicle_off)):
        if along is not None and off is not None and off > WARN_OFF_AXIS * along:
            share = f"{100.0 * off / along:.0f} % of its" if along > 0.0 else "but has no"
            parts.append(f"the {body} is {off:.3g} m RMS off the axis, {share} motion along it ({along:.3g} m)")
    if not parts:
        return None
    return (
        f"Record {name} is not planar: {' and '.join(parts)}; above {100.0 * WARN_OFF_AXIS:.0f} % the planar models "
        "miss what the turns do."
    )
