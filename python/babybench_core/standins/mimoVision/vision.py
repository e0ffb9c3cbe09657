"""MIMo's vision."""

from babybench_core.mimo.senses import SimpleVision, Vision

__all__ = ["SimpleVision", "Vision"]
