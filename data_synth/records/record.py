"""A record: what is known of a ship and its vehicle on one set of times."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from models.quantity import InvalidInput
from models.trace import Floats, Trace

#: Fewest vehicle fixes that a comparison with a model is worth.
FEWEST_SCORED = 20
#: Times closer than this are one [s]: multiples of a step differ in their last digit.
SAME_TIME = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Record:
    """A ship's track and, where known, its vehicle's, on the same times.

    Attributes
    ----------
    name
        What tables call it.
    ship
        (n,) samples, all with a position.
    vehicle
        (n,) samples, NaN rows where there is no fix.
    depth
        (n,) [m], down, as measured; NaN where missing.
    tension
        (n, 2) [N] at the top and the bottom of the cable; NaN where missing.
    bodies
        Further bodies, from the second on; (n,) samples each, NaN rows where there is no fix.
    notes
        What was counted, repaired or found suspect, one sentence each.
    source
        The format it was read from.
    """

    name: str
    ship: Trace
    vehicle: Trace | None = None
    depth: Floats | None = None
    tension: Floats | None = None
    bodies: tuple[Trace, ...] = ()
    notes: tuple[str, ...] = ()
    source: Literal["trace", "deep-tow", "nmea", "creel"] = "trace"

    def __post_init__(self) -> None:
        n = len(self.ship)
        if not self.ship.valid.all():
            raise InvalidInput(f"Record {self.name} needs the ship's position at every time.")
        vehicles = self.bodies if self.vehicle is None else (self.vehicle, *self.bodies)
        if not all(np.array_equal(each.t, self.ship.t) for each in vehicles):
            raise InvalidInput(f"Record {self.name} needs ship and vehicle on the same times; use join().")
        for name, shape in (("depth", (n,)), ("tension", (n, 2))):
            value = getattr(self, name)
            if value is None:
                continue
            array = np.array(value, dtype=float)
            if array.shape != shape:
                raise InvalidInput(f"Record.{name} needs the shape {shape}, but has {array.shape}.")
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def t(self) -> Floats:
        """(n,) [s]."""
        return self.ship.t

    @property
    def origin(self) -> Floats:
        """(3,) [m] a local origin for coordinates: the ship's first position on the map, z = 0."""
        return np.array([*self.ship.position[0, :2], 0.0])


def require_vehicle(record: Record, fewest: int = FEWEST_SCORED) -> Trace:
    """The vehicle's track of a record that is to be scored.

    Raises
    ------
    InvalidInput
        There is none, or it has fewer fixes than `fewest`.
    """
    if record.vehicle is None:
        raise InvalidInput(
            f"Record {record.name} has no vehicle, which is needed here; "
            "add the columns vehicle_x_m, vehicle_y_m, vehicle_z_m."
        )
    fixes = int(record.vehicle.valid.sum())
    if fixes < fewest:
        raise InvalidInput(
            f"Record {record.name} has {fixes} vehicle fixes, but at least {fewest} are needed to score a model; "
            "use a longer record."
        )
    return record.vehicle


def join(name: str, ship: Trace, vehicle: Trace | None = None, *, notes: tuple[str, ...] = ()) -> Record:
    """One record of a ship's track and a vehicle's on other times, such as fixes every 10 s.

    The record's times are those of both; the ship is interpolated by its spline, the vehicle is not. Depth
    and tension are taken from the vehicle's trace where it has them, the tension from the ship's otherwise.

    Raises
    ------
    InvalidInput
        The vehicle's times leave those of the ship.
    """
    if vehicle is None:
        return Record(name=name, ship=ship, tension=ship.tension, notes=notes)
    if vehicle.t[0] < ship.t[0] - SAME_TIME or vehicle.t[-1] > ship.t[-1] + SAME_TIME:
        raise InvalidInput(
            f"The vehicle's track lasts from {vehicle.t[0]:g} to {vehicle.t[-1]:g} s, outside the ship's "
            f"{ship.t[0]:g} to {ship.t[-1]:g} s; the ship's must cover it."
        )
    fix_times = _snapped(vehicle.t, ship.t)
    t = np.union1d(ship.t, fix_times)
    own, fixes = np.searchsorted(t, ship.t), np.searchsorted(t, fix_times)
    position = ship.at(t)
    position[own] = ship.position
    track = np.full((t.size, 3), np.nan)
    track[fixes] = vehicle.position
    tension = None
    for source, place in ((vehicle, fixes), (ship, own)):
        if tension is None and source.tension is not None:
            tension = np.full((t.size, 2), np.nan)
            tension[place] = source.tension
    return Record(
        name=name,
        ship=ship if t.size == ship.t.size else Trace(t=t, position=position),
        vehicle=Trace(t=t, position=track),
        depth=-track[:, 2],
        tension=tension,
        notes=notes,
    )


def _snapped(times: Floats, to: Floats) -> Floats:
    """The times, each moved to the one of `to` that it agrees with."""
    after = np.minimum(np.searchsorted(to, times), to.size - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(times - to[before] < to[after] - times, to[before], to[after])
    return np.where(np.abs(nearest - times) < SAME_TIME, nearest, times)
