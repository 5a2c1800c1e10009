"""What an acoustic fix says of the vehicle, and how velocity is read from fixes."""

from data_synth.sensors.differentiator import Differentiator, differentiator
from data_synth.sensors.fixes import SensorModel, measure
from data_synth.sensors.usbl_smoother import UsblSmoother, usbl_smoother

__all__ = ["Differentiator", "SensorModel", "UsblSmoother", "differentiator", "measure", "usbl_smoother"]
