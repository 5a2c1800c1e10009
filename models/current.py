"""The ambient current: horizontal speed against depth, positive toward +X."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Current:
    """A profile: linear between the given depths, constant outside them."""

    depth: NDArray[np.float64]
    speed: NDArray[np.float64]

    def __post_init__(self) -> None:
        depth = np.array(self.depth, dtype=float)
        speed = np.array(self.speed, dtype=float)
        if depth.ndim != 1 or depth.shape != speed.shape or depth.size == 0:
            raise InvalidInput(
                f"Current needs one speed [m/s] for each depth [m], but got {depth.size} depths and "
                f"{speed.size} speeds."
            )
        if not (np.isfinite(depth).all() and np.isfinite(speed).all()):
            raise InvalidInput("Current needs finite depths and speeds, but one of them is not a number.")
        if np.any(np.diff(depth) <= 0.0):
            i = int(np.argmax(np.diff(depth) <= 0.0))
            raise InvalidInput(
                f"Current needs increasing depths, but depth[{i}] = {depth[i]:g} m and "
                f"depth[{i + 1}] = {depth[i + 1]:g} m."
            )
        depth.setflags(write=False)
        speed.setflags(write=False)
        object.__setattr__(self, "depth", depth)
        object.__setattr__(self, "speed", speed)

    @classmethod
    def from_profile(cls, depth: Sequence[float], speed: Sequence[float]) -> "Current":
        """The profile through the given depths [m, positive down] and speeds [m/s]."""
        return cls(depth=np.asarray(depth, dtype=float), speed=np.asarray(speed, dtype=float))

    @classmethod
    def uniform(cls, speed: float) -> "Current":
        """The same speed [m/s] at every depth."""
        return cls.from_profile([0.0], [speed])

    def at(self, depth: ArrayLike) -> NDArray[np.float64]:
        """Speed [m/s] at the given depths [m, positive down], shape kept."""
        speed: NDArray[np.float64] = np.interp(np.asarray(depth, dtype=float), self.depth, self.speed)
        return speed
