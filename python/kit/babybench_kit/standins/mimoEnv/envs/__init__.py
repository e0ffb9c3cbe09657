"""MIMo's environments."""

from babybench_kit.env import MIMoEnv
from babybench_kit.experiments import MIMoCatchEnv, MIMoReachEnv, MIMoSelfBodyEnv, MIMoStandupEnv, missing

__all__ = ["MIMoCatchEnv", "MIMoEnv", "MIMoReachEnv", "MIMoSelfBodyEnv", "MIMoStandupEnv"]


def __getattr__(name: str) -> object:
    return missing(__name__, name)
