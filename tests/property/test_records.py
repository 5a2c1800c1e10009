"""What must hold for every record: files read back to the bit, projections commute with moving the map."""

import tempfile
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from data_synth.records import Record, join, planar, read_record, write_record
from data_synth.sensors import differentiator
from data_synth.ships import superpose
from models.trace import Trace

numbers = st.floats(-1e3, 1e3, allow_subnormal=False)


@st.composite
def tracks(draw: st.DrawFn) -> Trace:
    steps = draw(arrays(float, st.integers(4, 30), elements=st.floats(0.5, 59.0)))
    shape = (steps.size + 1, 3)
    t = np.concatenate(([0.0], np.cumsum(steps)))
    position = np.cumsum(draw(arrays(float, shape, elements=st.floats(-2.0, 2.0))), axis=0)
    return Trace(t=t, position=position)


@given(ship=tracks(), data=st.data())
@settings(max_examples=50, deadline=None)
def test_a_written_record_reads_back_to_the_bit(ship: Trace, data: st.DataObject) -> None:
    n = len(ship)
    gaps = data.draw(arrays(bool, n))
    vehicle = data.draw(arrays(float, (n, 3), elements=numbers))
    vehicle[gaps] = np.nan
    tension = data.draw(arrays(float, (n, 2), elements=numbers))
    tension[data.draw(arrays(bool, n))] = np.nan
    record = Record(
        name="tow",
        ship=ship,
        vehicle=Trace(t=ship.t, position=vehicle),
        depth=-vehicle[:, 2],
        tension=tension,
        bodies=tuple(Trace(t=ship.t, position=part * vehicle) for part in (0.5, -2.0)),
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "tow.csv"
        write_record(record, path)
        again = read_record(path)
    assert again.t.tobytes() == record.t.tobytes()
    assert again.ship.position.tobytes() == record.ship.position.tobytes()
    for one, other in (
        (again.vehicle.position, vehicle),
        (again.depth, record.depth),
        (again.tension, record.tension),
        (again.bodies[0].position, 0.5 * vehicle),
        (again.bodies[1].position, -2.0 * vehicle),
    ):
        assert np.array_equal(one, other, equal_nan=True)


@given(
    ship=tracks(),
    angle=st.floats(-3.0, 3.0),
    east=st.floats(-1e5, 1e5),
    north=st.floats(-1e6, 1e6),
)
@settings(max_examples=50, deadline=None)
def test_moving_and_turning_the_map_changes_no_projection(ship: Trace, angle: float, east: float, north: float) -> None:
    drift = np.column_stack([np.linspace(0.0, 500.0, len(ship)), np.linspace(0.0, 100.0, len(ship)), 0.0 * ship.t])
    here = Trace(t=ship.t, position=ship.position + drift)
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    there = Trace(t=here.t, position=here.position @ turn + [east, north, 0.0])
    one, other = planar(join("here", here, here)), planar(join("there", there, there))
    for a, b in ((one.record.ship, other.record.ship), (one.record.vehicle, other.record.vehicle)):
        assert np.abs(a.position - b.position).max() < 1e-6
    assert abs(one.off_plane - other.off_plane) < 1e-6
    assert other.record.ship.position[-1, 0] > 0.0
    back = other.on_map(other.record.ship)
    off = np.linalg.norm((back.position - there.position)[:, :2], axis=1)
    assert abs(off.max() - other.off_plane) < 1e-6


@given(valid=arrays(bool, 80, elements=st.booleans()), curve=st.tuples(numbers, numbers, st.floats(-1.0, 1.0)))
@settings(max_examples=50, deadline=None)
def test_the_differentiator_is_exact_on_parabolas_whatever_is_missing(
    valid: np.ndarray, curve: tuple[float, float, float]
) -> None:
    valid[::2] = True
    t = np.cumsum(np.where(np.arange(80) % 3, 5.0, 9.0))
    a, b, c = curve
    operator = differentiator(t, valid)
    slope = b + 2.0 * c * t[operator.index]
    scale = 1.0 + np.abs(slope).max() + abs(a)
    assert np.abs(operator.velocity(a + b * t + c * t**2) - slope).max() < 1e-9 * scale


@given(one=tracks(), shift=st.tuples(numbers, numbers, numbers))
@settings(max_examples=30, deadline=None)
def test_superposition_is_commutative_and_keeps_a_still_ship_still(one: Trace, shift: tuple[float, ...]) -> None:
    other = Trace(t=one.t, position=np.tile(shift, (len(one), 1)))
    both, turned = superpose(one, other), superpose(other, one)
    assert np.allclose(both.position, turned.position, rtol=0.0, atol=1e-12)
    assert np.allclose(both.rates(), one.rates(), rtol=0.0, atol=1e-9)
