"""Linear chains: their state-space form, and their exact response to the ship's cubic spline.

States are the spring forces e and, with mass, the node velocities f; input the ship's velocity; output the
vehicle's velocity (T (6.4), (6.7), with the drag of each node its own):

    e_i' = k_i (f_{i-1} - f_i),   f_i' = (e_i - e_{i+1} - r_i f_i)/m_i,   f_0 = v_ship
    massless: f_i = (e_i - e_{i+1})/r_i

| symbol | meaning | unit |
| --- | --- | --- |
| e, f | force of the link above the node, velocity of the node | N, m/s |
| A, B, C, D | z' = A z + B v_ship, v_vehicle = C z + D v_ship | |
| S | diagonal scale to energy coordinates, e/sqrt(k) and f sqrt(m), where exp(A t) never grows | |
| E | propagator less the identity, exp(A h) - I | - |
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.chain import Chain, Motion
from models.drive import Drive
from models.kernels import kernel
from models.quantity import NumericalFailure

Floats = NDArray[np.float64]

#: Distinct sampling intervals that get a propagator each; records with more share one ladder.
FEW = 8

#: Terms of the exponential series: exact to rounding for a norm up to 1/2.
TERMS = 13

#: Halvings of the longest interval after which a system counts as too stiff to be propagated.
HALVINGS = 60


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearModel:
    """State-space arrays z' = A z + B v_ship(t - delay), v_vehicle = C z + D v_ship(t - delay).

    `A` (N, N) [1/s], `B` (N, 1), `C` (1, N), `D` (1, 1), `delay` [s]; the same system maps ship position to vehicle
    position. States as in the module docstring.
    """

    A: Floats
    B: Floats
    C: Floats
    D: Floats
    delay: float = 0.0

    def response(self, omega: Floats) -> NDArray[np.complex128]:
        """Frequency response C (i omega - A)^-1 B + D, times the delay's phase, at (p,) frequencies [rad/s]."""
        s = 1j * np.asarray(omega, dtype=float)[:, None, None]
        states = np.linalg.solve(s * np.eye(len(self.A)) - self.A, self.B)
        return np.asarray((self.C @ states + self.D)[:, 0, 0] * np.exp(-s[:, 0, 0] * self.delay))


def state_space(chain: Chain, delay: float = 0.0) -> LinearModel:
    """The state-space form of a chain with linear drag, T (6.4); massless (6.7) with every node's own drag."""
    k, r, m = chain
    n = k.size
    # Rows of `differ` give f_{i-1} - f_i; its transpose with the sign changed gives e_i - e_{i+1}.
    differ = np.eye(n, k=-1) - np.eye(n)
    last = np.zeros((1, n))
    last[0, -1] = 1.0
    B = np.zeros((n, 1))
    B[0, 0] = k[0]
    if m.any():
        A = np.block([[np.zeros((n, n)), k[:, None] * differ], [-differ.T / m[:, None], np.diag(-r / m)]])
        B, C = np.vstack([B, np.zeros((n, 1))]), np.hstack([np.zeros((1, n)), last])
    else:
        A = -k[:, None] * (differ @ (differ.T / r[:, None]))
        C = last / r[-1]
    return LinearModel(A=A, B=B, C=C, D=np.zeros((1, 1)), delay=delay)


def linear_motion(chain: Chain, drive: Drive) -> Motion:
    """The vehicle of a chain with linear drag, exact for the ship's cubic spline.

    Raises
    ------
    NumericalFailure
        The fastest rate is beyond what the longest interval resolves.
    """
    system = state_space(chain)
    inertial = bool(chain.m.any())
    S = 1.0 / np.sqrt(chain.k)
    force = np.cumsum(chain.r[::-1])[::-1] * drive.start_speed
    start = force
    if inertial:
        S = np.append(S, np.sqrt(chain.m))
        start = np.append(force, np.full(chain.m.size, drive.start_speed))
    # The input's own states: velocity, acceleration and jerk of the ship.
    N = S.size
    augmented = np.zeros((N + 3, N + 3))
    augmented[:N, :N] = S[:, None] * system.A / S
    augmented[:N, N] = S * system.B[:, 0]
    augmented[N, N + 1] = augmented[N + 1, N + 2] = 1.0
    tables, chosen, rest = _propagators(augmented, drive)
    z = np.empty((drive.t.size, N))
    _propagate(tables, chosen, rest, np.ascontiguousarray(augmented.T), drive.rates, S * start, z)
    n = chain.k.size
    v = z @ (system.C[0] / S)
    x = drive.u - z[:, :n] @ (1.0 / (chain.k * S[:n]))
    return Motion(x, v)


def _propagators(A: Floats, drive: Drive) -> tuple[Floats, NDArray[np.int64], Floats]:
    """Transposed tables of E (p, N, N); per interval the tables to apply, as bits, and the rest of the time [s].

    A few distinct intervals have a table each. Otherwise the tables are a ladder of doubled steps of which any
    interval is a sum, up to a rest for the series.
    """
    intervals, which = drive.intervals
    if intervals.size <= FEW:
        tables = np.stack([doublings(A, float(h))[-1].T for h in intervals])
        return np.ascontiguousarray(tables), np.int64(1) << which, np.zeros(which.size)
    ladder = doublings(A, float(intervals.max()))
    unit = float(intervals.max()) / 2 ** (len(ladder) - 1)
    interval = intervals[which]
    whole = np.floor(interval / unit)
    return (
        np.ascontiguousarray(np.stack([E.T for E in ladder])),
        whole.astype(np.int64),
        np.maximum(interval - whole * unit, 0.0),
    )


def doublings(A: Floats, h: float) -> list[Floats]:
    """E = exp(A t) - I for t = h/2^p, ..., h/2, h [s], by series and doubling.

    Doubling E -> 2 E + E E keeps the digits of the slow states, which squaring exp(A t) itself would lose
    against the identity.

    Raises
    ------
    NumericalFailure
        More than `HALVINGS` halvings are needed, or A is not finite.
    """
    norm = float(np.abs(A).sum(axis=1).max()) * h
    if not math.isfinite(norm) or norm > 0.5 * 2.0**HALVINGS:
        raise NumericalFailure(
            f"The linear model's fastest rate times its step of {h:g} s is {norm:g}, which cannot be propagated; "
            "its parameters are too extreme."
        )
    halvings = max(math.ceil(math.log2(norm / 0.5)), 0) if norm > 0.0 else 0
    step = A * (h / 2**halvings)
    E = step.copy()
    for q in range(TERMS, 1, -1):
        E = step + (step @ E) / q
    ladder = [E]
    for _ in range(halvings):
        E = 2.0 * E + E @ E
        ladder.append(E)
    return ladder


@kernel
def _propagate(
    tables: Floats,
    chosen: NDArray[np.int64],
    rest: Floats,
    A: Floats,
    rates: Floats,
    start: Floats,
    z: Floats,
) -> None:
    """March the augmented state through all intervals; `tables` and `A` are transposed so that rows add up."""
    size = A.shape[0]
    N = size - 3
    w, term, turned = np.empty(size), np.empty(size), np.empty(size)
    w[:N] = start
    z[0] = start
    for interval in range(chosen.size):
        for i in range(3):
            w[N + i] = rates[interval, i]
        bits = chosen[interval]
        table = 0
        while bits > 0:
            if bits & 1:
                turned[:] = 0.0
                for j in range(size):
                    for i in range(size):
                        turned[i] += tables[table, j, i] * w[j]
                for i in range(size):
                    w[i] += turned[i]
            bits >>= 1
            table += 1
        if rest[interval] > 0.0:
            for i in range(size):
                term[i] = w[i]
            for q in range(1, TERMS + 1):
                turned[:] = 0.0
                for j in range(size):
                    for i in range(size):
                        turned[i] += A[j, i] * term[j]
                for i in range(size):
                    term[i] = turned[i] * rest[interval] / q
                    w[i] += term[i]
        for i in range(N):
            z[interval + 1, i] = w[i]
