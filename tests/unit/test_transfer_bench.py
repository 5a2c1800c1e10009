"""What the benchmark of the matrix method rests on: operations counted, a band matrix, and that it times the method."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ident.benchmark import operations, transfer_bench, transfer_costs
from ident.benchmark.banded_response import BandedResponse, Drag
from ident.benchmark.operations import Counting
from ident.benchmark.transfer_bench import REDUCED, March
from models.current import Current
from models.quantity import NumericalFailure
from models.tow import Tow
from models.transfer_matrix import frequency_response
from models.transfer_matrix.march import harmonic_march

NAMES = ("s-shape-205", "swath-4000", "autec-1200", "multipart-2200")
Tows = Callable[[str], Tow]


def sheared(tow: Tow) -> Tow:
    """With a sheared current, a compressible cable and axial losses, so that no term is zero."""
    cable = replace(tow.cable, poisson_ratio=0.3, axial_damping=0.02, added_mass=0.3)
    return replace(tow, cable=cable, current=Current(depth=[0.0, 5000.0], speed=[0.6, 0.1]))


@pytest.mark.parametrize(
    ("work", "expected"),
    [
        (lambda x, z: x + 1.0, 1),
        (lambda x, z: 2.0 - z, 1),
        (lambda x, z: z + z, 2),
        (lambda x, z: x * x, 1),
        (lambda x, z: 3.0 * z, 2),
        (lambda x, z: z * 1j, 6),
        (lambda x, z: z / x, 2),
        (lambda x, z: 1.0 / z, 11),
        (lambda x, z: abs(z), 4),
        (lambda x, z: -z.conjugate(), 0),
        (lambda x, z: (z.real < z.imag) + (x == 2.0), 0),
        (lambda x, z: np.array([z, z], dtype=object) * x, 4),
        (lambda x, z: x**2, 1),
    ],
)
def test_operations_are_counted_as_on_paper(work: Callable[[Counting, Counting], object], expected: int) -> None:
    tally: Counter[str] = Counter()
    work(Counting(2.0, tally), Counting(1.0 + 2.0j, tally))
    assert sum(tally.values()) == expected


def counted(tow: Tow, segments: int) -> tuple[Counter[str], March, np.ndarray]:
    """Operations of one iteration, the march that did the same compiled, and the states of the counting one."""
    omega = np.array([0.7])
    march = March(transfer_bench.line_with(tow, segments, omega), omega, -1.0, 1)
    tally: Counter[str] = Counter()
    line, states = march.line, operations.empty(1, segments + 1, 4)
    first = March(line, omega)
    operations.in_python(harmonic_march)(
        *(operations.counting(each, tally) for each in (omega, line.ends, line.nodes)), line.h,
        *(operations.counting(each, tally) for each in (line.body, march.scales, march.tops)), np.zeros(4), False,
        -1.0, 1, states, operations.empty(1, 3), operations.counting(first.b, tally),
        operations.counting(first.D, tally), np.zeros(1, dtype=int), operations.empty(1), operations.empty(1),
    )  # fmt: skip
    march()
    return tally, march, np.vectorize(lambda each: each.value)(states)


@pytest.mark.parametrize("name", ["s-shape-205", "autec-1200"])
def test_counting_runs_the_kernel_itself(name: str, configurations: Tows) -> None:
    tally, march, states = counted(configurations(name), 20)
    np.testing.assert_allclose(states, march.states, rtol=1e-9, atol=1e-12 * abs(march.states).max())
    # By hand: two states a node, whose norm takes four moduli squared, two products and three sums.
    assert tally["solve._weighed"] == 2 * 17 * 21


def test_operations_are_linear_in_the_nodes(configurations: Tows) -> None:
    few, many = (sum(counted(configurations("s-shape-205"), count)[0].values()) for count in (40, 80))
    assert many / few == pytest.approx(2.0, rel=0.05)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        *((name, lambda tow: tow) for name in NAMES),
        # The S-shape has no equilibrium in so strong a current.
        *((name, sheared) for name in NAMES[1:]),
    ],
)
def test_the_band_matrix_and_the_sweep_agree(name: str, change: Callable[[Tow], Tow], configurations: Tows) -> None:
    tow = configurations(name)
    omega = transfer_bench.frequencies(6)
    march = March(transfer_bench.line_with(change(tow), 60, omega), omega)
    rng = np.random.default_rng(1)
    drag = Drag(
        b=rng.uniform(0.1, 0.5, (61, 2)), D=rng.uniform(1.0, 50.0, (2, 2)) * np.exp(1j * rng.random((2, 2))), b_turn=7.0
    )
    march.once(drag)
    for omega_k, states, top, scale in zip(omega.tolist(), march.states, march.tops, march.scales, strict=True):
        band = BandedResponse(line=march.line, drag=drag, top=top, scale=scale)
        exact = band.solve(omega_k)
        assert band.size_of(states - exact) < 1e-11 * band.size_of(exact)


def test_a_band_matrix_without_a_solution_is_told(configurations: Tows) -> None:
    omega = np.array([0.5])
    march = March(transfer_bench.line_with(configurations("autec-1200"), 10, omega), omega)
    none = Drag(b=np.zeros((11, 2)), D=np.zeros((2, 2), dtype=complex))
    broken = replace(march.line, body=np.zeros_like(march.line.body), ends=np.zeros_like(march.line.ends))
    band = BandedResponse(line=broken, drag=none, top=march.tops[0], scale=march.scales[0])
    with pytest.raises(NumericalFailure, match=r"0\.5 rad/s"):
        band.solve(0.5)


@pytest.mark.parametrize("name", NAMES)
def test_what_is_timed_is_the_method(name: str, configurations: Tows) -> None:
    tow, omega = configurations(name), transfer_bench.frequencies(8)
    run = frequency_response(tow, omega, segments=30, tolerance=1e-4, companion=False)
    march = March(transfer_bench.line_with(tow, 30, omega), omega)
    march()
    np.testing.assert_array_equal(march.iterations, run.iterations)
    np.testing.assert_array_equal(march.states, run.states)


def test_the_mesh_errs_at_second_order(configurations: Tows) -> None:
    few, more = transfer_bench.precision(configurations("swath-4000"), replace(REDUCED, segments=(32, 64))).points
    assert few.segments == 32
    assert few.velocity_error / more.velocity_error == pytest.approx(4.0, rel=0.1)


def test_a_tighter_tolerance_leaves_less(configurations: Tows) -> None:
    loose, tight = transfer_bench.tolerances(configurations("s-shape-205"), REDUCED)
    assert loose.solves <= tight.solves
    assert loose.velocity_error > tight.velocity_error > 0.0


def test_the_parts_of_an_iteration_add_up_to_its_operations(configurations: Tows) -> None:
    rows, tally = transfer_costs.costs(configurations("s-shape-205"), REDUCED)
    assert sum(row.counted for row in rows) == sum(tally.values())
    assert sum(row.printed for row in rows) == transfer_costs.PRINTED_OPERATIONS
    assert sum(row.printed_per_node for row in rows) == 2684
