"""A passive heave compensator between vessel and cable: what it lets through, and how to tune it (H IV).

Symbols: D motion of the vessel along the cable, p_n of the cable's top, R = p_n - D of the compensator [m];
k, b, m_c stiffness [N/m], damping [N s/m] and mass [kg] of the compensator; c = T_n/p_n - omega^2 m_c the cable with
that mass as a dynamic stiffness [N/m]. The balance (k + i omega b)(D - p_n) = c p_n gives

    Z = p_n/D = (k + i omega b)/(c + k + i omega b),      R/D = Z - 1 = -c/(c + k + i omega b).

A cable that is a mass to the compensator, Re c < 0, gives |Z| < 1 if and only if
k < (|c|^2 + 2 Im c omega b)/(-2 Re c), and so at every damping if k < k_crit = |c|^2/(-2 Re c). Where Re c >= 0 and the
cable only takes energy, Im c >= 0, no stiffness makes the motion of its top larger than the vessel's.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.quantity import InvalidInput, NumericalFailure, check_quantities, non_negative, positive
from models.response_statistics import exceeded_by_one_in, significant

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Advice = Literal["soft", "damp", "lock"]

#: Share of the vessel's motion that a compensator must take off the cable's top to be worth its while.
LEAST_GAIN = 0.01


def dynamic_stiffness(tension_top: ArrayLike, omega: ArrayLike, mass: float) -> Complexes:
    """c [N/m] of the cable's top tension per metre of its top's motion [N/m] and the compensator's mass [kg]."""
    return np.asarray(np.asarray(tension_top) - np.asarray(omega, dtype=float) ** 2 * mass, dtype=complex)


def motion_ratio(c: ArrayLike, omega: ArrayLike, stiffness: ArrayLike, damping: ArrayLike) -> Complexes:
    """Z = p_n/D, of the shape to which all arguments broadcast; infinite stiffness or damping is a locked one.

    Raises
    ------
    NumericalFailure
        Cable and compensator resonate without damping.
    """
    return np.asarray(1.0 + relative_ratio(c, omega, stiffness, damping))


def relative_ratio(c: ArrayLike, omega: ArrayLike, stiffness: ArrayLike, damping: ArrayLike) -> Complexes:
    """R/D, as `motion_ratio`."""
    c, omega = np.asarray(c, dtype=complex), np.asarray(omega, dtype=float)
    stiffness, damping = np.asarray(stiffness, dtype=float), np.asarray(damping, dtype=float)
    locked = np.isinf(stiffness) | np.isinf(damping)
    free = np.where(locked, 0.0, stiffness) + 1j * omega * np.where(locked, 0.0, damping)
    total = np.asarray(c + free)
    held = np.broadcast_to(locked, total.shape)
    if np.any((total == 0.0) & ~held):
        raise NumericalFailure(
            "Cable and compensator resonate without any damping; give the compensator a damping above 0 N s/m."
        )
    return np.asarray(-c / np.where(held, np.inf, total))


def critical_stiffness(c: ArrayLike, resistance: ArrayLike = 0.0) -> Floats:
    """k_crit [N/m], the largest stiffness that does not amplify; infinite where Re c >= 0.

    `resistance` is omega b [N/m] of a damping that is there anyway: it raises k_crit to
    (|c|^2 + 2 Im c omega b)/(-2 Re c). Without it, k_crit holds for every damping, as H means it.
    """
    c = np.asarray(c, dtype=complex)
    falling = c.real < 0.0
    least = np.abs(c) ** 2 + 2.0 * c.imag * np.asarray(resistance, dtype=float)
    return np.asarray(np.where(falling, least / np.where(falling, -2.0 * c.real, 1.0), np.inf))


def relative_limit(stroke: float, sigma: float) -> float:
    """|R/D| at which one relative height in a thousand exceeds the stroke (H IV-B; the quantile, as in its Table IV).

    Parameters
    ----------
    stroke
        Distance between the stops [m].
    sigma
        Standard deviation of the vessel's motion along the cable [m].

    Raises
    ------
    InvalidInput
        The stroke is negative, or the vessel does not move.
    """
    if not 0.0 <= stroke < math.inf:
        raise InvalidInput(f"The compensator's stroke must be at least 0 m, but it is {stroke:g} m.")
    if not 0.0 < sigma < math.inf:
        raise InvalidInput(f"Tuning needs a vessel that moves, but the deviation of its heave is {sigma:g} m.")
    return stroke / float(exceeded_by_one_in(sigma, 1000.0))


def largest_free_height(stroke: float, relative: float) -> float:
    """Significant height of the vessel's motion [m] up to which `relative` = |R/D| keeps inside the stroke [m]."""
    return math.inf if relative == 0.0 else float(significant(stroke / (relative * exceeded_by_one_in(1.0, 1000.0))))


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """Stiffness and damping of a compensator; both infinite for a locked one."""

    stiffness: Annotated[float, non_negative("k", "N/m")]
    damping: Annotated[float, non_negative("b", "N s/m")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Tuning:
    """What keeps inside a limit at one frequency, and what to do of it.

    Parameters
    ----------
    omega, limit
        Frequency [rad/s] and |R/D| asked for.
    c
        Dynamic stiffness of cable and compensator's mass [N/m].
    critical, critical_tuned
        k_crit [N/m] at no damping, and at the damping of `by_damping`; infinite when no stiffness amplifies.
    softest
        The least stiffness with the least damping.
    by_stiffness, by_damping
        The smallest change from `softest`, of the stiffness alone and of the damping alone, that keeps the limit.
    advice
        By H's rules. ``soft``: the softest keeps the limit, nothing is to be tuned. ``damp``: raise the damping.
        ``lock``: the least stiffness is not below `critical`, or the stroke is too short for any use; where it is below
        `critical_tuned` the rule is stricter than it need be, and the tuned damping still spares the cable's top.
    why
        The reason in a sentence.
    """

    omega: float
    limit: float
    c: complex
    critical: float
    critical_tuned: float
    softest: Setting
    by_stiffness: Setting
    by_damping: Setting
    advice: Advice
    why: str

    @property
    def strict(self) -> bool:
        """Whether the rule locks a compensator whose tuned damping would still spare the cable's top."""
        tuned = math.isfinite(self.by_damping.damping)
        return tuned and self.critical <= self.softest.stiffness < self.critical_tuned

    def relative(self, setting: Setting) -> float:
        """|R/D| of a setting."""
        return float(np.abs(relative_ratio(self.c, self.omega, setting.stiffness, setting.damping)))

    def top(self, setting: Setting) -> float:
        """|p_n/D| of a setting."""
        return float(np.abs(motion_ratio(self.c, self.omega, setting.stiffness, setting.damping)))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    """The checked arguments of `tune`."""

    omega: Annotated[float, positive("omega", "rad/s")]
    limit: Annotated[float, non_negative("|R/D|", "-")]
    least_stiffness: Annotated[float, non_negative("k_min", "N/m")]
    least_damping: Annotated[float, non_negative("b_min", "N s/m")]

    def __post_init__(self) -> None:
        check_quantities(self)


def tune(c: complex, omega: float, limit: float, *, least_stiffness: float, least_damping: float) -> Tuning:
    """Tune a compensator for |R/D| <= limit at one frequency, by H's rules for high seas.

    Parameters
    ----------
    c
        Dynamic stiffness of the cable with the compensator's mass at `omega` [N/m].
    omega
        [rad/s].
    limit
        Of `relative_limit`.
    least_stiffness, least_damping
        [N/m], [N s/m]; what the compensator cannot go below.

    Raises
    ------
    InvalidInput
        A value is out of bounds.
    NumericalFailure
        Cable and compensator resonate without damping.

    Notes
    -----
    H looks at k_crit without damping; what is tuned has some, and so `Tuning.critical_tuned` is the sharper bound.
    The limit is the circle |c + k + i omega b| = |c|/limit. The softest setting is inside it when it moves too much,
    and then stiffness and damping each cross it once going up.
    """
    _Task(omega=omega, limit=limit, least_stiffness=least_stiffness, least_damping=least_damping)
    omega, limit, c = float(omega), float(limit), complex(c)
    softest = Setting(stiffness=least_stiffness, damping=least_damping)
    locked = Setting(stiffness=math.inf, damping=math.inf)
    relative = float(np.abs(relative_ratio(c, omega, least_stiffness, least_damping)))
    critical = float(critical_stiffness(c))
    if relative <= limit:
        by_stiffness = by_damping = softest
    elif limit == 0.0:
        by_stiffness = by_damping = locked
    else:
        radius = abs(c) / limit
        height, width = c.imag + omega * least_damping, c.real + least_stiffness
        by_stiffness = Setting(
            stiffness=math.sqrt(radius**2 - height**2) - c.real,
            damping=least_damping,
        )
        by_damping = Setting(
            stiffness=least_stiffness,
            damping=(math.sqrt(radius**2 - width**2) - c.imag) / omega,
        )
    advice, why = _advice(limit, relative, least_stiffness, critical)
    return Tuning(
        omega=omega,
        limit=limit,
        c=c,
        critical=critical,
        critical_tuned=float(critical_stiffness(c, omega * by_damping.damping)) if limit > 0.0 else math.inf,
        softest=softest,
        by_stiffness=by_stiffness,
        by_damping=by_damping,
        advice=advice,
        why=why,
    )


def _advice(limit: float, relative: float, stiffness: float, critical: float) -> tuple[Advice, str]:
    """H's rules, and the two ends that they leave out: a stroke that is long enough, and one too short for any use."""
    if stiffness >= critical:
        return "lock", (
            f"the least stiffness, {stiffness:.4g} N/m, is not below k_crit = {critical:.4g} N/m, so that the cable's "
            "top could move more than the vessel"
        )
    if relative <= limit:
        return "soft", (
            f"the softest compensator moves by {relative:.3g} of the vessel's motion and may move by {limit:.3g}: "
            "nothing has to be constrained"
        )
    if limit < LEAST_GAIN:
        return "lock", (
            f"the stroke allows {limit:.2g} of the vessel's motion, and the cable's top cannot be spared more than that"
        )
    if math.isinf(critical):
        return "damp", "no stiffness amplifies, and damping until the stroke holds spares the cable's top most"
    return "damp", (
        f"the least stiffness, {stiffness:.4g} N/m, is below k_crit = {critical:.4g} N/m, so that no damping lets the "
        "cable's top move more than the vessel"
    )
