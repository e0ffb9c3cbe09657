"""BabyBench's environments: ``mimoEnv.babybench``."""

from __future__ import annotations

import copy
import os
import pickle
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import tables
from .actuation import MODELS, ActuationModel, EngineActuation, SpringDamperModel
from .core import Core
from .known_scenes import SCENE_NAME
from .mimo_env import _ORIGINAL, DEFAULT_SIZE, EMOTES, MIMoEnv
from .replaceable import replaced
from .sensing import Observation
from .utils import get_child_bodies, get_geoms_for_body

__all__ = [
    "DEFAULT_SIZE",
    "EMOTES",
    "SCENE_NAME",
    "BabyBenchEnv",
    "BabyBenchHandRegardEnv",
    "BabyBenchSelfTouchEnv",
    "MIMoEnv",
]

_SETTLING = 100
"""Physics steps without action before the first episode."""

_START_ACTIONS = 10
"""Physics steps with random actions at the start of an episode."""


def subtree_geoms(core: Core, bodies: Iterable[int]) -> NDArray[np.int64]:
    """Returns the ids of the geoms of bodies."""
    return np.concatenate([np.array(get_geoms_for_body(core.tree, body)) for body in bodies]).astype(np.int64)


class BabyBenchEnv(MIMoEnv):
    """MIMo in a scene of BabyBench, without extrinsic reward.

    Args:
        model_path: The scene.
        frame_skip: Physics steps of 5 ms for each step.
        proprio_params, vision_params, vestibular_params, touch_params: Parameters of the senses; ``None`` turns one off. A
            configuration replaces them.
        actuation_model: The class of the actuation model; a configuration replaces it.
        width, height: Size of rendered pictures, pixels.
        config: The configuration of BabyBench.
        training: Whether episodes are logged in ``save_dir`` and counted one by one.

    Attributes:
        behavior, save_dir, save_logs_every, training: As in the configuration.
        steps: Number of steps in this episode.
    """

    _any_scene = False

    def __init__(
        self,
        model_path: str | os.PathLike[str] = SCENE_NAME,
        frame_skip: int = 1,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_PARAMS,
        vision_params: dict[str, Any] | None = tables.VISION_PARAMS,
        vestibular_params: dict[str, Any] | None = tables.VESTIBULAR_PARAMS,
        touch_params: dict[str, Any] | None = tables.TOUCH_PARAMS,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        width: int = DEFAULT_SIZE,
        height: int = DEFAULT_SIZE,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene and lets MIMo settle."""
        config: Mapping[str, Any] | None = kwargs.get("config")
        senses: dict[str, Any] = {
            "proprio_params": copy.deepcopy(proprio_params),
            "vision_params": copy.deepcopy(vision_params),
            "vestibular_params": copy.deepcopy(vestibular_params),
            "touch_params": copy.deepcopy(touch_params),
        }
        self.behavior = self.save_dir = self.save_logs_every = self.training = None
        if config is not None:
            _configure(senses, config)
            chosen = config.get("actuation_model")
            if chosen is not None:
                if chosen not in MODELS:
                    raise ValueError(
                        f"configuration: actuation_model is {chosen!r}, expected one of {', '.join(MODELS)}"
                    )
                actuation_model = MODELS[chosen]
            self.behavior, self.save_dir = config.get("behavior"), config.get("save_dir")
            self.save_logs_every, self.training = config.get("save_logs_every"), kwargs.get("training")
        super().__init__(
            model_path,
            frame_skip=frame_skip,
            width=width,
            height=height,
            actuation_model=actuation_model,
            goals_in_observation=False,
            done_active=False,
            render_mode=kwargs.get("render_mode"),
            camera_id=kwargs.get("camera_id"),
            camera_name=kwargs.get("camera_name"),
            config=config,
            **senses,
        )
        self._settle()
        self.steps = 0
        self._info_init()
        self._info_hist: list[dict[str, Any]] = []

    def _settle(self) -> None:
        """Lets the scene come to rest; episodes start there."""
        core = self._core
        own = replaced(self, _ORIGINAL, ("set_state", "_set_action", "_single_mujoco_step"))
        if core.settled and core.place is None and isinstance(self.actuation_model, EngineActuation) and not own:
            # the engine has done that
            self.init_qpos, self.init_qvel = core.blueprint.init_qpos, core.blueprint.init_qvel
            core.forward(self.init_qpos, self.init_qvel)
        else:
            self.set_state(self.init_qpos, self.init_qvel)
            self._set_action(np.zeros(self.action_space.shape or ()))
            for _ in range(_SETTLING):
                self._single_mujoco_step()
            self.init_qpos, self.init_qvel = core.engine.state_array("qpos"), core.engine.state_array("qvel")

    def compute_reward(self, achieved_goal: Any = None, desired_goal: Any = None, info: Any = None, **_: Any) -> Any:
        """Returns 0: learners define their own reward."""
        return 0

    def reset_model(self) -> Observation:
        """Logs the last episode, puts the scene at the start of another, and returns the observation."""
        if self.training:
            self._info_reset()
        self.set_state(self.init_qpos, self.init_qvel)
        self._randomize_reset()
        self.steps = 0
        return self._get_obs()

    def _randomize_reset(self) -> None:
        """Changes the start of an episode; does nothing here."""

    def _start_actions(self) -> None:
        """Takes random actions at the start of an episode."""
        for _ in range(_START_ACTIONS):
            self._set_action(self.action_space.sample())
            self._single_mujoco_step()

    def step(self, action: ArrayLike) -> tuple[Observation, Any, bool, bool, dict[str, Any]]:
        """Applies an action, (n,), for ``frame_skip`` physics steps.

        Returns:
            Observation, 0, False, False (a wrapper counts steps), and information: the counters of the behavior, and ``steps``,
            one less than the steps done.
        """
        observation = self._advance(action)
        self._obs_callback()
        info = self._info()
        info["steps"] = self.steps
        terminated, truncated = self._is_done(None, self.goal, info)
        reward = self.compute_reward()
        self.steps += 1
        return observation, reward, terminated, truncated, info

    def _info_reset(self) -> None:
        """Adds the last episode to the log, and resets the counters."""
        info = self._info()
        info["steps"] = self.steps
        self._info_hist.append(info)
        if self.save_logs_every is not None and self.save_dir is not None and self.steps % self.save_logs_every == 0:
            self._write_log(Path(self.save_dir) / "logs" / "training.pkl")
        self._info_init()

    def _write_log(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(f"{path.name}.{os.getpid()}")
        with part.open("wb") as file:
            pickle.dump(self._info_hist, file, -1)
        part.replace(path)

    def _info(self) -> dict[str, Any]:
        """Updates the counters, and returns the report of the behavior."""
        return {}

    def _info_init(self) -> None:
        """Resets the counters."""

    def is_success(self, achieved_goal: Any = None, desired_goal: Any = None) -> bool:
        """Returns False."""
        return False

    def is_failure(self, achieved_goal: Any = None, desired_goal: Any = None) -> bool:
        """Returns False."""
        return False

    def is_truncated(self) -> bool:
        """Returns False."""
        return False

    def sample_goal(self) -> Any:
        """Returns False."""
        return False

    def get_achieved_goal(self) -> Any:
        """Returns False."""
        return False


def _configure(senses: dict[str, Any], config: Mapping[str, Any]) -> None:
    """Sets the parameters of the senses from a configuration; keys without a value do not change them."""
    if config.get("vision_active") is False:
        senses["vision_params"] = None
    elif config.get("vision_resolution") is not None:
        senses["vision_params"] = tables.vision_params(config["vision_resolution"])
    if config.get("vestibular_active") is False:
        senses["vestibular_params"] = None
    scale = config.get("touch_scale")
    if config.get("touch_active") is False or (config.get("touch_active") is not None and scale == 0):
        senses["touch_params"] = None
        return
    touch = senses["touch_params"]
    if touch is None:
        if config.get("touch_active") is None:
            return
        raise TypeError(
            "touch_params is None, but the configuration has touch_active: give parameters, or leave the key out"
        )
    if scale is not None:
        on = {part for part in tables.PARTS if config.get(f"touch_{part}", part != "eyes") is True}
        touch["scales"] = {b: s * scale for b, s in touch["scales"].items() if tables.PART_OF_BODY[b] in on}
        if not touch["scales"]:
            raise ValueError("configuration: touch_active, but every touch_* is off; set touch_active to False")
    touch["touch_function"] = config.get("touch_function") or touch["touch_function"]
    touch["response_function"] = config.get("touch_response") or touch["response_function"]


class BabyBenchSelfTouchEnv(BabyBenchEnv):
    """MIMo v1 learns to touch himself.

    Attributes:
        right_hand_geoms, left_hand_geoms: Ids of the geoms of the palms.
        mimo_bodies, mimo_geoms: Ids of MIMo's bodies and geoms, from the hip outwards.
    """

    _engine_behavior = "self_touch"

    def __init__(
        self,
        model_path: str | os.PathLike[str] = SCENE_NAME,
        frame_skip: int = 1,
        width: int = DEFAULT_SIZE,
        height: int = DEFAULT_SIZE,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene and lets MIMo settle."""
        self._counted = (0, 0)
        super().__init__(model_path=model_path, frame_skip=frame_skip, width=width, height=height, **kwargs)
        bodies, tree = self._core.names["body"], self._core.tree
        self.right_hand_geoms = get_geoms_for_body(tree, bodies.index("right_hand"))
        self.left_hand_geoms = get_geoms_for_body(tree, bodies.index("left_hand"))
        self.mimo_bodies = get_child_bodies(tree, bodies.index("hip"))
        self.mimo_geoms = subtree_geoms(self._core, self.mimo_bodies)

    def _info(self) -> dict[str, Any]:
        """Returns the geoms that the palms have touched; the lists stay the same objects throughout an episode."""
        right, left = self._self_touch_right_hand, self._self_touch_left_hand
        if self._core.course.moment.computed:
            parts = self._core.parts
            parts.track()
            new = parts.touches(*self._counted)
            if new is not None and (new[0] or new[1]):
                right.extend(new[0])
                left.extend(new[1])
                self._counted = (self._counted[0] + len(new[0]), self._counted[1] + len(new[1]))
        return {"right_hand_touches": right, "left_hand_touches": left}

    def _info_init(self) -> None:
        """Resets the counters."""
        self._core.parts.clear_info()
        self._counted = (0, 0)
        self._self_touch_right_hand: list[int] = []
        self._self_touch_left_hand: list[int] = []

    def _randomize_reset(self) -> None:
        """Takes random actions."""
        self._start_actions()


class BabyBenchHandRegardEnv(BabyBenchEnv):
    """MIMo v2 learns to look at his hands."""

    _engine_behavior = "hand_regard"
    _PAIRS = ("right_eye_right_hand", "right_eye_left_hand", "left_eye_right_hand", "left_eye_left_hand")

    def _info(self) -> dict[str, Any]:
        """Returns for how many steps each eye has had each hand in view."""
        parts = self._core.parts
        if self._core.course.moment.computed:
            parts.track()
        return dict(zip(self._PAIRS, parts.regards or (0, 0, 0, 0)))

    def _info_init(self) -> None:
        """Resets the counters."""
        self._core.parts.clear_info()

    def _randomize_reset(self) -> None:
        """Takes random actions."""
        self._start_actions()
