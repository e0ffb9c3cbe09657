"""Standing up."""

from babybench_core.mimo.experiments import MIMoStandupEnv

__all__ = ["MIMoStandupEnv"]
