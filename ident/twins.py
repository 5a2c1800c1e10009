"""Twins: other parameters of a linear chain with the same response.

The velocity of the vehicle does not tell the nodes of a linear chain apart. Two massless links have the
exact twin ``r1' = r2 (k1 + k2)/k2``, ``r2' = r1 k2/(k1 + k2)``; longer chains, whose inner nodes share their
parameters, have near twins that only many digits separate. Both are found as minima of the distance between
logarithmic frequency responses, from many start points, and verified by simulation. Models with quadratic
drag respond differently at every amplitude, and the delayed linear ones are minimal: neither has twins.

| symbol | meaning | unit |
| --- | --- | --- |
| z | impedance of a node, m s^2 + r s | N/m |
| x, e | amplitude of a node, and force of the link above it | m, N |
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import leastsq

from ident.cases import Case, Floats
from ident.search_space import SearchSpace
from models import reduced
from models.chain import Chain
from models.inertial import Inertial
from models.massless import Massless, lumped
from models.quantity import NumericalFailure
from models.reduced import ReducedModel

Complex = NDArray[np.complexfloating[Any, Any]]

#: Largest difference of velocity [m/s] between indistinguishable models.
SAME = 1e-6

#: Smallest difference in a search coordinate between different parameter sets.
DIFFERENT = 5e-3

#: Coordinates beyond this are cut off, so that a wandering search stays within the range of numbers.
FARTHEST = 60.0

#: The same between rough ends of a search, which are then made exact.
ROUGHLY = 0.03

#: Evaluations of a rough search, and of an exact one.
ROUGH, FINE = 120, 300

#: Start points, and how far they lie about the fit (a factor of 30 either way).
STARTS, REACH = 16, 3.4

#: Frequencies at which responses are compared.
FREQUENCIES = 30


@dataclass(frozen=True, slots=True, kw_only=True)
class Twin:
    """Parameter values that the record cannot tell from the fitted ones.

    `values` in the order of the searched parameters `names`; `difference` is the largest difference of the
    compared velocity [m/s].
    """

    names: tuple[str, ...]
    values: tuple[float, ...]
    difference: float


def find_twins(
    space: SearchSpace, u: Floats, cases: Sequence[Case], *, candidates: Sequence[Floats] | None = None
) -> tuple[Twin, ...]:
    """The parameter sets within the search range that respond as the one at u (p,), none for quadratic models.

    A set is a twin only if the response changes on the way to it: a valley is a flat direction, not a twin.

    Parameters
    ----------
    candidates
        Where to look, in search coordinates; `alternatives` by default.
    """
    model = space.model_at(u)
    found = []
    for other in alternatives(space, u, cases) if candidates is None else candidates:
        difference = _difference(model, space.model_at(other), cases)
        if difference <= SAME < _difference(model, space.model_at(0.5 * (u + other)), cases):
            values = tuple(float(value) for value in space.values_at(other))
            found.append(Twin(names=space.names, values=values, difference=difference))
    return tuple(found)


def alternatives(space: SearchSpace, u: Floats, cases: Sequence[Case], *, seed: int = 0) -> list[Floats]:
    """Search coordinates (p,) away from u where the response has a closest approach to that at u.

    Closeness is taken twice: as the logarithm of the response over all rates of the model, which finds exact
    twins, and as the velocity in the band of the ship's motion, which finds what this record can confuse.
    Empty for models that have no twins.
    """
    model = space.model_at(u)
    if not isinstance(model, Massless | Inertial) or model.drag != "linear" or u.size < 2:
        return []
    chain = _chains(space)
    everywhere = 1j * _frequencies(model)
    omega, amplitude = _ship_band(cases)
    log_target = np.log(_ship_over_vehicle(model.chain(), everywhere))
    target = amplitude / _ship_over_vehicle(model.chain(), 1j * omega)

    def by_ratio(x: Floats) -> Floats:
        ratio = np.log(_ship_over_vehicle(chain(x), everywhere)) - log_target
        # The principal branch: a whole turn of phase is no difference.
        return np.concatenate([ratio.real, ratio.imag - 2.0 * np.pi * np.round(ratio.imag / (2.0 * np.pi))])

    def by_velocity(x: Floats) -> Floats:
        difference = amplitude / _ship_over_vehicle(chain(x), 1j * omega) - target
        return np.concatenate([difference.real, difference.imag])

    rng = np.random.default_rng(seed)
    found: list[Floats] = []
    for mismatch in (by_ratio, by_velocity):
        rough: list[Floats] = []
        for _ in range(STARTS):
            start = u + rng.uniform(-REACH, REACH, u.size)
            end = leastsq(mismatch, start, xtol=1e-4, ftol=1e-6, maxfev=ROUGH, full_output=True)[0]
            if all(np.abs(end - other).max() > ROUGHLY for other in (u, *rough)):
                rough.append(end)
        for start in rough:
            end = leastsq(mismatch, start, xtol=1e-14, ftol=1e-15, maxfev=FINE, full_output=True)[0]
            inside = bool(np.all((end >= space.lower) & (end <= space.upper)))
            if inside and all(np.abs(end - other).max() > DIFFERENT for other in (u, *found)):
                found.append(end)
    return found


def _chains(space: SearchSpace) -> Callable[[Floats], Chain]:
    """The map from search coordinates (p,), which may lie outside their range, to the node values of a chain."""
    model = space.model
    assert isinstance(model, Massless | Inertial)
    names = [p.name for p in reduced.parameters(model)]
    n, link, stiffness = model.stiffness.size, model.link, model.stiffness

    def chain(u: Floats) -> Chain:
        free = np.exp(np.minimum(np.maximum(u, -FARTHEST), FARTHEST)) - space.shift
        value = dict(zip(names, space.all_values(free), strict=True))
        r = lumped(n, value.get("cable_drag", 0.0) * link, value["vehicle_drag"])
        m = lumped(n, value.get("cable_mass", 0.0) * link, value.get("vehicle_mass", 0.0))
        return Chain(stiffness, r, m)

    return chain


def _frequencies(model: ReducedModel) -> Floats:
    """(FREQUENCIES,) [rad/s] over all rates of a model."""
    rates = np.abs(np.linalg.eigvals(reduced.linearise(model).A))
    return np.geomspace(0.1 * rates.min(), 10.0 * rates.max(), FREQUENCIES)


def _ship_band(cases: Sequence[Case]) -> tuple[Floats, Floats]:
    """Frequencies (q,) [rad/s] that carry the ships' velocity, and its amplitudes there [m/s]."""
    omega, power = [], []
    for case in cases:
        t = np.linspace(case.drive.t[0], case.drive.t[-1], case.drive.t.size)
        u = np.interp(t, case.drive.t, case.drive.rates[:, 0])
        omega.append(2.0 * np.pi * np.fft.rfftfreq(t.size, t[1] - t[0])[1:])
        power.append(np.abs(np.fft.rfft(u)[1:]) ** 2 / t.size**2)
    frequency, energy = np.concatenate(omega), np.concatenate(power)
    order = np.argsort(frequency)
    carried = np.cumsum(energy[order]) / energy.sum()
    # One frequency for each equal share of the energy.
    chosen = np.searchsorted(carried, (np.arange(FREQUENCIES) + 0.5) / FREQUENCIES)
    return frequency[order][chosen], np.full(FREQUENCIES, np.sqrt(2.0 * energy.sum() / FREQUENCIES))


def _ship_over_vehicle(chain: Chain, s: Complex) -> Complex:
    """Inverse of the response at s (q,) [rad/s]: up the chain from a vehicle of amplitude one."""
    x, e = np.ones_like(s), np.zeros_like(s)
    for k, r, m in zip(chain.k[::-1], chain.r[::-1], chain.m[::-1], strict=True):
        e = e + (m * s + r) * s * x
        x = x + e / k
    return x


def _difference(model: ReducedModel, other: ReducedModel, cases: Sequence[Case]) -> float:
    """Largest difference of the compared velocity [m/s]; infinite where a simulation fails."""
    try:
        return max(
            float(
                np.abs(
                    case.model_velocity(reduced.respond(model, case.drive))
                    - case.model_velocity(reduced.respond(other, case.drive))
                ).max()
            )
            for case in cases
        )
    except NumericalFailure:
        return float("inf")
