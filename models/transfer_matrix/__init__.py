"""Motions and tensions of a tow under small motions of the cable's top, in the frequency domain (H)."""

from models.transfer_matrix.response import Response, Solver, frequency_response, product_digits
from models.transfer_matrix.sea import SEA_QUANTITIES, SeaResponse, sea_response
from models.transfer_matrix.setup import COARSE, Compensator, Direction, DragForm, UniformDamping

__all__ = [
    "COARSE",
    "SEA_QUANTITIES",
    "Compensator",
    "Direction",
    "DragForm",
    "Response",
    "SeaResponse",
    "Solver",
    "UniformDamping",
    "frequency_response",
    "product_digits",
    "sea_response",
]
