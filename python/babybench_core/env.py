"""One environment, behind the current Gymnasium interface."""

from __future__ import annotations

import os
import weakref
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Optional, Union

import gymnasium
import numpy as np
import numpy.typing as npt

from babybench_core import _native, changes, hints, locks, looks, scenes, spaces
from babybench_core.goals import ComputeReward, compute_reward
from babybench_core.records import LockReport
from babybench_core.scene_access import SceneAccess
from babybench_core.senses import Proprioception, Touch
from babybench_core.window import Window

Observation = dict[str, npt.NDArray[Any]]
"""MIMo's sensations by name: see :class:`Env`."""


class Env(SceneAccess, gymnasium.Env[Observation, npt.NDArray[Any]]):
    """MIMo in a room: an environment of BabyBench.

    The action is a vector of motor commands (``action_space``, float32); values out of bounds are clipped. BabyBench's
    behaviors have no extrinsic reward (always 0), and no end but truncation after ``max_episode_steps``; tasks (``reach``,
    ``standup``, ``selfbody``, ``catch``, ``roll_over``, ``mobile``, ``play``) have both. The observation has an entry for
    each sense that the configuration turns on:

    | entry           | type    | meaning                                                                              |
    |-----------------|---------|--------------------------------------------------------------------------------------|
    | `observation`   | float64 | proprioception: rad, rad/s, N m (`env.proprioception` describes the layout)          |
    | `touch`         | float32 | forces on the skin, N (`env.touch`)                                                  |
    | `touch_pooled`  | float64 | for each body normal force, N, active sensors, and force, N, (bodies, 5)             |
    | `pain`          | float32 | pain, a number for each touch sensor                                                 |
    | `eye_left`      | uint8   | what the left eye sees, (height, width, 3), red, green, blue, from the top           |
    | `eye_right`     | uint8   | what the right eye sees                                                              |
    | `vestibular`    | float64 | linear acceleration (m/s^2, 3) and angular velocity (rad/s, 3) of the head           |
    | `reflexes`      | float64 | how strongly each of ``env.reflexes`` acts, 0 to 1                                 |
    | `achieved_goal` | float64 | in tasks with goals: the achieved goal                                               |
    | `desired_goal`  | float64 | in tasks with goals: the desired goal                                                |

    Arrays are fresh with every step, unless ``views`` is set. With ``vision_lazy`` images are left out: :meth:`eyes` draws them.

    The information has ``steps`` and, by behavior, ``right_hand_touches`` and ``left_hand_touches`` (ids of the geoms that
    the palm has touched in this episode) with their names in ``right_hand_parts`` and ``left_hand_parts``; or how many
    steps each hand was in the view of each eye (``right_eye_left_hand``, ...), and ``gaze_angles`` (rad). With a task it has
    its name (``task``), ``is_success``, ``is_failure``, the ``return`` of the episode so far and ``reward_terms``, the values
    besides goals that the reward depends on, for :meth:`compute_reward`. With ``reflexes`` it has ``reflex_NAME``, the share of
    the episode's physics steps in which that reflex acted.

    Example:
        >>> import babybench
        >>> env = babybench.make("self_touch", vision_active=False)
        >>> observation, info = env.reset(seed=0)
        >>> observation["touch"].shape
        (17169,)
        >>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        >>> info["steps"]
        1
    """

    action_space: gymnasium.spaces.Box  # type: ignore[assignment, unused-ignore]
    observation_space: gymnasium.spaces.Dict  # type: ignore[assignment, unused-ignore]

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array", "depth_array"], "render_fps": 200}  # noqa: RUF012

    def __init__(
        self,
        config: scenes.ConfigLike = None,
        *,
        render_mode: Optional[str] = None,
        camera: Optional[str] = None,
        assets: Optional[Union[str, os.PathLike[str]]] = None,
        views: bool = False,
        **keys: object,
    ) -> None:
        """Builds an environment.

        Args:
            config: A mapping, the name of an example, the path of a YAML file, or nothing for the defaults.
            render_mode: ``None``, ``"rgb_array"``, ``"depth_array"`` (m) or ``"human"``: a window by pygame, in real time, in
                which the pointer turns the camera and pulls bodies, and keys pause (space), take one step (right), change the
                speed (up, down), show contacts (c) and touch (t). Once it is closed, steps are as fast as without it.
            camera: The camera of :meth:`render`; by default ``corner``, or the left eye in the scene of a task; a window begins
                with one that looks at MIMo.
            assets: A folder with MJCF and textures laid out like the kit's, instead of those that come with the package.
            views: Observations are read-only arrays that stay the same and change with the next step or reset: nothing
                is allocated. Copy what you keep.
            **keys: Keys of the configuration that replace those of ``config``; ``babybench.config_keys()`` lists them.

        Raises:
            FileNotFoundError: The file or folder does not exist.
            ValueError: An unknown key, a value that is not allowed, assets that cannot be read. A keyword that is not a key is
                a ``TypeError``, too.
        """
        modes = self.metadata["render_modes"]
        if render_mode is not None and render_mode not in modes:
            raise ValueError(f"render_mode is {render_mode!r}, expected None or one of {', '.join(modes)}")
        self.render_mode = render_mode
        self.config: dict[str, Any] = scenes.read_config(config, **keys)
        """All keys of the configuration with their values."""
        self._assets = None if assets is None else os.fspath(assets)
        self._views = views
        self._window: Optional[Window] = None
        self._recorders: weakref.WeakSet[Any] = weakref.WeakSet()
        self._build()
        self.action_space = spaces.action_space(self._core.action_bounds)
        self.observation_space = spaces.observation_space(self._core)
        self.camera = scenes.camera_of(self._core.blueprint, camera)
        self._window_camera = camera
        self.metadata = {**self.metadata, "render_fps": round(1 / self.dt)}

    def _build(self) -> None:
        self._core = _native.Env(scenes.blueprint(self.config, self._assets), self._views, self.config["vision_lazy"])

    @property
    def dt(self) -> float:
        """The time between two steps, s."""
        return self._core.dt

    # --- Gymnasium ---

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Mapping[str, object]] = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Starts an episode.

        Args:
            seed: Reseeds every random choice; without it, the generators continue. Under ``compat: reference`` it seeds nothing.
            options: What changes before the episode: ``age`` in months (:meth:`set_age`), then ``model``, numbers of the model
                (:meth:`change_model`).

        Returns:
            The observation and the information.

        Raises:
            ValueError: There is no such option.
        """
        seed, wanted = changes.seed_of(seed), changes.options_of(options)
        super().reset(seed=seed)
        if "age" in wanted:
            self.set_age(wanted["age"])
        if wanted.get("model") is not None:
            self.change_model(wanted["model"])
        observation = self._core.reset(seed)
        self._follow_age()
        self._show(0.0)
        return observation, self._core.info()

    def step(self, action: npt.NDArray[Any]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Applies an action for ``frame_skip`` physics steps of 5 ms.

        Returns:
            Observation, reward (0 without a task), terminated (False without a task), truncated, information.

        Raises:
            ValueError: An action of another shape, or with numbers that are not finite; nothing changes then.
            RuntimeError: The simulation diverged, or there was no reset; reset it.
        """
        observation, reward, terminated, truncated = self._core.step(action)
        self._show(self.dt)
        return observation, reward, terminated, truncated, self._core.info()

    @property
    def compute_reward(self) -> ComputeReward:
        """Computes the rewards of goals, as Gymnasium-Robotics does. For the goals of a step, it returns that step's reward.

        It is called as ``compute_reward(achieved_goal, desired_goal, info)``, with goals of the shape (goal,) and the
        information of the step, or with K goals, (K, goal), and the information of K steps; it returns the reward, or K of
        them. Only environments with goals have it, because learners recognize them by it.

        Raises:
            AttributeError: The observation has no goals.
            KeyError: When it is called: information without ``reward_terms``.
            ValueError: When it is called: goals of another shape.
        """
        if "desired_goal" not in self.observation_space.spaces:
            raise AttributeError(hints.ENV["compute_reward"])
        reward, terms = self._core.compute_reward, self._core.reward_terms
        return lambda achieved_goal, desired_goal, info: compute_reward(
            reward, achieved_goal, desired_goal, info, terms
        )

    def set_goal(self, desired_goal: npt.ArrayLike) -> Observation:
        """Changes the desired goal of this episode; returns the observation with it.

        Raises:
            ValueError: A goal of another shape, or with numbers that are not finite.
        """
        if "desired_goal" not in self.observation_space.spaces:
            raise ValueError(
                "set_goal: this environment has no goals; tasks with goals are reach, standup, selfbody and roll_over"
            )
        return self._core.set_goal(desired_goal)

    def render(self) -> Optional[npt.NDArray[Any]]:  # type: ignore[override, unused-ignore]
        """Draws the room from ``camera``: ``render_size`` by ``render_size`` pixels.

        Returns:
            (height, width, 3) bytes for ``rgb_array``, (height, width) m for ``depth_array``, nothing for ``human``.
        """
        size = self.config["render_size"]
        if self.render_mode == "rgb_array":
            return self._core.render(self.camera, size, size)
        if self.render_mode == "depth_array":
            return self._core.depth(self.camera, size, size)
        if self.render_mode is None:
            gymnasium.logger.warn('render() draws nothing: make the environment with render_mode="rgb_array"')
        return None

    def close(self) -> None:
        """Frees the environment and closes the window. Later calls raise ``RuntimeError``.

        The episode that a :class:`babybench.data.Recorder` is recording ends.
        """
        for recorder in list(self._recorders):
            recorder.end()
        if self._window is not None:
            self._window.close()
            self._window = None
        self._core.close()

    def _show(self, seconds: float) -> None:
        if self.render_mode != "human":
            return
        if self._window is None:
            size = self.config["render_size"]
            self._window = Window("BabyBench", self._core, (size, size), self._window_camera)
        self._window.show(seconds)

    # --- pictures ---

    def eyes(self) -> Observation:
        """Returns the images of the last observation: ``eye_left`` and ``eye_right``, unless configured otherwise.

        With ``vision_lazy`` neither observations nor ``observation_space`` have images, and only this draws them, with the bits
        that they have otherwise; call it before the next step. Called twice, it draws once.

        Example:
            >>> import babybench
            >>> env = babybench.make("hand_regard", vision_lazy=True)
            >>> observation, info = env.reset(seed=0)
            >>> list(observation)
            ['observation']
            >>> env.eyes()["eye_left"].shape
            (64, 64, 3)
        """
        return self._core.eyes()

    def picture(
        self,
        camera: Union[str, tuple[Sequence[float], float, float, float]],
        width: int = 480,
        height: int = 480,
    ) -> npt.NDArray[np.uint8]:
        """Draws from a camera.

        Args:
            camera: ``corner``, ``top``, ``side1``, ``side2``, ``closeup``, ``eye_left`` or ``eye_right``; or one anywhere: the
                point that it looks at (m), distance (m), azimuth and elevation (degrees).
            width: Pixels.
            height: Pixels.

        Returns:
            (height, width, 3): red, green, blue, rows from the top.

        Raises:
            KeyError: The camera does not exist.
        """
        return self._core.render(camera, width, height)

    def depth(self, camera: str = "eye_left", width: int = 64, height: int = 64) -> npt.NDArray[np.float32]:
        """Draws distances from a camera's plane, (height, width), m; infinite where there is nothing."""
        return self._core.depth(camera, width, height)

    def segmentation(self, camera: str = "eye_left", width: int = 64, height: int = 64) -> npt.NDArray[np.int32]:
        """Draws the id of the geom in each pixel, (height, width); -1 in the background (names: ``geom_names``)."""
        return self._core.segmentation(camera, width, height)

    # --- what the numbers are ---

    @cached_property
    def proprioception(self) -> Proprioception:
        """The layout of ``observation``."""
        return Proprioception(self._core)

    @cached_property
    def touch(self) -> Touch:
        """The layout of ``touch``, and touch beyond the vector.

        Raises:
            ValueError: Touch is off.
        """
        return Touch(self._core)

    @property
    def reflexes(self) -> list[str]:
        """Names of the reflexes that act on MIMo, in the order of the entry ``reflexes`` of the observation."""
        return list(self._core.reflexes)

    def set_age(self, age: Optional[float]) -> None:
        """Sets MIMo's age, 0 to 24 months, or restores his own proportions (``None``); the next call must be a reset.

        Locks and the random generator are kept; changes to the model are lost. Names and ids are the same at every age. So is
        ``observation_space``, except for the length of touch without ``touch_grows``.

        Example:
            >>> import babybench
            >>> env = babybench.make("self_touch", touch_grows=True, age=1)
            >>> for age in (3, 6):
            ...     env.set_age(age)
            ...     observation, info = env.reset(seed=0)
            >>> env.config["age"]
            6.0

        Raises:
            ValueError: An age that is not allowed; nothing changes then.
        """
        self.config = self._core.set_age(None if age is None else float(age))
        self._forget_layouts()
        self.observation_space = spaces.observation_space(self._core)

    def _forget_layouts(self) -> None:
        for layout in ("proprioception", "touch"):
            self.__dict__.pop(layout, None)

    def _follow_age(self) -> None:
        """Takes over the age of a MIMo who grows by ``age_schedule``."""
        age = self._core.age
        if age != self.config["age"]:
            self.config = {**self.config, "age": age}
            self._forget_layouts()

    # --- other moments ---

    def snapshot(self) -> bytes:
        """Takes a snapshot; :meth:`restore` returns to it and continues with the same bits."""
        return self._core.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Goes back to a snapshot of this environment, or of another of the same configuration.

        Touch and images are those of that moment from the next step on.

        Raises:
            ValueError: A snapshot of another environment, or a damaged one; nothing changes then.
        """
        self._core.restore(snapshot)
        self._follow_age()

    def swap_facial_expression(self, expression: str) -> None:
        """Changes MIMo's face: ``default``, ``happy``, ``sad``, ``surprised``, ``angry``, ``disgusted``, ``scared``.

        Nothing but pictures changes; the next step has the same bits as without.

        Raises:
            ValueError: The face does not exist; nothing changes then.
        """
        old, core, snapshot = self.config, self._core, self._core.snapshot()
        self.config = _native.config_from_mapping({**old, "facial_expression": expression})
        try:
            self._build()
            # before the first reset there is nothing to see
            if core.ready:
                self._core.resume(snapshot)
            else:
                self._core.restore(snapshot)
        except Exception:
            self.config, self._core = old, core
            raise
        core.close()

    def set_state(self, qpos: npt.ArrayLike, qvel: npt.ArrayLike) -> Observation:
        """Moves the scene to positions (nq; m, rad, quaternions) and velocities (nv; m/s, rad/s) and observes it."""
        return self._core.set_state(qpos, qvel)

    def set_mocap(
        self, body: Union[str, int], pos: Sequence[float], quat: Sequence[float] = (1.0, 0.0, 0.0, 0.0)
    ) -> None:
        """Moves a body with ``mocap="true"`` to a position (world, m) and an orientation (w, x, y, z), from the next step.

        It stays there until it is moved again; a reset returns it to its pose in the document. Bodies of the key
        ``mocap_motion`` follow their paths instead.

        >>> hand = "<body name='hand' mocap='true' pos='.3 0 .3'><geom size='.03'/></body>"
        >>> env = Env({"scene_extra": hand, "vision_active": False})
        >>> _ = env.reset(seed=0)
        >>> env.set_mocap("hand", [0.2, 0.1, 0.4])

        Raises:
            KeyError: The body does not exist.
            ValueError: A number is not finite.
        """
        number = changes.element(body, "body", self._core.blueprint)
        self._core.set_mocap(self.body_names[number], list(pos), list(quat))

    def push(
        self,
        body: Union[str, int],
        force: Sequence[float],
        torque: Sequence[float] = (0.0, 0.0, 0.0),
        point: Optional[Sequence[float]] = None,
    ) -> None:
        """Puts a force and a torque on a body, replacing those of an earlier push; they act until a reset.

        Args:
            body: The name or the id of a body.
            force: N, in the world; zeros remove it.
            torque: N m, in the world.
            point: Where the force acts, m, in the world, at the body's current pose; by default its centre of mass.

        Example:
            >>> import babybench
            >>> env = babybench.make("self_touch", vision_active=False)
            >>> observation, info = env.reset(seed=0)
            >>> env.push("right_hand", force=[0, 0, 5])
            >>> observation, *_ = env.step(env.action_space.sample() * 0)
            >>> env.array("xfrc_applied")[env.body_names.index("right_hand"), :3]
            array([0., 0., 5.])

        Raises:
            KeyError: There is no such body.
            ValueError: A number is not finite.
        """
        number = changes.element(body, "body", self._core.blueprint)
        at = None if point is None else [float(value) for value in point]
        self._core.push(number, [float(value) for value in force], [float(value) for value in torque], at)

    def lock(self, target: Union[str, int], angle: float = 0.0) -> LockReport:
        """Locks a joint (``"robot:right_elbow"``), or all joints of a part (``"head"``), at an angle in rad.

        Locks outlast resets. An angle outside a joint's range is accepted with a warning: the lock and the limit pull
        against each other.

        Raises:
            KeyError: The joint does not exist.
        """
        with locks.known(target, self._core.blueprint):
            return locks.within_limits(self._core.lock(target, angle), angle, self._core.blueprint)

    def unlock(self, target: Union[str, int]) -> LockReport:
        """Unlocks a joint, or all joints of a part."""
        with locks.known(target, self._core.blueprint):
            return self._core.unlock(target)

    def __getattr__(self, name: str) -> Any:
        """Suggests replacements for attributes that the starter kit's environments have.

        Raises:
            AttributeError: Always.
        """
        hints.refuse(self, name, hints.ENV)

    def __getstate__(self) -> dict[str, Any]:
        """Returns the state that a copy needs to continue with the same bits."""
        state = self.__dict__.copy()
        for made in ("_core", "_recorders", "_window", "proprioception", "touch"):
            state.pop(made, None)
        state["_snapshot"] = None if self._core.closed else self._core.snapshot()
        state["_changes"] = {} if self._core.closed else self._core.model_changes
        state["_looks"] = {} if self._core.closed else looks.of(self._core)
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Builds the copy."""
        snapshot, changed, look = state.pop("_snapshot"), state.pop("_changes"), state.pop("_looks")
        self.__dict__.update(state)
        self._window, self._recorders = None, weakref.WeakSet()
        self._build()
        self._core.change_model(changed)
        looks.take(self._core, look)
        if snapshot is None:
            self._core.close()
        else:
            self._core.restore(snapshot)

    def __str__(self) -> str:
        return repr(self)

    def __repr__(self) -> str:
        return f"<babybench.Env {self.config['behavior']} in {self.config['scene']}>"


def make(config: scenes.ConfigLike = "self_touch", **arguments: Any) -> Env:
    """Builds an environment.

    Args:
        config: An example (``self_touch``, ``hand_regard``, ``test_installation``; tasks are ``reach``, ``standup``,
            ``selfbody``, ``catch``, ``roll_over``, ``mobile``, ``play``), a mapping, or the path of a YAML file.
        **arguments: Arguments of :class:`Env`, and keys that replace those of the configuration.

    Example:
        >>> import babybench
        >>> babybench.make("hand_regard", vision_resolution=32, render_mode="rgb_array")
        <babybench.Env hand_regard in cubes>
    """
    return Env(config, **arguments)
