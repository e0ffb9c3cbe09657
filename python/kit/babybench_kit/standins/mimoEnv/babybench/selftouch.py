"""The environment of self-touch."""

from babybench_kit.env import DEFAULT_SIZE, BabyBenchEnv, BabyBenchSelfTouchEnv

__all__ = ["DEFAULT_SIZE", "BabyBenchEnv", "BabyBenchSelfTouchEnv"]
