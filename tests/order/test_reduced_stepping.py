"""The implicit stepper of the quadratic models is of order 2, the linear propagator exact."""

import numpy as np
import pytest

from ident.configuration import load
from models import reduced
from models.chain import quadratic_motion
from models.drive import Drive
from models.statics import static_shape
from models.trace import Trace

TOW = load("autec-1200").tow
SHAPE = static_shape(TOW)


def smooth_ship(step: float) -> Trace:
    """A ship that never reverses, so that the massless velocity is smooth."""
    t = np.arange(0.0, 601.0, step)
    return Trace.along_x(t, 0.4 * t + 3.0 * np.sin(0.04 * t))


@pytest.mark.parametrize(
    "name", ["massless-4-quadratic", "inertial-4-quadratic", "second-order-quadratic", "first-order-quadratic"]
)
def test_the_implicit_stepper_is_second_order(name: str) -> None:
    chain = reduced.section(name, TOW, SHAPE).chain()
    ship = smooth_ship(4.0)

    def run(step: float) -> np.ndarray:
        return quadratic_motion(chain, Drive.from_trace(ship, start="steady", max_step=step), path="implicit").v[20:]

    exact = run(1 / 64)
    errors = [float(np.sqrt(np.mean((run(step) - exact) ** 2))) for step in (4.0, 2.0, 1.0, 0.5)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] > 1e-10, "the errors must stand above the Newton tolerance to show an order"
    assert np.all(np.abs(orders[1:] - 2.0) < 0.2), orders


@pytest.mark.parametrize("name", ["massless-4-linear", "inertial-4-linear", "inertial-16-linear", "massless-1-linear"])
def test_linear_response_does_not_depend_on_the_step(name: str) -> None:
    model = reduced.section(name, TOW, SHAPE)
    coarse = smooth_ship(8.0)
    # The refined samples lie on the same spline, so the motion between them is the same.
    t = np.linspace(coarse.t[0], coarse.t[-1], 32 * (len(coarse) - 1) + 1)
    fine = Trace.along_x(t, coarse.at(t)[:, 0])
    few = reduced.respond(model, Drive.from_trace(coarse))
    many = reduced.respond(model, Drive.from_trace(fine))
    np.testing.assert_allclose(few.velocity, many.velocity[::32], atol=1e-10)
    np.testing.assert_allclose(few.position, many.position[::32], atol=1e-9)
