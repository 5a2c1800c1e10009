"""What the defaults of the three simulators ask for, what they estimate, and what they err by against finer runs."""

from dataclasses import dataclass, replace

import numpy as np

from ident.benchmark import transfer_bench
from ident.benchmark.chain_bench import FINER, TIGHTER, worst_error
from ident.benchmark.spectral_bench import error_of
from ident.configuration import Configuration
from models import link_joint
from models.spectral import SpectralResult, simulate
from models.towed_system import TowedSystem
from models.trace import Trace
from models.transfer_matrix import frequency_response
from models.transfer_matrix.response import QUANTITIES

#: Frequencies that the matrix method is checked at, and share of the largest amplitude that its own mesh may err by.
FREQUENCIES, SHARE = 25, 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """What a simulator's default asks for, estimates, and errs by against a finer run; in m/s, or a share."""

    simulator: str
    unit: str
    asked: float
    estimated: float
    found: float

    @property
    def met(self) -> bool:
        """Whether the error is as asked."""
        return self.found <= self.asked


def kept(configuration: Configuration, ship: Trace, converged: SpectralResult, short: Trace) -> list[Kept]:
    """The spectral simulator on `ship`, against its `converged` run there; the chain on `short`, the matrix method.

    Raises
    ------
    NumericalFailure
        A simulator does not reach what its default asks for.
    """
    return [_spectral(configuration, ship, converged), _chain(configuration, short), _matrix(configuration)]


def _spectral(configuration: Configuration, ship: Trace, converged: SpectralResult) -> Kept:
    asked = configuration.spectral.tolerance
    run = simulate(configuration.tow, ship, tolerance=asked)
    assert run.error is not None
    return Kept(simulator="spectral", unit="m/s", asked=asked, estimated=run.error, found=error_of(run, converged))


def _chain(configuration: Configuration, ship: Trace) -> Kept:
    system, asked = TowedSystem.from_tow(configuration.tow), configuration.link_joint.tolerance
    run = link_joint.simulate(system, ship, tolerance=asked)
    assert run.error is not None
    links = FINER * run.links[0]
    finer = link_joint.simulate(system, ship, links=links, tolerance=TIGHTER * asked, companion=False)
    return Kept(simulator="link-joint", unit="m/s", asked=asked, estimated=run.error, found=worst_error(run, finer))


def _matrix(configuration: Configuration) -> Kept:
    omega = transfer_bench.frequencies(FREQUENCIES)
    run = frequency_response(configuration.tow, omega)
    finer = frequency_response(configuration.tow, omega, segments=FINER * (run.shape.s.size - 1), companion=False)
    apart = {name: np.abs(getattr(run, name) - getattr(finer, name)) for name in QUANTITIES}
    return Kept(
        simulator="matrix",
        unit="of the largest amplitude",
        asked=SHARE,
        estimated=max(run.shares.values()),
        found=max(replace(finer, error=apart).shares.values()),
    )
