"""Tests of MIMo 3's muscles."""

from babybench_kit.assets import scene_path as _path
from babybench_kit.assets import written
from babybench_kit.tasks.muscle_test import COMPLIANCE_CAMERA_CONFIG, COMPLIANCE_INIT_POSITION
from babybench_kit.third.tasks import PATHS as _FILES
from babybench_kit.third.tasks import (
    MIMoComplianceEnv,
    MIMoComplianceMuscleEnv,
    MIMoStaticMuscleTestEnv,
    MIMoStaticMuscleTestV2Env,
    MIMoVelocityMuscleTestEnv,
    MIMoVelocityMuscleTestV2Env,
)

__all__ = [
    "COMPLIANCE_CAMERA_CONFIG",
    "COMPLIANCE_INIT_POSITION",
    "MIMoComplianceEnv",
    "MIMoComplianceMuscleEnv",
    "MIMoStaticMuscleTestEnv",
    "MIMoStaticMuscleTestV2Env",
    "MIMoVelocityMuscleTestEnv",
    "MIMoVelocityMuscleTestV2Env",
]

_XML = ("STATIC_TEST_XML", "STATIC_TEST_XML_V2", "VELOCITY_TEST_XML", "VELOCITY_TEST_XML_V2", "COMPLIANCE_XML")
__getattr__ = written(__name__, {name: _path(_FILES[name], 3) for name in _XML}, 3)
