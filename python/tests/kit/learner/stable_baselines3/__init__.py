"""The part of Stable-Baselines3 that the kit's examples need, without PyTorch: random actions instead of learning."""

from __future__ import annotations

from pathlib import Path
from typing import Any


class PPO:
    """Takes random actions."""

    def __init__(self, policy: str, env: Any, verbose: int = 0) -> None:
        """Takes the environment."""
        self.env = env

    def learn(self, total_timesteps: int) -> PPO:
        """Steps through episodes, as learners do."""
        self.env.reset()
        rewards = 0.0
        for _ in range(total_timesteps):
            _, reward, terminated, truncated, _ = self.env.step(self.env.action_space.sample())
            rewards += reward
            if terminated or truncated:
                self.env.reset()
        print(f"rewards {rewards:.6f}")
        return self

    def save(self, path: str) -> None:
        """Writes something where the policy would be."""
        Path(f"{path}.zip").write_text("random")
