"""The ids of the kit's environments, and their attributes through wrappers."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from . import experiments

IDS = {
    "BabyBench": "BabyBenchEnv",
    "BabyBench-SelfTouch": "BabyBenchSelfTouchEnv",
    "BabyBench-HandRegard": "BabyBenchHandRegardEnv",
}
"""Ids of the environments, with their classes."""


def _forwarded(self: gym.Wrapper[Any, Any, Any, Any], name: str) -> Any:
    """Returns an attribute of what is wrapped, if that is one of MIMo's environments in the end."""
    env = self.__dict__.get("env")
    if env is None or name.startswith("_") or not getattr(env.unwrapped, "_forwards_attributes", False):
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
    return getattr(env, name)


def forward_attributes() -> None:
    """Lets wrappers show the attributes of MIMo's environments, as all wrappers did before Gymnasium 1.

    Scripts for the kit say ``env.touch`` and, in wrappers of their own, ``self.model``. Other environments are as before.
    """
    if not hasattr(gym.Wrapper, "__getattr__"):
        gym.Wrapper.__getattr__ = _forwarded  # type: ignore[attr-defined]


def register_kit() -> None:
    """Registers the ids of the kit with Gymnasium."""
    forward_attributes()
    for name, cls in IDS.items():
        # a seed alone does not decide how an episode starts: see MIMoEnv.reset
        entry_point = f"babybench_kit.env:{cls}"
        gym.register(id=name, entry_point=entry_point, max_episode_steps=1000, nondeterministic=True)
    for name, (experiment, steps) in experiments.IDS.items():
        entry_point = f"{experiments.__name__}:{experiment.__name__}"
        gym.register(id=name, entry_point=entry_point, max_episode_steps=steps, disable_env_checker=True)
    for name in experiments.ELSEWHERE:
        gym.register(id=name, entry_point=f"{experiments.__name__}:refuse", kwargs={"experiment": name})
