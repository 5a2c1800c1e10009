"""What a configuration says beside the tow itself: the settings of the simulator, the search and the studies.

Field name, symbol, unit, bounds and default stand here once; `ident.schema` makes the keys of the file from them.
"""

import math
from dataclasses import dataclass, field
from typing import Annotated, Literal

from data_synth.settings import check_increasing, check_same_length
from models.quantity import Quantity, non_negative, positive
from models.towed_system import DragLaw, StrummingDamping

_TURN = 2.0 * math.pi

VerificationKind = Literal["starts-and-stops", "sharp-transients", "few-sinusoids"]


def _every_model() -> tuple[str, ...]:
    from models.reduced import MODEL_NAMES

    return tuple(MODEL_NAMES)


@dataclass(frozen=True, slots=True, kw_only=True)
class Heading:
    """The keys above the first section; `guesses` names the keys whose values nobody measured."""

    description: str = ""
    guesses: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """The cable's material, from which mass, weight and stiffness follow."""

    density: Annotated[float, positive("rho_c", "kg/m3")]
    young_modulus: Annotated[float, positive("E", "Pa")]


@dataclass(frozen=True, slots=True, kw_only=True)
class SpectralSettings:
    """The reference simulator: a tolerance, and a resolution that follows from it unless given."""

    tolerance: Annotated[float, Quantity("eps", "m/s", lower=1e-9, upper=0.1)] = 1e-4
    harmonics: Annotated[int | None, Quantity("N", "-", lower=1, upper=2000)] = None
    stations: Annotated[int | None, Quantity("n_s", "-", lower=2, upper=100_000)] = None
    step: Annotated[float | None, positive("dt", "s")] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkJointSettings:
    """The three-dimensional chain: a tolerance and what follows from it unless given, and the drag of its cables.

    `links` are those of the first part; the others have links of the same length.
    """

    links: Annotated[int | None, Quantity("n", "-", lower=4, upper=4096)] = None
    tolerance: Annotated[float, Quantity("eps", "m/s", lower=1e-9, upper=0.1)] = 1e-3
    step: Annotated[float | None, positive("dt", "s")] = None
    drag_law: DragLaw = "quadratic"
    strumming: bool = False
    strumming_damping: StrummingDamping = 0.005


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoringSettings:
    """The window that is scored, the same for every model."""

    settle: Annotated[float, non_negative("t_0", "s")] = 300.0


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationSettings:
    """The truth that fitted models are verified on, made by the link-joint chain with changed coefficients.

    `links` are those of the first part; `tolerance` steers the steps alone, and the report says what the error is.
    """

    kind: VerificationKind = "sharp-transients"
    coefficient_change: Annotated[float, Quantity("c", "-", lower=0.0, upper=1.0, open_upper=True)] = 0.05
    links: Annotated[int, Quantity("n", "-", lower=8, upper=4096)] = 60
    tolerance: Annotated[float, Quantity("eps", "m/s", lower=1e-9, upper=0.1)] = 5e-5
    current_speed: Annotated[float, Quantity("U_c", "m/s", lower=-3.0, upper=3.0)] = 0.05


@dataclass(frozen=True, slots=True, kw_only=True)
class IdentificationSettings:
    """The search: which models, at most `budget` simulations a fit, how many start points."""

    models: tuple[str, ...] = field(default_factory=_every_model)
    budget: Annotated[int, Quantity("n_e", "-", lower=1)] = 3000
    starts: Annotated[int, Quantity("n_0", "-", lower=1, upper=1000)] = 1
    delay: Literal["fit", "fixed"] = "fit"


@dataclass(frozen=True, slots=True, kw_only=True)
class StepSettings:
    """The step study: ship speed after the step, cable lengths and vehicle weights to compare (T 4.1)."""

    lengths: tuple[Annotated[float, positive("L", "m")], ...] = (500.0, 1000.0, 2500.0)
    weights: tuple[Annotated[float, positive("W", "N")], ...] = (6000.0, 11000.0, 16000.0)
    speed: Annotated[float, Quantity("v", "m/s", lower=-3.0, upper=3.0)] = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class BodeSettings:
    """The frequency response: ship amplitudes and frequencies (T figures 3-6 and 3-7)."""

    amplitudes: tuple[Annotated[float, positive("X", "m")], ...] = (25.0, 50.0)
    omegas: tuple[Annotated[float, positive("omega", "rad/s")], ...] = (
        0.002,
        0.004,
        0.007,
        0.012,
        0.02,
        0.035,
        0.06,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class CompensatorSettings:
    """The heave compensator at the ship: its apparent mass, its stroke, and how soft it can be made (H section IV)."""

    mass: Annotated[float, non_negative("m_comp", "kg")] = 0.0
    stroke: Annotated[float, positive("R_max", "m")] = 4.0
    least_stiffness: Annotated[float, positive("k_min", "N/m")] = 100.0
    least_damping: Annotated[float, positive("b_min", "N s/m")] = 100.0


@dataclass(frozen=True, slots=True, kw_only=True)
class CurrentProfile:
    """A current: speeds at increasing depths, straight lines between; toward +X unless directions are given."""

    depth: tuple[Annotated[float, non_negative("z", "m")], ...]
    speed: tuple[Annotated[float, Quantity("U", "m/s", lower=-5.0, upper=5.0)], ...]
    direction: tuple[Annotated[float, Quantity("theta", "rad", lower=-_TURN, upper=_TURN)], ...] = (0.0,)


@dataclass(frozen=True, slots=True, kw_only=True)
class Winch:
    """Open loop: the cable paid out (positive) at `rates` from each of `times` on, at most 5 % of its length."""

    duration: Annotated[float, positive("T", "s")] = 3600.0
    sample: Annotated[float, positive("dt", "s")] = 1.0
    times: tuple[Annotated[float, non_negative("t", "s")], ...] = (300.0, 400.0, 1500.0, 1600.0)
    rates: tuple[Annotated[float, Quantity("l'", "m/s", lower=-3.0, upper=3.0)], ...] = (0.2, 0.0, -0.2, 0.0)

    def __post_init__(self) -> None:
        check_same_length(self, "times", "rates")
        check_increasing(self, "times")


@dataclass(frozen=True, slots=True, kw_only=True)
class WinchDepth:
    """Closed loop: proportional and integral action on the vehicle's depth, with a limit on the rate.

    The depth asked for is the one at the start plus `depth_changes` from each of `times` on.
    """

    duration: Annotated[float, positive("T", "s")] = 3600.0
    sample: Annotated[float, positive("dt", "s")] = 1.0
    times: tuple[Annotated[float, non_negative("t", "s")], ...] = (300.0, 1800.0)
    depth_changes: tuple[Annotated[float, Quantity("dz", "m")], ...] = (10.0, -10.0)
    proportional_gain: Annotated[float, non_negative("K_p", "1/s")] = 0.05
    integral_gain: Annotated[float, non_negative("K_i", "1/s2")] = 0.0005
    rate_limit: Annotated[float, positive("l'_max", "m/s")] = 0.5
    acceleration_limit: Annotated[float, positive("l''_max", "m/s2")] = 0.05

    def __post_init__(self) -> None:
        check_same_length(self, "times", "depth_changes")
        check_increasing(self, "times")
