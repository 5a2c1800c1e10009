"""What a configuration asks for that makes no measurable difference to its run, each with the figure.

The run's reference simulator follows the beginning of the identification record with the term and without it, at the
same resolution. A term counts as needless where the vehicle's velocity changes by less than the tolerance that the
simulator is run with, its position by less than a fix can tell, and the tension at the top by a thousandth.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ident.configuration import Configuration
from ident.leaving_out.scenes import as_point, changed
from models import spectral
from models.current import Current
from models.quantity import InvalidInput, NumericalFailure
from models.statics import static_shape
from models.strumming import amplification
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Towfish
from reports.markdown import significant

#: How much of the record is followed [s].
_FOLLOWED = 1800.0
#: What tells two positions apart where the configured sensor has no noise [m], and two tensions [share].
_POSITION, _TENSION = 0.1, 1e-3
#: Share of the tolerance that the comparison is made with, and the changes of velocity [m/s] below which it is blind.
_CLOSELY, _BLIND = 0.01, 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Needless:
    """A key or section of the configuration, what to do about it, and the RMS changes that it makes.

    `velocity` [m/s] and `position` [m] of the vehicle, `tension` at the top as a share of its mean.
    """

    key: str
    advice: str
    velocity: float
    position: float
    tension: float
    duration: float

    @property
    def words(self) -> str:
        """The figure and the advice in a sentence."""
        return (
            f"in {self.duration:g} s of the identification record it changes the vehicle's velocity by "
            f"{_at_least(self.velocity)} m/s RMS, its position by {significant(self.position, 2)} m and the "
            f"tension at the top by {significant(100.0 * self.tension, 2)} %; {self.advice}"
        )


def _at_least(velocity: float) -> str:
    return significant(velocity, 2) if velocity > _BLIND else f"less than {_BLIND:g}"


def needless(configuration: Configuration, ship: Trace, harmonics: int) -> list[Needless]:
    """The terms of a configuration that its run could do without.

    Parameters
    ----------
    ship
        The identification record's.
    harmonics
        Of the run's reference simulator.
    """
    count = int(np.searchsorted(ship.t, ship.t[0] + _FOLLOWED, side="right"))
    ship = Trace(t=ship.t[:count], position=ship.position[:count])
    tolerance = configuration.spectral.tolerance

    def follow(tow: Tow) -> Trace:
        # So closely that the steps' errors do not pass for what a term changes.
        return spectral.simulate(
            tow, ship, tolerance=_CLOSELY * tolerance, harmonics=harmonics, companion=False
        ).vehicle

    found: list[Needless] = []
    fix = max(configuration.sensor.fix_sigma, _POSITION)
    for key, advice, own, without in _terms(configuration):
        if key.partition(".")[0] in {each.key for each in found}:
            continue
        whole = follow(own)
        try:
            change = _change(whole, follow(without))
        except (InvalidInput, NumericalFailure):
            # What cannot be run without a term needs it.
            continue
        if change[0] <= tolerance and change[1] <= fix and change[2] <= _TENSION:
            duration = float(ship.t[-1] - ship.t[0])
            velocity, position, tension = change
            found.append(
                Needless(
                    key=key, advice=advice, velocity=velocity, position=position, tension=tension, duration=duration
                )
            )
    return found


def _terms(configuration: Configuration) -> Iterator[tuple[str, str, Tow, Tow]]:
    """Key, advice, and the tow with the term and without it."""
    tow, given = configuration.tow, configuration.given
    cable, current, vehicle = tow.cable, tow.current, tow.vehicle
    if current is not None:
        yield "current", "leave the section out", tow, replace(tow, current=None)
        mean = _mean(tow, current)
        if current.speed.size > 1:
            flat = replace(tow, current=Current.uniform(mean))
            yield "current.depth_m", f"one speed of {significant(mean)} m/s at all depths will do", tow, flat
    for key, field, value, advice in (
        ("tangential_drag_coefficient", "tangential_drag_coefficient", 0.0, "set it to 0"),
        ("axial_damping_s", "axial_damping", 0.0, "leave it out"),
        ("poisson_ratio", "poisson_ratio", 0.5, "leave it out"),
    ):
        if f"cable.{key}" in given and getattr(cable, field) != value:
            yield f"cable.{key}", advice, tow, changed(tow, **{field: value})
    if isinstance(vehicle, Towfish):
        yield "towfish", "a point [vehicle] will do", tow, replace(tow, vehicle=as_point(vehicle))
    if configuration.link_joint.strumming:
        times = amplification(cable, tow.water_density, configuration.link_joint.strumming_damping)
        strums = changed(tow, normal_drag_coefficient=times * cable.normal_drag_coefficient)
        yield "link-joint.strumming", "leave it out", strums, tow


def _mean(tow: Tow, current: Current) -> float:
    """Mean speed of the current over the depth of the cable [m/s]."""
    depth = np.linspace(0.0, static_shape(tow).depth, 201)
    return float(np.trapezoid(current.at(depth), depth) / depth[-1])


def _change(one: Trace, other: Trace) -> tuple[float, float, float]:
    """RMS change of velocity [m/s], of position [m], and of the tension at the top over its mean."""
    assert one.velocity is not None
    assert other.velocity is not None
    assert one.tension is not None
    assert other.tension is not None
    velocity, position = (
        float(np.sqrt(np.mean(np.sum((a - b) ** 2, axis=1))))
        for a, b in ((one.velocity, other.velocity), (one.position, other.position))
    )
    top = one.tension[:, 0]
    return velocity, position, float(np.sqrt(np.mean((top - other.tension[:, 0]) ** 2)) / top.mean())
