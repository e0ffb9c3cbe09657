"""The names under which Gymnasium finds the environments."""

from __future__ import annotations

from typing import Any

import gymnasium

from babybench_core._native import config_examples

IDS = {
    "babybench/SelfTouch-v0": "self_touch",
    "babybench/HandRegard-v0": "hand_regard",
    "babybench/Installation-v0": "test_installation",
    "babybench/Reach-v0": "reach",
    "babybench/Standup-v0": "standup",
    "babybench/SelfBody-v0": "selfbody",
    "babybench/Catch-v0": "catch",
    "babybench/RollOver-v0": "roll_over",
    "babybench/Mobile-v0": "mobile",
    "babybench/Play-v0": "play",
}
"""Gymnasium's names of the example configurations."""


def register() -> None:
    """Registers the names with Gymnasium, once."""
    vectors = "vector_entry_point" in gymnasium.envs.registration.EnvSpec.__dataclass_fields__
    examples = config_examples()
    for name, example in IDS.items():
        if name in gymnasium.registry:
            continue
        more: dict[str, Any] = {"vector_entry_point": "babybench_core.vector:VectorEnv"} if vectors else {}
        gymnasium.register(
            name,
            entry_point="babybench_core.env:Env",
            kwargs={"config": example},
            max_episode_steps=examples[example]["max_episode_steps"],
            disable_env_checker=True,  # checked in the tests, not with every environment
            **more,
        )
