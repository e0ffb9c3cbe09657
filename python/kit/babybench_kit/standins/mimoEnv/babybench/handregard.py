"""The environment of hand regard."""

from babybench_kit.env import DEFAULT_SIZE, BabyBenchEnv, BabyBenchHandRegardEnv

__all__ = ["DEFAULT_SIZE", "BabyBenchEnv", "BabyBenchHandRegardEnv"]
