"""MIMo's vision."""

from babybench_kit.senses import SimpleVision, Vision

__all__ = ["SimpleVision", "Vision"]
