"""Equivalent linear drag of quadratic drag: the describing function of r v|v|.

A sinusoid of velocity amplitude V meets the same work per cycle from the linear drag 8/(3 pi) r V.
"""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from models.chain import Chain
from models.quantity import NumericalFailure

Floats = NDArray[np.float64]

#: The factor 8/(3 pi).
DESCRIBING_FACTOR = 8.0 / (3.0 * math.pi)

#: Relative change of the drag at which its iteration ends, and the iterations allowed.
CHANGE = 1e-12
ITERATIONS = 500


def at_speed(r: Floats, speed: float | Floats) -> Floats:
    """Linear drag [N s/m] of quadratic drag r [N s2/m2] where all nodes move with the velocity amplitude [m/s]."""
    return DESCRIBING_FACTOR * r * speed


def at_ship_motion(chain: Chain, ship_amplitude: float, omega: float) -> Floats:
    """Linear drag [N s/m] of each node, consistent with the node velocities that the ship's sinusoid causes.

    Parameters
    ----------
    chain
        With quadratic drag.
    ship_amplitude, omega
        Amplitude [m] and frequency [rad/s] of the ship.

    Raises
    ------
    NumericalFailure
        The iteration does not settle.

    Notes
    -----
    Where drag rules, the velocity falls as the drag grows and plain substitution only alternates; the geometric
    mean of old and new lands on the solution there, and halves the error where drag is weak.
    """
    r = at_speed(chain.r, ship_amplitude * omega)
    change = math.inf
    for _ in range(ITERATIONS):
        speed = ship_amplitude * omega * np.abs(gains(chain._replace(r=r), omega))
        new = np.sqrt(r * at_speed(chain.r, speed))
        change = float(np.abs(new / r - 1.0).max())
        r = new
        if change <= CHANGE:
            return np.asarray(r)
    raise NumericalFailure(
        f"The equivalent drag at {ship_amplitude:g} m and {omega:g} rad/s still changes by {change:g} after "
        f"{ITERATIONS} iterations."
    )


def gains(chain: Chain, omega: float) -> NDArray[np.complex128]:
    """(n,) complex ratio of node to ship motion at omega [rad/s], with linear drag."""
    k, r, m = chain
    bands = np.zeros((3, k.size), dtype=complex)
    bands[1] = k + np.append(k[1:], 0.0) + 1j * omega * r - omega**2 * m
    bands[0, 1:] = bands[2, :-1] = -k[1:]
    pull = np.zeros(k.size, dtype=complex)
    pull[0] = k[0]
    return np.asarray(solve_banded((1, 1), bands, pull))
