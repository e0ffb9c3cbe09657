"""The interface of the tasks of MIMo's environments."""

from __future__ import annotations

from typing import Any

from .sensing import Observation, SensingEnv


class GoalEnv(SensingEnv):
    """The methods that each task defines."""

    def reset_model(self) -> Observation:
        """Moves the scene to the start of an episode, and returns the observation."""
        raise NotImplementedError

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether a goal is reached."""
        raise NotImplementedError

    def is_failure(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether a goal can no longer be reached."""
        raise NotImplementedError

    def is_truncated(self) -> bool:
        """Returns whether the episode ends for another reason."""
        raise NotImplementedError

    def sample_goal(self) -> Any:
        """Returns a goal."""
        raise NotImplementedError

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> Any:
        """Returns the reward of a step."""
        raise NotImplementedError
