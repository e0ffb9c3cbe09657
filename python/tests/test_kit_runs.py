"""Logs, scores, configurations and scenes, as the starter kit has them."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from kit_scripts import CONFIG, Make, steps
from mimoEnv.babybench import BabyBenchEnv, BabyBenchSelfTouchEnv

from babybench.build_xml import build
from babybench.eval import EVALS

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
    with pytest.raises(ValueError, match=r"it has <geom>; BabyBench's own environments take the scenes that"):
        make(training=False)


def test_build_names_what_is_missing() -> None:
    with pytest.raises(KeyError, match="act_legs"):
        build({key: value for key, value in CONFIG.items() if key != "act_legs"})
    text = build(CONFIG, "/somewhere")
    assert '<include file="/somewhere/babybench/motor_legs.xml"></include>' in text
    assert "motor_eyes" not in text


TRUNK = {"head": 0.1, "hip": 0.1, "lower_body": 0.1, "upper_body": 0.1}


def test_touch_parameters_that_a_behavior_does_not_have_are_refused() -> None:
    own = {"scales": TRUNK, "touch_function": "force_vector", "response_function": "nearest"}
    with pytest.raises(ValueError, match=r"touch_scale.*MIMoEnv for others"):
        BabyBenchSelfTouchEnv(touch_params=own)
    env, usual = BabyBenchEnv(touch_params=own), BabyBenchEnv(touch_params=None)
    felt = env.reset()[0]["touch"]
    assert felt.shape == (3 * env.touch.get_total_sensor_count(),)
    assert np.allclose(env.init_qpos, usual.init_qpos, atol=1e-9), "both settle"


def test_other_cameras_are_drawn() -> None:
    seen = BabyBenchEnv(
        vision_params={"eye_left": {"width": 48, "height": 16}, "corner": {"width": 32, "height": 24}}
    ).reset()[0]
    assert (seen["eye_left"].shape, seen["corner"].shape) == ((16, 48, 3), (24, 32, 3))


def test_each_eye_has_its_own_width_and_height() -> None:
    env = BabyBenchEnv(vision_params={"eye_left": {"width": 48, "height": 16}, "eye_right": {"width": 8, "height": 24}})
    seen = env.reset()[0]
    assert (seen["eye_left"].shape, seen["eye_right"].shape) == ((16, 48, 3), (24, 8, 3))
    assert env.observation_space["eye_left"].shape == (16, 48, 3)
    env.close()


def test_a_face_is_seen_and_changes_nothing_else() -> None:
    env, other = BabyBenchEnv(), BabyBenchEnv()
    for each in (env, other):
        each.reset(seed=3)
        each.step(np.full(each.action_space.shape, 0.2))
    pictures = []
    for face in ("happy", "default", "happy", "scared"):
        env.swap_facial_expression(face)
        pictures.append(env.mujoco_renderer.render("rgb_array", camera_name="closeup"))
    happy, default, again, scared = pictures
    np.testing.assert_array_equal(happy, again)
    for one, other_face in ((happy, default), (happy, scared), (default, scared)):
        assert (one != other_face).any()
    for _ in range(3):
        mine, others = (each.step(np.full(each.action_space.shape, -0.1))[0]["observation"] for each in (env, other))
        np.testing.assert_array_equal(mine, others)
    with pytest.raises(AssertionError, match="bored is not a valid"):
        env.swap_facial_expression("bored")
    env.close(), other.close()


def test_a_log_that_is_there_is_named_before_it_is_replaced(make: Make, tmp_path: Path) -> None:
    make()  # nothing is there
    log = tmp_path / "run" / "logs" / "training.pkl"
    log.write_bytes(b"records")
    with pytest.warns(UserWarning, match=r"training.pkl is the log of an earlier run"):
        make()
    make(training=False)


def test_two_processes_in_one_folder_are_told(make: Make, tmp_path: Path) -> None:
    program = f"""
import sys, warnings
import babybench, babybench.utils
from kit_scripts import maker
from pathlib import Path
env = maker(Path({str(tmp_path / "run")!r}))()
print("made", flush=True)
sys.stdin.read()
"""
    folder = os.path.dirname(__file__)
    child = subprocess.Popen(
        [sys.executable, "-c", program],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": folder},
    )
    try:
        assert child.stdout is not None
        assert child.stdout.readline() == "made\n"
        with pytest.warns(UserWarning, match=rf"process {child.pid} trains into this folder"):
            make()
    finally:
        child.communicate("")
    make()
