"""The linear solve at one frequency: the cable's four states by trapezoidal steps, from the body to the imposed top.

    (I - h/2 A_{i+1}) y_{i+1} = (I + h/2 A_i) y_i,   y = (T~, phi~, p, q)            H (12)

with A of `models.transfer_matrix.line`. The body leaves two of the four states at the lower end free, the top
motion fixes them. `product` multiplies the steps together as H (13), (23)-(26) does: where lateral waves are damped
over many of their lengths the columns of the product become parallel to rounding and nothing is left. `sweep` solves
the same equations by carrying an orthonormal basis of the solutions that satisfy the lower end: directions that grow
upward stay apart, and the way back down divides by what grew. Both cost O(n).
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, inner_kernel
from models.transfer_matrix.columns import (
    ANGLE_A,
    ANGLE_T,
    BODY_ANGLE_P,
    BODY_ANGLE_Q,
    BODY_COS,
    BODY_CROSS_P,
    BODY_CROSS_Q,
    BODY_DRAG_P,
    BODY_DRAG_Q,
    BODY_INERTIA,
    BODY_MASS_P,
    BODY_MASS_Q,
    BODY_PITCHES,
    BODY_SHEAR_P,
    BODY_SHEAR_Q,
    BODY_SIN,
    BODY_SLOPE_COS,
    BODY_SLOPE_SIN,
    BODY_STIFF_M,
    BODY_STIFF_P,
    BODY_STIFF_Q,
    BODY_TENSION,
    BODY_TOW_P,
    BODY_TOW_Q,
    COMPLIANCE,
    COSINE,
    CURVATURE,
    CURVATURE_T,
    DRAG_A,
    DRAG_T,
    LOSS,
    MASS,
    MASS_A,
    SHEAR_A,
    SHEAR_T,
    SINE,
    SQUEEZE,
    STRAIN_A,
    STRAIN_T,
    STRETCH,
    WEIGHT_A,
    WEIGHT_T,
)

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Scalars = tuple[complex, ...]


@inline_kernel
def _slopes(ends: Floats, j: int, omega: float, b_t: float, b_a: float) -> Scalars:
    """The entries of A at a row of `ends` that are not zero, by row: T~ (4), phi~ (4), p (3), q (2)."""
    squeeze, sine, cosine = ends[j, SQUEEZE], ends[j, SINE], ends[j, COSINE]
    force_t, force_a = ends[j, DRAG_T] * b_t, ends[j, DRAG_A] * b_a
    strain_t, strain_a = ends[j, STRAIN_T], ends[j, STRAIN_A]
    height_t = force_t * ends[j, SHEAR_T] + strain_t * squeeze
    height_a = force_a * ends[j, SHEAR_A] + strain_a * squeeze
    give = ends[j, COMPLIANCE] / (1.0 + 1j * omega * ends[j, LOSS])
    curvature = ends[j, CURVATURE]
    return (
        strain_t * give,
        ends[j, WEIGHT_T] + force_t * ends[j, ANGLE_T],
        -ends[j, MASS] * omega * omega + height_t * sine + 1j * omega * force_t,
        height_t * cosine,
        -ends[j, CURVATURE_T] + strain_a * give,
        -ends[j, WEIGHT_A] + force_a * ends[j, ANGLE_A],
        height_a * sine,
        -ends[j, MASS_A] * omega * omega + height_a * cosine + 1j * omega * force_a,
        give,
        squeeze * sine,
        curvature + squeeze * cosine,
        ends[j, STRETCH],
        -curvature,
    )


@inline_kernel
def _inverse(z: complex) -> complex:
    """1/z; not a number for 0, where a compiled complex division would raise."""
    size = z.real * z.real + z.imag * z.imag
    return z.real / size - 1j * (z.imag / size)


@inline_kernel
def _segment(g: float, B: Scalars) -> Scalars:
    """What a step needs beside A at its lower end, B being A at the upper one and g half the segment's length.

    The last two rows of the upper matrix are real: S is the inverse of their block of (p, q), F = B_fw S, and K the
    inverse of the Schur complement for (T~, phi~).
    """
    b_tt, b_ta, b_tp, b_tq, b_at, b_aa, b_ap, b_aq, b_pt, b_pp, b_pq, b_qa, b_qp = B
    low = 1.0 - g * b_pp
    det = low - g * g * b_pq * b_qp
    s_pp, s_pq, s_qp, s_qq = 1.0 / det, g * b_pq / det, g * b_qp / det, low / det
    f_tp, f_tq = b_tp * s_pp + b_tq * s_qp, b_tp * s_pq + b_tq * s_qq
    f_ap, f_aq = b_ap * s_pp + b_aq * s_qp, b_ap * s_pq + b_aq * s_qq
    c_tt = 1.0 - g * b_tt - g * g * f_tp * b_pt
    c_ta = -g * b_ta - g * g * f_tq * b_qa
    c_at = -g * b_at - g * g * f_ap * b_pt
    c_aa = 1.0 - g * b_aa - g * g * f_aq * b_qa
    over = _inverse(c_tt * c_aa - c_ta * c_at)
    return (
        s_pp,
        s_pq,
        s_qp,
        s_qq,
        g * f_tp,
        g * f_tq,
        g * f_ap,
        g * f_aq,
        c_aa * over,
        -c_ta * over,
        -c_at * over,
        c_tt * over,
        g * b_pt,
        g * b_qa,
    )


@inline_kernel
def _advance(
    g: float, A: Scalars, step: Scalars, T: complex, a: complex, p: complex, q: complex
) -> tuple[complex, complex, complex, complex]:
    """One trapezoidal step of a state upward."""
    a_tt, a_ta, a_tp, a_tq, a_at, a_aa, a_ap, a_aq, a_pt, a_pp, a_pq, a_qa, a_qp = A
    s_pp, s_pq, s_qp, s_qq, f_tp, f_tq, f_ap, f_aq, k_tt, k_ta, k_at, k_aa, g_pt, g_qa = step
    r_t = T + g * (a_tt * T + a_ta * a + a_tp * p + a_tq * q)
    r_a = a + g * (a_at * T + a_aa * a + a_ap * p + a_aq * q)
    r_p = p + g * (a_pt * T + a_pp * p + a_pq * q)
    r_q = q + g * (a_qa * a + a_qp * p)
    r_t += f_tp * r_p + f_tq * r_q
    r_a += f_ap * r_p + f_aq * r_q
    T_next, a_next = k_tt * r_t + k_ta * r_a, k_at * r_t + k_aa * r_a
    r_p += g_pt * T_next
    r_q += g_qa * a_next
    return T_next, a_next, s_pp * r_p + s_pq * r_q, s_qp * r_p + s_qq * r_q


@inline_kernel
def _weighed(T: complex, a: complex, p: complex, q: complex, scale: Floats) -> float:
    """Square of a state's norm."""
    force: float = (T.real * T.real + T.imag * T.imag) * scale[0] + (a.real * a.real + a.imag * a.imag) * scale[1]
    return force + (p.real * p.real + p.imag * p.imag) + (q.real * q.real + q.imag * q.imag)


@inner_kernel
def sweep(
    omega: float,
    ends: Floats,
    h: Floats,
    b: Floats,
    first: Complexes,
    scale: Floats,
    top: Complexes,
    basis: Complexes,
    growth: Complexes,
    y: Complexes,
    free: Complexes,
) -> bool:
    """Solve for y (n+1, 4) with p, q = `top` at the last node; False where the top cannot be moved so.

    `first` (2, 4) are the two states that the lower end leaves free, `b` (n+1, 2) the linearised drag of the nodes
    [m/s], `scale` (2,) the weights of T~^2 and phi~^2 beside 1 for p^2 and q^2, `free` (2,) the shares of the
    states of `first`; `basis` (n+1, 8) and `growth` (n+1, 3) are for work.
    """
    n = h.size
    T0, a0, p0, q0 = first[0, 0], first[0, 1], first[0, 2], first[0, 3]
    T1, a1, p1, q1 = first[1, 0], first[1, 1], first[1, 2], first[1, 3]
    for i in range(n + 1):
        if i > 0:
            g = 0.5 * h[i - 1]
            A = _slopes(ends, 2 * i - 2, omega, b[i - 1, 0], b[i - 1, 1])
            B = _slopes(ends, 2 * i - 1, omega, b[i, 0], b[i, 1])
            step = _segment(g, B)
            T0, a0, p0, q0 = _advance(g, A, step, T0, a0, p0, q0)
            T1, a1, p1, q1 = _advance(g, A, step, T1, a1, p1, q1)
        r_0 = math.sqrt(_weighed(T0, a0, p0, q0, scale))
        T0, a0, p0, q0 = T0 / r_0, a0 / r_0, p0 / r_0, q0 / r_0
        share = (
            (T0.conjugate() * T1) * scale[0]
            + (a0.conjugate() * a1) * scale[1]
            + p0.conjugate() * p1
            + q0.conjugate() * q1
        )
        T1, a1, p1, q1 = T1 - share * T0, a1 - share * a0, p1 - share * p0, q1 - share * q0
        r_1 = math.sqrt(_weighed(T1, a1, p1, q1, scale))
        T1, a1, p1, q1 = T1 / r_1, a1 / r_1, p1 / r_1, q1 / r_1
        basis[i, 0], basis[i, 1], basis[i, 2], basis[i, 3] = T0, a0, p0, q0
        basis[i, 4], basis[i, 5], basis[i, 6], basis[i, 7] = T1, a1, p1, q1
        growth[i, 0], growth[i, 1], growth[i, 2] = r_0, share, r_1
    det = p0 * q1 - p1 * q0
    if not abs(det) > 0.0:
        return False
    over = _inverse(det)
    c0, c1 = (top[0] * q1 - p1 * top[1]) * over, (p0 * top[1] - top[0] * q0) * over
    for i in range(n, -1, -1):
        for k in range(4):
            y[i, k] = basis[i, k] * c0 + basis[i, 4 + k] * c1
        c1 = c1 / growth[i, 2].real
        c0 = (c0 - growth[i, 1] * c1) / growth[i, 0].real
    free[0], free[1] = c0, c1
    return True


@inner_kernel
def product(
    omega: float,
    ends: Floats,
    h: Floats,
    b: Floats,
    first: Complexes,
    top: Complexes,
    steps: Complexes,
    y: Complexes,
    free: Complexes,
) -> float:
    """As `sweep`, by the product of matrices; returns the decimal digits that the sums at the top have left.

    `steps` (n+1, 4, 4) is for work and holds the products beta_i.
    """
    n = h.size
    for k in range(4):
        for m in range(4):
            steps[0, k, m] = 1.0 if k == m else 0.0
    for i in range(n):
        g = 0.5 * h[i]
        A = _slopes(ends, 2 * i, omega, b[i, 0], b[i, 1])
        B = _slopes(ends, 2 * i + 1, omega, b[i + 1, 0], b[i + 1, 1])
        step = _segment(g, B)
        for m in range(4):
            T, a, p, q = _advance(g, A, step, steps[i, 0, m], steps[i, 1, m], steps[i, 2, m], steps[i, 3, m])
            steps[i + 1, 0, m], steps[i + 1, 1, m], steps[i + 1, 2, m], steps[i + 1, 3, m] = T, a, p, q
    w00, w01, w10, w11 = 0.0j, 0.0j, 0.0j, 0.0j
    for m in range(4):
        w00 += steps[n, 2, m] * first[0, m]
        w10 += steps[n, 3, m] * first[0, m]
        w01 += steps[n, 2, m] * first[1, m]
        w11 += steps[n, 3, m] * first[1, m]
    over = _inverse(w00 * w11 - w01 * w10)
    free[0], free[1] = (top[0] * w11 - w01 * top[1]) * over, (w00 * top[1] - top[0] * w10) * over
    lost = 0.0
    for m in range(4):
        own = first[0, m] * free[0], first[1, m] * free[1]
        for k in range(2, 4):
            lost += abs(steps[n, k, m]) * (abs(own[0]) + abs(own[1]))
        y[0, m] = own[0] + own[1]
    for i in range(1, n + 1):
        for k in range(4):
            y[i, k] = 0.0
            for m in range(4):
                y[i, k] += steps[i, k, m] * y[0, m]
    size = math.sqrt(abs(top[0]) ** 2 + abs(top[1]) ** 2)
    left = 16.0 - math.log10(max(lost / size, 1.0)) if math.isfinite(lost) and lost > 0.0 else 0.0
    return max(left, 0.0)


@inner_kernel
def lower_end(
    omega: float, body: Floats, D: Complexes, b_turn: float, scale: Floats, first: Complexes, motion: Complexes
) -> None:
    """The two states that the body leaves free, `first` (2, 4), and the body's motions (P, Q, Phi) with them, `motion`.

    H (21) and (23): H v = G f and w = R v, three equations for the five unknowns f = (T~, phi~) and v = (P, Q, Phi);
    eliminated with full pivoting, so that a body without mass, which lets no tension act, is a case like any other.
    """
    sine, cosine, T = body[BODY_SIN], body[BODY_COS], body[BODY_TENSION]
    r_p, r_q, s_p, s_q = body[BODY_TOW_P], body[BODY_TOW_Q], body[BODY_DRAG_P], body[BODY_DRAG_Q]
    square, pitches = omega * omega, body[BODY_PITCHES]
    R = np.zeros((2, 3))
    R[0, 0], R[0, 1], R[0, 2] = cosine, sine, pitches * (r_p * sine - r_q * cosine)
    R[1, 0], R[1, 1], R[1, 2] = -sine, cosine, pitches * (r_p * cosine + r_q * sine)
    relative = np.zeros((2, 3), dtype=np.complex128)
    relative[0, 0] = relative[1, 1] = 1j * omega
    relative[0, 2], relative[1, 2] = body[BODY_ANGLE_P], body[BODY_ANGLE_Q]
    for m in range(3):
        height = body[BODY_SLOPE_SIN] * R[0, m] + body[BODY_SLOPE_COS] * R[1, m]
        relative[0, m] += body[BODY_SHEAR_P] * height
        relative[1, m] += body[BODY_SHEAR_Q] * height
    M = np.zeros((3, 5), dtype=np.complex128)
    M[0, 0], M[0, 2] = -square * body[BODY_MASS_P], body[BODY_STIFF_P]
    M[1, 1], M[1, 2] = -square * body[BODY_MASS_Q], body[BODY_STIFF_Q]
    M[2, 0], M[2, 1] = square * body[BODY_CROSS_P], square * body[BODY_CROSS_Q]
    M[2, 2] = -square * body[BODY_INERTIA] + 1j * omega * b_turn + body[BODY_STIFF_M]
    for m in range(3):
        force_p = D[0, 0] * relative[0, m] + D[0, 1] * relative[1, m]
        force_q = D[1, 0] * relative[0, m] + D[1, 1] * relative[1, m]
        M[0, m] += force_p
        M[1, m] += force_q
        M[2, m] += s_p * force_q - s_q * force_p
    for k in range(2):
        for m in range(3):
            M[m, 3 + k] = -R[k, m] * (1.0 if k == 0 else T)
    if pitches == 0.0:
        for m in range(5):
            M[2, m] = 1.0 if m == 2 else 0.0
            if m < 2:
                M[m, 2] = 0.0
    size = np.array([1.0, 1.0, 1.0, 1.0 / math.sqrt(scale[0]), 1.0 / math.sqrt(scale[1])])
    for k in range(3):
        largest = 0.0
        for m in range(5):
            M[k, m] *= size[m]
            largest = max(largest, abs(M[k, m]))
        if largest > 0.0:
            for m in range(5):
                M[k, m] = M[k, m] * (1.0 / largest)
    order, solution = np.arange(5), np.zeros(5, dtype=np.complex128)
    for k in range(3):
        best, row, column = -1.0, k, k
        for i in range(k, 3):
            for m in range(k, 5):
                if abs(M[i, m]) > best:
                    best, row, column = abs(M[i, m]), i, m
        for m in range(5):
            M[k, m], M[row, m] = M[row, m], M[k, m]
        for i in range(3):
            M[i, k], M[i, column] = M[i, column], M[i, k]
        order[k], order[column] = order[column], order[k]
        if best <= 0.0:
            continue
        pivot = _inverse(M[k, k])
        for m in range(5):
            M[k, m] *= pivot
        for i in range(3):
            if i != k:
                factor = M[i, k]
                for m in range(5):
                    M[i, m] -= factor * M[k, m]
    for k in range(2):
        solution[order[3 + k]], solution[order[4 - k]] = 1.0, 0.0
        for i in range(3):
            solution[order[i]] = -M[i, 3 + k]
        for m in range(5):
            solution[m] *= size[m]
        for m in range(3):
            motion[k, m] = solution[m]
        first[k, 0], first[k, 1] = solution[3], solution[4]
        for j in range(2):
            first[k, 2 + j] = R[j, 0] * solution[0] + R[j, 1] * solution[1] + R[j, 2] * solution[2]
