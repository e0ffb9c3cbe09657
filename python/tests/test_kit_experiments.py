"""MIMo's own experiments, by their ids and by their classes."""

from __future__ import annotations

import copy
import importlib
import pickle

import gymnasium as gym
import numpy as np
import pytest

import babybench
import mimoEnv

TASKS = {"Reach": "reach", "Standup": "standup", "SelfBody": "selfbody", "Catch": "catch"}


@pytest.mark.parametrize(("name", "task"), TASKS.items())
def test_an_experiment_is_the_task(name: str, task: str) -> None:
    assert mimoEnv
    env = gym.make(f"MIMo{name}-v0", frame_skip=1)
    alone = babybench.make(task, frame_skip=1)
    assert env.spec is not None
    assert env.spec.max_episode_steps == env.unwrapped.config["max_episode_steps"] == alone.config["max_episode_steps"]
    assert {k: v for k, v in env.unwrapped.config.items() if k != "save_dir"} == {
        k: v for k, v in alone.config.items() if k != "save_dir"
    }
    a, b = env.reset(seed=3)[0], alone.reset(seed=3)[0]
    assert a.keys() == b.keys()
    alone.action_space.seed(1)
    for _ in range(3):
        action = alone.action_space.sample()
        a, b = env.step(action)[0], alone.step(action)[0]
    assert all(np.array_equal(a[key], b[key]) for key in b)
    again = copy.deepcopy(env.unwrapped), pickle.loads(pickle.dumps(env.unwrapped))
    for other in again:
        assert type(other) is type(env.unwrapped)
        assert np.array_equal(other.array("qpos"), env.unwrapped.array("qpos"))


def test_classes_are_where_mimo_has_them() -> None:
    for name, task in TASKS.items():
        module = importlib.import_module(f"mimoEnv.envs.{task}")
        cls = getattr(module, f"MIMo{name}Env")
        assert getattr(importlib.import_module("mimoEnv.envs"), cls.__name__) is cls
        assert cls.task == task


def test_what_would_be_ignored_is_refused() -> None:
    from mimoEnv.envs.reach import MIMoReachEnv

    with pytest.raises(TypeError, match=r"touch_params of MIMo's constructor .*touch_active"):
        gym.make("MIMoReach-v0", touch_params=None)
    with pytest.raises(TypeError, match=r"Mine: a task runs in the engine.*BABYBENCH_MIMO=original"):
        type("Mine", (MIMoReachEnv,), {"compute_reward": lambda *_: 1.0, "__module__": "mine"})


def test_the_others_name_what_to_use() -> None:
    from babybench_kit.experiments import ELSEWHERE

    for name in ELSEWHERE:
        with pytest.raises(NotImplementedError, match=rf"{name} is not part of babybench: .*make\("):
            gym.make(name)
    for module in ("mimoEnv.envs", "mimoEnv.envs.dummy", "mimoEnv.envs.muscle_test"):
        with pytest.raises(ImportError, match=r"MIMoDummyEnv is not part of babybench: .*make\("):
            importlib.import_module(module).MIMoDummyEnv  # noqa: B018
        with pytest.raises(AttributeError, match="no attribute 'Other'"):
            importlib.import_module(module).Other  # noqa: B018
