"""Records: what is recorded, read, measured and repeated."""

from __future__ import annotations

import json
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import SMALL

import babybench
import babybench.data

STEPS = 30


@pytest.fixture(name="folder")
def recorded(tmp_path):
    """The folder of a record of two episodes, and what the skin felt in the last step."""
    env = babybench.make(SMALL, touch_active=True)
    noise = babybench.ActionNoise("held:0.1", env, seed=7)
    with babybench.data.Recorder(env, tmp_path / "record", policy="held") as recorder:
        for seed in (3, 4):
            recorder.reset(seed=seed)
            for _ in range(STEPS):
                observation, *_ = recorder.step(noise())
    np.save(tmp_path / "touch.npy", observation["touch"])
    return tmp_path / "record"


def test_two_lines_of_numpy_read_an_episode(folder):
    with np.load(folder / "episode_0.npz") as episode:
        assert episode["qpos"].shape[0] == episode["actions"].shape[0] == STEPS
        assert episode["time"][0] == pytest.approx(0.005)


def test_a_record_has_episodes_by_number(folder):
    record = babybench.data.open(folder)
    assert list(record) == [0, 1]
    assert record.manifest["policy"] == "held"
    episode = record[1]
    assert set(episode) == set(record.manifest["arrays"])
    assert episode.steps == STEPS == len(episode["qvel"])
    felt = np.load(folder.parent / "touch.npy").ravel()
    np.testing.assert_allclose(episode.touch(-1), felt, rtol=5e-4)
    contacts = episode.contacts(0)
    assert len(contacts["part"]) == len(contacts["dist"]) == len(contacts["geom"])
    with pytest.raises(KeyError, match="no array 'nothing'"):
        episode["nothing"]
    with pytest.raises(IndexError, match="step 30"):
        episode.touch(STEPS)
    with pytest.raises(KeyError, match="no episode 2"):
        record[2]
    assert record.skin()["position"].shape == (len(record.skin()["body"]), 3)


def test_a_record_is_repeated_and_measured(folder):
    record = babybench.data.open(folder)
    assert [record.replay(episode) for episode in record] == [None, None]
    both = record.measure()
    assert both["episodes"] == 2
    assert both["steps"] == 2 * STEPS
    assert record.measure(0)["seconds"] == pytest.approx(STEPS * 0.005)
    seen = {"fps": 200, "band": (10, 100), "window": 16}
    movement = record.movement(**seen)
    assert movement["episodes"] == 2
    assert movement["options"]["window"] == 16
    assert movement["values"]["right_hand_speed"] > 0
    assert record.movement(0, **seen, jitter=1, seed=1) == record.movement(0, **seen, jitter=1, seed=1)
    assert record.movement(0, **seen, jitter=1, seed=1) != record.movement(0, **seen, jitter=1, seed=2)
    with pytest.raises(ValueError, match="band is 10,300"):
        record.movement(**{**seen, "band": (10, 300)})
    with pytest.raises(ValueError, match='frame is "head"'):
        record.movement(frame="head")


def test_an_episode_is_a_table_of_pandas(folder):
    pandas = pytest.importorskip("pandas")
    episode = babybench.data.open(folder)[0]
    table = episode.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    assert table.index.name == "time"
    assert len(table) == STEPS
    np.testing.assert_array_equal(table["reward"], episode["reward"])


def test_an_episode_is_a_data_set_of_xarray(folder):
    xarray = pytest.importorskip("xarray")
    episode = babybench.data.open(folder)[0]
    data = episode.to_xarray()
    assert isinstance(data, xarray.Dataset)
    assert dict(data.sizes) == {
        "time": STEPS,
        "joint": len(episode.manifest["joints"]),
        "actuator": episode["actions"].shape[1],
    }
    np.testing.assert_array_equal(data["action"], episode["actions"])


def test_what_is_no_record_is_refused(folder, tmp_path):
    with pytest.raises(FileNotFoundError):
        babybench.data.open(tmp_path / "nowhere")
    with pytest.raises(FileExistsError, match="choose another folder"):
        babybench.data.Recorder(babybench.make(SMALL), folder)
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    (folder / "manifest.json").write_text(json.dumps({**manifest, "format": "else"}), "utf-8")
    with pytest.raises(ValueError, match="no record of babybench"):
        babybench.data.open(folder)
    manifest["episodes"][0]["file"] = "../episode_0.npz"
    (folder / "manifest.json").write_text(json.dumps(manifest), "utf-8")
    with pytest.raises(ValueError, match="in this folder"):
        babybench.data.open(folder)[0]


def changed(folder, **keys):
    """Records an episode of a scene as it is, then one of a changed model, then one with the change of before."""
    env = babybench.make({**SMALL, "touch_active": True, "touch_grows": True, "age": 6}, **keys)
    noise = babybench.ActionNoise("held:0.1", env, seed=7)
    friction = env.array("geom_friction") * 0.5
    options = [
        None,
        {"model": {"opt.gravity": [0, 0, -1.62], "geom_friction": friction}},
        {"model": {"opt.timestep": 0.004, "body_mass": {"head": 1.5}}},
        {"age": 3.0, "model": {"opt.gravity": [0, 0, -3.0]}},
        {"age": 6},
    ]
    with babybench.data.Recorder(env, folder) as recorder:
        for number, one in enumerate(options):
            recorder.reset(seed=number, options=one)
            for _ in range(5):
                recorder.step(noise())
    return babybench.data.open(folder)


def test_records_of_changed_models_are_repeated(tmp_path):
    record = changed(tmp_path / "record")
    assert [record.replay(number) for number in (*record, *reversed(list(record)))] == [None] * 10
    assert record[0].model == {}
    assert set(record[1].model) == {"opt.gravity", "geom_friction"}
    assert record[1].model["geom_friction"].shape == record.environment().array("geom_friction").shape
    assert np.array_equal(record[2].model["opt.gravity"], [0, 0, -1.62])  # changes hold until they are taken back
    assert "age" in record[3].description
    assert record[3].description["age"] == 3.0
    for number in record:
        steps = list(record.repeat(number))
        np.testing.assert_allclose(steps[-1][0]["touch"].ravel(), record[number].touch(-1), rtol=5e-4)
        assert len(steps) == 6
    assert record.measure()


def test_a_folder_stays_where_it_was(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    env = babybench.make(SMALL)
    recorder = babybench.data.Recorder(env, "record")
    recorder.reset(seed=0)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    recorder.step(env.action_space.sample())
    recorder.end()
    assert len(babybench.data.open(tmp_path / "record")) == 1


def test_an_episode_that_nobody_ends_is_kept_and_marked(tmp_path):
    env = babybench.make(SMALL)
    recorder = babybench.data.Recorder(env, tmp_path / "record")
    for _ in range(2):
        recorder.reset(seed=0)
        recorder.step(env.action_space.sample())
    rescue = recorder._rescue
    with pytest.warns(ResourceWarning, match="marked as unfinished"):
        rescue()  # what the end of the recorder, or of the program, calls
    record = babybench.data.open(tmp_path / "record")
    assert [episode.finished for episode in record.values()] == [True, False]
    assert [record.replay(number) for number in record] == [None, None]


def test_the_end_of_a_program_keeps_an_episode(tmp_path):
    program = f"""
import babybench, babybench.data
env = babybench.make({SMALL!r})
recorder = babybench.data.Recorder(env, {str(tmp_path / "record")!r})
recorder.reset(seed=0)
for _ in range(3): recorder.step(env.action_space.sample())
raise SystemExit(3)
"""
    assert subprocess.run([sys.executable, "-c", program], check=False, timeout=600).returncode == 3
    record = babybench.data.open(tmp_path / "record")
    assert (record[0].steps, record[0].finished) == (3, False)


def test_closing_the_environment_ends_the_episode(tmp_path):
    env = babybench.make(SMALL)
    recorder = babybench.data.Recorder(env, tmp_path / "record")
    recorder.reset(seed=0)
    recorder.step(env.action_space.sample())
    env.close()
    recorder.close()
    assert babybench.data.open(tmp_path / "record")[0].finished


def test_a_recorder_says_what_it_needs(tmp_path):
    env = babybench.make(SMALL)
    recorder = babybench.data.Recorder(env, tmp_path / "record")
    with pytest.raises(RuntimeError, match=r"call the recorder's reset\(\)"):
        recorder.step(env.action_space.sample())
    with pytest.raises(TypeError, match=r"records a babybench.Env, not a VectorEnv"):
        babybench.data.Recorder(babybench.VectorEnv(SMALL, 2), tmp_path / "other")
    other = babybench.data.Recorder(babybench.make(SMALL, touch_active=True), tmp_path / "third")
    with pytest.raises(ValueError, match="touch_grows"):
        other.reset(options={"age": 1})


def test_a_record_keeps_the_last_episodes(folder):
    record = babybench.data.open(folder)
    assert record[0] is record[0]
    assert record[1] is record[1]
    record[0].touch(0)
    begin = time.perf_counter()
    for step in range(STEPS):
        record[0].touch(step)
    assert (time.perf_counter() - begin) / STEPS < 0.5e-3
