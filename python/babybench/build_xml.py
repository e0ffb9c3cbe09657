"""Builds the document of a scene."""

from babybench_core.mimo.build_xml import build

__all__ = ["build"]
