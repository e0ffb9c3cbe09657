"""MIMo 3's environments."""

from babybench_kit.third.env import MIMoEnv
from babybench_kit.third.roll_over import MIMoRollOverEnv
from babybench_kit.third.tasks import (
    MIMoCatchEnv,
    MIMoComplianceEnv,
    MIMoComplianceMuscleEnv,
    MIMoDummyEnv,
    MIMoMuscleDummyEnv,
    MIMoReachEnv,
    MIMoSelfBodyEnv,
    MIMoStandupEnv,
    MIMoStaticMuscleTestEnv,
    MIMoStaticMuscleTestV2Env,
    MIMoV2DummyEnv,
    MIMoVelocityMuscleTestEnv,
    MIMoVelocityMuscleTestV2Env,
)

__all__ = [
    "MIMoCatchEnv",
    "MIMoComplianceEnv",
    "MIMoComplianceMuscleEnv",
    "MIMoDummyEnv",
    "MIMoEnv",
    "MIMoMuscleDummyEnv",
    "MIMoReachEnv",
    "MIMoRollOverEnv",
    "MIMoSelfBodyEnv",
    "MIMoStandupEnv",
    "MIMoStaticMuscleTestEnv",
    "MIMoStaticMuscleTestV2Env",
    "MIMoV2DummyEnv",
    "MIMoVelocityMuscleTestEnv",
    "MIMoVelocityMuscleTestV2Env",
]
