"""Reaching for a ball."""

from babybench_kit.experiments import MIMoReachEnv

__all__ = ["MIMoReachEnv"]
