"""The senses of MIMo's environments: how they are made, and what an observation consists of."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from .actuation import ActuationModel
from .core import Core
from .course import Share
from .replaceable import Replaceable, replaced
from .senses import Proprioception, SimpleProprioception, SimpleVestibular, SimpleVision, Vestibular, Vision
from .touch import Touch, TrimeshTouch

Observation = dict[str, NDArray[Any]]
Array = NDArray[np.float64]

_HOOKS = ("get_proprio_obs", "get_touch_obs", "get_vision_obs", "get_vestibular_obs")
_PARTS = ("proprioception", "touch", "vision", "vestibular", "actuation_model")


class SensingEnv(gym.Env):  # type: ignore[type-arg,unused-ignore]
    """An environment with proprioception, touch, vision and balance, which subclasses can replace.

    Attributes:
        proprioception, touch, vision, vestibular: The senses; ``None`` where one is off.
    """

    proprio_params: dict[str, Any] | None
    touch_params: dict[str, Any] | None
    vision_params: dict[str, Any] | None
    vestibular_params: dict[str, Any] | None
    proprioception: Proprioception | None = None
    touch: Touch | None = None
    vision: Vision | None = None
    vestibular: Vestibular | None = None
    goals_in_observation: bool
    goal: Any
    actuation_model: ActuationModel
    _core: Core
    _share = Share.SENSES

    # --- construction ---

    def _env_setup(self) -> None:
        """Makes the senses."""
        self.proprio_setup(self.proprio_params)
        if self.touch_params is not None:
            self.touch_setup(self.touch_params)
        if self.vision_params is not None:
            self.vision_setup(self.vision_params)
        if self.vestibular_params is not None:
            self.vestibular_setup(self.vestibular_params)

    def proprio_setup(self, proprio_params: dict[str, Any] | None) -> None:
        """Makes proprioception."""
        self.proprioception = SimpleProprioception(self, proprio_params)

    def touch_setup(self, touch_params: dict[str, Any]) -> None:
        """Makes touch."""
        self.touch = TrimeshTouch(self, touch_params)

    def vision_setup(self, vision_params: dict[str, Any]) -> None:
        """Makes vision."""
        self.vision = SimpleVision(self, vision_params)

    def vestibular_setup(self, vestibular_params: dict[str, Any]) -> None:
        """Makes the sense of balance."""
        self.vestibular = SimpleVestibular(self, vestibular_params)

    def _set_observation_space(self) -> None:
        """Makes :attr:`observation_space` from an observation."""
        observation = self._get_obs()
        boxes: dict[str, spaces.Space[Any]] = {}
        for key, value in observation.items():
            low, high = (0, 255) if value.dtype == np.uint8 else (-np.inf, np.inf)
            boxes[key] = spaces.Box(low, high, shape=value.shape, dtype=value.dtype.type)
        self.observation_space = spaces.Dict(boxes)

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        if name in _PARTS or callable(getattr(type(self), name, None)):
            self._reconsider()

    def _reconsider(self) -> None:
        """Records that a script has replaced a part or a method of this environment."""
        if "_share" in self.__dict__:
            self.__dict__["_share"] = self._share_of_the_script()

    def _share_of_the_script(self) -> Share:
        """Returns the parts of this environment that a script has replaced."""
        raise NotImplementedError

    def _observes_plainly(self) -> bool:
        """Returns whether the observation is the engine's, with nothing replaced."""
        known = (SimpleProprioception, TrimeshTouch, SimpleVision, SimpleVestibular, type(None))
        senses = (self.proprioception, self.touch, self.vision, self.vestibular)
        components = set((self.proprio_params or {}).get("components", ()))
        return (
            not replaced(self, _ORIGINAL, _HOOKS)
            and all(type(sense) in known or getattr(sense, "_as_known", False) for sense in senses)
            and not any(sense._replaced for sense in senses if isinstance(sense, Replaceable))
            and (self.touch is None or self.touch._plain)
            and (self.vision is None or self._core.config["vision_active"])
            and (self.vestibular is None or self._core.config["vestibular_active"])
            and components == set(SimpleProprioception.VALID_COMPONENTS)
            and self._core.plain_actuation
            and self._core.whole
            and not self.goals_in_observation
        )

    # --- observation ---

    def get_proprio_obs(self) -> Array:
        """Returns the current proprioception, (n,)."""
        assert self.proprioception is not None
        return self.proprioception.get_proprioception_obs()

    def get_touch_obs(self) -> NDArray[np.float32]:
        """Returns the current touch forces, (sensors, 3), N."""
        assert self.touch is not None
        return self.touch.get_touch_obs()

    def get_vision_obs(self) -> dict[str, NDArray[np.uint8]]:
        """Returns the current pictures, by camera."""
        assert self.vision is not None
        return self.vision.get_vision_obs()

    def get_vestibular_obs(self) -> Array:
        """Returns the current sense of balance, (6,)."""
        assert self.vestibular is not None
        return self.vestibular.get_vestibular_obs()

    def _get_obs(self) -> Observation:
        """Returns the observation: the current one, or an earlier one with a sensory delay."""
        return self._delayed_observation(self._sensed())

    def _delayed_observation(self, observation: Observation) -> Observation:
        """Returns the observation that arrives when one is made: the same one, except with MIMo 3's delay."""
        return observation

    def _sensed(self) -> Observation:
        """Returns the current observation."""
        core = self._core
        core.observe()
        # feeling again at one instant gives other forces
        if self._share is not Share.SENSES and not core.course.moment.felt:
            if self.touch is not None:
                core.course.change("feel")
            return core.observation()
        observation: Observation = {"observation": self.get_proprio_obs()}
        if self.touch:
            observation["touch"] = self.get_touch_obs().ravel()
        if self.vision:
            observation.update(self.get_vision_obs())
        if self.vestibular:
            observation["vestibular"] = self.get_vestibular_obs()
        if self.goals_in_observation:
            observation["achieved_goal"] = np.array(self.get_achieved_goal())
            observation["desired_goal"] = np.array(self.goal)
        return observation

    def get_achieved_goal(self) -> Any:
        """Returns the goal that the current state has achieved."""
        raise NotImplementedError


_ORIGINAL = dict(vars(SensingEnv))
