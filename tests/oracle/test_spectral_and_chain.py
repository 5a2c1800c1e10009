"""Two simulators that share the description of the tow only: sines about a static shape, and a nonlinear chain."""

from dataclasses import replace

import numpy as np
import pytest

from ident.configuration import load
from ident.truth import identification_ship, reference_run
from models import link_joint
from models.trace import Trace


@pytest.mark.parametrize("name", ["mangus-740", "autec-1200", "mangus-2500"])
def test_they_agree_where_deflections_are_small_and_part_where_they_are_not(name: str) -> None:
    """On the standard input scaled to 0.25, 0.5 and 1 m/s; slope, and with it the share, grows with speed squared."""
    own = load(name)
    given = identification_ship(replace(own, input=replace(own.input, duration=1800.0)), 0)
    apart, share = [], []
    for scale in (0.5, 1.0, 2.0):
        ship = Trace(t=given.t, position=scale * given.position)
        chain = link_joint.simulate(own.system, ship, links=120, tolerance=2e-5, start="rest").vehicle
        spectral = reference_run(own, ship, tolerance=2e-5).vehicle
        difference = (chain.rates() - spectral.rates())[:, 0]
        apart.append(float(np.sqrt(np.mean(difference**2))))
        share.append(apart[-1] / float(np.sqrt(np.mean(chain.rates()[:, 0] ** 2))))
    assert apart[0] < 4e-5
    assert 5e-5 < apart[1] < 5e-4
    assert 6.0 < share[2] / share[1] < 20.0
