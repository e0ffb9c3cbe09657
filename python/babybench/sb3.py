"""Stable-Baselines3: :class:`VecEnv` is many environments at once, and :func:`sparse` lets PPO learn faster from a whole skin."""

from babybench_core.sb3 import VecEnv, sparse

__all__ = ["VecEnv", "sparse"]
