"""The environments of BabyBench."""

from babybench_core.mimo.env import BabyBenchEnv, BabyBenchHandRegardEnv, BabyBenchSelfTouchEnv

__all__ = ["BabyBenchEnv", "BabyBenchHandRegardEnv", "BabyBenchSelfTouchEnv"]
