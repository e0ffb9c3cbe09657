"""Reaching for a ball."""

from babybench_kit.assets import written
from babybench_kit.tasks import reach
from babybench_kit.tasks.reach import MIMoReachEnv

__all__ = ["MIMoReachEnv"]

__getattr__ = written(__name__, {"REACH_XML": reach.REACH_XML})
