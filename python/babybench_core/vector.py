"""Many environments at once: Gymnasium's vector interface, and EnvPool's halves of a step."""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping, Sequence
from enum import Enum
from numbers import Real
from typing import Any, Optional, Union

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector.utils import batch_space

from babybench_core import _native, changes, hints, locks, scenes, spaces
from babybench_core.goals import Infos, compute_reward
from babybench_core.records import LockReport
from babybench_core.senses import Proprioception, TouchLayout

try:
    from gymnasium.vector import AutoresetMode
except ImportError:  # Gymnasium before 1.1

    class AutoresetMode(Enum):  # type: ignore[no-redef]
        """When an environment starts the next episode."""

        NEXT_STEP = "NextStep"
        SAME_STEP = "SameStep"
        DISABLED = "Disabled"


__all__ = ["AutoresetMode", "VectorEnv"]

Observations = dict[str, npt.NDArray[Any]]
"""Observations of all environments, by name: a row for each."""

Mask = npt.NDArray[np.bool_]

_MODES = {
    AutoresetMode.NEXT_STEP: "next_step",
    AutoresetMode.SAME_STEP: "same_step",
    AutoresetMode.DISABLED: "disabled",
}
# before 1.0 every Gymnasium vector resets in the same step
_USUAL = AutoresetMode.NEXT_STEP if hasattr(gymnasium.vector, "AutoresetMode") else AutoresetMode.SAME_STEP


_EACH = ("array", "change_model", "compute_reward", "info", "lock", "restore", "set_age", "snapshot", "unlock")
"""Methods that take the number of an environment first."""

_SINGLE = {
    "action_space": "single_action_space",
    "dt": "dt",
    "observation_space": "single_observation_space",
    "proprioception": "proprioception",
    "render_mode": "render_mode",
    "spec": "spec",
    "touch": "touch",
}
"""Attributes that a vector's environments share, and the names of the vector's attributes for them."""


def _population(config: dict[str, Any], num_envs: int) -> tuple[dict[str, Any], ...]:
    """Returns the configurations of environments that have one, each with the next infant of its population."""
    if not config["body_random"]:
        return (config,) * num_envs
    return tuple({**config, "body_number": config["body_number"] + number} for number in range(num_envs))


class VectorEnv(gymnasium.vector.VectorEnv):  # type: ignore[type-arg, unused-ignore]
    """Environments that are stepped together, on all cores.

    Environment i returns the same bits as if it were alone, for any number of threads. While threads
    step, Python's lock is free.

    Information comes as arrays over environments: ``steps`` (N), and by behavior ``touches`` (N, 2, geoms), which geoms
    the right and the left palm have touched in this episode, 1 or 0; or ``regards`` (N, 4), how many steps the right hand,
    then the left, was in the view of the right eye, then of the left, with ``page_regards`` and ``kit_regards``, counted as
    BabyBench's page describes it and as the kit does. ``envs.info(i)`` has the lists and names of one
    environment. An environment whose simulation diverges is truncated and restarts; ``infos["failure"]`` has the reason.

    Example:
        >>> import babybench
        >>> envs = babybench.VectorEnv("self_touch", num_envs=4)
        >>> observations, infos = envs.reset(seed=0)  # environment i is seeded with i
        >>> observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
        >>> observations["touch"].shape
        (4, 17169)
        >>> envs.close()
    """

    single_action_space: gymnasium.spaces.Box  # type: ignore[assignment, unused-ignore]
    single_observation_space: gymnasium.spaces.Dict  # type: ignore[assignment, unused-ignore]

    def __init__(
        self,
        config: Union[scenes.ConfigLike, Sequence[scenes.ConfigLike]] = "self_touch",
        num_envs: Optional[int] = None,
        *,
        autoreset_mode: Union[AutoresetMode, str, None] = None,
        threads: int = 0,
        copy: bool = True,
        render_mode: Optional[str] = None,
        camera: Optional[str] = None,
        assets: Optional[Union[str, os.PathLike[str]]] = None,
        max_memory: Optional[int] = None,
        **keys: object,
    ) -> None:
        """Builds a vector.

        Args:
            config: The configuration of all environments (an example, a mapping or the path of a YAML file), or a list with
                one for each; scenes and behaviors may differ, spaces may not. With ``body_random`` each environment of one
                configuration has another infant of the population.
            num_envs: How many; by default 1, or the length of the list.
            autoreset_mode: When the next episode starts: Gymnasium's ``AutoresetMode`` or its value (``"NextStep"``,
                ``"SameStep"``, ``"Disabled"``). By default as Gymnasium's own vectors do.
            threads: How many threads step environments; 0 means one for each core.
            copy: Whether observations, rewards and flags are fresh arrays. Otherwise they are read-only views of the
                arrays that threads write into: nothing is copied, and the next step or reset changes them.
            render_mode: ``None`` or ``"rgb_array"``.
            camera: The camera of :meth:`render`; by default ``corner``, or the left eye in the scene of a task.
            assets: A folder with MJCF and textures laid out like the kit's.
            max_memory: How much memory the environments may take, bytes; by default what the system has available.
            **keys: Keys that replace those of every configuration.

        Raises:
            ValueError: A value is not allowed, or spaces differ.
            MemoryError: More environments than fit; the text says how many would.
        """
        configs = [config] if config is None or isinstance(config, (str, os.PathLike, Mapping)) else list(config)
        num_envs = len(configs) if num_envs is None else changes.whole("num_envs", num_envs, 1)
        threads = changes.whole("threads", threads, 0)
        if len(configs) not in (1, num_envs):
            raise ValueError(f"num_envs is {num_envs}, but there are {len(configs)} configurations")
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode is {render_mode!r}, expected None or rgb_array")
        mode = _USUAL if autoreset_mode is None else _mode(autoreset_mode)
        full = [scenes.read_config(one, **keys) for one in configs]
        if len({one["vision_lazy"] for one in full}) > 1:
            raise ValueError(
                "vision_lazy is True in some configurations and False in others; it must be the same in all"
            )
        self.config: dict[str, Any] = full[0]
        """The configuration of the first environment."""
        self._assets = None if assets is None else os.fspath(assets)
        self._limits = (threads, max_memory)
        self._copy = copy
        # two copies of observations, of the last step and of this one, and two of the last observations of ended episodes;
        # the arrays that threads write into replace the vector's own
        self._kept = 2 * copy + 2 * (mode is AutoresetMode.SAME_STEP)
        self.autoreset_mode = mode
        shared = scenes.blueprint(full[0], self._assets)  # kept until the environments share it
        _native.VectorEnv.check_memory(shared, num_envs, _MODES[mode], *self._limits, self._kept)
        self.configs: tuple[dict[str, Any], ...] = (
            tuple(full) if len(full) == num_envs else _population(full[0], num_envs)
        )
        """The configurations of all environments. With ``body_random``, those of one configuration differ in ``body_number``."""
        self._build()
        self._camera = scenes.camera_of(self._blueprints[0], camera)
        self._everyone: Mask = np.ones(num_envs, np.bool_)
        self.dt: float = self._blueprints[0].model_options["timestep"] * self.config["frame_skip"]
        """The time between two steps, s."""
        self.num_envs = num_envs
        self.render_mode = render_mode
        low, high = self._core.action_bounds
        self.single_action_space = spaces.action_space((low, high))
        self.single_observation_space = spaces.observation_space(self._core)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = spaces.batch(self.single_observation_space, num_envs)
        self.metadata = {"render_modes": ["rgb_array"], "render_fps": 200, "autoreset_mode": mode}
        self.spec = None
        self.closed = False
        self._order: Optional[npt.NDArray[np.intp]] = None
        self._sent: Optional[npt.NDArray[np.float32]] = None

    def _build(self) -> None:
        """Builds the environments; those of one configuration share a scene."""
        made: dict[int, _native.Blueprint] = {}
        for config in self.configs:
            if id(config) not in made:
                made[id(config)] = scenes.blueprint(config, self._assets)
        self._blueprints = tuple(made[id(config)] for config in self.configs)
        lazy = self.config["vision_lazy"]
        self._core = _native.VectorEnv(self._blueprints, _MODES[self.autoreset_mode], *self._limits, lazy, self._kept)

    # --- Gymnasium ---

    def reset(  # type: ignore[override, unused-ignore]
        self,
        *,
        seed: Union[int, Sequence[Optional[int]], None] = None,
        options: Optional[Mapping[str, Any]] = None,
    ) -> tuple[Observations, dict[str, Any]]:
        """Starts an episode in all environments.

        Args:
            seed: With one seed, environment i gets the seed plus i; a list has one, or none, for each.
            options: ``reset_mask`` (N), bool: which environments to reset; the rows of the others stay. ``age`` of those that
                are reset, months, one or a list with one for each: :meth:`set_age`. ``model``: changes of their model, one
                mapping or a list with one, or ``None``, for each: :meth:`change_model`.

        Returns:
            Observations and information.

        Raises:
            ValueError: There is no such option.
        """
        options = changes.options_of(options, (*changes.OPTIONS, "reset_mask"))
        mask = options.get("reset_mask")
        if mask is not None:
            mask = np.asarray(mask)
            if mask.shape != (self.num_envs,) or mask.dtype != np.bool_:
                expected = f"bool of shape ({self.num_envs},)"
                raise ValueError(f"reset_mask is {mask.dtype} of shape {mask.shape}, expected {expected}")
        if isinstance(seed, Sequence) and len(seed) != self.num_envs:
            raise ValueError(f"there are {len(seed)} seeds, but {self.num_envs} environments")
        begins = np.flatnonzero(self._everyone if mask is None else mask)
        ages = changes.of_vector("age", options["age"], self.num_envs, Real) if "age" in options else None
        models = changes.of_vector("model", options.get("model"), self.num_envs, Mapping)
        for env in begins.tolist():
            if ages is not None:
                self.set_age(env, ages[env])
            if models[env] is not None:
                self.change_model(env, models[env])
        self._order = None
        return self._core.reset(seed, mask, self._copy), self._infos()

    def step(self, actions: npt.ArrayLike) -> tuple[Observations, npt.NDArray[np.float64], Mask, Mask, dict[str, Any]]:
        """Applies an action in each environment, (N, action size), and waits for all of them.

        Returns:
            Observations, rewards, terminated, truncated, information; a row for each environment. Without a task rewards
            are 0 and nothing terminates. With
            ``SAME_STEP``, the ends of episodes are in ``final_obs`` and ``final_info``.

        Raises:
            ValueError: Actions of another shape, or with numbers that are not finite; nothing changes then.
            RuntimeError: Environments that need a reset, or are in flight.
        """
        self._order = None
        observations = self._core.step(actions, self._copy)
        return observations, *self._given(*self._core.flags), self._infos()

    def step_async(self, actions: npt.ArrayLike) -> None:
        """Sends all environments an action and returns at once; :meth:`step_wait` waits for them."""
        self._core.send(actions, np.arange(self.num_envs))

    def step_wait(self, **_: object) -> tuple[Observations, npt.NDArray[np.float64], Mask, Mask, dict[str, Any]]:
        """Waits for the step that :meth:`step_async` began; rows are in the order of the environments."""
        received, rewards, terminated, truncated, ids = self._core.recv(self.num_envs)
        order = self._order = np.argsort(ids)
        infos = self._infos(ids)
        rows = {key: rows[order] for key, rows in received.items()}
        ordered = {key: rows[order] for key, rows in infos.items()}
        return rows, rewards[order], terminated[order], truncated[order], ordered

    def eyes(self) -> Observations:
        """Returns the images of the last observations, a row for each environment that was returned.

        With ``vision_lazy`` neither observations nor spaces have images, and only this draws them, on all threads; call it before
        the next step. Called twice, it draws once.

        Raises:
            RuntimeError: An environment has been sent on.
        """
        seen = self._core.eyes(self._copy)
        return seen if self._order is None else {key: rows[self._order] for key, rows in seen.items()}

    def render(self) -> Optional[tuple[npt.NDArray[np.uint8], ...]]:
        """Draws the rooms, (render_size, render_size, 3) each, with ``render_mode="rgb_array"``."""
        if self.render_mode is None:
            gymnasium.logger.warn('render() draws nothing: make the vector with render_mode="rgb_array"')
            return None
        size = self.config["render_size"]
        return tuple(self._core.render(env, self._camera, size, size) for env in range(self.num_envs))

    def close(self, **_: object) -> None:
        """Ends the threads and frees the environments. Later calls raise ``RuntimeError``."""
        self.closed = True
        self._core.close()

    def close_extras(self, **_: object) -> None:
        """Does nothing: :meth:`close` is enough."""

    def __del__(self) -> None:
        """Does nothing: the native part ends its threads when it is freed."""

    # --- EnvPool ---

    def send(
        self, actions: npt.ArrayLike, ids: Optional[Union[Sequence[int], npt.NDArray[np.integer[Any]]]] = None
    ) -> None:
        """Sends an action to each of some environments, (K, action size), and returns at once.

        Args:
            actions: The actions.
            ids: Which environments; all of them by default.

        Raises:
            ValueError: Actions of another shape, or with numbers that are not finite; nothing is sent then.
            IndexError: The environment does not exist.
            RuntimeError: An environment is already under way, or needs a reset.
        """
        self._core.send(actions, np.arange(self.num_envs) if ids is None else ids)

    def recv(
        self, batch_size: Optional[int] = None
    ) -> tuple[Observations, npt.NDArray[np.float64], Mask, Mask, dict[str, Any]]:
        """Waits for the first environments that are ready, so that a slow one does not hold up the others.

        Args:
            batch_size: The number of environments to wait for; by default all that are under way.

        Returns:
            As :meth:`step`, a row for each of them; ``info["env_id"]`` has their numbers.

        Raises:
            RuntimeError: Fewer are under way.
        """
        self._order = None
        wanted = self._core.in_flight if batch_size is None else batch_size
        received, rewards, terminated, truncated, ids = self._core.recv(wanted, self._copy)
        return received, *self._given(rewards, terminated, truncated), self._infos(ids)

    # --- what the numbers are ---

    @functools.cached_property
    def proprioception(self) -> Proprioception:
        """The layout of a row of ``observation``."""
        return Proprioception(_native.Env(self._blueprints[0], False))

    @functools.cached_property
    def touch(self) -> TouchLayout:
        """The layout of a row of ``touch``.

        Raises:
            ValueError: Touch is off.
        """
        return TouchLayout(_native.Env(self._blueprints[0], False))

    # --- each environment ---

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Calls a method of one environment (``info``, ``snapshot``, ``lock``, ...) for each of them, as Gymnasium's vectors do.

        An attribute that is not a method is returned, once for each environment.

        Example:
            >>> import babybench
            >>> envs = babybench.VectorEnv("self_touch", num_envs=2, vision_active=False)
            >>> observations, infos = envs.reset(seed=0)
            >>> [round(float(state[2]), 2) for state in envs.call("array", "qpos")]
            [0.3, 0.3]

        Raises:
            AttributeError: The method or attribute does not exist.
        """
        values = self.get_attr(name)
        return tuple(value(*args, **kwargs) if callable(value) else value for value in values)

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Returns an attribute of one environment for each of them: ``config``, ``action_space``, or a method such as ``info``.

        Raises:
            AttributeError: The attribute does not exist.
        """
        if name in _EACH:
            method = getattr(self, name)
            return tuple(functools.partial(method, env) for env in range(self.num_envs))
        if name == "config":
            return self.configs
        if name in _SINGLE:
            return (getattr(self, _SINGLE[name]),) * self.num_envs
        known = ", ".join(sorted([*_EACH, *_SINGLE, "config"]))
        raise AttributeError(f"environments of a vector have no {name!r}; they have {known}")

    def set_attr(self, name: str, values: Any) -> None:
        """Raises an error: environments of a vector have no attributes that can be set.

        Raises:
            AttributeError: Always.
        """
        raise AttributeError(
            f"cannot set {name!r}: environments of a vector have no attributes of their own; their configurations can differ "
            "(a list of them), and change_model, set_age, lock, restore and reset take the number of an environment: "
            'with env_method("change_model", ...) of a vector of Stable-Baselines3'
        )

    # --- one environment ---

    def info(self, env: int) -> dict[str, Any]:
        """Returns the information of one environment as :class:`babybench.Env` gives it, with lists and names."""
        return self._core.info(env)

    def compute_reward(
        self, env: int, achieved_goal: npt.ArrayLike, desired_goal: npt.ArrayLike, info: Infos
    ) -> Union[float, npt.NDArray[np.float64]]:
        """Computes the rewards of goals in one environment: see :meth:`babybench.Env.compute_reward`."""
        reward = functools.partial(self._core.compute_reward, env)
        return compute_reward(reward, achieved_goal, desired_goal, info, self._core.reward_terms)

    def snapshot(self, env: int) -> bytes:
        """Takes a snapshot of one environment, for :meth:`restore` and for that of a single :class:`Env`."""
        return self._core.snapshot(env)

    def restore(self, env: int, snapshot: bytes) -> None:
        """Takes one environment back to a snapshot; its row follows with the next step."""
        self._core.restore(env, snapshot)

    def lock(self, env: int, target: Union[str, int], angle: float = 0.0) -> LockReport:
        """Locks a joint, or all joints of a part, of one environment at an angle in rad."""
        with locks.known(target, self._blueprints[env]):
            return locks.within_limits(self._core.lock(env, target, angle), angle, self._blueprints[env])

    def unlock(self, env: int, target: Union[str, int]) -> LockReport:
        """Unlocks a joint, or all joints of a part, of one environment."""
        with locks.known(target, self._blueprints[env]):
            return self._core.unlock(env, target)

    def array(self, env: int, name: str, element: Optional[str] = None) -> npt.NDArray[Any]:
        """Returns a copy of an array of the scene or of the state of one environment: see :meth:`babybench.Env.array`."""
        state, model = self._core.state_array, self._core.model_array
        array = changes.read(name, functools.partial(state, env), functools.partial(model, env))
        return array if element is None else array[changes.rows_of(name, element, self._blueprints[env])]

    def change_model(self, env: int, model: changes.Changes) -> None:
        """Changes numbers of the model of one environment from its next step: see :meth:`babybench.Env.change_model`."""
        present = functools.partial(self._core.model_array, env)
        self._core.change_model(env, changes.arrays(model, present, self._blueprints[env]))

    def set_age(self, env: int, age: Optional[float]) -> None:
        """Sets the age of one environment's MIMo, months. It then needs a reset: see :meth:`babybench.Env.set_age`.

        Raises:
            ValueError: An age that is not allowed, or at which the observation has another shape, as without ``touch_grows``;
                nothing changes then.
        """
        config = self._core.set_age(env, None if age is None else float(age))
        self.configs = (*self.configs[:env], config, *self.configs[env + 1 :])
        if env == 0:
            self.config = config

    @property
    def threads(self) -> int:
        """Number of threads that step environments."""
        return self._core.threads

    # --- inside ---

    def _given(
        self, rewards: npt.NDArray[np.float64], terminated: Mask, truncated: Mask
    ) -> tuple[npt.NDArray[np.float64], Mask, Mask]:
        """Returns copies or views for the caller."""
        return (rewards.copy(), terminated.copy(), truncated.copy()) if self._copy else (rewards, terminated, truncated)

    def _infos(self, ids: Optional[npt.NDArray[np.int64]] = None) -> dict[str, Any]:
        """Returns the information of the last rows in Gymnasium's layout: each array with a mask of environments."""
        infos: dict[str, Any] = self._core.infos()
        rows = self.num_envs if ids is None else len(ids)
        everyone = self._everyone if rows == self.num_envs else np.ones(rows, np.bool_)
        infos.update({f"_{key}": everyone for key in list(infos)})
        if ids is not None:
            infos["env_id"] = ids
        row_of = (lambda env: env) if ids is None else {int(env): row for row, env in enumerate(ids)}.__getitem__
        failures = [(row_of(env), text) for env, text in self._core.failures()]
        if failures:
            infos.update(_sparse("failure", rows, failures))
        if self.autoreset_mode is AutoresetMode.SAME_STEP:
            self._add_ends(infos, rows, row_of)
        return infos

    def _add_ends(self, infos: dict[str, Any], rows: int, row_of: Any) -> None:
        ends = self._core.final_observations()
        if not ends:
            return
        observations = [(row_of(env), observation) for env, observation in ends]
        details = [(row_of(env), self._core.final_info(env)) for env, _ in ends]
        for key in ("final_obs", "final_observation"):
            infos.update(_sparse(key, rows, observations))
        infos.update(_sparse("final_info", rows, details))

    def __getstate__(self) -> dict[str, Any]:
        """Returns the state that a copy needs to continue with the same bits.

        Raises:
            RuntimeError: Environments are under way.
        """
        state = self.__dict__.copy()
        for made in ("_core", "_blueprints", "proprioception", "touch"):
            state.pop(made, None)
        state["_snapshots"] = None if self.closed else self.call("snapshot")
        state["_changes"] = [] if self.closed else [self._core.model_changes(env) for env in range(self.num_envs)]
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Builds the copy."""
        snapshots, changed = state.pop("_snapshots"), state.pop("_changes")
        self.__dict__.update(state)
        self._build()
        for env, numbers in enumerate(changed):
            self._core.change_model(env, numbers)
        if snapshots is None:
            self._core.close()
        else:
            for env, snapshot in enumerate(snapshots):
                self._core.restore(env, snapshot)

    def __repr__(self) -> str:
        return f"<babybench.VectorEnv of {self.num_envs}>"


def _mode(mode: Union[AutoresetMode, str]) -> AutoresetMode:
    """Returns a mode by its value.

    Raises:
        ValueError: The mode does not exist.
    """
    try:
        return AutoresetMode(mode)
    except ValueError:
        known = ", ".join(repr(one.value) for one in AutoresetMode)
        meant = hints.nearest(str(mode), [one.value for one in AutoresetMode])
        raise ValueError(f"autoreset_mode is {mode!r}, expected one of {known}{meant}") from None


def _sparse(key: str, rows: int, entries: Sequence[tuple[int, object]]) -> dict[str, Any]:
    """Returns an array of objects that some rows have, and the mask of those rows."""
    values = np.full(rows, None, dtype=object)
    mask = np.zeros(rows, np.bool_)
    for row, value in entries:
        values[row] = value
        mask[row] = True
    return {key: values, f"_{key}": mask}
