"""Tasks with goals: Gymnasium-Robotics' interface, alone and in vectors."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import babybench

TASKS = {
    "babybench/Reach-v0": "reach",
    "babybench/Standup-v0": "standup",
    "babybench/SelfBody-v0": "selfbody",
    "babybench/Catch-v0": "catch",
    "babybench/RollOver-v0": "roll_over",
    "babybench/Mobile-v0": "mobile",
    "babybench/Play-v0": "play",
}


@pytest.mark.parametrize("name", TASKS)
def test_a_task_has_goals_and_rewards_that_can_be_computed_again(name):
    env = gymnasium.make(name).unwrapped
    assert env.config["behavior"] == TASKS[name]
    env.action_space.seed(0)
    observation, info = env.reset(seed=0)
    assert "is_success" in info
    achieved, desired, infos, rewards = [], [], [], []
    for _ in range(20):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        assert env.observation_space.contains(observation)
        assert isinstance(reward, float)
        rewards.append(reward)
        if "achieved_goal" in observation:
            goals = [observation[key] for key in ("achieved_goal", "desired_goal")]
            assert env.compute_reward(*goals, info) == reward
            achieved.append(goals[0])
            desired.append(goals[1])
            infos.append(info)
        if terminated or truncated:
            env.reset()
    # learners tell by this which environments have goals
    assert hasattr(env, "compute_reward") == bool(achieved)
    if achieved:
        np.testing.assert_array_equal(env.compute_reward(np.array(achieved), np.array(desired), infos), rewards)
    assert np.ptp(rewards) > 0 or TASKS[name] in ("selfbody", "catch", "mobile", "play")


def test_what_tasks_of_the_library_measure_is_in_the_information():
    env = babybench.make("mobile", vision_active=False, touch_active=False, mobile_limb="left_foot", mobile_reward=True)
    env.reset(seed=0)
    _, reward, *_, info = env.step(env.action_space.sample())
    assert info["phase"] == 0
    assert info["mobile_movement_baseline"] == reward > 0
    assert info["left_foot_movements_baseline"] >= 0 == info["mobile_movement_reinforcement"]
    env = babybench.make("play", vision_active=False, touch_active=False)
    _, info = env.reset(seed=0)
    assert info["toys"] == 9
    assert info["toys_touched"] == info["holding_time"] == 0


def test_reach_follows_the_goal_that_is_set():
    env = babybench.make("reach")
    observation, _ = env.reset(seed=1)
    there = observation["achieved_goal"]
    observation = env.set_goal(there)
    np.testing.assert_array_equal(observation["desired_goal"], there)
    observation, reward, *_, info = env.step(np.zeros(env.action_space.shape, np.float32))
    distance = np.linalg.norm(observation["achieved_goal"] - there)
    assert reward == pytest.approx(-distance + 100 * info["is_success"])
    with pytest.raises(ValueError, match="desired_goal has the shape"):
        env.set_goal(np.zeros(2))


def test_what_rewards_need_is_asked_for():
    env = babybench.make("standup")
    env.reset(seed=0)
    goal = np.zeros(1)
    with pytest.raises(KeyError, match="copy_info_dict"):
        env.compute_reward(goal, goal, {})
    with pytest.raises(ValueError, match="1 goals, but the information of 2 steps"):
        env.compute_reward(goal, goal, [{}, {}])
    with pytest.raises(ValueError, match="achieved_goal has the shape"):
        env.compute_reward(np.zeros(3), goal, {"reward_terms": np.zeros(1)})


def test_without_goals_nothing_is_computed_from_them(env):
    assert not hasattr(env, "compute_reward")
    with pytest.raises(AttributeError, match="no goals"):
        env.compute_reward(np.zeros(1), np.zeros(1), {})


def test_a_vector_is_its_environments():
    steps = 5
    alone = [babybench.make("reach") for _ in range(3)]
    envs = babybench.VectorEnv("reach", num_envs=3, autoreset_mode="SameStep")
    together, _ = envs.reset(seed=3)
    singles = [env.reset(seed=3 + k)[0] for k, env in enumerate(alone)]
    rng = np.random.default_rng(0)
    for _ in range(steps):
        for key in ("observation", "achieved_goal", "desired_goal"):
            np.testing.assert_array_equal(together[key], [single[key] for single in singles])
        actions = rng.uniform(-1, 1, (3, *envs.single_action_space.shape)).astype(np.float32)
        together, rewards, terminated, _, infos = envs.step(actions)
        stepped = [env.step(action) for env, action in zip(alone, actions)]
        singles = [step[0] for step in stepped]
        np.testing.assert_array_equal(rewards, [step[1] for step in stepped])
        np.testing.assert_array_equal(infos["is_success"], [step[4]["is_success"] for step in stepped])
        assert not terminated.any()
        goals = (singles[1]["achieved_goal"], singles[1]["desired_goal"])
        assert envs.compute_reward(1, *goals, stepped[1][4]) == rewards[1]
    envs.close()


@pytest.mark.filterwarnings("ignore:.*infinity. This is probably too")
def test_gymnasium_finds_nothing_wrong():
    check_env(babybench.make("reach"), skip_render_check=True)


def test_tasks_take_the_keys_of_the_body_and_the_senses():
    env = babybench.make("standup", age=12, delay_sensory=2)
    env.reset(seed=0)
    stature = babybench.make("standup", age=3)
    assert env.observation_space["observation"] == stature.observation_space["observation"]
    first, *_ = env.step(env.action_space.sample())
    second, *_ = env.step(env.action_space.sample())
    np.testing.assert_array_equal(first["observation"], second["observation"])  # still those of the reset
    third, *_ = env.step(env.action_space.sample())
    assert not np.array_equal(third["observation"], second["observation"])
