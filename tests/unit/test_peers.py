"""The tow that MoorDyn is given, what it cannot be given, and, where it is installed, its agreement with statics."""

import importlib.util
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ident import tows_compared
from ident.benchmark import peer_bench, peers
from ident.benchmark.peers import Setting
from ident.timing import Timing, exponent, front
from models.body import Body
from models.current import Current
from models.link_joint import simulate
from models.quantity import GRAVITY, InvalidInput, NumericalFailure
from models.tow import Tow
from models.towed_system import Part, TowedSystem
from models.trace import Trace

SETTING = Setting(segments=6, scheme="RK2", step=0.05)
installed = pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="MoorDyn is an optional extra")


@pytest.fixture
def system(configurations: Callable[[str], Tow]) -> TowedSystem:
    """Steel sphere on 1200 m of cable."""
    return TowedSystem.from_tow(configurations("autec-1200"))


def table(text: str, heading: str) -> list[list[str]]:
    """Rows of a section of MoorDyn's input file, below its two lines of names and units."""
    lines = text.splitlines()
    start = next(i for i, line in enumerate(lines) if line.strip("- ") == heading)
    rows = []
    for line in lines[start + 3 :]:
        if line.startswith("---"):
            break
        rows.append(line.split())
    return rows


def with_part(system: TowedSystem, **changes: object) -> TowedSystem:
    return replace(system, parts=(replace(system.parts[0], **changes),))


def test_line_and_point_have_the_cables_physics(system: TowedSystem) -> None:
    # A thicker fairing: the displacement is no longer that of the diameter that the drag refers to.
    cable = replace(system.parts[0].cable, diameter=0.03, weight_in_water=6.0)
    system = with_part(system, cable=cable)
    text, rho = peers.input_file(system, SETTING), system.water_density
    [(_, d, m, ea, ba, _, cd, ca, cdx, cax)] = [[row[0], *map(float, row[1:])] for row in table(text, "LINE TYPES")]
    displaced = 0.25 * math.pi * d**2 * rho
    assert (m - displaced) * GRAVITY == pytest.approx(6.0, rel=1e-12)
    assert (m, ea, cax) == (cable.mass, cable.axial_stiffness, 0.0)
    assert ba == pytest.approx(cable.axial_damping * cable.axial_stiffness)
    assert 0.5 * rho * d * cd == pytest.approx(cable.normal_drag(rho))
    assert 0.5 * rho * math.pi * d * cdx == pytest.approx(cable.tangential_drag(rho))
    assert ca * displaced == pytest.approx(cable.added_mass)
    point, ship = table(text, "POINTS")
    mass, volume, area, added = map(float, point[5:])
    body = system.parts[0].body
    assert body is not None
    assert mass == body.mass + body.added_mass_surge
    assert added == 0.0
    assert (mass - rho * volume) * GRAVITY == pytest.approx(body.weight_in_water, rel=1e-12)
    assert area == pytest.approx(body.drag_coefficient * body.area_surge)
    assert ship[1] == "Coupled"


def test_a_share_of_critical_is_written_negative(system: TowedSystem) -> None:
    text = peers.input_file(system, replace(SETTING, damping=0.8))
    assert float(table(text, "LINE TYPES")[0][4]) == -0.8


@pytest.mark.parametrize("what", ["parts", "current", "strumming", "law", "axes", "buoyant"])
def test_what_moordyn_has_no_tow_of_is_refused(system: TowedSystem, what: str) -> None:
    part = system.parts[0]
    body = part.body
    assert isinstance(body, Body)
    current = Current(depth=np.array([0.0, 100.0]), speed=np.array([0.1, 0.1]))
    tail = Part(name="tail", cable=replace(part.cable, length=100.0), body=None, after=part.name)
    wrong = {
        "parts": replace(system, parts=(part, tail)),
        "current": replace(system, current=current),
        "strumming": replace(system, strumming=True),
        "law": replace(system, drag_law="incidence"),
        "axes": with_part(system, body=replace(body, area_heave=2.0 * body.area_heave)),
        "buoyant": with_part(system, cable=replace(part.cable, weight_in_water=1.1 * part.cable.mass * GRAVITY)),
    }[what]
    with pytest.raises(InvalidInput, match="MoorDyn"):
        peers.input_file(wrong, SETTING)


def test_without_moordyn_the_message_says_how_to_get_it(system: TowedSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peers, "version", lambda: None)
    with pytest.raises(InvalidInput, match="pip install"):
        peers.simulate(system, tows_compared.tows()["step"], SETTING)


def test_a_ship_under_way_is_refused(system: TowedSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peers, "version", lambda: "2.7.2")
    t = np.arange(10.0)
    with pytest.raises(InvalidInput, match="at rest"):
        peers.simulate(system, Trace.along_x(t, 2.0 * t), SETTING)


def test_front_and_ratio_at_equal_error() -> None:
    assert front([(1.0, 1.0), (0.5, 4.0), (0.9, 2.0), (0.6, 5.0)], lambda point: point) == [
        (1.0, 1.0),
        (0.9, 2.0),
        (0.5, 4.0),
    ]
    assert exponent([1.0, 2.0, 4.0], [3.0, 6.0, 12.0]) == pytest.approx(1.0)

    def point(error: float) -> peer_bench.PeerPoint:
        return peer_bench.PeerPoint(tow="step", setting=SETTING, error=error, timing=Timing(1.0, 0.0, 1))

    # The chain's time goes as the inverse root of its error, from 0.01 s at 1 to 0.1 s at 0.01.
    found = peer_bench.ratios([point(2.0), point(0.1), point(0.001)], [(1.0, 0.01), (0.01, 0.1)])
    assert found[:2] == pytest.approx([100.0, 1.0 / math.sqrt(1e-3)])
    assert math.isnan(found[2])


def test_the_circle_keeps_the_speed_of_the_straight_track() -> None:
    ship = tows_compared.tows()["circle"]
    assert np.linalg.norm(ship.position[:, :2] - [0.0, tows_compared.RADIUS], axis=1) == pytest.approx(
        np.full(len(ship), tows_compared.RADIUS)
    )
    assert np.linalg.norm(ship.rates()[-1]) == pytest.approx(tows_compared.SPEED)


@installed
def test_moordyn_hangs_and_tows_as_the_chain_does(system: TowedSystem) -> None:
    """Tension of the end segments at rest in closed form; the body's track on the way to 2 m/s as the chain's."""
    cable, body = system.parts[0].cable, system.parts[0].body
    assert body is not None
    ship = tows_compared.tows()["straight"]
    run = peers.simulate(system, ship, Setting(segments=12, scheme="RK2", step=0.02, damping=0.8)).body
    assert run.tension is not None
    half = 0.5 * cable.weight_in_water * cable.length / 12
    hanging = body.weight_in_water + cable.weight_in_water * cable.length
    assert run.tension[0] == pytest.approx([hanging - half, body.weight_in_water + half], rel=1e-6)
    chain = simulate(system, ship, links=24, tolerance=1e-3, companion=False).vehicle
    # Both err by 0.7 m or less at this resolution, over a trail of 760 m.
    assert np.abs(run.position - chain.position).max() < 1.5
    assert np.linalg.norm(run.position[-1] - ship.position[-1]) > 1000.0


@installed
def test_a_step_past_the_limit_is_not_taken_for_stable(system: TowedSystem) -> None:
    ship = tows_compared.tows(0.3)["step"]
    fine = Setting(segments=24, scheme="RK4", step=2.0 / peers.fastest_rate(system, ship, 24), damping=0.8)
    found = peers.largest_steps(system, ship, peers.simulate(system, ship, fine).body, 6)
    assert set(found) == set(peers.CANDIDATES)
    # RK2 is stable to 2.2 or so over the axial frequency at this loss.
    assert 1.5 < found["RK2"] < 2.4


@installed
def test_a_run_that_leaves_the_finite_range_says_so(system: TowedSystem, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(NumericalFailure, match="MoorDyn"):
        peers.simulate(system, tows_compared.tows(0.1)["step"], replace(SETTING, segments=24, step=0.2))
    printed = capfd.readouterr()
    assert printed.out == printed.err == ""
