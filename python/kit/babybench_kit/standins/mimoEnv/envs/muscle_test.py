"""Tests of muscles."""

from babybench_kit.assets import written
from babybench_kit.tasks import muscle_test
from babybench_kit.tasks.muscle_test import (
    COMPLIANCE_CAMERA_CONFIG,
    COMPLIANCE_INIT_POSITION,
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

__getattr__ = written(
    __name__,
    {
        "COMPLIANCE_XML": muscle_test.COMPLIANCE_XML,
        "STATIC_TEST_XML": muscle_test.STATIC_TEST_XML,
        "STATIC_TEST_XML_V2": muscle_test.STATIC_TEST_XML_V2,
        "VELOCITY_TEST_XML": muscle_test.VELOCITY_TEST_XML,
        "VELOCITY_TEST_XML_V2": muscle_test.VELOCITY_TEST_XML_V2,
    },
)
