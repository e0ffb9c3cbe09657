"""MIMo without a task: ``mimoEnv.envs.dummy``."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from numpy.typing import ArrayLike

from .. import tables, utils
from ..actuation import ActuationModel, MuscleModel, SpringDamperModel
from ..assets import scene_path
from ..sensing import Observation
from ..touch import TrimeshTouch
from .base import TaskMethods

DEMO_XML = scene_path("showroom.xml")
BENCHMARK_XML = scene_path("benchmark_scene.xml")
BENCHMARK_XML_V2 = scene_path("benchmarkv2_scene.xml")
TEST_XML = scene_path("test_scene.xml")
"""A name that MIMo also has, without the file."""


class MIMoDummyEnv(TaskMethods):
    """MIMo v1 with all senses next to two objects on a plane, without a goal or a reward.

    Args:
        model_path: The scene.
        show_sensors: Whether to print how many touch sensors each body has, and to plot them.
        print_space_sizes: Whether to print the shapes of the spaces.

    The other arguments are those of :class:`~babybench_kit.mimo_env.MIMoEnv`.

    Attributes:
        steps: Number of steps since the environment was made.
        show_sensors: As the argument.
    """

    def __init__(
        self,
        model_path: str | os.PathLike[str] = BENCHMARK_XML,
        frame_skip: int = 2,
        initial_qpos: Mapping[str, ArrayLike] | None = None,
        render_mode: str | None = None,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = tables.TOUCH_DEFAULTS,
        vision_params: dict[str, Any] | None = tables.VISION_DEFAULTS,
        vestibular_params: dict[str, Any] | None = tables.VESTIBULAR_DEFAULTS,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        goals_in_observation: bool = False,
        done_active: bool = True,
        show_sensors: bool = False,
        print_space_sizes: bool = False,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        self.steps, self.show_sensors = 0, show_sensors
        super().__init__(
            model_path=model_path,
            frame_skip=frame_skip,
            initial_qpos=initial_qpos,
            render_mode=render_mode,
            proprio_params=proprio_params,
            touch_params=touch_params,
            vision_params=vision_params,
            vestibular_params=vestibular_params,
            actuation_model=actuation_model,
            goals_in_observation=goals_in_observation,
            done_active=done_active,
            **kwargs,
        )
        if print_space_sizes:
            for name, space in self.observation_space.spaces.items():  # type: ignore[attr-defined]
                print(f"observation {name}: {space.shape}")
            print(f"action: {self.action_space.shape}")

    def touch_setup(self, touch_params: dict[str, Any]) -> None:
        """Makes touch, and shows its sensors if requested."""
        touch = self.touch = TrimeshTouch(self, touch_params=touch_params)
        if not self.show_sensors:
            return
        for body, positions in touch.sensor_positions.items():
            name = self._core.names["body"][body]
            print(f"{name}: {len(positions)} touch sensors")
            utils.plot_points(positions, limit=1.0, title=name)
        print(f"{touch.get_total_sensor_count()} touch sensors")

    def _obs_callback(self) -> None:
        """Counts steps."""
        self.steps += 1

    def reset_model(self) -> Observation:
        """Moves the scene to its start, and returns the observation."""
        self.set_state(self.init_qpos, self.init_qvel)
        return self._get_obs()

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns False."""
        return False

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        """Returns 0."""
        return 0


class MIMoV2DummyEnv(MIMoDummyEnv):
    """The same with MIMo v2, who has fingers and big toes."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = BENCHMARK_XML_V2,
        touch_params: dict[str, Any] | None = tables.TOUCH_DEFAULTS_V2,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, touch_params=touch_params, **kwargs)


class MIMoMuscleDummyEnv(MIMoDummyEnv):
    """MIMo v2 with muscles."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = BENCHMARK_XML_V2,
        touch_params: dict[str, Any] | None = tables.TOUCH_DEFAULTS_V2,
        actuation_model: type[ActuationModel] = MuscleModel,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, touch_params=touch_params, actuation_model=actuation_model, **kwargs)
