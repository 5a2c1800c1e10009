"""What follows from the stages of a step: the polynomial through their velocities, and the error of the step."""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import fast_kernel, kernel
from models.spectral.basis import LENGTH, TANGENT_X, TANGENT_Z
from models.spectral.system import substitute
from models.spectral.workspace import LOAD_MASS, T_BOTTOM

Floats = NDArray[np.float64]

#: Most nodes of a polynomial here.
MOST_NODES = 8
#: Weight of the sines' error beside the vehicle's, and share of an error that is not carried on in one that is.
_WAVE_WEIGHT, _TIED_SHARE = 0.1, 0.04


@kernel
def weights_at(nodes: Floats, m: int, x: float, out: Floats) -> None:
    """Fill out[:m] with the weights at x of the polynomial through the first m nodes."""
    for i in range(m):
        above, below = 1.0, 1.0
        for k in range(m):
            if k != i:
                above *= x - nodes[k]
                below *= nodes[i] - nodes[k]
        out[i] = above / below


@kernel
def predict(
    c: Floats, k: int, ratio: float, w: Floats, before: Floats, nodes: Floats, weights: Floats, guess: Floats
) -> None:
    """Fill `guess` with the velocity at stage k by the stages so far and every other of the last step's.

    `ratio` is the last step over this one, 0 where it says nothing; every other, because close nodes far from the
    stage magnify their errors.
    """
    last, m = c.size - 1, k
    for j in range(k):
        nodes[j] = c[j]
    j = last - 1
    while ratio > 0.0 and j >= 0 and m <= last:
        nodes[m] = (c[j] - 1.0) * ratio
        m += 1
        j -= 2
    weights_at(nodes, m, c[k], weights)
    for i in range(guess.size):
        guess[i] = 0.0
    for j in range(m):
        for i in range(guess.size):
            guess[i] += weights[j] * (w[j, i] if j < k else before[last - 1 - 2 * (j - k), i])


@fast_kernel
def at_sample(
    c: Floats, s: float, step: float, nb: int, u: Floats, w: Floats, tension: Floats, weights: Floats,
    out: Floats, shape: Floats,
) -> None:  # fmt: skip
    """Fill `out` (2 nb + 3,) and the sines of `shape` (2 + N,) at the share s of a step.

    Places are the cubic through both ends and their velocities, velocities and tensions run through the stages.
    """
    last, t = c.size - 1, 1.0 - s
    weights_at(c, last + 1, s, weights)
    p_0, v_0, p_1, v_1 = (1.0 + 2.0 * s) * t * t, s * t * t * step, s * s * (3.0 - 2.0 * s), -s * s * t * step
    for i in range(nb):
        out[i] = p_0 * u[0, i] + v_0 * w[0, i] + p_1 * u[last, i] + v_1 * w[last, i]
        velocity = 0.0
        for j in range(last + 1):
            velocity += weights[j] * w[j, i]
        out[nb + i] = velocity
    for i in range(nb, u.shape[1]):
        shape[2 + i - nb] = p_0 * u[0, i] + v_0 * w[0, i] + p_1 * u[last, i] + v_1 * w[last, i]
    for i in range(2):
        total = 0.0
        for j in range(last + 1):
            total += weights[j] * tension[j, i]
        out[2 * nb + i] = total


@kernel
def local_error(
    scalar: Floats, d: Floats, step: float, gh: float, nb: int, w: Floats, F: Floats, A: Floats,
    pivot: NDArray[np.int64], end: Floats, stiffness: float, e: Floats,
) -> float:  # fmt: skip
    """The error of a step's velocity [m/s], by the embedded solution and the factors of its stages.

    `scalar` are those of the fields, `d` the weights of the embedded error, `stiffness` is EA/L [N/m], and
    `e` (n,) is workspace.
    """
    n = e.size
    for i in range(n):
        total = 0.0
        for j in range(d.size):
            total += d[j] * F[j, i]
        e[i] = step * total
    substitute(A, pivot, e)
    wave, error, along, across = 0.0, 0.0, 0.0, 0.0
    for i in range(nb):
        # A pitching body's rate counts at one metre from its centre.
        error = max(error, abs(e[i]))
    for i in range(nb, n):
        wave += 0.5 * e[i] * e[i]
    error = max(error, _WAVE_WEIGHT * math.sqrt(wave))
    # Along a stiff cable, and across any under slow motion, the place is tied to the ship's, and the velocity errs by
    # the place's error over g h. The factors hide that from e; it is not carried on from step to step, so much more of
    # it is allowed.
    for j in range(d.size):
        along += d[j] * (scalar[TANGENT_X] * w[j, 0] + scalar[TANGENT_Z] * w[j, 1])
        across += d[j] * (scalar[TANGENT_X] * w[j, 1] - scalar[TANGENT_Z] * w[j, 0])
    for off, held in ((along, stiffness), (across, end[T_BOTTOM] / scalar[LENGTH])):
        tied = gh * gh * held
        tied /= tied + end[LOAD_MASS] + 1e-30
        error = max(error, _TIED_SHARE * tied * step * abs(off) / gh)
    return error if math.isfinite(error) else math.inf
