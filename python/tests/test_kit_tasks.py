"""MIMo's own environments: by their ids, with his constructors' arguments, as base classes, and on scenes of one's own."""

from __future__ import annotations

import copy
import importlib
import json
import pickle
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from mimoActuation.actuation import SpringDamperModel
from mimoActuation.muscle import MuscleModel
from mimoEnv.envs.dummy import MIMoDummyEnv, MIMoV2DummyEnv
from mimoEnv.envs.mimo_env import DEFAULT_TOUCH_PARAMS, DEFAULT_TOUCH_PARAMS_V2, SCENE_DIRECTORY, MIMoEnv
from mimoEnv.envs.reach import MIMoReachEnv
from mimoEnv.envs.selfbody import SITTING_POSITION, TOUCH_PARAMS, MIMoSelfBodyEnv
from mimoTouch.touch import TrimeshTouch

import babybench
import mujoco

NAMES: dict[str, Any] = json.loads((Path(__file__).parent / "kit" / "mimo_names.json").read_text(encoding="utf-8"))
ATTRIBUTES = {
    name: names["attributes"]
    for module in NAMES["modules"].values()
    for name, names in module["classes"].items()
    if name.endswith("Env")
}
BLIND: dict[str, Any] = {"vision_params": None}
SMALL = {
    "MIMoBench-v0": BLIND,
    "MIMoBenchV2-v0": BLIND,
    "MIMoShowroom-v0": {**BLIND, "render_mode": None},
    "MIMoMuscle-v0": BLIND,
}
SIZES = {
    # nq, motors or muscles, proprioception
    "MIMoBench-v0": (68, 44),
    "MIMoBenchV2-v0": (112, 88),
    "MIMoShowroom-v0": (196, 88),
    "MIMoReach-v0": (61, 8),
    "MIMoStandup-v0": (54, 27),
    "MIMoSelfBody-v0": (54, 8),
    "MIMoCatch-v0": (105, 40),
    "MIMoMuscle-v0": (112, 176),
    "MIMoMuscleStaticTest-v0": (54, 88),
    "MIMoVelocityMuscleTest-v0": (54, 88),
    "MIMoMuscleStaticTestV2-v0": (98, 176),
    "MIMoVelocityMuscleTestV2-v0": (98, 176),
    "MIMoComplianceTest-v0": (105, 88),
    "MIMoComplianceMuscleTest-v0": (105, 176),
}
"""Positions of each scene, and numbers of an action: those of MIMo's own."""


def made(name: str, **arguments: Any) -> Any:
    env = gym.make(name, **{**SMALL.get(name, {}), **arguments})
    env.action_space.seed(1)
    return env


@pytest.mark.parametrize("name", SIZES)
def test_an_environment_is_made_reset_and_stepped(name: str) -> None:
    env = made(name)
    inner = env.unwrapped
    assert (inner.model.nq, env.action_space.shape[0]) == SIZES[name]
    observation, _ = env.reset(seed=3)
    assert env.observation_space.contains(observation)
    for _ in range(3):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert np.isfinite(reward)
    assert (terminated, truncated) == (False, False)
    assert all(np.isfinite(value).all() for value in observation.values())
    assert {"is_success", "is_failure"} <= set(info)
    for cls in type(inner).__mro__:
        missing = [name for name in ATTRIBUTES.get(cls.__name__, ()) if not hasattr(inner, name)]
        assert missing == [], cls.__name__


def test_a_copy_continues() -> None:
    env = made("MIMoReach-v0").unwrapped
    env.reset(seed=3)
    for other in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
        action = np.full(env.action_space.shape, 0.3)
        again = copy.deepcopy(env)
        assert np.array_equal(other.step(action)[0]["observation"], again.step(action)[0]["observation"])


def test_tasks_take_the_arguments_of_mimos_constructors() -> None:
    env = made(
        "MIMoReach-v0",
        actuation_model=SpringDamperModel,
        touch_params=TOUCH_PARAMS,
        done_active=False,
        width=64,
        height=48,
    )
    observation, _ = env.reset(seed=0)
    assert len(SITTING_POSITION) == 39
    assert sorted(observation) == ["observation", "touch"]
    assert env.unwrapped.done_active is False
    assert made("MIMoReach-v0", actuation_model=MuscleModel).action_space.shape == (16,)
    assert made("MIMoSelfBody-v0", done_active=False, frame_skip=2).unwrapped.dt == pytest.approx(0.01)
    with pytest.raises(TypeError, match="unknown_argument"):
        made("MIMoReach-v0", unknown_argument=1)


def test_the_reward_of_reaching_is_the_distance_until_the_ball_moves() -> None:
    env = made("MIMoReach-v0").unwrapped
    env.reset(seed=2)
    _, reward, terminated, _, info = env.step(np.zeros(env.action_space.shape))
    fingers, ball = (env.data.body(name).xpos for name in ("right_fingers", "target"))
    assert reward == pytest.approx(-np.linalg.norm(fingers - ball))
    assert not info["is_success"]
    env.data.qpos[-7] += 0.2
    mujoco.mj_forward(env.model, env.data)
    assert env.is_success(None, None)


def test_a_subclass_replaces_methods_of_a_task() -> None:
    calls: list[str] = []

    class Mine(MIMoReachEnv):
        def __init__(self, **arguments: Any) -> None:
            super().__init__(touch_params=TOUCH_PARAMS, **arguments)

        def touch_setup(self, touch_params: dict[str, Any]) -> None:
            self.touch = Pressure(self, {**touch_params, "touch_function": "pressure"})

        def compute_reward(self, achieved_goal: Any, desired_goal: Any, info: dict[str, Any]) -> float:
            calls.append("reward")
            return 7.0

        def reset_model(self) -> Any:
            calls.append("reset")
            return super().reset_model()

        def _step_callback(self) -> None:
            calls.append("step")

    env = Mine()
    env.reset(seed=0)
    observation, reward, *_ = env.step(env.action_space.sample())
    assert reward == 7.0
    assert set(calls) == {"reward", "reset", "step"}
    assert env.touch.touch_size == 1
    assert observation["touch"].shape == (env.touch.get_total_sensor_count(),)


class Pressure(TrimeshTouch):
    """One number for each sensor."""

    VALID_TOUCH_TYPES = {**TrimeshTouch.VALID_TOUCH_TYPES, "pressure": 1}  # noqa: RUF012

    def pressure(self, contact_id: int, body_id: int) -> Any:
        return np.array([np.linalg.norm(self.get_raw_force(contact_id, body_id))])


def test_touching_oneself_is_felt_on_as_many_sensors_as_in_mimo() -> None:
    class Task(MIMoSelfBodyEnv):
        def touch_setup(self, touch_params: dict[str, Any]) -> None:
            self.touch = Pressure(self, {**touch_params, "touch_function": "pressure"})

    env = Task()
    observation, _ = env.reset(seed=0)
    assert observation["touch"].shape == (612,)
    assert observation["desired_goal"].sum() == 1


def test_touch_parameters_of_ones_own() -> None:
    scales = DEFAULT_TOUCH_PARAMS["scales"]
    for own in (
        {"right_hand": scales["right_hand"]},
        {**scales, "left_hand": 0.004, "right_hand": 0.004},
        {"left_hand": 0.01, "hip": 0.05},
    ):
        env = MIMoDummyEnv(touch_params={**DEFAULT_TOUCH_PARAMS, "scales": own}, vision_params=None)
        observation, _ = env.reset(seed=0)
        assert {env.model.body(body).name: scale for body, scale in env.touch.sensor_scales.items()} == own
        assert observation["touch"].shape == (3 * env.touch.get_total_sensor_count(),)
    assert len(MIMoV2DummyEnv(vision_params=None).touch.sensor_scales) == len(DEFAULT_TOUCH_PARAMS_V2["scales"])


def test_cameras_of_ones_own() -> None:
    env = MIMoDummyEnv(touch_params=None, vision_params={"eye_left": {"width": 24, "height": 16}})
    observation, _ = env.reset(seed=0)
    assert observation["eye_left"].shape == (16, 24, 3)
    assert "eye_right" not in observation


ROOM = """<mujoco model="nursery">
  <compiler angle="degree"/>
  <option timestep="0.0025"/>
  <include file="{folder}/mimo/MIMo_meta.xml"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 .1"/>
    <body name="mimo_location" pos="0 0 .12" euler="0 -90 0"><freejoint/><include file="{folder}/mimo/MIMo_model.xml"/></body>
    <body name="toy" pos=".1 0 .5"><freejoint name="toy"/><geom name="toy" size=".03" mass=".1"/></body>
    <body name="hand" mocap="true" pos="1 1 1"><geom size=".02" contype="0" conaffinity="0"/></body>
  </worldbody>
</mujoco>"""


class Lying(MIMoDummyEnv):
    """Settles in a reset by ``mj_step``."""

    def reset_model(self) -> Any:
        self.set_state(self.init_qpos, self.init_qvel)
        self._set_action(np.zeros(self.action_space.shape))
        mujoco.mj_step(self.model, self.data, nstep=40)
        mujoco.mj_forward(self.model, self.data)
        return self._get_obs()


def test_any_scene_with_mimo_is_served(tmp_path: Path) -> None:
    path = tmp_path / "nursery.xml"
    path.write_text(ROOM.format(folder=SCENE_DIRECTORY))
    env = Lying(path, vision_params=None)
    observation, _ = env.reset(seed=0)
    assert env.model.opt.timestep == env.dt / 2 == 0.0025
    assert env.data.time == pytest.approx(40 * 0.0025)
    assert env.data.body("toy").xpos[2] < 0.5
    assert env.observation_space.contains(observation)
    env.data.mocap_pos[0] = 0.2, 0.3, 0.4
    env.data.xfrc_applied[env.model.body("toy").id, 2] = 0.1 * 9.81
    before = env.data.qvel[-6:].copy()
    env.step(np.zeros(env.action_space.shape))
    assert np.allclose(env.data.body("hand").xpos, [0.2, 0.3, 0.4])
    assert np.allclose(env.data.qvel[-6:], before, atol=1e-9)


def test_mimo_has_an_age() -> None:
    def height(age: float | None) -> float:
        return float(MIMoDummyEnv(touch_params=None, **BLIND, age=age).model.body("head").subtreemass[0])

    assert height(1.0) < height(12.0) < height(24.0)


def test_a_base_class_asks_for_what_subclasses_say() -> None:
    with pytest.raises(NotImplementedError):
        MIMoEnv(model_path=str(Path(SCENE_DIRECTORY) / "benchmark_scene.xml"))


@pytest.mark.parametrize("name", ["catch", "reach", "selfbody", "standup", "dummy", "muscle_test"])
def test_modules_have_the_names_of_the_base_module(name: str) -> None:
    module = importlib.import_module(f"mimoEnv.envs.{name}")
    assert module.MIMoEnv is MIMoEnv
    with pytest.raises(AttributeError, match="no attribute 'Other'"):
        module.Other  # noqa: B018


def test_mimo_grows_in_a_copy_of_a_scene(tmp_path: Path) -> None:
    from mimoGrowth.growth import adjust_mimo_to_age, delete_growth_scene, get_version

    scene = str(Path(SCENE_DIRECTORY) / "benchmark_scene.xml")
    path = adjust_mimo_to_age(6, scene, create_log=False)
    try:
        copy_of_scene, grown = (
            MIMoDummyEnv(touch_params=None, **BLIND, **given) for given in ({"model_path": path}, {"age": 6})
        )
        for name in (
            "body_mass",
            "body_inertia",
            "body_pos",
            "geom_size",
            "geom_pos",
            "jnt_pos",
            "site_pos",
            "actuator_gear",
        ):
            assert np.allclose(
                getattr(copy_of_scene.model, name), getattr(grown.model, name), rtol=1e-12, atol=1e-12
            ), name
    finally:
        delete_growth_scene(path)
    assert not Path(path).exists()
    assert (get_version(scene), get_version(Path(SCENE_DIRECTORY) / "catch_scene.xml")) == ("v1", "v2")
    with pytest.raises(ValueError, match="age"):
        adjust_mimo_to_age(99, scene)
    with pytest.raises(ValueError, match="not deleted"):
        delete_growth_scene(tmp_path / "own.xml")


BESIDE = """<mujoco>
  <option timestep="0.005" gravity="0 0 0"/>
  <include file="{folder}/mimo/MIMo_meta.xml"/>
  <worldbody>
    <body name="mimo_location" pos="0 0 1"><freejoint/><include file="{folder}/mimo/MIMo_model.xml"/></body>
    <body name="mother" pos="3 0 1">
      <joint name="robot:mother" axis="0 1 0" range="-90 90"/><geom type="capsule" fromto="0 0 0 0 0 .5" size=".05"/>
    </body>
  </worldbody>
  <actuator><motor name="act:mother" joint="robot:mother" gear="2" ctrlrange="-1 1" forcerange="-1 1"/></actuator>
</mujoco>"""


def test_others_with_mimos_names_are_driven_and_sensed(tmp_path: Path) -> None:
    path = tmp_path / "mother.xml"
    path.write_text(BESIDE.format(folder=SCENE_DIRECTORY))
    env, alone = MIMoDummyEnv(path, **BLIND), made("MIMoBench-v0").unwrapped
    observation, _ = env.reset(seed=0)
    assert env.action_space.shape == (45,)
    # an angle, a velocity, a limit, a control and a torque more
    assert observation["observation"].shape == (len(alone.reset()[0]["observation"]) + 5,)
    action = np.zeros(45)
    action[-1] = 1.0
    for _ in range(4):
        observation, *_ = env.step(action)
    angle = env.data.joint("robot:mother").qpos[0]
    assert angle > 0.004
    assert env.proprioception.sensor_outputs["qpos"][-1] == angle
    assert np.all(env.data.ctrl == action)
    with pytest.raises(NotImplementedError, match="only SpringDamperModel drives"):
        MIMoDummyEnv(path, actuation_model=MuscleModel, **BLIND)


@pytest.mark.parametrize(("name", "task"), [("Reach", "reach"), ("Standup", "standup"), ("SelfBody", "selfbody")])
def test_a_task_is_that_of_the_engine_step_by_step(name: str, task: str) -> None:
    engine, env = babybench.make(task, compat="reference"), made(f"MIMo{name}-v0").unwrapped
    start, _ = engine.reset(seed=5)
    env.reset(seed=5)
    if name == "SelfBody":
        env.target_geom = int(start["desired_goal"].argmax())
        env.target_body = env.model.body(int(env.model.geom_bodyid[env.target_geom])).name
    draws, known = np.random.default_rng(0), engine.unwrapped
    env.set_state(known.array("qpos"), known.array("qvel"))
    if name == "Reach":
        env.target_init_pos = np.array(env.data.body("target").xpos)
    for _ in range(20):
        env.set_state(known.array("qpos"), known.array("qvel"))
        action = draws.uniform(env.action_space.low, env.action_space.high).astype(np.float32)
        expected, found = engine.step(action), env.step(action)
        assert np.allclose(found[0]["observation"], expected[0]["observation"], rtol=1e-3, atol=1e-3)
        assert np.allclose(env.data.qpos, known.array("qpos"), atol=1e-6)
        assert found[1] == pytest.approx(expected[1], abs=1e-9)


def test_senses_and_actuation_have_mimos_attributes() -> None:
    eyes = {eye: {"width": 8, "height": 8} for eye in ("eye_left", "eye_right")}
    env, muscles = MIMoDummyEnv(vision_params=eyes), made("MIMoMuscle-v0", touch_params=None).unwrapped
    env.reset()
    muscles.reset()
    known = {
        name: names
        for module in NAMES["modules"].values()
        for name, names in module["classes"].items()
        if name[:4] != "MIMo"
    }
    for part in (
        env.touch,
        env.vision,
        env.vestibular,
        env.proprioception,
        env.actuation_model,
        muscles.actuation_model,
    ):
        names = known[type(part).__name__]
        wanted = [name for name in [*names["attributes"], *names["methods"], *names["properties"]] if name[0] != "_"]
        uncalled = getattr(type(part), "_uncalled", ())
        assert [name for name in wanted if not hasattr(part, name) and name not in uncalled] == [], type(part).__name__


def test_scenes_without_a_camera_are_seen_from_a_free_one() -> None:
    near, far = (
        made("MIMoReach-v0", render_mode="rgb_array", width=48, height=32, default_camera_config={"distance": distance})
        for distance in (1.0, 4.0)
    )
    pictures = []
    for env in (near, far):
        env.reset(seed=0)
        pictures.append(env.unwrapped.render())
    assert pictures[0].shape == (32, 48, 3)
    assert not np.array_equal(*pictures)


def test_a_window_shows_the_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = made("MIMoReach-v0", render_mode="human", width=64, height=48)
    env.reset(seed=0)
    for _ in range(2):
        env.step(env.action_space.sample())
        assert env.render() is None
    env.close()
