"""Many environments at once: see :class:`VectorEnv`."""

from babybench_core.vector import AutoresetMode, VectorEnv

__all__ = ["AutoresetMode", "VectorEnv"]
