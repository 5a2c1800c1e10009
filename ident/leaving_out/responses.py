"""The terms that are left out of the matrix method and of the reduced models."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ident.leaving_out.case import NOTHING, Answer, Case, Floats
from ident.leaving_out.scenes import CURRENT, Scene, as_point, changed, currents, of_cable, without_drag
from models import reduced
from models.chain import Chain, quadratic_motion
from models.current import Current
from models.delayed import SecondOrder
from models.drive import MAX_STEP, Drive
from models.inertial import Inertial
from models.massless import Massless
from models.statics import static_shape
from models.tow import Tow
from models.transfer_matrix import Compensator, frequency_response
from models.transfer_matrix.line import linearise
from models.transfer_matrix.setup import DragForm, nodes_of
from models.vehicle import Towfish

#: Frequencies [rad/s], segments, and H's norm of the last iteration.
OMEGA, SEGMENTS, TOLERANCE = np.linspace(0.05, 1.5, 40), 200, 1e-8
#: A soft compensator: stiffness [N/m] and damping [N s/m]; and a stiff one that moves by nothing.
_SOFT, _STIFF = Compensator(stiffness=2000.0, damping=2000.0), Compensator(stiffness=1.0 / NOTHING, damping=0.0)
#: A cable that does not stretch, to all that a response shows [N].
_STIFF_CABLE = 1e13
_LINKS = 4


def by_matrix(scene: Scene) -> list[Case]:
    """The terms of the matrix method, for 1 m of motion along the cable's top."""
    tow = scene.tow

    def runs(of: Tow, compensator: Compensator | None = None, drag: DragForm = "consistent") -> Callable[[], Answer]:
        def answer() -> Answer:
            found = frequency_response(
                of, OMEGA, segments=SEGMENTS, tolerance=TOLERANCE, compensator=compensator, drag=drag, companion=False
            )
            return {"motion": found.motion[:, :2], "tension": found.tension_top, "deflection": found.states[:, :, 2:]}

        return answer

    def arrays(of: Tow, drag: DragForm = "consistent") -> Callable[[], Sequence[Floats]]:
        def built() -> Sequence[Floats]:
            shape = static_shape(of, nodes=nodes_of(of, SEGMENTS, OMEGA, 1.0))
            line = linearise(of, shape, printed=drag == "printed")
            return [*line.ends.T, *line.nodes.T, *line.body[:, None]]

        return built

    def case(
        term: str, strength: str, off: Tow, zero: Tow | None, on: Tow, beside: Tow | None = None, note: str = ""
    ) -> Case:
        return Case(
            scene=scene.name, simulator="matrix", term=term, strength=strength, off=runs(off), on=runs(on),
            zero=None if zero is None else runs(zero), beside=None if beside is None else runs(beside),
            built_off=arrays(off), built_on=arrays(on), note=note,
        )  # fmt: skip

    cases = [
        case(term, strength, changed(tow, **off), changed(tow, **zero), changed(tow, **on))
        for term, strength, off, zero, on in of_cable(tow.cable)
    ]
    uniform, flat, sheared = currents(tow)
    nothing = replace(tow, current=Current.uniform(NOTHING))
    cases.append(case("current", f"{CURRENT:g} m/s", tow, nothing, uniform))
    cases.append(case("shear", f"{2 * CURRENT:g} m/s at the surface, none at depth", uniform, flat, sheared))
    cases.append(
        case(
            "elasticity", f"{tow.cable.axial_stiffness:.3g} N", changed(tow, axial_stiffness=_STIFF_CABLE), None, tow,
            note=f"beside {_STIFF_CABLE:g} N: the method has a stiffness in any scene",
        )
    )  # fmt: skip
    cases.append(
        Case(
            scene=scene.name, simulator="matrix", term="compensator", off=runs(tow), zero=runs(tow, _STIFF),
            on=runs(tow, _SOFT), strength=f"{_SOFT.stiffness:g} N/m, {_SOFT.damping:g} N s/m",
        )
    )  # fmt: skip
    bare = replace(tow, vehicle=replace(tow.vehicle, drag_coefficient=0.0))
    cases.append(
        Case(
            scene=scene.name, simulator="matrix", term="coupled drag", strength="of the body as it is",
            off=runs(tow, drag="printed"), zero=runs(tow), on=runs(tow), same_off=runs(bare, drag="printed"),
            same_zero=runs(bare), built_off=arrays(tow, "printed"), built_on=arrays(tow),
            note="both forms compared at a drag of the body of zero, timed as it is",
        )
    )  # fmt: skip
    if isinstance(tow.vehicle, Towfish):
        point, level = (replace(tow, vehicle=each) for each in without_drag(tow.vehicle))
        as_it_is = replace(tow, vehicle=as_point(tow.vehicle))
        cases.append(case("pitch", "the towfish as it is", point, level, tow, as_it_is))
    return cases


def by_reduced(scene: Scene) -> list[Case]:
    """Mass of a chain and the delay of a model of one link."""
    shape, ship = static_shape(scene.tow), scene.ship
    light = reduced.section(f"massless-{_LINKS}-quadratic", scene.tow, shape)
    heavy = reduced.section(f"inertial-{_LINKS}-quadratic", scene.tow, shape)
    late = reduced.section("second-order-quadratic", scene.tow, shape)
    assert isinstance(light, Massless)
    assert isinstance(heavy, Inertial)
    assert isinstance(late, SecondOrder)
    drive, fine = Drive.from_trace(ship), Drive.from_trace(ship, max_step=0.5 * MAX_STEP)

    def moves(chain: Chain, on: Drive) -> Callable[[], Answer]:
        def answer() -> Answer:
            motion = quadratic_motion(chain, on)
            return {"velocity": motion.v, "position": motion.x}

        return answer

    def responds(delay: float) -> Callable[[], Answer]:
        def answer() -> Answer:
            found = reduced.respond(replace(late, delay=delay), drive)
            return {"velocity": found.velocity, "position": found.position}

        return answer

    chain = light.chain()
    massed = chain._replace(m=np.full(_LINKS, NOTHING))
    return [
        Case(
            scene=scene.name, simulator=f"{_LINKS} links, quadratic", term="mass", strength="of cable and vehicle",
            off=moves(chain, drive), zero=moves(massed, drive), on=moves(heavy.chain(), drive),
            same_off=moves(chain, fine), same_zero=moves(massed, drive),
            built_off=lambda: list(chain), built_on=lambda: list(heavy.chain()),
            note="a chain with mass takes half the step",
        ),
        Case(
            scene=scene.name, simulator="second-order-quadratic", term="delay", strength=f"{late.delay:.1f} s",
            off=responds(0.0), zero=responds(NOTHING), on=responds(late.delay),
        ),
    ]  # fmt: skip
