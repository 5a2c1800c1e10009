"""The Kalman smoother that the published track of the deep-tow camera went through, as a linear operator.

State on each axis: position and velocity. Observations at each ping: the acoustic fix as position, and the
*ship's* velocity as if it were the vehicle's. Smoothing is the least-squares path through both, so the
published track is linear in the true one and in the ship's velocity: a model's output must pass through the
same operator before its velocity is compared.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from models.quantity import InvalidInput
from models.trace import Floats

#: Variance added to position [m2] and to velocity [m2/s2] from ping to ping.
TRANSITION_VARIANCE = 1e-3
#: Variance of a fix [m2] and of a velocity [m2/s2].
FIX_VARIANCE = 15.0
VELOCITY_VARIANCE = 0.01


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class UsblSmoother:
    """Published position = ``fixes @ position + leak @ ship_velocity``, for scalar motion along any one axis.

    Attributes
    ----------
    fixes
        (n, n) [1]; its rows add up to 1.
    leak
        (n, n) [s].
    """

    fixes: Floats
    leak: Floats

    def published(self, position: ArrayLike, ship_velocity: ArrayLike) -> Floats:
        """(n,) published position [m] from the vehicle's true one [m] and the ship's velocity [m/s], both (n,)."""
        return np.asarray(self.fixes @ np.asarray(position) + self.leak @ np.asarray(ship_velocity), dtype=float)


def usbl_smoother(t: ArrayLike) -> UsblSmoother:
    """The operator on pings at `t` (n,) [s].

    Raises
    ------
    InvalidInput
        There are fewer than two pings, or they do not increase.

    Notes
    -----
    A Kalman filter from the first observation and a Rauch-Tung-Striebel smoother give the minimum of
    ``sum (x - fix)^2/15 + (v - v_ship)^2/0.01 + (|x' - x - v dt|^2 + |v' - v|^2)/0.001``; here its normal
    equations, five-banded in (x_1, v_1, x_2, v_2, ...), are solved for every unit observation at once.
    """
    from scipy.linalg import solveh_banded

    t = np.asarray(t, dtype=float)
    if t.ndim != 1 or t.size < 2 or np.any(np.diff(t) <= 0.0):
        raise InvalidInput("The smoother needs at least 2 pings at increasing times.")
    n, dt = t.size, np.diff(t)
    stiffness = 1.0 / TRANSITION_VARIANCE
    bands = np.zeros((3, 2 * n))  # bands[j, i] = H[i + j, i]
    x, v = slice(0, 2 * n, 2), slice(1, 2 * n, 2)
    bands[0, x], bands[0, v] = 1.0 / FIX_VARIANCE, 1.0 / VELOCITY_VARIANCE
    before_x, before_v = slice(0, 2 * n - 2, 2), slice(1, 2 * n - 2, 2)
    bands[0, before_x] += stiffness
    bands[0, before_v] += stiffness * (1.0 + dt**2)
    bands[0, 2::2] += stiffness
    bands[0, 3::2] += stiffness
    bands[1, before_x] = stiffness * dt
    bands[1, before_v] = -stiffness * dt
    bands[2, : 2 * n - 2] = -stiffness
    observed = np.zeros((2 * n, 2 * n))
    k = np.arange(n)
    observed[2 * k, k] = 1.0 / FIX_VARIANCE
    observed[2 * k + 1, n + k] = 1.0 / VELOCITY_VARIANCE
    smoothed = np.asarray(solveh_banded(bands, observed, lower=True), dtype=float)[x]
    return UsblSmoother(fixes=smoothed[:, :n], leak=smoothed[:, n:])
