"""The base of MIMo 3's environments, and the default parameters of the senses."""

from babybench_kit import tables as _second
from babybench_kit.actuation import ActuationModel, SpringDamperModel
from babybench_kit.assets import assets_folder
from babybench_kit.mimo_env import EMOTES
from babybench_kit.senses import Proprioception, SimpleProprioception, SimpleVestibular, Vestibular
from babybench_kit.third import tables
from babybench_kit.third.env import DEFAULT_SIZE, MIMoEnv
from babybench_kit.third.vision import SimpleVision, Vision
from babybench_kit.touch import Touch, TrimeshTouch

__all__ = [
    "DEFAULT_PROPRIOCEPTION_PARAMS",
    "DEFAULT_SIZE",
    "DEFAULT_TOUCH_PARAMS",
    "DEFAULT_TOUCH_PARAMS_V2",
    "DEFAULT_VESTIBULAR_PARAMS",
    "DEFAULT_VISION_PARAMS",
    "EMOTES",
    "ActuationModel",
    "MIMoEnv",
    "Proprioception",
    "SimpleProprioception",
    "SimpleVestibular",
    "SimpleVision",
    "SpringDamperModel",
    "Touch",
    "TrimeshTouch",
    "Vestibular",
    "Vision",
]

DEFAULT_TOUCH_PARAMS = tables.TOUCH_DEFAULTS
DEFAULT_TOUCH_PARAMS_V2 = tables.TOUCH_DEFAULTS_V2
DEFAULT_VISION_PARAMS = tables.VISION_DEFAULTS
DEFAULT_VESTIBULAR_PARAMS = _second.VESTIBULAR_DEFAULTS
DEFAULT_PROPRIOCEPTION_PARAMS = _second.PROPRIOCEPTION_DEFAULTS


def __getattr__(name: str) -> str:
    if name == "SCENE_DIRECTORY":
        return str(assets_folder(3))
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
