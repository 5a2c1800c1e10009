"""Cases of the spectral simulator: lengths, stiffness, weights, drag, masses, steps, pitch, winch and aliasing.

Their independent figures are closed forms of small angles, the chain of Bessel, bars with an end mass, and shapes
integrated apart from the program; see the table.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from ident.stability.aliasing import aliasing_error, aliasing_map
from ident.stability.case import Case, Finding
from ident.stability.planar import (
    TEN_KNOTS,
    at_once,
    frequency,
    gentle,
    hanging,
    heavier_drag,
    lag,
    mangus,
    rms,
    transfer,
)
from models.cable import Cable
from models.spectral import Payout, SpectralResult, simulate
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Towfish, Vehicle


def _settled(tow: Tow, speed: float, *, duration: float = 6000.0, sample: float = 10.0) -> Finding:
    """From rest to a steady tow: the trail."""
    ship = gentle(np.arange(0.0, duration + sample, sample), 0.0, speed)
    result = simulate(tow, ship)
    return Finding(figures={"trail": lag(ship, result.vehicle)}, text=_error(result))


def _heave(tow: Tow, amplitude: float, *, omega: float = 0.8) -> Finding:
    """Regular heave: the vehicle's over the ship's."""
    t = np.arange(0.0, 300.0, 0.25)
    ship = Trace.along_x(t, np.zeros(t.size), amplitude * (1.0 - np.cos(omega * t)))
    result = simulate(tow, ship)
    return Finding(
        figures={"heave ratio": transfer(t, ship.position[:, 2], result.vehicle.position[:, 2], omega).real},
        text=_error(result),
    )


def _swing(tow: Tow, *, duration: float, sample: float, push: float) -> Finding:
    """Free swings of the undamped vehicle after the ship has moved 1 m in `push` seconds: frequency and growth."""
    t = np.arange(0.0, duration, sample)
    s = np.clip(t / push, 0.0, 1.0)
    # The usual 1e-4 m/s would be 3 % of the slowest swing.
    result = simulate(tow, Trace.along_x(t, s**3 * (10.0 - 15.0 * s + 6.0 * s**2)), tolerance=2e-5)
    v = result.vehicle.rates()[:, 0]
    free = t > push
    quarter = int(free.sum()) // 4
    figures = {
        "frequency": frequency(t[free], v[free], 2e-3, 0.3),
        "growth": rms(v[-quarter:]) / rms(v[free][:quarter]),
    }
    return Finding(figures=figures, text=_error(result))


def _bare(mass: float = 1.0) -> Tow:
    """Without drag and loss, the masses of the vehicle times `mass`."""
    tow = heavier_drag(0.0, axial_damping=0.0)
    vehicle = tow.vehicle
    assert isinstance(vehicle, Vehicle)
    return replace(tow, vehicle=replace(vehicle, mass=mass * vehicle.mass, added_mass=mass * vehicle.added_mass))


def _step() -> Finding:
    ship = at_once(np.arange(0.0, 601.0), 0.5)
    result = simulate(mangus(name="mangus-2500"), ship)
    return Finding(figures={"way after 600 s": float(result.vehicle.position[-1, 0])}, text=_error(result))


def _ten_knots_at_once() -> Finding:
    ship = at_once(np.arange(0.0, 601.0), TEN_KNOTS)
    result = simulate(mangus(), ship)
    return Finding(figures={"trail": lag(ship, result.vehicle)}, text=f"trail {lag(ship, result.vehicle):.0f} m")


def _ten_knots() -> Finding:
    """A little faster and a little slower than a steady tow at ten knots: half of what the shapes differ by.

    The half difference, because a small deflection leaves out the second order of the change.
    """
    t = np.arange(0.0, 6000.0, 10.0)
    tow = replace(mangus(), speed=TEN_KNOTS)
    slower, faster = (simulate(tow, gentle(t, TEN_KNOTS, change), tolerance=1e-6) for change in (-0.05, 0.05))
    figures = {
        "change of depth": 0.5 * (hanging(faster) - hanging(slower)),
        "change of trail": 0.5 * (lag(faster.ship, faster.vehicle) - lag(slower.ship, slower.vehicle)),
    }
    return Finding(figures=figures, text=_error(faster))


def _ten_knots_error() -> Finding:
    """Whether the vehicle's velocity is as exact as the default tolerance says."""
    tow = replace(mangus(), speed=TEN_KNOTS)
    ship = gentle(np.arange(0.0, 6000.0, 10.0), TEN_KNOTS, 0.05)
    result, fine = simulate(tow, ship), simulate(tow, ship, harmonics=120, tolerance=1e-6, companion=False)
    gap = np.linalg.norm(result.vehicle.rates() - fine.vehicle.rates(), axis=1)
    return Finding(figures={"velocity error": rms(gap)}, text=_error(result))


def _slack() -> Finding:
    t = np.arange(0.0, 60.0, 0.1)
    result = simulate(mangus(), Trace.along_x(t, np.zeros(t.size), 3.0 * np.sin(1.5 * t)))
    assert result.vehicle.tension is not None
    return Finding(figures={}, text=f"least tension {result.vehicle.tension.min():.0f} N")


def _circle() -> Finding:
    t = np.arange(0.0, 300.0)
    position = np.column_stack([50.0 * np.sin(t / 50.0), 50.0 * (1.0 - np.cos(t / 50.0)), np.zeros(t.size)])
    result = simulate(mangus(), Trace(t=t, position=position))
    return Finding(figures={}, text=_error(result))


def _nose_hung(tow_point_p: float = 0.8, tow_point_q: float = 0.0) -> Tow:
    """The towfish of H Table II without drag on 60 m of light rope, hung by a point ahead of its centre of mass."""
    rope = Cable(
        length=60.0,
        diameter=0.0173,
        mass=1e-4,
        weight_in_water=0.0,
        added_mass=0.0,
        axial_stiffness=42e9 * 0.25 * math.pi * 0.0173**2,
        normal_drag_coefficient=0.0,
        tangential_drag_coefficient=0.0,
    )
    fish = Towfish(
        weight=3920.0,
        buoyancy=780.0,
        mass=400.0,
        added_mass_p=500.0,
        added_mass_q=500.0,
        inertia=280.0,
        drag_coefficient=0.0,
        area_p=0.25,
        area_q=1.0,
        length=2.0,
        tow_point_p=tow_point_p,
        tow_point_q=tow_point_q,
    )
    return Tow(cable=rope, vehicle=fish)


def _pitch() -> Finding:
    """Swings about the nose-up rest after a quick push of the ship."""
    t = np.arange(0.0, 240.0, 0.1)
    s = np.clip(t / 2.0, 0.0, 1.0)
    ship = Trace.along_x(t, 0.1 * s**3 * (10.0 - 15.0 * s + 6.0 * s**2))
    result = simulate(_nose_hung(), ship, harmonics=2, tolerance=1e-7)
    assert result.pitch is not None
    free = t > 3.0
    figures = {
        "pitch": float(result.pitch[free].mean()),
        "surge frequency": frequency(t[free], result.vehicle.position[free, 0], 0.1, 1.0),
        "pitch frequency": frequency(t[free], result.pitch[free], 1.0, 6.0),
    }
    return Finding(figures=figures, text=f"pitch from {result.pitch.min():.4f} to {result.pitch.max():.4f} rad")


def _upside_down() -> Finding:
    result = simulate(_nose_hung(0.0, -0.8), at_once(np.arange(0.0, 60.0), 0.0))
    return Finding(figures={}, text=_error(result))


def _payout(length: float) -> Finding:
    t = np.arange(0.0, 401.0)
    winch = Payout(t=np.array([0.0, 10.0, 200.0]), length=np.array([0.0, 0.0, length]))
    result = simulate(mangus(), at_once(t, 0.0), winch=winch)
    assert result.vehicle.tension is not None
    figures = {
        "lowered": hanging(result) + float(result.vehicle.position[0, 2]),
        "tension at the top": float(result.vehicle.tension[-1, 0]),
    }
    return Finding(figures=figures, text=_error(result))


def _map() -> Finding:
    found = aliasing_map()
    worst = float(found.error[found.accepted].max())
    lost, refused = int((~found.stable).sum()), int((~found.accepted).sum())
    text = f"{lost} of {found.error.size} pairs unstable, {refused} refused"
    return Finding(figures={"worst accepted error": worst}, text=text)


def _refused() -> Finding:
    result = simulate(mangus(), at_once(np.arange(0.0, 60.0), 0.1), harmonics=24, stations=12, companion=False)
    return Finding(figures={}, text=_error(result))


def _error(result: SpectralResult) -> str:
    given = "resolution given" if result.error is None else f"error {result.error:.1e} m/s"
    return f"{given}, {result.harmonics} harmonics, {result.steps} steps"


def _case(name: str, run: Callable[[], Finding], *, reduced: bool = False) -> Case:
    return Case(name=f"spectral-{name}", run=run, reduced=reduced)


def _of(build: Callable[[], Tow], measure: Callable[..., Finding], *values: float, **settings: float) -> Finding:
    """Build the tow when the case is run, not when the catalogue is read."""
    return measure(build(), *values, **settings)


_SHORT, _LONGEST = partial(mangus, length=5.0), partial(mangus, length=11_000.0)
_EA = 6.2e10 * 0.25 * math.pi * 0.0173**2
_RIGID, _RUBBER = partial(mangus, axial_stiffness=1e3 * _EA), partial(mangus, axial_stiffness=1e-3 * _EA)

CASES: tuple[Case, ...] = (
    _case("length-5", partial(_of, _SHORT, _settled, 0.25), reduced=True),
    _case("length-5-heave", partial(_of, _SHORT, _heave, 0.5), reduced=True),
    _case("length-2500-heave", partial(_of, partial(mangus, name="mangus-2500"), _heave, 0.02)),
    _case("length-11000", partial(_of, _LONGEST, _settled, 0.1, duration=60_000.0, sample=30.0)),
    _case("length-11000-heave", partial(_of, _LONGEST, _heave, 0.02)),
    _case("stiff", partial(_of, _RIGID, _settled, 0.1), reduced=True),
    _case("stiff-heave", partial(_of, _RIGID, _heave, 0.5)),
    _case("stiff-heave-lossless", lambda: _heave(mangus(axial_stiffness=1e3 * _EA, axial_damping=0.0), 0.5)),
    _case("rubber", partial(_of, _RUBBER, _settled, 0.25), reduced=True),
    _case("rubber-heave", partial(_of, _RUBBER, _heave, 0.02)),
    _case("vehicle-weight-0", lambda: _settled(mangus(vehicle={"weight_in_water": 0.0}), 0.1), reduced=True),
    _case("vehicle-floats", lambda: _settled(mangus(vehicle={"weight_in_water": -100.0}), 0.1), reduced=True),
    _case("cable-neutral", partial(_of, partial(mangus, weight_in_water=0.0), _settled, 0.1), reduced=True),
    _case("cable-buoyant", partial(_of, partial(mangus, weight_in_water=-2.0), _settled, 0.1)),
    _case("cable-floats", partial(_of, partial(mangus, weight_in_water=-10.0), _settled, 0.1), reduced=True),
    _case("drag-0", lambda: _swing(_bare(), duration=2000.0, sample=1.0, push=30.0)),
    _case("drag-tenfold", partial(_of, partial(heavier_drag, 10.0), _settled, 0.1), reduced=True),
    _case("mass-0", lambda: _settled(mangus(vehicle={"mass": 0.0, "added_mass": 0.0}), 0.1), reduced=True),
    _case("mass-hundredfold", lambda: _swing(_bare(100.0), duration=30_000.0, sample=5.0, push=300.0)),
    _case("step", _step, reduced=True),
    _case("step-ten-knots", _ten_knots_at_once, reduced=True),
    _case("ten-knots", _ten_knots),
    _case("ten-knots-error", _ten_knots_error),
    _case("slack", _slack, reduced=True),
    _case("circle", _circle, reduced=True),
    _case("pitch-90", _pitch, reduced=True),
    _case("pitch-upside-down", _upside_down, reduced=True),
    _case("payout-most", partial(_payout, 37.0), reduced=True),
    _case("haul-most", partial(_payout, -37.0)),
    _case("payout-twice", partial(_payout, 740.0), reduced=True),
    _case("haul-to-a-tenth", partial(_payout, -666.0), reduced=True),
    _case("aliasing-map", _map),
    _case("aliasing-refused", _refused, reduced=True),
    _case("aliasing-forced", lambda: Finding(figures={"error": aliasing_error(24, 12)}), reduced=True),
)
