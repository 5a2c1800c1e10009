"""A tow like that of the thesis at 1200 m, and the standard input."""

from collections.abc import Callable

import numpy as np
import pytest

from data_synth.ships import StandardInput, standard_input
from ident.configuration import load
from models.reduced import ReducedModel, section
from models.statics import static_shape
from models.trace import Trace

TOW = load("autec-1200").tow


@pytest.fixture(scope="session")
def mapped() -> Callable[[str], ReducedModel]:
    """The first guess of a model by its name."""
    shape = static_shape(TOW)
    return lambda name: section(name, TOW, shape)


@pytest.fixture(scope="session")
def ship() -> Trace:
    """The standard input of seed 0."""
    return standard_input(StandardInput(), np.random.default_rng(0))
