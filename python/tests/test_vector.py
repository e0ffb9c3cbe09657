"""Vectors: the same bits as alone, modes of reset, halves of a step, copies and views."""

from __future__ import annotations

import importlib
import pickle
import sys
import types

import gymnasium
import numpy as np
import pytest
from conftest import SEEING, SMALL

import babybench
from babybench.vector import AutoresetMode

MODES = list(AutoresetMode)
VERSION = tuple(int(part) for part in gymnasium.__version__.split(".")[:2])


def actions_of(envs, steps, seed=0):
    rng = np.random.default_rng(seed)
    low, high = envs.action_space.low, envs.action_space.high
    return rng.uniform(low, high, (steps, *low.shape)).astype(np.float32)


@pytest.mark.parametrize("config", [SMALL, SEEING], ids=["self_touch", "hand_regard"])
@pytest.mark.parametrize("threads", [1, 2])
def test_each_environment_goes_as_if_it_were_alone(config, threads):
    envs = babybench.VectorEnv(config, 3, threads=threads)
    alone = [babybench.Env(config) for _ in range(3)]
    observations, infos = envs.reset(seed=5)
    for i, env in enumerate(alone):
        first, _ = env.reset(seed=5 + i)
        for key in first:
            np.testing.assert_array_equal(observations[key][i], first[key], strict=True)
    for actions in actions_of(envs, 3):
        observations, rewards, terminated, truncated, infos = envs.step(actions)
        assert envs.observation_space.contains(observations)
        assert (rewards == 0).all()
        assert not terminated.any()
        for i, env in enumerate(alone):
            one, _, _, cut, info = env.step(actions[i])
            for key in one:
                np.testing.assert_array_equal(observations[key][i], one[key], err_msg=key)
            assert truncated[i] == cut
            assert infos["steps"][i] == info["steps"]
            assert envs.info(i) == info
            if "touches" in infos:
                right = sorted(info["right_hand_touches"])
                assert np.flatnonzero(infos["touches"][i, 0]).tolist() == right
    envs.close()


@pytest.mark.parametrize("order", [np.asfortranarray, lambda a: a[::-1, ::-1].copy()[::-1, ::-1], np.ndarray.tolist])
def test_actions_mean_the_same_in_any_order_of_memory(order):
    envs, others = (babybench.VectorEnv(SMALL, 3) for _ in range(2))
    for vector in (envs, others):
        vector.reset(seed=5)
    for actions in actions_of(envs, 3):
        expected, found = envs.step(actions)[0], others.step(order(actions))[0]
        for key, values in expected.items():
            np.testing.assert_array_equal(found[key], values)


def test_copies_stay_with_who_holds_them():
    envs, views = babybench.VectorEnv(SMALL, 3), babybench.VectorEnv(SMALL, 3, copy=False)
    kept = []
    for k, actions in enumerate([None, *actions_of(envs, 12)]):
        both = [e.reset(seed=0)[0] if actions is None else e.step(actions)[0] for e in (envs, views)]
        for key in both[0]:
            np.testing.assert_array_equal(both[0][key], both[1][key], err_msg=key)
        mine = both[0]["touch"]
        mine += 1  # the caller's own: later ones know nothing of it
        if k % 4 == 0:
            kept.append((both[0]["observation"], both[0]["observation"].copy()))
            kept.append((mine[1:, 5:9], mine[1:, 5:9].copy()))
            kept.append((memoryview(mine), mine.copy()))
        del both, mine
    for held, values in kept:
        np.testing.assert_array_equal(np.asarray(held), values)
    envs.close()
    views.close()


@pytest.mark.parametrize("mode", MODES, ids=[mode.name for mode in MODES])
def test_episodes_follow_each_other_as_the_mode_says(mode):
    envs = babybench.VectorEnv(SMALL, 2, autoreset_mode=mode)
    envs.reset(seed=0)
    script = actions_of(envs, 9)
    seen = [envs.step(actions) for actions in script[:6]]
    assert seen[-1][3].tolist() == [True, True]
    last = seen[-1]
    if mode is AutoresetMode.SAME_STEP:
        assert last[4]["_final_obs"].all()
        assert last[4]["_final_info"].all()
        alone = babybench.Env(SMALL)
        alone.reset(seed=1)
        ends = [alone.step(actions[1]) for actions in script[:6]][-1]
        for key, value in last[4]["final_obs"][1].items():
            np.testing.assert_array_equal(value, ends[0][key], strict=True)
        assert last[4]["final_info"][1] == ends[4]
        assert last[4]["steps"].tolist() == [0, 0]
        assert "final_obs" not in envs.step(script[6])[4]
    elif mode is AutoresetMode.NEXT_STEP:
        _, _, _, truncated, infos = envs.step(script[6])
        assert (truncated.tolist(), infos["steps"].tolist()) == ([False, False], [0, 0])
        assert envs.step(script[7])[4]["steps"].tolist() == [1, 1]
    else:
        assert envs.step(script[6])[4]["steps"].tolist() == [7, 7]
        observations, infos = envs.reset(options={"reset_mask": np.array([False, True])})
        assert infos["steps"].tolist() == [7, 0]
        with pytest.raises(ValueError, match="reset_mask"):
            envs.reset(options={"reset_mask": np.array([1, 0])})


def test_modes_have_names():
    for name in ("NextStep", "SameStep", "Disabled"):
        envs = babybench.VectorEnv(SMALL, 1, autoreset_mode=name)
        assert envs.metadata["autoreset_mode"].value == name
    with pytest.raises(ValueError, match="Never"):
        babybench.VectorEnv(SMALL, 1, autoreset_mode="Never")


def test_copies_are_kept_and_views_change():
    copies, views = babybench.VectorEnv(SMALL, 2), babybench.VectorEnv(SMALL, 2, copy=False)
    first, _ = copies.reset(seed=0)
    seen, _ = views.reset(seed=0)
    kept = seen["observation"].copy()
    for actions in actions_of(copies, 5):
        a, *flags_a, _ = copies.step(actions)
        b, *flags_b, _ = views.step(actions)
        for key in a:
            np.testing.assert_array_equal(a[key], b[key], strict=True)
            assert b[key] is seen[key]
            assert not np.shares_memory(a[key], first[key])
        for x, y in zip(flags_a, flags_b):
            np.testing.assert_array_equal(x, y)
    assert not np.array_equal(kept, seen["observation"])
    with pytest.raises(ValueError, match="read-only"):
        seen["touch"][0, 0] = 1
    # what was given outlives the vector
    views.close()
    del views
    assert np.isfinite(seen["touch"]).all()


def test_halves_of_a_step_return_whoever_is_ready():
    envs = babybench.VectorEnv(SMALL, 4)
    whole = babybench.VectorEnv(SMALL, 4)
    envs.reset(seed=0)
    whole.reset(seed=0)
    script = actions_of(envs, 3)
    expected = [whole.step(actions) for actions in script]
    counts = np.zeros(4, int)
    envs.send(script[0])
    received = 0
    while received < 12:
        observations, _, _, truncated, infos = envs.recv(2)
        ids = infos["env_id"]
        for row, i in enumerate(ids):
            np.testing.assert_array_equal(observations["touch"][row], expected[counts[i]][0]["touch"][i])
            assert infos["steps"][row] == counts[i] + 1
        counts[ids] += 1
        received += 2
        going = ids[counts[ids] < 3]
        if len(going):
            envs.send(np.stack([script[counts[i], i] for i in going]), going)
    assert counts.tolist() == [3] * 4
    with pytest.raises(RuntimeError, match="call send first"):
        envs.recv(1)
    with pytest.raises(RuntimeError, match="call send first"):
        envs.recv(5)


def test_step_async_and_step_wait_are_a_step():
    one, other = babybench.VectorEnv(SMALL, 3), babybench.VectorEnv(SMALL, 3)
    one.reset(seed=0)
    other.reset(seed=0)
    for actions in actions_of(one, 8):
        one.step_async(actions)
        a, b = one.step_wait(), other.step(actions)
        for key in b[0]:
            np.testing.assert_array_equal(a[0][key], b[0][key])
        for x, y in zip(a[1:4], b[1:4]):
            np.testing.assert_array_equal(x, y)
        np.testing.assert_array_equal(a[4]["steps"], b[4]["steps"])


def test_environments_of_different_scenes_share_arrays():
    envs = babybench.VectorEnv([{**SMALL, "scene": scene} for scene in ("crib", "base")])
    assert envs.num_envs == 2
    assert envs.reset(seed=0)[0]["touch"].shape[0] == 2
    with pytest.raises(ValueError, match="differs from environment 0"):
        babybench.VectorEnv([SMALL, {**SMALL, "touch_scale": 3.0}])
    with pytest.raises(ValueError, match="2 configurations"):
        babybench.VectorEnv([SMALL, SMALL], 3)


def test_snapshots_fit_vectors_and_single_environments():
    envs, env = babybench.VectorEnv(SMALL, 2), babybench.Env(SMALL)
    envs.reset(seed=0)
    script = actions_of(envs, 4)
    envs.step(script[0])
    env.restore(envs.snapshot(1))
    envs.restore(0, envs.snapshot(1))
    observations, *_ = envs.step(np.stack([script[1, 1]] * 2))
    one, *_ = env.step(script[1, 1])
    for i in (0, 1):
        np.testing.assert_array_equal(observations["touch"][i], one["touch"])
    assert envs.lock(0, "head")["changed"]
    assert envs.array(0, "qpos").shape == env.array("qpos").shape


def test_a_noise_moves_all_as_each_alone():
    env, envs = babybench.Env(SMALL), babybench.VectorEnv(SMALL, 3)
    many, one = babybench.ActionNoise("pink", envs, seed=4), babybench.ActionNoise("pink", env, seed=5)
    for _ in range(5):
        actions = many()
        assert envs.action_space.contains(actions)
        np.testing.assert_array_equal(actions[1], one(), strict=True)
    noises = [babybench.ActionNoise(name, env) for name in ("white", "held:0.1", "ou", "pink", "oscillators:2")]
    assert len({noise().tobytes() + noise().tobytes() for noise in noises}) == 5
    one.reset(5)
    many.reset(4)
    np.testing.assert_array_equal(many()[1], one())
    assert env.dt == envs.dt == 0.005 == envs.get_attr("dt")[2]
    with pytest.raises(ValueError, match="choose white, held"):
        babybench.ActionNoise("brown", env)


def test_what_the_numbers_are_is_that_of_one_environment():
    envs, env = babybench.VectorEnv(SMALL, 2), babybench.Env(SMALL)
    observations, _ = envs.reset(seed=0)
    env.reset(seed=1)
    assert envs.proprioception.names == env.proprioception.names
    assert envs.touch.names == env.touch.names
    assert envs.touch.sensors * envs.touch.width == observations["touch"].shape[1]
    hand = envs.touch.slices["right_hand"]
    np.testing.assert_array_equal(observations["touch"][1, hand], env.touch.of("right_hand").ravel())


def test_attributes_and_methods_of_each_environment():
    envs = babybench.VectorEnv([{**SMALL, "scene": scene} for scene in ("crib", "base")])
    envs.reset(seed=0)
    assert [config["scene"] for config in envs.get_attr("config")] == ["crib", "base"]
    assert envs.get_attr("action_space") == (envs.single_action_space,) * 2
    assert envs.call("info") == (envs.info(0), envs.info(1))
    heights = [positions[2] for positions in envs.call("array", "qpos")]
    assert heights[0] != heights[1]
    assert all(report["changed"] for report in envs.call("lock", "head", angle=0.1))
    for name in ("no_such_thing", "step", "_core"):
        with pytest.raises(AttributeError, match=r"they have .*snapshot"):
            envs.call(name)
    with pytest.raises(AttributeError, match="cannot set"):
        envs.set_attr("config", {})


@pytest.mark.parametrize("mode", MODES)
def test_a_copy_goes_on_with_the_same_bits(mode):
    envs = babybench.VectorEnv({**SMALL, "max_episode_steps": 3}, 2, autoreset_mode=mode, threads=1)
    script = actions_of(envs, 8)
    envs.reset(seed=3)
    for k, actions in enumerate(script):
        copy = pickle.loads(pickle.dumps(envs))
        assert (copy.num_envs, copy.autoreset_mode, copy.configs) == (2, mode, envs.configs)
        if mode is AutoresetMode.DISABLED and k % 3 == 0:
            results = [e.reset() for e in (envs, copy)]
        results = [e.step(actions) for e in (envs, copy)]
        for key in results[0][0]:
            np.testing.assert_array_equal(results[0][0][key], results[1][0][key], err_msg=f"step {k}: {key}")
        for one, other in zip(results[0][1:4], results[1][1:4]):
            np.testing.assert_array_equal(one, other)
        copy.close()
    envs.close()
    with pytest.raises(RuntimeError, match="closed"):
        pickle.loads(pickle.dumps(envs)).reset()


def test_pictures_of_all():
    envs = babybench.VectorEnv({**SMALL, "render_size": 24}, 2, render_mode="rgb_array")
    envs.reset(seed=0)
    pictures = envs.render()
    assert [picture.shape for picture in pictures] == [(24, 24, 3)] * 2


@pytest.mark.skipif(VERSION < (1, 0), reason="Gymnasium before 1.0 makes no vectors of their own class")
def test_gymnasium_makes_vectors():
    envs = gymnasium.make_vec("babybench/SelfTouch-v0", num_envs=2, touch_scale=2.0)
    assert isinstance(envs.unwrapped, babybench.VectorEnv)
    observations, _ = envs.reset(seed=0)
    assert observations["touch"].shape[0] == 2
    envs.close()


@pytest.mark.skipif(VERSION < (1, 0), reason="wrappers of vectors came with Gymnasium 1.0")
def test_wrappers_of_vectors_go_around():
    from gymnasium.wrappers import vector

    envs = vector.RecordEpisodeStatistics(babybench.VectorEnv(SMALL, 2))
    envs.reset(seed=0)
    script = actions_of(envs, 6)
    infos = [envs.step(actions)[4] for actions in script][-1]
    assert infos["episode"]["l"].tolist() == [6, 6]


def test_observations_for_learners_outlive_the_next_step(monkeypatch):
    """Stable-Baselines3 stores an observation when the step after it is done; a stand-in suffices where it is missing."""
    try:
        import stable_baselines3  # noqa: F401
    except ImportError:

        class Base:
            def __init__(self, num_envs, observation_space, action_space):
                self.num_envs, self.action_space = num_envs, action_space
                self._seeds, self._options = [None] * num_envs, [{}] * num_envs
                self._reset_seeds = self._reset_options = lambda: None

        for name in ("stable_baselines3", "stable_baselines3.common", "stable_baselines3.common.vec_env"):
            monkeypatch.setitem(sys.modules, name, types.SimpleNamespace(VecEnv=Base))
    monkeypatch.delitem(sys.modules, "babybench_core.sb3", raising=False)
    sb3 = importlib.import_module("babybench_core.sb3")
    monkeypatch.delitem(sys.modules, "babybench_core.sb3")
    envs = sb3.VecEnv(SMALL, 2)
    before = envs.reset()
    kept = {key: values.copy() for key, values in before.items()}
    envs.step_async(np.full((2, *envs.action_space.shape), 0.5, np.float32))
    after, *_ = envs.step_wait()
    for key, values in before.items():
        np.testing.assert_array_equal(values, kept[key])
        assert values.flags.writeable
    assert not np.array_equal(before["observation"], after["observation"])
    envs.close()
    with pytest.raises(ValueError, match="copy=False"):
        sb3.VecEnv(SMALL, 2, copy=False)


def test_each_environment_has_its_own_changes_of_the_model():
    envs, one = babybench.VectorEnv(SMALL, 3), babybench.Env(SMALL)
    changes = [None, {"opt.gravity": [0, 0, -2.0]}, {"geom_friction": one.array("geom_friction") / 2}]
    observations, _ = envs.reset(seed=0, options={"model": changes})
    assert [array[2] for array in envs.call("array", "opt.gravity")] == [-9.81, -2, -9.81]
    rng = np.random.default_rng(0)
    actions = rng.uniform(envs.action_space.low, envs.action_space.high, (5, *envs.action_space.shape)).astype(
        np.float32
    )
    for action in actions:
        observations, *_ = envs.step(action)
    for number, change in enumerate(changes):
        one = babybench.Env(SMALL)
        one.reset(seed=number, options=None if change is None else {"model": change})
        for action in actions:
            observation, *_ = one.step(action[number])
        np.testing.assert_array_equal(observations["observation"][number], observation["observation"])
    copied = pickle.loads(pickle.dumps(envs))
    np.testing.assert_array_equal(copied.step(actions[0])[0]["observation"], envs.step(actions[0])[0]["observation"])
    envs.reset(options={"model": {"opt.gravity": [0, 0, -1.0]}, "reset_mask": np.array([True, False, True])})
    assert [array[2] for array in envs.call("array", "opt.gravity")] == [-1, -2, -1]
    with pytest.raises(ValueError, match="2 entries, but there are 3"):
        envs.reset(options={"model": [None, None]})
    with pytest.raises(TypeError, match="expected a mapping or a list"):
        envs.reset(options={"model": 3})


@pytest.mark.parametrize("compat", ["api", "reference"])
def test_hands_in_view_are_counted_in_both_ways(compat):
    keys = {"behavior": "hand_regard", "scene": "base", "touch_active": False, "vision_active": False}
    envs = babybench.VectorEnv(keys, 2, threads=1, compat=compat)
    envs.reset(seed=3)
    for actions in actions_of(envs, 20):
        infos = envs.step(actions)[-1]
    own = {"api": "page_regards", "reference": "kit_regards"}[compat]
    np.testing.assert_array_equal(infos["regards"], infos[own])
    assert infos["page_regards"].shape == infos["kit_regards"].shape == (2, 4)
    for k in range(2):
        info = envs.info(k)
        assert list(info["page_regards"].values()) == infos["page_regards"][k].tolist()
        assert list(info["kit_regards"].values()) == infos["kit_regards"][k].tolist()


@pytest.mark.parametrize("copy", [True, False])
def test_eyes_of_all_are_drawn_for_those_who_ask(copy):
    keys = {**SEEING, "max_episode_steps": 4}
    every = babybench.VectorEnv(keys, 3, autoreset_mode="SameStep")
    some = babybench.VectorEnv(keys, 3, autoreset_mode="SameStep", copy=copy, threads=2, vision_lazy=True)
    every.reset(seed=1)
    some.reset(seed=1)
    for step, actions in enumerate(actions_of(every, 6)):
        whole, *_, infos = every.step(actions)
        blind, *_, blind_infos = some.step(actions)
        assert some.observation_space.contains(blind)
        assert "eye_left" not in blind
        if "final_obs" in infos:
            assert infos["final_obs"][0].keys() - blind_infos["final_obs"][0].keys() == {"eye_left", "eye_right"}
        if step % 2 == 0:
            for key, images in {**blind, **some.eyes(), **some.eyes()}.items():
                np.testing.assert_array_equal(images, whole[key], err_msg=f"{key} of step {step}")
    every.step_async(actions)
    some.step_async(actions)
    whole = every.step_wait()[0]
    some.step_wait()
    for key, images in some.eyes().items():
        np.testing.assert_array_equal(images, whole[key])
    with pytest.raises(ValueError, match="vision_lazy"):
        babybench.VectorEnv([keys, {**keys, "vision_lazy": True}])
    some.send(actions)
    with pytest.raises(RuntimeError, match="environment 0"):
        some.eyes()
