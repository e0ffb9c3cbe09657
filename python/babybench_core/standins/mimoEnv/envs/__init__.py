"""MIMo's environments."""

from babybench_core.mimo.env import MIMoEnv
from babybench_core.mimo.experiments import MIMoCatchEnv, MIMoReachEnv, MIMoSelfBodyEnv, MIMoStandupEnv, missing

__all__ = ["MIMoCatchEnv", "MIMoEnv", "MIMoReachEnv", "MIMoSelfBodyEnv", "MIMoStandupEnv"]


def __getattr__(name: str) -> object:
    return missing(__name__, name)
