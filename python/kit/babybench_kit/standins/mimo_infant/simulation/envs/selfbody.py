"""Touching a part of his own body."""

from babybench_kit.assets import scene_path as _path
from babybench_kit.assets import written
from babybench_kit.tasks.selfbody import SITTING_POSITION, TOUCH_PARAMS
from babybench_kit.third.tasks import PATHS as _FILES
from babybench_kit.third.tasks import MIMoSelfBodyEnv

__all__ = ["SITTING_POSITION", "TOUCH_PARAMS", "MIMoSelfBodyEnv"]

_XML = ("SELFBODY_XML",)
__getattr__ = written(__name__, {name: _path(_FILES[name], 3) for name in _XML}, 3)
