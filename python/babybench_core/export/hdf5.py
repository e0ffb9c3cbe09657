"""HDF5, written with h5py: every array of a record, with its unit and its meaning."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from babybench_core.export import episodes, library
from babybench_core.export.signals import UNITS

if TYPE_CHECKING:
    from babybench_core.data import Record


def write(record: Record, path: Path) -> None:
    """Writes a record: groups ``episode_N`` and ``skin``, with the manifest and the names of joints, actions and geoms above."""
    h5py = library("hdf5")
    numbers = episodes(record)
    with h5py.File(path, "w") as file:
        file.attrs["manifest"] = json.dumps(record.manifest)
        for name in ("format", "babybench", "platform", "policy", "dt"):
            file.attrs[name] = record.manifest[name]
        text = h5py.string_dtype()
        for name, values in (
            ("joints", [joint["name"] for joint in record.manifest["joints"]]),
            ("actions", record.manifest["actions"]),
            ("geoms", [geom["part"] for geom in record.manifest["geoms"]]),
            ("bodies", record.bodies),
        ):
            file.create_dataset(f"names/{name}", data=values, dtype=text)
        if record.has_skin:
            for name, array in record.skin().items():
                made = file.create_dataset(f"skin/{name}", data=array)
                made.attrs["unit"] = "m" if name == "position" else "1"
        for number in numbers:
            _episode(record, file, number)


def _episode(record: Record, file: Any, number: int) -> None:
    episode = record[number]
    group = file.create_group(f"episode_{number}")
    group.attrs["episode"] = episode.number
    group.attrs["steps"] = episode.steps
    group.attrs["info"] = json.dumps(episode.info)
    for name, values in episode.items():
        # scalars and empty arrays have no chunks to compress
        packing = {"compression": "gzip", "shuffle": True} if values.ndim and values.size else {}
        made = group.create_dataset(name, data=values, **packing)
        meaning = record.manifest["arrays"].get(name, {}).get("meaning", "")
        made.attrs["meaning"] = meaning
        made.attrs["unit"] = UNITS.get(name, "1")
