"""MIMo's muscles."""

from babybench_kit.actuation import MuscleModel

__all__ = ["MuscleModel"]
