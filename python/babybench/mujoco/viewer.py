"""``mujoco.viewer``: a page on this machine that shows a state while a program steps it, of an environment or of any model."""

from babybench_core.mujoco.viewer import Handle, Window, launch, launch_from_path, launch_passive

__all__ = ["Handle", "Window", "launch", "launch_from_path", "launch_passive"]
