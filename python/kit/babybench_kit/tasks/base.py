"""The methods that most of MIMo's tasks share."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mimo_env import MIMoEnv


class TaskMethods(MIMoEnv):
    """A task that by default has no failure, no end of its own and no goal."""

    def is_failure(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns False."""
        return False

    def is_truncated(self) -> bool:
        """Returns False."""
        return False

    def sample_goal(self) -> Any:
        """Returns an empty array."""
        return np.zeros(0)

    def get_achieved_goal(self) -> Any:
        """Returns zeros in the shape of the goal."""
        return np.zeros(np.shape(self.goal))
