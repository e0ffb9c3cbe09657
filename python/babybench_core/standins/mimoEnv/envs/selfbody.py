"""Touching a part of the body."""

from babybench_core.mimo.experiments import MIMoSelfBodyEnv

__all__ = ["MIMoSelfBodyEnv"]
