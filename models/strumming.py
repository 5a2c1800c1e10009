"""The mean drag of a cable that strums: vortices shed from it shake it across the flow, and its drag rises.

Symbols: SG response parameter; St Strouhal number; m_t mass per length with the added mass [kg/m]; zeta structural
damping ratio; Y amplitude across the flow [m].

    SG = 2 pi St^2 (2 m_t (2 pi zeta))/(rho d^2),  Y/d = 1.29/(1 + 0.43 SG)^3.35,
    C_D/C_D0 = 1 + 1.043 (2 Y_rms/d)^0.65,         Y_rms = Y/sqrt(2).

SG is the parameter of Skop and Griffin; the amplitude is the fit of Griffin and Ramberg, Some recent studies of vortex
shedding with application to marine tubulars and risers, J. Energy Resources Technology 104 (1982), with a shape factor
of 1; the drag is that of Vandiver, Drag coefficients of long flexible cylinders, OTC 4490 (1983). All hold for a cable
that strums at one frequency along its whole length: where the flow across it varies, the drag is overstated.
"""

import math

from models.cable import Cable

#: Strouhal number of a cylinder below the critical Reynolds number, about 2e5.
STROUHAL = 0.2


def amplification(cable: Cable, water_density: float, damping: float) -> float:
    """C_D/C_D0 of the normal drag, at least 1; `damping` is the structural damping ratio zeta."""
    m_t = cable.mass + cable.added_mass
    SG = 2.0 * math.pi * STROUHAL**2 * 2.0 * m_t * 2.0 * math.pi * damping / (water_density * cable.diameter**2)
    Y_rms = 1.29 / math.pow(1.0 + 0.43 * SG, 3.35) / math.sqrt(2.0)
    return 1.0 + 1.043 * math.pow(2.0 * Y_rms, 0.65)


def strouhal_frequency(cable: Cable, speed: float) -> float:
    """Frequency [Hz] at which vortices leave the cable, St V_n/d; `speed` [m/s] is the flow across the cable."""
    return STROUHAL * abs(speed) / cable.diameter
