"""Functions that tests of the starter kit's interface share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import babybench.utils as bb_utils

CONFIG: dict[str, Any] = {
    "behavior": "self_touch",
    "scene": "crib",
    "max_episode_steps": 8,
    "frame_skip": 1,
    "render_size": 48,
    "save_logs_every": 4,
    "vestibular_active": True,
    "vision_active": False,
    "vision_resolution": 16,
    "touch_active": True,
    "touch_scale": 2.0,
    "touch_function": "force_vector",
    "touch_response": "spread_linear",
    "actuation_model": "spring_damper",
    **{
        f"{what}_{part}": True
        for what in ("touch", "act")
        for part in ("hands", "fingers", "arms", "feet", "legs", "body", "head")
    },
    "touch_eyes": False,
    "act_eyes": False,
    **{f"lock_{part}": False for part in ("hands", "fingers", "arms", "feet", "legs", "body", "head", "eyes")},
}

Make = Callable[..., Any]


def maker(save_dir: Path) -> Make:
    """Returns what makes an environment as scripts do, with changes of the configuration."""

    def made(training: bool = True, **changes: Any) -> Any:
        config = {**CONFIG, "save_dir": str(save_dir), **changes}
        env = bb_utils.make_env(config, training=training)
        env.action_space.seed(5)
        return env

    return made


def steps(env: Any, count: int) -> list[Any]:
    """Takes random actions and returns what each step returned."""
    return [env.step(env.action_space.sample()) for _ in range(count)]
