"""Two infants in one room, each with a policy of his own: see :class:`ParallelEnv`."""

from babybench_core.parallel import LEARNER, OTHER, ParallelEnv

__all__ = ["LEARNER", "OTHER", "ParallelEnv"]
