"""The link-joint simulator: a nonlinear three-dimensional chain of links, after W.

W is Wang, Gu and Huang, A Link Joint Model for Vibration Isolation of Multi Parts Towed Cable System.
"""

from models.link_joint.chain import build
from models.link_joint.gauss import accelerations
from models.link_joint.simulation import LinkJointResult, SlackEvent, simulate
from models.link_joint.steady import SteadyTow, steady_tow

__all__ = [
    "LinkJointResult",
    "SlackEvent",
    "SteadyTow",
    "accelerations",
    "build",
    "simulate",
    "steady_tow",
]
