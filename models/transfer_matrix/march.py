"""The iteration of H section III over all frequencies: solve, linearise the drag anew, until the deflection stands.

Each frequency starts from the drag of the one before. The new drag is mixed with the old by a factor that follows
the residual (the dynamic relaxation of Irons and Tuck): with r_k = b(y_k) - b_k,

    b_{k+1} = b_k + theta_k r_k,   theta_k = -theta_{k-1} r_{k-1} . (r_k - r_{k-1})/|r_k - r_{k-1}|^2,

kept within bounds, which ends the swinging between two drags where the response is ruled by its damping.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, inner_kernel, kernel
from models.transfer_matrix.columns import (
    BODY_ANGLE_P,
    BODY_ANGLE_Q,
    BODY_K_P,
    BODY_K_Q,
    BODY_K_TURN,
    BODY_PITCHES,
    BODY_SHEAR_P,
    BODY_SHEAR_Q,
    BODY_SLOPE_COS,
    BODY_SLOPE_SIN,
    NODE_ANGLE_A,
    NODE_ANGLE_T,
    NODE_COSINE,
    NODE_FLOW_A,
    NODE_FLOW_T,
    NODE_FORCE_A,
    NODE_FORCE_T,
    NODE_LENGTH,
    NODE_SHEAR_A,
    NODE_SHEAR_T,
    NODE_SINE,
)
from models.transfer_matrix.drag import body_harmonic, harmonic
from models.transfer_matrix.solve import lower_end, product, sweep

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Integers = NDArray[np.int64]

#: Where the relaxation begins, and its bounds.
_THETA, _LEAST, _MOST = 0.8, 0.1, 1.0


@inline_kernel
def _relative(omega: float, nodes: Floats, i: int, y: Complexes) -> tuple[complex, complex]:
    """Tangential and normal relative velocity of node i."""
    height = y[i, 2] * nodes[i, NODE_SINE] + y[i, 3] * nodes[i, NODE_COSINE]
    v_t = 1j * omega * y[i, 2] + nodes[i, NODE_ANGLE_T] * y[i, 1] + nodes[i, NODE_SHEAR_T] * height
    v_n = 1j * omega * y[i, 3] + nodes[i, NODE_ANGLE_A] * y[i, 1] + nodes[i, NODE_SHEAR_A] * height
    return v_t, v_n


@kernel
def solve_with(
    omegas: Floats,
    ends: Floats,
    h: Floats,
    body: Floats,
    scales: Floats,
    tops: Complexes,
    compensator: Floats,
    b: Floats,
    D: Complexes,
    b_turn: float,
    by_product: bool,
    y: Complexes,
    v: Complexes,
    digits: Floats,
) -> int:
    """Responses y (k, n+1, 4) and v (k, 3) for given drag; -1, or the frequency that cannot be solved.

    The drag is b (n+1, 2) [m/s] of the cable, D (2, 2) [N s/m] of the body and b_turn [N m s] of its pitching.
    `tops` (k, 2) are p_n, q_n at the top, or of the vessel's deck where `compensator` (mass, stiffness, damping) has
    its fourth entry set; `digits` (k,) is what the product of matrices keeps.
    """
    n = h.size
    first, motion = np.zeros((2, 4), dtype=np.complex128), np.zeros((2, 3), dtype=np.complex128)
    basis, growth = np.zeros((n + 1, 8), dtype=np.complex128), np.zeros((n + 1, 3), dtype=np.complex128)
    steps = np.zeros((n + 1 if by_product else 0, 4, 4), dtype=np.complex128)
    free = np.zeros(2, dtype=np.complex128)
    for k in range(omegas.size):
        digits[k] = _solve(
            omegas[k], ends, h, body, scales[k], tops[k], compensator, b, D, b_turn, by_product,
            first, motion, basis, growth, steps, free, y[k], v[k],
        )  # fmt: skip
        if digits[k] < 0.0:
            return k
    return -1


@inner_kernel
def _solve(
    omega: float,
    ends: Floats,
    h: Floats,
    body: Floats,
    scale: Floats,
    top: Complexes,
    compensator: Floats,
    b: Floats,
    D: Complexes,
    b_turn: float,
    by_product: bool,
    first: Complexes,
    motion: Complexes,
    basis: Complexes,
    growth: Complexes,
    steps: Complexes,
    free: Complexes,
    y: Complexes,
    v: Complexes,
) -> float:
    """One linear solve; digits of the product (16 by the sweep), or -1 where it failed."""
    n = h.size
    lower_end(omega, body, D, b_turn, scale, first, motion)
    moved = top
    sprung = compensator[3] != 0.0
    if sprung:
        moved = np.array([1.0 + 0.0j, 0.0j])
    digits = 16.0
    if by_product:
        digits = product(omega, ends, h, b, first, moved, steps, y, free)
    elif not sweep(omega, ends, h, b, first, scale, moved, basis, growth, y, free):
        return -1.0
    factor = 1.0 + 0.0j
    if sprung:
        # H (27): p_n = Z D, with c = T_n/p_n - om^2 m.
        held = y[n, 0] - omega * omega * compensator[0]
        spring = compensator[1] + 1j * omega * compensator[2]
        if abs(held + spring) == 0.0:
            return -1.0
        factor = spring / (held + spring) * top[0]
        for i in range(n + 1):
            for m in range(4):
                y[i, m] *= factor
    for m in range(3):
        v[m] = (motion[0, m] * free[0] + motion[1, m] * free[1]) * factor
    if not (math.isfinite(abs(v[0])) and math.isfinite(abs(y[n, 0])) and math.isfinite(abs(y[0, 0]))):
        return 0.0 if by_product else -1.0
    return digits


@kernel
def harmonic_march(
    omegas: Floats,
    ends: Floats,
    nodes: Floats,
    h: Floats,
    body: Floats,
    scales: Floats,
    tops: Complexes,
    compensator: Floats,
    by_product: bool,
    tolerance: float,
    most: int,
    y: Complexes,
    v: Complexes,
    b: Floats,
    D: Complexes,
    iterations: Integers,
    change: Floats,
    digits: Floats,
) -> int:
    """Responses under sinusoidal motion of the top, drag iterated; -1, or the frequency that cannot be solved.

    `b` (n+1, 2) and `D` (2, 2) are the first guess and come back as the last frequency's; `change` (k,) is H's norm
    int |dp|^2 + |dq|^2 ds / (L (|p_n|^2 + |q_n|^2)) of the last iteration. A frequency ends at `tolerance` or after
    `most` solves.
    """
    n = h.size
    first, motion = np.zeros((2, 4), dtype=np.complex128), np.zeros((2, 3), dtype=np.complex128)
    basis, growth = np.zeros((n + 1, 8), dtype=np.complex128), np.zeros((n + 1, 3), dtype=np.complex128)
    steps = np.zeros((n + 1 if by_product else 0, 4, 4), dtype=np.complex128)
    free = np.zeros(2, dtype=np.complex128)
    before = np.zeros((n + 1, 2), dtype=np.complex128)
    residual, last = np.zeros((n + 1, 2)), np.zeros((n + 1, 2))
    D_new, D_last = np.zeros((2, 2), dtype=np.complex128), np.zeros((2, 2), dtype=np.complex128)
    b_turn, strength = 0.0, max(body[BODY_K_P], body[BODY_K_Q])
    length = h.sum()
    for k in range(omegas.size):
        omega = omegas[k]
        imposed = length * (abs(tops[k, 0]) ** 2 + abs(tops[k, 1]) ** 2)
        theta = _THETA
        change[k] = np.inf
        for iteration in range(most):
            digits[k] = _solve(
                omega, ends, h, body, scales[k], tops[k], compensator, b, D, b_turn, by_product,
                first, motion, basis, growth, steps, free, y[k], v[k],
            )  # fmt: skip
            iterations[k] = iteration + 1
            if digits[k] < 0.0:
                return k
            if digits[k] == 0.0:
                break
            moved = 0.0
            for i in range(n + 1):
                d_p, d_q = y[k, i, 2] - before[i, 0], y[k, i, 3] - before[i, 1]
                square = d_p.real * d_p.real + d_p.imag * d_p.imag + d_q.real * d_q.real + d_q.imag * d_q.imag
                moved += square * nodes[i, NODE_LENGTH]
                before[i, 0], before[i, 1] = y[k, i, 2], y[k, i, 3]
            if iteration > 0:
                change[k] = moved / imposed
                if change[k] <= tolerance:
                    break
            # The drag that this motion asks for, and how far it is from the one assumed.
            along, size = 0.0, 0.0
            for i in range(n + 1):
                v_t, v_n = _relative(omega, nodes, i, y[k])
                r_t = harmonic(abs(v_t), nodes[i, NODE_FLOW_T]) - b[i, 0]
                r_n = harmonic(abs(v_n), nodes[i, NODE_FLOW_A]) - b[i, 1]
                d_t, d_n = r_t - last[i, 0], r_n - last[i, 1]
                along += last[i, 0] * d_t * nodes[i, NODE_FORCE_T] + last[i, 1] * d_n * nodes[i, NODE_FORCE_A]
                size += d_t * d_t * nodes[i, NODE_FORCE_T] + d_n * d_n * nodes[i, NODE_FORCE_A]
                residual[i, 0], residual[i, 1] = r_t, r_n
            _body_drag(omega, body, y[k, 0], v[k], D_new)
            for i in range(2):
                for m in range(2):
                    r = D_new[i, m] - D[i, m]
                    D_new[i, m] = r
                    if strength > 0.0:
                        d = r - D_last[i, m]
                        along += (D_last[i, m].real * d.real + D_last[i, m].imag * d.imag) / strength
                        size += (d.real * d.real + d.imag * d.imag) / strength
                    D_last[i, m] = r
            turn = body[BODY_K_TURN] * harmonic(omega * abs(v[k, 2]), 0.0) if body[BODY_PITCHES] > 0.0 else 0.0
            if iteration > 0 and size > 0.0:
                theta = min(max(-theta * along / size, _LEAST), _MOST)
            for i in range(n + 1):
                for m in range(2):
                    b[i, m] += theta * residual[i, m]
                    last[i, m] = residual[i, m]
            for i in range(2):
                for m in range(2):
                    D[i, m] += theta * D_new[i, m]
            b_turn += theta * (turn - b_turn)
    return -1


@inner_kernel
def _body_drag(omega: float, body: Floats, y: Complexes, v: Complexes, D: Complexes) -> None:
    """Linearised drag of the body in the motion v, the tow point's states being y."""
    height = body[BODY_SLOPE_SIN] * y[2] + body[BODY_SLOPE_COS] * y[3]
    along = 1j * omega * v[0] + body[BODY_ANGLE_P] * v[2] + body[BODY_SHEAR_P] * height
    across = 1j * omega * v[1] + body[BODY_ANGLE_Q] * v[2] + body[BODY_SHEAR_Q] * height
    body_harmonic(body, along, across, D)
