"""The formulas of growth."""

from babybench_kit.third.growth import calc_volume, growth_function, mj_unit

__all__ = ["calc_volume", "growth_function", "mj_unit"]
