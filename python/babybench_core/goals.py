"""Rewards of goals, as Gymnasium-Robotics and hindsight replay request them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

Infos = Union[Mapping[str, Any], Sequence[Mapping[str, Any]], npt.NDArray[np.object_]]
"""The information of one step, or of several."""

ComputeReward = Callable[[npt.ArrayLike, npt.ArrayLike, Infos], Union[float, npt.NDArray[np.float64]]]
"""A function of achieved goals, desired goals and information."""

Reward = Callable[[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike], npt.NDArray[np.float64]]


def compute_reward(
    reward: Reward, achieved_goal: npt.ArrayLike, desired_goal: npt.ArrayLike, infos: Infos, width: int
) -> Union[float, npt.NDArray[np.float64]]:
    """Calls ``reward`` with rows of goals and of the ``width`` terms in the information of their steps."""
    achieved, desired = (np.asarray(goal, np.float64) for goal in (achieved_goal, desired_goal))
    single = achieved.ndim == 1
    if single:
        achieved, desired = achieved[None], desired[None]
    each = [infos] if isinstance(infos, Mapping) else list(infos)
    if len(each) != len(achieved):
        raise ValueError(f"there are {len(achieved)} goals, but the information of {len(each)} steps")
    try:
        terms = np.array([info["reward_terms"] for info in each], np.float64).reshape(len(each), width)
    except KeyError:
        text = "the information has no reward_terms; HerReplayBuffer keeps it with copy_info_dict=True"
        raise KeyError(text) from None
    rewards = reward(achieved, desired, terms)
    return float(rewards[0]) if single else rewards
