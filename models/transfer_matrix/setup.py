"""What both kinds of response start from: the linearised tow on its nodes, and the motion imposed at the top."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Literal, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput, NumericalFailure, Quantity, check_quantities, non_negative
from models.rise import Rise
from models.statics import StaticShape, shape_on
from models.tow import Tow
from models.transfer_matrix import columns as c
from models.transfer_matrix.line import Line, linearise
from models.transfer_matrix.mesh import graded_nodes, joints_of

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

#: Motion of the cable's top: along the cable, vertical, or horizontal.
Direction = Literal["axial", "heave", "surge"]
#: Whether the moved angle, the coupled drag of the body and shear are kept, or left out as H prints the equations.
DragForm = Literal["consistent", "printed"]

#: Segments that the search for a resolution begins and ends with, and the share of the largest amplitude that the
#: error of a result may have.
FIRST_SEGMENTS, LAST_SEGMENTS, SHARE = 64, 16384, 1e-3
#: The share from which a mesh that was asked for is called too coarse.
COARSE = 0.01

_TENSIONS = ("tension_bottom", "tension_top")

R = TypeVar("R", bound="HasError")


class HasError(Protocol):
    """A result with the estimated errors of its quantities as shares of their largest amplitudes."""

    @property
    def shares(self) -> Mapping[str, float]: ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Compensator:
    """A passive heave compensator between the deck and the cable's top, H section IV-A."""

    mass: Annotated[float, non_negative("m_comp", "kg")] = 0.0
    stiffness: Annotated[float, non_negative("k_comp", "N/m")]
    damping: Annotated[float, non_negative("b_comp", "N s/m")]

    def __post_init__(self) -> None:
        check_quantities(self)


@dataclass(frozen=True, slots=True, kw_only=True)
class UniformDamping:
    """Linear damping that is given and not iterated for: b_p and b_q of the cable, B_P, B_Q and B_Phi of the body."""

    axial: Annotated[float, Quantity("b_p", "N s/m2", lower=0.0)] = 0.0
    normal: Annotated[float, Quantity("b_q", "N s/m2", lower=0.0)] = 0.0
    surge: Annotated[float, Quantity("B_P", "N s/m", lower=0.0)] = 0.0
    heave: Annotated[float, Quantity("B_Q", "N s/m", lower=0.0)] = 0.0
    pitch: Annotated[float, Quantity("B_Phi", "N m s", lower=0.0)] = 0.0

    def __post_init__(self) -> None:
        check_quantities(self)


def checked_frequencies(omega: ArrayLike) -> Floats:
    """The frequencies as an increasing array above zero [rad/s].

    Raises
    ------
    InvalidInput
        None, one that is not above zero and finite, or one not above the one before.
    """
    values = np.atleast_1d(np.asarray(omega, dtype=float))
    if values.ndim != 1 or values.size == 0:
        raise InvalidInput("Give at least one frequency [rad/s], in one list.")
    wrong = ~(np.isfinite(values) & (values > 0.0))
    if wrong.any():
        i = int(np.argmax(wrong))
        raise InvalidInput(
            f"A frequency must be above 0 rad/s, but omega[{i}] = {values[i]:g} rad/s; slow motion is that of a small "
            "frequency such as 1e-4 rad/s, and at rest the cable has its static shape."
        )
    if np.any(np.diff(values) <= 0.0):
        i = int(np.argmax(np.diff(values) <= 0.0))
        raise InvalidInput(
            f"Frequencies must increase, but omega[{i}] = {values[i]:g} and omega[{i + 1}] = {values[i + 1]:g} rad/s."
        )
    return values


def nodes_of(
    tow: Tow, segments: int, omega: Floats, amplitude: float, *, halvings: int = 1, way: Rise | None = None
) -> Floats:
    """The graded nodes for frequencies up to the last of `omega` and a motion of the top of `amplitude` [m]."""
    highest = float(omega[-1])
    return graded_nodes(tow, segments, highest, 0.1 * amplitude * highest, halvings=halvings, way=way)


def checked_nodes(tow: Tow, nodes: ArrayLike) -> Floats:
    """Nodes given by the caller, with every joint of two sections among them.

    Raises
    ------
    InvalidInput
        They do not increase from 0 to the length of the cable, or a joint between two sections is not a node.
    """
    s = np.asarray(nodes, dtype=float)
    if s.ndim != 1 or s.size < 3 or not np.isfinite(s).all() or np.any(np.diff(s) <= 0.0):
        raise InvalidInput("nodes must be at least three increasing lengths from the vehicle [m].")
    for joint in joints_of(tow).tolist():
        if not np.isclose(s, joint, rtol=0.0, atol=1e-9 * tow.length).any():
            raise InvalidInput(
                f"nodes must hold 0, the length of the cable and every joint, but {joint:g} m is missing."
            )
    return s


def line_of(tow: Tow, way: Rise, nodes: Floats, drag: DragForm, *, stretch_drag: bool = True) -> Line:
    """The tow linearised about its steady shape, whose way up is `way`.

    Raises
    ------
    InvalidInput
        An unknown form of the drag, or nodes out of order.
    """
    if drag not in ("consistent", "printed"):
        raise InvalidInput(f"drag must be 'consistent' or 'printed', but it is {drag!r}.")
    return linearise(tow, shape_on(tow, way, nodes), printed=drag == "printed", stretch_drag=stretch_drag)


def direction_of(line: Line, direction: Direction) -> Floats:
    """(2,) components p_n, q_n of a unit motion of the top."""
    phi = float(line.shape.phi[-1])
    known = {
        "axial": (1.0, 0.0),
        "heave": (math.sin(phi), math.cos(phi)),
        "surge": (math.cos(phi), -math.sin(phi)),
    }
    if direction not in known:
        raise InvalidInput(f"direction must be one of {', '.join(known)}, but it is {direction!r}.")
    return np.array(known[direction])


def compensator_of(compensator: Compensator | None, tops: Complexes) -> Floats:
    """(4,) mass, stiffness, damping and whether there is one; the motion must then be along the cable."""
    if compensator is None:
        return np.zeros(4)
    if compensator.stiffness == 0.0 and compensator.damping == 0.0:
        raise InvalidInput(
            "A compensator needs a stiffness or a damping above 0; with neither the cable hangs on nothing."
        )
    across = np.abs(tops[:, 1]) > 1e-6 * np.abs(tops[:, 0])
    if across.any():
        raise InvalidInput(
            "A heave compensator acts along the cable (H section IV-A), but the motion of its top has a part across "
            "it; use the direction 'axial'."
        )
    return np.array([compensator.mass, compensator.stiffness, compensator.damping, 1.0])


def scales_of(line: Line, omega: Floats) -> Floats:
    """(k, 2) weights of T~^2 and phi~^2 beside those of p^2 and q^2: the impedances of both kinds of waves."""
    T = float(np.mean(line.shape.T))
    mass, compliance = float(line.ends[:, c.MASS].max()), float(line.ends[:, c.COMPLIANCE].min())
    lateral = float((line.ends[:, c.MASS_A] * T).max())
    length = float(line.shape.s[-1])
    axial = omega * math.sqrt(mass / compliance) + T / length
    angle = omega * math.sqrt(lateral / T) + 1.0 / length
    return np.column_stack([axial**-2.0, angle**-2.0])


def shares_of(
    error: Mapping[str, float], size: Mapping[str, float], imposed: float, shape: StaticShape
) -> dict[str, float]:
    """Errors over sizes; those of motions in the plane over the largest of them, and nothing over next to nothing.

    `imposed` is the motion of the top [m].
    """
    plane = max([imposed * 1e-3, *(size[name] for name in size if name not in ("pitch", *_TENSIONS))])
    floor = dict.fromkeys(_TENSIONS, 1e-4 * float(np.max(shape.T))) | {"pitch": 1e-3 * imposed}
    return {
        name: each / max(size[name], floor[name]) if name in floor else each / plane for name, each in error.items()
    }


def failed_at(line: Line, omega: float) -> NumericalFailure:
    """The failure of a linear solve, with its place."""
    return NumericalFailure(
        f"The motion of the cable's top cannot be imposed at {omega:g} rad/s: without any damping this frequency is "
        f"one of the cable's own ({line.h.size} segments, least tension {line.shape.T.min():.4g} N). Give some drag or "
        "change the frequency."
    )


def on_nodes(
    run: Callable[[Floats], R], tow: Tow, nodes: Floats, companion: bool, with_error: Callable[[R, R], R]
) -> R:
    """The result on given nodes, with its error where every second of them is a mesh too."""
    joints = joints_of(tow)
    even = nodes.size > 4 and all(
        np.isclose(nodes[::2], joint, rtol=0.0, atol=1e-9 * tow.length).any() for joint in joints
    )
    return with_error(run(nodes), run(nodes[::2])) if companion and even else run(nodes)


def resolve(
    run: Callable[[Floats], R],
    tow: Tow,
    segments: int | None,
    make: Callable[[int], Floats],
    with_error: Callable[[R, R], R],
) -> R:
    """The result on a mesh fine enough: its segments are doubled until the estimated error is small, unless given.

    Raises
    ------
    NumericalFailure
        The finest mesh still errs by more than its share.
    """
    count = FIRST_SEGMENTS * len(tow.cables) if segments is None else segments
    nodes = make(count)
    coarse = run(nodes[::2])
    while True:
        fine = with_error(run(nodes), coarse)
        worst = max(fine.shares, key=lambda name: fine.shares[name])
        if segments is not None or fine.shares[worst] <= SHARE:
            return fine
        if count >= LAST_SEGMENTS:
            raise NumericalFailure(
                f"With {count} segments the {worst} still errs by {fine.shares[worst]:.2g} of its largest amplitude; "
                "give the number of segments and take the error as it is, or lower the highest frequency."
            )
        count *= 2
        nodes = make(count)
        coarse = run(nodes[::2])
