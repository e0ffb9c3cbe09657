"""Builds the document of a scene, for scripts for BabyBench's Python kit (``pip install "babybench[kit]"``)."""

from babybench_core.starter_kit import needed as _needed

with _needed(__name__):
    from babybench_kit.build_xml import build

__all__ = ["build"]
