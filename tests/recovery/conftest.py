"""A tow like that of the thesis at 1200 m, and the standard input."""

from collections.abc import Callable

import numpy as np
import pytest

from data_synth.ships import StandardInput, standard_input
from models.cable import Cable
from models.reduced import ReducedModel, section
from models.statics import static_shape
from models.tow import Tow
from models.trace import Trace
from models.vehicle import Vehicle

TOW = Tow(
    cable=Cable.from_material(
        length=1200.0,
        diameter=0.0173,
        density=4400.0,
        young_modulus=6.2e10,
        water_density=1025.0,
        added_mass=0.24,
        normal_drag_coefficient=1.6,
        tangential_drag_coefficient=0.08,
    ),
    vehicle=Vehicle(weight_in_water=19170.0, mass=2240.0, added_mass=45.0, area=0.56, drag_coefficient=0.4),
)


@pytest.fixture(scope="session")
def mapped() -> Callable[[str], ReducedModel]:
    """The first guess of a model by its name."""
    shape = static_shape(TOW)
    return lambda name: section(name, TOW, shape)


@pytest.fixture(scope="session")
def ship() -> Trace:
    """The standard input of seed 0."""
    return standard_input(StandardInput(), np.random.default_rng(0))
