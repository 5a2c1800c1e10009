"""The arrays of the solves on one mesh, the first guess of its drag, and the calls of the kernels."""

import numpy as np
from numpy.typing import NDArray

from models.transfer_matrix import columns as c
from models.transfer_matrix.drag import body_gaussian, harmonic
from models.transfer_matrix.line import Line
from models.transfer_matrix.march import harmonic_march, solve_with
from models.transfer_matrix.setup import Complexes, Floats, scales_of

#: Most solves of one frequency.
MOST_ITERATIONS = 200


class Work:
    """k frequencies on a mesh of n segments, under given motions of the top.

    Parameters
    ----------
    line
        The linearised tow.
    omega
        (k,) [rad/s].
    tops
        (k, 2) motion of the top along and across the cable [m].
    compensator
        (4,) mass, stiffness, damping and whether there is one.

    Attributes
    ----------
    states, motion
        (k, n+1, 4) and (k, 3), what was solved for last.
    iterations, change, digits
        (k,) of each frequency.
    b, D
        (n+1, 2) [m/s] and (2, 2) [N s/m], the drag of the last frequency of a march.
    """

    def __init__(self, line: Line, omega: Floats, tops: Complexes, compensator: Floats | None = None) -> None:
        k, n = omega.size, line.h.size
        self.line, self.omega, self.tops, self.scales = line, omega, tops, scales_of(line, omega)
        self.states, self.motion = np.zeros((k, n + 1, 4), dtype=complex), np.zeros((k, 3), dtype=complex)
        self.iterations: NDArray[np.int64] = np.zeros(k, dtype=np.int64)
        self.change, self.digits = np.full(k, np.inf), np.full(k, np.nan)
        self.b, self.D = self.first_guess()
        self._compensator = np.zeros(4) if compensator is None else compensator

    def first_guess(self) -> tuple[Floats, Complexes]:
        """b and D of a cable that follows its top along itself and a tenth of it across."""
        speed = float(self.omega[0] * np.linalg.norm(self.tops[0]))
        flow = self.line.nodes[:, [c.NODE_FLOW_T, c.NODE_FLOW_A]].tolist()
        b = np.array([[harmonic(speed, along), harmonic(0.1 * speed, across)] for along, across in flow])
        return b, body_gaussian(self.line.body, np.diag([(0.1 * speed) ** 2, speed**2]))

    def march(self, *, tolerance: float, most: int = MOST_ITERATIONS, by_product: bool = False) -> int:
        """Iterate the drag of every frequency from the first guess; -1, or the frequency that cannot be solved."""
        line = self.line
        self.b, self.D = self.first_guess()
        failed: int = harmonic_march(
            self.omega, line.ends, line.nodes, line.h, line.body, self.scales, self.tops, self._compensator, by_product,
            tolerance, most, self.states, self.motion, self.b, self.D, self.iterations, self.change, self.digits,
        )  # fmt: skip
        return failed

    def solve(
        self, b: Floats, D: Complexes, b_turn: float, *, by_product: bool = False, line: Line | None = None
    ) -> int:
        """Solve every frequency once with the same drag, of another `line` where given; -1, or where it failed."""
        on = self.line if line is None else line
        failed: int = solve_with(
            self.omega, on.ends, on.h, on.body, self.scales, self.tops, self._compensator, b, D, b_turn, by_product,
            self.states, self.motion, self.digits,
        )  # fmt: skip
        return failed
