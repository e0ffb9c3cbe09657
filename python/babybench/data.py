"""Records of runs: see :func:`open`."""

from babybench_core.data import Episode, Record, Recorder, open

__all__ = ["Episode", "Record", "Recorder", "open"]
