"""The interface of the starter kit, without the kit: what scripts hold, write to, subclass, copy, and what is refused."""

from __future__ import annotations

import copy
import pickle
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium as gym
import mimoEnv.utils as env_utils
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from mimoActuation.actuation import SpringDamperModel
from mimoEnv.babybench import BabyBenchEnv, BabyBenchSelfTouchEnv
from mimoEnv.envs.mimo_env import MIMoEnv
from mimoTouch.touch import TrimeshTouch

import babybench.utils as bb_utils
import mimoEnv
import mujoco
from babybench.build_xml import build
from babybench.eval import EVALS

assert mimoEnv is not None

CONFIG: dict[str, Any] = {
    "behavior": "self_touch",
    "scene": "crib",
    "max_episode_steps": 8,
    "frame_skip": 1,
    "render_size": 48,
    "save_logs_every": 4,
    "vestibular_active": True,
    "vision_active": False,
    "vision_resolution": 16,
    "touch_active": True,
    "touch_scale": 2.0,
    "touch_function": "force_vector",
    "touch_response": "spread_linear",
    "actuation_model": "spring_damper",
    **{
        f"{what}_{part}": True
        for what in ("touch", "act")
        for part in ("hands", "fingers", "arms", "feet", "legs", "body", "head")
    },
    "touch_eyes": False,
    "act_eyes": False,
    **{f"lock_{part}": False for part in ("hands", "fingers", "arms", "feet", "legs", "body", "head", "eyes")},
}

Make = Callable[..., Any]


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Makes an environment as scripts do, with changes of the configuration."""

    def made(training: bool = True, **changes: Any) -> Any:
        config = {**CONFIG, "save_dir": str(tmp_path / "run"), **changes}
        env = bb_utils.make_env(config, training=training)
        env.action_space.seed(5)
        return env

    return made


def steps(env: Any, count: int) -> list[Any]:
    """Takes random actions and returns what each step returned."""
    return [env.step(env.action_space.sample()) for _ in range(count)]


# --- what scripts hold ---


def test_a_held_state_shows_the_present_and_changes_nothing(make: Make) -> None:
    held, free = make(), make()
    for env in (held, free):
        env.reset()
    data = held.unwrapped.data
    for k, (a, b) in enumerate(zip(steps(held, 8), steps(free, 8))):
        assert all(np.array_equal(a[0][key], b[0][key]) for key in a[0]), k
    core = held.unwrapped._core
    assert np.array_equal(data.qpos, core.engine.state_array("qpos"))
    np.testing.assert_allclose(data.xpos, core.engine.state_array("xpos"), rtol=0, atol=1e-12)
    np.testing.assert_allclose(data.sensordata, core.engine.state_array("sensordata"), rtol=0, atol=1e-9)
    assert data.time == pytest.approx(core.engine.time)


def test_a_state_that_is_first_asked_for_within_an_episode_has_the_contacts_of_that_instant(make: Make) -> None:
    env = make()
    env.reset()
    steps(env, 5)
    contacts = env.unwrapped._core.engine.contacts()
    data = env.unwrapped.data
    assert data.ncon == len(data.contact.geom1) == len(contacts["geom1"]) > 0
    assert np.array_equal(data.contact.geom1, contacts["geom1"])
    np.testing.assert_allclose(data.contact.pos, contacts["pos"], rtol=0, atol=1e-12)
    assert data.contact[0].geom2 == contacts["geom2"][0]
    force = np.zeros(6)
    mujoco.mj_contactForce(env.unwrapped.model, data, 0, force)
    np.testing.assert_allclose(force[:3], contacts["force"][0][:3], rtol=1e-6)


def test_an_array_alone_keeps_the_state_up_to_date(make: Make) -> None:
    env = make()
    env.reset()
    qpos = env.unwrapped.data.qpos
    before = qpos.copy()
    steps(env, 2)
    assert not np.array_equal(qpos, before)
    assert np.array_equal(qpos, env.unwrapped._core.engine.state_array("qpos"))


def test_nobody_pays_for_a_state_that_nobody_holds(make: Make) -> None:
    env = make()
    env.reset()
    assert env.unwrapped.data.ncon >= 0
    live = env.unwrapped._core._live
    refreshed = []
    live.refresh = lambda: refreshed.append(1)
    steps(env, 3)
    assert not refreshed
    held = env.unwrapped._core._live.data
    steps(env, 1)
    assert refreshed
    assert held is not None


def test_what_a_script_writes_is_where_the_engine_goes_on(make: Make) -> None:
    env = make()
    env.reset()
    u = env.unwrapped
    elbow = int(u.model.joint("robot:right_elbow").qposadr[0])
    u.data.qpos[elbow] = -1.0
    mujoco.mj_forward(u.model, u.data)
    observation = u._get_obs()
    at = u.proprioception.joint_names.index("robot:right_elbow")
    assert u.proprioception.sensor_outputs["qpos"][at] == -1.0
    assert observation["observation"].shape == env.observation_space["observation"].shape
    env_utils.set_joint_qpos(u.model, u.data, "robot:right_elbow", -1.5)
    env.step(np.zeros(env.action_space.shape, np.float32))
    assert abs(u.data.qpos[elbow] + 1.5) < 0.1
    u.set_state(u.init_qpos, u.init_qvel)
    assert np.array_equal(u.data.qpos, u.init_qpos)


def test_forces_from_outside_act_and_others_are_refused(make: Make) -> None:
    env = make()
    env.reset()
    u = env.unwrapped
    arm = int(u.model.joint("robot:right_shoulder_horizontal").dofadr[0])
    u.data.qfrc_applied[arm] = 2.0
    assert u._core.engine.state_array("qfrc_applied")[arm] == 0.0
    before = u.data.qvel[arm]
    steps(env, 1)
    assert u._core.engine.state_array("qfrc_applied")[arm] == 2.0
    assert u.data.qvel[arm] > before


def test_writes_to_the_model_are_refused(make: Make) -> None:
    env = make()
    env.reset()
    model = env.unwrapped.model

    def write_mass() -> None:
        model.body_mass[3] = 0.1
        env.reset()

    def write_timestep() -> None:
        model.opt.timestep = 0.001
        env.reset()

    for write in (write_mass, write_timestep):
        with pytest.raises((ValueError, AttributeError), match=r"read-only|cannot be"):
            write()


def test_joints_are_locked_through_the_model(make: Make) -> None:
    env = make()
    env.reset()
    u = env.unwrapped
    env_utils.lock_joint(u.model, "robot:right_elbow", -1.0)
    env.reset()
    for _ in range(60):
        u.step(np.zeros(env.action_space.shape, np.float32))
    elbow = int(u.model.joint("robot:right_elbow").qposadr[0])
    assert u.data.qpos[elbow] == pytest.approx(-1.0, abs=0.02)
    env_utils.unlock_joint(u.model, "robot:right_elbow")
    env.reset()
    for _ in range(60):
        u.step(np.zeros(env.action_space.shape, np.float32))
    assert abs(u.data.qpos[elbow] + 1.0) > 0.05


def test_elements_are_found_by_name_and_by_number(make: Make) -> None:
    u = make().unwrapped
    model, data = u.model, u.data
    hand = model.body("right_hand").id
    assert mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, hand) == "right_hand"
    assert mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "right_hand") == hand
    assert np.array_equal(data.body("right_hand").xpos, data.xpos[hand])
    assert data.body(hand).xmat.shape == (9,)
    with pytest.raises(KeyError, match="Invalid name"):
        model.body("third_hand")
    point = env_utils.body_pos_to_world(data, np.array([[0.0, 0.0, 0.1]]), hand)
    back = env_utils.world_pos_to_body(data, point, hand)
    np.testing.assert_allclose(back, [[0.0, 0.0, 0.1]], atol=1e-12)
    assert hand in env_utils.get_child_bodies(model, model.body("hip").id)


# --- logs ---


def test_logs_lists_and_counters_are_the_kits(make: Make, tmp_path: Path) -> None:
    env = make()
    env.reset()
    infos = [step[4] for step in steps(env, 4)]
    assert infos[0]["right_hand_touches"] is infos[3]["right_hand_touches"]
    assert [info["steps"] for info in infos] == [0, 1, 2, 3]
    env.reset()
    steps(env, 3)
    env.reset()
    with (tmp_path / "run" / "logs" / "training.pkl").open("rb") as f:
        logs = pickle.load(f)
    # the third episode has 3 steps: not a multiple of 4
    assert [record["steps"] for record in logs] == [0, 4]
    assert [record["steps"] for record in env.unwrapped._info_hist] == [0, 4, 3]
    assert env.unwrapped._info_hist[1]["right_hand_touches"] is infos[0]["right_hand_touches"]


def test_evaluation_goes_on_counting_and_logs_nothing(make: Make, tmp_path: Path) -> None:
    make()
    env = make(training=False)
    env.reset()
    first = steps(env, 1)[0][4]
    env.reset()
    assert steps(env, 1)[0][4]["left_hand_touches"] is first["left_hand_touches"]
    assert not env.unwrapped._info_hist
    with pytest.raises(AssertionError, match="was this configuration trained"):
        make(training=False, save_dir=str(tmp_path / "nowhere"))


def test_scores(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "logs").mkdir()
    records = [
        {"right_hand_touches": [1, 2, 3], "left_hand_touches": [9]},
        {"right_hand_touches": [5, 6], "left_hand_touches": [7]},
        {"right_hand_touches": [6], "left_hand_touches": []},
    ]
    (tmp_path / "logs" / "training.pkl").write_bytes(pickle.dumps(records))
    EVALS["self_touch"](env=None, duration=1, render=False, save_dir=str(tmp_path)).eval_logs()
    assert capsys.readouterr().out == f"Preliminary training score: {3 / 68}\n"
    pairs = ("right_eye_right_hand", "left_eye_right_hand", "right_eye_left_hand", "left_eye_left_hand")
    regards = [{**dict.fromkeys(pairs, n), "steps": s} for n, s in ((100, 100), (3, 10), (1, 30))]
    (tmp_path / "logs" / "training.pkl").write_bytes(pickle.dumps(regards))
    EVALS["hand_regard"](env=None, duration=1, render=False, save_dir=str(tmp_path)).eval_logs()
    assert capsys.readouterr().out == "Preliminary training score: 0.1\n"
    EVALS["none"](env=None, duration=1, render=False, save_dir=str(tmp_path / "no")).eval_logs()
    assert "not found" in capsys.readouterr().out


# --- configurations and scenes ---


def test_unknown_keys_have_no_effect_and_are_named(make: Make) -> None:
    with pytest.warns(UserWarning, match="my_bonus"):
        env = make(my_bonus=3)
    assert "my_bonus" not in env.unwrapped._core.config


def test_the_default_environment_is_the_kits() -> None:
    env = gym.make("BabyBench")
    env.reset(seed=0)
    assert env.observation_space["touch"].shape == (17175,)
    assert env.observation_space["eye_left"].shape == (64, 64, 3)
    assert env.unwrapped.init_qpos[2] == pytest.approx(0.05, abs=0.02)
    assert env.unwrapped.behavior is None


def test_a_scene_is_taken_as_it_is(make: Make, tmp_path: Path) -> None:
    make(act_legs=False)
    evaluated = make(training=False, act_legs=True)
    assert evaluated.action_space.shape == make(act_legs=False).action_space.shape
    scene = tmp_path / "run" / "scene.xml"
    scene.write_text(scene.read_text().replace("<worldbody>", "<worldbody><geom size='1'/>"))
    with pytest.raises(ValueError, match=r"it has <geom>; this engine serves the scenes that"):
        make(training=False)


def test_build_names_what_is_missing() -> None:
    with pytest.raises(KeyError, match="act_legs"):
        build({key: value for key, value in CONFIG.items() if key != "act_legs"})
    text = build(CONFIG, "/somewhere")
    assert '<include file="/somewhere/babybench/motor_legs.xml"></include>' in text
    assert "motor_eyes" not in text


def test_parameters_that_the_engine_does_not_have_are_refused() -> None:
    with pytest.raises(ValueError, match="touch_scale"):
        BabyBenchEnv(
            touch_params={
                "scales": {"head": 0.1, "hip": 0.1, "lower_body": 0.1, "upper_body": 0.1},
                "touch_function": "force_vector",
                "response_function": "nearest",
            }
        )
    with pytest.raises(ValueError, match="squares of one size"):
        BabyBenchEnv(vision_params={"eye_left": {"width": 64, "height": 32}, "eye_right": {"width": 64, "height": 32}})
    with pytest.raises(NotImplementedError, match="face"):
        BabyBenchEnv().swap_facial_expression("happy")


# --- hooks ---


class Damped(SpringDamperModel):
    """Halves every action."""

    def action(self, action: Any) -> None:
        """Takes half of an action."""
        super().action(np.asarray(action) / 2)


class Numb(TrimeshTouch):
    """Feels half of every force, in Python."""

    def force_vector(self, contact_id: int, body_id: int) -> Any:
        """Returns half of the force."""
        return super().force_vector(contact_id, body_id) / 2


class Mine(BabyBenchSelfTouchEnv):
    """Changes a little of everything."""

    def touch_setup(self, touch_params: dict[str, Any]) -> None:
        """Makes another sense of touch."""
        self.touch = Numb(self, touch_params)

    def get_vestibular_obs(self) -> Any:
        """Returns the sense of balance, scaled."""
        return 2 * super().get_vestibular_obs()

    def _randomize_reset(self) -> None:
        self._set_action(np.zeros(self.action_space.shape))
        self._single_mujoco_step()

    def compute_reward(self, *_: Any, **__: Any) -> float:
        """Returns a reward of its own."""
        return 1.5

    def _info(self) -> dict[str, Any]:
        return {**super()._info(), "mine": True}


def test_subclasses_replace_what_they_like(make: Make, tmp_path: Path) -> None:
    usual = make()
    config = {**CONFIG, "save_dir": str(tmp_path / "run")}
    mine = Mine(model_path=str(tmp_path / "run" / "scene.xml"), config=config, training=False)
    mine.reset()
    assert isinstance(mine, MIMoEnv)
    usual.reset()
    for env in (usual.unwrapped, mine):
        env._set_action(np.zeros(env.action_space.shape))
        env.set_state(mine.init_qpos, mine.init_qvel)
    a, b = usual.unwrapped._get_obs(), mine._get_obs()
    assert np.abs(a["touch"]).max() > 0
    np.testing.assert_allclose(b["touch"], a["touch"] / 2, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(b["vestibular"], 2 * a["vestibular"], rtol=1e-4, atol=1e-6)
    _, reward, _, _, info = mine.step(mine.action_space.sample())
    assert reward == 1.5
    assert info["mine"]


def test_an_actuation_model_can_be_changed(tmp_path: Path) -> None:
    env, usual = BabyBenchEnv(actuation_model=Damped), BabyBenchEnv()
    action = np.full(env.action_space.shape, 0.5, np.float32)
    for e, a in ((env, action), (usual, action / 2)):
        e.set_state(usual.init_qpos, usual.init_qvel)
        e.do_simulation(a, 1)
    assert np.array_equal(env.data.ctrl, usual.data.ctrl)


# --- Gymnasium ---


class Counting(gym.Wrapper):  # type: ignore[type-arg]
    """Counts what is touched, as participants' wrappers do."""

    def __init__(self, env: Any) -> None:
        """Reads attributes of the environment as its own."""
        super().__init__(env)
        self.parts = [list(env_utils.get_geoms_for_body(self.model, body)) for body in self.mimo_bodies]

    def step(self, action: Any) -> Any:
        """Takes a step, with the number of sensors that feel something as reward."""
        observation, _, terminated, truncated, info = self.env.step(action)
        felt = sum(int((force > 0).any()) for force in self.touch.sensor_outputs.values())
        return observation, felt, terminated, truncated, info


def test_attributes_are_seen_through_wrappers(make: Make) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Gymnasium 0.29 announces that it will not do so any more
        env = Counting(make())
        env.reset()
        assert env.touch is env.unwrapped.touch
        assert env.data is env.unwrapped.data
        assert len(env.parts) == len(env.mimo_bodies)
        assert env.step(env.action_space.sample())[1] >= 0
        with pytest.raises(AttributeError):
            _ = env.no_such_thing
        with pytest.raises(AttributeError):
            _ = gym.make("CartPole-v1").no_such_thing
    assert not hasattr(env.unwrapped, "env")


@pytest.mark.filterwarnings("ignore")
def test_gymnasium_checks_and_wraps(make: Make, tmp_path: Path) -> None:
    check_env(make().unwrapped, skip_render_check=True)
    flat = gym.wrappers.NormalizeObservation(gym.wrappers.FlattenObservation(make()))
    flat.reset()
    assert np.isfinite(flat.step(flat.action_space.sample())[0]).all()
    counted = gym.wrappers.RecordEpisodeStatistics(make())
    counted.reset()
    assert [step[3] for step in steps(counted, 8)] == [False] * 7 + [True]
    vector = gym.vector.SyncVectorEnv([lambda i=i: make(save_dir=str(tmp_path / str(i))) for i in range(2)])
    vector.reset(seed=0)
    for _ in range(10):
        observation = vector.step(vector.action_space.sample())[0]
    assert observation["touch"].shape == (2, 4497)


def test_a_seed_repeats_an_episode_unless_the_action_space_has_its_own(make: Make, tmp_path: Path) -> None:
    env = make()
    config = {**CONFIG, "save_dir": str(tmp_path / "run")}
    fresh = gym.make(
        "BabyBench-SelfTouch", model_path=str(tmp_path / "run" / "scene.xml"), config=config, training=False
    )
    first, again = fresh.reset(seed=3)[0], fresh.reset(seed=3)[0]
    assert np.array_equal(first["observation"], again["observation"])
    env.action_space.seed(9)
    one = env.reset(seed=3)[0]
    env.action_space.seed(9)
    assert np.array_equal(env.reset(seed=4)[0]["observation"], one["observation"])


def test_copies_and_pickles_continue_with_the_same_bits(make: Make) -> None:
    env = make().unwrapped
    env.reset()
    steps(env, 3)
    copies = [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
    action = env.action_space.sample()
    expected = env.step(action)
    for other in copies:
        got = other.step(action)
        assert all(np.array_equal(got[0][key], expected[0][key]) for key in expected[0])
        assert got[4] == expected[4]


def test_wrong_actions_are_errors(make: Make) -> None:
    env = make()
    env.reset()
    for wrong in (np.full(env.action_space.shape, np.nan), np.zeros(3)):
        with pytest.raises(ValueError, match=r"action|broadcast"):
            env.unwrapped.step(wrong)
    env.unwrapped.step(np.float32(0.1))


@pytest.mark.parametrize("actuation", ["spring_damper", "muscle", "positional"])
def test_actuation_models(make: Make, tmp_path: Path, actuation: str) -> None:
    env = make(actuation_model=actuation, save_dir=str(tmp_path / actuation), frame_skip=2, lock_hands=True)
    env.reset()
    steps(env, 2)
    u = env.unwrapped
    outputs = u.proprioception.sensor_outputs
    np.testing.assert_allclose(u.actuation_model.observations(), outputs["actuation"], rtol=1e-6, atol=1e-9)
    assert 0 <= u.actuation_model.cost() <= 1
    assert u.data.ctrl.shape == (u.n_actuators,)


def test_pictures(make: Make) -> None:
    env = make()
    env.reset()
    picture = bb_utils.render(env, "closeup")
    assert picture.shape == (48, 48, 3)
    assert picture.dtype == np.uint8
    assert bb_utils.to_grayscale(picture).shape == (48, 48)
    depth = env.unwrapped.mujoco_renderer.render("depth_array", camera_name="top")
    assert 0 < depth.min() <= depth.max() <= 1
    with pytest.raises(ValueError, match="there is no camera"):
        bb_utils.render(env, "moon")
    with pytest.raises(ValueError, match="render_size"):
        bb_utils.evaluation_img(env)
    if getattr(mujoco, "stands_in", False):  # MuJoCo's own needs OpenGL
        renderer = mujoco.Renderer(env.unwrapped.model, 24, 32)
        renderer.update_scene(env.unwrapped.data, camera="top")
        assert renderer.render().shape == (24, 32, 3)


def test_a_video_of_an_evaluation(make: Make, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        env = make(render_size=480)
        env.reset()
        evaluation = EVALS["self_touch"](env=env, duration=2, render=True, save_dir=str(tmp_path / "run"))
        evaluation.reset()
        for step in steps(env, 2):
            evaluation.eval_step(step[4])
        evaluation.end(3)
    assert (tmp_path / "run" / "videos" / "evaluation_3.avi").stat().st_size > 10_000
    with (tmp_path / "run" / "logs" / "evaluation_3.pkl").open("rb") as f:
        assert len(pickle.load(f)["qpos"]) == 2


def test_a_video_without_opencv(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "cv2", None)
    frames = [np.full((48, 72, 3), k, np.uint8) for k in range(5)]
    bb_utils.evaluation_video(frames, tmp_path / "v.avi", resolution=(72, 48))
    assert (tmp_path / "v.avi").read_bytes()[:4] == b"RIFF"
