"""Forces of the sine series: the weak form of T (2.22) tested with (1 - x) and sin(m pi x).

Generalised coordinates y = (p_b, eta_1, Q_1 ... Q_N): tangential and normal deflection of the lower end in
the static frame there, and the sine amplitudes [m]. With v any of the shapes (1 - x), sin(m pi x),

    int v (m + m_a) q_tt ds + int v' T phi_d ds = int v (T_d phi_s' + f_n - f_n0 + f_t phi_d) ds + [end force],

where T = T_s + T_d, phi_d (1 + e) = q_s + p phi_s', f_n = -k_n v_r |v_r| with the one signed relative velocity
v_r = q_t + u sin(phi_s + phi_d), and f_t = -k_t u_r |u_r| with u_r = p_t - u cos(phi_s + phi_d); a sheared flow u
is taken at the moved depth. The gravity term w sin(phi_s) phi_d of the strong form sits in T' of the weak one. The
dynamic tension is

    T_d = EA/L [(1 + tau_a d/dt)(p_top - p_b - int q phi_s' ds) + 1/2 int phi_d^2 ds] + G(s),
    G' = w cos(phi_s) phi_d - f_t + f_t0,

G of zero mean, which carries T (2.33) with the tangential drag. A winch pays out l: p_top - l, L + l, and the
material's own motion (p_t + x l') phi_d in the normal velocity.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import fast_kernel
from models.spectral.basis import (
    AXIAL_LOSS,
    AXIAL_MASS,
    AXIAL_STIFFNESS,
    BEND,
    BEND_0,
    COSINE,
    CURVED,
    FLOW,
    FLOWING,
    LENGTH,
    MOVED,
    NORMAL_DRAG,
    QUADRATURE,
    SHEAR,
    SINE,
    STATIC_NORMAL,
    STATIC_TANGENTIAL,
    STATIC_TENSION,
    STRETCH,
    STRETCH_0,
    TANGENTIAL_DRAG,
    TENSION_0,
    TENSION_TOP,
    WEAK,
    WEIGHT,
    Fields,
    X,
)
from models.spectral.workspace import (
    ALONG,
    CHI,
    ETA_2,
    ETA_2_RATE,
    LOAD,
    LOAD_MASS,
    NORMAL,
    P_TOP,
    P_TOP_CHANGE,
    P_TOP_RATE,
    PAID,
    PAID_RATE,
    PHI,
    RATE,
    SLOPE,
    T_BOTTOM,
    T_TOP,
    TENSION,
    WATER,
    WORK,
)

Floats = NDArray[np.float64]


@fast_kernel
def _integral(f: Fields, station: Floats, of: int, to: int) -> float:
    """Fill row `to` of the workspace with the integral of row `of` from the vehicle on; that over the whole cable."""
    K, J = f.axial.shape[1:]
    whole = 0.0
    for j in range(J):
        station[to, j] = 0.0
    for k in range(K):
        c = 0.0
        for j in range(J):
            c += f.axial[0, k, j] * station[of, j]
        if k == 0:
            whole = c
        for j in range(J):
            station[to, j] += f.axial[1, k, j] * c
    return whole


@fast_kernel
def cable_forces(f: Fields, y: Floats, v: Floats, end: Floats, F: Floats, station: Floats) -> None:
    """Fill F (2 + N,) [N] and the station workspace; F[0] is what the whole cable pulls the vehicle with.

    `end` (END_ROWS,) is named above: the tensions at both ends are filled.
    """
    N, J = f.sines.shape[1:]
    p, field = f.scalar, f.station
    L, EA, w, k_t = p[LENGTH], p[AXIAL_STIFFNESS], p[WEIGHT], p[TANGENTIAL_DRAG]
    water, turn_s, turn_c = 0.0, 1.0, 0.0
    flowing, moved, curved = p[FLOWING] != 0.0, p[MOVED] != 0.0, p[CURVED] != 0.0
    lam = 1.0 + end[PAID] / L
    winch = end[PAID] != 0.0 or end[PAID_RATE] != 0.0
    slant, eta_1, eta_2 = (end[ETA_2] - y[1]) / (L * lam), y[1], end[ETA_2]
    v_1, v_2 = v[1], end[ETA_2_RATE] - v[1]
    for j in range(J):
        station[PHI, j] = slant
        station[RATE, j] = v_1 + v_2 * field[X, j]
    for n in range(N):
        a, d = y[2 + n] / lam, v[2 + n]
        for j in range(J):
            station[PHI, j] += a * f.sines[1, n, j]
            station[RATE, j] += d * f.sines[0, n, j]
    stretch, bend = end[P_TOP] - y[0], 0.0
    if curved:
        for j in range(J):
            station[WORK, j] = eta_1 + (eta_2 - eta_1) * field[X, j]
        for n in range(N):
            a = y[2 + n]
            for j in range(J):
                station[WORK, j] += a * f.sines[0, n, j]
        for j in range(J):
            station[NORMAL, j] = station[WORK, j] * field[BEND, j]
        bend = _integral(f, station, NORMAL, TENSION)
        stretch -= bend
        for j in range(J):
            # p(s), the axial deflection: the bend's share, and the uniform rest so that p meets both ends.
            axial = y[0] + field[X, j] * (end[P_TOP] - y[0] - bend) + station[TENSION, j]
            # Where the point x is, not the material that passes it: the payout moves it along.
            axial += field[X, j] * end[PAID]
            station[PHI, j] += axial * field[BEND, j] / lam
            sunk = axial * field[SINE, j] + station[WORK, j] * field[COSINE, j]
            station[WATER, j] = field[FLOW, j] + field[SHEAR, j] * sunk
            station[NORMAL, j] = station[RATE, j] * field[BEND, j]
        bend = _integral(f, station, NORMAL, ALONG)
    slip_0, slip_1 = v[0], end[P_TOP_RATE] - v[0] - bend
    bow = 0.0
    for j in range(J):
        slip = slip_0 + slip_1 * field[X, j]
        station[ALONG, j] = slip + station[ALONG, j] if curved else slip
        phi = station[PHI, j] * field[STRETCH, j]
        station[PHI, j] = phi
        bow += field[QUADRATURE, j] * phi * phi
    # The internal loss sees the linear part of the stretch's rate.
    stretch += 0.5 * lam * bow + p[AXIAL_LOSS] * slip_1
    mean_tension = EA / (L * lam) * stretch

    # Tangential: drag and the turned weight tilt the dynamic tension about its mean.
    for j in range(J):
        phi, v_r, slip = station[PHI, j], station[RATE, j], station[ALONG, j]
        if winch:
            v_r -= (slip + field[X, j] * end[PAID_RATE]) * phi
        weight = field[QUADRATURE, j] * lam
        if flowing:
            water, turn_s, turn_c = station[WATER, j] if curved else field[FLOW, j], field[SINE, j], field[COSINE, j]
            if moved:
                sine, cosine = math.sin(phi), math.cos(phi)
                turn_s, turn_c = turn_s * cosine + turn_c * sine, turn_c * cosine - turn_s * sine
            slip -= water * turn_c
            v_r += water * turn_s
        f_t = -k_t * slip * abs(slip)
        drag = field[NORMAL_DRAG, j] * abs(v_r)
        station[SLOPE, j] = 2.0 * weight * drag
        station[CHI, j] = -weight * f_t
        if flowing and moved:
            station[CHI, j] += station[SLOPE, j] * water * turn_c
        station[NORMAL, j] = weight * (f_t * phi - drag * v_r - field[STATIC_NORMAL, j])
        turned = (w * field[COSINE, j] * phi - f_t) * lam
        station[WORK, j] = turned + field[STATIC_TANGENTIAL, j] + w * field[SINE, j] * (lam - 1.0)
    tilt, mean_tilt = _integral(f, station, WORK, TENSION), 0.0
    for j in range(J):
        mean_tilt += field[QUADRATURE, j] * station[TENSION, j]
    T_0 = mean_tension - mean_tilt / L
    F[0] = p[TENSION_0] + T_0
    # What moves along the cable takes its tension: m p_tt is its slope, p_tt linear between the ends.
    m, a_2 = p[AXIAL_MASS] * L * lam, end[P_TOP_CHANGE]
    a_1 = (F[0] + end[LOAD] - m / 6.0 * a_2) / (end[LOAD_MASS] + m / 3.0) if m > 0.0 else 0.0
    T_0 -= m * (a_1 / 3.0 + a_2 / 6.0)
    end[T_BOTTOM] = p[TENSION_0] + T_0
    end[T_TOP] = p[TENSION_TOP] + T_0 + tilt + 0.5 * m * (a_1 + a_2)
    F_1 = 0.0
    for j in range(J):
        x = field[X, j]
        T_d = T_0 + station[TENSION, j] + m * x * (a_1 + 0.5 * (a_2 - a_1) * x)
        T = field[STATIC_TENSION, j] + T_d
        a = -field[QUADRATURE, j] * T * station[PHI, j]
        # The cable paid out carries the static load too, and spreads the static bend over its length.
        spread = T_d - (lam - 1.0) * field[STATIC_TENSION, j]
        b = station[NORMAL, j] + field[QUADRATURE, j] * field[BEND, j] * spread
        F_1 += b * (1.0 - x) - a / L
        station[TENSION, j], station[WORK, j], station[NORMAL, j] = T, a, b
    F[1] = F_1
    for n in range(N):
        total = 0.0
        for j in range(J):
            total += station[WORK, j] * f.sines[1, n, j] + station[NORMAL, j] * f.sines[0, n, j]
        F[2 + n] = total
    if p[WEAK] == 0.0:
        angle = slant
        for n in range(N):
            angle += (n + 1) * math.pi / (L * lam) * y[2 + n]
        F[1] = end[T_BOTTOM] * (angle + y[0] * p[BEND_0]) * p[STRETCH_0]
