"""TorchRL takes the environments as they are. It needs PyTorch: see docs/learners.md."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest
from conftest import SEEING, SMALL

import babybench

torch = pytest.importorskip("torch", reason="PyTorch is not installed")
libs = pytest.importorskip("torchrl.envs", reason="TorchRL is not installed: it needs PyTorch")


def test_environments_by_name():
    env = libs.GymEnv("babybench/SelfTouch-v0", touch_scale=3.0)
    libs.check_env_specs(env)
    alone = babybench.make("self_touch", touch_scale=3.0)
    env.set_seed(3)  # resets, too
    alone.reset(seed=3)
    ours, theirs = alone.reset()[0], env.reset()
    rng = np.random.default_rng(0)
    for _ in range(5):
        for key, values in ours.items():
            np.testing.assert_array_equal(theirs[key].numpy(), values)
        action = rng.uniform(-1, 1, alone.action_space.shape).astype(np.float32)
        ours = alone.step(action)[0]
        theirs = env.step(theirs.set("action", torch.from_numpy(action)))["next"]


@pytest.mark.parametrize("name", ["HandRegard", "Installation", "Reach", "Standup", "SelfBody", "Catch", "RollOver"])
def test_the_checker_finds_nothing(name):
    libs.check_env_specs(libs.GymEnv(f"babybench/{name}-v0"))


def test_pixels_and_repeated_actions():
    env = libs.GymEnv("babybench/HandRegard-v0", from_pixels=True, pixels_only=False, frame_skip=2, render_size=48)
    rollout = env.rollout(3)
    assert rollout["pixels"].shape == (3, 48, 48, 3)
    assert rollout["eye_left"].shape[:1] == (3,)


def test_wrapped_environments_store_what_was_before_and_after():
    env = libs.GymWrapper(babybench.Env(SEEING))
    libs.check_env_specs(env)
    rollout = env.rollout(4)
    for key in ("observation", "eye_right"):
        before, after = rollout[key].numpy(), rollout["next", key].numpy()
        np.testing.assert_array_equal(before[1:], after[:-1])
    assert not np.array_equal(rollout["observation"].numpy(), rollout["next", "observation"].numpy())
    assert rollout["next", "truncated"][-1].item()


@pytest.mark.skipif(
    not hasattr(gymnasium.vector, "AutoresetMode"), reason="TorchRL takes vectors of Gymnasium since 1.1"
)
def test_vectors():
    envs = libs.GymWrapper(babybench.VectorEnv(SMALL, 3, autoreset_mode="Disabled"))
    libs.check_env_specs(envs)
    rollout = envs.rollout(2 * 6, break_when_any_done=False)
    assert rollout.batch_size == (3, 12)
    ends = rollout["next", "truncated"][..., 0].numpy()
    np.testing.assert_array_equal(ends, np.tile(np.arange(12) % 6 == 5, (3, 1)))
    before, after = rollout["observation"].numpy(), rollout["next", "observation"].numpy()
    np.testing.assert_array_equal(before[:, 1:6], after[:, :5])
    assert not np.array_equal(before[:, 6], after[:, 5])  # the next episode's own start
