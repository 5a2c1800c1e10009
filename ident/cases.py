"""One record prepared for fitting and scoring: what drives the model, and what it is compared with."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from data_synth.sensors import differentiator, usbl_smoother
from models.drive import MAX_STEP, Drive, Start
from models.quantity import InvalidInput
from models.reduced import Response
from models.trace import Trace

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

#: Fewer scored samples than this say nothing about a model.
FEWEST_SAMPLES = 20


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading:
    """A linear operator on the model's position at the ship's times: ``matrix @ position + constant``.

    `matrix` (m, n) sparse or dense, `constant` (m,).
    """

    matrix: Any
    constant: Floats

    def of(self, position: Floats) -> Floats:
        """(m,) what the instrument makes of positions (n,) [m]."""
        read: Floats = self.matrix @ position + self.constant
        return read

    def rows(self, keep: NDArray[np.bool_]) -> "Reading":
        """The operator for a part of its samples."""
        return Reading(matrix=self.matrix[np.flatnonzero(keep)], constant=self.constant[keep])


@dataclass(frozen=True, kw_only=True, eq=False)
class Case:
    """A record: the ship's motion that drives a model and the vehicle's that it is scored against.

    Every scored sample weighs the same (T 5.2.1). A model's compared velocity is its own at the samples
    `index` of the drive, or, where `velocity_reading` is given, what the very operator that made the observed
    velocity makes of the model's position; likewise the position.

    Parameters
    ----------
    time, velocity, index
        (m,) scored times [s], observed velocity there [m/s], and their places among `drive.t`.
    position, position_index
        (k,) observed position [m] and its places among `drive.t`, for the position scores.
    """

    name: str
    drive: Drive
    time: Floats
    velocity: Floats
    index: Integers
    position: Floats
    position_index: Integers
    velocity_reading: Reading | None = None
    position_reading: Reading | None = None

    def __post_init__(self) -> None:
        if self.time.size < FEWEST_SAMPLES:
            raise InvalidInput(
                f"Record {self.name} needs at least {FEWEST_SAMPLES} scored samples, but {self.time.size} are left "
                "after the settling time and the gaps; give a longer record or a shorter settling time."
            )

    def model_velocity(self, response: Response) -> Floats:
        """(m,) the model's velocity [m/s] as it is compared with `velocity`."""
        if self.velocity_reading is None:
            return response.velocity[self.index]
        # The local origin keeps digits: map coordinates are large beside the motion.
        return self.velocity_reading.of(response.position - self.drive.x0)

    def model_position(self, response: Response) -> Floats:
        """(k,) the model's position [m] as it is compared with `position`."""
        if self.position_reading is None:
            return response.position[self.position_index]
        return self.position_reading.of(response.position - self.drive.x0) + self.drive.x0

    def residual(self, response: Response) -> Floats:
        """(m,) model minus observation [m/s]."""
        return self.model_velocity(response) - self.velocity

    def between(self, begin: float, end: float) -> "Case":
        """The same record scored only from `begin` up to, not including, `end` [s after its start]."""
        since = self.time - self.drive.t[0]
        keep = (since >= begin) & (since < end)
        since = self.drive.t[self.position_index] - self.drive.t[0]
        seen = (since >= begin) & (since < end)
        return replace(
            self,
            time=self.time[keep],
            velocity=self.velocity[keep],
            index=self.index[keep],
            velocity_reading=self.velocity_reading and self.velocity_reading.rows(keep),
            position=self.position[seen],
            position_index=self.position_index[seen],
            position_reading=self.position_reading and self.position_reading.rows(seen),
        )


def case_from_truth(
    name: str, ship: Trace, vehicle: Trace, settle: float, *, start: Start = "rest", max_step: float = MAX_STEP
) -> Case:
    """A noise-free record: the vehicle's own velocity against the model's.

    Parameters
    ----------
    settle
        Time from the record's start that is not scored [s].
    start, max_step
        As `Drive.from_trace` takes them.

    Raises
    ------
    InvalidInput
        Fewer than 20 scored samples are left.
    """
    seen = _seen(ship, vehicle)
    drive = Drive.from_trace(_with_times(ship, vehicle.t[seen]), start=start, max_step=max_step)
    scored = seen & (vehicle.t - drive.t[0] >= settle)
    index = np.searchsorted(drive.t, vehicle.t[scored]).astype(np.int64)
    return Case(
        name=name,
        drive=drive,
        time=vehicle.t[scored],
        velocity=vehicle.rates()[scored, 0],
        index=index,
        position=vehicle.position[scored, 0],
        position_index=index,
    )


def case_from_fixes(
    name: str,
    ship: Trace,
    vehicle: Trace,
    settle: float,
    *,
    window: float = 90.0,
    smoother: bool = False,
    start: Start = "rest",
    max_step: float = MAX_STEP,
) -> Case:
    """A measured record: the same differentiator goes over the fixes and over the model's positions at their times.

    Parameters
    ----------
    vehicle
        Fixes; missing ones are NaN.
    settle
        Time from the record's start that is not scored [s].
    window
        Length of the differentiator's window [s].
    smoother
        The fixes went through the published USBL smoother, so the model's positions pass it too.
    start, max_step
        As `Drive.from_trace` takes them.

    Raises
    ------
    InvalidInput
        Fewer than 20 scored samples are left.
    """
    within = (vehicle.t >= ship.t[0]) & (vehicle.t <= ship.t[-1])
    seen = within & vehicle.valid
    times = vehicle.t[seen]
    if times.size < FEWEST_SAMPLES:
        raise InvalidInput(
            f"Record {name} needs at least {FEWEST_SAMPLES} fixes of the vehicle while the ship is recorded, but has "
            f"{times.size}."
        )
    drive = Drive.from_trace(_with_times(ship, times), start=start, max_step=max_step)
    places = np.searchsorted(drive.t, times).astype(np.int64)
    fixes = vehicle.position[seen, 0]
    slope = differentiator(vehicle.t[within], vehicle.valid[within], window=window)
    matrix = slope.matrix.tocsc()[:, np.flatnonzero(seen[within])]
    velocity = matrix @ (fixes - drive.x0)
    scored = vehicle.t[within][slope.index] - drive.t[0] >= settle
    at = np.searchsorted(drive.t, vehicle.t[within][slope.index]).astype(np.int64)
    late = times - drive.t[0] >= settle
    velocity_reading = Reading(matrix=_spread(matrix, places, drive.t.size), constant=np.zeros(velocity.size))
    position_reading = None
    if smoother:
        smooth = usbl_smoother(times)
        leak = smooth.leak @ ship.spline(times, 1)[:, 0]
        velocity_reading = Reading(
            matrix=_spread(matrix @ smooth.fixes, places, drive.t.size), constant=np.asarray(matrix @ leak)
        )
        position_reading = Reading(matrix=_spread(smooth.fixes, places, drive.t.size), constant=leak).rows(late)
    return Case(
        name=name,
        drive=drive,
        time=drive.t[at][scored],
        velocity=velocity[scored],
        index=at[scored],
        velocity_reading=velocity_reading.rows(scored),
        position=fixes[late],
        position_index=places[late],
        position_reading=position_reading,
    )


def _seen(ship: Trace, vehicle: Trace) -> NDArray[np.bool_]:
    """(n,) samples of the vehicle that are valid and lie within the ship's record."""
    seen: NDArray[np.bool_] = vehicle.valid & (vehicle.t >= ship.t[0]) & (vehicle.t <= ship.t[-1])
    return seen


def _with_times(ship: Trace, times: Floats) -> Trace:
    """The ship on its own times and the given ones; more samples of the same cubic spline are the same spline."""
    union = np.union1d(ship.t, times)
    return ship if union.size == ship.t.size else Trace(t=union, position=ship.at(union))


def _spread(matrix: Any, places: Integers, width: int) -> sparse.csr_array:
    """A matrix on some samples as one on all `width` samples of the drive."""
    part = sparse.coo_array(matrix)
    return sparse.csr_array((part.data, (part.row, places[part.col])), shape=(part.shape[0], width))
