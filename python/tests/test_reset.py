"""Resets: options, seeds, ages."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from conftest import SMALL

import babybench

GROWING = {**SMALL, "touch_active": True, "touch_grows": True, "age": 6}
MOON = [0.0, 0.0, -1.62]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"modle": {"opt.gravity": MOON}}, r"no such option .* did you mean `model`"),
        ({"opt.gravity": MOON}, "no such option"),
        ({"qpos": np.zeros(3)}, "there are age, model"),
        ({"Age": 3.0}, "did you mean `age`"),
        ({7: 1}, "no such option"),
    ],
)
def test_options_that_there_are_not_are_errors(options, message):
    env, envs = babybench.Env(SMALL), babybench.VectorEnv(SMALL, 2)
    with pytest.raises(ValueError, match=message):
        env.reset(seed=0, options=options)
    with pytest.raises(ValueError, match=message.replace("age, model", "age, model, reset_mask")):
        envs.reset(seed=0, options=options)
    for one in (env, envs):
        with pytest.raises(TypeError, match="expected a mapping"):
            one.reset(options=["model"])
        one.reset(seed=0, options={})


def test_a_misspelt_mask_is_an_error():
    envs = babybench.VectorEnv(SMALL, 2)
    with pytest.raises(ValueError, match="did you mean `reset_mask`"):
        envs.reset(options={"reset_msk": np.array([True, False])})


def test_an_age_makes_the_body_of_that_age():
    env, wanted = babybench.Env(GROWING), babybench.Env(GROWING, age=3)
    for change in (lambda: env.set_age(3), lambda: env.set_age(9) or env.reset(options={"age": 3})):
        change()
        a, b = env.reset(seed=4)[0], wanted.reset(seed=4)[0]
        for _ in range(4):
            assert a.keys() == b.keys()
            assert all(np.array_equal(a[key], b[key]) for key in a)
            action = np.full(env.action_space.shape, 0.3, np.float32)
            a, b = env.step(action)[0], wanted.step(action)[0]
        assert env.config["age"] == 3.0
        assert np.array_equal(env.array("body_mass"), wanted.array("body_mass"))
    env = babybench.Env(SMALL, age=3)
    env.set_age(None)
    env.reset(seed=0)
    assert np.array_equal(env.array("body_mass"), babybench.Env(SMALL).array("body_mass"))


def test_an_age_needs_a_reset_and_is_refused_where_it_is_none():
    env = babybench.Env(GROWING)
    env.reset(seed=0)
    mass = env.array("body_mass")
    with pytest.raises(ValueError, match="age"):
        env.set_age(99)
    assert np.array_equal(env.array("body_mass"), mass)
    env.step(env.action_space.sample())
    env.set_age(3)
    with pytest.raises(RuntimeError, match="reset"):
        env.step(env.action_space.sample())


def test_senses_follow_the_body():
    env = babybench.Env({**SMALL, "touch_active": True}, views=True)
    env.reset(seed=0)
    before = env.touch.sensors
    observation = env.reset(seed=0, options={"age": 1})[0]
    assert env.touch.sensors < before
    assert observation["touch"].shape == env.observation_space["touch"].shape
    assert env.observation_space.contains({key: np.array(value) for key, value in observation.items()})


def test_a_copy_of_a_grown_environment_is_as_old():
    env = babybench.Env(GROWING)
    env.reset(seed=0, options={"age": 3, "model": {"opt.gravity": MOON}})
    for other in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
        action = np.full(env.action_space.shape, 0.1, np.float32)
        assert np.array_equal(other.array("body_mass"), env.array("body_mass"))
        assert np.array_equal(other.array("opt.gravity"), MOON)
        a, b = copy.deepcopy(env).step(action)[0], other.step(action)[0]
        assert all(np.array_equal(a[key], b[key]) for key in a)


def test_environments_of_a_vector_have_their_own_ages():
    envs = babybench.VectorEnv(GROWING, 3)
    envs.reset(seed=0, options={"age": [1, 6, 12]})
    masses = [envs.array(env, "body_mass").sum() for env in range(3)]
    assert masses[0] < masses[2]
    assert [config["age"] for config in envs.configs] == [1.0, 6.0, 12.0]
    other = pickle.loads(pickle.dumps(envs))
    assert [other.array(env, "body_mass").sum() for env in range(3)] == masses
    envs.set_age(1, 1)
    envs.reset(seed=0, options={"reset_mask": np.array([False, True, False])})
    assert envs.array(1, "body_mass").sum() == masses[0]
    assert envs.call("set_age", 6) == (None, None, None)
    assert {config["age"] for config in envs.configs} == {6.0}
    with pytest.raises(ValueError, match="3"):
        envs.reset(options={"age": [1, 2]})


def test_ages_of_a_vector_keep_its_spaces():
    envs = babybench.VectorEnv({**SMALL, "touch_active": True}, 2)
    with pytest.raises(ValueError, match="touch"):
        envs.set_age(0, 1)
    envs.reset(seed=0)
    envs.step(envs.action_space.sample())


@pytest.mark.parametrize(
    ("seed", "error", "message"),
    [
        (-1, ValueError, "seed is -1, expected 0 to"),
        (2**64, ValueError, "expected 0 to"),
        (1.5, TypeError, "expected a whole number"),
        ("7", TypeError, "expected a whole number"),
    ],
)
def test_seeds_that_are_none_are_refused(seed, error, message):
    with pytest.raises(error, match=message):
        babybench.Env(SMALL).reset(seed=seed)


def test_numbers_of_numpy_are_seeds():
    a, b = babybench.Env(SMALL), babybench.Env(SMALL)
    first, second = a.reset(seed=np.int64(3))[0], b.reset(seed=3)[0]
    assert all(np.array_equal(first[key], second[key]) for key in first)


def test_what_has_no_bounds_says_so():
    gymnasium = pytest.importorskip("gymnasium")
    env = babybench.Env(SMALL, touch_active=True)
    space = env.observation_space["observation"]
    assert np.isneginf(space.low).all()
    assert np.isposinf(space.high).all()
    assert env.observation_space.contains(env.observation_space.sample())
    if not hasattr(gymnasium.wrappers, "RescaleObservation"):  # Gymnasium before 1.0
        return
    flat = gymnasium.wrappers.FlattenObservation(env)
    with pytest.raises((AssertionError, ValueError)):  # refused by Gymnasium, with its own words
        gymnasium.wrappers.RescaleObservation(flat, -1, 1)


def test_an_infant_who_grows():
    """The age follows the schedule at resets and restored snapshots, in one environment and by row."""
    keys = {"vision_active": False, "touch_grows": True, "touch_scale": 3.0, "max_episode_steps": 4}
    env = babybench.make("self_touch", age={0: 1, 8: 3}, **keys)
    assert env.config["age_schedule"] == "0: 1, 8: 3"
    spaces = env.observation_space
    action = np.zeros(env.action_space.shape, np.float32)
    ages, sizes = [], []
    for seed in range(4):
        observation, info = env.reset(seed=seed)
        assert spaces.contains(observation)
        assert env.config["age"] == info["age"]
        ages.append(info["age"])
        sizes.append(env.array("body_mass").sum())
        if seed == 0:
            snapshot = env.snapshot()
        for _ in range(4):
            assert env.step(action)[4]["age"] == ages[-1]
    assert ages == [1, 2, 3, 3]
    assert sizes[0] < sizes[1] < sizes[2] == sizes[3]
    env.restore(snapshot)
    assert env.config["age"] == 1
    with pytest.raises(ValueError, match="age_schedule"):
        env.set_age(5)
    with pytest.raises(ValueError, match="touch_grows"):
        babybench.make("self_touch", age={0: 1, 8: 3})
    with pytest.raises(ValueError, match="rising steps"):
        babybench.make("self_touch", age={5: 1}, **keys)

    envs = babybench.VectorEnv({**babybench.config_examples()["self_touch"], **keys, "age": {0: 1, 8: 3}}, 2)
    infos = envs.reset(seed=0)[1]
    for _ in range(10):
        np.testing.assert_array_equal(infos["age"], infos["age"][0])
        infos = envs.step(np.zeros(envs.action_space.shape, np.float32))[4]
    assert infos["age"].tolist() == [3, 3]
