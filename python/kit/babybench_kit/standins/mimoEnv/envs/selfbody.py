"""Touching a part of the body."""

from babybench_kit.experiments import MIMoSelfBodyEnv

__all__ = ["MIMoSelfBodyEnv"]
