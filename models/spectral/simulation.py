"""The spectral reference simulator: T chapter 2 from a tow and a ship trace to the vehicle's trace."""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from models.quantity import NumericalFailure
from models.spectral.basis import Fields, prepare
from models.spectral.explicit import march_explicit
from models.spectral.implicit import march
from models.spectral.refusals import check, fail, refuse_axial_waves
from models.spectral.system import DONE
from models.spectral.winch import Winch, control_arrays
from models.statics import StaticShape, static_shape
from models.tow import Tow, refuse_sections_and_thrust
from models.trace import Trace
from models.vehicle import Towfish

Floats = NDArray[np.float64]
Stepper = Literal["implicit", "newmark", "runge-kutta"]
STEPPERS: tuple[Stepper, ...] = ("implicit", "newmark", "runge-kutta")
Start = Literal["rest", "steady"]

#: Most steps of a run, accepted and rejected.
STEP_BUDGET = 5_000_000
#: Most steps times the square of the sines and a few more, in which a step's cost grows: some minutes.
WORK_BUDGET, _MORE = 1_000_000_000, 8
#: Local error per step that a wanted error of the whole record allows, measured on the built-in configurations.
_LOCAL_SHARE: dict[Stepper, float] = {"implicit": 0.012, "newmark": 0.24, "runge-kutta": 0.24}
#: Harmonics and tolerance of the companion run, and how much smaller the error of the finer run is at least.
_COMPANION_HARMONICS, _COMPANION_TOLERANCE, _COMPANION_RATIO = 0.6, 4.0, 0.4
_REFINEMENTS = 5
#: That ratio where the series converges at first order.
_SLOWEST_RATIO = 1.5
#: Share of the tolerance that the surge may err by before a refinement lengthens the series too.
_SERIES_SHARE = 0.6
_MOST_HARMONICS = 160


@dataclass(frozen=True, kw_only=True, eq=False)
class SpectralResult:
    """A spectral run.

    `vehicle` is absolute, with its velocity and the tensions at the top and at the vehicle. `amplitudes` (n, 2 + N)
    [m] are (p_b, eta_1, Q_1 ... Q_N) at the samples, counted from `shape`. `error` [m/s] is the estimated RMS error
    of the vehicle's velocity, None where no companion run was made.
    """

    vehicle: Trace
    amplitudes: Floats
    shape: StaticShape
    tow: Tow
    ship: Trace
    pitch: Floats | None
    payout: Floats | None
    harmonics: int
    stations: int
    steps: int
    rejected: int
    evaluations: int
    error: float | None

    @property
    def largest_angle(self) -> float:
        """Largest turn of the cable from its static shape, at the samples and a few places [rad].

        Deflections count as small: what that costs grows with the square of this angle, and no error here tells it.
        """
        x, n = np.linspace(0.0, 1.0, 2 * self.harmonics + 1), np.arange(1, self.harmonics + 1)
        moved = self.ship.position - self.ship.position[0]
        dx = moved[:, 0] - self.tow.speed * (self.ship.t - self.ship.t[0])
        top = float(self.shape.phi[-1])
        straight = math.cos(top) * moved[:, 2] - math.sin(top) * dx - self.amplitudes[:, 1]
        bent = self.amplitudes[:, 2:] @ (math.pi * n[:, None] * np.cos(math.pi * n[:, None] * x))
        return float(np.abs(np.arctan((straight[:, None] + bent) / self.tow.cable.length)).max())

    def cable_at(self, sample: int, points: int = 61) -> tuple[Floats, Floats]:
        """x and z [m] of the cable at a sample, vehicle first, (points,) each."""
        x = np.linspace(0.0, 1.0, points)
        shape, y = self.shape, self.amplitudes[sample]
        s = x * self.tow.cable.length
        phi = np.interp(s, shape.s, shape.phi)
        elapsed = self.ship.t[sample] - self.ship.t[0]
        moved = self.ship.position[sample] - self.ship.position[0]
        dx, dz = moved[0] - self.tow.speed * elapsed, moved[2]
        top = float(shape.phi[-1])
        eta_2 = -math.sin(top) * dx + math.cos(top) * dz
        p_top = math.cos(top) * dx + math.sin(top) * dz
        n = np.arange(1, self.harmonics + 1)
        q = y[1] * (1.0 - x) + eta_2 * x + np.sin(math.pi * x[:, None] * n) @ y[2:]
        # The axial deflection is uniform but for the share that the bend takes from the lateral one, p' = q phi_s'.
        bend = np.concatenate([[0.0], np.cumsum(0.5 * (q[1:] + q[:-1]) * np.diff(phi))])
        p = y[0] * (1.0 - x) + p_top * x + bend - bend[-1] * x
        X = np.interp(s, shape.s, shape.x) + p * np.cos(phi) - q * np.sin(phi)
        Z = np.interp(s, shape.s, shape.z) + p * np.sin(phi) + q * np.cos(phi)
        start = self.ship.position[0]
        return X + start[0] + self.tow.speed * elapsed, Z + start[2]


def simulate(
    tow: Tow,
    ship: Trace,
    *,
    tolerance: float = 1e-4,
    harmonics: int | None = None,
    stations: int | None = None,
    step: float | None = None,
    stepper: Stepper = "implicit",
    start: Start = "rest",
    winch: Winch | None = None,
    drag_angle: str = "moved",
    end_condition: str = "weak",
    allow_aliasing: bool = False,
    companion: bool = True,
) -> SpectralResult:
    """Simulate the planar motion of a cable and its vehicle under a ship's motion.

    Parameters
    ----------
    ship
        Trace of the tow point along x and z; y must not change. Results come at its times.
    tolerance
        Wanted RMS error of the vehicle's velocity over the record [m/s]. It chooses the harmonics and the steps
        where they are not given, and is checked against a coarser companion run.
    harmonics, stations, step
        Resolution, where it shall be given: sines, Gauss stations, and the step [s] of Newmark's method, which the
        others do without. The error is then what it is.
    companion
        Whether to estimate the error by a coarser run where the resolution is given.
    start
        ``rest``: steady in the frame that moves at `tow.speed`; ``steady``: the static shape at the ship's mean
        velocity over the first minute.

    Raises
    ------
    InvalidInput
        An unknown option, a track out of the plane, missing ship samples, a resolution that aliases, sections or a
        thrust.
    SlackCable
        The tension falls to zero: the small deflections about one shape no longer describe the cable.
    NumericalFailure
        The steps do not converge, the step budget runs out, or the error stays above the tolerance.
    """
    check(ship, tolerance, stepper, STEPPERS, start, step)
    refuse_sections_and_thrust(tow, "The spectral simulator")
    if start == "steady":
        tow = replace(tow, speed=initial_speed(ship))
    shape = static_shape(tow)
    refuse_axial_waves(tow, ship, shape, tolerance)
    options = {"drag_angle": drag_angle, "end_condition": end_condition, "allow_aliasing": allow_aliasing}

    def run(sines: int, local: float, newmark_step: float) -> SpectralResult:
        fields = prepare(tow, harmonics=sines, stations=stations, shape=shape, **options)  # type: ignore[arg-type]
        return advance(tow, ship, shape, fields, stepper=stepper, local=local, newmark_step=newmark_step, winch=winch)

    local = local_error(stepper, tolerance)
    newmark_step = step if step is not None else min(float(np.diff(ship.t).max()), 40.0 * math.sqrt(tolerance))
    sines = harmonics if harmonics is not None else first_harmonics(tow, ship, shape, tolerance)
    given = harmonics is not None or (step is not None and stepper == "newmark")
    if given and not companion:
        return run(sines, local, newmark_step)
    if stations is not None:
        # Refuse a resolution that aliases by its own name, not by the companion's.
        prepare(tow, harmonics=sines, stations=stations, shape=shape, **options)  # type: ignore[arg-type]
    fewer = max(min(3, sines - 1), round(_COMPANION_HARMONICS * sines)) if sines > 1 else 2
    coarse = run(fewer, _COMPANION_TOLERANCE * local, 2.0 * newmark_step)
    # Of an inclined cable heave too is a matter of the series, which then converges at first order at the worst.
    ratio = np.full(2, _COMPANION_RATIO if abs(float(shape.phi[0]) - 0.5 * math.pi) < 1e-6 else _SLOWEST_RATIO)
    before: Floats | None = None
    series = 0.0
    for _ in range(_REFINEMENTS):
        fine = run(sines, local, newmark_step)
        difference = _rms_difference(fine, coarse)
        if before is not None and ratio[0] > _COMPANION_RATIO:
            ratio = np.clip(difference / np.maximum(before - difference, 1e-300), _COMPANION_RATIO, _SLOWEST_RATIO)
        across, along = ratio * difference
        if fine.harmonics != coarse.harmonics:
            # What the shorter series costs shows across the cable; it stands until the series is lengthened again.
            series = across
        error = math.hypot(max(across, series), along)
        if error <= tolerance or given:
            return replace(fine, error=error)
        if sines == _MOST_HARMONICS and series > tolerance:
            break
        coarse, before = fine, difference
        local /= _COMPANION_TOLERANCE
        newmark_step *= 0.5
        if max(across, series) > _SERIES_SHARE * tolerance or (ratio[0] > _COMPANION_RATIO and along > across):
            sines = min(_MOST_HARMONICS, math.ceil(sines / _COMPANION_HARMONICS))
    raise NumericalFailure(
        f"The spectral simulator's estimated error in the vehicle's velocity is still {error:.3g} m/s RMS over the "
        f"record of {ship.t[-1] - ship.t[0]:g} s with {sines} harmonics, above the tolerance of {tolerance:g} m/s; "
        "smooth the ship's record, give the cable an axial damping if it rings in heave, or allow a larger tolerance."
    )


def _rms_difference(one: SpectralResult, other: SpectralResult) -> Floats:
    """RMS difference of the vehicles' velocities across and along the static shape's chord, (2,) [m/s]."""
    assert one.vehicle.velocity is not None
    assert other.vehicle.velocity is not None
    x, _, z = (one.vehicle.velocity - other.vehicle.velocity).T
    shape = one.shape
    chord = math.atan2(-float(shape.z[0]), -float(shape.x[0]))
    c, s = math.cos(chord), math.sin(chord)
    rms: Floats = np.sqrt(np.mean(np.array([c * z - s * x, c * x + s * z]) ** 2, axis=1))
    return rms


def initial_speed(ship: Trace, window: float = 60.0) -> float:
    """Mean velocity of the ship along x over its first minute [m/s]."""
    until = min(float(ship.t[0]) + window, float(ship.t[-1]))
    place = ship.at([float(ship.t[0]), until])[:, 0]
    return float((place[1] - place[0]) / (until - ship.t[0]))


def first_harmonics(tow: Tow, ship: Trace, shape: StaticShape, tolerance: float) -> int:
    """Sines for a first run: the lateral motion diffuses down the cable over sqrt(T/(omega b)), b = 2 k_n V.

    The count is affine in the cable's length over that depth, with constants measured on the built-in
    configurations, and follows the tolerance by the measured order 3.3 of the weak form.
    """
    rates = ship.spline(ship.t, 1)[:, 0] - tow.speed
    speed = float(np.sqrt(np.mean(rates**2))) + 1e-3
    change = float(np.sqrt(np.mean(ship.spline(ship.t, 2)[:, 0] ** 2)))
    omega = min(max(change / speed, 0.02), 0.5)
    drag = 2.0 * tow.cable.normal_drag(tow.water_density) * (speed + abs(tow.speed))
    tension = float(shape.tension_at(0.5 * tow.cable.length))
    waves = tow.cable.length / math.pi * math.sqrt(omega * drag / tension)
    wanted = math.ceil((5.2 + 4.3 * waves) * math.pow(1e-4 / tolerance, 0.3))
    return min(_MOST_HARMONICS, max(4, wanted))


def budget_of(harmonics: int) -> int:
    """Most steps of a run with so many sines."""
    return min(STEP_BUDGET, WORK_BUDGET // (harmonics + _MORE) ** 2)


def local_error(stepper: Stepper, tolerance: float) -> float:
    """Local error of a step that a wanted error of the whole record allows, both [m/s]."""
    return _LOCAL_SHARE[stepper] * tolerance


def advance(
    tow: Tow,
    ship: Trace,
    shape: StaticShape,
    fields: Fields,
    *,
    stepper: Stepper,
    local: float,
    newmark_step: float = 1.0,
    winch: Winch | None = None,
) -> SpectralResult:
    """One run with tables that are ready: nothing is chosen, and nothing checked but that the steps succeed.

    Parameters
    ----------
    shape, fields
        The static shape, and the tables of sines and stations about it.
    local
        Error that a step may make [m/s]; of Newmark's method a thousandth of it is left by the corrector.
    newmark_step
        [s], of Newmark's method only.

    Raises
    ------
    SlackCable, NumericalFailure
        As `simulate` does.
    """
    N, J = fields.sines.shape[1:]
    nb = 3 if isinstance(tow.vehicle, Towfish) else 2
    spline = ship.spline
    knots = np.ascontiguousarray(spline.x)
    # In the steadily towed frame, from the first position: large map coordinates cost no digits.
    coefficients = np.array(spline.c[:, :, [0, 2]], order="C")
    if coefficients.shape[0] < 4:
        coefficients = np.concatenate([np.zeros((4 - coefficients.shape[0], *coefficients.shape[1:])), coefficients])
    coefficients[3] -= np.array([ship.position[0, 0], ship.position[0, 2]])
    coefficients[3, :, 0] -= tow.speed * (knots[:-1] - knots[0])
    coefficients[2, :, 0] -= tow.speed
    control, payout_t, payout_l = control_arrays(winch, tow.cable.length)
    out, shapes = np.zeros((len(ship), 2 * nb + 3)), np.zeros((len(ship), 2 + N))
    counts, where = np.zeros(4, dtype=np.int64), np.zeros(2)
    first, budget = min(1.0, float(np.diff(ship.t).min())), budget_of(N)
    rest = (control, payout_t, payout_l, out, shapes, counts, where)
    if stepper == "runge-kutta":
        status = march_explicit(fields, knots, coefficients, ship.t, first, local, budget, *rest)
    elif stepper == "newmark":
        status = march(fields, knots, coefficients, ship.t, 1, newmark_step, 1e-3 * local, budget, *rest)
    else:
        status = march(fields, knots, coefficients, ship.t, 0, first, local, budget, *rest)
    if status != DONE:
        fail(status, where, counts, tow, budget)
    elapsed = ship.t - ship.t[0]
    position, velocity = np.zeros((len(ship), 3)), np.zeros((len(ship), 3))
    end_x, end_z = float(shape.x[0]), float(shape.z[0])
    if isinstance(tow.vehicle, Towfish):
        s, c = math.sin(shape.pitch), math.cos(shape.pitch)
        end_x -= tow.vehicle.tow_point_p * c - tow.vehicle.tow_point_q * s
        end_z -= tow.vehicle.tow_point_p * s + tow.vehicle.tow_point_q * c
    position[:, 0] = ship.position[0, 0] + tow.speed * elapsed + end_x + out[:, 0]
    position[:, 1] = ship.position[0, 1]
    position[:, 2] = ship.position[0, 2] + end_z + out[:, 1]
    velocity[:, 0], velocity[:, 2] = tow.speed + out[:, nb], out[:, nb + 1]
    return SpectralResult(
        vehicle=Trace(t=ship.t, position=position, velocity=velocity, tension=out[:, 2 * nb : 2 * nb + 2]),
        amplitudes=shapes,
        shape=shape,
        tow=tow,
        ship=ship,
        pitch=out[:, 2].copy() if nb == 3 else None,
        payout=out[:, 2 * nb + 2].copy() if winch is not None else None,
        harmonics=N,
        stations=J,
        steps=int(counts[2]),
        rejected=int(counts[3]),
        evaluations=int(counts[0]),
        error=None,
    )
