"""The discrete chain as the kernels read it: links, nodes, bodies and the current, in flat arrays.

Nodes are numbered from the free ends up, the ship last, so that the parent of node i has a larger number and a branch
comes before the joint it hangs from. Link i joins node i to its parent. Cable that is paid out becomes new nodes just
below the ship, at the end of the arrays.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.quantity import GRAVITY, InvalidInput
from models.strumming import amplification
from models.towed_system import Part, TowedSystem

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Links that every part has at least, and that the first part may have at most.
FEWEST_LINKS, MOST_LINKS = 4, 4096
#: From this stiffness on [N] a link is rigid: tens of kilonewtons stretch it by a few millionths.
RIGID = 1e10

QUADRATIC, INCIDENCE = 0, 1


class Chain(NamedTuple):
    """Arrays over links (m,) and nodes (m + 1,), the ship's node last; see the module docstring for the order."""

    parent: Indices  # of node i
    part: Indices  # part of link i
    length: Floats  # unstretched [m]
    compliance: Floats  # 1/EA [1/N], 0 of a rigid link
    damping: Floats  # tau_a [s]
    poisson: Floats  # nu
    area: Floats  # cross section [m2]
    mass: Floats  # [kg/m]
    added_mass: Floats  # normal [kg/m]
    weight: Floats  # in water [N/m]
    normal_drag: Floats  # [N s2/m3]
    tangential_drag: Floats  # [N s2/m3]
    has_body: NDArray[np.bool_]
    held: NDArray[np.bool_]  # a node that does not move
    body_mass: Floats  # [kg]
    body_weight: Floats  # in water [N]
    body_added_mass: Floats  # (m + 1, 3) surge, sway, heave [kg]
    body_drag: Floats  # (m + 1, 3) [N s2/m2]
    current_depth: Floats  # (k,) [m], empty in still water
    current_x: Floats  # (k,) [m/s]
    current_y: Floats  # empty where the chain is that of a plane, with current_x along it
    specific_weight: float  # of the water [N/m3]
    law: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Layout:
    """A chain, and where its parts are in it: of each part the node of its lower end, and the number of its links.

    The links of a part follow each other from its lower end up, each with the number of its lower node.
    """

    chain: Chain
    lower_end: tuple[int, ...]
    links: tuple[int, ...]

    @property
    def count(self) -> int:
        """Number of links and of moving nodes."""
        return sum(self.links)


def links_of_parts(system: TowedSystem, links: int) -> tuple[int, ...]:
    """Links of every part: the first has `links`, the others the same length of link, at least four.

    Raises
    ------
    InvalidInput
        Fewer than four links, or too many.
    """
    if not FEWEST_LINKS <= links <= MOST_LINKS:
        raise InvalidInput(
            f"The link-joint chain needs {FEWEST_LINKS} to {MOST_LINKS} links on its first part, but {links} were "
            "given."
        )
    size = system.parts[0].cable.length / links
    return (links, *(max(FEWEST_LINKS, round(part.cable.length / size)) for part in system.parts[1:]))


def build(system: TowedSystem, links: int) -> Layout:
    """The chain of a system with `links` on its first part."""
    counts = links_of_parts(system, links)
    total = sum(counts)
    # Last part first: whatever hangs from a joint is numbered before the joint.
    first, at = {}, 0
    for index in reversed(range(len(counts))):
        first[index] = at
        at += counts[index]
    names = [part.name for part in system.parts]
    parent, part_of = np.zeros(total, np.int64), np.zeros(total, np.int64)
    for index, part in enumerate(system.parts):
        start, count = first[index], counts[index]
        parent[start : start + count] = np.arange(start + 1, start + count + 1)
        parent[start + count - 1] = total if part.after is None else first[names.index(part.after)]
        part_of[start : start + count] = index
    per_link = np.array([_link(part, count, system) for part, count in zip(system.parts, counts, strict=True)])[part_of]
    bodies = np.zeros((total + 1, 8))
    has_body = np.zeros(total + 1, np.bool_)
    for index, part in enumerate(system.parts):
        if part.body is not None:
            has_body[first[index]] = True
            bodies[first[index]] = _body(part, system.water_density)
    depth, speeds = current_of(system)
    chain = Chain(
        parent=parent,
        part=part_of,
        **{name: np.ascontiguousarray(per_link[:, i]) for i, name in enumerate(_LINK_FIELDS)},
        has_body=has_body,
        held=np.zeros(total + 1, np.bool_),
        body_mass=np.ascontiguousarray(bodies[:, 0]),
        body_weight=np.ascontiguousarray(bodies[:, 1]),
        body_added_mass=np.ascontiguousarray(bodies[:, 2:5]),
        body_drag=np.ascontiguousarray(bodies[:, 5:8]),
        current_depth=depth,
        current_x=np.ascontiguousarray(speeds[:, 0]),
        current_y=np.ascontiguousarray(speeds[:, 1]),
        specific_weight=system.water_density * GRAVITY,
        law=INCIDENCE if system.drag_law == "incidence" else QUADRATIC,
    )
    return Layout(chain=chain, lower_end=tuple(first[index] for index in range(len(counts))), links=counts)


def current_of(system: TowedSystem) -> tuple[Floats, Floats]:
    """Depths (k,) [m] and the current's horizontal velocity there (k, 2) [m/s], of no depth in still water."""
    current = system.current
    if current is None or not current.speed.any():
        return np.zeros(0), np.zeros((0, 2))
    return np.array(current.depth), current.velocity_at(current.depth)


_LINK_FIELDS = (
    "length",
    "compliance",
    "damping",
    "poisson",
    "area",
    "mass",
    "added_mass",
    "weight",
    "normal_drag",
    "tangential_drag",
)


_NODE_FIELDS = ("has_body", "held", "body_mass", "body_weight", "body_added_mass", "body_drag")


def _link(part: Part, count: int, system: TowedSystem) -> tuple[float, ...]:
    """One link's numbers in the order of `_LINK_FIELDS`."""
    cable, rho = part.cable, system.water_density
    normal = cable.normal_drag(rho)
    if system.strumming:
        normal *= amplification(cable, rho, system.strumming_damping)
    rigid = cable.axial_stiffness >= RIGID
    return (
        cable.length / count,
        0.0 if rigid else 1.0 / cable.axial_stiffness,
        0.0 if rigid else cable.axial_damping,
        cable.poisson_ratio,
        0.0 if rigid else cable.cross_section,
        cable.mass,
        cable.added_mass,
        cable.weight_in_water,
        normal,
        cable.tangential_drag(rho),
    )


def _body(part: Part, rho: float) -> tuple[float, ...]:
    """Mass, weight in water, added masses and drags of a part's body."""
    body = part.body
    assert body is not None
    half = 0.5 * rho * body.drag_coefficient
    return (
        body.mass,
        body.weight_in_water,
        body.added_mass_surge,
        body.added_mass_sway,
        body.added_mass_heave,
        half * body.area_surge,
        half * body.area_sway,
        half * body.area_heave,
    )


def with_room(chain: Chain, extra: int, nominal: float) -> Chain:
    """The chain with room for `extra` more links below the ship, of `nominal` unstretched length [m].

    The node that was the ship stays the last of those in use; new links repeat the properties of the top one.
    """
    top = chain.parent.size - 1
    total = top + 1 + extra

    def links(name: str) -> Any:
        values = getattr(chain, name)
        return np.concatenate([values, np.repeat(values[top], extra)])

    def nodes(name: str) -> Any:
        values = getattr(chain, name)
        return np.concatenate([values, np.zeros((extra, *values.shape[1:]), values.dtype)])

    more: dict[str, Any] = {name: links(name) for name in _LINK_FIELDS}
    more |= {name: nodes(name) for name in _NODE_FIELDS}
    more["length"] = np.concatenate([chain.length, np.full(extra, nominal)])
    return chain._replace(
        parent=np.concatenate([chain.parent, np.arange(top + 2, total + 1)]),
        part=np.concatenate([chain.part, np.repeat(chain.part[top], extra)]),
        **more,
    )
