"""Fixtures that tests of several files share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import babybench

if TYPE_CHECKING:
    from kit_scripts import Make

SMALL: dict[str, object] = {
    "behavior": "self_touch",
    "scene": "crib",
    "vision_active": False,
    "touch_scale": 2.0,
    "max_episode_steps": 6,
}
"""A configuration that is quick to build and to step."""

SEEING: dict[str, object] = {
    "behavior": "hand_regard",
    "scene": "cubes",
    "vision_resolution": 16,
    "touch_active": False,
    "render_size": 48,
    "max_episode_steps": 4,
}
"""A configuration with eyes."""


@pytest.fixture
def env() -> babybench.Env:
    """An environment that has been reset."""
    env = babybench.Env(SMALL)
    env.action_space.seed(1)
    env.reset(seed=0)
    return env


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Makes an environment as scripts for the starter kit do, with changes of the configuration."""
    from kit_scripts import maker  # needs babybench-kit, which most tests do without

    return maker(tmp_path / "run")
