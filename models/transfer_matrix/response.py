"""The response of a tow to sinusoidal motion of the cable's top, one amplitude for every frequency (H section II)."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput, NumericalFailure
from models.statics import StaticShape, steady_way
from models.tow import Tow
from models.transfer_matrix import columns as c
from models.transfer_matrix.line import Line
from models.transfer_matrix.setup import (
    Compensator,
    Complexes,
    Direction,
    DragForm,
    Floats,
    UniformDamping,
    checked_frequencies,
    checked_nodes,
    compensator_of,
    direction_of,
    failed_at,
    line_of,
    nodes_of,
    on_nodes,
    resolve,
    shares_of,
)
from models.transfer_matrix.work import Work

#: The stable sweep, or H's product of matrices.
Solver = Literal["stable", "product"]

#: Fewest decimal digits that the product of matrices must keep.
LEAST_DIGITS = 4.0
#: The quantities whose error is estimated.
QUANTITIES = ("surge", "heave", "pitch", "tension_bottom", "tension_top")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Response:
    """Complex amplitudes at k frequencies: a quantity is the real part of its amplitude times e^{i omega t}.

    Attributes
    ----------
    omega
        (k,) [rad/s].
    amplitude
        (k,) motion imposed in `direction` [m]: of the cable's top, or of the deck above a compensator.
    shape
        The steady shape at the n + 1 nodes, vehicle first.
    motion
        (k, 3) P, Q [m] of the body's centre of mass in its own axes and its pitch Phi [rad].
    states
        (k, n+1, 4) T~ [N], phi~ [rad], p and q [m] along the cable.
    iterations, change
        (k,) solves of each frequency, and H's norm of the change of the last.
    converged
        (k,) whether `change` came down to the tolerance.
    error
        Estimated error of the mesh, (k,) for each of `QUANTITIES`, from a run on every second node; empty without it.
    digits
        (k,) decimal digits that H's product of matrices kept; NaN for the stable solve.
    """

    omega: Floats
    amplitude: Floats
    direction: Direction
    shape: StaticShape
    motion: Complexes
    states: Complexes
    iterations: NDArray[np.int64]
    change: Floats
    converged: NDArray[np.bool_]
    digits: Floats
    error: Mapping[str, Floats]

    @property
    def surge(self) -> Complexes:
        """P [m], along the body."""
        return self.motion[:, 0]

    @property
    def heave(self) -> Complexes:
        """Q [m], across the body."""
        return self.motion[:, 1]

    @property
    def pitch(self) -> Complexes:
        """Phi [rad]; zero for a point body."""
        return self.motion[:, 2]

    @property
    def horizontal(self) -> Complexes:
        """Motion of the body's centre of mass toward +X [m]."""
        motion: Complexes = self.surge * np.cos(self.shape.pitch) - self.heave * np.sin(self.shape.pitch)
        return motion

    @property
    def vertical(self) -> Complexes:
        """Motion of the body's centre of mass upward [m]."""
        motion: Complexes = self.surge * np.sin(self.shape.pitch) + self.heave * np.cos(self.shape.pitch)
        return motion

    @property
    def tension(self) -> Complexes:
        """(k, n+1) T~ [N]."""
        return self.states[:, :, 0]

    @property
    def angle(self) -> Complexes:
        """(k, n+1) phi~ [rad]."""
        return self.states[:, :, 1]

    @property
    def axial(self) -> Complexes:
        """(k, n+1) p [m]."""
        return self.states[:, :, 2]

    @property
    def normal(self) -> Complexes:
        """(k, n+1) q [m]."""
        return self.states[:, :, 3]

    @property
    def tension_bottom(self) -> Complexes:
        """T~ at the vehicle [N]."""
        return self.states[:, 0, 0]

    @property
    def tension_top(self) -> Complexes:
        """T~ at the top [N]."""
        return self.states[:, -1, 0]

    @property
    def top(self) -> Complexes:
        """p_n [m], motion of the cable's top along the cable."""
        return self.states[:, -1, 2]

    @property
    def shares(self) -> Mapping[str, float]:
        """The estimated errors over the largest amplitude of each quantity; of surge and heave over the larger."""
        largest = {name: float(np.max(np.abs(getattr(self, name)))) for name in self.error}
        worst = {name: float(np.max(error)) for name, error in self.error.items()}
        return shares_of(worst, largest, float(np.max(self.amplitude)), self.shape)


def frequency_response(
    tow: Tow,
    omega: ArrayLike,
    *,
    amplitude: float = 1.0,
    direction: Direction = "axial",
    segments: int | None = None,
    nodes: ArrayLike | None = None,
    drag: DragForm = "consistent",
    solver: Solver = "stable",
    tolerance: float = 1e-10,
    damping: UniformDamping | None = None,
    compensator: Compensator | None = None,
    companion: bool = True,
    stretch_drag: bool = True,
) -> Response:
    """The response to sinusoidal motion of the cable's top, with its drag linearised for that motion.

    Parameters
    ----------
    omega
        (k,) [rad/s], increasing, above 0.
    amplitude
        Of the motion [m].
    segments
        Of the cable, graded by its shape; left out, doubled until the estimated error is 1e-3 of each quantity's
        largest amplitude.
    nodes
        (n+1,) lengths from the vehicle [m] instead, any spacing, every joint of two sections among them.
    tolerance
        H's norm, the mean square change of the deflection in one iteration over that of the top; H takes 1e-4.
    damping
        Given linear damping instead of drag.
    companion
        Whether to estimate the error of the mesh by a second run on every second node, where `segments` or `nodes`
        are given.

    Raises
    ------
    InvalidInput
        A frequency not above zero, a setting out of bounds, a towfish without equilibrium.
    NumericalFailure
        No steady shape; tension that falls to zero; a mesh that cannot be made fine enough; the product of matrices
        has lost its digits.

    Notes
    -----
    H (11)-(13), (18)-(27) and section III, see `models.transfer_matrix.line`, ``solve`` and ``march``. The mean shape
    is that of the steady flow: what waves add to the mean drag is left out, as in H.
    """
    frequencies = checked_frequencies(omega)
    if not (np.isfinite(amplitude) and amplitude > 0.0):
        raise InvalidInput(f"amplitude must be above 0 m, but it is {amplitude:g} m.")
    if not 0.0 < tolerance < 1.0:
        raise InvalidInput(f"tolerance must be above 0 and below 1, but it is {tolerance:g}.")
    if solver not in ("stable", "product"):
        raise InvalidInput(f"solver must be 'stable' or 'product', but it is {solver!r}.")

    way = steady_way(tow)

    def run(mesh: Floats) -> Response:
        line = line_of(tow, way, mesh, drag, stretch_drag=stretch_drag)
        return _run(line, frequencies, amplitude, direction, solver, tolerance, damping, compensator)

    if nodes is not None:
        return on_nodes(run, tow, checked_nodes(tow, nodes), companion, _with_error)
    if segments is not None and not companion:
        return run(nodes_of(tow, segments, frequencies, amplitude, way=way))
    return resolve(run, tow, segments, lambda count: nodes_of(tow, count, frequencies, amplitude, way=way), _with_error)


def product_digits(
    tow: Tow,
    omega: ArrayLike,
    *,
    amplitude: float = 1.0,
    direction: Direction = "axial",
    segments: int = 200,
    drag: DragForm = "consistent",
) -> Floats:
    """Decimal digits (k,) that H's product of matrices keeps of 16, with the drag of the stable solve."""
    frequencies = checked_frequencies(omega)
    way = steady_way(tow)
    line = line_of(tow, way, nodes_of(tow, segments, frequencies, amplitude, way=way), drag)
    digits = np.empty(frequencies.size)
    for k, each in enumerate(frequencies):
        one = np.array([each])
        tops = (amplitude * direction_of(line, direction)[None, :]).astype(complex)
        work = Work(line, one, tops)
        work.march(tolerance=1e-6)
        work.solve(work.b, work.D, 0.0, by_product=True)
        digits[k] = work.digits[0]
    return digits


def _run(
    line: Line,
    omega: Floats,
    amplitude: float,
    direction: Direction,
    solver: Solver,
    tolerance: float,
    damping: UniformDamping | None,
    compensator: Compensator | None,
) -> Response:
    tops = np.tile(amplitude * direction_of(line, direction), (omega.size, 1)).astype(complex)
    by_product = solver == "product"
    work = Work(line, omega, tops, compensator_of(compensator, tops))
    if damping is None:
        failed = work.march(tolerance=tolerance, by_product=by_product)
    else:
        failed = _given(work, damping, by_product)
    if failed >= 0:
        raise failed_at(line, float(omega[failed]))
    if by_product and np.any(work.digits < LEAST_DIGITS):
        i = int(np.argmax(work.digits < LEAST_DIGITS))
        raise NumericalFailure(
            f"The product of transfer matrices keeps {work.digits[i]:.1f} of 16 digits at {omega[i]:g} rad/s over "
            f"{line.shape.s[-1]:g} m: its entries grow with the damping of lateral waves until rounding is all that "
            "is left. Use the stable solver."
        )
    return Response(
        omega=omega,
        amplitude=np.full(omega.size, amplitude),
        direction=direction,
        shape=line.shape,
        motion=work.motion,
        states=work.states,
        iterations=work.iterations,
        change=work.change,
        converged=work.change <= tolerance,
        digits=work.digits if by_product else np.full(omega.size, np.nan),
        error={},
    )


def _given(work: Work, damping: UniformDamping, by_product: bool) -> int:
    """Solve with given damping: the drag factors become 1, the terms of moved angle and height go."""
    line = work.line
    ends, body = line.ends.copy(), line.body.copy()
    ends[:, c.DRAG_T], ends[:, c.DRAG_A] = 1.0, 1.0 / np.repeat(line.shape.T, 2)[1:-1]
    ends[:, [c.STRAIN_T, c.STRAIN_A, c.ANGLE_T, c.ANGLE_A, c.SHEAR_T, c.SHEAR_A]] = 0.0
    body[[c.BODY_ANGLE_P, c.BODY_ANGLE_Q, c.BODY_SHEAR_P, c.BODY_SHEAR_Q]] = 0.0
    b = np.tile([damping.axial, damping.normal], (line.h.size + 1, 1))
    D = np.diag([damping.surge, damping.heave]).astype(complex)
    work.iterations[:], work.change[:] = 1, 0.0
    return work.solve(b, D, damping.pitch, by_product=by_product, line=replace(line, ends=ends, body=body))


def _with_error(fine: Response, coarse: Response) -> Response:
    """The finer run with a third of the difference to the coarser: both err at second order."""
    errors = {name: np.abs(getattr(fine, name) - getattr(coarse, name)) / 3.0 for name in QUANTITIES}
    return replace(fine, error=errors)
