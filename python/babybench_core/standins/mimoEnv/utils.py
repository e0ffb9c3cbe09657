"""Names, subtrees and frames of models and states."""

from babybench_core.mimo.utils import *  # noqa: F403
