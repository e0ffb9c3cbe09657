"""MIMo's actuation models: ``mimoActuation``.

They run in the engine. These classes show their values, and let subclasses change an action on its way.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NoReturn

import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from babybench_core import _native

from .muscle_parts import MuscleParts
from .replaceable import Replaceable
from .utils import JOINT_EQUALITY

if TYPE_CHECKING:
    from .mimo_env import MIMoEnv

Array = NDArray[np.float64]


class ActuationModel(Replaceable):
    """The interface of actuation models.

    Attributes:
        env: The environment.
        actuators: Ids of the actuators, (n,).
        n_actuators: Their number.
        action_space: The bounds of an action.
    """

    _engine_name = ""
    """The value of ``actuation_model`` in a configuration."""

    def __init__(self, env: MIMoEnv, actuators: NDArray[np.int_], *args: Any) -> None:
        """Takes the environment and the ids of the actuators to drive."""
        self.env = env
        self._core = env._core
        self.actuators = actuators
        self.n_actuators = actuators.shape[0]
        self.action_space = self.get_action_space()

    def get_action_space(self) -> spaces.Box:
        """Returns the bounds of an action."""
        raise NotImplementedError

    def action(self, action: ArrayLike) -> None:
        """Takes an action for the next step."""
        raise NotImplementedError

    def substep_update(self) -> None:
        """Updates the actuators before each physics step of a step except the first."""

    def observations(self) -> Array:
        """Returns the actuators' part of proprioception."""
        raise NotImplementedError

    def cost(self) -> float:
        """Returns the cost of the present controls."""
        raise NotImplementedError

    def reset(self) -> None:
        """Puts the actuators to rest."""
        raise NotImplementedError


class EngineActuation(ActuationModel):
    """An actuation model that runs in the engine.

    Attributes:
        control_input: The last action, clipped to the action space.
    """

    _state = frozenset({"control_input"})
    _fixed: ClassVar[frozenset[str]] = frozenset({"actuators", "n_actuators"})
    """Attributes that the engine does not use."""

    def __init_subclass__(cls, **arguments: Any) -> None:
        """Refuses subclasses that change values that the engine does not read."""
        super().__init_subclass__(**arguments)
        if cls.__module__ != __name__:
            for name in sorted(cls._fixed & set(vars(cls))):
                cls._refuse(name)

    def __init__(self, env: MIMoEnv, actuators: NDArray[np.int_]) -> None:
        """Takes the environment and the ids of its actuators: all of MIMo's.

        Raises:
            ValueError: The environment has another actuation model.
        """
        self.control_input: NDArray[Any] = np.zeros(0)
        made_for = env._core.config["actuation_model"]
        if made_for != self._engine_name:
            raise ValueError(
                f"{type(self).__name__} drives MIMo as {self._engine_name}, but this environment was made with {made_for}: "
                "give the class to the constructor of the environment (actuation_model=...)"
            )
        super().__init__(env, actuators)
        if self.n_actuators != sum(name.startswith("act:") for name in env._core.names["actuator"]):
            self._refuse("actuators")

    @classmethod
    def _refuse(cls, name: str) -> NoReturn:
        raise AttributeError(
            f"{cls.__name__}.{name} differs from MIMo's: the engine computes this actuation model and takes no other "
            "value; write a subclass of ActuationModel that sets env.data.ctrl in action() and substep_update()"
        )

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self._fixed and "_parts_of_mimo" in self.__dict__:
            self._refuse(name)
        super().__setattr__(name, value)

    def _made(self) -> None:
        for name in sorted(self._fixed & set(vars(self))):
            if hasattr(type(self), name):  # a constant of the class
                self._refuse(name)
        super()._made()

    def get_action_space(self) -> spaces.Box:
        """Returns a new space with the bounds of an action."""
        low, high = self._core.engine.action_bounds if self._core.whole else self._own_bounds()
        self.control_input = np.zeros(low.shape)
        return spaces.Box(low=low, high=high, dtype=np.float32)

    def action(self, action: ArrayLike) -> None:
        """Takes an action, (n,), clipped to the action space, for the next step."""
        space = self.action_space
        control = np.asarray(action)
        if control.shape != space.shape:
            # one number stands for all
            control = np.broadcast_to(control, space.shape)
        self.control_input = np.minimum(np.maximum(control, space.low), space.high)  # faster than clip
        if self._core.whole:
            self._core.set_action(self.control_input)
        else:
            self._core.set_controls(self.actuators, self.control_input)

    def _own_bounds(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Returns the bounds where other bodies have actuators with MIMo's names, which the engine does not drive."""
        raise NotImplementedError(
            f"{type(self).__name__}: other bodies than MIMo have actuators named act:..., which only SpringDamperModel drives: "
            "name them otherwise, or write a subclass of ActuationModel that sets env.data.ctrl"
        )

    def substep_update(self) -> None:
        """Updates the actuators before each physics step of a step except the first."""
        if self._core.whole:
            self._core.substep()

    def observations(self) -> Array:
        """Returns the actuators' part of proprioception."""
        self._core.observe()
        return np.array(self._core.proprioception()[self._core.layout["actuation"]])

    def cost(self) -> float:
        """Returns the cost of the current controls, 0 to 1."""
        return float(self._core.parts.cost)

    def reset(self) -> None:
        """Puts the actuators to rest."""
        self.action(np.zeros_like(self.control_input))


class SpringDamperModel(EngineActuation):
    """Torque motors: an action is the torque over the gear, within the force range of each motor.

    Attributes:
        max_torque: Gear of each motor, (n,), N m.
    """

    _engine_name = "spring_damper"

    def __init__(self, env: MIMoEnv, actuators: NDArray[np.int_]) -> None:
        """Takes the environment and the ids of the actuators to drive."""
        super().__init__(env, actuators)
        self.max_torque: Array = np.asarray(env._core.blueprint.model_array("actuator_gear"))[actuators]
        self._made()

    def _own_bounds(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Returns the force ranges of the motors."""
        bounds = np.asarray(self._core.blueprint.model_array("actuator_forcerange"), np.float32)[self.actuators]
        return bounds[:, 0], bounds[:, 1]

    def cost(self) -> float:
        """Returns the cost of the current controls, 0 to 1."""
        if "max_torque" not in self._replaced and self._core.whole:
            return super().cost()
        return float(abs(self.control_input**2 * self.max_torque).sum() / (self.n_actuators * self.max_torque.sum()))

    def observations(self) -> Array:
        """Returns controls and torques (N m), (2 n,)."""
        return np.concatenate([self.control_input.flatten(), self.simulation_torque()])

    def simulation_torque(self) -> Array:
        """Returns the torque of each motor, (n,), N m."""
        engine = self._core.engine
        torque: Array = (engine.model_array("actuator_gear") * engine.state_array("ctrl"))[self.actuators]
        return torque


class PositionalModel(EngineActuation):
    """Position servos: an action is an angle for each joint, rad. Joints that a constraint holds do not follow.

    Attributes:
        actuated_joints: Ids of the joints, (n,).
        locked_joints: Ids of those that a constraint holds.
    """

    _engine_name = "positional"
    _fixed = frozenset({*EngineActuation._fixed, "actuated_joints", "locked_joints"})

    def __init__(self, env: MIMoEnv, actuators: NDArray[np.int_]) -> None:
        """Takes the environment and the ids of the actuators to drive."""
        self.actuated_joints: NDArray[np.int_] = np.asarray(env._core.blueprint.model_array("actuator_trnid"))[
            actuators
        ]
        super().__init__(env, actuators)
        self.locked_joints = self._engine_locks()
        self._made()
        if not np.array_equal(self.get_locked_joints(), self.locked_joints):
            self._refuse("get_locked_joints")

    def get_locked_joints(self) -> NDArray[np.int_]:
        """Returns the ids of the actuated joints that a constraint holds."""
        return self._engine_locks()

    def _engine_locks(self) -> NDArray[np.int_]:
        equalities = _native.model_extras(self._core.blueprint)
        holding = (equalities["eq_type"] == JOINT_EQUALITY) & (self._core.parts.eq_active0 == 1)
        held = np.concatenate([equalities["eq_obj1id"][holding], equalities["eq_obj2id"][holding]])
        return np.intersect1d(held, self.actuated_joints)

    def substep_update(self) -> None:
        """Returns to 0 rad after the first physics step of a step, as MIMo's own does."""
        self.action(np.zeros_like(self.control_input))

    def observations(self) -> Array:
        """Returns the angles of the last action, (n,), rad."""
        return self.control_input.flatten()

    def cost(self) -> float:
        """Returns 0."""
        return 0


class MuscleModel(MuscleParts, EngineActuation):
    """Two opposing muscles for each actuator: an action is their excitations, 0 to 1, first those that pull to the negative side.

    Attributes:
        tau: Time constant of activation, s.
        lmin, lmax: Shortest and longest length at which a muscle pulls, relative to its optimum.
        fvmax, fpmax: Largest factors of lengthening and of passive force.
        lce_min, lce_max: Lengths at the ends of a joint's range.
    """

    _engine_name = "muscle"
    lmin, lmax = 0.5, 1.6
    fvmax, fpmax = 1.2, 1.3
    lce_min, lce_max = 0.75, 1.05
    tau = 0.01
    _fixed = frozenset(
        {
            *EngineActuation._fixed,
            *(
                "lmin",
                "lmax",
                "fvmax",
                "fpmax",
                "lce_min",
                "lce_max",
                "tau",
                "time_step",
                "vmax",
                "fmax",
                "phi_min",
                "phi_max",
            ),
            *("mimo_actuated_joints", "mimo_actuated_qpos", "mimo_actuated_qvel", "activity", "target_activity"),
            *("joint_torque", "maximum_isometric_forces"),
        }
    )
    _uncalled = frozenset(
        {
            *("_set_max_forces", "_get_actuated_joints", "_set_muscles", "_compute_parametrization"),
            *("_collect_muscle_parameters", "_set_initial_muscle_state", "_update_muscle_state", "_update_activity"),
            *("_update_virtual_lengths", "_update_virtual_velocities", "_update_torque", "_apply_torque"),
            *("_compute_muscle_action", "fl", "fv", "fp"),
        }
    )
    _instead = "replace action or observations"

    def __init__(self, env: MIMoEnv, actuators: NDArray[np.int_]) -> None:
        """Takes the environment and the ids of the actuators to drive."""
        super().__init__(env, actuators)
        model = env._core.blueprint.model_array
        user = np.asarray(model("actuator_user"))[actuators]
        joints = np.asarray(model("actuator_trnid"))[actuators]
        self.time_step = float(env._core.blueprint.model_options["timestep"])
        self.vmax: Array = user[:, 0].copy()
        self.fmax: Array = np.concatenate([user[:, 1], user[:, 2]])
        self.mimo_actuated_joints = joints
        self.mimo_actuated_qpos = np.asarray(model("jnt_qposadr"))[joints]
        self.mimo_actuated_qvel = np.asarray(model("jnt_dofadr"))[joints]
        spring = np.asarray(model("qpos_spring"))[self.mimo_actuated_qpos]
        limits = np.asarray(model("jnt_range"))[joints]
        self.phi_min, self.phi_max = limits[:, 0] - spring, limits[:, 1] - spring
        self._spring = spring
        span = (self.lce_max - self.lce_min + 1e-10) / (self.phi_max - self.phi_min + 1e-10)
        self._moments = np.concatenate([span, -span])
        self._offsets = np.concatenate([self.lce_min - span * self.phi_min, self.lce_min + span * self.phi_max])
        self._made()

    @property
    def joint_torque(self) -> Array:
        """Returns the torques of the muscles on the joints, (n,), N m."""
        return np.asarray(self._core.engine.state_array("muscle_torque"))

    def observations(self) -> Array:
        """Returns activations and forces, (4 n,)."""
        return np.concatenate([self.muscle_activations, self.muscle_forces * self.fmax])

    @property
    def muscle_activations(self) -> Array:
        """Returns the activations of the muscles, (2 n,), 0 to 1."""
        return self.activity

    def simulation_torque(self) -> Array:
        """Returns the torque on each joint, (n,), N m."""
        return self.joint_torque

    def set_fmax(self, fmax: ArrayLike) -> None:
        """Refuses other strengths: they are in the files of the scene."""
        raise NotImplementedError("the strengths of muscles are `user` of the actuators in the MJCF: change them there")

    def set_vmax(self, vmax: ArrayLike) -> None:
        """Refuses other velocities: they are in the files of the scene."""
        raise NotImplementedError(
            "the velocities of muscles are `user` of the actuators in the MJCF: change them there"
        )


MODELS: dict[str, type[EngineActuation]] = {
    model._engine_name: model for model in (SpringDamperModel, PositionalModel, MuscleModel)
}
"""The actuation models by their names in configurations."""
