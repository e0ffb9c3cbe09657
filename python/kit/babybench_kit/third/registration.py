"""The ids of MIMo 3's environments."""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from ..assets import scene_path
from ..registration import MIMO_IDS, forward_attributes

IDS: dict[str, tuple[str, int | None]] = {**MIMO_IDS, "MIMoRollOver-v0": ("MIMoRollOverEnv", 500)}
"""Ids with their classes in ``mimo_infant.simulation.envs`` and the steps of an episode."""


def safe_register(id: str, **kwargs: Any) -> None:
    """Registers an id with Gymnasium, unless it is registered already."""
    if id not in gym.envs.registry:
        gym.register(id=id, **kwargs)


def register_mimo_envs() -> None:
    """Registers the ids of MIMo 3's environments that are not registered."""
    forward_attributes()
    for name, (cls, steps) in IDS.items():
        kwargs = {"model_path": scene_path("showroom.xml", 3), "render_mode": "human"} if "Showroom" in name else {}
        safe_register(
            name,
            entry_point=f"mimo_infant.simulation.envs:{cls}",
            max_episode_steps=steps,
            kwargs=kwargs,
            nondeterministic=True,
        )
