"""Runs CleanRL's script for continuous actions, unchanged, with MIMo: he is rewarded for touches that are new in the episode.

CleanRL's scripts make environments by a Gymnasium name and flatten their observations; this file registers such a
name and starts the script that it is given::

    python cleanrl_selftouch.py cleanrl/ppo_continuous_action.py --total-timesteps 20000 --num-envs 8 --num-steps 256

The reward that the learner gets is a wrapper of three lines: change it, and it is another experiment. Needs what the script needs
(PyTorch, tensorboard; CleanRL 1.2 wants Gymnasium 0.28).
"""

from __future__ import annotations

import runpy
import sys
from typing import Any

import gymnasium
import numpy as np

import babybench

NAME = "babybench/SelfTouchNovelty-v0"


class Novelty(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Proprioception and touch, with a reward for each sensor that feels something for the first time in the episode."""

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        """Starts an episode without touches."""
        observation, info = self.env.reset(**options)
        self._known = observation["touch"] != 0
        return observation, info

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Rewards new touches."""
        observation, _, terminated, truncated, info = self.env.step(action)
        touched = observation["touch"] != 0
        new = int(np.sum(touched & ~self._known))
        self._known |= touched
        # what a script prints is the sum of these; lists of touched parts would only cost time
        return observation, 0.1 * new, terminated, truncated, {"steps": info["steps"]}


def make(render_mode: str | None = None, **_: Any) -> gymnasium.Env[Any, Any]:
    """Makes the environment: a skin of half the density, which a small network can read."""
    env = babybench.make(
        "self_touch", render_mode=render_mode, touch_function="normal", touch_scale=2.0, vision_active=False
    )
    return Novelty(env)


def main() -> None:
    """Starts the script."""
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(str(__doc__))
    gymnasium.register(NAME, entry_point=make, max_episode_steps=200)
    script = sys.argv[1]
    sys.argv = [script, "--env-id", NAME, *sys.argv[2:]]
    runpy.run_path(script, run_name="__main__")


if __name__ == "__main__":
    main()
