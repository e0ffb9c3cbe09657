"""Copies of scenes."""

from babybench_kit.growth import delete_growth_scene

__all__ = ["delete_growth_scene"]
