"""The chain of rigid links in the dense form that W prints: the baseline of the benchmark, and an oracle.

    x'' = a + M^-1/2 (A M^-1/2)^+ (b - A a),   T_i = -lambda_i l_i

for one part, with full matrices and the pseudo-inverse by singular values. The first row of b has the sign of the
derivation, +(s_1 - s_m) s_m'', not the printed one, and no tension is inside a.
"""

import numpy as np
from numpy.typing import NDArray

from models.towed_system import Part

Floats = NDArray[np.float64]


def lumps(part: Part, rho: float, x: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """Mass (3n, 3n), weight (3n,) and drag matrix C (3n, 3n), force -C v, of the nodes below the ship (row 0).

    Half of a link at each of its ends, with the link's own tangent; the body at the last node, the same in all axes.
    """
    cable, body, n = part.cable, part.body, len(x) - 1
    half, one = 0.5 * cable.length / n, np.eye(3)
    M, C, weight = np.zeros((n + 1, 3, 3)), np.zeros((n + 1, 3, 3)), np.zeros((n + 1, 3))
    for i in range(n):
        t = (x[i + 1] - x[i]) / np.linalg.norm(x[i + 1] - x[i])
        along, across = np.outer(t, t), one - np.outer(t, t)
        for q in (i, i + 1):
            M[q] += half * (cable.mass * one + cable.added_mass * across)
            C[q] += half * cable.normal_drag(rho) * np.linalg.norm(across @ v[q]) * across
            C[q] += half * cable.tangential_drag(rho) * abs(t @ v[q]) * along
            weight[q, 2] -= half * cable.weight_in_water
    if body is not None:
        M[n] += (body.mass + body.added_mass_surge) * one
        C[n] += 0.5 * rho * body.drag_coefficient * body.area_surge * np.linalg.norm(v[n]) * one
        weight[n, 2] -= body.weight_in_water

    def blocks(each: Floats) -> Floats:
        full = np.zeros((n, 3, n, 3))
        full[range(n), :, range(n), :] = each[1:]
        return full.reshape(3 * n, 3 * n)

    return blocks(M), weight[1:].ravel(), blocks(C)


def accelerations(
    M: Floats, force: Floats, x: Floats, v: Floats, ship: Floats, correction: Floats | float = 0.0
) -> tuple[Floats, Floats]:
    """Accelerations (n, 3) [m/s2] and tensions (n,) [N].

    Parameters
    ----------
    M, force
        (3n, 3n) [kg] and (3n,) [N] of the nodes below the ship.
    x, v
        (n + 1, 3) [m], [m/s], from the ship (row 0) down.
    ship
        (3,) the ship's acceleration [m/s2].
    correction
        (n,) what a stabilisation takes off b [m2/s2].
    """
    n, r, rate = len(x) - 1, np.diff(x, axis=0), np.diff(v, axis=0)
    blocks = np.zeros((n, n, 3))
    for i in range(n):
        blocks[i, i] = r[i]
        if i > 0:
            blocks[i, i - 1] = -r[i]
    A = blocks.reshape(n, 3 * n)
    b = -(rate**2).sum(axis=1) - correction
    b[0] += r[0] @ ship
    values, vectors = np.linalg.eigh(M)
    root = vectors / np.sqrt(values) @ vectors.T
    a = np.linalg.solve(M, force)
    total = a + root @ np.linalg.pinv(A @ root) @ (b - A @ a)
    # A' lambda = M (x'' - a), from the free end up: what a node lacks is the pull of the links at both its sides.
    pull = np.cumsum((M @ (total - a)).reshape(n, 3)[::-1], axis=0)[::-1]
    return total.reshape(n, 3), -np.einsum("ij,ij->i", pull, r) / np.linalg.norm(r, axis=1)
