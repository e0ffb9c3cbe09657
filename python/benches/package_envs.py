"""The environments of five packages, with one interface; ``packages.py`` runs them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

SEED = 0


class Env:
    """The interface that this script gives to the environments of all packages."""

    def __init__(self, reset: Callable[[], Any], step: Callable[[Any], Any], owner: Any, low: Any, high: Any) -> None:
        """Takes the functions that reset and step it; ``owner`` is searched for its model and state."""
        self.reset, self.step, self.owner = reset, step, owner
        self.low, self.high = (np.clip(np.asarray(bound, np.float64), -1, 1) for bound in (low, high))
        self.halves = False
        """Whether a step begins with its second half, so that the first has to be done again from another state."""

    @property
    def model(self) -> Any:
        """The model of MuJoCo."""
        return _found(self.owner(), "model")

    @property
    def data(self) -> Any:
        """The state of MuJoCo."""
        return _found(self.owner(), "data")


def _found(owner: Any, name: str) -> Any:
    """Returns the model or the state that an environment holds, without the classes that packages wrap around it."""
    value = getattr(owner, name)
    for inner in ("ptr", f"_{name}"):
        value = (
            getattr(value, inner) if hasattr(type(value), inner) or inner in getattr(value, "__dict__", {}) else value
        )
    return value


def flat(value: Any) -> list[float]:
    """Returns the numbers of an observation."""
    if isinstance(value, dict):
        return [number for key in sorted(value) for number in flat(value[key])]
    if isinstance(value, (tuple, list)):
        return [number for part in value for number in flat(part)]
    array = np.asarray(value)
    return [] if array.dtype.kind not in "bifu" else [float(number) for number in array.reshape(-1)]


def _of_gymnasium(make: Callable[[], Any], inner: tuple[str, ...] = ()) -> Env:
    env = make()

    def owner() -> Any:
        found = env.unwrapped
        for name in inner:
            found = getattr(found, name, found)
        return found

    def step(action: Any) -> tuple[Any, float, bool]:
        observation, reward, terminated, truncated, _ = env.step(action.astype(env.action_space.dtype))
        return observation, float(reward), bool(terminated or truncated)

    return Env(lambda: env.reset(seed=SEED)[0], step, owner, env.action_space.low, env.action_space.high)


def _of_dm_control(make: Callable[[], Any]) -> Env:
    env = make()
    spec = env.action_spec()

    def step(action: Any) -> tuple[Any, float, bool]:
        now = env.step(action)
        return now.observation, float(now.reward or 0), now.last()

    made = Env(lambda: env.reset().observation, step, lambda: env.physics, spec.minimum, spec.maximum)
    made.halves = True
    return made


def gymnasium_robotics() -> dict[str, Callable[[], Env]]:
    """The environments that the package registers."""
    import gymnasium
    import gymnasium_robotics

    gymnasium.register_envs(gymnasium_robotics)
    names = [name for name, spec in gymnasium.registry.items() if "gymnasium_robotics" in str(spec.entry_point)]
    inner = ("ant_env", "point_env", "robot_env", "unwrapped")
    return {name: (lambda name=name: _of_gymnasium(lambda: gymnasium.make(name), inner)) for name in names}


def metaworld() -> dict[str, Callable[[], Env]]:
    """The tasks of the package."""
    import gymnasium
    import metaworld  # noqa: F401
    from metaworld.env_dict import ALL_V3_ENVIRONMENTS

    def make(name: str) -> Env:
        return _of_gymnasium(lambda: gymnasium.make("Meta-World/MT1", env_name=name, seed=SEED))

    return {name: (lambda name=name: make(name)) for name in ALL_V3_ENVIRONMENTS}


def dm_control() -> dict[str, Callable[[], Env]]:
    """The tasks of the suite and of ``manipulation``."""
    from dm_control import manipulation, suite

    def of_suite(domain: str, task: str) -> Env:
        return _of_dm_control(lambda: suite.load(domain, task, task_kwargs={"random": SEED}))

    tasks = {f"{domain}/{task}": (lambda d=domain, t=task: of_suite(d, t)) for domain, task in suite.ALL_TASKS}
    for name in manipulation.ALL:
        tasks[f"manipulation/{name}"] = lambda name=name: _of_dm_control(lambda: manipulation.load(name, seed=SEED))
    return tasks


def myosuite() -> dict[str, Callable[[], Env]]:
    """The environments that the package registers."""
    import myosuite
    from myosuite.utils import gym

    def make(name: str) -> Env:
        made = _of_gymnasium(lambda: gym.make(name, seed=SEED), ("sim",))
        made.halves = True
        return made

    return {name: (lambda name=name: make(name)) for name in sorted(myosuite.myosuite_env_suite)}


def robosuite() -> dict[str, Callable[[], Env]]:
    """The environments that the package registers, with one Panda, or two for tasks with two arms."""
    import robosuite
    from robosuite.environments.base import REGISTERED_ENVS

    def make(name: str) -> Env:
        robots = ["Panda", "Panda"] if name.startswith("TwoArm") else "Panda"
        settings = {"has_renderer": False, "has_offscreen_renderer": False, "use_camera_obs": False, "seed": SEED}
        env = robosuite.make(name, robots=robots, **settings)
        low, high = env.action_spec

        def step(action: Any) -> tuple[Any, float, bool]:
            observation, reward, done, _ = env.step(action)
            return observation, float(reward), bool(done)

        return Env(env.reset, step, lambda: env.sim, low, high)

    return {name: (lambda name=name: make(name)) for name in REGISTERED_ENVS}


SOURCES = {"gymnasium-robotics": gymnasium_robotics, "metaworld": metaworld, "dm_control": dm_control} | {
    "myosuite": myosuite,
    "robosuite": robosuite,
}
