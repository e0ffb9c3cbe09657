"""Touching a part of the body."""

from babybench_kit.assets import written
from babybench_kit.tasks import selfbody
from babybench_kit.tasks.selfbody import SITTING_POSITION, TOUCH_PARAMS, MIMoSelfBodyEnv

__all__ = ["SITTING_POSITION", "TOUCH_PARAMS", "MIMoSelfBodyEnv"]

__getattr__ = written(__name__, {"SELFBODY_XML": selfbody.SELFBODY_XML})
