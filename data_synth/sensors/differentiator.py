"""Velocity from fixes: a local polynomial fit, Savitzky and Golay's filter for uneven and missing samples.

It is a linear operator on the positions, so that the same one goes over a measurement and over a model's
output, and what it makes of noise alone is known.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput
from models.trace import Floats

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Differentiator:
    """Velocity at the samples that allow one.

    Attributes
    ----------
    index
        (m,) samples of the record that velocities belong to.
    matrix
        (m, n) sparse [1/s]; its columns of missing samples are empty.
    """

    index: NDArray[np.intp]
    matrix: "csr_matrix"

    def velocity(self, position: ArrayLike) -> Floats:
        """(m,) velocity [m/s] from positions (n,) [m]; those of missing samples may be NaN.

        Raises
        ------
        InvalidInput
            A position is missing that counted as valid, or the length is not that of the record.
        """
        position = np.asarray(position, dtype=float)
        if position.shape != (self.matrix.shape[1],):
            raise InvalidInput(
                f"The differentiator was made for {self.matrix.shape[1]} positions, but was given the shape "
                f"{position.shape}."
            )
        velocity = np.asarray(self.matrix @ position, dtype=float)
        if not np.isfinite(velocity).all():
            row = int(np.argmin(np.isfinite(velocity)))
            raise InvalidInput(
                f"The velocity at sample {self.index[row]} needs a position that is not finite; make the "
                "differentiator with that sample marked as missing."
            )
        return velocity

    def noise_floor(self, sigma: float) -> float:
        """RMS velocity [m/s] that independent noise of `sigma` [m] in each position makes alone."""
        return float(sigma * np.sqrt(self.matrix.power(2).sum() / self.index.size))


def differentiator(
    t: ArrayLike, valid: ArrayLike | None = None, window: float = 90.0, order: int = 2
) -> Differentiator:
    """Least squares of a polynomial over a moving window, its slope at the middle.

    Parameters
    ----------
    t
        (n,) [s], increasing.
    valid
        (n,) whether the sample holds a position; all by default.
    window
        Length [s]; the samples up to half of it to either side are used.
    order
        Degree of the polynomial, at least 1.

    Raises
    ------
    InvalidInput
        No sample has the window inside the record and enough valid samples on it.

    Notes
    -----
    A sample gets a velocity if it is valid itself, its window lies inside the record, and the window has at
    least ``order + 2`` valid samples, among them at least one to either side, without a gap of more than half
    the window between them. Rows that hold no fix, such as the ship's between two fixes, change nothing.
    On a uniform record without gaps this is ``scipy.signal.savgol_filter(deriv=1)``.
    """
    from scipy.sparse import csr_matrix

    t = np.asarray(t, dtype=float)
    valid = np.ones(t.size, dtype=bool) if valid is None else np.asarray(valid, dtype=bool)
    half = 0.5 * window
    slack = 1e-9 * max(window, 1.0)
    starts = np.searchsorted(t, t - half - slack, side="left")
    ends = np.searchsorted(t, t + half + slack, side="right")
    candidates = np.flatnonzero(valid & (t - half >= t[0] - slack) & (t + half <= t[-1] + slack))
    powers = np.arange(order + 1)
    rows: list[Floats] = []
    columns: list[NDArray[np.intp]] = []
    index: list[int] = []
    for i in candidates:
        used = starts[i] + np.flatnonzero(valid[starts[i] : ends[i]])
        if used.size < order + 2 or used[0] == i or used[-1] == i or np.diff(t[used]).max() > half + slack:
            continue
        terms = ((t[used] - t[i]) / half)[:, None] ** powers
        rows.append(np.linalg.solve(terms.T @ terms, terms.T)[1] / half)
        columns.append(used)
        index.append(int(i))
    if not index:
        raise InvalidInput(
            f"No velocity can be read over {window:g} s from {int(valid.sum())} fixes in {t[-1] - t[0]:g} s: a window "
            f"needs at least {order + 2} of them, no two farther apart than half of it; make the window longer or use "
            "a longer record."
        )
    bounds = np.concatenate(([0], np.cumsum([c.size for c in columns])))
    matrix = csr_matrix((np.concatenate(rows), np.concatenate(columns), bounds), shape=(len(index), t.size))
    return Differentiator(index=np.array(index, dtype=np.intp), matrix=matrix)
