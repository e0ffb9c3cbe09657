"""``mujoco.rollout``: many states advanced by the same model, with threads."""

from babybench_core.mujoco.rollout import *  # noqa: F403
from babybench_core.mujoco.rollout import __all__ as __all__
