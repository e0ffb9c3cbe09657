"""The ids of the kit's environments, and their attributes through wrappers."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from .assets import scene_path

IDS = {
    "BabyBench": "BabyBenchEnv",
    "BabyBench-SelfTouch": "BabyBenchSelfTouchEnv",
    "BabyBench-HandRegard": "BabyBenchHandRegardEnv",
}
"""Ids of the environments, with their classes."""

MIMO_IDS: dict[str, tuple[str, int | None]] = {
    "MIMoBench-v0": ("MIMoDummyEnv", 6000),
    "MIMoBenchV2-v0": ("MIMoV2DummyEnv", 6000),
    "MIMoShowroom-v0": ("MIMoV2DummyEnv", 500),
    "MIMoReach-v0": ("MIMoReachEnv", 1000),
    "MIMoStandup-v0": ("MIMoStandupEnv", 500),
    "MIMoSelfBody-v0": ("MIMoSelfBodyEnv", 500),
    "MIMoCatch-v0": ("MIMoCatchEnv", 800),
    "MIMoMuscle-v0": ("MIMoMuscleDummyEnv", 6000),
    "MIMoMuscleStaticTest-v0": ("MIMoStaticMuscleTestEnv", 5000),
    "MIMoVelocityMuscleTest-v0": ("MIMoVelocityMuscleTestEnv", 3000),
    "MIMoMuscleStaticTestV2-v0": ("MIMoStaticMuscleTestV2Env", 5000),
    "MIMoVelocityMuscleTestV2-v0": ("MIMoVelocityMuscleTestV2Env", 3000),
    "MIMoComplianceTest-v0": ("MIMoComplianceEnv", None),
    "MIMoComplianceMuscleTest-v0": ("MIMoComplianceMuscleEnv", None),
}
"""Ids of MIMo's own environments, with their classes in ``mimoEnv.envs`` and the steps of an episode."""


def _forwarded(self: gym.Wrapper[Any, Any, Any, Any], name: str) -> Any:
    """Returns an attribute of the innermost wrapped environment, if that is one of MIMo's."""
    env = self.__dict__.get("env")
    if env is None or name.startswith("_") or not getattr(env.unwrapped, "_forwards_attributes", False):
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
    return getattr(env, name)


def forward_attributes() -> None:
    """Makes wrappers show the attributes of MIMo's environments, as all wrappers did before Gymnasium 1.

    Scripts for the kit use ``env.touch`` and, in wrappers of their own, ``self.model``. Other environments are unaffected.
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
    for name, (cls, steps) in MIMO_IDS.items():
        kwargs = {"model_path": scene_path("showroom.xml"), "render_mode": "human"} if name == "MIMoShowroom-v0" else {}
        entry_point = f"mimoEnv.envs:{cls}"
        if name in gym.registry and str(gym.registry[name].entry_point).startswith("mimo_infant."):
            del gym.registry[name]  # MIMo 2 has precedence, as when it is registered first
        gym.register(id=name, entry_point=entry_point, max_episode_steps=steps, kwargs=kwargs, nondeterministic=True)
