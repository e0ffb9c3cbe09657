"""What a subclass or an instance replaces of MIMo's classes is called as MIMo calls it, acts, or is refused by name."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest
from kit_scripts import Make, steps
from mimoActuation.actuation import ActuationModel, PositionalModel, SpringDamperModel
from mimoActuation.muscle import MuscleModel
from mimoEnv.babybench.base import BabyBenchEnv
from mimoEnv.babybench.selftouch import BabyBenchSelfTouchEnv
from mimoEnv.envs.mimo_env import (
    DEFAULT_PROPRIOCEPTION_PARAMS,
    DEFAULT_TOUCH_PARAMS,
    DEFAULT_VESTIBULAR_PARAMS,
    MIMoEnv,
)
from mimoProprioception.proprio import SimpleProprioception
from mimoTouch.touch import TrimeshTouch
from mimoVestibular.vestibular import SimpleVestibular
from mimoVision.vision import SimpleVision

SENSES = {
    "proprioception": (SimpleProprioception, "proprio_setup"),
    "touch": (TrimeshTouch, "touch_setup"),
    "vision": (SimpleVision, "vision_setup"),
    "vestibular": (SimpleVestibular, "vestibular_setup"),
}
BY_SCRIPTS_ALONE = {
    # MIMo's own classes do not call these in a reset or a step either
    "TrimeshTouch": {
        *("contact_tuples", "get_k_nearest_sensors", "get_total_sensor_count", "plain", "sensing_bodies"),
        *("plot_force_bodies", "plot_force_body", "plot_force_body_subtree", "plot_sensors_body"),
        *("changed", "force_vector_global", "normal_force", "nearest", "get_nearest_sensor"),
    },
    "SimpleVision": {"changed", "save_obs_to_file"},
    "SimpleProprioception": {"changed", "sensor_outputs"},
    "SimpleVestibular": {"changed"},
    "SpringDamperModel": {"changed", "cost"},
    "PositionalModel": {"changed", "cost"},
    "MuscleModel": {
        *("changed", "cost", "set_fmax", "set_vmax", "simulation_torque", "muscle_lengths", "muscle_velocities"),
        *("activity", "target_activity", "joint_torque", "collect_data_for_actuators", "fl", "fv", "fp"),
        *(f"{stem}_{k}" for stem in ("lce", "lce_dot", "force_muscles", "moment") for k in (1, 2)),
        *("lce_1_ref", "lce_2_ref", "maximum_isometric_forces"),
    },
    "Room": {
        *(
            "close",
            "data",
            "dt",
            "get_body_com",
            "get_wrapper_attr",
            "has_wrapper_attr",
            "model",
            "n_actuators",
            "np_random",
        ),
        *("np_random_seed", "render", "set_wrapper_attr", "state_vector", "swap_facial_expression", "unwrapped"),
        *("set_state",),  # by reset_model
    },
}
"""Members of each class that MIMo's own does not call in a reset or a step, or only with another touch type."""


class Room(MIMoEnv):
    """MIMo in the default scene, with all senses and no task."""

    def __init__(self, **arguments: Any) -> None:
        arguments = {
            "touch_params": DEFAULT_TOUCH_PARAMS,
            "proprio_params": DEFAULT_PROPRIOCEPTION_PARAMS,
            "vestibular_params": DEFAULT_VESTIBULAR_PARAMS,
            "vision_params": None,
            "goals_in_observation": False,
            **arguments,
        }
        super().__init__(**arguments)

    def reset_model(self) -> dict[str, Any]:
        self.set_state(self.init_qpos, self.init_qvel)
        return self._get_obs()

    def sample_goal(self) -> np.ndarray:
        return np.zeros(0)

    def get_achieved_goal(self) -> np.ndarray:
        return np.zeros(0)

    def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: Any) -> float:
        return 0.0

    def is_success(self, achieved_goal: Any, desired_goal: Any) -> bool:
        return False

    def is_failure(self, achieved_goal: Any, desired_goal: Any) -> bool:
        return False

    def is_truncated(self) -> bool:
        return False


def room(sense: type | None = None, params: dict[str, Any] | None = None, base: type = Room, **arguments: Any) -> Any:
    """Makes a room in which a class of a sense is another one."""
    own: dict[str, Any] = {}
    if sense is not None:
        setup = next(name for known, name in SENSES.values() if issubclass(sense, known))
        attribute = setup.removesuffix("_setup").replace("proprio", "proprioception")

        def make(self: Any, given: dict[str, Any]) -> None:
            setattr(self, attribute, sense(self, {**given, **(params or {})}))

        own[setup] = make
    return type("Own", (base,), own)(**arguments)


def run(env: Any, count: int = 12) -> list[dict[str, np.ndarray]]:
    env.reset(seed=1)
    draws = np.random.default_rng(0)
    low, high = env.action_space.low, env.action_space.high
    return [env.step(draws.uniform(low, high))[0] for _ in range(count)]


def members(cls: type) -> list[str]:
    """Returns the public methods and properties of a class of this package."""
    named = {name for base in cls.__mro__ if base.__module__.startswith(("babybench", __name__)) for name in vars(base)}
    kept = []
    for name in sorted(named):
        member = inspect.getattr_static(cls, name)
        if not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, property)):
            kept.append(name)
    return kept


def counting(cls: type, name: str, calls: list[str]) -> type:
    """Returns a subclass that counts the calls of a member, and does what the class does."""
    member = inspect.getattr_static(cls, name)
    if isinstance(member, property):

        def read(self: Any) -> Any:
            calls.append(name)
            return member.fget(self)

        own: Any = property(read, member.fset)
    else:

        def own(self: Any, *args: Any, **kwargs: Any) -> Any:
            calls.append(name)
            return member(self, *args, **kwargs)

    return type(f"Counting{cls.__name__}", (cls,), {name: own})


EYES = {eye: {"width": 16, "height": 16} for eye in ("eye_left", "eye_right")}


@pytest.mark.parametrize(
    ("cls", "name"),
    [(cls, name) for cls, _ in SENSES.values() for name in members(cls)],
    ids=lambda v: getattr(v, "__name__", v),
)
def test_each_member_of_a_sense_that_a_subclass_replaces_is_called(cls: type, name: str) -> None:
    calls: list[str] = []
    env = room(counting(cls, name, calls), vision_params=EYES if cls is SimpleVision else None)
    calls.clear()
    run(env)
    if name not in BY_SCRIPTS_ALONE[cls.__name__]:
        assert calls, f"{cls.__name__}.{name} is never called"


@pytest.mark.parametrize("model", [SpringDamperModel, PositionalModel, MuscleModel])
def test_each_member_of_an_actuation_model_that_a_subclass_replaces_is_called(
    model: type, make: Make, tmp_path: Path
) -> None:
    for name in members(model):
        if name in BY_SCRIPTS_ALONE[model.__name__]:
            continue
        calls: list[str] = []
        env = made_by_kit(make, counting(model, name, calls), model)
        run(env, 3)
        assert calls, f"{model.__name__}.{name} is never called"


def made_by_kit(make: Make, actuation: type, base: type) -> Any:
    """Makes the kit's environment with a class of an actuation model."""
    path = make(actuation_model=base._engine_name).unwrapped.fullpath
    return BabyBenchSelfTouchEnv(model_path=path, frame_skip=2, actuation_model=actuation, vision_params=None)


@pytest.mark.parametrize("name", members(Room))
def test_each_member_of_the_environment_that_a_subclass_replaces_is_called(name: str) -> None:
    if name in BY_SCRIPTS_ALONE["Room"]:
        pytest.skip("for scripts alone")
    calls: list[str] = []
    eyes = EYES if "vision" in name else None
    run(counting(Room, name, calls)(vision_params=eyes, frame_skip=2), 2)
    assert calls, f"{name} is never called"


HOOKS = (
    *("_get_actuators", "_get_facial_expressions", "_get_joints", "_get_obs", "_initialize_simulation", "_is_done"),
    *(
        "_get_reset_info",
        "_obs_callback",
        "_reset_simulation",
        "_set_action",
        "_set_action_space",
        "_set_initial_position",
    ),
    *("_set_observation_space", "_single_mujoco_step", "_step_callback", "_substep_callback", "_env_setup"),
)
"""MIMo's hooks: methods whose names begin with an underscore, which its manual tells to replace."""


@pytest.mark.parametrize("name", HOOKS)
def test_each_hook_that_a_subclass_replaces_is_called(name: str) -> None:
    calls: list[str] = []
    run(counting(Room, name, calls)(), 2)
    assert calls, f"{name} is never called"


@pytest.mark.parametrize(
    "name", [name for name in HOOKS if (name in vars(MIMoEnv) and "callback" in name) or name == "_get_obs"]
)
def test_a_hook_of_an_instance_is_called(name: str) -> None:
    env, calls = Room(), []
    run(env, 2)
    original = getattr(env, name)
    setattr(env, name, lambda: calls.append(1) or original())
    run(env, 2)
    assert len(calls) >= 2


@pytest.mark.parametrize("name", sorted(TrimeshTouch._uncalled))
def test_a_subclass_with_a_method_that_nothing_calls_is_refused(name: str) -> None:
    with pytest.raises(TypeError, match=name):
        type("Own", (TrimeshTouch,), {name: lambda self: None})


@pytest.mark.parametrize("name", sorted(MuscleModel._uncalled | MuscleModel._fixed))
def test_other_muscles_are_refused(name: str) -> None:
    with pytest.raises((TypeError, AttributeError), match=name):
        type("Own", (MuscleModel,), {name: 0.5})


def test_constants_of_muscles_on_an_instance_are_refused(make: Make) -> None:
    def before(self: Any, env: Any, actuators: Any) -> None:
        self.tau = 0.02
        MuscleModel.__init__(self, env, actuators)

    with pytest.raises(AttributeError, match="tau"):
        made_by_kit(make, type("Own", (MuscleModel,), {"__init__": before}), MuscleModel)
    env = made_by_kit(make, MuscleModel, MuscleModel)
    for name in ("tau", "vmax", "activity", "actuators"):
        with pytest.raises(AttributeError):
            setattr(env.actuation_model, name, 0.5)


def test_an_initialization_that_takes_another_model_is_refused() -> None:
    with pytest.raises(TypeError, match="_initialize_simulation"):
        type("Own", (Room,), {"_initialize_simulation": lambda self: None})()


# --- touch of one's own ---


class Two(TrimeshTouch):
    """Two numbers for each sensor, spread as a bell."""

    VALID_TOUCH_TYPES: ClassVar[dict[str, int]] = {**TrimeshTouch.VALID_TOUCH_TYPES, "press_and_speed": 2}
    VALID_RESPONSE_FUNCTIONS: ClassVar[list[str]] = [*TrimeshTouch.VALID_RESPONSE_FUNCTIONS, "bell"]

    def __init__(self, env: Any, touch_params: dict[str, Any]) -> None:
        self.last: dict[int, float] = {}
        super().__init__(env, touch_params)

    def press_and_speed(self, contact_id: int, body_id: int) -> np.ndarray:
        press = float(np.linalg.norm(self.get_raw_force(contact_id, body_id)))
        change = press - self.last.get(body_id, 0.0)
        self.last[body_id] = press
        return np.array([press, change])

    def bell(self, contact_id: int, body_id: int, force: np.ndarray) -> None:
        width = self.sensor_scales[body_id]
        point = self.get_contact_position_relative(contact_id, body_id)
        ids, distance = self.get_sensors_within_distance(point, body_id, 3 * width)
        weight = np.exp(-0.5 * (np.asarray(distance) / width) ** 2)
        self.sensor_outputs[body_id][ids] += np.outer(weight / weight.sum(), force)


def test_a_new_touch_type_and_a_new_response_are_called() -> None:
    env = room(Two, {"touch_function": "press_and_speed", "response_function": "bell"})
    sensors = env.touch.get_total_sensor_count()
    assert env.observation_space["touch"].shape == (2 * sensors,)
    felt, draws = 0.0, np.random.default_rng(0)
    env.reset(seed=1)
    for _ in range(40):
        observation = env.step(draws.uniform(-1, 1, env.action_space.shape))[0]
        outputs = env.touch.sensor_outputs
        assert observation["touch"].shape == (2 * sensors,)
        assert all(outputs[body].shape == (len(env.touch.sensor_positions[body]), 2) for body in outputs)
        pressed = sum(float(np.linalg.norm(env.touch.get_raw_force(c, b))) for c, b, _ in env.touch.contact_tuples)
        assert observation["touch"].reshape(-1, 2)[:, 0].sum() == pytest.approx(pressed, rel=1e-5)
        felt += pressed
    assert felt > 10


def test_a_new_type_given_to_the_environment_reaches_the_sense() -> None:
    params = {**DEFAULT_TOUCH_PARAMS, "touch_function": "press_and_speed", "response_function": "bell"}
    env = room(Two, touch_params=params)
    assert env.touch.touch_type == "press_and_speed"
    assert run(env, 3)[-1]["touch"].shape == (2 * env.touch.get_total_sensor_count(),)


@pytest.mark.parametrize("function", ["force_vector", "force_vector_global", "normal_force"])
@pytest.mark.parametrize("response", ["nearest", "spread_linear"])
def test_python_feels_what_the_engine_feels(function: str, response: str) -> None:
    params = {**DEFAULT_TOUCH_PARAMS, "touch_function": function, "response_function": response}
    plain, own = room(touch_params=params), room(touch_params=params)
    own.touch.touch_function = own.touch.touch_function  # a script's own from now on
    assert own.touch._plain is False
    for a, b in zip(run(plain, 20), run(own, 20)):
        np.testing.assert_allclose(a["touch"], b["touch"], rtol=1e-5, atol=1e-6)


def test_functions_of_an_instance_are_called_from_then_on() -> None:
    env = room()
    run(env, 3)
    before = env.touch.force_vector
    env.touch.touch_function = lambda contact, body: 2 * before(contact, body)
    doubled = [observation["touch"] for observation in run(env)]
    plain = [observation["touch"] for observation in run(room())]
    assert np.abs(plain).sum() > 1
    np.testing.assert_allclose(doubled, 2 * np.array(plain), rtol=1e-5, atol=1e-6)
    env.touch.has_sensors = lambda body: False
    assert not np.any([observation["touch"] for observation in run(env)])
    for sense, hook in (("vestibular", "get_vestibular_obs"), ("proprioception", "get_proprioception_obs")):
        setattr(getattr(env, sense), hook, lambda: np.full(6, 7.0))
    observation = run(env, 1)[0]
    assert (observation["vestibular"] == 7).all()
    assert (observation["observation"] == 7).all()


def test_another_sense_of_an_environment_is_asked() -> None:
    env = room()
    env.touch = Two(env, {**DEFAULT_TOUCH_PARAMS, "touch_function": "press_and_speed"})
    assert run(env, 2)[-1]["touch"].shape == (2 * env.touch.get_total_sensor_count(),)


def test_another_touch_type_of_the_sense_than_of_the_environment_is_felt() -> None:
    env = room(TrimeshTouch, {"touch_function": "force_vector_global"})
    wanted = room(touch_params={**DEFAULT_TOUCH_PARAMS, "touch_function": "force_vector_global"})
    for a, b in zip(run(env), run(wanted)):
        np.testing.assert_allclose(a["touch"], b["touch"], rtol=1e-5, atol=1e-6)


def test_other_distances_of_the_sense_than_of_the_environment_are_refused() -> None:
    with pytest.raises(ValueError, match=r"left_hand are 0.007 m apart .* not 0.004"):
        room(TrimeshTouch, {"scales": {"left_hand": 0.004}})


# --- attributes ---

INFORMATION = {
    # MIMo reads them when a sense is made, or for plots
    "TrimeshTouch": {"env", "touch_type", "response_type", "sensor_positions", "active_vertices", "plotting_limits"},
    "SimpleProprioception": {
        *("env", "proprio_parameters", "sensors", "sensor_ids", "joint_names", "joint_ids", "sensor_names"),
    },
    "SimpleVestibular": {"env", "vestibular_parameters", "sensors", "sensor_ids"},
    "SimpleVision": {"env"},
}
"""Attributes that MIMo's own senses do not read when they sense."""

ACT: dict[str, Callable[[Any], Any]] = {
    "touch_function": lambda t: lambda contact, body: 3 * t.force_vector(contact, body),
    "response_function": lambda t: t.nearest,
    "touch_size": lambda t: 3,
    "meshes": lambda t: dict(list(t.meshes.items())[:3]),
    "sensor_scales": lambda t: {body: 2 * scale for body, scale in t.sensor_scales.items()},
    "output_components": lambda p: ["velocity"],
    "joint_qpos": lambda p: p.joint_qpos[::-1],
    "joint_qvel": lambda p: p.joint_qvel[::-1],
    "joint_limits": lambda p: p.joint_limits * 0.1,
    "sensor_addrs": lambda s: s.sensor_addrs[:1],
    "limit_thresh": lambda p: 0.7,
    "camera_parameters": lambda v: {"eye_left": {"width": 16, "height": 16}, "corner": {"width": 20, "height": 10}},
}
"""Another value of each attribute that acts."""


@pytest.mark.parametrize("sense", list(SENSES))
def test_each_attribute_of_a_sense_that_a_script_assigns_acts(sense: str) -> None:
    eyes = EYES if sense == "vision" else None
    cls = SENSES[sense][0]
    plain = room(vision_params=eyes)
    wanted = run(plain)
    attributes = {name for name in vars(getattr(plain, sense)) if not name.startswith("_")}
    assert attributes == {*INFORMATION[cls.__name__], *(attributes & set(ACT))}, "say what a new attribute does"
    for name in sorted(attributes & set(ACT)):
        env = room(vision_params=eyes)
        part = getattr(env, sense)
        setattr(part, name, ACT[name](part))
        if name == "meshes":
            part.has_sensors = lambda body, part=part: body in part.meshes
        found = run(env)
        same = all(
            a.keys() == b.keys() and all(np.array_equal(a[key], b[key]) for key in a) for a, b in zip(wanted, found)
        )
        assert not same or name == "touch_size", f"{cls.__name__}.{name} does not act"


def test_a_distance_between_sensors_that_a_script_writes_acts() -> None:
    env, plain = room(), room()
    for body in list(env.touch.sensor_scales):
        env.touch.sensor_scales[body] *= 3
    assert any(not np.array_equal(a["touch"], b["touch"]) for a, b in zip(run(env), run(plain)))


def test_proprioception_in_python_is_the_engine_s() -> None:
    own = {**DEFAULT_PROPRIOCEPTION_PARAMS, "threshold": 0.7}
    env, plain = room(proprio_params=own), room()
    env.proprioception.limit_thresh = 0.035
    for a, b in zip(run(env), run(plain)):
        np.testing.assert_allclose(a["observation"], b["observation"], rtol=1e-6, atol=1e-9)


def test_pictures_of_other_sizes_are_those_of_the_eyes() -> None:
    env, plain = room(vision_params=EYES), room(vision_params=EYES)
    env.vision.camera_parameters = {"eye_left": {"width": 16, "height": 16}}
    for a, b in zip(run(env, 3), run(plain, 3)):
        assert np.array_equal(a["eye_left"], b["eye_left"])
        assert "eye_right" not in a


def test_an_actuation_model_that_does_not_suit_the_environment_is_refused(make: Make) -> None:
    env = made_by_kit(make, SpringDamperModel, SpringDamperModel)
    with pytest.raises(ValueError, match="spring_damper"):
        env.actuation_model = MuscleModel(env, env.mimo_actuators)
    with pytest.raises(AttributeError, match="actuators"):
        SpringDamperModel(env, env.mimo_actuators[:5])


def test_torques_follow_the_gears_of_the_model(make: Make) -> None:
    env = made_by_kit(make, SpringDamperModel, SpringDamperModel)
    env.reset()
    steps(env, 2)
    before = env.actuation_model.simulation_torque()
    env.model.actuator_gear[:, 0] *= 2
    steps(env, 1)
    ctrl = env._core.engine.state_array("ctrl")
    assert np.array_equal(env.actuation_model.simulation_torque(), env.model.actuator_gear[:, 0] * ctrl)
    assert before.shape == ctrl.shape


def test_the_interfaces_stay() -> None:
    assert issubclass(BabyBenchEnv, MIMoEnv)
    assert issubclass(SpringDamperModel, ActuationModel)
