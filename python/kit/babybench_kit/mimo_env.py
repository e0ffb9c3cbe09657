"""The base of MIMo's environments: ``mimoEnv.envs.mimo_env``.

Resets and steps call the same methods as the kit's, so that subclasses can replace any of them. The engine does the work of
each method.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from babybench_core import _native, looks
from babybench_core.mujoco.model import MjModel, Source

from .actuation import MODELS, ActuationModel, SpringDamperModel
from .core import Core
from .course import Share
from .given_model import Given, TakesModels
from .goal_env import GoalEnv
from .known_scenes import SCENE_NAME, known_scene, prepare_scene
from .looks import take_looks
from .renderer import MujocoRenderer
from .replaceable import refuse_uncalled, replaced
from .scene import Scene
from .sensing import Observation, SensingEnv
from .settings import engine_settings

Array = NDArray[np.float64]

DEFAULT_SIZE = 480
"""Width and height of rendered pictures, pixels."""

EMOTES = {"default": "tex_head_default"} | {
    emotion: f"tex_head_{emotion}" for emotion in ("happy", "sad", "surprised", "angry", "disgusted", "scared")
}
"""The textures of facial expressions."""

_WITHIN_STEP = (
    "do_simulation",
    "_set_action",
    "_single_mujoco_step",
    "_substep_callback",
    "_step_callback",
    "_get_obs",
)
"""Methods between the start of a step and its observation."""

_UNCALLED = ("_step_mujoco_simulation", "viewer_setup")
"""Methods of Gymnasium's ``MujocoEnv`` that nothing calls here."""


class MIMoEnv(TakesModels, GoalEnv):
    """MIMo in a scene, with the senses and the actuation that the arguments request.

    Args:
        model_path: The scene: any MJCF document with MIMo.
        initial_qpos: Joint angles at the start by the joints' names, rad.
        frame_skip: Physics steps of 5 ms for each step.
        render_mode: ``rgb_array`` or ``depth_array``, for :meth:`render`.
        camera_id: The camera of :meth:`render`, by id.
        camera_name: The camera of :meth:`render`, by name.
        width, height: Size of rendered pictures, pixels.
        default_camera_config: The free camera of :meth:`render` in scenes without a camera for the room: ``lookat``,
            ``distance``, ``azimuth``, ``elevation``.
        proprio_params, touch_params, vision_params, vestibular_params: Parameters of the senses; ``None`` turns one off.
        actuation_model: The class of the actuation model.
        goals_in_observation: Whether ``achieved_goal`` and ``desired_goal`` are part of the observation.
        done_active: Whether success and failure end an episode.
        config: A configuration of BabyBench, whose keys apply where no argument overrides them.
        age: MIMo's age, months; ``None`` for the proportions of the scene.

    Attributes:
        model, data: MuJoCo's ``MjModel`` and ``MjData`` of the current state where MuJoCo is installed, or their stand-ins.
            ``qpos``, ``qvel``, ``ctrl`` and ``qfrc_applied`` of ``data`` can be written to. Both can be replaced by a model that
            :mod:`babybench.mujoco` has compiled and a state of it, above all in :meth:`_initialize_simulation`.
        init_qpos, init_qvel: The state in which episodes start.
        touch, proprioception, vestibular, vision, actuation_model: The senses and the actuation.
        mimo_joints, mimo_actuators: Ids of MIMo's joints and actuators.
        facial_expressions: Ids of the textures of MIMo's faces.
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array", "depth_array"], "render_fps": 200}  # noqa: RUF012
    _engine_behavior = "none"
    _any_scene = True
    """Whether it accepts scenes that BabyBench's ``build_xml`` did not write."""
    _forwards_attributes = True
    _updates_first = False
    """Whether actuators are updated before the first physics step of a step, too, as in MIMo 3."""
    init_qpos: Array
    init_qvel: Array
    _ezpickle_args: tuple[Any, ...]
    _ezpickle_kwargs: dict[str, Any]

    def __init_subclass__(cls, **arguments: Any) -> None:
        """Refuses subclasses that replace methods that are never called."""
        super().__init_subclass__(**arguments)
        refuse_uncalled(cls, _UNCALLED, "replace _single_mujoco_step, render or _reset_simulation")

    def __new__(cls, *args: Any, **kwargs: Any) -> MIMoEnv:
        """Stores the arguments, for copies and pickles."""
        env = super().__new__(cls)
        env._ezpickle_args, env._ezpickle_kwargs = args, kwargs
        return env

    def __init__(
        self,
        model_path: str | os.PathLike[str] = SCENE_NAME,
        initial_qpos: Mapping[str, ArrayLike] | None = None,
        frame_skip: int = 2,
        render_mode: str | None = None,
        camera_id: int | None = None,
        camera_name: str | None = None,
        width: int = 500,
        height: int = 500,
        default_camera_config: dict[str, Any] | None = None,
        proprio_params: dict[str, Any] | None = None,
        touch_params: dict[str, Any] | None = None,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = None,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        goals_in_observation: bool = True,
        done_active: bool = False,
        *,
        config: Mapping[str, Any] | None = None,
        age: float | None = None,
    ) -> None:
        """Compiles the scene, and takes one physics step if it is not one of BabyBench's."""
        self._age = age
        self.frame_skip = frame_skip
        self.proprio_params, self.touch_params = proprio_params, touch_params
        self.vision_params, self.vestibular_params = vision_params, vestibular_params
        self.goals_in_observation, self.done_active = goals_in_observation, done_active
        self.width, self.height = width, height
        self.render_mode, self.camera_id, self.camera_name = render_mode, camera_id, camera_name
        self.fullpath = os.path.abspath(model_path)
        self._initial_qpos = initial_qpos
        self._actuation, self._config, self._camera_config = actuation_model, config or {}, default_camera_config
        self._source: Source | None = None
        prepare_scene(self.fullpath)
        self._given: Given | None = None
        self._making = True
        self.actuation_model: Any = actuation_model
        self._take_over(self._initialize_simulation())
        self._sense_anew()

    def _sense_anew(self) -> None:
        """Makes spaces and senses for the model, and takes one physics step if the scene is not one of BabyBench's."""
        self._set_action_space()
        self._own_seed = self.action_space.np_random
        self.mujoco_renderer = MujocoRenderer(self._core, self._camera_config)
        self.proprioception = self.touch = self.vision = self.vestibular = None
        self._core.reset_data()
        self._core.forward(self.init_qpos, self.init_qvel)
        if self._core.document is not None:
            self._single_mujoco_step()
            self._set_initial_position(self._initial_qpos)
        self._env_setup()
        self.goal = self.sample_goal()
        self._share = self._share_of_the_script()
        self._set_observation_space()

    def _share_of_the_script(self) -> Share:
        """Returns the parts of this environment that a script has replaced."""
        model = self.actuation_model
        self._core.plain_actuation = self._core.whole and type(model) in MODELS.values() and not model._replaced
        if not self._observes_plainly():
            return Share.SENSES
        return Share.STEP if replaced(self, _ORIGINAL, _WITHIN_STEP) else Share.NOTHING

    def _initialize_simulation(self) -> Any:
        """Compiles the scene, and makes the actuation model.

        A subclass that replaces this assigns :attr:`model` and :attr:`data`, or returns both.
        """
        self._core = self._compile(
            known_scene(self.fullpath, self._any_scene), self._actuation, self._config, self._age
        )
        self._name_parts()
        self._core.move(self.init_qpos)
        self._set_initial_position(self._initial_qpos)
        self.init_qpos = self._core.read("qpos")
        self._make_actuation()
        self._core.plain_actuation = self._core.whole and self._actuation in MODELS.values()
        if type(self)._initialize_simulation is not MIMoEnv._initialize_simulation:
            return self.model, self.data  # for a subclass, which may unpack them
        return None

    def _make_actuation(self) -> None:
        """Makes :attr:`actuation_model`."""
        self.actuation_model = self._actuation(self, self.mimo_actuators)

    def _compile(
        self, scene: Scene, actuation_model: type[ActuationModel], config: Mapping[str, Any], age: float | None
    ) -> Core:
        """Compiles a scene for the senses and the actuation that the arguments request."""
        names = (name for cls in actuation_model.__mro__ if (name := getattr(cls, "_engine_name", "")))
        settings = engine_settings(
            config,
            scene,
            behavior=self._engine_behavior,
            frame_skip=self.frame_skip,
            size=max(self.width, self.height),
            touch=self.touch_params,
            vision=self.vision_params,
            balance=self.vestibular_params,
            actuation=next(names, "spring_damper"),
            age=age,
        )
        return Core(settings, scene, self.width, self.height)

    def _name_parts(self) -> None:
        """Finds MIMo's elements in the scene."""
        core = self._core
        self.metadata = {**type(self).metadata, "render_fps": round(1 / self.dt)}
        self._get_joints()
        self._get_actuators()
        self._get_facial_expressions(EMOTES)
        self.init_qpos = np.array(core.blueprint.model_array("qpos0"))
        self.init_qvel = np.zeros(core.blueprint.model_options["nv"])
        if core.place is not None:
            self.init_qpos[:3] = core.place

    # --- what scripts see ---

    @property
    def dt(self) -> float:
        """Returns the duration of a step, s."""
        return self._core.timestep * self.frame_skip

    @property
    def n_actuators(self) -> int:
        """Returns the number of MIMo's actuators."""
        return int(self.mimo_actuators.shape[0])

    def get_body_com(self, body_name: str) -> Array:
        """Returns the position of a body's frame in the world, m."""
        return np.array(self._core.poses.xpos[self._core.names["body"].index(body_name)])

    def state_vector(self) -> Array:
        """Returns positions and velocities, (nq + nv,)."""
        self._core.pull()
        engine = self._core.engine
        return np.concatenate([engine.state_array("qpos"), engine.state_array("qvel")])

    def swap_facial_expression(self, emotion: str) -> None:
        """Changes MIMo's face in later pictures, to one of :attr:`facial_expressions`."""
        assert emotion in self.facial_expressions, f"{emotion} is not a valid facial expression!"
        self._core.pull()
        self._core.engine.swap_facial_expression(emotion)
        self._core.changed()  # poses and contacts are now those of the state, no longer of the last step's start

    # --- construction ---

    def _get_joints(self) -> None:
        """Finds :attr:`mimo_joints`."""
        self.mimo_joints = self._core.mimo_joints

    def _get_actuators(self) -> None:
        """Finds :attr:`mimo_actuators`."""
        names = enumerate(self._core.names["actuator"])
        self.mimo_actuators = np.asarray([number for number, name in names if name.startswith("act:")])

    def _get_facial_expressions(self, emotion_textures: Mapping[str, str]) -> None:
        """Finds :attr:`facial_expressions`: the ids of the textures that ``emotion_textures`` lists by expression."""
        extras = _native.model_extras(self._core.blueprint)
        textures: list[str] = extras["texture"]
        materials: list[str] = extras["material"]
        self._head_material_id = materials.index("head") if "head" in materials else None
        self.facial_expressions = {
            emotion: textures.index(name) for emotion, name in emotion_textures.items() if name in textures
        }

    def _set_initial_position(self, initial_qpos: Mapping[str, ArrayLike] | None) -> None:
        """Moves joints to the positions that a dictionary gives by name."""
        if not initial_qpos:
            return
        array, joints = self._core.blueprint.model_array, self._core.names["joint"]
        given = self._given
        qpos = self._core.read("qpos") if given is None else given.data.qpos
        for name, position in initial_qpos.items():
            first = array("jnt_qposadr")[joints.index(name)]
            qpos[first : first + np.size(position)] = position
        if given is None:
            self._core.move(qpos)

    def _set_action_space(self) -> None:
        """Makes :attr:`action_space`."""
        self.action_space = self.actuation_model.get_action_space()

    # --- physics ---

    def _set_action(self, action: ArrayLike) -> None:
        """Passes an action to the actuation model."""
        self._core.pull()
        self.actuation_model.action(self._delayed_action(action))

    def _delayed_action(self, action: ArrayLike) -> ArrayLike:
        """Returns the action that takes effect when one is given: the same one, except with MIMo 3's delay."""
        return action

    def _single_mujoco_step(self) -> None:
        """Advances by one physics step."""
        self._core.physics_step()

    def do_simulation(self, action: ArrayLike, n_frames: int) -> None:
        """Applies an action for a number of physics steps."""
        self._set_action(action)
        if self._updates_first:
            self.actuation_model.substep_update()
        self._single_mujoco_step()
        self._substep_callback()
        for _ in range(n_frames - 1):
            self.actuation_model.substep_update()
            self._single_mujoco_step()
            self._substep_callback()

    def set_state(self, qpos: ArrayLike, qvel: ArrayLike) -> None:
        """Moves the scene to positions (nq,) and velocities (nv,), and computes everything there."""
        self._core.forward(qpos, qvel)

    def _reset_simulation(self) -> None:
        """Resets the simulation, puts the actuators to rest, and samples a goal."""
        self._core.reset_data()
        self.actuation_model.reset()
        self.goal = self.sample_goal()

    def _step_callback(self) -> None:
        """Called after the physics steps of a step."""

    def _substep_callback(self) -> None:
        """Called after each physics step."""

    def _obs_callback(self) -> None:
        """Called after the observation of a step."""

    # --- Gymnasium ---

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Starts an episode.

        The random start actions come from the generator of :attr:`action_space`, as the kit's do. A seed reaches that generator
        unless a script has seeded it: ``env.action_space.seed(7)`` makes episodes repeatable as with the kit.

        Returns:
            The observation, and no information.
        """
        super().reset(seed=seed)
        if seed is not None and self.action_space._np_random is self._own_seed:
            self.action_space.seed(seed)
            self._own_seed = self.action_space._np_random
        self._reset_simulation()
        return self.reset_model(), self._get_reset_info()

    def _get_reset_info(self) -> dict[str, Any]:
        """Returns the information of a reset: nothing."""
        return {}

    def _advance(self, action: ArrayLike) -> Observation:
        """Applies an action, and returns the observation after it."""
        core = self._core
        core.pull()
        if self._share is not Share.NOTHING:
            return self._acted(action)
        # without a subclass's methods, no script writes to the state before the observation
        core.course.change("begin")
        try:
            return self._acted(action)
        finally:
            core.course.change("end")

    def _acted(self, action: ArrayLike) -> Observation:
        self.do_simulation(action, self.frame_skip)
        self._step_callback()
        return self._get_obs()

    def step(self, action: ArrayLike) -> tuple[Observation, Any, bool, bool, dict[str, Any]]:
        """Applies an action, (n,), for ``frame_skip`` physics steps.

        Returns:
            Observation, reward, whether the episode has ended, whether it was truncated, and information.
        """
        observation = self._advance(action)
        self._obs_callback()
        achieved = self.get_achieved_goal()
        info = {"is_success": self.is_success(achieved, self.goal), "is_failure": self.is_failure(achieved, self.goal)}
        if not self.goals_in_observation:
            info.update(achieved_goal=achieved, desired_goal=self.goal)
        terminated, truncated = self._is_done(achieved, self.goal, info)
        return observation, self.compute_reward(achieved, self.goal, info), terminated, truncated, info

    def _is_done(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> tuple[bool, bool]:
        """Returns whether the episode has ended, and whether it was truncated."""
        return bool(self.done_active and (info["is_success"] or info["is_failure"])), self.is_truncated()

    def render(self) -> NDArray[Any] | None:  # type: ignore[override,unused-ignore]
        """Renders the scene in the mode and from the camera of the constructor."""
        return self.mujoco_renderer.render(self.render_mode, self.camera_id, self.camera_name)

    def close(self) -> None:
        """Closes the renderer."""
        renderer = getattr(self, "mujoco_renderer", None)
        if renderer is not None:
            renderer.close()

    # --- copies ---

    def __getstate__(self) -> dict[str, Any]:
        """Returns the data from which a copy continues: arguments, state of the engine, and everything else."""
        kept = {name: value for name, value in self.__dict__.items() if name not in _REMADE}
        engine = self._core.engine
        return {
            "source": self._source,
            "snapshot": engine.snapshot(),
            "changes": engine.model_changes,
            "looks": looks.of(engine),
            "kept": kept,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Rebuilds the environment and continues there."""
        kept = state["kept"]
        self.__init__(*kept["_ezpickle_args"], **kept["_ezpickle_kwargs"])  # type: ignore[misc,unused-ignore]
        source = state["source"]
        if source is not None:
            self.model = MjModel._made(source.compile(), source)
        self.__dict__.update(kept)
        self._core.change_model(state["changes"])
        take_looks(self._core, state["looks"])
        self._core.engine.restore(state["snapshot"])
        self._own_seed = self.action_space._np_random
        self._core.changed()


_REMADE = frozenset(
    {
        "_core",
        "mujoco_renderer",
        "touch",
        "proprioception",
        "vision",
        "vestibular",
        "actuation_model",
        "_own_seed",
        "_tracking",
        "run_folder",
    }
)
"""Attributes that a copy makes again."""
_ORIGINAL = {**vars(SensingEnv), **vars(GoalEnv), **vars(MIMoEnv)}
"""Methods as this module and :mod:`.sensing` define them."""
