"""Tableaux of the implicit steppers: explicit first stage, one diagonal, and the last stage is the step's end.

The default is the implicit part of ARK3(2)4L[2]SA of Kennedy and Carpenter, Applied Numerical Mathematics 44 (2003)
139-181: order 3, L-stable, all stages of order 2, with an embedded solution of order 2.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_GAMMA = 1767732205903.0 / 4055673282236.0
STAGES = np.array(
    [
        [0.0, 0.0, 0.0, 0.0],
        [_GAMMA, _GAMMA, 0.0, 0.0],
        [2746238789719.0 / 10658868560708.0, -640167445237.0 / 6845629431997.0, _GAMMA, 0.0],
        [
            1471266399579.0 / 7840856788654.0,
            -4482444167858.0 / 7529755066697.0,
            11266239266428.0 / 11593286722821.0,
            _GAMMA,
        ],
    ]
)
EMBEDDED = np.array(
    [
        2756255671327.0 / 12835298489170.0,
        -10771552573575.0 / 22201958757719.0,
        9247589265047.0 / 10645013368117.0,
        2193209047091.0 / 5459859503100.0,
    ]
)
NODES = STAGES.sum(axis=1)
#: Weights of the embedded error, of third order in the step.
DEFECT = STAGES[-1] - EMBEDDED
ORDER = 3.0
#: Newmark's average acceleration: the trapezoidal rule.
AVERAGE = np.array([[0.0, 0.0], [0.5, 0.5]])
ENDS = np.array([0.0, 1.0])
