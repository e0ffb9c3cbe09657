"""Catching a ball."""

from babybench_core.mimo.experiments import MIMoCatchEnv

__all__ = ["MIMoCatchEnv"]
