"""What many tests share: the built-in configurations, H Table II with its towfish, and the continuum solutions."""

import importlib.util
import math
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest

from ident.configuration import load
from models.cable import Cable
from models.tow import Tow
from models.vehicle import Towfish


@pytest.fixture(scope="session")
def configurations() -> Callable[[str], Tow]:
    """The tow of a built-in configuration, by name."""
    return cache(lambda name: load(name).tow)


@pytest.fixture(scope="session")
def continuum() -> ModuleType:
    """The module of continuum solutions; tests are no package, so it is loaded from its file."""
    spec = importlib.util.spec_from_file_location("continuum", Path(__file__).parent / "oracle" / "continuum.py")
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules["continuum"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def table_two() -> Tow:
    """H Table II: 4000 m of cable and a towfish."""
    diameter = 0.0173
    return Tow(
        cable=Cable(
            length=4000.0,
            diameter=diameter,
            mass=1.04,
            weight_in_water=8.14,
            added_mass=0.20,
            axial_stiffness=42e9 * 0.25 * math.pi * diameter**2,
            normal_drag_coefficient=1.6,
            tangential_drag_coefficient=0.01,
        ),
        vehicle=Towfish(
            weight=3920.0,
            buoyancy=780.0,
            mass=400.0,
            added_mass_p=500.0,
            added_mass_q=500.0,
            inertia=280.0,
            drag_coefficient=2.0,
            area_p=0.25,
            area_q=1.0,
            length=2.0,
            added_mass_centre_p=-0.05,
            buoyancy_centre_q=0.02,
            tow_point_q=0.8,
            drag_centre_p=-0.05,
        ),
    )
