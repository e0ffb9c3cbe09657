"""Standing up."""

from babybench_kit.experiments import MIMoStandupEnv

__all__ = ["MIMoStandupEnv"]
