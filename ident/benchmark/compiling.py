"""What compiling costs where no machine code is kept: the first call less the second one, in a process of its own."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from ident.configuration import load
from models import link_joint, reduced
from models.spectral import simulate
from models.statics import static_shape
from models.towed_system import TowedSystem
from models.trace import Trace
from models.transfer_matrix import frequency_response

#: What the calls are made on; what the compiler is started for, and what all of it takes on two cores [s].
_TOW, _WORKERS, TAKES = "autec-1200", 2, 45.0
#: How the reduced models are called together.
REDUCED = "reduced models"


def _straight() -> Trace:
    t = np.arange(0.0, 11.0)
    return Trace.along_x(t, 0.01 * t * t)


def _chain() -> None:
    link_joint.simulate(TowedSystem.from_tow(load(_TOW).tow), _straight(), links=8, companion=False)


def _spectral() -> None:
    simulate(load(_TOW).tow, _straight(), harmonics=4, companion=False)


def _matrix() -> None:
    frequency_response(load(_TOW).tow, [0.1, 0.2], segments=16, companion=False)


def _reduced() -> None:
    tow, ship = load(_TOW).tow, _straight()
    shape = static_shape(tow)
    for name in reduced.MODEL_NAMES:
        reduced.simulate(reduced.section(name, tow, shape), ship)


#: By method: the chain in a plane, the spectral simulator by its usual stepper, the reduced models all together.
METHODS: dict[str, Callable[[], None]] = {
    "link-joint": _chain,
    "spectral": _spectral,
    "matrix": _matrix,
    REDUCED: _reduced,
}


def first_call(method: str) -> float:
    """CPU time of the first call less that of the second [s]: nothing where the machine code was kept."""
    taken = []
    for _ in range(2):
        began = time.process_time()
        METHODS[method]()
        taken.append(time.process_time() - began)
    return max(0.0, taken[0] - taken[1])


def compiled_anew() -> dict[str, float]:
    """CPU time of compiling [s] by method, where no machine code is kept."""
    with ThreadPoolExecutor(_WORKERS) as pool:
        return dict(zip(METHODS, pool.map(_in_new_process, METHODS), strict=True))


def _in_new_process(method: str) -> float:
    program = f"from ident.benchmark.compiling import first_call\nprint(first_call({method!r}))\n"
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"NUMBA_CACHE_DIR": folder, "PYTHONPATH": os.pathsep.join(sys.path)}
        run = subprocess.run(
            [sys.executable, "-c", program], env=environment, check=True, capture_output=True, text=True
        )
    return float(run.stdout)
