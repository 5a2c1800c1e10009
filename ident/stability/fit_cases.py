"""Cases of fits that start a factor of 100 away from the parameters that made the record."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from data_synth.ships import StandardInput, standard_input
from ident.cases import case_from_truth
from ident.learning import fit
from ident.stability.case import Case, Finding
from ident.stability.reduced_cases import sectioned
from models import reduced

#: How far away the start is, either way.
AWAY = 100.0


def _fitted(name: str, signs: Sequence[int]) -> Finding:
    """Half an hour of the standard input without noise; `signs` say which way each parameter starts away."""
    truth = sectioned(name)
    ship = standard_input(StandardInput(duration=1800.0), np.random.default_rng(0))
    case = case_from_truth("half an hour", ship, reduced.simulate(truth, ship), 300.0)
    true = [parameter.value for parameter in reduced.parameters(truth)]
    start = reduced.with_values(truth, [value * AWAY**sign for value, sign in zip(true, signs, strict=True)])
    result = fit(start, [case], profile=False)
    found = [parameter.value for parameter in reduced.parameters(result.model)]
    off = max(abs(math.log(max(one, 1e-300) / other)) for one, other in zip(found, true, strict=True))
    return Finding(
        figures={"factor off": math.exp(off), "error": result.rms},
        text=f"{result.outcome}, {result.simulations} simulations, {result.failures} of them failed",
    )


def _case(name: str, model: str, *signs: int, reduced: bool = False) -> Case:
    return Case(name=f"fit-{name}", run=partial(_fitted, model, signs), reduced=reduced)


CASES: tuple[Case, ...] = (
    _case("massless-above", "massless-4-quadratic", 1, 1),
    _case("massless-below", "massless-4-quadratic", -1, -1, reduced=True),
    _case("massless-apart", "massless-4-quadratic", 1, -1),
    _case("massless-linear", "massless-4-linear", 1, -1),
    _case("inertial-above", "inertial-4-quadratic", 1, 1, 1, 1),
    _case("inertial-below", "inertial-4-quadratic", -1, -1, -1, -1),
    _case("inertial-linear", "inertial-1-linear", 1, -1),
    _case("first-order-above", "first-order-quadratic", 1, 1),
    _case("first-order-below", "first-order-quadratic", -1, -1, reduced=True),
    _case("second-order-above", "second-order-quadratic", 1, 1, 1),
    _case("second-order-below", "second-order-quadratic", -1, -1, -1),
    _case("second-order-linear", "second-order-linear", 1, 1, -1),
)
