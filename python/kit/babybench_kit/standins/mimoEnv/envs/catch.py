"""Catching a ball."""

from babybench_kit.assets import written
from babybench_kit.tasks import catch
from babybench_kit.tasks.catch import CATCH_CAMERA_CONFIG, TOUCH_PARAMS, MIMoCatchEnv

__all__ = ["CATCH_CAMERA_CONFIG", "TOUCH_PARAMS", "MIMoCatchEnv"]

__getattr__ = written(__name__, {"CATCH_XML": catch.CATCH_XML})
