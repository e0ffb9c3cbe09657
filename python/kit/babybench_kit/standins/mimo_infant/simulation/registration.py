"""The ids of MIMo 3's environments."""

from babybench_kit.third.registration import register_mimo_envs, safe_register

__all__ = ["register_mimo_envs", "safe_register"]
