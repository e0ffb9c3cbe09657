"""MIMo's environments."""

from babybench_kit.env import MIMoEnv
from babybench_kit.tasks.catch import MIMoCatchEnv
from babybench_kit.tasks.dummy import MIMoDummyEnv, MIMoMuscleDummyEnv, MIMoV2DummyEnv
from babybench_kit.tasks.muscle_test import (
    MIMoComplianceEnv,
    MIMoComplianceMuscleEnv,
    MIMoStaticMuscleTestEnv,
    MIMoStaticMuscleTestV2Env,
    MIMoVelocityMuscleTestEnv,
    MIMoVelocityMuscleTestV2Env,
)
from babybench_kit.tasks.reach import MIMoReachEnv
from babybench_kit.tasks.selfbody import MIMoSelfBodyEnv
from babybench_kit.tasks.standup import MIMoStandupEnv

__all__ = [
    "MIMoCatchEnv",
    "MIMoComplianceEnv",
    "MIMoComplianceMuscleEnv",
    "MIMoDummyEnv",
    "MIMoEnv",
    "MIMoMuscleDummyEnv",
    "MIMoReachEnv",
    "MIMoSelfBodyEnv",
    "MIMoStandupEnv",
    "MIMoStaticMuscleTestEnv",
    "MIMoStaticMuscleTestV2Env",
    "MIMoV2DummyEnv",
    "MIMoVelocityMuscleTestEnv",
    "MIMoVelocityMuscleTestV2Env",
]
