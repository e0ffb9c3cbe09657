"""MIMo learns to reach with hindsight: SAC with hindsight experience replay from Stable-Baselines3, on a vector.

Needs stable-baselines3 and PyTorch: pip install "stable-baselines3>=2.3"

    python her_reach.py [STEPS]
"""

from __future__ import annotations

import sys

from stable_baselines3 import SAC, HerReplayBuffer
from stable_baselines3.common.vec_env import VecMonitor

import babybench.sb3


def main(steps: int = 50_000) -> None:
    """Trains and prints how often the ball was touched."""
    envs = VecMonitor(babybench.sb3.VecEnv("reach", num_envs=8, max_episode_steps=200), info_keywords=("is_success",))
    model = SAC(
        "MultiInputPolicy",
        envs,
        replay_buffer_class=HerReplayBuffer,
        # rewards depend on more than goals: each transition keeps its information
        replay_buffer_kwargs={"n_sampled_goal": 4, "goal_selection_strategy": "future", "copy_info_dict": True},
        learning_starts=4_000,
        gradient_steps=4,
        verbose=1,
        seed=0,
    )
    model.learn(steps)
    model.save("her_reach")
    envs.close()


if __name__ == "__main__":
    main(*(int(argument) for argument in sys.argv[1:2]))
