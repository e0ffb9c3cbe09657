"""Motions: what MIMo feels in them, and what is refused."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from conftest import SMALL

import babybench
import babybench.data

STEPS = 40
CONFIG = """behavior: self_touch
scene: crib
vision_active: false
touch_scale: 2.0
"""


@pytest.fixture(scope="module", name="record")
def recorded(tmp_path_factory):
    """A record of held noise with all senses."""
    folder = tmp_path_factory.mktemp("motion") / "record"
    env = babybench.make({**SMALL, "max_episode_steps": STEPS})
    noise = babybench.ActionNoise("held:0.1", env, seed=2)
    with babybench.data.Recorder(env, folder, senses=True) as recorder:
        recorder.reset(seed=1)
        for _ in range(STEPS):
            recorder.step(noise())
    return babybench.data.open(folder)


def test_a_motion_out_of_a_record_gives_its_proprioceptive_angles(record, tmp_path):
    motion = record.motion(0)
    assert motion["root_pos"].shape == (STEPS, 3)
    played = babybench.data.play_motion(motion, tmp_path / "played", record.manifest["configuration"], seed=7)
    assert (played.steps, played.error, played.worst) == (STEPS, 0.0, None)
    joints = len(motion["names"])
    felt = played.record[0]["observation"][:, :joints]
    # positions of records have 32 bits
    np.testing.assert_allclose(felt, record[0]["observation"][:, :joints], atol=1e-6)
    assert np.diff(played.record[0]["touch_ptr"]).max() > 0
    assert played.record.manifest["policy"] == "motion, kinematic"


def test_motors_track_a_motion_and_the_record_is_repeated(tmp_path):
    angles = -1 + 0.3 * np.sin(np.arange(100) / 20)[:, None]
    motion = {"names": ["robot:right_elbow"], "angles": angles, "rate": 100}
    played = babybench.data.play_motion(motion, tmp_path / "played", SMALL, track=True, senses=False)
    assert 0 < played.error < 0.25
    assert played.worst[0] == "robot:right_elbow"
    assert played.record.replay(0) is None


def test_the_command_reads_tables_and_writes_archives(tmp_path):
    (tmp_path / "c.yml").write_text(CONFIG)
    rows = [f"{k / 50},{10 * k},{-5 * k}" for k in range(10)]
    (tmp_path / "m.csv").write_text("time,robot:left_elbow,robot:right_knee\n" + "\n".join(rows))
    command = [sys.executable, "-m", "babybench", "senses", "--config", "c.yml", "--quiet"]
    table = ["--motion", "m.csv", "--degrees", "--save", "m.npz", "--record", "out", "--record-senses"]
    done = subprocess.run([*command, *table], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert "10 frames at 50" in done.stdout
    with np.load(tmp_path / "m.npz") as motion:
        assert motion["names"].tolist() == ["robot:left_elbow", "robot:right_knee"]
        np.testing.assert_allclose(motion["angles"][:, 0], np.radians(10.0 * np.arange(10)))
        assert motion["rate"] == pytest.approx(50)
    record = babybench.data.open(tmp_path / "out")
    names = [joint["name"] for joint in record.manifest["joints"]]
    knee = record[0]["observation"][:, names.index("robot:right_knee")]
    np.testing.assert_allclose(knee, np.radians(np.linspace(0, -45, len(knee))), atol=1e-6)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"angles": [[np.nan]]}, "is NaN"),
        ({"angles": [[90.0]]}, "expected an angle in rad"),
        ({"angles": [0.0]}, "expected \\(frames, joints\\)"),
        ({"names": ["robot:right_elbo"]}, "did you mean"),
        ({"names": ["a", "b"]}, "2 names for 1 columns"),
        ({"rate": 1e300}, "the rate is"),
        ({"rate": [1.0, 2.0]}, "expected one number"),
        ({"root_pos": [[0.0, 0.0, 0.0]]}, "belong together"),
        ({"speed": 1.0}, "a motion has no 'speed'"),
    ],
)
def test_what_is_no_motion_is_refused(tmp_path, change, said):
    motion = {"names": ["robot:right_elbow"], "angles": [[0.0]], "rate": 10.0, **change}
    with pytest.raises(ValueError, match=said):
        babybench.data.play_motion(motion, tmp_path / "played", SMALL)


def test_files_that_are_not_there_and_muscles_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError):
        babybench.data.play_motion(tmp_path / "none.npz", tmp_path / "a", SMALL)
    motion = {"names": ["robot:right_elbow"], "angles": [[0.0]], "rate": 10.0}
    with pytest.raises(ValueError, match="muscles do not follow angles"):
        babybench.data.play_motion(motion, tmp_path / "b", SMALL, track=True, actuation_model="muscle")
