"""``python -m babybench view``: MIMo in a window, to be looked at and pulled."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from typing import Optional

import numpy as np
import numpy.typing as npt

from babybench_core.env import Env
from babybench_core.noise import ActionNoise
from babybench_core.window import HELP, Window


def parser(program: str) -> argparse.ArgumentParser:
    """Returns the parser of the arguments."""
    made = argparse.ArgumentParser(
        prog=f"{program} view",
        description="Shows MIMo in a window, in real time (needs pygame). " + "; ".join(HELP),
        allow_abbrev=False,
    )
    made.add_argument(
        "config", nargs="?", default="self_touch", help="a YAML file or the name of an example (self_touch)"
    )
    made.add_argument("--seed", type=int, default=None, help="the seed of the first episode")
    made.add_argument(
        "--noise", default=None, help="what moves him: white, held, ou, pink or oscillators; without, he keeps still"
    )
    made.add_argument("--camera", default=None, help="a camera of the scene to begin with")
    made.add_argument("--size", type=int, nargs=2, default=(800, 600), metavar=("WIDTH", "HEIGHT"), help="pixels")
    made.add_argument("--episodes", type=int, default=None, help="how many episodes; by default until it is closed")
    return made


def main(arguments: Sequence[str], program: str = "python -m babybench") -> None:
    """Shows what the arguments say until the window is closed."""
    args = parser(program).parse_args(arguments)
    env = Env(args.config)
    env.reset(seed=args.seed)
    noise = None if args.noise is None else ActionNoise(args.noise, env)
    still = np.zeros(env.action_space.shape, np.float32)
    window = Window(f"BabyBench: {env.config['behavior']}", env._core, tuple(args.size), args.camera)
    try:
        _play(env, window, (lambda: still) if noise is None else noise, args.episodes)
    finally:
        window.close()
        env.close()


def _play(env: Env, window: Window, act: Callable[[], npt.NDArray[np.float32]], episodes: Optional[int]) -> None:
    done = 0
    window.show(0.0)
    while window.open and (episodes is None or done < episodes):
        _, _, terminated, truncated, _ = env.step(act())
        window.show(env.dt)
        if terminated or truncated:
            done += 1
            env.reset()
