"""Records: what is recorded, read, measured and repeated."""

from __future__ import annotations

import json

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
    with pytest.raises(FileExistsError, match="name another folder"):
        babybench.data.Recorder(babybench.make(SMALL), folder)
    manifest = json.loads((folder / "manifest.json").read_text("utf-8"))
    (folder / "manifest.json").write_text(json.dumps({**manifest, "format": "else"}), "utf-8")
    with pytest.raises(ValueError, match="no record of babybench"):
        babybench.data.open(folder)
    manifest["episodes"][0]["file"] = "../episode_0.npz"
    (folder / "manifest.json").write_text(json.dumps(manifest), "utf-8")
    with pytest.raises(ValueError, match="in this folder"):
        babybench.data.open(folder)[0]
