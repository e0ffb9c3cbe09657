"""Standing up."""

from babybench_kit.assets import written
from babybench_kit.tasks import standup
from babybench_kit.tasks.standup import SITTING_POSITION, MIMoStandupEnv

__all__ = ["SITTING_POSITION", "MIMoStandupEnv"]

__getattr__ = written(__name__, {"STANDUP_XML": standup.STANDUP_XML})
