"""Reaching for a ball: ``mimoEnv.envs.reach``."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import tables
from ..actuation import ActuationModel, SpringDamperModel
from ..assets import scene_path
from ..sensing import Observation
from .base import TaskMethods
from .looking import HeadTracking

REACH_XML = scene_path("reach_scene.xml")
_MOVED = 0.01
"""Displacement of the ball that counts as touched, m."""
_BONUS = 100
_START_ACTIONS = 10
_BALL = ((-0.1, 0.0), (-0.2, 0.1), (-0.1, 0.0))
"""How far the ball may lie from its place at the start of an episode, m: from, to."""


class MIMoReachEnv(TaskMethods):
    """MIMo hangs in the air and knocks a hovering ball away with the right hand; his eyes follow it.

    The reward is minus the distance of the right fingers from the ball, m, and 100 more on success: the ball has moved by 1 cm.
    The arguments are those of :class:`~babybench_kit.mimo_env.MIMoEnv`.

    Attributes:
        target_init_pos: Where the ball was at the start of the episode, (3,), world, m.
    """

    def __init__(
        self,
        model_path: str | os.PathLike[str] = REACH_XML,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = None,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = None,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        goals_in_observation: bool = False,
        done_active: bool = True,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(
            model_path=model_path,
            proprio_params=proprio_params,
            touch_params=touch_params,
            vision_params=vision_params,
            vestibular_params=vestibular_params,
            actuation_model=actuation_model,
            goals_in_observation=goals_in_observation,
            done_active=done_active,
            **kwargs,
        )
        self.target_init_pos = self._position("target")

    def _position(self, body: str) -> NDArray[np.float64]:
        return np.array(self._core.present.xpos[self._core.names["body"].index(body)])

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        """Returns minus the distance of the fingers from the ball, m, and a bonus for success."""
        distance = float(np.linalg.norm(self._position("right_fingers") - self._position("target")))
        return _BONUS * bool(self.is_success(achieved_goal, desired_goal)) - distance

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether the ball has moved."""
        return bool(np.linalg.norm(self._position("target") - self.target_init_pos) > _MOVED)

    def reset_model(self) -> Observation:
        """Moves the arm by random actions, puts the ball at a random place, and returns the observation."""
        self.set_state(self.init_qpos, self.init_qvel)
        for _ in range(_START_ACTIONS):
            self._set_action(self.action_space.sample())
            self._single_mujoco_step()
            self._step_callback()
        qpos = self._core.read("qpos")
        ball = len(qpos) - 7  # the last joint
        for k, (low, high) in enumerate(_BALL):
            qpos[ball + k] = self.init_qpos[ball + k] + self.np_random.uniform(low=low, high=high, size=1)[0]
        self.set_state(qpos, np.zeros_like(self.init_qvel))
        self.target_init_pos = self._position("target")
        return self._get_obs()

    def _step_callback(self) -> None:
        """Turns head and eyes towards the ball; the left eye rolls freely, as in MIMo's own."""
        tracking = self.__dict__.get("_tracking")
        if tracking is None:
            tracking = self.__dict__["_tracking"] = self._make_tracking()
        tracking.look_at(self._position("target"))

    def _make_tracking(self) -> HeadTracking:
        """Finds the joints that follow the ball."""
        return HeadTracking(self._core, free=("left_eye_torsional",))
