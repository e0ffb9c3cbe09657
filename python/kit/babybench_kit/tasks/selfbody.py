"""Touching a part of his own body: ``mimoEnv.envs.selfbody``."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import tables, utils
from ..actuation import ActuationModel, SpringDamperModel
from ..assets import scene_path
from ..sensing import Observation
from .base import TaskMethods
from .postures import SITTING, SITTING_BASE

SELFBODY_XML = scene_path("selfbody_scene.xml")
SITTING_POSITION = SITTING
"""Where MIMo sits: the angles of his joints, rad."""
TOUCH_PARAMS: dict[str, Any] = {
    "scales": {
        **{f"{side}_foot": 0.05 for side in ("left", "right")},
        **{f"{side}_{part}": 0.1 for part in ("lower_leg", "upper_leg") for side in ("left", "right")},
        **dict.fromkeys(("hip", "lower_body", "upper_body", "head"), 0.1),
        **dict.fromkeys(("left_upper_arm", "left_lower_arm", "right_fingers"), 0.01),
    },
    "touch_function": "force_vector",
    "response_function": "spread_linear",
}
"""The sensors, few on most bodies: all but the last two bodies are targets."""
_TARGETS = 37
"""Length of a goal."""
_NO_TARGETS = 2
"""Number of bodies at the end of the list that are not targets."""
_SETTLING = 25
"""Physics steps in which weld and locks settle."""
_FOUND = 500


class MIMoSelfBodyEnv(TaskMethods):
    """MIMo sits and touches a part of his body, the goal, with the right arm.

    The reward is 500 for the right part, minus the distance from it, m, for another one, and -1 without contact. The arguments
    are those of :class:`~babybench_kit.mimo_env.MIMoEnv`.

    Attributes:
        goal: The target, one of 37 numbers that is 1.
        target_geom: The target's body, by id. MIMo's own calls it a geom, and takes it for one in ``target_body``.
        target_body: Name of the body of the geom with that id, from which distances are measured.
        init_sitting_qpos: The positions in which episodes start, (nq,).
    """

    def __init__(
        self,
        model_path: str | os.PathLike[str] = SELFBODY_XML,
        initial_qpos: Mapping[str, ArrayLike] | None = SITTING_POSITION,
        frame_skip: int = 1,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = TOUCH_PARAMS,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = None,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        goals_in_observation: bool = True,
        done_active: bool = True,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene, and lets MIMo settle in his seat."""
        self.target_geom, self.target_body, self.goal = 0, "", np.zeros(_TARGETS)
        super().__init__(
            model_path=model_path,
            initial_qpos=initial_qpos,
            frame_skip=frame_skip,
            proprio_params=proprio_params,
            touch_params=touch_params,
            vision_params=vision_params,
            vestibular_params=vestibular_params,
            actuation_model=actuation_model,
            goals_in_observation=goals_in_observation,
            done_active=done_active,
            **kwargs,
        )
        self._set_initial_position({"mimo_location": SITTING_BASE})
        for name, angle in SITTING_POSITION.items():
            utils.lock_joint(self.model, name, joint_angle=float(angle[0]))
        self.do_simulation(np.zeros(self.action_space.shape or ()), _SETTLING)
        self.init_sitting_qpos = self._core.read("qpos")

    def _felt(self) -> dict[int, NDArray[np.float32]]:
        if self.touch is None:
            raise TypeError(f"{type(self).__name__} needs touch: its goals and rewards are about what is felt")
        felt: dict[int, NDArray[np.float32]] = self.touch.sensor_outputs  # type: ignore[attr-defined]
        return felt

    def sample_goal(self) -> NDArray[np.float64]:
        """Returns a random target, drawn from NumPy's global generator as in MIMo's own: one of 37 numbers is 1."""
        bodies = list(self._felt())
        self.target_geom = bodies[np.random.randint(len(bodies) - _NO_TARGETS)]
        goal = np.zeros(_TARGETS)
        goal[self.target_geom] = 1
        self.target_body = self._core.names["body"][self._core.body_of_geom[self.target_geom]]
        return goal

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether something is felt on the target."""
        return bool(np.max(self._felt()[self.target_geom]) > 0)

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        """Returns the reward of the current touches."""
        if info["is_success"]:
            return _FOUND
        felt = list(self._felt().values())
        if max(np.max(forces) for forces in felt[-_NO_TARGETS:]) <= 0:
            return -1
        bodies = self._core.names["body"]
        fingers, target = (self._core.present.xpos[bodies.index(name)] for name in ("right_fingers", self.target_body))
        return -float(np.linalg.norm(fingers - target))

    def reset_model(self) -> Observation:
        """Puts MIMo in his seat, and returns the observation."""
        self.set_state(self.init_sitting_qpos, np.zeros_like(self.init_qvel))
        return self._get_obs()
