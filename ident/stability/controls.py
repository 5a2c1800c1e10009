"""Negative controls: faults that the catalogue's own figures must catch, each beside the case that is without it.

The schemes with a limit have no case of their own; their twins run them within it."""

import math
from dataclasses import replace

import numpy as np

from ident.stability import chain_cases, matrix_cases
from ident.stability.case import Case, Finding
from ident.stability.lumped import Lumped, march
from ident.stability.scenes import changed
from models.statics import steady_way
from models.towed_system import TowedSystem
from models.transfer_matrix import UniformDamping, response
from models.transfer_matrix.setup import direction_of, line_of, nodes_of
from models.transfer_matrix.work import Work

#: The plain chain: nodes, ship's speed [m/s], duration [s]; of each scheme a step [s] within its limit, and one beyond.
_NODES, _SPEED, _DURATION = 10, 1.0, 400.0
_EXPLICIT, _NAIVE = (0.1, 0.109), (0.06, 0.07)


def wrong_sign() -> Finding:
    """The current with its sign turned: `chain-current-reversed`."""
    scene = chain_cases.TOWED["chain-current-reversed"]()
    turned = replace(chain_cases.SHEARED, speed=-chain_cases.SHEARED.speed)
    return replace(scene, system=replace(scene.system, current=turned)).find()


def wrong_coefficient() -> Finding:
    """A normal drag coefficient of 1.5 for 1.6: `chain-links-64`."""
    scene = chain_cases.TOWED["chain-links-64"]()
    return replace(scene, system=changed(scene.system, cable={"normal_drag_coefficient": 1.5})).find()


def too_few_links() -> Finding:
    """Four links held to what 64 must reach: `chain-links-64`."""
    return replace(chain_cases.TOWED["chain-links-64"](), links=4).find()


def no_added_mass() -> Finding:
    """Swinging without added mass: `chain-drag-zero`."""
    scene = chain_cases.SWUNG["chain-drag-zero"]()
    bare = changed(scene.system, cable={"added_mass": 0.0}, body={"added_mass_surge": 0.0, "added_mass_sway": 0.0})
    return replace(scene, system=bare).find()


def lost_moved_angle() -> Finding:
    """Drag that does not see the moved angle, as H prints it: `matrix-weight-zero`."""
    return matrix_cases.slow_motion(matrix_cases.light_body(0.0), drag="printed")


def unguarded_product() -> Finding:
    """The product of matrices without the count of its digits: `matrix-inclined`."""
    scene = matrix_cases.INCLINED
    tow, omega = scene.tow, np.array([scene.omega])
    way = steady_way(tow)
    line = line_of(tow, way, nodes_of(tow, matrix_cases.PRODUCT_SEGMENTS, omega, 1.0, way=way), "consistent")
    work = Work(line, omega, direction_of(line, "surge")[None, :].astype(complex))
    response._given(work, UniformDamping(normal=scene.normal), by_product=True)
    p, q = work.motion[0, 0], work.motion[0, 1]
    return Finding(
        figures={
            "tension_top": float(abs(work.states[0, -1, 0])),
            "angle_top": float(abs(work.states[0, -1, 1])),
            "across": float(abs(p * math.cos(line.shape.pitch) - q * math.sin(line.shape.pitch))),
        },
        text=f"{work.digits[0]:.1f} digits left",
    )


def soft_system() -> TowedSystem:
    """The sled on 100 m of a soft cable."""
    return changed(chain_cases.mangus(100.0), cable={"axial_stiffness": 2e4})


def lumped(step: float, *, implicit: bool = False) -> Finding:
    """The plain chain with a step [s]."""
    place, tension = march(Lumped(soft_system(), _NODES), _SPEED, _DURATION, step, implicit=implicit)
    figures = {"trail": -float(place[0]), "depth": -float(place[1]), "tension_top": tension}
    return Finding(figures=figures, text=f"a step of {step:g} s")


CASES = (
    Case(name="control-wrong-sign", run=wrong_sign, reduced=True),
    Case(name="control-wrong-coefficient", run=wrong_coefficient, reduced=True),
    Case(name="control-too-few-links", run=too_few_links, reduced=True),
    Case(name="control-no-added-mass", run=no_added_mass),
    Case(name="control-lost-moved-angle", run=lost_moved_angle, reduced=True),
    Case(name="control-unguarded-product", run=unguarded_product, reduced=True),
    Case(name="control-step-past-the-limit", run=lambda: lumped(_EXPLICIT[1]), reduced=True, may_fail=True),
    Case(name="control-naive-scheme", run=lambda: lumped(_NAIVE[1], implicit=True), may_fail=True),
    Case(name="twin-explicit-scheme", run=lambda: lumped(_EXPLICIT[0]), reduced=True),
    Case(name="twin-naive-scheme", run=lambda: lumped(_NAIVE[0], implicit=True)),
)
