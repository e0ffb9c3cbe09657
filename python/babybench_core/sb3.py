"""Many environments at once for Stable-Baselines3.

Example:
    .. code-block:: python

        from stable_baselines3 import PPO

        import babybench

        envs = babybench.sb3.VecEnv("self_touch", num_envs=16)
        PPO("MultiInputPolicy", envs, n_steps=256).learn(100_000)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt
from stable_baselines3.common.vec_env import VecEnv as BaseVecEnv

from babybench_core import changes
from babybench_core.vector import AutoresetMode, VectorEnv

Indices = Union[None, int, Iterable[int]]

_OUTCOME = ("is_success", "is_failure", "reward_terms")
"""Keys by which a task judges a step."""
_KEYS = ("steps", "touches", "regards", "page_regards", "kit_regards", *_OUTCOME)
_PAIRS = ("right_eye_right_hand", "right_eye_left_hand", "left_eye_right_hand", "left_eye_left_hand")


def _ended(key: str, last: dict[str, Any], running: Any) -> Any:
    """Returns the value that a vector reports under a key for a finished episode; `running` is the next episode's value."""
    if key == "touches":
        touches = np.zeros_like(running)
        for hand, geoms in enumerate((last["right_hand_touches"], last["left_hand_touches"])):
            touches[hand, geoms] = 1
        return touches
    if key.endswith("regards"):
        counters = last if key == "regards" else last[key]
        return np.array([counters[pair] for pair in _PAIRS], dtype=running.dtype)
    return last.get(key, running)


class VecEnv(BaseVecEnv):
    """A vector of environments behind Stable-Baselines3's interface, on all cores and in one process.

    Ends of episodes are in ``infos[i]["terminal_observation"]``. Wrappers such as ``VecMonitor`` and ``VecNormalize`` go
    around it; wrappers of single environments do not go inside, so intrinsic rewards are computed for the vector: see
    ``examples/ppo_selftouch.py``. Observations are fresh arrays, because learners store those before a step after the step.
    """

    def __init__(self, config: Any = "self_touch", num_envs: Optional[int] = None, **arguments: Any) -> None:
        """Builds a vector; the arguments are those of :class:`babybench.VectorEnv` except ``autoreset_mode`` and ``copy``.

        Raises:
            ValueError: As :class:`babybench.VectorEnv`; ``copy=False``.
        """
        if not arguments.setdefault("copy", True):
            raise ValueError(
                "copy=False: Stable-Baselines3 stores the observations before a step when the step is done"
            )
        arguments["autoreset_mode"] = AutoresetMode.SAME_STEP
        self.envs = VectorEnv(config, num_envs, **arguments)
        self._actions: Optional[npt.NDArray[np.float32]] = None
        super().__init__(self.envs.num_envs, self.envs.single_observation_space, self.envs.single_action_space)

    def reset(self) -> dict[str, npt.NDArray[Any]]:
        """Starts an episode in all environments, with the seeds of :meth:`seed` and the options of :meth:`set_options`.

        Raises:
            ValueError: There is no such option.
        """
        seeds = list(self._seeds)
        each = [changes.options_of(options) for options in self._options]
        for env, options in enumerate(each):
            if "age" in options:
                self.envs.set_age(env, options["age"])
        observations, _ = self.envs.reset(
            seed=seeds if any(seed is not None for seed in seeds) else None,
            options={"model": [options.get("model") for options in each]},
        )
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: npt.NDArray[np.float32]) -> None:
        """Keeps the actions for :meth:`step_wait`."""
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[dict[str, npt.NDArray[Any]], npt.NDArray[np.float32], npt.NDArray[np.bool_], list[dict[str, Any]]]:
        """Applies the actions and waits for all environments."""
        if self._actions is None:
            raise RuntimeError("step_wait without step_async: no step is running")
        observations, rewards, terminated, truncated, infos = self.envs.step(self._actions)
        self._actions = None
        dones = terminated | truncated
        return observations, rewards.astype(np.float32), dones, self._split(infos, dones, truncated & ~terminated)

    def _split(
        self, infos: dict[str, Any], dones: npt.NDArray[np.bool_], cut: npt.NDArray[np.bool_]
    ) -> list[dict[str, Any]]:
        """Returns the information of each environment; for an episode that has ended, the information at its end."""
        keys = [key for key in _KEYS if key in infos]
        split: list[dict[str, Any]] = [{key: infos[key][env] for key in keys} for env in range(self.num_envs)]
        for env in np.flatnonzero(dones):
            last = infos["final_info"][env]
            split[env] = {key: _ended(key, last, value) for key, value in split[env].items()}
            split[env]["TimeLimit.truncated"] = bool(cut[env])
            split[env]["terminal_observation"] = infos["final_obs"][env]
            split[env]["final_info"] = last
        for env in np.flatnonzero(infos.get("_failure", ())):
            split[env]["failure"] = infos["failure"][env]
        return split

    def close(self) -> None:
        """Ends the threads and frees the environments."""
        self.envs.close()

    def get_images(self) -> Sequence[Optional[npt.NDArray[np.uint8]]]:
        """Draws the rooms."""
        return self.envs.render() or [None] * self.num_envs

    def get_attr(self, attr_name: str, indices: Indices = None) -> list[Any]:
        """Returns an attribute of each environment (see :meth:`babybench.VectorEnv.get_attr`), or the vector's own for each."""
        try:
            values = self.envs.get_attr(attr_name)
        except AttributeError:
            values = (getattr(self.envs, attr_name),) * self.num_envs
        return [values[env] for env in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Indices = None) -> None:
        """Raises an error, because environments of a vector have no attributes of their own."""
        self.envs.set_attr(attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: Indices = None, **kwargs: Any) -> list[Any]:
        """Calls a method of the vector (``info``, ``snapshot``, ``lock``, ...) with the number of each environment."""
        method = getattr(self.envs, method_name)
        return [method(env, *args, **kwargs) for env in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Indices = None) -> list[bool]:
        """Returns False for each environment."""
        return [False for _ in self._get_indices(indices)]


def sparse(features_dim: int = 64) -> dict[str, Any]:
    """Returns keyword arguments for PPO and A2C with ``"MultiInputPolicy"``, with which they learn faster from a whole skin.

    The networks are those of Stable-Baselines3 without these arguments, two layers of 64 with tanh for actions and two for
    values. Their outputs and gradients are the same up to rounding, because the omitted numbers are 0. Normalised
    observations (``VecNormalize``) are not 0 where nothing is felt, and gain nothing. Do not give ``policy_kwargs``
    besides: change those that it returns.

    Example:
        .. code-block:: python

            envs = babybench.sb3.VecEnv("self_touch", num_envs=16)
            PPO("MultiInputPolicy", envs, n_steps=128, batch_size=512, **babybench.sb3.sparse()).learn(100_000)

    Args:
        features_dim: The number of outputs of the first layer.
    """
    from babybench_core.sb3_sparse import SparseExtractor, SparseRolloutBuffer

    return {
        "rollout_buffer_class": SparseRolloutBuffer,
        "policy_kwargs": {
            "features_extractor_class": SparseExtractor,
            "features_extractor_kwargs": {"features_dim": features_dim},
            "share_features_extractor": False,
            "net_arch": [64],
        },
    }
