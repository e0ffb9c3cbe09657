"""Runs of Gymnasium's MuJoCo environments: recorded on MuJoCo, repeated on this package.

``python mujoco_runs.py RECORDINGS`` repeats every recording of a folder on :mod:`babybench.mujoco`, Gymnasium
unchanged, and prints how far observations and rewards are away, as JSON.
"""

from __future__ import annotations

import json
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

STEPS = 1000
STARTS = 4
"""Runs of MuJoCo that start next to the recorded one."""
NEXT = 1e-12
"""How far away, of each coordinate."""

Array = NDArray[np.float64]


def make(name: str) -> Any:
    import gymnasium

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # v4
        return gymnasium.make(name).unwrapped


def names() -> list[str]:
    import gymnasium

    found = (name for name, spec in gymnasium.registry.items() if "envs.mujoco" in str(spec.entry_point))
    # MuJoCo 3 is too new for Gymnasium's Pusher-v4, which says so
    return sorted(name for name in found if name.endswith(("-v4", "-v5")) and name != "Pusher-v4")


def actions(env: Any) -> Array:
    space = env.action_space
    return np.random.default_rng(1).uniform(space.low, space.high, (STEPS, *space.shape))


def run(env: Any, start: Array | None = None, before: Any = None) -> tuple[Array, Array, Array]:
    """Returns the observations of 1,000 steps with that of the reset, the rewards, and the terminations, which end nothing."""
    observation, _ = env.reset(seed=0)
    if start is not None:
        env.set_state(start, env.data.qvel.copy())
    rows: tuple[list[Any], list[Any], list[Any]] = ([observation], [], [])
    for step, action in enumerate(actions(env)):
        if before is not None:
            before(step)
        observation, reward, terminated, _, _ = env.step(action)
        for row, value in zip(rows, (observation, reward, terminated)):
            row.append(value)
    return np.array(rows[0]), np.array(rows[1], float), np.array(rows[2], float)


def away(ours: Array, theirs: Array) -> Array:
    """Returns how far numbers are away, relative to the largest beside them, the greatest so far in each step."""
    ours, theirs = (values.reshape(len(values), -1) for values in (ours, theirs))
    distance = np.abs(ours - theirs).max(axis=1) / np.maximum(1.0, np.abs(theirs).max(axis=1))
    return np.maximum.accumulate(distance)


def record(name: str, folder: Path) -> None:
    """Records a run on MuJoCo: the states before its steps, what it observed, and how far runs next to it went."""
    import mujoco

    env = make(name)
    spec = mujoco.mjtState.mjSTATE_INTEGRATION
    states: list[Array] = []

    def keep(_: int) -> None:
        state = np.empty(mujoco.mj_stateSize(env.model, spec))
        mujoco.mj_getState(env.model, env.data, state, spec)
        states.append(state)

    observations, rewards, terminations = run(env, before=keep)
    start = env.model.qpos0 * 0 + states[0][1 : 1 + env.model.nq]
    rng = np.random.default_rng(2)
    floor = np.zeros(STEPS + 1)
    for _ in range(STARTS):
        nearby = run(env, start + NEXT * rng.uniform(-1, 1, start.shape))
        floor = np.maximum(floor, away(nearby[0], observations))
    np.savez(
        folder / f"{name}.npz",
        states=np.array(states),
        observations=observations,
        rewards=rewards,
        terminations=terminations,
        floor=floor,
    )


def repeat(path: Path) -> dict[str, float]:
    """Repeats a recording, from MuJoCo's state in each step and from its first state alone."""
    import mujoco

    env = make(path.stem)
    kept = np.load(path)
    spec = mujoco.mjtState.mjSTATE_INTEGRATION

    def put(step: int) -> None:
        mujoco.mj_setState(env.model, env.data, kept["states"][step], spec)

    observations, rewards, terminations = run(env, before=put)
    alone = run(env)
    drift = away(alone[0], kept["observations"])
    return {
        "observations": float(away(observations, kept["observations"])[-1]),
        "rewards": float(away(rewards, kept["rewards"])[-1]),
        "terminations": float(np.abs(terminations - kept["terminations"]).max()),
        "drift": float(drift[-1]),
        "floor": float(kept["floor"][-1]),
        "over_floor": float((drift / np.maximum(kept["floor"], NEXT)).max()),
    }


if __name__ == "__main__":
    import babybench.mujoco

    babybench.mujoco.install()
    print(json.dumps({path.stem: repeat(path) for path in sorted(Path(sys.argv[1]).glob("*.npz"))}))
