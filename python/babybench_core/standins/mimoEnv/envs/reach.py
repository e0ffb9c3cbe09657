"""Reaching for a ball."""

from babybench_core.mimo.experiments import MIMoReachEnv

__all__ = ["MIMoReachEnv"]
