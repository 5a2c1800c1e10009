"""The response of a tow to a random sea, its drag linearised for the whole spectrum (H section III).

The motion is a normal process; with the response y(omega) to a metre of wave at each frequency,

    sigma_y^2 = int |y|^2 S d omega,   b_v = 2 E|v + U|

where sigma of the velocity v of each node follows from the same sum. Wave, deck and every response are one-sided
spectra in angular frequency (the factor 1/2 pi of H is not needed then).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from models.quantity import InvalidInput
from models.statics import steady_way
from models.tow import Tow
from models.transfer_matrix import columns as c
from models.transfer_matrix.drag import body_gaussian, gaussian
from models.transfer_matrix.line import Line
from models.transfer_matrix.march import solve_with
from models.transfer_matrix.response import Response
from models.transfer_matrix.setup import (
    Compensator,
    Complexes,
    Direction,
    DragForm,
    Floats,
    checked_frequencies,
    checked_nodes,
    compensator_of,
    direction_of,
    failed_at,
    line_of,
    nodes_of,
    on_nodes,
    resolve,
    scales_of,
    shares_of,
)

_MOST_ITERATIONS = 200
_THETA, _LEAST, _MOST = 0.8, 0.1, 1.0
#: Quantities with a standard deviation.
SEA_QUANTITIES = (
    "top",
    "relative",
    "surge",
    "heave",
    "pitch",
    "horizontal",
    "vertical",
    "tension_bottom",
    "tension_top",
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SeaResponse:
    """Standard deviations in a random sea, and the response to a metre of wave with the drag of that sea.

    Attributes
    ----------
    omega, density
        (k,) [rad/s] and the wave's spectrum [m2 s/rad].
    deck
        (k,) motion along the cable's top, of the cable or of the deck above a compensator, a metre of wave.
    response
        Amplitudes a metre of wave.
    sigma, rate
        Standard deviation of each quantity [m, rad, N] and of its time derivative: ``top`` is the cable's top along
        the cable, ``relative`` the same less the deck's motion, ``horizontal`` and ``vertical`` the body's centre of
        mass in earth axes, ``surge`` and ``heave`` in its own.
    sigma_tension
        (n+1,) of the dynamic tension along the cable [N].
    iterations, change, converged
        Of the drag, H's norm with standard deviations in the place of amplitudes.
    error
        Estimated error of the mesh in each `sigma`, from a run on every second node; empty without it.
    """

    omega: Floats
    density: Floats
    deck: Complexes
    response: Response
    sigma: Mapping[str, float]
    rate: Mapping[str, float]
    sigma_tension: Floats
    iterations: int
    change: float
    converged: bool
    error: Mapping[str, float]

    def amplitudes(self, name: str) -> Complexes:
        """(k,) amplitude of a quantity of `sigma` a metre of wave."""
        if name == "relative":
            return self.response.top - self.deck
        amplitudes: Complexes = getattr(self.response, name)
        return amplitudes

    @property
    def shares(self) -> Mapping[str, float]:
        """The estimated errors over the standard deviations; of both motions in the plane over the larger."""
        weights = self.density * _trapezoid(self.omega)
        imposed = math.sqrt(float(weights @ self.response.amplitude**2))
        return shares_of(self.error, self.sigma, imposed, self.response.shape)


def sea_response(
    tow: Tow,
    omega: ArrayLike,
    density: ArrayLike,
    *,
    motion: ArrayLike | None = None,
    direction: Direction = "axial",
    segments: int | None = None,
    nodes: ArrayLike | None = None,
    drag: DragForm = "consistent",
    tolerance: float = 1e-10,
    compensator: Compensator | None = None,
    companion: bool = True,
) -> SeaResponse:
    """The response in a random sea.

    Parameters
    ----------
    omega, density
        (k,) [rad/s], increasing, above 0, at least 3, and the one-sided spectrum of the waves [m2 s/rad]; sums over
        frequency are trapezoidal.
    motion
        (k, 2) horizontal and vertical motion of the cable's top a metre of wave, complex: the vessel's response.
        Left out, the top moves by the wave itself in `direction`.
    direction
        With a `compensator` and a `motion`, ``axial`` takes the vertical motion as one along the cable.
    segments, nodes, drag, tolerance, companion
        As of `frequency_response`.

    Raises
    ------
    InvalidInput
        A spectrum with negative values or without energy, or as of `frequency_response`.
    NumericalFailure
        As of `frequency_response`.
    """
    frequencies = checked_frequencies(omega)
    spectrum = _checked_density(frequencies, density)
    weights = spectrum * _trapezoid(frequencies)
    amplitude = math.sqrt(2.0 * float(weights.sum()))

    way = steady_way(tow)

    def run(mesh: Floats) -> SeaResponse:
        line = line_of(tow, way, mesh, drag)
        tops = _tops(line, frequencies, motion, direction)
        return _run(line, frequencies, spectrum, weights, tops, direction, tolerance, compensator)

    if nodes is not None:
        return on_nodes(run, tow, checked_nodes(tow, nodes), companion, _with_error)
    if segments is not None and not companion:
        return run(nodes_of(tow, segments, frequencies, amplitude, way=way))
    return resolve(run, tow, segments, lambda count: nodes_of(tow, count, frequencies, amplitude, way=way), _with_error)


def _checked_density(omega: Floats, density: ArrayLike) -> Floats:
    values = np.asarray(density, dtype=float)
    if values.shape != omega.shape or omega.size < 3:
        raise InvalidInput(
            f"A spectrum needs a density for each of at least 3 frequencies, but got {omega.size} frequencies and "
            f"{values.size} densities."
        )
    wrong = ~(np.isfinite(values) & (values >= 0.0))
    if wrong.any():
        i = int(np.argmax(wrong))
        raise InvalidInput(
            f"A spectral density must be at least 0 m2 s/rad, but it is {values[i]:g} at {omega[i]:g} rad/s."
        )
    if not values.any():
        raise InvalidInput("The spectrum has no energy: every density is 0 m2 s/rad.")
    return values


def _trapezoid(omega: Floats) -> Floats:
    """(k,) weights of the trapezoidal rule."""
    step = np.diff(omega)
    weights = np.zeros(omega.size)
    weights[:-1] += 0.5 * step
    weights[1:] += 0.5 * step
    return weights


def _tops(line: Line, omega: Floats, motion: ArrayLike | None, direction: Direction) -> Complexes:
    """(k, 2) p_n and q_n a metre of wave."""
    if motion is None:
        return np.tile(direction_of(line, direction), (omega.size, 1)).astype(complex)
    values = np.asarray(motion, dtype=complex)
    if values.shape != (omega.size, 2) or not np.isfinite(values).all():
        raise InvalidInput(
            f"motion needs a finite horizontal and vertical amplitude for each of {omega.size} frequencies, but its "
            f"shape is {values.shape}."
        )
    if direction == "axial":
        return np.column_stack([values[:, 1], np.zeros(omega.size)])
    phi = float(line.shape.phi[-1])
    x, z = values[:, 0], values[:, 1]
    return np.column_stack([x * math.cos(phi) + z * math.sin(phi), z * math.cos(phi) - x * math.sin(phi)])


def _run(
    line: Line,
    omega: Floats,
    density: Floats,
    weights: Floats,
    tops: Complexes,
    direction: Direction,
    tolerance: float,
    compensator: Compensator | None,
) -> SeaResponse:
    k, n = omega.size, line.h.size
    sprung, scales = compensator_of(compensator, tops), scales_of(line, omega)
    y, v, digits = np.zeros((k, n + 1, 4), dtype=complex), np.zeros((k, 3), dtype=complex), np.empty(k)
    speed = math.sqrt(float(np.sum(weights * omega**2 * np.sum(np.abs(tops) ** 2, axis=1))))
    imposed = float(line.shape.s[-1] * np.sum(weights * np.sum(np.abs(tops) ** 2, axis=1)))
    if not imposed > 0.0:
        raise InvalidInput("The motion of the cable's top has no energy: the vessel does not answer to this spectrum.")
    flow = line.nodes[:, [c.NODE_FLOW_T, c.NODE_FLOW_A]]
    force = line.nodes[:, [c.NODE_FORCE_T, c.NODE_FORCE_A]]
    b = np.column_stack([_gaussian(np.full(n + 1, share * speed), flow[:, m]) for m, share in enumerate((1.0, 0.1))])
    D, b_turn = body_gaussian(line.body, np.diag([(0.1 * speed) ** 2, speed**2])), 0.0
    before, last = np.zeros((k, n + 1, 2), dtype=complex), np.zeros_like(b)
    last_body, strength = np.zeros(8), max(float(line.body[c.BODY_K_P]), float(line.body[c.BODY_K_Q]), 1e-30)
    theta, change, iterations = _THETA, math.inf, 0
    while iterations < _MOST_ITERATIONS:
        iterations += 1
        failed = solve_with(
            omega, line.ends, line.h, line.body, scales, tops, sprung, b, D, b_turn, False, y, v, digits
        )  # fmt: skip
        if failed >= 0:
            raise failed_at(line, float(omega[failed]))
        moved = np.sum(np.abs(y[:, :, 2:] - before) ** 2, axis=2) @ line.nodes[:, c.NODE_LENGTH]
        before[:] = y[:, :, 2:]
        if iterations > 1:
            change = float(weights @ moved) / imposed
            if change <= tolerance:
                break
        sigma = _velocities(line, omega, weights, y)
        residual = np.column_stack([_gaussian(sigma[:, m], flow[:, m]) for m in range(2)]) - b
        D_new, turn_new = _body_drag(line, omega, weights, y, v)
        residual_body = (D_new - D).ravel().view(float)
        if iterations > 1:
            step, step_body = residual - last, residual_body - last_body
            size = float(np.sum(force * step * step)) + float(step_body @ step_body) / strength
            along = float(np.sum(force * last * step)) + float(last_body @ step_body) / strength
            if size > 0.0:
                theta = min(max(-theta * along / size, _LEAST), _MOST)
        last, last_body = residual, residual_body
        b = b + theta * residual
        D, b_turn = D + theta * (D_new - D), b_turn + theta * (turn_new - b_turn)
    response = Response(
        omega=omega,
        amplitude=np.linalg.norm(tops, axis=1),
        direction=direction,
        shape=line.shape,
        motion=v,
        states=y,
        iterations=np.full(k, iterations, dtype=np.int64),
        change=np.full(k, change),
        converged=np.full(k, change <= tolerance),
        digits=np.full(k, math.nan),
        error={},
    )
    made = SeaResponse(
        omega=omega,
        density=density,
        deck=tops[:, 0],
        response=response,
        sigma={},
        rate={},
        sigma_tension=np.sqrt(weights @ np.abs(y[:, :, 0]) ** 2),
        iterations=iterations,
        change=change,
        converged=change <= tolerance,
        error={},
    )
    squares = {name: np.abs(made.amplitudes(name)) ** 2 for name in SEA_QUANTITIES}
    return replace(
        made,
        sigma={name: math.sqrt(float(weights @ square)) for name, square in squares.items()},
        rate={name: math.sqrt(float(weights @ (omega**2 * square))) for name, square in squares.items()},
    )


_gaussian = np.vectorize(gaussian, otypes=[float])


def _velocities(line: Line, omega: Floats, weights: Floats, y: Complexes) -> Floats:
    """(n+1, 2) standard deviations of the tangential and normal relative velocity of the nodes."""
    nodes = line.nodes
    height = y[:, :, 2] * nodes[:, c.NODE_SINE] + y[:, :, 3] * nodes[:, c.NODE_COSINE]
    found = np.empty((line.h.size + 1, 2))
    for m, (angle, shear) in enumerate(((c.NODE_ANGLE_T, c.NODE_SHEAR_T), (c.NODE_ANGLE_A, c.NODE_SHEAR_A))):
        velocity = 1j * omega[:, None] * y[:, :, 2 + m] + nodes[:, angle] * y[:, :, 1] + nodes[:, shear] * height
        found[:, m] = np.sqrt(weights @ np.abs(velocity) ** 2)
    return found


def _body_drag(line: Line, omega: Floats, weights: Floats, y: Complexes, v: Complexes) -> tuple[Complexes, float]:
    """Linearised drag of the body: D (2, 2) and of its pitching."""
    body = line.body
    height = body[c.BODY_SLOPE_SIN] * y[:, 0, 2] + body[c.BODY_SLOPE_COS] * y[:, 0, 3]
    relative = np.column_stack(
        [
            1j * omega * v[:, 0] + body[c.BODY_ANGLE_P] * v[:, 2] + body[c.BODY_SHEAR_P] * height,
            1j * omega * v[:, 1] + body[c.BODY_ANGLE_Q] * v[:, 2] + body[c.BODY_SHEAR_Q] * height,
        ]
    )
    covariance = np.real(np.conj(relative).T @ (weights[:, None] * relative))
    turning = math.sqrt(float(weights @ (omega**2 * np.abs(v[:, 2]) ** 2)))
    return body_gaussian(body, covariance), float(body[c.BODY_K_TURN]) * gaussian(turning, 0.0)


def _with_error(fine: SeaResponse, coarse: SeaResponse) -> SeaResponse:
    """The finer run with a third of the difference to the coarser: both err at second order."""
    return replace(fine, error={name: abs(fine.sigma[name] - coarse.sigma[name]) / 3.0 for name in SEA_QUANTITIES})
