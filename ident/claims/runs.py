"""The turns that answer W's claims: its radii, speeds, lengths and parts, one at a time."""

from dataclasses import dataclass

import numpy as np

from data_synth.ships import KNOT
from ident.configuration import Configuration
from ident.turning import Turning

#: W's sweeps: radii [m], speeds [kn], lengths of the main cable [m], and the circles of each full turn.
RADII = (250.0, 500.0, 750.0, 1000.0, 1500.0)
SPEEDS = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
LENGTHS = tuple(np.arange(1000.0, 3201.0, 200.0).tolist())
TURNS = 6.0
U_SPEEDS, U_RADII = (2.0, 4.0, 6.0), (250.0, 500.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Turns that are shown together."""

    title: str
    turnings: tuple[Turning, ...]


def groups(configuration: Configuration) -> tuple[Group, ...]:
    """The turns that answer the claims, on the configuration's own length where the length is not what changes."""
    most = 1 + len(configuration.tails)
    own, fast = configuration.tow.cable.length, max(SPEEDS) * KNOT
    few, three = min(2, most), min(3, most)

    def full(parts: int = 1, length: float = own, radius: float = RADII[0], speed: float = fast) -> Turning:
        return Turning(parts=parts, length=length, radius=radius, speed=speed, turns=TURNS)

    u_turns = [
        Turning(parts=few, length=own, radius=radius, speed=speed * KNOT, turns=0.5)
        for radius in U_RADII
        for speed in U_SPEEDS
    ]
    return (
        Group(title="One, two and three parts", turnings=tuple(full(parts=n + 1) for n in range(three))),
        Group(title="Turning radius", turnings=tuple(full(radius=radius) for radius in RADII)),
        *(
            [Group(title="Turning radius, all parts", turnings=tuple(full(parts=three, radius=r) for r in RADII))]
            if three > 1
            else []
        ),
        Group(title="Tow speed", turnings=tuple(full(speed=speed * KNOT) for speed in SPEEDS)),
        Group(
            title="Length of the main cable",
            turnings=tuple(full(parts=few, length=length) for length in LENGTHS),
        ),
        Group(title="U-turns", turnings=tuple(u_turns)),
    )
