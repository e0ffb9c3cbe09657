"""The base of MIMo 3's environments: age and delays."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, TypeVar

from numpy.typing import ArrayLike

from .. import mimo_env
from ..actuation import ActuationModel, SpringDamperModel
from ..sensing import Observation
from .vision import SimpleVision

DEFAULT_SIZE = 500
_Item = TypeVar("_Item")


def _late(history: list[_Item], item: _Item, delay: int) -> _Item:
    """Returns the item that arrives now: always the first one until ``delay`` items are stored."""
    history.append(item)
    return history[0] if len(history) < delay else history.pop(0)


class MIMoEnv(mimo_env.MIMoEnv):
    """MIMo 3 in a scene, with the senses and the actuation that the arguments request.

    Args:
        model_path: The scene: any MJCF document with MIMo.
        sensory_delay: An observation arrives ``sensory_delay - 1`` observations later; 0 for no delay.
        motor_delay: An action arrives ``motor_delay - 1`` actions later, those of resets included; 0 for no delay.
        age: MIMo's age, months; ``None`` for the proportions of the scene.
        custom_measurements: Must be ``None``: measurements are keys of a configuration here.

    The other arguments are those of :class:`babybench_kit.mimo_env.MIMoEnv`.

    Attributes:
        age, sensory_delay, motor_delay: As the arguments.
    """

    _updates_first = True

    def __init__(
        self,
        model_path: str | os.PathLike[str],
        initial_qpos: Mapping[str, ArrayLike] | None = None,
        frame_skip: int = 2,
        sensory_delay: int = 0,
        motor_delay: int = 0,
        render_mode: str | None = None,
        camera_id: int | None = None,
        camera_name: str | None = None,
        width: int = DEFAULT_SIZE,
        height: int = DEFAULT_SIZE,
        default_camera_config: dict[str, Any] | None = None,
        age: float | None = None,
        custom_measurements: Mapping[tuple[str, int], float] | None = None,
        proprio_params: dict[str, Any] | None = None,
        touch_params: dict[str, Any] | None = None,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = None,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        goals_in_observation: bool = True,
        done_active: bool = False,
    ) -> None:
        """Compiles the scene, and takes one physics step.

        Raises:
            NotImplementedError: ``custom_measurements`` is given.
            ValueError: A delay is below 0, or MIMo has no size at this age.
        """
        if custom_measurements is not None:
            raise NotImplementedError(
                "custom_measurements: give measurements as keys of a configuration "
                "(babybench.make(..., mimo_version=3, head_circumference=...))"
            )
        if min(sensory_delay, motor_delay) < 0:
            raise ValueError(f"sensory_delay is {sensory_delay} and motor_delay {motor_delay}: neither can be below 0")
        self.age, self.sensory_delay, self.motor_delay = age, int(sensory_delay), int(motor_delay)
        self._action_history: list[ArrayLike] = []
        self._obs_history: list[Observation] = []
        super().__init__(
            model_path,
            initial_qpos=initial_qpos,
            frame_skip=frame_skip,
            render_mode=render_mode,
            camera_id=camera_id,
            camera_name=camera_name,
            width=width,
            height=height,
            default_camera_config=default_camera_config,
            proprio_params=proprio_params,
            touch_params=touch_params,
            vision_params=vision_params,
            vestibular_params=vestibular_params,
            actuation_model=actuation_model,
            goals_in_observation=goals_in_observation,
            done_active=done_active,
            age=age,
        )

    def vision_setup(self, vision_params: dict[str, Any]) -> None:
        """Makes vision."""
        self.vision = SimpleVision(self, vision_params)

    def _delayed_action(self, action: ArrayLike) -> ArrayLike:
        """Returns the action that arrives when one is given."""
        return _late(self._action_history, action, self.motor_delay) if self.motor_delay else action

    def _delayed_observation(self, observation: Observation) -> Observation:
        """Returns the observation that arrives when one is made."""
        return _late(self._obs_history, observation, self.sensory_delay) if self.sensory_delay else observation

    def _reset_simulation(self) -> None:
        """Resets the simulation and delayed items, puts the actuators to rest, and samples a goal."""
        self._action_history.clear()
        self._obs_history.clear()
        super()._reset_simulation()
