"""Catching a ball."""

from babybench_kit.assets import scene_path as _path
from babybench_kit.assets import written
from babybench_kit.tasks.catch import CATCH_CAMERA_CONFIG, TOUCH_PARAMS
from babybench_kit.third.tasks import PATHS as _FILES
from babybench_kit.third.tasks import MIMoCatchEnv

__all__ = ["CATCH_CAMERA_CONFIG", "TOUCH_PARAMS", "MIMoCatchEnv"]

_XML = ("CATCH_XML",)
__getattr__ = written(__name__, {name: _path(_FILES[name], 3) for name in _XML}, 3)
