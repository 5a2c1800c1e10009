"""The massless n-link chain, T (6.5)-(6.7): springs of the local static tension, drag at the nodes.

Node i < n carries the drag of ds of cable; the vehicle's node carries one drag of its own, the vehicle's with
half a link of cable. The half link next to the ship is the ship's, so the nodes hold B + beta (L - ds/2).
"""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from models.chain import Chain
from models.parameter import Drag, Free, check_free
from models.quantity import InvalidInput

#: Most links of a chain.
MAX_LINKS = 64


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Massless:
    """Massless chain; `stiffness` (n,) [N/m] from the ship down and `link` length [m] are physics, not parameters.

    With one link the only node is the vehicle: `cable_drag` is 0 and not a parameter.
    """

    drag: Drag
    stiffness: NDArray[np.float64]
    link: float
    cable_drag: Annotated[float, Free("beta", "N s2/m3", "N s/m2", 1e-3, 1e5)] = 0.0
    vehicle_drag: Annotated[float, Free("B_veh", "N s2/m2", "N s/m", 1e-3, 1e8)]

    def __post_init__(self) -> None:
        object.__setattr__(self, "stiffness", springs(self.stiffness, self.link))
        check_free(self, self.held)

    @property
    def held(self) -> tuple[str, ...]:
        """Parameters that are not free: no node carries them."""
        return ("cable_drag",) if self.stiffness.size == 1 else ()

    def chain(self) -> Chain:
        """Node values for the solvers."""
        n = self.stiffness.size
        return Chain(self.stiffness, lumped(n, self.cable_drag * self.link, self.vehicle_drag), np.zeros(n))


def lumped(n: int, inner: float, vehicle: float) -> NDArray[np.float64]:
    """(n,) node values: `inner` at the cable's nodes, `vehicle` at the last."""
    values = np.full(n, inner)
    values[-1] = vehicle
    return values


def springs(stiffness: NDArray[np.float64], link: float) -> NDArray[np.float64]:
    """A read-only copy of (n,) spring stiffnesses [N/m].

    Raises
    ------
    InvalidInput
        There are not 1 to 64 springs, or a stiffness or the length of a link [m] is not above zero.
    """
    k = np.array(stiffness, dtype=float)
    if k.ndim != 1 or not 1 <= k.size <= MAX_LINKS:
        raise InvalidInput(f"A chain needs 1 to {MAX_LINKS} links, but stiffness has the shape {k.shape}.")
    sound = np.isfinite(k) & (k > 0.0)
    if not sound.all():
        i = int(np.argmin(sound))
        raise InvalidInput(
            f"A link's stiffness must be above 0 N/m, but link {i + 1} from the ship has {k[i]:g} N/m; "
            "the cable must be in tension everywhere."
        )
    if not (np.isfinite(link) and link > 0.0):
        raise InvalidInput(f"The length of a link must be above 0 m, but it is {link:g} m.")
    k.setflags(write=False)
    return k
