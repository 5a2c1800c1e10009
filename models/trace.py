"""The one type in and out of every simulator: time and positions.

Between its samples a trace is the C2 cubic spline through its positions (not-a-knot ends), so that every
model is driven by the very same motion and velocity.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Trace:
    """Positions of one body against time.

    Parameters
    ----------
    t
        (n,) [s], strictly increasing, n at least 2.
    position
        (n, 3) [m]: x and y horizontal, z up from the surface. NaN marks a missing fix.
    velocity
        (n, 3) [m/s], given where the source knows it; otherwise the derivative of the spline.
    tension
        (n, 2) [N] at the top and at the bottom of the cable, where known.

    Raises
    ------
    InvalidInput
        The times do not increase, or the shapes do not agree.
    """

    t: Floats
    position: Floats
    velocity: Floats | None = None
    tension: Floats | None = None

    def __post_init__(self) -> None:
        t = np.array(self.t, dtype=float)
        if t.ndim != 1 or t.size < 2:
            raise InvalidInput(f"Trace needs at least 2 times, but t has the shape {t.shape}.")
        if not np.isfinite(t).all():
            raise InvalidInput(f"Trace needs finite times, but t[{int(np.argmin(np.isfinite(t)))}] is not.")
        steps = np.diff(t)
        if np.any(steps <= 0.0):
            i = int(np.argmax(steps <= 0.0))
            raise InvalidInput(
                f"Trace needs strictly increasing t, but t[{i}] = {t[i]:g} s and t[{i + 1}] = {t[i + 1]:g} s; "
                "sort the record or drop the repeats."
            )
        for name, width in (("t", 0), ("position", 3), ("velocity", 3), ("tension", 2)):
            value = getattr(self, name)
            if value is None:
                continue
            array = np.array(value, dtype=float)
            if width and array.shape != (t.size, width):
                raise InvalidInput(f"Trace.{name} needs the shape ({t.size}, {width}), but has {array.shape}.")
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @classmethod
    def along_x(cls, t: ArrayLike, x: ArrayLike, z: ArrayLike = 0.0) -> "Trace":
        """A planar trace: x [m] and z [m] against t [s], y = 0."""
        t = np.asarray(t, dtype=float)
        position = np.zeros((t.size, 3))
        position[:, 0] = x
        position[:, 2] = z
        return cls(t=t, position=position)

    def __len__(self) -> int:
        return int(self.t.size)

    @property
    def valid(self) -> NDArray[np.bool_]:
        """(n,) whether the sample holds a fix."""
        seen: NDArray[np.bool_] = np.logical_and.reduce(np.isfinite(self.position), axis=1)
        return seen

    @cached_property
    def spline(self) -> "CubicSpline":
        """The C2 cubic spline through the valid positions."""
        from scipy.interpolate import CubicSpline

        keep = self.valid
        if int(keep.sum()) < 2:
            raise InvalidInput("A trace needs at least 2 fixes to be interpolated.")
        return CubicSpline(self.t[keep], self.position[keep])

    def at(self, times: ArrayLike) -> Floats:
        """(k, 3) positions [m] at the given times [s]."""
        return np.asarray(self.spline(np.asarray(times, dtype=float)), dtype=float)

    def rates(self) -> Floats:
        """(n, 3) velocity [m/s] at the samples: as given, else the derivative of the spline."""
        if self.velocity is not None:
            return self.velocity
        return np.asarray(self.spline(self.t, 1), dtype=float)
