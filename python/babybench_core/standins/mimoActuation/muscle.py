"""MIMo's muscles."""

from babybench_core.mimo.actuation import MuscleModel

__all__ = ["MuscleModel"]
