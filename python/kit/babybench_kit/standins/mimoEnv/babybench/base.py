"""The base of BabyBench's environments, and the default parameters of the senses."""

import os

from babybench_kit import tables
from babybench_kit.actuation import MODELS as ACTUATION_MODELS
from babybench_kit.actuation import MuscleModel, PositionalModel, SpringDamperModel
from babybench_kit.assets import assets_folder
from babybench_kit.env import DEFAULT_SIZE, SCENE_NAME, BabyBenchEnv, MIMoEnv
from babybench_kit.tables import PART_OF_BODY as BODY_GROUPS
from babybench_kit.tables import PROPRIOCEPTION_PARAMS, TOUCH_PARAMS, VESTIBULAR_PARAMS, VISION_PARAMS

__all__ = [
    "ACTUATION_MODELS",
    "BODY_GROUPS",
    "DEFAULT_SIZE",
    "PROPRIOCEPTION_PARAMS",
    "TOUCH_PARAMS",
    "TOUCH_PARAMS_V2",
    "VESTIBULAR_PARAMS",
    "VISION_PARAMS",
    "BabyBenchEnv",
    "MIMoEnv",
    "MuscleModel",
    "PositionalModel",
    "SpringDamperModel",
]

TOUCH_PARAMS_V2 = tables.touch_params(tables.SPACING_V2)


def __getattr__(name: str) -> str:
    if name == "SCENE_DIRECTORY":
        return str(assets_folder())
    if name == "SCENE_XML":
        return os.path.join(assets_folder(), SCENE_NAME)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
