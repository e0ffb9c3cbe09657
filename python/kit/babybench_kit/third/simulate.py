"""Watching one of MIMo 3's environments: ``mimo_infant.simulation.simulate``."""

from __future__ import annotations

import argparse

import gymnasium as gym

from .registration import register_mimo_envs

ENV_NAMES = {
    "reach": "MIMoReach-v0",
    "standup": "MIMoStandup-v0",
    "selfbody": "MIMoSelfBody-v0",
    "catch": "MIMoCatch-v0",
    "roll_over": "MIMoRollOver-v0",
}
"""The environments that can be watched, and their ids."""


def main() -> None:
    """Shows an environment with random actions in a window, until that is closed or the program is interrupted."""
    parser = argparse.ArgumentParser(description="Shows one of MIMo 3's environments with random actions.")
    parser.add_argument("--env", choices=sorted(ENV_NAMES), default="reach", help="the environment")
    parser.add_argument("--fps", type=float, default=None, help="pictures per second; by default the environment's")
    arguments = parser.parse_args()
    register_mimo_envs()
    env = gym.make(ENV_NAMES[arguments.env], render_mode="human")
    if arguments.fps is not None:
        env.unwrapped.metadata["render_fps"] = arguments.fps
    try:
        env.reset()
        while True:
            _, _, terminated, truncated, _ = env.step(env.action_space.sample())
            env.render()
            if terminated or truncated:
                env.reset()
    except KeyboardInterrupt:
        pass
    finally:
        env.close()
