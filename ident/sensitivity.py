"""Sensitivities of the compared velocity and the covariance of the fitted parameters.

| symbol | meaning |
| --- | --- |
| J | (m, p) derivative of the compared velocity by the search coordinates [m/s] |
| e | (m,) residuals [m/s] |
| R | (m, m) covariance of the residuals, a band along the diagonal [m2/s2] |
| V, lambda | eigenvectors and eigenvalues of J'J |
| y | coordinates u = V lambda^(-1/2) y, in which J'J is the identity |
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import matmul_toeplitz
from scipy.stats import t as student

from ident.cases import Case, Floats
from ident.objective import residuals
from ident.residuals import autocovariance, memory_length
from ident.search_space import SearchSpace

#: Half the difference in search coordinates of a central difference.
STEP = 1e-3

#: RMS change of velocity [m/s] per unit of a search coordinate below which a direction is lost in rounding.
UNSEEN = 1e-7

#: Standard deviation in search coordinates that stands for a lost direction.
LOST = 100.0

#: Fewest degrees of freedom that an interval is given.
FEWEST_DEGREES = 3.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Covariance:
    """Sandwich covariance of the search coordinates.

    `information` J'J, its `inverse` and `covariance` are (p, p); `degrees` are the effective degrees of freedom
    of the residual variance and `critical` is the 95 % value of Student's t with them.
    `lost` (p, q) are directions that change the velocity by less than rounding.
    """

    information: Floats
    inverse: Floats
    covariance: Floats
    lost: Floats
    degrees: float
    critical: float

    def half_width(self, direction: Floats) -> float:
        """95 % half-width along a direction (p,) in search coordinates."""
        return self.critical * math.sqrt(max(float(direction @ self.covariance @ direction), 0.0))

    def rise(self, direction: Floats) -> float:
        """Rise of the sum of squares [m2/s2] at the ends of the 95 % interval along a direction (p,)."""
        return self.half_width(direction) ** 2 / float(direction @ self.inverse @ direction)


def sensitivities(space: SearchSpace, u: Floats, cases: Sequence[Case]) -> Floats:
    """(m, p) central differences of the compared velocity by the search coordinates at u (p,) [m/s].

    Raises
    ------
    NumericalFailure
        A simulation failed.
    """
    J = np.empty((sum(case.time.size for case in cases), u.size))
    for j in range(u.size):
        above, below = u.copy(), u.copy()
        above[j] = min(u[j] + STEP, space.upper[j])
        below[j] = max(u[j] - STEP, space.lower[j])
        difference = residuals(space.model_at(above), cases) - residuals(space.model_at(below), cases)
        J[:, j] = difference / (above[j] - below[j])
    return J


def covariance(space: SearchSpace, u: Floats, cases: Sequence[Case]) -> Covariance:
    """Covariance of the search coordinates at an optimum u (p,) that allows for autocorrelated residuals.

    Raises
    ------
    NumericalFailure
        A simulation right beside the optimum failed.

    Notes
    -----
    The sandwich ``(J'J)^-1 J'RJ (J'J)^-1`` of a least-squares fit, in small samples:

    - R is banded, from the residuals' autocovariance under a flat-top lag window (Politis 2003), which
      reproduces the finite memory of a differentiator without bias; records are independent of each other;
    - R is enlarged by what the fit took out of the residuals, ``tr((J'J)^-1 J'RJ)``;
    - degrees of freedom are those of the variance of correlated samples, ``m / (1 + 2 sum rho^2) - p``.
    """
    J = sensitivities(space, u, cases)
    e = residuals(space.model_at(u), cases)
    m, p = J.shape
    values, V = np.linalg.eigh(J.T @ J)
    seen = values > m * UNSEEN**2
    scale = V[:, seen] / np.sqrt(values[seen])
    middle, degrees = _middle(J @ scale, e, [case.time.size for case in cases])
    degrees = max(degrees - p, FEWEST_DEGREES)
    lost = V[:, ~seen]
    endless = LOST**2 * lost @ lost.T
    return Covariance(
        information=J.T @ J,
        inverse=scale @ scale.T + endless,
        covariance=scale @ middle @ scale.T + endless,
        lost=lost,
        degrees=degrees,
        critical=float(student.ppf(0.975, degrees)),
    )


def _middle(K: Floats, e: Floats, sizes: Sequence[int]) -> tuple[Floats, float]:
    """K'RK of orthonormal K (m, p), and the degrees of freedom of R."""
    p = K.shape[1]
    flat, tapered = np.zeros((p, p)), np.zeros((p, p))
    degrees = 0.0
    at = 0
    for size in sizes if p else ():
        k, r = K[at : at + size], e[at : at + size]
        at += size
        gamma = autocovariance(r)
        rho = gamma / max(gamma[0], np.finfo(float).tiny)
        memory = max(memory_length(rho, size), 1)
        lag = np.arange(size)
        window = np.clip(2.0 - lag / memory, 0.0, 1.0)
        flat += k.T @ matmul_toeplitz(gamma * window, k)
        tapered += k.T @ matmul_toeplitz(gamma * np.maximum(1.0 - lag / (2.0 * memory), 0.0), k)
        degrees += size / (1.0 + 2.0 * float((window[1:] * rho[1:] ** 2).sum()))
    # A flat-top window may lose positive definiteness; the triangular one of the same memory never does.
    middle = flat if p and np.linalg.eigvalsh(flat)[0] > 0.0 else tapered
    taken = float(np.trace(middle)) / max(float(e @ e), np.finfo(float).tiny)
    return middle / max(1.0 - taken, 0.25), degrees
