"""``mujoco.viewer`` for environments: a page on this machine that shows ``env.data`` while a program steps it."""

from babybench_core.mujoco.viewer import Handle, launch, launch_passive

__all__ = ["Handle", "launch", "launch_passive"]
