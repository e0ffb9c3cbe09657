"""MIMo 3's vision."""

from babybench_kit.third.vision import SimpleVision, Vision

__all__ = ["SimpleVision", "Vision"]
