"""Standing up in a crib: ``mimoEnv.envs.standup``."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import tables
from ..actuation import ActuationModel, SpringDamperModel
from ..assets import scene_path
from ..sensing import Observation
from .base import TaskMethods
from .postures import CROUCHING

STANDUP_XML = scene_path("standup_scene.xml")
SITTING_POSITION = CROUCHING
"""Where MIMo sits: his place, and the angles of his joints, rad."""
_STANDING = 0.5
"""Height of the head that is a success, m."""
_SITTING = 0.2
_SHAKE = 0.01
"""How far each angle may differ at the start of an episode, rad."""
_SETTLING = 100
"""Physics steps without action at the start of an episode."""


class MIMoStandupEnv(TaskMethods):
    """MIMo crouches at a railing that he holds, and raises his head.

    The reward is the height of the head less 0.2 m, less a hundredth of the squares of the controls. Episodes have no end, but
    success is reported. The arguments are those of :class:`~babybench_kit.mimo_env.MIMoEnv`.

    Attributes:
        init_crouch_position: The positions around which episodes start, (nq,).
    """

    def __init__(
        self,
        model_path: str | os.PathLike[str] = STANDUP_XML,
        initial_qpos: Mapping[str, ArrayLike] | None = SITTING_POSITION,
        frame_skip: int = 2,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = None,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = tables.VESTIBULAR_DEFAULTS,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(
            model_path=model_path,
            initial_qpos=initial_qpos,
            frame_skip=frame_skip,
            proprio_params=proprio_params,
            touch_params=touch_params,
            vision_params=vision_params,
            vestibular_params=vestibular_params,
            actuation_model=actuation_model,
            goals_in_observation=False,
            done_active=False,
            **kwargs,
        )
        self.init_crouch_position = self._core.read("qpos")

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        """Returns the height of the head above its sitting height, minus the cost of the controls."""
        cost = 0.01 * float(np.square(self._core.read("ctrl")).sum())
        return float(achieved_goal) - _SITTING - cost

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether the head is as high as the goal."""
        return bool(achieved_goal >= desired_goal)

    def sample_goal(self) -> float:
        """Returns the height of a standing MIMo's head, m."""
        return _STANDING

    def get_achieved_goal(self) -> float:
        """Returns the height of the head, m."""
        return float(self._core.present.xpos[self._core.names["body"].index("head")][2])

    def reset_model(self) -> Observation:
        """Shakes the crouching MIMo a little, lets him settle, and returns the observation."""
        self.set_state(self.init_qpos, self.init_qvel)
        qpos = np.array(self.init_crouch_position)
        qpos[7:] += self.np_random.uniform(low=-_SHAKE, high=_SHAKE, size=len(qpos) - 7)
        self.set_state(qpos, np.zeros_like(self.init_qvel))
        self._set_action(np.zeros(self.action_space.shape or ()))
        for _ in range(_SETTLING):
            self._core.physics_step()
        return self._get_obs()
