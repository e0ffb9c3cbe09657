"""MIMo without a task, which this package has under other names."""

from babybench_kit.experiments import missing


def __getattr__(name: str) -> object:
    return missing(__name__, name)
