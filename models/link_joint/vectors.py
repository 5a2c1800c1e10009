"""Vectors and square matrices as tuples, in the two axes of a vertical plane or in all three; z is the last.

The kernels are written once for both: `axes`, (0, 2) or (0, 1, 2), says by its length which of the two is compiled.
Numba knows the length of a tuple that is an argument and drops the other branch before it looks at types, so nothing
is decided at run time. Matrices are row by row; as tuples the compiler keeps them in registers.
"""

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel

Floats = NDArray[np.float64]
Axes = tuple[int, ...]
Vector = tuple[float, ...]
Matrix = tuple[float, ...]

#: Earth axes of what moves in a vertical plane, and of what moves anywhere.
PLANE: Axes = (0, 2)
SPACE: Axes = (0, 1, 2)


def axes_of(d: int) -> Axes:
    """The axes of what has `d` numbers a node."""
    return PLANE if d == len(PLANE) else SPACE


@inline_kernel
def vector(axes: Axes, A: Floats, i: int, at: int) -> Vector:
    """The vector in row i of A from column `at` on."""
    if len(axes) == 2:
        return A[i, at], A[i, at + 1]
    return A[i, at], A[i, at + 1], A[i, at + 2]


@inline_kernel
def matrix(axes: Axes, A: Floats, i: int, at: int) -> Matrix:
    """The matrix in row i of A from column `at` on."""
    if len(axes) == 2:
        return A[i, at], A[i, at + 1], A[i, at + 2], A[i, at + 3]
    return (
        A[i, at], A[i, at + 1], A[i, at + 2],
        A[i, at + 3], A[i, at + 4], A[i, at + 5],
        A[i, at + 6], A[i, at + 7], A[i, at + 8],
    )  # fmt: skip


@inline_kernel
def put(A: Floats, i: int, at: int, v: Vector) -> None:
    """Write a vector or a matrix into row i of A from column `at` on."""
    A[i, at], A[i, at + 1] = v[0], v[1]
    if len(v) > 2:
        A[i, at + 2] = v[2]
    if len(v) > 3:
        A[i, at + 3] = v[3]
    if len(v) > 4:
        A[i, at + 4], A[i, at + 5], A[i, at + 6], A[i, at + 7], A[i, at + 8] = v[4], v[5], v[6], v[7], v[8]


@inline_kernel
def plus(a: Vector, b: Vector) -> Vector:
    """a + b, of vectors or matrices."""
    if len(a) == 2:
        return a[0] + b[0], a[1] + b[1]
    if len(a) == 3:
        return a[0] + b[0], a[1] + b[1], a[2] + b[2]
    if len(a) == 4:
        return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]
    return (
        a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4],
        a[5] + b[5], a[6] + b[6], a[7] + b[7], a[8] + b[8],
    )  # fmt: skip


@inline_kernel
def minus(a: Vector, b: Vector) -> Vector:
    """a - b, of vectors or matrices."""
    if len(a) == 2:
        return a[0] - b[0], a[1] - b[1]
    if len(a) == 3:
        return a[0] - b[0], a[1] - b[1], a[2] - b[2]
    if len(a) == 4:
        return a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]
    return (
        a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3], a[4] - b[4],
        a[5] - b[5], a[6] - b[6], a[7] - b[7], a[8] - b[8],
    )  # fmt: skip


@inline_kernel
def times(s: float, a: Vector) -> Vector:
    """s a, of a vector or a matrix."""
    if len(a) == 2:
        return s * a[0], s * a[1]
    if len(a) == 3:
        return s * a[0], s * a[1], s * a[2]
    if len(a) == 4:
        return s * a[0], s * a[1], s * a[2], s * a[3]
    return s * a[0], s * a[1], s * a[2], s * a[3], s * a[4], s * a[5], s * a[6], s * a[7], s * a[8]


@inline_kernel
def combined(s: float, a: Vector, t: float, b: Vector) -> Vector:
    """s a + t b, of vectors or matrices."""
    return plus(times(s, a), times(t, b))


@inline_kernel
def add(A: Floats, axes: Axes, i: int, at: int, v: Vector) -> None:
    """Add a vector to that in row i of A from column `at` on."""
    put(A, i, at, plus(vector(axes, A, i, at), v))


@inline_kernel
def dot(a: Vector, b: Vector) -> float:
    """a.b."""
    if len(a) == 2:
        return a[0] * b[0] + a[1] * b[1]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inline_kernel
def raised(v: Vector, h: float) -> Vector:
    """v, with h more upwards."""
    if len(v) == 2:
        return v[0], v[1] + h
    return v[0], v[1], v[2] + h


@inline_kernel
def nought(axes: Axes) -> Vector:
    """The vector 0."""
    if len(axes) == 2:
        return 0.0, 0.0
    return 0.0, 0.0, 0.0


@inline_kernel
def outer(a: Vector, b: Vector) -> Matrix:
    """The matrix a b'."""
    if len(a) == 2:
        return a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]
    return (
        a[0] * b[0], a[0] * b[1], a[0] * b[2],
        a[1] * b[0], a[1] * b[1], a[1] * b[2],
        a[2] * b[0], a[2] * b[1], a[2] * b[2],
    )  # fmt: skip


@inline_kernel
def with_diagonal(A: Matrix, s: float) -> Matrix:
    """A + s 1."""
    if len(A) == 4:
        return A[0] + s, A[1], A[2], A[3] + s
    return A[0] + s, A[1], A[2], A[3], A[4] + s, A[5], A[6], A[7], A[8] + s


@inline_kernel
def across(s: float, t: Vector) -> Matrix:
    """s (1 - t t')."""
    if len(t) == 2:
        xz = -s * t[0] * t[1]
        return s * (1.0 - t[0] * t[0]), xz, xz, s * (1.0 - t[1] * t[1])
    xy, xz, yz = -s * t[0] * t[1], -s * t[0] * t[2], -s * t[1] * t[2]
    return (
        s * (1.0 - t[0] * t[0]), xy, xz,
        xy, s * (1.0 - t[1] * t[1]), yz,
        xz, yz, s * (1.0 - t[2] * t[2]),
    )  # fmt: skip


@inline_kernel
def applied(A: Matrix, v: Vector) -> Vector:
    """A v."""
    if len(v) == 2:
        return A[0] * v[0] + A[1] * v[1], A[2] * v[0] + A[3] * v[1]
    return (
        A[0] * v[0] + A[1] * v[1] + A[2] * v[2],
        A[3] * v[0] + A[4] * v[1] + A[5] * v[2],
        A[6] * v[0] + A[7] * v[1] + A[8] * v[2],
    )


@inline_kernel
def from_left(v: Vector, A: Matrix) -> Vector:
    """v' A."""
    if len(v) == 2:
        return v[0] * A[0] + v[1] * A[2], v[0] * A[1] + v[1] * A[3]
    return (
        v[0] * A[0] + v[1] * A[3] + v[2] * A[6],
        v[0] * A[1] + v[1] * A[4] + v[2] * A[7],
        v[0] * A[2] + v[1] * A[5] + v[2] * A[8],
    )


@inline_kernel
def product(A: Matrix, B: Matrix) -> Matrix:
    """A B."""
    if len(A) == 4:
        return (
            A[0] * B[0] + A[1] * B[2], A[0] * B[1] + A[1] * B[3],
            A[2] * B[0] + A[3] * B[2], A[2] * B[1] + A[3] * B[3],
        )  # fmt: skip
    return (
        A[0] * B[0] + A[1] * B[3] + A[2] * B[6],
        A[0] * B[1] + A[1] * B[4] + A[2] * B[7],
        A[0] * B[2] + A[1] * B[5] + A[2] * B[8],
        A[3] * B[0] + A[4] * B[3] + A[5] * B[6],
        A[3] * B[1] + A[4] * B[4] + A[5] * B[7],
        A[3] * B[2] + A[4] * B[5] + A[5] * B[8],
        A[6] * B[0] + A[7] * B[3] + A[8] * B[6],
        A[6] * B[1] + A[7] * B[4] + A[8] * B[7],
        A[6] * B[2] + A[7] * B[5] + A[8] * B[8],
    )


@inline_kernel
def inverse(A: Matrix, none: bool) -> Matrix:
    """A^-1, or 0 where there is to be `none`.

    In space y is eliminated first: where nothing couples it, what is left are the digits of the plane.
    """
    if len(A) == 4:
        over = 0.0 if none else 1.0 / (A[0] * A[3] - A[1] * A[2])
        return A[3] * over, -A[1] * over, -A[2] * over, A[0] * over
    xx, xy, xz, yx, yy, yz, zx, zy, zz = A
    r = 0.0 if none else 1.0 / yy
    u, w = xy * r, zy * r
    a, b, c, d = xx - u * yx, xz - u * yz, zx - w * yx, zz - w * yz
    over = 0.0 if none else 1.0 / (a * d - b * c)
    a, b, c, d = d * over, -b * over, -c * over, a * over
    f, g = -(a * u + b * w), -(c * u + d * w)
    return a, f, b, -r * (yx * a + yz * c), r - r * (yx * f + yz * g), -r * (yx * b + yz * d), c, g, d
