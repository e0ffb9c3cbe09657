"""Records in the formats of other programs: written, and read back by these programs' own libraries."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import SMALL

import babybench
import babybench.data
from babybench_core.export import FORMATS, signals

STEPS = 25
EYES = 3
IMAGES = 9


@pytest.fixture(scope="module", name="record")
def recorded(tmp_path_factory):
    """A record of two episodes with touch, and one of eyes beside it."""
    folder = tmp_path_factory.mktemp("export") / "record"
    env = babybench.make({**SMALL, "vision_active": True, "vision_resolution": 8, "max_episode_steps": STEPS})
    noise = babybench.ActionNoise("held:0.1", env, seed=7)
    with babybench.data.Recorder(env, folder, eyes_every=EYES, policy="held") as recorder:
        for seed in (3, 4):
            recorder.reset(seed=seed)
            for _ in range(STEPS):
                recorder.step(noise())
    return babybench.data.open(folder)


def angles(record, number=0):
    """The joint angles of an episode, (T, joints)."""
    return record[number]["qpos"][:, [joint["qpos"] for joint in record.manifest["joints"]]]


def test_signals_have_names_and_units(record):
    told = {signal.name: signal for signal in signals.signals(record[0])}
    assert told["angle"].unit == "rad"
    assert told["touch"].unit == "N"
    assert list(told["angle"].labels) == [joint["name"] for joint in record.manifest["joints"]]
    # what a region feels is what its sensors feel
    step = int(np.argmax(told["touch"].values.sum(1)))
    sensors = len(record.skin()["body"])
    felt = np.linalg.norm(record[0].touch(step).reshape(sensors, -1).astype(np.float64), axis=1)
    assert felt.sum() > 0
    np.testing.assert_allclose(told["touch"].values[step].sum(), felt.sum(), rtol=1e-5)
    assert set(record.manifest["arrays"]) - {"snapshot", "checksum"} - set(signals.UNITS) == {"eye_left", "eye_right"}
    assert (
        record.bodies == record.environment(touch_active=False, vision_active=False)._core.blueprint.model_names["body"]
    )


def test_an_episode_is_repeated_with_everything_observed(record):
    steps = list(record.repeat(1))
    assert len(steps) == STEPS + 1
    np.testing.assert_array_equal(steps[-1][0]["eye_left"], record[1]["eye_left"][-1])
    first = steps[1][0]
    np.testing.assert_array_equal(first["eye_left"], record[1]["eye_left"][0])
    np.testing.assert_allclose(first["touch"].ravel(), record[1].touch(0), rtol=5e-4)
    assert steps[-1][4]["steps"] == STEPS


def test_parquet_is_read_by_pyarrow(record, tmp_path):
    pq = pytest.importorskip("pyarrow.parquet")
    record.to_parquet(tmp_path / "r.parquet")
    table = pq.read_table(tmp_path / "r.parquet")
    assert table.num_rows == 2 * STEPS
    names = [f"angle {joint['name']}" for joint in record.manifest["joints"]]
    read = np.stack([table[name].to_numpy()[STEPS:] for name in names], axis=1)
    np.testing.assert_array_equal(read, angles(record, 1))
    assert table.schema.field(names[0]).metadata[b"unit"] == b"rad"
    assert json.loads(table.schema.metadata[b"babybench"])["format"] == "babybench record"
    row = table.slice(STEPS + 17, 1).to_pylist()[0]
    touch = np.zeros_like(record[1].touch(17))
    touch[row["touch_idx"]] = row["touch_val"]
    np.testing.assert_array_equal(touch, record[1].touch(17))
    contacts = record[1].contacts(17)
    np.testing.assert_array_equal(np.reshape(row["contact_pos"], (-1, 3)).astype(np.float32), contacts["pos"])


def test_hdf5_is_read_by_h5py(record, tmp_path):
    h5py = pytest.importorskip("h5py")
    record.to_hdf5(tmp_path / "r.h5")
    with h5py.File(tmp_path / "r.h5") as file:
        assert json.loads(file.attrs["manifest"]) == record.manifest
        group = file["episode_1"]
        assert set(group) == set(record[1])
        for name, values in record[1].items():
            np.testing.assert_array_equal(group[name][()], values)
        assert group["qvel"].attrs["unit"] == "m/s, rad/s"
        np.testing.assert_array_equal(file["skin/position"], record.skin()["position"])
        assert file["names/bodies"].asstr()[1] == record.bodies[1]


# what the libraries say of each other
@pytest.mark.filterwarnings("ignore")
def test_nwb_is_valid_and_read_by_pynwb(record, tmp_path):
    pynwb = pytest.importorskip("pynwb")
    path = tmp_path / "r.nwb"
    record.to_nwb(path)
    assert not pynwb.validate(path=str(path))
    with pynwb.NWBHDF5IO(path, "r") as io:
        file = io.read()
        assert file.subject.age == "P548D"
        assert file.trials["episode"][:].tolist() == [0, 1]
        behavior = file.processing["behavior"]
        series = behavior["angle"]
        assert series.unit == "radians"
        np.testing.assert_array_equal(series.data[STEPS:], angles(record, 1))
        start = file.trials["start_time"][1]
        np.testing.assert_allclose(series.timestamps[STEPS:] - start, record[1]["time"])
        touch = np.zeros_like(record[1].touch(17))
        table = behavior["touch_sparse"]
        touch[table["touch_idx"][STEPS + 17]] = table["touch_val"][STEPS + 17]
        np.testing.assert_array_equal(touch, record[1].touch(17))
        np.testing.assert_array_equal(
            np.swapaxes(file.acquisition["eye_left"].data[IMAGES:], 1, 2), record[1]["eye_left"]
        )


@pytest.mark.filterwarnings("ignore")
def test_nwb_pleases_the_inspector(record, tmp_path):
    inspector = pytest.importorskip("nwbinspector")
    path = tmp_path / "r.nwb"
    record.to_nwb(path)
    found = [m for m in inspector.inspect_nwbfile(nwbfile_path=path) if m.importance.name in ("ERROR", "CRITICAL")]
    assert not found, found


def test_rerun_is_read_by_rerun(record, tmp_path):
    pytest.importorskip("rerun")
    from rerun.chunk import RrdReader

    record.to_rerun(tmp_path / "r.rrd", every=5)
    columns = {}
    for chunk in RrdReader(str(tmp_path / "r.rrd")).stream():
        batch = chunk.to_record_batch()
        columns.update({(str(chunk.entity_path), name): batch.column(name) for name in batch.schema.names})

    def column(path, name):
        return columns[f"/episode_1/{path}", name].to_pylist()

    # the hip's pose is the root's, which the record has
    env = record.environment(vision_active=False, touch_active=False)
    qpos, qvel = (record[1][name][5].astype(np.float64) for name in ("qpos", "qvel"))
    env.set_state(qpos, qvel)
    hand = env._core.blueprint.model_names["body"].index("right_hand")
    xpos = env.array("xpos").reshape(-1, 3)[hand]
    np.testing.assert_allclose(column("world/right_hand", "Transform3D:translation")[1][0], xpos, atol=1e-6)
    steps, sensors, forces = signals.sensor_forces(record[1])
    np.testing.assert_array_equal(column("world/touch", "sensor")[1], sensors[steps == 5])
    np.testing.assert_allclose(column("world/touch", "force_N")[1], forces[steps == 5])
    assert len(column("world/touch", "Points3D:positions")[1]) == np.sum(steps == 5)
    name = record.manifest["joints"][0]["name"]
    path = next(
        path for path, _ in columns if path.startswith("/episode_1/angle") and path.endswith(name.split(":")[1])
    )
    np.testing.assert_allclose(np.ravel(columns[path, "Scalars:scalars"].to_pylist()), angles(record, 1)[:, 0])
    picture = np.array(column("eyes/left", "Image:buffer")[-1][0], np.uint8).reshape(8, 8, 3)
    np.testing.assert_array_equal(picture, record[1]["eye_left"][-1])


def test_tensorboard_reads_its_events(record, tmp_path):
    pytest.importorskip("tensorboard")
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    record.to_tensorboard(tmp_path / "board")
    events = EventAccumulator(str(tmp_path / "board" / "episode_1"), size_guidance={"tensors": 0})
    events.Reload()
    name = record.manifest["joints"][0]["name"]
    read = [float(event.tensor_proto.float_val[0]) for event in events.Tensors(f"angle, rad/{name}")]
    np.testing.assert_allclose(read, angles(record, 1)[:, 0], rtol=1e-6)
    episodes = EventAccumulator(str(tmp_path / "board" / "episodes"), size_guidance={"tensors": 0})
    episodes.Reload()
    read = [float(event.tensor_proto.float_val[0]) for event in episodes.Tensors("measures/double_touch")]
    np.testing.assert_allclose(read, [record.measure(k)["double_touch"] for k in record], rtol=1e-6)
    with pytest.raises(ValueError, match="every is 0"):
        record.to_tensorboard(tmp_path / "other", every=0)


@pytest.mark.filterwarnings("ignore")
def test_minari_has_every_observation(record, tmp_path, monkeypatch):
    minari = pytest.importorskip("minari")
    record.to_minari("babybench/held-v0", tmp_path / "sets")
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "sets"))
    data = minari.load_dataset("babybench/held-v0")
    assert data.total_episodes == 2
    assert data.total_steps == 2 * STEPS
    episode = data[1]
    np.testing.assert_array_equal(episode.actions, record[1]["actions"])
    assert episode.truncations[-1]
    np.testing.assert_allclose(episode.observations["touch"][18].ravel(), record[1].touch(17), rtol=5e-4)
    np.testing.assert_array_equal(episode.observations["eye_left"][1], record[1]["eye_left"][0])


def test_the_command_exports(record, tmp_path):
    pytest.importorskip("h5py")
    pytest.importorskip("pyarrow")
    command = [sys.executable, "-m", "babybench", "export", str(record.folder), "--to", "parquet,hdf5"]
    command += ["--out", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "record.parquet").is_file()
    assert "record.h5" in done.stdout
    again = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert again.returncode == 1
    assert "already exists" in again.stderr
    assert "Traceback" not in again.stderr
    command[command.index("parquet,hdf5")] = "csv"
    other = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert other.returncode != 0
    assert "there is no format 'csv'" in other.stderr


@pytest.mark.parametrize("format", FORMATS)
def test_a_library_that_is_not_there_is_named_with_its_extra(record, tmp_path, monkeypatch, format):
    monkeypatch.setitem(sys.modules, FORMATS[format].library, None)
    with pytest.raises(ModuleNotFoundError, match=rf"pip install 'babybench\[{FORMATS[format].extra}\]'"):
        babybench_export(record, format, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def babybench_export(record, format, path):
    """Writes a record in a format."""
    if format == "minari":
        record.to_minari(path=path)
    else:
        getattr(record, f"to_{format}")(path)


def test_a_record_without_episodes_is_refused(tmp_path):
    pytest.importorskip("h5py")
    babybench.data.Recorder(babybench.make(SMALL), tmp_path / "empty")
    with pytest.raises(ValueError, match="the record has no episodes"):
        babybench.data.open(tmp_path / "empty").to_hdf5(tmp_path / "r.h5")
