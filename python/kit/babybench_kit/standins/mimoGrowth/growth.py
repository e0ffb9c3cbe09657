"""MIMo at an age, in a copy of a scene."""

from babybench_kit.growth import adjust_mimo_to_age, delete_growth_scene, get_version

__all__ = ["adjust_mimo_to_age", "delete_growth_scene", "get_version"]
