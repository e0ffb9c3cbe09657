"""MIMo's environments."""

from babybench_core.mimo.env import MIMoEnv
from babybench_core.mimo.registration import missing_env

__all__ = ["MIMoEnv"]


def __getattr__(name: str) -> object:
    return missing_env(name)
