"""Standing up in a crib."""

from babybench_kit.assets import scene_path as _path
from babybench_kit.assets import written
from babybench_kit.tasks.standup import SITTING_POSITION
from babybench_kit.third.tasks import PATHS as _FILES
from babybench_kit.third.tasks import MIMoStandupEnv

__all__ = ["SITTING_POSITION", "MIMoStandupEnv"]

_XML = ("STANDUP_XML",)
__getattr__ = written(__name__, {name: _path(_FILES[name], 3) for name in _XML}, 3)
