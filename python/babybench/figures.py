"""Figures for papers: see :func:`learning_curves`, :func:`touch_on_body` and :func:`touch_raster`."""

from babybench_core.figures import benchmark_bars, learning_curves, save, touch_on_body, touch_raster

__all__ = ["benchmark_bars", "learning_curves", "save", "touch_on_body", "touch_raster"]
