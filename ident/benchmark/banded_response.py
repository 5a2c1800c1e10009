"""The equations of the matrix method as one band matrix a frequency: a baseline of the benchmark, and an oracle.

All unknowns stand in one vector, (P, Q, Phi) of the body and (T~, phi~, p, q) of every node from the body up, and all
equations of `models.transfer_matrix.line` and of H (21), (23) in one matrix: three of the body, two of its tow point,
four of every segment, two of the top. Rows keep to five diagonals on either side of the main one, and LAPACK's band
solver with row exchanges does the rest. The terms are written down from that module's docstring, apart from the
kernels.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from models.quantity import NumericalFailure
from models.transfer_matrix import columns as c
from models.transfer_matrix.line import Line

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

#: Diagonals below and above the main one.
_BAND = 5


@dataclass(frozen=True, kw_only=True, eq=False)
class Drag:
    """Linear drag: b (n+1, 2) [m/s] of the nodes, D (2, 2) [N s/m] of the body, b_turn [N m s] of its pitching."""

    b: Floats
    D: Complexes
    b_turn: float = 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class BandedResponse:
    """The matrix for given drag, top motion (p_n, q_n) `top` [m], and weights `scale` of T~^2 and phi~^2."""

    line: Line
    drag: Drag
    top: Complexes
    scale: Floats

    def solve(self, omega: float) -> Complexes:
        """States (n+1, 4) at a frequency [rad/s].

        Raises
        ------
        NumericalFailure
            The matrix is singular.
        """
        try:
            solution = solve_banded(
                (_BAND, _BAND), self.diagonals(omega), self._right_side, overwrite_ab=True, check_finite=False
            )
        except np.linalg.LinAlgError as error:
            raise NumericalFailure(f"The band matrix has no solution at {omega:g} rad/s: {error}") from error
        states: Complexes = solution[3:].reshape(-1, 4) * self._sizes
        return states

    def size_of(self, states: Complexes) -> float:
        """The largest of some states (n+1, 4) in the measure of `scale` [m]."""
        return float(np.max(np.abs(states / self._sizes)))

    def diagonals(self, omega: float) -> Complexes:
        """The matrix (11, 4n + 7) as `scipy.linalg.solve_banded` takes it."""
        rows, columns = self._places
        values = np.concatenate(
            [self._body(omega).ravel(), self._tow_point.ravel(), self._segments(omega).ravel(), [1.0, 1.0]]
        )
        band = np.zeros((2 * _BAND + 1, self._right_side.size), dtype=complex)
        band[_BAND + rows - columns, columns] = values
        return band

    @cached_property
    def _sizes(self) -> Floats:
        """(4,) what a state is counted in."""
        return np.array([self.scale[0] ** -0.5, self.scale[1] ** -0.5, 1.0, 1.0])

    @cached_property
    def _right_side(self) -> Complexes:
        right = np.zeros(4 * self.line.h.size + 7, dtype=complex)
        right[-2:] = self.top
        return right

    @cached_property
    def _places(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Row and column of every entry."""
        n = self.line.h.size
        first = 4 * np.arange(n)[:, None, None]
        body = np.indices((3, 5)).reshape(2, -1)
        # The tow point's motion by (P, Q, Phi), and p and q of node 0 less it.
        point_rows, point_columns = np.repeat([3, 4], 4), np.array([0, 1, 2, 5, 0, 1, 2, 6])
        rows = 5 + first + np.arange(4)[:, None] + np.zeros((1, 1, 8), dtype=int)
        columns = 3 + first + np.arange(8)[None, None, :] + np.zeros((1, 4, 1), dtype=int)
        last = 4 * n + 5
        return (
            np.concatenate([body[0], point_rows, rows.ravel(), [last, last + 1]]),
            np.concatenate([body[1], point_columns, columns.ravel(), [last, last + 1]]),
        )

    @cached_property
    def _tow_point_motion(self) -> Floats:
        """R (2, 3) of H (23)."""
        body = self.line.body
        sine, cosine, r_p, r_q = (body[i] for i in (c.BODY_SIN, c.BODY_COS, c.BODY_TOW_P, c.BODY_TOW_Q))
        turn = body[c.BODY_PITCHES] * np.array([r_p * sine - r_q * cosine, r_p * cosine + r_q * sine])
        return np.column_stack([[cosine, -sine], [sine, cosine], turn])

    @cached_property
    def _tow_point(self) -> Floats:
        return np.column_stack([self._tow_point_motion, [-1.0, -1.0]])

    def _body(self, omega: float) -> Complexes:
        """(3, 5) of (P, Q, Phi, T~, phi~): H v - G f = 0 of H (21)."""
        body, R = self.line.body, self._tow_point_motion
        height = body[c.BODY_SLOPE_SIN] * R[0] + body[c.BODY_SLOPE_COS] * R[1]
        relative = 1j * omega * np.eye(2, 3) + np.outer(body[[c.BODY_SHEAR_P, c.BODY_SHEAR_Q]], height)
        relative[:, 2] += body[[c.BODY_ANGLE_P, c.BODY_ANGLE_Q]]
        force = self.drag.D @ relative
        H = np.zeros((3, 3), dtype=complex)
        H[0, 0], H[1, 1] = -(omega**2) * body[c.BODY_MASS_P], -(omega**2) * body[c.BODY_MASS_Q]
        H[2, :2] = omega**2 * body[[c.BODY_CROSS_P, c.BODY_CROSS_Q]]
        H[:, 2] = body[[c.BODY_STIFF_P, c.BODY_STIFF_Q, c.BODY_STIFF_M]]
        H[2, 2] += -(omega**2) * body[c.BODY_INERTIA] + 1j * omega * self.drag.b_turn
        H[:2] += force
        H[2] += body[c.BODY_DRAG_P] * force[1] - body[c.BODY_DRAG_Q] * force[0]
        G = R.T * [1.0, body[c.BODY_TENSION]]
        if body[c.BODY_PITCHES] == 0.0:
            H[2], H[:2, 2], G[2] = [0.0, 0.0, 1.0], 0.0, 0.0
        return np.hstack([H, -G * self._sizes[:2]])

    def _segments(self, omega: float) -> Complexes:
        """(n, 4, 8) of the states at both ends of a segment: -(I + h/2 A_i), I - h/2 A_{i+1}."""
        change: Complexes = self._slopes(omega).reshape(-1, 2, 4, 4) * (0.5 * self.line.h[:, None, None, None])
        sides: list[Complexes] = [-(change[:, 0] + np.eye(4)), -(change[:, 1] - np.eye(4))]
        both: Complexes = np.concatenate(sides, axis=2)
        both *= np.tile(self._sizes, 2) / self._sizes[:, None]
        return both

    def _slopes(self, omega: float) -> Complexes:
        """A (2n, 4, 4) at both ends of every segment."""
        ends, b = self.line.ends.T, np.repeat(self.drag.b, 2, axis=0)[1:-1].T
        still = np.zeros(ends.shape[1])
        # Rows of (T~, phi~, p, q): height, strain, and both relative velocities.
        height: Complexes = np.array([still, still, ends[c.SINE], ends[c.COSINE]], dtype=complex)
        strain: Complexes = height * ends[c.SQUEEZE]
        strain[0] += ends[c.COMPLIANCE] / (1.0 + 1j * omega * ends[c.LOSS])
        v_t, v_n = ends[c.SHEAR_T] * height, ends[c.SHEAR_A] * height
        v_t[1] += ends[c.ANGLE_T]
        v_t[2] += 1j * omega
        v_n[1] += ends[c.ANGLE_A]
        v_n[3] += 1j * omega
        A = np.zeros((4, 4, ends.shape[1]), dtype=complex)
        A[0] = ends[c.DRAG_T] * b[0] * v_t + ends[c.STRAIN_T] * strain
        A[0, 1] += ends[c.WEIGHT_T]
        A[0, 2] -= omega**2 * ends[c.MASS]
        A[1] = ends[c.DRAG_A] * b[1] * v_n + ends[c.STRAIN_A] * strain
        A[1, 0] -= ends[c.CURVATURE_T]
        A[1, 1] -= ends[c.WEIGHT_A]
        A[1, 3] -= omega**2 * ends[c.MASS_A]
        A[2] = strain
        A[2, 3] += ends[c.CURVATURE]
        A[3, 1], A[3, 2] = ends[c.STRETCH], -ends[c.CURVATURE]
        slopes: Complexes = np.moveaxis(A, 2, 0)
        return slopes
