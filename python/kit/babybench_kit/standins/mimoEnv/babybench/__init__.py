"""The environments of BabyBench."""

from babybench_kit.env import BabyBenchEnv, BabyBenchHandRegardEnv, BabyBenchSelfTouchEnv

__all__ = ["BabyBenchEnv", "BabyBenchHandRegardEnv", "BabyBenchSelfTouchEnv"]
