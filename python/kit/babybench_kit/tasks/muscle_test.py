"""Tests of MIMo's muscles: ``mimoEnv.envs.muscle_test``."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import utils
from ..actuation import ActuationModel, MuscleModel, SpringDamperModel
from ..assets import scene_path
from .dummy import MIMoDummyEnv

STATIC_TEST_XML = scene_path("muscle_static_test.xml")
STATIC_TEST_XML_V2 = scene_path("muscle_static_test_v2.xml")
VELOCITY_TEST_XML = scene_path("muscle_velocity_test.xml")
VELOCITY_TEST_XML_V2 = scene_path("muscle_velocity_test_v2.xml")
COMPLIANCE_XML = scene_path("compliance_test_scene.xml")
COMPLIANCE_INIT_POSITION = {"robot:right_shoulder_ad_ab": np.array([1.35])}
"""The raised arm, rad."""
COMPLIANCE_CAMERA_CONFIG = {
    "trackbodyid": 0,
    "distance": 1.5,
    "lookat": np.asarray([0, -0.3, 0.5]),
    "elevation": 0,
    "azimuth": 180,
}
"""The camera in front of MIMo."""
SIDE_VIEW = {"azimuth": 135}
_FREE = "robot:right_shoulder_ad_ab"
_WRIST = ("robot:right_hand1", -0.25)


class MIMoStaticMuscleTestEnv(MIMoDummyEnv):
    """All joints are held, so that the torques of the muscles show: MIMo v1 without gravity."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = STATIC_TEST_XML,
        default_camera_config: dict[str, Any] | None = SIDE_VIEW,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        super().__init__(
            model_path=model_path,
            proprio_params=None,
            touch_params=None,
            vision_params=None,
            vestibular_params=None,
            actuation_model=MuscleModel,
            goals_in_observation=False,
            done_active=False,
            default_camera_config=default_camera_config,
            **kwargs,
        )


class MIMoStaticMuscleTestV2Env(MIMoStaticMuscleTestEnv):
    """The same with MIMo v2; MIMo's own scene names a joint that MIMo does not have, and does not load."""

    def __init__(self, model_path: str | os.PathLike[str] = STATIC_TEST_XML_V2, **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, **kwargs)


class MIMoVelocityMuscleTestEnv(MIMoStaticMuscleTestEnv):
    """MIMo v1 hangs by the hip without gravity, so that the velocities of the muscles show."""

    def __init__(self, model_path: str | os.PathLike[str] = VELOCITY_TEST_XML, **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, **kwargs)


class MIMoVelocityMuscleTestV2Env(MIMoStaticMuscleTestEnv):
    """The same with MIMo v2."""

    def __init__(self, model_path: str | os.PathLike[str] = VELOCITY_TEST_XML_V2, **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(model_path=model_path, **kwargs)


class MIMoComplianceEnv(MIMoDummyEnv):
    """A ball falls onto an outstretched arm that yields only at the shoulder: MIMo v2."""

    def __init__(
        self,
        model_path: str | os.PathLike[str] = COMPLIANCE_XML,
        initial_qpos: Mapping[str, ArrayLike] | None = COMPLIANCE_INIT_POSITION,
        actuation_model: type[ActuationModel] = SpringDamperModel,
        default_camera_config: dict[str, Any] | None = COMPLIANCE_CAMERA_CONFIG,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene, holds the joints, and lets weld and locks settle without gravity."""
        super().__init__(
            model_path=model_path,
            initial_qpos=initial_qpos,
            proprio_params=None,
            touch_params=None,
            vision_params=None,
            vestibular_params=None,
            actuation_model=actuation_model,
            default_camera_config=default_camera_config,
            **kwargs,
        )
        model = self.model
        for joint in self.mimo_joints:
            name = self._core.names["joint"][joint]
            if name != _FREE and name in self._core.names["equality"]:
                utils.lock_joint(model, name)
        wrist, angle = _WRIST
        utils.lock_joint(model, wrist, joint_angle=angle)
        weight = float(model.opt.gravity[2])
        model.opt.gravity[2] = 0
        self.do_simulation(np.zeros(self.action_space.shape or ()), 2)
        model.opt.gravity[2] = weight
        self.init_qpos = self._core.read("qpos")


class MIMoComplianceMuscleEnv(MIMoComplianceEnv):
    """The same with muscles."""

    def __init__(self, actuation_model: type[ActuationModel] = MuscleModel, **kwargs: Any) -> None:
        """Compiles the scene."""
        super().__init__(actuation_model=actuation_model, **kwargs)
