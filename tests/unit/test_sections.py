"""Lengths of cable below the first, and a vehicle's thrust: who knows them, and who says that it does not."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from data_synth.records import Record
from ident import simulators
from ident.cli import main
from ident.configuration import load
from models import link_joint, reduced, spectral
from models.body import Body
from models.quantity import InvalidInput
from models.spectral.basis import prepare
from models.statics import SlackCable, static_shape, travel_time
from models.tow import Tow
from models.towed_system import TowedSystem
from models.trace import Trace

MakeTow = Callable[[str], Tow]


def sectioned(tow: Tow) -> Tow:
    """The tow with two more lengths of cable, of 30 m above 20 m."""
    return replace(tow, sections=(replace(tow.cable, length=30.0), replace(tow.cable, length=20.0)))


def thrusting(tow: Tow) -> Tow:
    return replace(tow, vehicle=replace(tow.vehicle, thrust=-25.0))


def still_ship() -> Trace:
    t = np.arange(0.0, 11.0)
    return Trace.along_x(t, 0.0 * t)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (sectioned, "needs one uniform cable, but this one has 2 further sections"),
        (thrusting, r"knows no thrust, but Vehicle\.thrust \(F_x\) is -25 N"),
    ],
)
@pytest.mark.parametrize(
    ("what", "use"),
    [
        ("The spectral simulator", lambda tow: spectral.simulate(tow, still_ship())),
        ("The spectral simulator", lambda tow: prepare(tow, harmonics=5)),
        ("A reduced model", lambda tow: reduced.section("massless-4-linear", tow, static_shape(tow))),
    ],
)
def test_models_of_one_cable_refuse(
    configurations: MakeTow, change: Callable[[Tow], Tow], reason: str, what: str, use: Callable[[Tow], object]
) -> None:
    tow = configurations("mangus-740")
    use(tow)
    with pytest.raises(InvalidInput, match=f"^{what} {reason}"):
        use(change(tow))


def test_sections_are_refused_before_their_shape_is_looked_for(configurations: MakeTow) -> None:
    tow = replace(configurations("s-shape-205"), current=None)
    with pytest.raises(SlackCable):
        static_shape(tow)
    with pytest.raises(InvalidInput, match="The spectral simulator needs one uniform cable"):
        spectral.simulate(tow, still_ship())


def test_the_chain_refuses_a_thrust_alone(configurations: MakeTow) -> None:
    tow = configurations("mangus-740")
    with pytest.raises(InvalidInput, match=r"The link-joint chain knows no thrust, .* -25 N\. Leave it out"):
        Body.from_vehicle(thrusting(tow).vehicle)
    TowedSystem.from_tow(sectioned(tow))


def test_the_travel_time_of_a_wave_is_that_of_one_cable(configurations: MakeTow) -> None:
    tow = sectioned(configurations("mangus-740"))
    with pytest.raises(InvalidInput, match="The travel time of a wave needs one uniform cable"):
        travel_time(tow, static_shape(tow))


def test_sections_are_parts_without_bodies(configurations: MakeTow) -> None:
    tow = sectioned(configurations("mangus-740"))
    system = TowedSystem.from_tow(tow)
    assert [(part.name, part.after, part.cable.length) for part in system.parts] == [
        ("cable", None, 740.0),
        ("section-1", "cable", 30.0),
        ("vehicle", "section-1", 20.0),
    ]
    assert [part.body is None for part in system.parts] == [True, True, False]
    one = TowedSystem.from_tow(configurations("mangus-740"))
    assert [(part.name, part.after) for part in one.parts] == [("vehicle", None)]
    assert one.parts[0].body == system.parts[2].body


def test_the_vehicle_of_a_run_is_the_body_below_the_sections(configurations: MakeTow) -> None:
    tow = sectioned(configurations("mangus-740"))
    result = link_joint.simulate(TowedSystem.from_tow(tow), still_ship(), links=12, companion=False)
    assert result.names == ("cable", "section-1", "vehicle")
    np.testing.assert_array_equal(result.vehicle.position, result.bodies[2].position)
    assert result.vehicle.position[-1, 2] == pytest.approx(-790.0, abs=1.0)
    assert result.vehicle.tension is not None
    assert result.vehicle.tension[-1, 1] == pytest.approx(6000.0, rel=1e-3)
    # A record has the whole cable: its tension at the ship, and the tails but not the joints.
    own = replace(load("mangus-740"), tow=tow)
    (whole,) = simulators.ends(own, result)
    assert whole.tension is not None
    assert whole.tension[-1] == pytest.approx([6000.0 + 790.0 * tow.cable.weight_in_water, 6000.0], rel=1e-3)


def test_a_record_of_sections_needs_the_chain(configurations: MakeTow) -> None:
    own, ship = load("mangus-740"), Record(name="still", ship=still_ship())
    assert simulators.needed(own, ship) == "spectral"
    assert simulators.needed(replace(own, tow=sectioned(configurations("mangus-740"))), ship) == "link-joint"


@pytest.mark.parametrize("name", ["s-shape-205", "s-shape-205-thrust"])
@pytest.mark.parametrize("command", ["run", "step", "turn", "compare", "bench"])
def test_studies_of_one_cable_end_with_a_message(
    name: str, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, name, "--out", str(tmp_path / "out")]) == 2
    assert re.match(
        r"error: The \w.* needs one uniform cable, but this one has 1 further section ", capsys.readouterr().err
    )
    assert list(tmp_path.iterdir()) == []


def test_fits_and_simulations_of_one_cable_end_with_a_message(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = tmp_path / "record.csv"
    assert main(["record", "s-shape-205", "--input", "straight", "--duration", "60", "--out", str(record)]) == 0
    assert "link-joint" in capsys.readouterr().out
    commands = (
        ["simulate", "s-shape-205", "--ship", str(record)],
        ["fit", "s-shape-205", "--record", str(record), "--model", "massless-linear"],
        ["crossval", "s-shape-205", "--record", str(record)],
    )
    for command in commands:
        assert main([*command, "--out", str(tmp_path / "out")]) == 2, command
        assert "needs one uniform cable" in capsys.readouterr().err, command
    chain = tmp_path / "chain.csv"
    refused = [
        "simulate",
        "s-shape-205-thrust",
        "--reference",
        "link-joint",
        "--ship",
        str(record),
        "--out",
        str(chain),
    ]
    assert main(refused) == 2
    assert "The link-joint chain knows no thrust, but Towfish.thrust (F_x) is 70 N" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["record.csv"]
