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
    AXIAL_STIFFNESS,
    BEND,
    BEND_0,
    COSINE,
    CURVED,
    FLOW,
    FLOWING,
    LATERAL_MASS,
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

Floats = NDArray[np.float64]

#: Rows of the station workspace.
PHI, TENSION, SLOPE, CHI, WORK, RATE, NORMAL, ALONG, WATER = range(9)
WORK_ROWS = 9


@fast_kernel
def cable_forces(f: Fields, y: Floats, v: Floats, end: Floats, F: Floats, station: Floats, grad: Floats) -> None:
    """Fill F (2 + N,) [N], the station workspace and the gradient of the stretch `grad` (2 + N,).

    `end` is (p_top - l, its rate, eta_2, its rate, l, l', T_top): the last is filled with the tension at the top.
    F[0] is the tension at the vehicle.
    """
    S, D, St, Dt = f.sines[0], f.sines[1], f.sines_t[0], f.sines_t[1]
    N, J = S.shape
    p, field = f.scalar, f.station
    x, c, stretch_s, bend_s = field[X], field[QUADRATURE], field[STRETCH], field[BEND]
    sin_s, cos_s, flow, shear = field[SINE], field[COSINE], field[FLOW], field[SHEAR]
    T_s, k_n = field[STATIC_TENSION], field[NORMAL_DRAG]
    L, EA, w, k_t = p[LENGTH], p[AXIAL_STIFFNESS], p[WEIGHT], p[TANGENTIAL_DRAG]
    flowing, moved = p[FLOWING] != 0.0, p[MOVED] != 0.0
    lam = 1.0 + end[4] / L
    winch = end[4] != 0.0 or end[5] != 0.0
    phi, T, slope, chi = station[PHI], station[TENSION], station[SLOPE], station[CHI]
    q, rate, b, along, water = station[WORK], station[RATE], station[NORMAL], station[ALONG], station[WATER]
    slant = (end[2] - y[1]) / (L * lam)
    for j in range(J):
        phi[j] = slant
        water[j] = flow[j]
        rate[j] = v[1] * (1.0 - x[j]) + end[3] * x[j]
    for n in range(N):
        a, d = y[2 + n] / lam, v[2 + n]
        for j in range(J):
            phi[j] += a * D[n, j]
            rate[j] += d * S[n, j]
    stretch = end[0] - y[0]
    K = f.axial.shape[1]
    coefficient = np.zeros(K)
    bend = 0.0
    if p[CURVED] != 0.0:
        for j in range(J):
            q[j] = y[1] * (1.0 - x[j]) + end[2] * x[j]
        for n in range(N):
            a = y[2 + n]
            for j in range(J):
                q[j] += a * S[n, j]
        for j in range(J):
            g = q[j] * bend_s[j]
            for k in range(K):
                coefficient[k] += f.axial[0, k, j] * g
        bend = coefficient[0]
        stretch -= bend
        for j in range(J):
            # p(s), the axial deflection: the bend's share, and the uniform rest so that p meets both ends.
            axial = y[0] + x[j] * (end[0] - y[0] - bend)
            for k in range(K):
                axial += f.axial[1, k, j] * coefficient[k]
            # Where the point x is, not the material that passes it: the payout moves it along.
            axial += x[j] * end[4]
            phi[j] += axial * bend_s[j] / lam
            water[j] += shear[j] * (axial * sin_s[j] + q[j] * cos_s[j])
        for k in range(K):
            coefficient[k] = 0.0
        for j in range(J):
            g = rate[j] * bend_s[j]
            for k in range(K):
                coefficient[k] += f.axial[0, k, j] * g
        bend = coefficient[0]
    for j in range(J):
        along[j] = v[0] + x[j] * (end[1] - v[0] - bend)
        if p[CURVED] != 0.0:
            for k in range(K):
                along[j] += f.axial[1, k, j] * coefficient[k]
        phi[j] *= stretch_s[j]
        stretch += 0.5 * lam * c[j] * phi[j] * phi[j]
    # The internal loss sees the linear part of the stretch's rate.
    stretch += p[AXIAL_LOSS] * (end[1] - v[0] - bend)
    mean_tension = EA / (L * lam) * stretch

    # Tangential: drag and the turned weight tilt the dynamic tension about its mean.
    for k in range(K):
        coefficient[k] = 0.0
    for j in range(J):
        turn_s, turn_c = sin_s[j], cos_s[j]
        if flowing and moved:
            sine, cosine = math.sin(phi[j]), math.cos(phi[j])
            turn_s, turn_c = sin_s[j] * cosine + cos_s[j] * sine, cos_s[j] * cosine - sin_s[j] * sine
        slip = along[j] - water[j] * turn_c
        f_t = -k_t * slip * abs(slip)
        g = (w * cos_s[j] * phi[j] - f_t) * lam + field[STATIC_TANGENTIAL, j] + w * sin_s[j] * (lam - 1.0)
        for k in range(K):
            coefficient[k] += f.axial[0, k, j] * g
        v_r = rate[j] + water[j] * turn_s
        if winch:
            v_r -= (along[j] + x[j] * end[5]) * phi[j]
        weight = c[j] * lam
        slope[j] = weight * 2.0 * k_n[j] * abs(v_r)
        chi[j] = -weight * f_t
        if flowing:
            if moved:
                chi[j] += slope[j] * water[j] * turn_c
            b[j] = weight * (-k_n[j] * v_r * abs(v_r) - field[STATIC_NORMAL, j] + f_t * phi[j])
        else:
            b[j] = weight * (-k_n[j] * v_r * abs(v_r) + f_t * phi[j])
    mean_tilt = 0.0
    for j in range(J):
        G = 0.0
        for k in range(K):
            G += f.axial[1, k, j] * coefficient[k]
        T[j] = G
        mean_tilt += c[j] * G / L
    F[0] = p[TENSION_0] + mean_tension - mean_tilt
    end[6] = p[TENSION_TOP] + mean_tension + coefficient[0] - mean_tilt
    for n in range(1, N + 2):
        F[n] = grad[n] = 0.0
    grad[0] = -1.0
    for j in range(J):
        T_d = mean_tension + T[j] - mean_tilt
        T[j] = T_s[j] + T_d
        a = -c[j] * T[j] * phi[j]
        # The cable paid out carries the static load too, and spreads the static bend over its length.
        b[j] += c[j] * bend_s[j] * (T_d - (lam - 1.0) * T_s[j])
        F[1] += b[j] * (1.0 - x[j]) - a / L
        # Gradient of the stretch: the coupling of lateral motion into the mean tension.
        pull = c[j] * phi[j] * stretch_s[j]
        bow = c[j] * bend_s[j]
        grad[1] -= pull / L + bow * (1.0 - x[j])
        for n in range(N):
            F[2 + n] += a * Dt[j, n] + b[j] * St[j, n]
            grad[2 + n] += pull * Dt[j, n] - bow * St[j, n]
    if p[WEAK] == 0.0:
        angle = slant
        for n in range(N):
            angle += (n + 1) * math.pi / (L * lam) * y[2 + n]
        F[1] = F[0] * (angle + y[0] * p[BEND_0]) * p[STRETCH_0]


@fast_kernel
def cable_momentum(f: Fields, v: Floats, end: Floats, out: Floats) -> None:
    """Generalised momentum of the lateral motion, M v + m_2 eta_2', (2 + N,) [N s]; the axial one is quasi-static."""
    N = f.sines.shape[1]
    scale = f.scalar[LATERAL_MASS] * (f.scalar[LENGTH] + end[4])
    out[0] = 0.0
    total = v[1] / 3.0 + end[3] / 6.0
    for n in range(N):
        odd = 1.0 if n % 2 == 0 else -1.0
        inverse = 1.0 / ((n + 1) * math.pi)
        total += v[2 + n] * inverse
        out[2 + n] = scale * (0.5 * v[2 + n] + (v[1] + odd * end[3]) * inverse)
    out[1] = scale * total if f.scalar[WEAK] != 0.0 else 0.0


@fast_kernel
def cable_matrix(f: Fields, end: Floats, gh: float, station: Floats, grad: Floats, A: Floats) -> None:
    """Fill A (2 + N, 2 + N) with M - gh dF/dv - gh^2 dF/dy at the state of the last `cable_forces`.

    Products of sines are sums of cosines, so the matrix needs the 2N + 1 moments of each station field, not
    N^2 projections.
    """
    St, Dt, C2, S2 = f.sines_t[0], f.sines_t[1], f.moments[0], f.moments[1]
    J, N = St.shape
    p, x, c, stretch_s = f.scalar, f.station[X], f.station[QUADRATURE], f.station[STRETCH]
    L, EA = p[LENGTH], p[AXIAL_STIFFNESS]
    lam = 1.0 + end[4] / L
    slope, chi, T, phi = station[SLOPE], station[CHI], station[TENSION], station[PHI]
    M = 2 * N + 1
    drag, pull, cross = np.zeros(M), np.zeros(M), np.zeros(M)
    skewed = p[FLOWING] != 0.0
    drag_lin, pull_lin = np.zeros(N), 0.0
    cross_row, cross_col = np.zeros(N), np.zeros(N)
    A11 = 0.0
    for j in range(J):
        a = gh * slope[j]
        t = gh * gh * c[j] * T[j] * stretch_s[j] / lam
        pull_lin += t
        bottom = 1.0 - x[j]
        A11 += a * bottom * bottom
        for k in range(M):
            drag[k] += a * C2[j, k]
            pull[k] += t * C2[j, k]
        for n in range(N):
            drag_lin[n] += a * bottom * St[j, n]
        if skewed:
            z = gh * gh * chi[j] * stretch_s[j] / lam
            A11 -= z * bottom / L
            for k in range(M):
                cross[k] += z * S2[j, k]
            for n in range(N):
                cross_row[n] += z * bottom * Dt[j, n]
                cross_col[n] -= z * St[j, n] / L
    scale = p[LATERAL_MASS] * L * lam
    stiff = gh * (gh + p[AXIAL_LOSS]) * EA / (L * lam)
    A[0, 0] = stiff
    A[1, 1] = scale / 3.0 + A11 + pull_lin / (L * L) + stiff * grad[1] * grad[1]
    A[0, 1] = A[1, 0] = stiff * grad[0] * grad[1]
    for m in range(N):
        wave_m = (m + 1) * math.pi / L
        lateral = scale / ((m + 1) * math.pi) + drag_lin[m] - wave_m / L * pull[m + 1]
        A[1, 2 + m] = lateral + cross_row[m] + stiff * grad[1] * grad[2 + m]
        A[2 + m, 1] = lateral + cross_col[m] + stiff * grad[1] * grad[2 + m]
        A[0, 2 + m] = A[2 + m, 0] = stiff * grad[0] * grad[2 + m]
        for n in range(N):
            low, high = abs(m - n), m + n + 2
            wave_n = (n + 1) * math.pi / L
            value = 0.5 * (drag[low] - drag[high] + wave_m * wave_n * (pull[low] + pull[high]))
            if skewed:
                value += 0.5 * wave_n * (cross[high] + (cross[low] if m >= n else -cross[low]))
            A[2 + m, 2 + n] = value + stiff * grad[2 + m] * grad[2 + n]
        A[2 + m, 2 + m] += 0.5 * scale
    if p[WEAK] == 0.0:
        for n in range(N + 2):
            A[1, n] = 0.0
        A[1, 1] = gh * gh * p[TENSION_0] / (L * lam) * p[STRETCH_0]
        for n in range(N):
            A[1, 2 + n] = -gh * gh * p[TENSION_0] * (n + 1) * math.pi / (L * lam) * p[STRETCH_0]
        angle = phi[0]
        for n in range(N + 2):
            A[1, n] += stiff * angle * grad[n]
