"""Catching a ball: ``mimoEnv.envs.catch``."""

from __future__ import annotations

import os
import random
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import tables, utils
from ..actuation import ActuationModel, MuscleModel
from ..assets import scene_path
from ..sensing import Observation
from .base import TaskMethods
from .looking import HeadTracking

CATCH_XML = scene_path("catch_scene.xml")
_SKIN = ("upper_arm", "lower_arm", "hand")
_DIGITS = ("ff", "mf", "rf", "lf")
_HAND = (
    *(f"{digit}distal" for digit in (*_DIGITS, "th")),
    *(f"{digit}middle" for digit in _DIGITS),
    "thhub",
    *(f"{digit}knuckle" for digit in _DIGITS),
    "thbase",
    "lfmetacarpal",
)
TOUCH_PARAMS: dict[str, Any] = {
    "scales": {f"right_{part}": tables.SPACING_V2[f"right_{part}"] for part in (*_SKIN, *_HAND)},
    "touch_function": "force_vector",
    "response_function": "spread_linear",
}
"""The sensors of the right arm."""
CATCH_CAMERA_CONFIG = {
    "trackbodyid": 0,
    "distance": 0.5,
    "lookat": np.asarray([0.15, -0.04, 0.6]),
    "elevation": -30,
    "azimuth": 120,
}
"""The camera before the hand."""
_LEAST_FORCE = 1e-9
"""Least normal force of a contact that counts, N."""
_HELD = 100
_COST = 40
BONUS = 100
_LOST = (0.1, 0.5)
"""How far the ball may be below the hand, and from it, m."""
_SETTLING = 50
"""Physics steps without gravity in which the arm settles."""
_JITTER = (0.8, 1.2)


class MIMoCatchEnv(TaskMethods):
    """A ball of random size and mass falls into MIMo's right hand, and he holds it.

    The reward is 1 for contact with the ball, less 40 times the cost of the actuation model, 100 for success and -100 for
    failure: the ball is 10 cm below the hand, or 50 cm from it. The radius of the ball is the last entry of ``observation``.

    Args:
        model_path: The scene.
        action_penalty: Whether the actuation costs.
        jitter: Whether actions are multiplied by random factors, which change every 10 to 50 steps.
        position_inaccurate: Whether head and eyes follow a point beside the ball.

    The other arguments are those of :class:`~babybench_kit.mimo_env.MIMoEnv`.

    Attributes:
        action_penalty, jitter: As the arguments; ``use_position_inaccuracy`` is ``position_inaccurate``.
        position_limits: How far the ball is moved at the start of an episode, (7,); MIMo's own then loses it, and so does this.
        position_inaccuracy_limits, position_offset: Largest and current distance of the point from the ball, (3,), m.
        size_limits, ball_size: Least and largest, and current radius of the ball, m.
        mass_limits, ball_mass: Least and largest, and current mass of the ball, kg.
        jitter_array, jitter_period: The factors, and for how many steps they apply.
        steps_in_contact_for_success: For how many steps the ball must be held.
        in_contact_past: Whether it was held in each of the last of these steps, by the number of the step.
    """

    def __init__(
        self,
        model_path: str | os.PathLike[str] = CATCH_XML,
        initial_qpos: Mapping[str, ArrayLike] | None = None,
        frame_skip: int = 2,
        proprio_params: dict[str, Any] | None = tables.PROPRIOCEPTION_DEFAULTS,
        touch_params: dict[str, Any] | None = TOUCH_PARAMS,
        vision_params: dict[str, Any] | None = None,
        vestibular_params: dict[str, Any] | None = None,
        actuation_model: type[ActuationModel] = MuscleModel,
        goals_in_observation: bool = False,
        done_active: bool = True,
        action_penalty: bool = True,
        jitter: bool = False,
        position_inaccurate: bool = False,
        default_camera_config: dict[str, Any] | None = CATCH_CAMERA_CONFIG,
        **kwargs: Any,
    ) -> None:
        """Compiles the scene."""
        self.jitter, self.use_position_inaccuracy = jitter, position_inaccurate
        self.action_penalty = action_penalty
        self.position_limits = np.array([0.01, 0.01, 0.08, 0, 0, 0, 0])
        self.position_inaccuracy_limits = np.full(3, 0.005)
        self.position_offset = np.zeros(3)
        self.size_limits, self.ball_size = (0.005, 0.025), 0.025
        self.mass_limits, self.ball_mass = (0.05, 0.5), 0.5
        self.jitter_period, self.jitter_array = 0, np.asarray(1.0)
        super().__init__(
            model_path=model_path,
            initial_qpos=initial_qpos,
            frame_skip=frame_skip,
            proprio_params=proprio_params,
            touch_params=touch_params,
            vision_params=vision_params,
            vestibular_params=vestibular_params,
            actuation_model=actuation_model,
            goals_in_observation=goals_in_observation,
            done_active=done_active,
            default_camera_config=default_camera_config,
            **kwargs,
        )
        self.steps_in_contact_for_success = _HELD
        self.in_contact_past = [False] * _HELD
        self.steps = 0
        bodies, joints, tree = self._core.names["body"], self._core.names["joint"], self._core.tree
        self.target_id, self.hand_id, self.head_id = (bodies.index(name) for name in ("target", "right_hand", "head"))
        self.target_geoms = utils.get_geoms_for_body(tree, self.target_id)
        skin = (touch_params or TOUCH_PARAMS)["scales"]
        self.own_geoms = [geom for name in skin for geom in utils.get_geoms_for_body(tree, bodies.index(name))]
        self.target_joint_id = joints.index("target_joint")
        array = self._core.blueprint.model_array
        self.target_joint_qpos = list(range(q := int(array("jnt_qposadr")[self.target_joint_id]), q + 7))
        self.target_joint_qvel = list(range(v := int(array("jnt_dofadr")[self.target_joint_id]), v + 6))
        self._tracking = HeadTracking(self._core)

    # --- the ball ---

    def _touching(self) -> NDArray[np.intp]:
        """Returns the contacts of the ball with the arm that have a force."""
        contacts = self._core.contacts()
        pairs = [(contacts["geom1"], contacts["geom2"]), (contacts["geom2"], contacts["geom1"])]
        beside = np.logical_or(*(np.isin(a, self.target_geoms) & np.isin(b, self.own_geoms) for a, b in pairs))
        return np.flatnonzero(beside & (abs(contacts["force"][:, 0]) >= _LEAST_FORCE))

    def _in_contact(self) -> bool:
        """Returns whether the arm touches the ball now."""
        return len(self._touching()) > 0

    def _currently_in_contact(self) -> bool:
        """Returns whether the arm touched the ball at the end of the last step."""
        return self.in_contact_past[self.steps % self.steps_in_contact_for_success]

    def body_contact_reward(self) -> float:
        """Returns a tenth of the number of contacts between the ball and the arm."""
        return len(self._touching()) / 10

    def _throw(self) -> None:
        """Changes the ball's radius and mass."""
        self.ball_size = random.uniform(*self.size_limits)
        self.ball_mass = random.uniform(*self.mass_limits)
        inertia = 2 * self.ball_mass * self.ball_size**2 / 5
        geom, body, dof = self.target_geoms[0], self.target_id, self.target_joint_qvel
        changes = {
            name: np.array(self._core.engine.model_array(name))
            for name in ("geom_size", "geom_rbound", "body_mass", "body_inertia", "body_invweight0", "dof_invweight0")
        }
        changes["geom_size"][geom, 0] = changes["geom_rbound"][geom] = self.ball_size
        changes["body_mass"][body], changes["body_inertia"][body] = self.ball_mass, inertia
        changes["body_invweight0"][body] = 1 / self.ball_mass, 1 / inertia
        changes["dof_invweight0"][dof] = np.repeat([1 / self.ball_mass, 1 / inertia], 3)
        self._core.change_model(changes)

    # --- the task ---

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
        """Returns the reward of contact, cost, success and failure."""
        reward = float(self._currently_in_contact())
        if self.action_penalty:
            reward -= _COST * self.actuation_model.cost()
        return reward + BONUS * (bool(info["is_success"]) - bool(info["is_failure"]))

    def do_simulation(self, action: ArrayLike, n_frames: int) -> None:
        """Applies an action times the factors of the jitter, limited to 0 to 1."""
        super().do_simulation(np.clip(np.asarray(action) * self.jitter_array, 0, 1), n_frames)

    def _get_obs(self) -> Observation:
        """Returns the observation, with the radius of the ball."""
        observation = super()._get_obs()
        observation["observation"] = np.append(observation["observation"], self.ball_size)
        return observation

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether the ball was held all the time."""
        return all(self.in_contact_past)

    def is_failure(self, achieved_goal: Any, desired_goal: Any) -> bool:
        """Returns whether the ball is lost."""
        ball, hand = (self._core.present.xpos[body] for body in (self.target_id, self.hand_id))
        return bool(ball[2] < hand[2] - _LOST[0] or np.linalg.norm(ball - hand) > _LOST[1])

    def reset_model(self) -> Observation:
        """Throws another ball, lets the arm settle, and returns the observation."""
        self.set_state(self.init_qpos, self.init_qvel)
        np.random.uniform(low=-self.position_limits, high=self.position_limits)
        self._throw()
        if self.use_position_inaccuracy:
            limits = self.position_inaccuracy_limits
            self.position_offset = np.random.uniform(low=-limits, high=limits)
        # the constants of the model are recomputed there, which leaves the scene at the positions of the springs
        self._core.forward(self._core.blueprint.model_array("qpos_spring"), self.init_qvel)
        gravity = np.array(self._core.engine.model_array("opt.gravity"))
        self._core.change_model({"opt.gravity": gravity * (1, 1, 0)})
        self.actuation_model.reset()
        self._set_action(np.zeros(self.action_space.shape or ()))
        for _ in range(_SETTLING):
            self._single_mujoco_step()
        self._core.change_model({"opt.gravity": gravity})
        self._step_callback()
        self.steps = 0
        self._core.forward(self._core.read("qpos"), self._core.read("qvel"))
        return self._get_obs()

    def _step_callback(self) -> None:
        """Records contact, turns head and eyes towards the ball, and changes the factors of the jitter."""
        self.steps += 1
        self.in_contact_past[self.steps % self.steps_in_contact_for_success] = self._in_contact()
        self._tracking.look_at(self._core.present.xpos[self.target_id] + self.position_offset)
        if not self.jitter:
            return
        if self.jitter_period > 0:
            self.jitter_period -= 1
        else:
            self.jitter_period = int(random.uniform(10, 51))
            self.jitter_array = np.random.uniform(*_JITTER, self.action_space.shape)
