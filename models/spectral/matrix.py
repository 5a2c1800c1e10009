"""Momentum of the sine series, and the matrix of a stage: what the forces of `forces` change with."""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import fast_kernel
from models.spectral.basis import (
    AXIAL_LOSS,
    AXIAL_MASS,
    AXIAL_STIFFNESS,
    BEND,
    FLOWING,
    LATERAL_MASS,
    LENGTH,
    QUADRATURE,
    STRETCH,
    STRETCH_0,
    TENSION_0,
    WEAK,
    Fields,
    X,
)
from models.spectral.workspace import (
    ALONG,
    BENT,
    CHI,
    CROSS,
    CROSS_COL,
    CROSS_ROW,
    DRAG,
    DRAG_LIN,
    ETA_2_RATE,
    LOAD_MASS,
    NORMAL,
    P_TOP_RATE,
    PAID,
    PHI,
    PULL,
    RATE,
    SLOPE,
    SPREAD,
    TENSION,
    TIED,
    WATER,
    WORK,
)

Floats = NDArray[np.float64]


@fast_kernel
def cable_momentum(f: Fields, v: Floats, end: Floats, out: Floats) -> None:
    """Generalised momentum M v + m_2 eta_2' (2 + N,) [N s], with the axial motion linear in s."""
    N = f.sines.shape[1]
    length = f.scalar[LENGTH] + end[PAID]
    scale = f.scalar[LATERAL_MASS] * length
    # A third of the cable's mass goes with the lower end, a sixth with the upper: int m p_t (1 - x) ds.
    out[0] = f.scalar[AXIAL_MASS] * length * (v[0] / 3.0 + end[P_TOP_RATE] / 6.0)
    total = v[1] / 3.0 + end[ETA_2_RATE] / 6.0
    for n in range(N):
        odd = 1.0 if n % 2 == 0 else -1.0
        inverse = 1.0 / ((n + 1) * math.pi)
        total += v[2 + n] * inverse
        out[2 + n] = scale * (0.5 * v[2 + n] + (v[1] + odd * end[ETA_2_RATE]) * inverse)
    out[1] = scale * total if f.scalar[WEAK] != 0.0 else 0.0


@fast_kernel
def cable_matrix(f: Fields, end: Floats, gh: float, station: Floats, sums: Floats, A: Floats) -> None:
    """Fill A (2 + N, 2 + N) with M - gh dF/dv - gh^2 dF/dy at the state of the last `cable_forces`.

    Products of sines are sums of cosines, so the matrix needs the 2N + 1 moments of each station field, not
    N^2 projections. `sums` (SUM_ROWS, 2N + 1) is workspace, and so are the stations but for angle and tension.
    """
    N, J = f.sines.shape[1:]
    p, field = f.scalar, f.station
    L, EA, m = p[LENGTH], p[AXIAL_STIFFNESS], p[AXIAL_MASS] * (p[LENGTH] + end[PAID])
    lam = 1.0 + end[PAID] / L
    skewed = p[FLOWING] != 0.0
    pull_lin, A11, tied, bent = 0.0, 0.0, 0.0, 0.0
    # The share of a pull at the vehicle that the cable's own mass takes further up.
    share = m / (end[LOAD_MASS] + m / 3.0) if m > 0.0 else 0.0
    for j in range(J):
        x, bottom, phi = field[X, j], 1.0 - field[X, j], station[PHI, j]
        a = gh * station[SLOPE, j]
        t = gh * gh * field[QUADRATURE, j] * station[TENSION, j] * field[STRETCH, j] / lam
        # Gradient of the stretch, and of what its tension does to the lateral motion.
        pull, bow = field[QUADRATURE, j] * phi * field[STRETCH, j], field[QUADRATURE, j] * field[BEND, j]
        local = 1.0 + share * (x - 0.5 * x * x - 1.0 / 3.0)
        lean = pull / L + bow * bottom
        tied -= lean
        bent -= local * lean
        pull_lin += t
        z = gh * gh * station[CHI, j] * field[STRETCH, j] / lam if skewed else 0.0
        A11 += a * bottom * bottom - z * bottom / L
        station[RATE, j], station[WORK, j], station[ALONG, j] = a, t, z
        station[NORMAL, j], station[WATER, j], station[SPREAD, j] = pull, bow, local
    for k in range(2 * N + 1):
        drag, turned, cross = 0.0, 0.0, 0.0
        for j in range(J):
            drag += station[RATE, j] * f.moments[0, k, j]
            turned += station[WORK, j] * f.moments[0, k, j]
        if skewed:
            for j in range(J):
                cross += station[ALONG, j] * f.moments[1, k, j]
        sums[DRAG, k], sums[PULL, k], sums[CROSS, k] = drag, turned, cross
    for n in range(N):
        drag, one, other, row, column = 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(J):
            drag += station[RATE, j] * (1.0 - field[X, j]) * f.sines[0, n, j]
            gradient = station[NORMAL, j] * f.sines[1, n, j] - station[WATER, j] * f.sines[0, n, j]
            one += gradient
            other += station[SPREAD, j] * gradient
        if skewed:
            for j in range(J):
                row += station[ALONG, j] * (1.0 - field[X, j]) * f.sines[1, n, j]
                column -= station[ALONG, j] * f.sines[0, n, j] / L
        sums[DRAG_LIN, n], sums[TIED, n], sums[BENT, n] = drag, one, other
        sums[CROSS_ROW, n], sums[CROSS_COL, n] = row, column
    scale = p[LATERAL_MASS] * L * lam
    stiff = gh * (gh + p[AXIAL_LOSS]) * EA / (L * lam)
    A[0, 0] = stiff + m / 3.0
    A[1, 1] = scale / 3.0 + A11 + pull_lin / (L * L) + stiff * bent * tied
    A[0, 1], A[1, 0] = -stiff * tied, -stiff * bent
    for i in range(N):
        wave_i = (i + 1) * math.pi / L
        lateral = scale / ((i + 1) * math.pi) + sums[DRAG_LIN, i] - wave_i / L * sums[PULL, i + 1]
        A[1, 2 + i] = lateral + sums[CROSS_ROW, i] + stiff * bent * sums[TIED, i]
        A[2 + i, 1] = lateral + sums[CROSS_COL, i] + stiff * sums[BENT, i] * tied
        A[0, 2 + i], A[2 + i, 0] = -stiff * sums[TIED, i], -stiff * sums[BENT, i]
        for n in range(N):
            low, high = abs(i - n), i + n + 2
            wave_n = (n + 1) * math.pi / L
            value = 0.5 * (sums[DRAG, low] - sums[DRAG, high] + wave_i * wave_n * (sums[PULL, low] + sums[PULL, high]))
            if skewed:
                value += 0.5 * wave_n * (sums[CROSS, high] + (sums[CROSS, low] if i >= n else -sums[CROSS, low]))
            A[2 + i, 2 + n] = value + stiff * sums[BENT, i] * sums[TIED, n]
        A[2 + i, 2 + i] += 0.5 * scale
    if p[WEAK] == 0.0:
        for n in range(N + 2):
            A[1, n] = 0.0
        A[1, 1] = gh * gh * p[TENSION_0] / (L * lam) * p[STRETCH_0]
        for n in range(N):
            A[1, 2 + n] = -gh * gh * p[TENSION_0] * (n + 1) * math.pi / (L * lam) * p[STRETCH_0]
        angle = station[PHI, 0]
        A[1, 0] -= stiff * angle
        A[1, 1] += stiff * angle * tied
        for n in range(N):
            A[1, 2 + n] += stiff * angle * sums[TIED, n]
