"""Stable-Baselines3's PPO with an intrinsic reward, on a vector of environments.

The reward is that of the starter kit's example: the share of touch sensors that feel something. A wrapper of the vector
computes it for all environments at once, and the networks read only what is felt (``babybench.sb3.sparse``), in a third of
the time. Needs ``pip install stable-baselines3``; run it with ``python ppo_selftouch.py --steps 100000``.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecEnvWrapper, VecMonitor

import babybench


class TouchReward(VecEnvWrapper):
    """Rewards every environment with the share of its touch sensors that feel something."""

    def reset(self) -> Any:
        """Starts an episode in all environments."""
        return self.venv.reset()

    def step_wait(self) -> Any:
        """Adds the reward."""
        observations, rewards, dones, infos = self.venv.step_wait()
        felt = np.mean(observations["touch"] > 1e-6, axis=1, dtype=np.float32)
        return observations, rewards + felt, dones, infos


def main() -> None:
    """Runs the example."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--config", default="self_touch", help="an example, or a YAML file")
    parser.add_argument("--envs", type=int, default=16)
    parser.add_argument("--steps", type=int, default=20_000, help="steps of all environments together")
    parser.add_argument("--rollout", type=int, default=128, help="steps of each environment between two updates")
    parser.add_argument("--out", default="ppo_selftouch.zip")
    arguments = parser.parse_args()

    envs = VecMonitor(TouchReward(babybench.sb3.VecEnv(arguments.config, arguments.envs)))
    model = PPO(
        "MultiInputPolicy",
        envs,
        n_steps=arguments.rollout,
        batch_size=512,
        device="cpu",
        verbose=1,
        **babybench.sb3.sparse(),
    )
    started = time.perf_counter()
    model.learn(arguments.steps)
    print(f"{model.num_timesteps / (time.perf_counter() - started):.0f} steps a second, with learning")
    model.save(arguments.out)
    envs.close()


if __name__ == "__main__":
    main()
