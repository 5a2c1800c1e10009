"""The inertial n-link chain, T (6.3)-(6.4): the massless chain with mass at the nodes.

Node i < n carries drag and effective mass (with added mass) of ds of cable; the vehicle's node carries a drag
and a mass of its own, the vehicle's with half a link of cable.
"""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from models.chain import Chain
from models.massless import lumped, springs
from models.parameter import Drag, Free, check_free


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Inertial:
    """Chain with mass; `stiffness` (n,) [N/m] from the ship down and `link` length [m] are physics, not parameters.

    With one link the only node is the vehicle: `cable_drag` and `cable_mass` are 0 and not parameters.
    """

    drag: Drag
    stiffness: NDArray[np.float64]
    link: float
    cable_drag: Annotated[float, Free("beta", "N s2/m3", "N s/m2", 1e-3, 1e5)] = 0.0
    cable_mass: Annotated[float, Free("m_c", "kg/m", "kg/m", 1e-3, 1e4)] = 0.0
    vehicle_drag: Annotated[float, Free("B_veh", "N s2/m2", "N s/m", 1e-3, 1e8)]
    vehicle_mass: Annotated[float, Free("M_veh", "kg", "kg", 1e-1, 1e8)]

    def __post_init__(self) -> None:
        object.__setattr__(self, "stiffness", springs(self.stiffness, self.link))
        check_free(self, self.held)

    @property
    def held(self) -> tuple[str, ...]:
        """Parameters that are not free: no node carries them."""
        return ("cable_drag", "cable_mass") if self.stiffness.size == 1 else ()

    def chain(self) -> Chain:
        """Node values for the solvers."""
        n = self.stiffness.size
        return Chain(
            self.stiffness,
            lumped(n, self.cable_drag * self.link, self.vehicle_drag),
            lumped(n, self.cable_mass * self.link, self.vehicle_mass),
        )
