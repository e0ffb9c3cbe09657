"""Catching a ball."""

from babybench_kit.experiments import MIMoCatchEnv

__all__ = ["MIMoCatchEnv"]
