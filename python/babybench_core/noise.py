"""Random movements, with which infants babble and learners explore."""

from __future__ import annotations

from typing import Union

import numpy as np
import numpy.typing as npt

from babybench_core import _native, changes
from babybench_core.env import Env
from babybench_core.vector import VectorEnv

__all__ = ["ActionNoise"]


class ActionNoise:
    """Action noise for an environment, or for each environment of a vector.

    The same seed gives the same actions here, in Rust and in JavaScript. All noises except ``white`` change slowly enough to
    move MIMo; a new action every 5 ms does not move him.

    Example:
        >>> import babybench
        >>> env = babybench.make("self_touch", vision_active=False)
        >>> noise = babybench.ActionNoise("pink", env, seed=0)
        >>> observation, info = env.reset(seed=0)
        >>> observation, reward, terminated, truncated, info = env.step(noise())
    """

    def __init__(self, noise: str, env: Union[Env, VectorEnv], seed: int = 0) -> None:
        """Makes a noise.

        Args:
            noise: ``white`` (new at every step), ``held`` (for 0.5 s; ``held:0.1`` for 0.1 s), ``ou`` (Ornstein-Uhlenbeck;
                ``ou:0.2`` with a correlation of 0.2 s), ``pink``, ``color:0.69`` (power falls with that power of the
                frequency, 0 to 2), ``color_by_age`` (the exponent of infants of MIMo's age; ``color_by_age:3`` of 3
                months), or ``oscillators`` (coupled, of 1 Hz on average; ``oscillators:2`` of 2 Hz).
            env: The environment, or the vector.
            seed: The seed. Environment i of a vector gets the seed plus i.

        Raises:
            ValueError: There is no such noise, or MIMo has no age for ``color_by_age``; the text lists the noises.
        """
        age = env.config.get("age")
        if noise == "color_by_age" and age is not None:
            noise = f"color_by_age:{age}"
        if isinstance(env, VectorEnv):
            count, space = env.num_envs, env.single_action_space
        else:
            count, space = 0, env.action_space
        self._many = count > 0
        seed = changes.seed_of(seed) or 0
        low, high = space.low.tolist(), space.high.tolist()
        self._noises = [_native.ActionNoise(noise, low, high, env.dt, seed + k) for k in range(max(count, 1))]

    def __call__(self) -> npt.NDArray[np.float32]:
        """Returns the next action, (action size), or those of a vector, (N, action size)."""
        actions = [noise.sample() for noise in self._noises]
        return np.stack(actions) if self._many else actions[0]

    def reset(self, seed: int = 0) -> None:
        """Restarts."""
        seed = changes.seed_of(seed) or 0
        for k, noise in enumerate(self._noises):
            noise.reset(seed + k)

    def __repr__(self) -> str:
        return f"<babybench.ActionNoise of {len(self._noises)}>"
