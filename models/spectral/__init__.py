"""Spectral reference simulator (T chapter 2): a sine series about the static shape, with quadratic drag."""

from models.payout import Payout
from models.spectral.simulation import STEPPERS, SpectralResult, Stepper, initial_speed, simulate
from models.spectral.winch import DepthWinch, Winch

__all__ = ["STEPPERS", "DepthWinch", "Payout", "SpectralResult", "Stepper", "Winch", "initial_speed", "simulate"]
