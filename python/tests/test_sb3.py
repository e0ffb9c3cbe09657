"""Stable-Baselines3 takes the environments as they are. It needs PyTorch: see docs/learners.md."""

from __future__ import annotations

import warnings

import gymnasium
import numpy as np
import pytest
from conftest import SEEING, SMALL

import babybench

pytest.importorskip("stable_baselines3", reason="Stable-Baselines3 is not installed: it needs PyTorch")


@pytest.mark.parametrize(
    "name", ["SelfTouch", "HandRegard", "Installation", "Reach", "Standup", "SelfBody", "Catch", "RollOver"]
)
def test_the_checker_finds_nothing(name):
    from stable_baselines3.common.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # one task has muscles, whose activations are 0 to 1
        warnings.filterwarnings("ignore", message="We recommend you to use a symmetric")
        check_env(gymnasium.make(f"babybench/{name}-v0", render_size=48).unwrapped)


def test_a_vector_is_many_environments():
    from stable_baselines3.common.vec_env import DummyVecEnv

    ours = babybench.sb3.VecEnv(SMALL, 2)
    theirs = DummyVecEnv([lambda: babybench.Env(SMALL)] * 2)
    ours.seed(3)
    theirs.seed(3)
    a, b = ours.reset(), theirs.reset()
    rng = np.random.default_rng(0)
    for step in range(8):
        for key in b:
            np.testing.assert_array_equal(a[key], b[key])
        actions = rng.uniform(-1, 1, (2, *ours.action_space.shape)).astype(np.float32)
        (a, *flags_a, infos_a), (b, *flags_b, infos_b) = ours.step(actions), theirs.step(actions)
        for x, y in zip(flags_a, flags_b):
            np.testing.assert_array_equal(x, y)
        if step == 5:
            assert flags_a[1].all()
            for one, other in zip(infos_a, infos_b):
                assert one["steps"] == other["steps"] == 6
                assert one["TimeLimit.truncated"] == other["TimeLimit.truncated"] is True
                for key, value in other["terminal_observation"].items():
                    np.testing.assert_array_equal(one["terminal_observation"][key], value)
            # the starts of unseeded episodes come from generators that go on
            break


def test_wrappers_of_vectors_go_around():
    from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

    envs = VecNormalize(VecMonitor(babybench.sb3.VecEnv(SMALL, 2)), norm_obs_keys=["observation"])
    envs.reset()
    for _ in range(6):
        *_, infos = envs.step(np.zeros((2, *envs.action_space.shape), np.float32))
    assert infos[0]["episode"]["l"] == 6
    assert len(envs.env_method("snapshot")) == 2
    with pytest.raises(AttributeError, match="no attributes of their own"):
        envs.set_attr("x", 1)
    with pytest.raises(RuntimeError, match="nothing is under way"):
        envs.unwrapped.step_wait()


@pytest.mark.parametrize("config", [SMALL, {**SEEING, "vision_resolution": 36}], ids=["self_touch", "hand_regard"])
def test_a_policy_learns(config):
    from stable_baselines3 import PPO

    envs = babybench.sb3.VecEnv(config, 2)
    model = PPO("MultiInputPolicy", envs, n_steps=8, batch_size=8, n_epochs=1, device="cpu")
    assert model.learn(32).num_timesteps == 32


def test_learners_store_the_state_before_the_action():
    from stable_baselines3 import PPO

    steps, seeds = 5, [3, 4]
    envs = babybench.sb3.VecEnv(SMALL, 2)
    model = PPO("MultiInputPolicy", envs, n_steps=steps, batch_size=steps, n_epochs=1, device="cpu", seed=seeds[0])
    model.learn(2 * steps)
    # the buffer has been flattened, one environment after the other
    kept = {key: values.reshape(2, steps, -1) for key, values in model.rollout_buffer.observations.items()}
    actions = np.clip(model.rollout_buffer.actions, -1, 1).reshape(2, steps, -1).astype(np.float32)
    twins = babybench.VectorEnv(SMALL, 2)
    observations, _ = twins.reset(seed=seeds)
    for step in range(steps):
        for key, values in observations.items():
            np.testing.assert_array_equal(kept[key][:, step], values.reshape(2, -1).astype(kept[key].dtype))
        observations, *_ = twins.step(actions[:, step])


def test_hindsight_stores_what_was_before_and_after():
    from stable_baselines3 import SAC, HerReplayBuffer

    envs = babybench.sb3.VecEnv("reach", 2, max_episode_steps=6)
    kept = {"copy_info_dict": True}
    model = SAC(
        "MultiInputPolicy",
        envs,
        replay_buffer_class=HerReplayBuffer,
        replay_buffer_kwargs=kept,
        learning_starts=12,
        seed=0,
    )
    model.learn(24)
    buffer = model.replay_buffer
    for step in range(5):  # of an episode: what follows a step is what the next one starts from
        np.testing.assert_array_equal(
            buffer.next_observations["observation"][step], buffer.observations["observation"][step + 1]
        )
        assert not np.array_equal(
            buffer.observations["observation"][step], buffer.next_observations["observation"][step]
        )
    sample = buffer.sample(64)
    assert np.isfinite(sample.rewards.numpy()).all()


def test_the_last_information_is_that_of_the_episode_that_ended():
    rng = np.random.default_rng(0)
    for config, key in [("self_touch", "touches"), (SEEING, "regards")]:
        envs = babybench.sb3.VecEnv(config, 4, max_episode_steps=160)
        envs.seed(1)
        envs.reset()
        counts = [np.zeros(4)]
        for step in range(160):
            if step % 40 == 0:
                actions = rng.uniform(-1, 1, (4, *envs.action_space.shape)).astype(np.float32)
            _, _, dones, infos = envs.step(actions)
            assert [info["steps"] for info in infos] == [step + 1] * 4
            counts.append(np.array([info[key].sum() for info in infos]))
        assert dones.all()
        assert (np.diff(counts, axis=0) >= 0).all()
        if key == "regards":
            final = [sum(info["final_info"]["page_regards"].values()) for info in infos]
            np.testing.assert_array_equal(infos[0]["page_regards"], infos[0]["regards"])
        else:
            touches = [[info["final_info"][f"{hand}_hand_touches"] for hand in ("right", "left")] for info in infos]
            final = [len(right) + len(left) for right, left in touches]
            assert sum(final) > 0
            for info, hands in zip(infos, touches):
                for row, geoms in zip(info["touches"], hands):
                    assert set(np.flatnonzero(row)) == set(geoms)
        np.testing.assert_array_equal(counts[-1], final)
        envs.close()


def learned(config, seed, steps, weights=None, **arguments):
    """Returns a model that starts from the weights of another one, and learns for two rollouts."""
    from stable_baselines3 import PPO

    model = PPO(
        "MultiInputPolicy",
        babybench.sb3.VecEnv(config, 2),
        n_steps=steps,
        batch_size=steps,
        n_epochs=2,
        device="cpu",
        seed=seed,
        **arguments,
    )
    if weights is not None:
        model.policy.load_state_dict(weights)
        model.set_random_seed(seed)  # networks of other shapes have drawn other numbers
    model.learn(4 * steps)
    return model


def as_sparse(weights):
    """Returns the weights of the usual policy by the names of one whose first layers are sparse."""
    first = {
        "mlp_extractor.policy_net.0.": "pi_features_extractor.layer.",
        "mlp_extractor.value_net.0.": "vf_features_extractor.layer.",
        "mlp_extractor.policy_net.2.": "mlp_extractor.policy_net.0.",
        "mlp_extractor.value_net.2.": "mlp_extractor.value_net.0.",
    }
    named = {}
    for name, value in weights.items():
        start = next((start for start in first if name.startswith(start)), None)
        named[name if start is None else first[start] + name[len(start) :]] = value.clone()
    # the one that is not used where actions and values have their own
    named |= {
        name.replace("pi_", "", 1): value for name, value in named.items() if name.startswith("pi_features_extractor.")
    }
    return named


def test_a_sparse_first_layer_learns_what_a_dense_one_does():
    usual = {"policy_kwargs": {"ortho_init": False}, "learning_rate": 1e-3}
    untrained = learned("self_touch", 1, 16, **{**usual, "learning_rate": 0.0})
    start = {name: value.clone() for name, value in untrained.policy.state_dict().items()}
    dense = learned("self_touch", 1, 16, start, **usual)
    sparse = learned("self_touch", 1, 16, as_sparse(start), learning_rate=1e-3, **babybench.sb3.sparse())
    narrow = sparse.rollout_buffer.observations["touch"].shape[-1]
    assert 0 < narrow < 0.5 * sparse.observation_space["touch"].shape[0] * sparse.observation_space["touch"].shape[-1]
    expected, found = as_sparse(dense.policy.state_dict()), sparse.policy.state_dict()
    moved = 0.0
    for name, value in as_sparse(start).items():
        if name.startswith("features_extractor."):
            continue
        np.testing.assert_allclose(found[name], expected[name], atol=2e-4, err_msg=name)
        moved = max(moved, float((expected[name] - value).abs().max()))
    assert moved > 5e-3


def test_a_sparse_policy_sees_is_saved_and_goes_on(tmp_path):
    from stable_baselines3 import PPO

    config = {**SEEING, "vision_resolution": 36, "touch_active": True}
    model = learned(config, 0, 8, **babybench.sb3.sparse(features_dim=32))
    model.save(tmp_path / "model.zip")
    again = PPO.load(tmp_path / "model.zip", env=model.get_env(), device="cpu")
    observation = model.get_env().reset()
    np.testing.assert_array_equal(
        model.predict(observation, deterministic=True)[0], again.predict(observation, deterministic=True)[0]
    )
    assert again.learn(16).num_timesteps == 16


def test_options_reach_the_reset_and_hold_for_one():
    envs = babybench.sb3.VecEnv(SMALL, 2)
    envs.set_options({"model": {"opt.gravity": [0, 0, -1.62]}})
    envs.reset()
    assert [envs.envs.array(env, "opt.gravity")[2] for env in range(2)] == [-1.62, -1.62]
    head = envs.envs.array(0, "body_mass", "head")
    envs.set_options([{"model": {"body_mass": {"head": 5.0}}}, {}])
    envs.reset()
    assert [float(envs.envs.array(env, "body_mass", "head")) for env in range(2)] == [5.0, float(head)]
    envs.set_options({"age": 3.0})
    envs.reset()
    assert {config["age"] for config in envs.envs.configs} == {3.0}
    envs.set_options({"nonsense": 1})
    with pytest.raises(ValueError, match="no such option"):
        envs.reset()
