"""The steppers on published stiff problems, and at their order, where they are general enough to be run on them.

General enough are the three of the spectral simulator: the implicit default, Newmark and Runge-Kutta march u' = w,
pi(w)' = F(u, w, t) for any momentum and force. With pi = w - y(0) and F = f(t, w) their own source, interpreted, solves
y' = f(t, y). The others are written for one equation each: see test_manufactured.py.

Problems and solutions: Mazzia and Magherini, Test Set for Initial Value Problem Solvers, 2.4 (2008): van der Pol,
HIRES, ROBER and OREGO; ROBER at 40 s and 4e5 s from Hindmarsh et al., CVODE's example cvRoberts.
"""

import math
from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from models.spectral import explicit, implicit
from models.spectral.system import DONE
from models.spectral.workspace import T_BOTTOM

Floats = NDArray[np.float64]
Slope = Callable[[float, Floats], Floats]
IMPLICIT, NEWMARK = 0, 1
SOLVE_STAGE = vars(implicit)["solve_stage"].py_func


def jacobian(f: Slope) -> Callable[[float, Floats], Floats]:
    """By forward differences."""

    def of(t: float, y: Floats) -> Floats:
        d = 1e-6 * np.maximum(np.abs(y), 1e-3)
        return np.column_stack([(f(t, y + d[k] * (np.arange(y.size) == k)) - f(t, y)) / d[k] for k in range(y.size)])

    return of


class Interpreted:
    """The steppers' own source with another system below it, and the state and the counts it ends with."""

    def __init__(self, patch: pytest.MonkeyPatch, f: Slope, begin: Sequence[float] | Floats) -> None:
        self.patch, self.f, self.J = patch, f, jacobian(f)
        self.begin = self.y = np.array(begin, dtype=float)
        self.counts = np.zeros(4, dtype=np.int64)

    def __call__(
        self, stepper: int | None, times: Sequence[float], tolerance: float, h: float, fixed: bool = False
    ) -> Floats:
        """March from the first time to the last; `stepper` None is Runge-Kutta, `fixed` keeps the steps at h."""
        module = explicit if stepper is None else implicit
        replaced: dict[str, Any] = {
            "ship_at": self._ship_at,
            "evaluate": self._evaluate,
            "stage_matrix": self._stage_matrix,
            "steer": self._nothing,
            "pay_out": self._nothing,
        }
        if stepper is not None:
            replaced |= {"momentum": self._momentum, "end_motion": self._nothing, "solve_stage": SOLVE_STAGE}
        for name, value in replaced.items():
            self.patch.setattr(module, name, value)
        n, points = self.begin.size, np.array(times)
        fields = SimpleNamespace(
            sines=np.zeros((2, n - 2, 1)), station=np.zeros((12, 1)), body=np.zeros(3), scalar=np.zeros(23)
        )
        # A winch that does nothing cuts the steps at its period.
        control = np.array([1.0, h, *np.zeros(6)]) if fixed else np.zeros(8)
        out, shapes, self.counts = np.zeros((points.size, 7)), np.zeros((points.size, n)), np.zeros(4, dtype=np.int64)
        rest = (1_000_000, control, np.zeros(2), np.zeros(2), out, shapes, self.counts, np.zeros(2))
        kernel: Any = explicit.march_explicit if stepper is None else implicit.march
        which = () if stepper is None else (stepper,)
        assert kernel.py_func(fields, points, 0, points, *which, h, tolerance, *rest) == DONE
        return self.y

    def _ship_at(self, f: Any, t: float, knots: Any, ship: Any, place: int, end: Floats) -> int:
        end[0] = t
        return 0

    def _evaluate(
        self, f: Any, u: Floats, w: Floats, end: Floats, pi: Floats, F: Floats, cable: Floats, station: Floats
    ) -> None:
        # Taut, so that the march goes on.
        end[T_BOTTOM], station[:] = 1.0, 1.0
        F[:] = self.f(end[0], w)
        self._momentum(f, u, w, end, pi, F, cable)

    def _momentum(self, f: Any, u: Floats, w: Floats, end: Floats, pi: Floats, F: Floats, cable: Floats) -> None:
        pi[:], self.y = w - self.begin, w.copy()

    def _stage_matrix(
        self, f: Any, u: Floats, w: Floats, end: Floats, gh: float, cable: Any, station: Any, A: Floats, Y: Any
    ) -> None:
        A[:] = np.eye(w.size) - gh * self.J(end[0], w)

    def _nothing(self, *arguments: Any) -> None:
        pass


def van_der_pol(t: float, z: Floats) -> Floats:
    """y'' = ((1 - y^2) y' - y)/1e-6, z = (y, 1e-4 y')."""
    y, v = z[0], 1e4 * z[1]
    return np.array([v, 1e-4 * ((1.0 - y * y) * v - y) / 1e-6])


def hires(t: float, y: Floats) -> Floats:
    """Growth of plant tissue under light."""
    a, b, c, d, e, f, g, h = y
    return np.array(
        [
            -1.71 * a + 0.43 * b + 8.32 * c + 0.0007,
            1.71 * a - 8.75 * b,
            -10.03 * c + 0.43 * d + 0.035 * e,
            8.32 * b + 1.71 * c - 1.12 * d,
            -1.745 * e + 0.43 * f + 0.43 * g,
            -280.0 * f * h + 0.69 * d + 1.71 * e - 0.43 * f + 0.69 * g,
            280.0 * f * h - 1.81 * g,
            -280.0 * f * h + 1.81 * g,
        ]
    )


def rober(t: float, z: Floats) -> Floats:
    """Robertson's reaction, z = (y_2, y_1, y_3): the step control weighs the first two."""
    b, a, c = z
    return np.array([0.04 * a - 1e4 * b * c - 3e7 * b * b, -0.04 * a + 1e4 * b * c, 3e7 * b * b])


OREGO_SCALE = np.array([1e3, 1e3, 1e2])


def orego(t: float, z: Floats) -> Floats:
    """The Oregonator, z = y / (1000, 1000, 100)."""
    a, b, c = OREGO_SCALE * z
    slopes = np.array([77.27 * (b + a * (1.0 - 8.375e-6 * a - b)), (c - (1.0 + a) * b) / 77.27, 0.161 * (a - c)])
    return np.asarray(slopes / OREGO_SCALE)


HIRES_BEGIN, HIRES_END = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057), 321.8122
HIRES = np.array(
    [
        0.7371312573325668e-3,
        0.1442485726316185e-3,
        0.5888729740967575e-4,
        0.1175651343283149e-2,
        0.2386356198831331e-2,
        0.6238968252742796e-2,
        0.2849998395185769e-2,
        0.2850001604814231e-2,
    ]
)


def test_van_der_pol(monkeypatch: pytest.MonkeyPatch) -> None:
    run, exact = Interpreted(monkeypatch, van_der_pol, [2.0, 0.0]), np.array([1.706167732170483, -0.8928097010247975])
    errors, steps = [], []
    for tolerance in (1e-5, 1e-6):
        errors.append(np.abs(run(IMPLICIT, [0.0, 2.0], tolerance, 1e-6) * [1.0, 1e4] - exact).max())
        steps.append(run.counts[2])
    assert errors[0] < 1e-3
    assert errors[1] < 2e-4
    # Explicit, the slow parts alone would take 1.5 million steps: their rate is 3e6 1/s over 2 s, four steps of 1/rate.
    assert max(steps) < 6000


def test_hires(monkeypatch: pytest.MonkeyPatch) -> None:
    run = Interpreted(monkeypatch, hires, HIRES_BEGIN)
    errors = [np.abs(run(IMPLICIT, [0.0, HIRES_END], each, 1e-3) - HIRES).max() for each in (1e-4, 1e-5, 1e-6)]
    assert errors[2] < 1e-4
    assert errors[0] > 2.0 * errors[1] > 2.0 * errors[2]
    assert run.counts[2] < 400


def test_hires_by_newmark(monkeypatch: pytest.MonkeyPatch) -> None:
    """Newmark has no damping at infinity, but the slow end of HIRES is reached with steps of many time constants."""
    run = Interpreted(monkeypatch, hires, HIRES_BEGIN)
    assert np.abs(run(NEWMARK, [0.0, HIRES_END], 1e-9, 0.2) - HIRES).max() < 1e-5


def test_hires_by_runge_kutta(monkeypatch: pytest.MonkeyPatch) -> None:
    """Stable, but held to steps of the fastest time constant for as long as the problem lasts."""
    run = Interpreted(monkeypatch, hires, HIRES_BEGIN)
    assert np.abs(run(None, [0.0, HIRES_END], 2e-5, 1e-3) - HIRES).max() < 1e-4
    assert run.counts[2] > 2500


@pytest.mark.parametrize(
    ("end", "exact"),
    [(40.0, (9.185535e-6, 0.7158271, 0.2841637)), (4e5, (1.9846e-8, 4.9382e-3, 0.99506))],
)
def test_rober(monkeypatch: pytest.MonkeyPatch, end: float, exact: tuple[float, ...]) -> None:
    """A decade of time at once: a march takes no step below 1e-10 of its length."""
    y, t = np.array([0.0, 1.0, 0.0]), 0.0
    for until in (1e-2, 0.4, 4.0, 40.0, 400.0, 4e3, 4e4, 4e5):
        if until > end:
            break
        y = Interpreted(monkeypatch, rober, y)(IMPLICIT, [t, until], 1e-8, 1e-3 * (until - t))
        t = until
    np.testing.assert_allclose(y, exact, rtol=2e-4)
    assert y.sum() == pytest.approx(1.0, abs=1e-9)


def test_orego(monkeypatch: pytest.MonkeyPatch) -> None:
    exact = np.array([1.000814870318523, 1228.178521549917, 132.0554942846706])
    run = Interpreted(monkeypatch, orego, np.array([1.0, 2.0, 3.0]) / OREGO_SCALE)
    errors = [
        np.abs(run(IMPLICIT, [0.0, 360.0], each, 1e-4) * OREGO_SCALE / exact - 1.0).max() for each in (1e-5, 1e-6)
    ]
    assert errors[1] < 0.02
    assert errors[0] > 2.0 * errors[1]


@pytest.mark.parametrize(
    ("problem", "begin", "end", "exact"),
    [
        (van_der_pol, (2.0, 0.0), 2.0, (1.706167732170483, -0.8928097010247975e-4)),
        (hires, HIRES_BEGIN, HIRES_END, HIRES),
        (rober, (0.0, 1.0, 0.0), 40.0, (9.185535e-6, 0.7158271, 0.2841637)),
        (orego, (1e-3, 2e-3, 3e-2), 360.0, np.array([1.000814870318523, 1228.178521549917, 132.0554942846706])),
    ],
)
def test_the_problems_are_the_published_ones(problem: Slope, begin: Floats, end: float, exact: Floats) -> None:
    """By Radau, so that a mistyped coefficient is not taken for an error of a stepper."""
    run = solve_ivp(problem, (0.0, end), begin, "Radau", rtol=1e-9, atol=1e-14)
    scale = OREGO_SCALE if problem is orego else 1.0
    np.testing.assert_allclose(scale * run.y[:, -1], exact, rtol=2e-5)


def moving(t: float) -> Floats:
    return np.array([math.sin(t), math.cos(2.0 * t)])


def pulled(rate: float) -> Slope:
    """Prothero and Robinson's problem: y' = phi' - rate (y - phi), whose solution is phi at any rate."""

    def slope(t: float, y: Floats) -> Floats:
        return np.array([math.cos(t), -2.0 * math.sin(2.0 * t)]) - rate * (y - moving(t))

    return slope


@pytest.mark.parametrize("stepper", [IMPLICIT, NEWMARK])
@pytest.mark.parametrize("rate", [1.0, 1e6])
def test_the_implicit_steppers_keep_their_order_when_stiff(
    monkeypatch: pytest.MonkeyPatch, stepper: int, rate: float
) -> None:
    run = Interpreted(monkeypatch, pulled(rate), moving(0.0))
    sizes = (0.1, 0.05, 0.025, 0.0125)
    tolerance = 1e3 if stepper == IMPLICIT else 1e-12
    errors = []
    for h in sizes:
        errors.append(np.abs(run(stepper, [0.0, 3.0], tolerance, h, fixed=True) - moving(3.0)).max())
        assert run.counts[2] == round(3.0 / h)
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    # Far beyond its smallest time the default has the order of its stages.
    due = 3.0 if stepper == IMPLICIT and rate == 1.0 else 2.0
    assert np.all(np.abs(orders[-2:] - due) < 0.2), (orders, errors)


def test_runge_kutta_with_extrapolation_is_of_fifth_order(monkeypatch: pytest.MonkeyPatch) -> None:
    run = Interpreted(monkeypatch, pulled(1.0), moving(0.0))
    errors = [
        np.abs(run(None, np.linspace(0.0, 3.0, count + 1).tolist(), 1e3, 3.0) - moving(3.0)).max()
        for count in (16, 32, 64)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[-1] == pytest.approx(5.0, abs=0.2), (orders, errors)
