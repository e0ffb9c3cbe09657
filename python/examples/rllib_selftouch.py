"""Learns with RLlib's PPO: MIMo is rewarded for touches that are new in the episode.

``--vector`` lets RLlib's runner step the library's own vector, on all cores
(``gym_env_vectorize_mode="vector_entry_point"``), instead of one environment after the other.
Needs ``pip install "ray[rllib]" torch``.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
import ray
from ray.rllib.algorithms.ppo import PPOConfig
from ray.tune.registry import register_env

import babybench

Floats = npt.NDArray[np.float32]
NAME = "babybench/SelfTouch-v0"


class Flat(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Proprioception and which sensors are touched as one vector; a reward for each that is new in the episode."""

    def __init__(self, env: gymnasium.Env[Any, Any]) -> None:
        """Wraps an environment with touch."""
        super().__init__(env)
        self._proprioception = env.observation_space["observation"].shape[0]  # type: ignore[index]
        self._sensors = env.observation_space["touch"].shape[0]  # type: ignore[index]
        size = self._proprioception + self._sensors
        self.observation_space = gymnasium.spaces.Box(-5.0, 5.0, (size,), np.float32)
        self._known = np.zeros(self._sensors, bool)

    def _flat(self, observation: Any) -> Floats:
        touched = observation["touch"] != 0
        flat = np.concatenate([np.clip(observation["observation"], -5, 5), touched])
        return flat.astype(np.float32)

    def reset(self, **options: Any) -> tuple[Floats, dict[str, Any]]:
        """Starts an episode, and remembers which sensors feel something at the start."""
        observation, info = self.env.reset(**options)
        self._known[:] = observation["touch"] != 0
        return self._flat(observation), info

    def step(self, action: Any) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """Rewards new touches."""
        observation, _, terminated, truncated, info = self.env.step(action)
        touched = observation["touch"] != 0
        new = int(np.sum(touched & ~self._known))
        self._known |= touched
        return self._flat(observation), 0.1 * new, terminated, truncated, info


class FlatVector(gymnasium.vector.VectorWrapper):
    """The same for the library's vectors, all environments at once."""

    def __init__(self, envs: babybench.VectorEnv) -> None:
        """Wraps a vector with touch."""
        super().__init__(envs)
        space = envs.single_observation_space
        self._sensors = space["touch"].shape[0]  # type: ignore[index]
        size = space["observation"].shape[0] + self._sensors  # type: ignore[index]
        self.single_observation_space = gymnasium.spaces.Box(-5.0, 5.0, (size,), np.float32)
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, envs.num_envs)
        self._known = np.zeros((envs.num_envs, self._sensors), bool)
        self._over = np.zeros(envs.num_envs, bool)

    def _flat(self, observations: Any) -> tuple[Floats, npt.NDArray[np.bool_]]:
        touched = observations["touch"] != 0
        flat = np.concatenate([np.clip(observations["observation"], -5, 5), touched], axis=1)
        return flat.astype(np.float32), touched

    def reset(self, **options: Any) -> tuple[Floats, dict[str, Any]]:
        """Starts episodes, and remembers which sensors feel something at the start."""
        observations, _ = self.env.reset(**options)
        flat, self._known = self._flat(observations)
        self._over[:] = False
        return flat, {}

    def step(self, actions: Any) -> tuple[Floats, Any, Any, Any, dict[str, Any]]:
        """Rewards new touches."""
        observations, _, terminated, truncated, _ = self.env.step(actions)
        flat, touched = self._flat(observations)
        # the step after the last one of an episode is the reset: what is felt then is known
        self._known[self._over] = touched[self._over]
        rewards = 0.1 * np.sum(touched & ~self._known, axis=1)
        self._known |= touched
        self._over = terminated | truncated
        return flat, rewards, terminated, truncated, {}


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--iterations", type=int, default=10)
    parser.add_argument("--batch", type=int, default=2000, help="steps of an iteration")
    parser.add_argument("--envs", type=int, default=8, help="environments of the runner")
    parser.add_argument("--episode", type=int, default=200, help="steps of an episode")
    parser.add_argument("--vector", action="store_true", help="step the library's own vector")
    args = parser.parse_args()

    keys: dict[str, Any] = {"touch_function": "normal", "touch_scale": 2.0, "vision_active": False}

    def make(context: dict[str, Any]) -> Any:
        if "num_envs" in context and args.vector:
            envs = gymnasium.make_vec(
                NAME,
                context["num_envs"],
                vectorization_mode="vector_entry_point",
                max_episode_steps=args.episode,
                **keys,
            )
            return FlatVector(envs)  # type: ignore[arg-type]
        return Flat(gymnasium.make(NAME, max_episode_steps=args.episode, **keys))

    register_env("selftouch", make)
    ray.init(include_dashboard=False, logging_level="error")
    config = (
        PPOConfig()
        .environment("selftouch")
        .env_runners(
            num_env_runners=0,
            num_envs_per_env_runner=args.envs,
            gym_env_vectorize_mode="vector_entry_point" if args.vector else "sync",
        )
        .training(train_batch_size_per_learner=args.batch, minibatch_size=256, num_epochs=4, lr=3e-4, gamma=0.99)
        .learners(num_learners=0)
    )
    algorithm = config.build_algo()
    started = time.perf_counter()
    for iteration in range(1, args.iterations + 1):
        result = algorithm.train()
        steps = result["num_env_steps_sampled_lifetime"]
        mean = result["env_runners"].get("episode_return_mean", float("nan"))
        print(
            f"{iteration:4} {int(steps):8} steps, {steps / (time.perf_counter() - started):6.0f}/s, return {mean:.2f}"
        )
    algorithm.stop()
    ray.shutdown()


if __name__ == "__main__":
    main()
