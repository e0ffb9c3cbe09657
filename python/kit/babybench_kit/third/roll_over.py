"""Rolling over: ``mimo_infant.simulation.envs.roll_over``."""

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
from ..tasks.base import TaskMethods
from .env import MIMoEnv

STARTING_POSITION = "supine"
"""How MIMo lies at the start, ``supine`` or ``prone``: assign it before an environment is made."""
ROLL_OVER_XML = scene_path("roll_over_scene.xml", 3)
_LYING = {"supine": 1.0, "prone": -1.0}
"""The sign of the turn from upright, by the name of the start."""
_HEIGHT = 0.1
"""Height of the pelvis at the start, m."""
_SETTLING = 100
"""Physics steps without action at the start of an episode."""
_SHAKE = 0.01
"""How far each angle may differ at the start of an episode, rad."""
_TURNED = 0.8
_COST = 0.01


class MIMoRollOverEnv(TaskMethods, MIMoEnv):
    """MIMo lies on the floor, and turns over.

    The achieved goal is 0 on the side of the start and 1 on the other one, by the pitch of the pelvis. The reward is that
    number, less a hundredth of the squares of the controls. Episodes have no end, but success is reported. The arguments are
    those of :class:`~babybench_kit.third.env.MIMoEnv`.

    Attributes:
        init_position: The positions around which episodes start, (nq,).
    """

    def __init__(
        self,
        model_path: str | os.PathLike[str] = ROLL_OVER_XML,
        initial_qpos: Mapping[str, ArrayLike] | None = None,
        frame_skip: int = 2,
        age: float | None = None,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = None,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = tables.VESTIBULAR_DEFAULTS,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene, lays MIMo down, and lets him settle.

        Raises:
            ValueError: :data:`STARTING_POSITION` is another word.
        """
        if STARTING_POSITION not in _LYING:
            raise ValueError(f"STARTING_POSITION is {STARTING_POSITION!r}, expected {' or '.join(_LYING)}")
        self._sign = _LYING[STARTING_POSITION]
        super().__init__(
            model_path=model_path,
            initial_qpos=initial_qpos,
            frame_skip=frame_skip,
            age=age,
            proprio_params=proprio_params,
            touch_params=touch_params,
            vision_params=vision_params,
            vestibular_params=vestibular_params,
            actuation_model=actuation_model,
            goals_in_observation=False,
            done_active=False,
            **kwargs,
        )
        lying = np.array(self.init_qpos)
        lying[:7] = 0, 0, _HEIGHT, 0, self._sign * np.sqrt(0.5), 0, np.sqrt(0.5)
        self._settle(lying)
        self.init_position = self._core.read("qpos")

    def _settle(self, qpos: ArrayLike) -> None:
        """Moves the scene to positions, and advances without action."""
        self.set_state(qpos, np.zeros_like(self.init_qvel))
        self._set_action(np.zeros(self.action_space.shape or ()))
        for _ in range(_SETTLING):
            self._core.physics_step()

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether MIMo has turned far enough."""
        return bool(achieved_goal >= desired_goal)

    def sample_goal(self) -> float:
        """Returns the goal, which is always the same."""
        return _TURNED

    def get_achieved_goal(self) -> float:
        """Returns how far MIMo has turned, 0 to 1."""
        down, side, up = self._core.present.xmat[self._core.names["body"].index("hip")].reshape(3, 3)[2]
        turned = (np.degrees(np.arctan2(-down, np.hypot(side, up))) + 90) / 180
        return float(turned if self._sign > 0 else 1 - turned)

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        """Returns how far MIMo has turned, minus the cost of the controls."""
        return float(achieved_goal) - _COST * float(np.square(self._core.read("ctrl")).sum())

    def reset_model(self) -> Observation:
        """Shakes the lying MIMo a little, lets him settle, and returns the observation."""
        qpos = np.array(self.init_position)
        qpos[7:] += self.np_random.uniform(low=-_SHAKE, high=_SHAKE, size=len(qpos) - 7)
        self._settle(qpos)
        return self._get_obs()
