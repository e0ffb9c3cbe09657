"""MIMo 3's muscles."""

from babybench_kit.actuation import MuscleModel
from babybench_kit.muscle_parts import bump

__all__ = ["MuscleModel", "bump"]
