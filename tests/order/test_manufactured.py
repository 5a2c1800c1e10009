"""Steppers that are written for one equation, on manufactured solutions of it.

The vehicle's motion is given, and the ship's follows from the balance of forces: for the chain of the quadratic
reduced models node by node upward, for the link-joint chain through a line that hangs straight.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicSpline

from models import link_joint
from models.chain import Chain, quadratic_motion
from models.drive import Drive
from models.tow import Tow
from models.towed_system import TowedSystem
from models.trace import Trace
from models.vehicle import Vehicle


@pytest.mark.parametrize("massive", [False, True], ids=["massless", "inertial"])
@pytest.mark.parametrize("links", [1, 2, 3])
def test_the_stepper_of_the_reduced_models_on_a_manufactured_solution(links: int, massive: bool) -> None:
    """The vehicle's motion is given; node by node upward, the balance of forces gives the ship's, all polynomials."""
    span, speed, gain = 300.0, 0.4, 0.3
    s = Polynomial([0.0, 1.0 / span])
    v = speed + gain * s**8 * (9.0 - 8.0 * s)
    chain = Chain(
        k=np.array([400.0, 350.0, 300.0])[:links],
        r=np.array([3000.0, 4000.0, 9000.0])[:links],
        m=np.array([2500.0, 3000.0, 2500.0])[:links] * massive,
    )
    x, force = v.integ(), Polynomial([0.0])
    for k, r, m in zip(chain.k[::-1], chain.r[::-1], chain.m[::-1], strict=True):
        rate = x.deriv()
        assert min(rate(np.linspace(0.0, span, 200))) > 0.0
        force = force + m * rate.deriv() + r * rate**2
        x = x + force / k

    def error(step: float) -> float:
        t = np.linspace(0.0, span, round(span / step) + 1)
        drive = Drive.from_trace(Trace.along_x(t, x(t) - x(0.0)), start="steady", max_step=step)
        drive = replace(drive, start_speed=speed)
        motion = quadratic_motion(chain, drive, path="implicit")
        return float(np.sqrt(np.mean((motion.v - v(t)) ** 2)))

    errors = [error(step) for step in (8.0, 4.0, 2.0, 1.0)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] > 1e-9, "the errors must stand above the Newton tolerance to show an order"
    assert np.all(np.abs(orders[1:] - 2.0) < 0.2), (orders, errors)


def test_the_stepper_of_the_link_joint_chain_on_a_manufactured_swing(configurations: Callable[[str], Tow]) -> None:
    """A rigid chain of no weight hangs straight: l th'' = -g sin th - u'' cos th, the ship's u for any angle th."""
    span, length, weight = 120.0, 200.0, 500.0
    tow = configurations("mangus-740")
    assert isinstance(tow.vehicle, Vehicle)
    vehicle = replace(tow.vehicle, drag_coefficient=0.0, weight_in_water=weight)
    cable = replace(
        tow.cable,
        length=length,
        axial_stiffness=1e15,
        mass=1e-6,
        weight_in_water=1e-9,
        added_mass=0.0,
        normal_drag_coefficient=0.0,
        tangential_drag_coefficient=0.0,
    )
    system = TowedSystem.from_tow(replace(tow, cable=cable, vehicle=vehicle))
    s = Polynomial([0.0, 1.0 / span])
    angle = 0.6 * 256.0 * s**4 * (1.0 - s) ** 4
    fine, gravity = np.linspace(0.0, span, 12001), weight / (vehicle.mass + vehicle.added_mass)
    th, rate = angle(fine), angle.deriv()
    ship_rate = CubicSpline(fine, -(length * angle.deriv(2)(fine) + gravity * np.sin(th)) / np.cos(th)).antiderivative()
    t = np.linspace(0.0, span, 961)
    along = ship_rate.antiderivative()(t)
    ship = Trace(t=t, position=np.stack([along, 0.0 * t, 0.0 * t], axis=1))
    swing = length * rate(t)
    exact = np.stack([ship_rate(t) + swing * np.cos(angle(t)), 0.0 * t, swing * np.sin(angle(t))], axis=1)
    errors = []
    for step in (0.5, 0.25, 0.125):
        run = link_joint.simulate(system, ship, links=4, step=step, start="rest", companion=False)
        errors.append(float(np.sqrt(np.mean((run.vehicle.rates() - exact) ** 2))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(np.abs(orders - 2.0) < 0.2), (orders, errors)
    assert np.ptp(exact[:, 2]) > 2.0
