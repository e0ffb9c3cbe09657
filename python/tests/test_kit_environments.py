"""Environments as the starter kit makes them: subclasses, wrappers, copies, pictures."""

from __future__ import annotations

import copy
import pickle
import warnings
from pathlib import Path
from typing import Any

import gymnasium as gym
import mimoEnv.utils as env_utils
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from kit_scripts import CONFIG, Make, steps
from mimoActuation.actuation import SpringDamperModel
from mimoEnv.babybench import BabyBenchEnv, BabyBenchSelfTouchEnv
from mimoEnv.envs.mimo_env import MIMoEnv
from mimoTouch.touch import TrimeshTouch

import babybench
import babybench.utils as bb_utils
import mujoco
from babybench.eval import EVALS

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


# --- parameters of the senses ---


def test_none_turns_a_sense_off() -> None:
    env = BabyBenchSelfTouchEnv(touch_params=None, vision_params=None)
    assert list(env.reset()[0]) == ["observation", "vestibular"]
    assert env.touch is env.vision is None
    env = gym.make("BabyBench-SelfTouch", touch_params=None, vestibular_params=None, max_episode_steps=3).unwrapped
    assert list(env.reset()[0]) == ["observation", "eye_left", "eye_right"]
    # a configuration cannot turn on a sense that has no parameters
    env = BabyBenchEnv(touch_params=None, config={**CONFIG, "touch_active": False}, training=False)
    assert env.touch is None
    with pytest.raises(TypeError, match="touch_params is None"):
        BabyBenchEnv(touch_params=None, config={**CONFIG, "touch_active": True}, training=False)


def test_defaults_that_a_script_has_changed_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    from mimoEnv.babybench.base import TOUCH_PARAMS, VISION_PARAMS

    for eye in VISION_PARAMS.values():
        for side in eye:
            monkeypatch.setitem(eye, side, 24)
    monkeypatch.setitem(TOUCH_PARAMS, "response_function", "nearest")
    env = BabyBenchSelfTouchEnv()
    assert env.reset()[0]["eye_left"].shape == (24, 24, 3)
    assert env.touch is not None
    assert env.touch.response_type == "nearest"
    scales = dict(TOUCH_PARAMS["scales"])
    env = BabyBenchSelfTouchEnv(config={**CONFIG, "touch_active": True, "touch_scale": 2}, training=False)
    assert TOUCH_PARAMS["scales"] == scales  # one environment does not change the next


@pytest.mark.filterwarnings("ignore:make_env")
def test_keys_that_are_left_out_have_their_default(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for behavior in ("hand_regard", "self_touch", "none"):
        feels = {"touch_active": False} if behavior == "hand_regard" else {}  # the kit's skin is that of MIMo v1
        env = bb_utils.make_env({"behavior": behavior, "vision_active": False, **feels})
        env.reset()
        env.step(env.action_space.sample())
        assert env.unwrapped.frame_skip == 1
        assert env.spec.max_episode_steps == 1000
    folder = tmp_path / babybench.config_keys()["save_dir"]["default"]
    assert (folder / "scene.xml").is_file()
    assert bb_utils.make_env({}, training=False).unwrapped.behavior == "none"


def test_what_is_no_configuration_says_so() -> None:
    for wrong in ("self_touch", None, 3):
        with pytest.raises(
            TypeError, match=r"make_env needs a configuration, a dict, not .*babybench\.make\('self_touch'\)"
        ):
            bb_utils.make_env(wrong)
    with pytest.raises(ValueError, match="did you mean `self_touch`"):
        bb_utils.make_env({"behavior": "selftouch"})
