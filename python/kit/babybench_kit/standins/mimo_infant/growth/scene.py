"""The documents of grown scenes."""

from babybench_kit.third.growth import create_growth_scene, delete_growth_scene

__all__ = ["create_growth_scene", "delete_growth_scene"]
