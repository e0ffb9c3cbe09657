"""Tests of MIMo's muscles, which this package does not have."""

from babybench_kit.experiments import missing


def __getattr__(name: str) -> object:
    return missing(__name__, name)
