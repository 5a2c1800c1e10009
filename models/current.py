"""The ambient current: a horizontal velocity against depth."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Current:
    """A profile: its components are linear between the given depths and constant outside them.

    `direction` [rad] is where the water goes, from +X counterclockwise seen from above: one for each depth or one
    for them all. A negative `speed` goes the other way.
    """

    depth: Floats
    speed: Floats
    direction: Floats = field(default_factory=lambda: np.zeros(1))

    def __post_init__(self) -> None:
        depth = np.array(self.depth, dtype=float)
        speed = np.array(self.speed, dtype=float)
        direction = np.array(self.direction, dtype=float)
        if depth.ndim != 1 or depth.shape != speed.shape or depth.size == 0:
            raise InvalidInput(
                f"Current needs one speed [m/s] for each depth [m], but got {depth.size} depths and "
                f"{speed.size} speeds."
            )
        if direction.shape not in ((1,), depth.shape):
            raise InvalidInput(
                f"Current needs one direction [rad] for each depth [m], or one for all, but got {depth.size} depths "
                f"and {direction.size} directions."
            )
        if not (np.isfinite(depth).all() and np.isfinite(speed).all() and np.isfinite(direction).all()):
            raise InvalidInput("Current needs finite depths, speeds and directions, but one of them is not a number.")
        if np.any(np.diff(depth) <= 0.0):
            i = int(np.argmax(np.diff(depth) <= 0.0))
            raise InvalidInput(
                f"Current needs increasing depths, but depth[{i}] = {depth[i]:g} m and "
                f"depth[{i + 1}] = {depth[i + 1]:g} m."
            )
        for name, values in (("depth", depth), ("speed", speed), ("direction", np.resize(direction, depth.shape))):
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    @classmethod
    def from_profile(
        cls, depth: Sequence[float], speed: Sequence[float], direction: Sequence[float] = (0.0,)
    ) -> "Current":
        """The profile through the given depths [m, positive down], speeds [m/s] and directions [rad]."""
        return cls(
            depth=np.asarray(depth, dtype=float),
            speed=np.asarray(speed, dtype=float),
            direction=np.asarray(direction, dtype=float),
        )

    @classmethod
    def uniform(cls, speed: float, direction: float = 0.0) -> "Current":
        """The same speed [m/s] and direction [rad] at every depth."""
        return cls.from_profile([0.0], [speed], [direction])

    @property
    def velocity(self) -> Floats:
        """Components (n, 2) [m/s] along +X and +Y at the given depths."""
        velocity: Floats = self.speed[:, None] * np.column_stack([np.cos(self.direction), np.sin(self.direction)])
        return velocity

    @property
    def planar(self) -> bool:
        """Whether the water moves along X alone, to what a user writes of pi."""
        across = np.abs(self.velocity[:, 1])
        return bool((across <= 1e-6 * np.abs(self.speed)).all())

    def velocity_at(self, depth: ArrayLike) -> Floats:
        """Components [m/s] along +X and +Y at the given depths [m, positive down], on a last axis of 2."""
        return np.stack([self.at(depth), self._interpolated(depth, 1)], axis=-1)

    def at(self, depth: ArrayLike) -> Floats:
        """Component [m/s] along +X at the given depths [m, positive down], shape kept."""
        return self._interpolated(depth, 0)

    def plus(self, speed: float) -> "Current":
        """This current with the same speed [m/s] toward +X added at every depth."""
        x, y = self.velocity[:, 0] + speed, self.velocity[:, 1]
        return Current(depth=self.depth, speed=np.hypot(x, y), direction=np.arctan2(y, x))

    def _interpolated(self, depth: ArrayLike, axis: int) -> Floats:
        component: Floats = np.interp(np.asarray(depth, dtype=float), self.depth, self.velocity[:, axis])
        return component
