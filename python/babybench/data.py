"""Records of runs: see :func:`open`. Motions: see :func:`play_motion`."""

from babybench_core.data import Episode, Record, Recorder, open
from babybench_core.motion import Played, play_motion

__all__ = ["Episode", "Played", "Record", "Recorder", "open", "play_motion"]
