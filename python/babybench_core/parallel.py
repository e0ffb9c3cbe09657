"""Two infants in one room behind PettingZoo's parallel interface.

Example:
    .. code-block:: python

        from babybench.pettingzoo import ParallelEnv

        env = ParallelEnv("two.yml")  # its scene includes other_mimo.xml
        observations, infos = env.reset(seed=0)
        while env.agents:
            actions = {agent: env.action_space(agent).sample() for agent in env.agents}
            observations, rewards, terminations, truncations, infos = env.step(actions)
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, ClassVar, Optional

import gymnasium
import numpy as np
import numpy.typing as npt
import pettingzoo

from babybench_core import changes
from babybench_core.env import Env

LEARNER = "learner"
"""The infant whom the configuration calls the learner."""
OTHER = "other"
"""The other infant in the room."""

Observation = Any
"""The learner's is that of :class:`babybench.Env`, the other's an array."""


class ParallelEnv(pettingzoo.ParallelEnv[str, Observation, npt.NDArray[np.float32]]):
    """Two infants in one room, who act at the same time.

    ``learner`` has the observations and rewards of :class:`babybench.Env`. ``other`` is the second infant of a scene that
    includes ``other_mimo.xml``: his action is a number for each motor, in [-1, 1], or an angle for each servo, rad
    (``actuation_model: positional``); his observation, float64, has the angles (rad) and velocities (rad/s) of his joints,
    acceleration (m/s^2, 3) and angular velocity (rad/s, 3) of his head, and the torque (N m, 3) on each part; he has neither
    skin nor eyes, and his reward is 0. An episode ends for both at once.

    Attributes:
        env: The environment of the learner.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "babybench_v0",
        "render_modes": Env.metadata["render_modes"],
        "is_parallelizable": True,
    }

    def __init__(self, config: Any = "self_touch", **arguments: Any) -> None:
        """Builds the room; the arguments are those of :class:`babybench.Env`.

        Raises:
            ValueError: As :class:`babybench.Env`; the scene has one infant, or the actuation model is muscles, which only
                the learner has.
        """
        self.env = Env(config, **arguments)
        spaces = self.env._core.second_spaces()
        if spaces is None:
            self.env.close()
            raise ValueError(
                "the scene has no second infant to move: include other_mimo.xml, as the guide's chapter on rooms shows, "
                "and leave actuation_model: muscle out"
            )
        (low, high), felt = spaces
        self.possible_agents = [LEARNER, OTHER]
        self.agents: list[str] = []
        self.render_mode = self.env.render_mode
        self.action_spaces: dict[str, gymnasium.Space[Any]] = {
            LEARNER: self.env.action_space,
            OTHER: gymnasium.spaces.Box(low, high, dtype=np.float32),
        }
        self.observation_spaces: dict[str, gymnasium.Space[Any]] = {
            LEARNER: self.env.observation_space,
            OTHER: gymnasium.spaces.Box(-np.inf, np.inf, (felt,), dtype=np.float64),
        }

    def observation_space(self, agent: str) -> gymnasium.Space[Any]:
        """Returns the space of an infant's observations: always the same object."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> gymnasium.Space[Any]:
        """Returns the space of an infant's actions: always the same object."""
        return self.action_spaces[agent]

    def reset(
        self, seed: Optional[int] = None, options: Optional[Mapping[str, object]] = None
    ) -> tuple[dict[str, Observation], dict[str, Any]]:
        """Starts an episode of both; see :meth:`babybench.Env.reset`.

        Warns:
            UserWarning: There is no such option. PettingZoo's own test of environments gives one.
        """
        known = {name: value for name, value in (options or {}).items() if name in changes.OPTIONS}
        if len(known) < len(options or {}):
            strange = ", ".join(repr(name) for name in (options or {}) if name not in known)
            warnings.warn(
                f"options of a reset without effect: {strange}; there are {', '.join(changes.OPTIONS)}", stacklevel=2
            )
        observation, info = self.env.reset(seed=seed, options=known)
        self.agents = list(self.possible_agents)
        return self._observed(observation), {LEARNER: info, OTHER: {}}

    def step(
        self, actions: Mapping[str, npt.NDArray[np.float32]]
    ) -> tuple[dict[str, Observation], dict[str, float], dict[str, bool], dict[str, bool], dict[str, Any]]:
        """Applies an action of each infant. Only the learner needs one; without one, the other infant keeps his last action.

        Raises:
            KeyError: There is no action of the learner, or there is one of an unknown agent.
            ValueError: Actions of another shape, or with numbers that are not finite. Nothing has moved then; a valid action of
                the other is kept for the next step.
            RuntimeError: The episode is over, the simulation diverged, or there was no reset; reset it.
        """
        if not self.agents:
            raise RuntimeError("the episode is over, and no agent is left: call reset() before the next step()")
        for agent in actions:
            if agent not in self.agents:
                raise KeyError(f"there is no agent {agent!r}; agents are {', '.join(self.agents)}")
        if LEARNER not in actions:
            raise KeyError(f"there is no action of the agent {LEARNER!r}, which needs one in each step")
        action = actions[LEARNER]
        if OTHER in actions:
            self.env._core.act_second(actions[OTHER])
        observation, reward, terminated, truncated, info = self.env.step(action)
        both = self.possible_agents
        if terminated or truncated:
            self.agents = []
        return (
            self._observed(observation),
            {LEARNER: float(reward), OTHER: 0.0},
            dict.fromkeys(both, terminated),
            dict.fromkeys(both, truncated),
            {LEARNER: info, OTHER: {}},
        )

    def render(self) -> Any:
        """Draws the room: see :meth:`babybench.Env.render`."""
        return self.env.render()

    def close(self) -> None:
        """Frees the environment."""
        self.env.close()

    def _observed(self, observation: Observation) -> dict[str, Observation]:
        return {LEARNER: observation, OTHER: self.env._core.observe_second()}
