"""Many environments at once for Stable-Baselines3: see :class:`VecEnv`."""

from babybench_core.sb3 import VecEnv

__all__ = ["VecEnv"]
