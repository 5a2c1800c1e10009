"""Cases of the matrix method: waves damped over many of their lengths, bodies without weight or mass, any pitch."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.configuration import load
from ident.stability.case import Case, Finding
from models.cable import Cable
from models.current import Current
from models.quantity import GRAVITY
from models.tow import Tow
from models.transfer_matrix import Direction, Response, Solver, UniformDamping, frequency_response
from models.vehicle import Towfish, Vehicle

_STILL = {"normal_drag_coefficient": 0.0, "tangential_drag_coefficient": 0.0, "axial_damping": 0.0}


def sled(cable: dict[str, float] | None = None, vehicle: dict[str, float] | None = None) -> Tow:
    """MANGUS on 740 m with other fields of cable and vehicle."""
    tow = load("mangus-740").tow
    assert isinstance(tow.vehicle, Vehicle)
    return replace(
        tow,
        cable=replace(tow.cable, **(cable or {})),  # type: ignore[arg-type]
        vehicle=replace(tow.vehicle, **(vehicle or {})),
    )


def without_drag(cable: dict[str, float] | None = None, vehicle: dict[str, float] | None = None) -> Tow:
    """The sled with no drag and no internal loss."""
    return sled(_STILL | (cable or {}), {"drag_coefficient": 0.0} | (vehicle or {}))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Bar:
    """Motion of the top along a hanging cable without drag, and across it, at one frequency [rad/s]."""

    tow: Tow
    omega: float

    def find(self) -> Finding:
        """Amplitudes over that of the top: of the body along and across, of the tension at the top [N/m]."""
        along, across = (self._run(direction) for direction in ("axial", "surge"))
        return Finding(
            figures={
                "along": float(abs(along.vertical[0])),
                "tension_top": float(abs(along.tension_top[0])),
                "across": float(abs(across.horizontal[0])),
                "error": max(*along.shares.values(), *across.shares.values()),
            },
            text=f"{along.shape.s.size - 1} and {across.shape.s.size - 1} segments",
        )

    def _run(self, direction: Direction) -> Response:
        return frequency_response(self.tow, [self.omega], direction=direction)


_STEEL = load("mangus-740").tow.cable.axial_stiffness

#: Hanging cables whose motion along and across is that of a bar and of a string.
BARS: dict[str, Callable[[], Bar]] = {
    "matrix-drag-zero": lambda: Bar(tow=without_drag(), omega=1.0),
    "matrix-length-5": lambda: Bar(tow=without_drag({"length": 5.0}), omega=1.0),
    "matrix-length-11000": lambda: Bar(tow=without_drag({"length": 11_000.0}), omega=0.3),
    "matrix-stiffness-times-1000": lambda: Bar(tow=without_drag({"axial_stiffness": 1e3 * _STEEL}), omega=1.0),
    "matrix-rubber": lambda: Bar(tow=without_drag({"axial_stiffness": 1e-3 * _STEEL}), omega=0.2),
    "matrix-vehicle-massless": lambda: Bar(tow=without_drag(None, {"mass": 0.0, "added_mass": 0.0}), omega=1.0),
    "matrix-vehicle-mass-hundredfold": lambda: Bar(
        tow=without_drag(None, {"mass": 76_000.0, "added_mass": 54_500.0}), omega=0.2
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Damped:
    """Lateral motion of a neutral cable under given damping [N s/m2]: q'' = g^2 q, g complex."""

    length: float
    normal: float
    omega: float
    solver: Solver = "stable"
    segments: int | None = None
    tow: Tow = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "tow", without_drag({"length": self.length, "weight_in_water": 0.0}))

    def find(self) -> Finding:
        """The decay of the motion from the top to the body, and the angle of the top over its motion [rad/m]."""
        answer = frequency_response(
            self.tow,
            [self.omega],
            direction="surge",
            damping=UniformDamping(normal=self.normal),
            solver=self.solver,
            segments=self.segments,
        )
        size = float(abs(answer.normal[0, 0]))
        return Finding(
            figures={
                "decades": math.log10(size) if size > 0.0 else -math.inf,
                "angle_top": float(abs(answer.angle[0, -1])),
                "error": max(answer.shares.values()),
            },
            text=f"{answer.shape.s.size - 1} segments",
        )


#: Waves that decay by 58 and by 3000 of their lengths; exp(3000) is no number.
DAMPED: dict[str, Callable[[], Damped]] = {
    "matrix-damped-waves": lambda: Damped(length=2000.0, normal=20.0, omega=0.5, segments=1024),
    "matrix-damped-waves-product": lambda: Damped(
        length=2000.0, normal=20.0, omega=0.5, solver="product", segments=1024
    ),
    "matrix-overflow": lambda: Damped(length=11_000.0, normal=1000.0, omega=1.0),
    "matrix-overflow-product": lambda: Damped(
        length=11_000.0, normal=1000.0, omega=1.0, solver="product", segments=4096
    ),
}

PRODUCT_SEGMENTS = 600


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Inclined:
    """The sled on 2500 m in a current of 0.5 m/s, given damping [N s/m2]: the shape couples both kinds of waves."""

    normal: float = 60.0
    omega: float = 0.3

    @property
    def tow(self) -> Tow:
        """The tow."""
        return replace(sled({"length": 2500.0, "axial_damping": 0.0}), current=Current.uniform(0.5))

    def find(self, solver: Solver = "stable", segments: int | None = None) -> Finding:
        """Tension and angle of the top and motion of the body, over the motion of the top."""
        answer = frequency_response(
            self.tow,
            [self.omega],
            direction="surge",
            damping=UniformDamping(normal=self.normal),
            solver=solver,
            segments=segments,
        )
        return Finding(
            figures={
                "tension_top": float(abs(answer.tension_top[0])),
                "angle_top": float(abs(answer.angle[0, -1])),
                "across": float(abs(answer.horizontal[0])),
                "error": max(answer.shares.values()),
            },
            text=f"{answer.shape.s.size - 1} segments",
        )


INCLINED = Inclined()


def light_body(net: float) -> Tow:
    """The sled with a weight in water [N] in a current of 0.5 m/s."""
    return replace(sled(None, {"weight_in_water": net}), current=Current.uniform(0.5))


def slow_motion(tow: Tow, **settings: Any) -> Finding:
    """The shape, and the force of a slow motion of the top over its speed: the derivative of the steady tow."""
    omega, size = 1e-7, 1e-3
    answer = frequency_response(tow, [omega], amplitude=size, direction="surge", tolerance=1e-22, **settings)
    return Finding(
        figures={
            "depth": answer.shape.depth,
            "tension_top": float(answer.shape.T[-1]),
            "tension_per_speed": float((answer.tension_top[0] / (1j * omega * size)).real),
            "error": answer.shares["tension_top"] if answer.error else math.nan,
        }
    )


def pendulum(drag_coefficient: float) -> Tow:
    """A heavy body on ten metres of a cable without weight, mass and drag."""
    cable = Cable(
        length=10.0,
        diameter=1e-4,
        mass=1e-6,
        weight_in_water=1e-6,
        added_mass=0.0,
        axial_stiffness=1e12,
        normal_drag_coefficient=0.0,
        tangential_drag_coefficient=0.0,
    )
    body = Vehicle(weight_in_water=500.0, mass=60.0, added_mass=30.0, area=0.5, drag_coefficient=drag_coefficient)
    return Tow(cable=cable, vehicle=body)


def drag_tenfold() -> Finding:
    """A pendulum at its own frequency with a drag coefficient of 10: the cubic of harmonic balance."""
    omega = math.sqrt(500.0 / (90.0 * 10.0))
    answer = frequency_response(pendulum(10.0), [omega], amplitude=0.1, direction="surge", segments=4)
    return Finding(figures={"swing": float(abs(answer.horizontal[0]))})


def upended_tow() -> Tow:
    """A towfish on a light rope that is towed by its nose."""
    tow = load("mangus-740").tow
    rope = {"length": 60.0, "mass": 1e-4, "weight_in_water": 0.0, "added_mass": 0.0}
    fish = Towfish(
        weight=400.0 * GRAVITY,
        buoyancy=780.0,
        mass=400.0,
        added_mass_p=600.0,
        added_mass_q=200.0,
        inertia=280.0,
        drag_coefficient=0.0,
        area_p=1.0,
        area_q=0.25,
        length=2.0,
        buoyancy_centre_p=0.02,
        tow_point_p=0.8,
    )
    return replace(tow, cable=replace(tow.cable, **(_STILL | rope)), vehicle=fish)  # type: ignore[arg-type]


def upended() -> Finding:
    """A towfish towed by its nose hangs with its length upright: its pitch is 90 degrees."""
    answer = frequency_response(upended_tow(), [0.8], amplitude=0.01, direction="surge")
    return Finding(
        figures={
            "pitch": answer.shape.pitch,
            "across": float(abs(answer.horizontal[0])),
            "swing": float(abs(answer.pitch[0])),
            "error": max(answer.shares.values()),
        }
    )


def s_shape() -> Finding:
    """The S of a floated tether: depth and tensions."""
    answer = frequency_response(load("s-shape-205").tow, [0.5], amplitude=0.1)
    shape = answer.shape
    return Finding(
        figures={
            "depth": shape.depth,
            "tension_bottom": float(shape.T[0]),
            "tension_top": float(shape.T[-1]),
            "error": max(answer.shares.values()),
        }
    )


def s_shape_modes() -> Finding:
    """The frequencies at which the vehicle under an S moves most, without a current."""
    omega = np.linspace(0.15, 0.85, 141)
    tow = replace(load("s-shape-205-thrust").tow, current=None)
    answer = frequency_response(tow, omega, amplitude=0.01)
    surge, heave = (_peaks(omega, np.abs(motion)) for motion in (answer.surge, answer.heave))
    return Finding(
        figures={
            name: min(found, key=lambda each: abs(each - printed), default=math.nan)
            for name, found, printed in (("surge", surge, 0.280), ("heave", heave, 0.435), ("pitch", surge, 0.550))
        }
    )


def _peaks(omega: NDArray[np.float64], size: NDArray[np.float64]) -> list[float]:
    return list(omega[1:-1][(size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])])


def no_frequency() -> Finding:
    """A motion of no frequency."""
    answer = frequency_response(sled(), [0.0])
    return Finding(figures={"heave": float(abs(answer.heave[0]))})


def _hangs_on_nothing(net: float) -> Finding:
    """A body of no weight, or one that floats, in still water."""
    answer = frequency_response(sled(None, {"weight_in_water": net}), [0.5])
    return Finding(figures={"heave": float(abs(answer.heave[0]))})


def _case(name: str, scene: Callable[[], Bar | Damped], reduced: bool) -> Case:
    return Case(name=name, run=lambda: scene().find(), reduced=reduced)


CASES = (
    *(_case(name, scene, True) for scenes in (BARS, DAMPED) for name, scene in scenes.items()),
    Case(name="matrix-inclined", run=INCLINED.find, reduced=True),
    Case(name="matrix-inclined-product", run=lambda: INCLINED.find("product", PRODUCT_SEGMENTS), reduced=True),
    Case(name="matrix-weight-zero", run=lambda: slow_motion(light_body(0.0)), reduced=True),
    Case(name="matrix-slightly-buoyant", run=lambda: slow_motion(light_body(-200.0)), reduced=True),
    Case(name="matrix-weight-zero-still", run=partial(_hangs_on_nothing, 0.0), reduced=True),
    Case(name="matrix-slightly-buoyant-still", run=partial(_hangs_on_nothing, -200.0), reduced=True),
    Case(name="matrix-drag-tenfold", run=drag_tenfold, reduced=True),
    Case(name="matrix-pitch-90", run=upended, reduced=True),
    Case(name="matrix-s-shape", run=s_shape, reduced=True),
    Case(name="matrix-s-shape-modes", run=s_shape_modes),
    Case(name="matrix-frequency-zero", run=no_frequency, reduced=True),
)
