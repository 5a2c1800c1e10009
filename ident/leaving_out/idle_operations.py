"""What a kernel spends on a term that is off: its own source, run on numbers that notice a zero among the operands.

Of the operations of one evaluation, `spared` are those that a kernel does with the term on and not with it off, `idle`
those that it does with it off on a zero that the term would fill: what a kernel without the term would not do, so the
most that it could save.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.benchmark import operations
from ident.benchmark.operations import Counting
from ident.leaving_out.case import Floats
from ident.leaving_out.responses import OMEGA
from ident.leaving_out.scenes import changed, currents
from models.link_joint.chain import build, current_of
from models.link_joint.columns import work_for
from models.link_joint.elimination import substitute
from models.link_joint.plane import plane_of
from models.link_joint.stage import assemble
from models.link_joint.steady import equilibrium
from models.spectral.basis import prepare
from models.spectral.forces import cable_forces
from models.spectral.matrix import cable_matrix
from models.spectral.workspace import END_ROWS, SUM_ROWS, WORK_ROWS
from models.statics import static_shape
from models.tow import Tow
from models.towed_system import TowedSystem
from models.transfer_matrix.line import linearise
from models.transfer_matrix.march import solve_with
from models.transfer_matrix.setup import scales_of

_IDLE = "idle"
_LINKS, _HARMONICS, _SEGMENTS = 8, 6, 8


@dataclass(frozen=True, slots=True, kw_only=True)
class Spent:
    """Shares of the operations of one evaluation with the term on."""

    simulator: str
    term: str
    spared: float
    idle: float


class Noticing(Counting):
    """A number that also enters how many operations have a zero among their operands."""

    __slots__ = ()

    def _with(self, other: Any, of: Callable[[Any, Any], complex], counts: tuple[int, int, int], turned: bool) -> Any:
        made = super()._with(other, of, counts, turned)
        if made is not NotImplemented and 0.0 in (self.value, other.value if isinstance(other, Counting) else other):
            complexes = sum(isinstance(getattr(each, "value", each), complex) for each in (self, other))
            self.tally[_IDLE] += counts[complexes]
        return made

    # Given here again, so that they come before those of a plain number that counts on the left.
    def __radd__(self, other: Any) -> Any:
        return super().__radd__(other)

    def __rsub__(self, other: Any) -> Any:
        return super().__rsub__(other)

    def __rmul__(self, other: Any) -> Any:
        return super().__rmul__(other)

    def __rtruediv__(self, other: Any) -> Any:
        return super().__rtruediv__(other)


def spent(tow: Tow) -> list[Spent]:
    """For every simulator the terms that its kernel could be without, all the others being on."""
    found = []
    for simulator, evaluate in (("spectral", _spectral), ("link-joint", _chain), ("matrix", _matrix)):
        for term, off, on in _terms(tow, simulator):
            (idle, done), (before, most) = evaluate(*off), evaluate(*on)
            found.append(
                Spent(
                    simulator=simulator, term=term, spared=(most - done) / most, idle=max(0.0, (idle - before) / most)
                )
            )
    return found


def _terms(tow: Tow, simulator: str) -> Iterator[tuple[str, tuple[Tow, bool], tuple[Tow, bool]]]:
    """Term, and the tow without it and with it, each with whether the chain moves in a plane."""
    full = currents(changed(tow, poisson_ratio=0.3, axial_damping=0.01, tangential_drag_coefficient=0.05))[2]
    whole = (full, False)
    for name, field, value in (
        ("tangential drag", "tangential_drag_coefficient", 0.0),
        ("internal loss", "axial_damping", 0.0),
        ("water pressure", "poisson_ratio", 0.5),
    ):
        yield name, (changed(full, **{field: value}), False), whole
    yield "current", (replace(full, current=None), False), whole
    yield "shear", (currents(full)[0], False), whole
    if simulator == "link-joint":
        yield "third axis", (full, True), whole


def _noticing(values: Any, tally: Counter[str]) -> NDArray[Any]:
    array = np.asarray(values)
    if array.dtype.kind not in "fc":
        return array
    made = np.empty(array.shape, dtype=object)
    for place, value in np.ndenumerate(array):
        made[place] = Noticing(value.item(), tally)
    return made


def _result(tally: Counter[str]) -> tuple[int, int]:
    return tally[_IDLE], sum(count for name, count in tally.items() if name != _IDLE)


def _chain(tow: Tow, planar: bool) -> tuple[int, int]:
    """Idle and all operations of one iteration of a stage, off its equilibrium."""
    system, velocity = TowedSystem.from_tow(tow), (1.0, 0.0, 0.0)
    layout = build(system, _LINKS)
    n, rng, tally, chain = layout.count, np.random.default_rng(1), Counter[str](), layout.chain
    place, T, _ = equilibrium(layout, velocity)
    states = [each + rng.normal(0.0, 0.1, place.shape) for each in (place, np.zeros_like(place), place)]
    plane = plane_of(current_of(system)[1], velocity) if planar else None
    if plane is not None:
        states, chain = [plane.along(each) for each in states], plane.chain(chain)
    arrays: dict[str, Any] = {name: _noticing(each, tally) for name, each in chain._asdict().items()}
    chain = chain._replace(**arrays | {"specific_weight": chain.specific_weight, "law": chain.law})
    work = work_for(n + 1, states[0].shape[1])
    work = work._replace(W=_noticing(work.W, tally), reel=_noticing(work.reel, tally))
    x, v, before, T = (_noticing(each, tally) for each in (*states, T))
    operations.in_python(assemble)(chain, n, 0.3, before, x, v, T, work)
    operations.in_python(substitute)(chain, n, work, _noticing(np.zeros(x.shape), tally), operations.empty(n))
    return _result(tally)


def _spectral(tow: Tow, planar: bool) -> tuple[int, int]:
    """Idle and all operations of the forces and their matrix."""
    fields = prepare(tow, harmonics=_HARMONICS)
    rng, tally, size = np.random.default_rng(1), Counter[str](), 2 + _HARMONICS
    own = type(fields)(*(_noticing(each, tally) for each in fields))
    y, v, end = (_noticing(rng.normal(0.0, 0.1, count), tally) for count in (size, size, END_ROWS))
    end[4] = end[5] = 0.0
    sums, station = operations.empty(SUM_ROWS, 2 * size), operations.empty(WORK_ROWS, fields.station.shape[1])
    operations.in_python(cable_forces)(own, y, v, end, operations.empty(size), station)
    operations.in_python(cable_matrix)(own, end, 0.3, station, sums, operations.empty(size, size))
    return _result(tally)


def _matrix(tow: Tow, planar: bool) -> tuple[int, int]:
    """Idle and all operations of one solve at one frequency."""
    line = linearise(tow, static_shape(tow, nodes=np.linspace(0.0, tow.length, _SEGMENTS + 1)))
    omega, rng, tally = OMEGA[20:21], np.random.default_rng(1), Counter[str]()
    drag: Floats = rng.uniform(0.1, 0.5, (_SEGMENTS + 1, 2))
    D = np.array([[10.0 + 1.0j, 1.0], [1.0, 20.0 + 1.0j]])
    arrays = (omega, line.ends, line.h, line.body, scales_of(line, omega), np.array([[1.0 + 0.0j, 0.0j]]), np.zeros(4))
    operations.in_python(solve_with)(
        *(_noticing(each, tally) for each in arrays), _noticing(drag, tally), _noticing(D, tally), 0.0, False,
        operations.empty(1, _SEGMENTS + 1, 4), operations.empty(1, 3), operations.empty(1),
    )  # fmt: skip
    return _result(tally)
