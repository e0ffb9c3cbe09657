"""Packs recordings of the reference for the repository: only what tests read, without duplicates, compressed.

    pip install numpy zopfli
    python conformance/scripts/pack_recordings.py RECORDED conformance/data
    python conformance/scripts/pack_recordings.py --tasks RECORDINGS conformance/data

RECORDED holds what was written while the reference ran (`conformance/data/README.md` names the files). Numbers stay the
same to the bit. Columns of `observation` that are columns of another array are stored once: `observation_from` has the
number of the array, of those in SOURCES, and the column; the remaining columns are in `observation_own`.
"""

import gzip
import io
import json
import shutil
import sys
import zipfile
import zlib
from pathlib import Path

import numpy as np
import zopfli.gzip
import zopfli.zlib

SOURCES = ["observation_own", "qpos", "qvel", "qacc", "sensordata", "ctrl", "gear", "actions", "vestibular"]
TIME = (1980, 1, 1, 0, 0, 0)


def deflated(data):
    """The deflate stream without zlib's header and checksum."""
    return zopfli.zlib.compress(data, numiterations=15)[2:-4]


def write_npz(path, arrays):
    """Writes a zip container of compressed members, which `zipfile` cannot do."""
    central, offset = b"", 0
    with open(path, "wb") as out:
        for name, array in arrays.items():
            member = io.BytesIO()
            np.save(member, np.ascontiguousarray(array))
            data, name = member.getvalue(), f"{name}.npy".encode()
            packed = deflated(data)
            sizes = [zlib.crc32(data), len(packed), len(data)]
            common = b"".join(n.to_bytes(2, "little") for n in (20, 0, 8, 0, 33))
            common += b"".join(n.to_bytes(4, "little") for n in sizes) + len(name).to_bytes(2, "little") + bytes(2)
            out.write(b"PK\3\4" + common + name + packed)
            central += b"PK\1\2" + (20).to_bytes(2, "little") + common + bytes(10) + offset.to_bytes(4, "little") + name
            offset += 30 + len(name) + len(packed)
        count = len(arrays).to_bytes(2, "little")
        out.write(central + b"PK\5\6" + bytes(4) + 2 * count)
        out.write(len(central).to_bytes(4, "little") + offset.to_bytes(4, "little") + bytes(2))
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
    with np.load(path) as read:
        for name, array in arrays.items():
            assert read[name].dtype == array.dtype and read[name].tobytes() == np.ascontiguousarray(array).tobytes(), name


def column(array, k):
    return np.ascontiguousarray(array[:, k].astype(np.float64)).tobytes()


def without_copies(arrays):
    """Replaces `observation` by its own columns and the indices of the others."""
    observation = arrays.pop("observation")
    places = {}
    for source, name in list(enumerate(SOURCES))[1:]:
        array = arrays.get(name)
        if array is not None and array.ndim == 2:
            for k in range(array.shape[1]):
                places.setdefault(column(array, k), (source, k))
    own, where = [], []
    for k in range(observation.shape[1]):
        place = places.get(column(observation, k))
        if place is None:
            place = (0, len(own))
            own.append(observation[:, k])
        where.append(place)
    arrays["observation_own"] = np.stack(own, axis=1)
    arrays["observation_from"] = np.array(where, dtype=np.int64)
    return arrays


def recordings(recorded, out):
    out.mkdir(parents=True, exist_ok=True)
    for config in sorted(recorded.glob("*.yml")):
        name = config.stem
        with np.load(recorded / f"{name}.npz") as npz:
            arrays = without_copies({key: npz[key] for key in npz.files})
        with np.load(recorded / f"{name}_floor.npz") as npz:
            arrays["floor"] = npz["rms"]
        write_npz(out / f"{name}.npz", arrays)
        shutil.copyfile(config, out / config.name)


def json_files(files, out):
    out.mkdir(parents=True, exist_ok=True)
    for source, name in files:
        packed = zopfli.gzip.compress(source.read_bytes())
        assert gzip.decompress(packed) == source.read_bytes()
        (out / f"{name}.json.gz").write_bytes(packed)


def arrays_only(files, out):
    for source in files:
        with np.load(source) as npz:
            write_npz(out / source.name, {key: npz[key] for key in npz.files})


def plain(files, out):
    out.mkdir(parents=True, exist_ok=True)
    for source in files:
        shutil.copyfile(source, out / source.name)


TASKS = """actions qpos qvel qacc activity reward terminated achieved_goal desired_goal ctor_qpos reset_row reset_qpos reset_qvel
reset_warm reset_activity reset_desired_goal reset_ball reset_set_qpos reset_actions""".split()


def tasks(recorded, out):
    """Recordings of tasks: states, rewards, goals, and the starts of episodes."""
    out.mkdir(parents=True, exist_ok=True)
    for path in sorted(recorded.glob("*.npz")):
        with np.load(path) as npz:
            arrays = {key: npz[key] for key in TASKS if key in npz.files and npz[key].size}
        info = json.loads(path.with_suffix(".json").read_text())["info"]
        arrays["is_success"] = np.array([row["is_success"] for row in info])
        write_npz(out / path.name, arrays)


def main():
    if sys.argv[1] == "--tasks":
        return tasks(Path(sys.argv[2]), Path(sys.argv[3]) / "tasks")
    recorded, data = map(Path, sys.argv[1:])
    golden, tables, touch = recorded / "golden", recorded / "mimo_tables", recorded / "touch_examples"
    recordings(golden, data / "recordings")
    runs = [(path, path.stem.removeprefix("golden_")) for path in sorted(tables.glob("golden_*.json"))]
    json_files(runs, data / "example_runs")
    plain(sorted(tables.glob("*_muscle_params.tsv")), data / "muscles")
    json_files([(path, path.stem) for path in sorted(touch.glob("*.json"))], data / "touch")
    arrays_only(sorted(touch.glob("*.npz")), data / "touch")
    plain([*sorted((golden / "logs").glob("*.pkl")), golden / "logs" / "expected_scores.json"], data / "logs")


if __name__ == "__main__":
    main()
