"""Angles between vectors."""

from babybench_kit.utils import angle_between_vector_and_rotation, angle_between_vectors

__all__ = ["angle_between_vector_and_rotation", "angle_between_vectors"]
