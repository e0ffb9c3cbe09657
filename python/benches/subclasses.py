"""What a subclass of MIMo's environments costs in each step, beside the engine alone: ``python benches/subclasses.py [STEPS]``.

Three environments take the same actions in turn, so that all see the same machine: the engine's own calls for one step, a
subclass that replaces ``reset_model`` and ``compute_reward``, and one with a touch function of its own. Prints the medians, in
microseconds.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from mimoEnv.envs.dummy import MIMoDummyEnv
from mimoEnv.envs.mimo_env import DEFAULT_TOUCH_PARAMS
from mimoTouch.touch import TrimeshTouch

BLOCK = 20
"""Steps of one environment before the next one's turn."""


class Task(MIMoDummyEnv):
    """A task of a program's own."""

    def reset_model(self) -> Any:
        self.set_state(self.init_qpos, self.init_qvel)
        return self._get_obs()

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        return 1.0


class Pressure(TrimeshTouch):
    """A sense of a program's own, one number for each sensor."""

    VALID_TOUCH_TYPES = {**TrimeshTouch.VALID_TOUCH_TYPES, "pressure": 1}  # noqa: RUF012
    calls = 0
    spent = 0.0

    def pressure(self, contact_id: int, body_id: int) -> Any:
        started = time.perf_counter()
        felt = np.array([np.linalg.norm(self.get_raw_force(contact_id, body_id))])
        Pressure.spent += time.perf_counter() - started
        Pressure.calls += 1
        return felt


class FeelingTask(Task):
    """The same task with that sense."""

    def touch_setup(self, touch_params: dict[str, Any]) -> None:
        self.touch = Pressure(self, {**touch_params, "touch_function": "pressure"})


def engine_step(env: Any) -> Callable[[Any], object]:
    """Returns the engine's own calls for one step of an environment."""
    core, parts, frames = env._core, env._core.parts, env.frame_skip

    def step(action: Any) -> object:
        parts.set_action(action)
        for frame in range(frames):
            if frame:
                parts.substep()
            parts.physics_step()
        parts.observe()
        return core.observation()

    return step


def main(steps: int) -> None:
    """Measures, and prints."""
    settings = {"vision_params": None, "touch_params": DEFAULT_TOUCH_PARAMS}
    bare, task, feeling = Task(**settings), Task(**settings), FeelingTask(**settings)
    for env in (bare, task, feeling):
        env.reset(seed=0)
    calls = {"engine": engine_step(bare), "subclass": task.step, "own touch": feeling.step}
    actions = np.random.default_rng(0).uniform(-0.3, 0.3, (steps, *task.action_space.shape)).astype(np.float32)
    spent: dict[str, list[float]] = {name: [] for name in calls}
    for first in range(0, steps, BLOCK):
        for name, step in calls.items():
            for action in actions[first : first + BLOCK]:
                started = time.perf_counter()
                step(action)
                spent[name].append(time.perf_counter() - started)
    medians = {name: 1e6 * float(np.median(times)) for name, times in spent.items()}
    print("us a step (median)")
    for name, median in medians.items():
        print(f"{name:10} {median:7.0f}   {median - medians['engine']:+7.0f}")
    own = 1e6 * Pressure.spent / steps
    print(f"of own touch: {own:.0f} us in {Pressure.calls / steps:.1f} calls of the program's function")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2000)
