"""Gymnasium's checker, wrappers and vectors take the environments as they are."""

from __future__ import annotations

import copy
import pickle
import warnings

import gymnasium
import numpy as np
import pytest
from conftest import SMALL

import babybench
from babybench_core.registration import IDS as IDS_OF_ALL

IDS = ["babybench/SelfTouch-v0", "babybench/HandRegard-v0", "babybench/Installation-v0"]


@pytest.mark.parametrize("name", IDS)
def test_the_checker_finds_nothing(name, monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pytest.importorskip("pygame", reason="render_mode human needs pygame")
    from gymnasium.utils.env_checker import check_env

    env = gymnasium.make(name, render_size=64).unwrapped
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*infinity. This is probably too")  # of what has no bounds
        check_env(env)


def test_names_take_keywords_and_configurations(tmp_path):
    file = tmp_path / "my.yml"
    file.write_text("behavior: none\nscene: base\nvision_active: False\n", "utf-8")
    assert gymnasium.make(IDS[0], touch_scale=2.0).unwrapped.config["touch_scale"] == 2.0
    assert gymnasium.make(IDS[0], config=str(file)).unwrapped.config["scene"] == "base"
    env = gymnasium.make(IDS[1], render_mode="rgb_array", render_size=32)
    assert gymnasium.make(env.spec).unwrapped.config == env.unwrapped.config


def test_wrappers_go_around(tmp_path):
    from gymnasium import wrappers

    env = wrappers.RecordEpisodeStatistics(babybench.Env(SMALL))
    env.reset(seed=0)
    for _ in range(6):
        *_, info = env.step(env.action_space.sample())
    assert info["episode"]["l"] == 6
    limited = wrappers.TimeLimit(babybench.Env(SMALL), max_episode_steps=2)
    limited.reset(seed=0)
    assert [limited.step(limited.action_space.sample())[3] for _ in range(2)] == [False, True]
    flat = wrappers.FlattenObservation(babybench.Env(SMALL))
    observation, _ = flat.reset(seed=0)
    assert flat.observation_space.contains(observation)
    normal = wrappers.NormalizeObservation(flat)
    assert np.isfinite(normal.reset(seed=0)[0]).all()


def test_videos_are_recorded(tmp_path):
    pytest.importorskip("moviepy", reason="Gymnasium's videos need moviepy")
    from gymnasium.wrappers import RecordVideo

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # moviepy's and Gymnasium's own
        env = RecordVideo(babybench.Env({**SMALL, "render_size": 64}, render_mode="rgb_array"), str(tmp_path))
        env.reset(seed=0)
        for _ in range(6):
            env.step(env.action_space.sample())
        env.close()
    assert [file.suffix for file in tmp_path.glob("*.mp4")] == [".mp4"]


def make_small():
    return babybench.Env(SMALL)


@pytest.mark.parametrize("kind", ["AsyncVectorEnv", "SyncVectorEnv"])
def test_gymnasiums_own_vectors_hold_the_same_bits(kind):
    if kind == "AsyncVectorEnv":
        envs = gymnasium.vector.AsyncVectorEnv([make_small] * 2, context="spawn")
    else:
        envs = gymnasium.vector.SyncVectorEnv([make_small] * 2)
    ours = babybench.VectorEnv(SMALL, 2)
    try:
        a, b = envs.reset(seed=3)[0], ours.reset(seed=3)[0]
        for _ in range(3):
            for key in b:
                np.testing.assert_array_equal(a[key], b[key])
            actions = ours.action_space.sample()
            a, b = envs.step(actions)[0], ours.step(actions)[0]
    finally:
        envs.close()


def test_the_spaces_say_what_is_observed():
    env = babybench.make("test_installation", vision_resolution=8)
    kinds = {key: space.dtype.name for key, space in env.observation_space.items()}
    assert kinds == {
        "observation": "float64",
        "touch": "float32",
        "eye_left": "uint8",
        "eye_right": "uint8",
        "vestibular": "float64",
    }
    assert set(env.reset(seed=0)[0]) == set(kinds)


@pytest.mark.parametrize("actuation_model", ["spring_damper", "positional", "muscle"])
def test_action_spaces_draw_what_a_box_draws(actuation_model):
    space = babybench.Env(SMALL, actuation_model=actuation_model).action_space
    box = gymnasium.spaces.Box(space.low, space.high, space.shape, np.float32)
    assert space == box
    assert box == space
    assert repr(space) == repr(box)
    for other in (space, box):
        other.seed(3)
    for _ in range(100):
        sample = space.sample()
        assert sample.dtype == np.float32
        assert np.array_equal(sample, box.sample())
    copies = copy.deepcopy(space), pickle.loads(pickle.dumps(space))
    sample = space.sample()
    assert all(np.array_equal(other.sample(), sample) for other in copies)
    space.low[:] = space.high
    assert np.array_equal(space.sample(), space.high)
    with pytest.raises(gymnasium.error.Error, match="mask"):
        space.sample(mask=np.ones(3))


@pytest.mark.parametrize("name", sorted(IDS_OF_ALL))
def test_the_length_of_an_episode_is_known(name):
    spec = gymnasium.spec(name)
    assert spec.max_episode_steps == babybench.config_examples()[IDS_OF_ALL[name]]["max_episode_steps"]
    assert name in (babybench.__doc__ or "")
    assert IDS_OF_ALL[name] in (babybench.make.__doc__ or "")
