"""Quadratic drag linearised: one velocity component in a steady flow, and the coupled drag of a body.

`harmonic` and `gaussian` replace |v + U|(v + U) - U|U| by b v for a sinusoid of amplitude z, and for a normal
process of standard deviation sigma (H section III, random form with sigma that of the velocity itself):

    U = 0           b = 8 z/(3 pi)
    z <= |U|        b = 2 |U|
    z >  |U| > 0    b = 4/(pi z) [U z asin(U/z) + (U^2 + 2 z^2)/3 sqrt(1 - U^2/z^2)]
    random          b = 2 E|v + U|

The coupled drag of a body is linearised by harmonic balance: with relative velocities V_j e^{i theta} about a mean
and J_ij the derivatives of the force, its first harmonic is exactly

    F_i = sum_j D_ij V_j,   D_ij = <J_ij> - <J_ij e^{-2 i theta}> conj(V_j)/V_j,

for a towfish in closed form from the harmonics of sgn(y), for a point body by a sum over phases, which errs by up to
2 % of the smaller force where the body moves mostly along one axis.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel, inner_kernel, kernel
from models.transfer_matrix.columns import (
    BODY_COUPLED,
    BODY_FLOW_P,
    BODY_FLOW_Q,
    BODY_K_P,
    BODY_K_Q,
    BODY_PITCHES,
)

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

#: Phases at which the drag of a point body is taken, and the share of its velocity below which a component is aside.
_PHASES, _ASIDE = 256, 1e-3


@kernel
def harmonic(z: float, flow: float) -> float:
    """b [m/s] of a sinusoid of velocity amplitude z about a flow of any sign [m/s]."""
    U = abs(flow)
    if z <= U:
        return 2.0 * U
    if U == 0.0:
        return 8.0 / (3.0 * math.pi) * z
    x = U / z
    return 4.0 / math.pi * (U * math.asin(x) + z * (x * x + 2.0) / 3.0 * math.sqrt(1.0 - x * x))


@kernel
def mean_speed(sigma: float, flow: float) -> float:
    """E|v + U| [m/s] of a normal process about a flow [m/s]."""
    U = abs(flow)
    if sigma <= 1e-8 * U:
        return U
    if sigma == 0.0:
        return 0.0
    x = U / (math.sqrt(2.0) * sigma)
    return sigma * math.sqrt(2.0 / math.pi) * math.exp(-x * x) + U * math.erf(x)


@kernel
def gaussian(sigma: float, flow: float) -> float:
    """b [m/s] of a normal process of velocity, standard deviation sigma, about a flow [m/s]."""
    return 2.0 * mean_speed(sigma, flow)


@inner_kernel
def _signs(amplitude: complex, mean: float, c: Complexes) -> None:
    """Fill c (4,) with <sgn(mean + Re(amplitude e^{i theta})) e^{-i k theta}>, k from 0 to 3."""
    size = abs(amplitude)
    if size <= abs(mean):
        c[0], c[1], c[2], c[3] = np.sign(mean), 0.0, 0.0, 0.0
        return
    half = math.acos(-mean / size)
    turn = amplitude / size
    c[0] = 2.0 * half / math.pi - 1.0
    c[1] = 2.0 * math.sin(half) / math.pi * turn
    c[2] = math.sin(2.0 * half) / math.pi * turn * turn
    c[3] = 2.0 * math.sin(3.0 * half) / (3.0 * math.pi) * turn * turn * turn


@inline_kernel
def _balanced(c: Complexes, amplitude: complex, mean: float, other: complex) -> complex:
    """<J> - <J e^{-2 i theta}> other, for J = sgn(y) (mean + Re(amplitude e^{i theta})) and c the signs of y."""
    level = mean * c[0] + (amplitude * c[1].conjugate() + amplitude.conjugate() * c[1]) / 2.0
    twice = mean * c[2] + (amplitude * c[1] + amplitude.conjugate() * c[3]) / 2.0
    balanced: complex = level - twice * other
    return balanced


@inner_kernel
def body_harmonic(body: Floats, u: complex, v: complex, D: Complexes) -> None:
    """Fill D (2, 2) [N s/m] for relative velocities u, v e^{i om t} along P and Q [m/s]."""
    k_p, k_q, u_0, v_0 = body[BODY_K_P], body[BODY_K_Q], body[BODY_FLOW_P], body[BODY_FLOW_Q]
    D[0, 0] = k_p * harmonic(abs(u), u_0)
    D[1, 1] = k_q * harmonic(abs(v), v_0)
    D[0, 1] = 0.0
    D[1, 0] = 0.0
    if body[BODY_COUPLED] == 0.0:
        return
    a = u.conjugate() / u if u != 0.0 else 0.0j
    b = v.conjugate() / v if v != 0.0 else 0.0j
    if body[BODY_PITCHES] > 0.0:
        # A towfish: k_q |y| x along P, k_p |x| y along Q beside its own parts.
        c = np.empty(4, dtype=np.complex128)
        _signs(v, v_0, c)
        D[0, 0] += k_q * _balanced(c, v, v_0, a)
        D[0, 1] = k_q * _balanced(c, u, u_0, b)
        _signs(u, u_0, c)
        D[1, 1] += k_p * _balanced(c, u, u_0, b)
        D[1, 0] = k_p * _balanced(c, v, v_0, a)
        return
    # A point: k |V| V. One that moves along one axis alone is in closed form: |x| x there, |x| y across.
    along_x, along_y = abs(u) + abs(u_0), abs(v) + abs(v_0)
    c = np.empty(4, dtype=np.complex128)
    if along_y <= _ASIDE * along_x:
        _signs(u, u_0, c)
        D[1, 1], D[1, 0] = k_p * _balanced(c, u, u_0, b), k_p * _balanced(c, v, v_0, a)
        return
    if along_x <= _ASIDE * along_y:
        _signs(v, v_0, c)
        D[0, 0], D[0, 1] = k_p * _balanced(c, v, v_0, a), k_p * _balanced(c, u, u_0, b)
        return
    for i in range(_PHASES):
        turn = np.exp(1j * (2.0 * math.pi * (i + 0.5) / _PHASES))
        x, y = u_0 + (u * turn).real, v_0 + (v * turn).real
        speed = math.hypot(x, y)
        if speed > 0.0:
            back = turn.conjugate() * turn.conjugate()
            along, across = k_p * (1.0 - back * a) / _PHASES, k_p * (1.0 - back * b) / _PHASES
            D[0, 0] += along * (speed + x * x / speed - 2.0 * abs(x))
            D[0, 1] += across * x * y / speed
            D[1, 0] += along * x * y / speed
            D[1, 1] += across * (speed + y * y / speed - 2.0 * abs(y))


def body_gaussian(body: Floats, covariance: Floats) -> Complexes:
    """D (2, 2) [N s/m], the mean derivative of the drag over normal relative velocities.

    `covariance` (2, 2) [m2/s2] of the velocities along P and Q, about the mean flow of `body`. For normal processes
    the mean derivative is the best linear form, with the coupling kept.
    """
    k_p, k_q, u_0, v_0 = (float(body[i]) for i in (BODY_K_P, BODY_K_Q, BODY_FLOW_P, BODY_FLOW_Q))
    sigma_u, sigma_v = (math.sqrt(max(float(covariance[i, i]), 0.0)) for i in (0, 1))
    D = np.array([[k_p * gaussian(sigma_u, u_0), 0.0], [0.0, k_q * gaussian(sigma_v, v_0)]], dtype=complex)
    if body[BODY_COUPLED] == 0.0:
        return D
    if body[BODY_PITCHES] == 0.0:
        return (k_p * _point_gaussian(np.array([u_0, v_0]), covariance)).astype(complex)
    both = float(covariance[0, 1])
    D[0, 0] += k_q * mean_speed(sigma_v, v_0)
    D[1, 1] += k_p * mean_speed(sigma_u, u_0)
    D[0, 1] = k_q * _signed(u_0, v_0, sigma_v, both)
    D[1, 0] = k_p * _signed(v_0, u_0, sigma_u, both)
    return D


def _signed(x_0: float, y_0: float, sigma_y: float, covariance: float) -> float:
    """E[sgn(y) x] of jointly normal x and y."""
    if sigma_y <= 1e-8 * abs(y_0):
        return math.copysign(x_0, x_0 * y_0) if y_0 != 0.0 else 0.0
    if sigma_y == 0.0:
        return 0.0
    z = y_0 / (math.sqrt(2.0) * sigma_y)
    return x_0 * math.erf(z) + covariance / sigma_y * math.sqrt(2.0 / math.pi) * math.exp(-z * z)


def _point_gaussian(mean: Floats, covariance: Floats) -> Floats:
    """E of the derivatives of |V| V, by Gauss-Hermite quadrature along the principal axes."""
    abscissae, weights = np.polynomial.hermite_e.hermegauss(40)
    value, axes = np.linalg.eigh(covariance)
    spread = axes * np.sqrt(np.maximum(value, 0.0))
    x, y = np.meshgrid(abscissae, abscissae)
    V = mean[:, None, None] + spread[:, 0, None, None] * x + spread[:, 1, None, None] * y
    speed = np.hypot(V[0], V[1])
    safe = np.where(speed > 0.0, speed, 1.0)
    share = np.outer(weights, weights) / (2.0 * math.pi)
    outer = np.array([[V[i] * V[j] / safe for j in range(2)] for i in range(2)])
    derivative: Floats = (share * (speed * np.eye(2)[:, :, None, None] + outer)).sum(axis=(2, 3))
    return derivative
