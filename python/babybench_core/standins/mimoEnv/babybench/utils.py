"""Angles between vectors."""

from babybench_core.mimo.utils import angle_between_vector_and_rotation, angle_between_vectors

__all__ = ["angle_between_vector_and_rotation", "angle_between_vectors"]
