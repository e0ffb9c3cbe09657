"""Names, subtrees and frames of models and states."""

from babybench_kit.utils import *  # noqa: F403
