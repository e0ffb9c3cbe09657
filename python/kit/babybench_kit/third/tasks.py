"""MIMo 3's tasks: those of MIMo 2 on MIMo 3's scenes, and what differs."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import tables
from ..actuation import ActuationModel, MuscleModel, SpringDamperModel
from ..assets import scene_path
from ..tasks import catch, dummy, muscle_test, reach, selfbody, standup
from ..tasks.looking import HeadTracking
from .env import MIMoEnv
from .tables import TOUCH_DEFAULTS, TOUCH_DEFAULTS_V2, VISION_DEFAULTS

PATHS = {
    "DEMO_XML": "showroom.xml",
    "BENCHMARK_XML": "benchmark_scene.xml",
    "BENCHMARK_XML_V2": "benchmarkv2_scene.xml",
    "TEST_XML": "test_scene.xml",
    "REACH_XML": "reach_scene.xml",
    "STANDUP_XML": "standup_scene.xml",
    "SELFBODY_XML": "selfbody_scene.xml",
    "CATCH_XML": "catch_scene.xml",
    "STATIC_TEST_XML": "muscle_static_test.xml",
    "STATIC_TEST_XML_V2": "muscle_static_test_v2.xml",
    "VELOCITY_TEST_XML": "muscle_velocity_test.xml",
    "VELOCITY_TEST_XML_V2": "muscle_velocity_test_v2.xml",
    "COMPLIANCE_XML": "compliance_test_scene.xml",
}
"""The names of scenes in MIMo 3's modules, and of their files; there is no ``test_scene.xml``, as in MIMo 3's own."""
_XML = {name: scene_path(file, 3) for name, file in PATHS.items()}
_NEAR = 0.5
"""The largest reward or cost of the distance of the ball from the hand, m."""


class MIMoDummyEnv(dummy.MIMoDummyEnv, MIMoEnv):
    """MIMo v1 with all senses next to two objects on a plane, without a goal or a reward."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["BENCHMARK_XML"],
        frame_skip: int = 2,
        initial_qpos: Mapping[str, ArrayLike] | None = None,
        render_mode: str | None = None,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = TOUCH_DEFAULTS,
        vision_params: dict[str, Any] | None = VISION_DEFAULTS,
        vestibular_params: dict[str, Any] | None = tables.VESTIBULAR_DEFAULTS,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        goals_in_observation: bool = False,
        done_active: bool = True,
        show_sensors: bool = False,
        print_space_sizes: bool = False,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(
            model_path,
            frame_skip,
            initial_qpos,
            render_mode,
            proprio_params,
            touch_params,
            vision_params,
            vestibular_params,
            actuation_model,
            goals_in_observation,
            done_active,
            show_sensors,
            print_space_sizes,
            **kwargs,
        )


class MIMoV2DummyEnv(MIMoDummyEnv):
    """The same with MIMo v2, who has fingers and big toes."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["BENCHMARK_XML_V2"],
        touch_params: dict[str, Any] | None = TOUCH_DEFAULTS_V2,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, touch_params=touch_params, **kwargs)


class MIMoMuscleDummyEnv(MIMoDummyEnv):
    """MIMo v2 with muscles."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["BENCHMARK_XML_V2"],
        touch_params: dict[str, Any] | None = TOUCH_DEFAULTS_V2,
        actuation_model: type[ActuationModel] = MuscleModel,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, touch_params=touch_params, actuation_model=actuation_model, **kwargs)


class MIMoReachEnv(reach.MIMoReachEnv, MIMoEnv):
    """MIMo hangs in the air and knocks a hovering ball away with the right hand; his eyes follow it."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["REACH_XML"],
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
            model_path,
            proprio_params,
            touch_params,
            vision_params,
            vestibular_params,
            actuation_model,
            goals_in_observation,
            done_active,
            **kwargs,
        )

    def _make_tracking(self) -> HeadTracking:
        """Finds the joints that follow the ball; the right eye looks straight ahead, as in MIMo 3's own."""
        free = ("right_eye_vertical", "right_eye_torsional")
        return HeadTracking(self._core, free=free, straight=("right_eye_horizontal",))


class MIMoStandupEnv(standup.MIMoStandupEnv, MIMoEnv):
    """MIMo crouches at a railing that he holds, and raises his head."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["STANDUP_XML"],
        initial_qpos: Mapping[str, ArrayLike] | None = standup.SITTING_POSITION,
        frame_skip: int = 2,
        age: float | None = None,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = None,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = tables.VESTIBULAR_DEFAULTS,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene.

        Raises:
            NotImplementedError: ``age`` is given: the railing grows with MIMo in the engine's own task.
        """
        if age is not None:
            raise NotImplementedError(
                "age: MIMoStandupEnv has no other ages here; the railing grows with MIMo in "
                'babybench.make("standup", mimo_version=3, age=...)'
            )
        kwargs.setdefault("default_camera_config", {"azimuth": 180})
        super().__init__(
            model_path,
            initial_qpos,
            frame_skip,
            proprio_params,
            touch_params,
            vision_params,
            vestibular_params,
            actuation_model,
            **kwargs,
        )


class MIMoSelfBodyEnv(selfbody.MIMoSelfBodyEnv, MIMoEnv):
    """MIMo sits and touches a part of his body, the goal, with the right arm."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["SELFBODY_XML"],
        initial_qpos: Mapping[str, ArrayLike] | None = selfbody.SITTING_POSITION,
        frame_skip: int = 1,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = selfbody.TOUCH_PARAMS,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = None,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        goals_in_observation: bool = True,
        done_active: bool = True,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene, and lets MIMo settle in his seat."""
        super().__init__(
            model_path,
            initial_qpos,
            frame_skip,
            proprio_params,
            touch_params,
            vision_params,
            vestibular_params,
            actuation_model,
            goals_in_observation,
            done_active,
            **kwargs,
        )


class MIMoCatchEnv(catch.MIMoCatchEnv, MIMoEnv):
    """A ball of random size and mass falls into MIMo's right hand, and he holds it.

    The reward is 1 for contact with the ball, or else 0.5 m less its distance from the hand, at least -0.5 and at most 0.5; with
    100 for success and -100 for failure.
    """

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["CATCH_XML"],
        initial_qpos: Mapping[str, ArrayLike] | None = None,
        frame_skip: int = 2,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = catch.TOUCH_PARAMS,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = None,
        actuation_model: type[ActuationModel] = MuscleModel,
        goals_in_observation: bool = False,
        done_active: bool = True,
        action_penalty: bool = True,
        jitter: bool = False,
        position_inaccurate: bool = False,
        default_camera_config: dict[str, Any] | None = catch.CATCH_CAMERA_CONFIG,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(
            model_path,
            initial_qpos,
            frame_skip,
            proprio_params,
            touch_params,
            vision_params,
            vestibular_params,
            actuation_model,
            goals_in_observation,
            done_active,
            action_penalty,
            jitter,
            position_inaccurate,
            default_camera_config,
            **kwargs,
        )

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        """Returns the reward of contact or nearness, success and failure."""
        ball, hand = (self._core.present.xpos[body] for body in (self.target_id, self.hand_id))
        near = float(np.clip(_NEAR - np.linalg.norm(hand - ball), -_NEAR, _NEAR))
        reward = 1.0 if self._currently_in_contact() else near
        return reward + catch.BONUS * (bool(info["is_success"]) - bool(info["is_failure"]))


class MIMoStaticMuscleTestEnv(muscle_test.MIMoStaticMuscleTestEnv, MIMoDummyEnv):
    """All joints are held, so that the torques of the muscles show: MIMo v1 without gravity."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["STATIC_TEST_XML"],
        default_camera_config: dict[str, Any] | None = muscle_test.SIDE_VIEW,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(model_path, default_camera_config, **kwargs)


class MIMoStaticMuscleTestV2Env(MIMoStaticMuscleTestEnv):
    """The same with MIMo v2. MIMo's own scene does not load: it names a joint that MIMo does not have."""

    def __init__(self, model_path: str | os.PathLike[str] = _XML["STATIC_TEST_XML_V2"], **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, **kwargs)


class MIMoVelocityMuscleTestEnv(MIMoStaticMuscleTestEnv):
    """MIMo v1 hangs by the hip without gravity, so that the velocities of the muscles show."""

    def __init__(self, model_path: str | os.PathLike[str] = _XML["VELOCITY_TEST_XML"], **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, **kwargs)


class MIMoVelocityMuscleTestV2Env(MIMoStaticMuscleTestEnv):
    """The same with MIMo v2."""

    def __init__(self, model_path: str | os.PathLike[str] = _XML["VELOCITY_TEST_XML_V2"], **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, **kwargs)


class MIMoComplianceEnv(muscle_test.MIMoComplianceEnv, MIMoDummyEnv):
    """A ball falls onto an outstretched arm that yields only at the shoulder: MIMo v2."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = _XML["COMPLIANCE_XML"],
        initial_qpos: Mapping[str, ArrayLike] | None = muscle_test.COMPLIANCE_INIT_POSITION,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        default_camera_config: dict[str, Any] | None = muscle_test.COMPLIANCE_CAMERA_CONFIG,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene, holds the joints that have a lock, and lets weld and locks settle without gravity."""
        super().__init__(model_path, initial_qpos, actuation_model, default_camera_config, **kwargs)


class MIMoComplianceMuscleEnv(MIMoComplianceEnv):
    """The same with muscles."""

    def __init__(self, actuation_model: type[ActuationModel] = MuscleModel, **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(actuation_model=actuation_model, **kwargs)
