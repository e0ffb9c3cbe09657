"""Parquet, written with pyarrow: one table, with a row for each step of every episode."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from babybench_core.export import episodes, library
from babybench_core.export.signals import signals

if TYPE_CHECKING:
    from babybench_core.data import Episode, Record


def write(record: Record, path: Path) -> None:
    """Writes a record as one table; units and meanings are in the metadata of its columns, the manifest in the table's."""
    library("parquet")
    import pyarrow.parquet as pq

    first = _table(record[episodes(record)[0]])
    with pq.ParquetWriter(path, first.schema, compression="zstd") as writer:
        writer.write_table(first)
        for number in episodes(record)[1:]:
            writer.write_table(_table(record[number]).cast(first.schema))


def _table(episode: Episode) -> Any:
    import pyarrow as pa

    fields, arrays = [], []

    def add(name: str, values: Any, unit: str, meaning: str) -> None:
        column = values if isinstance(values, pa.Array) else pa.array(np.ascontiguousarray(values))
        fields.append(pa.field(name, column.type, metadata={"unit": unit, "meaning": meaning}))
        arrays.append(column)

    steps = episode.steps
    add("episode", np.full(steps, episode.number, np.int64), "1", "Number of the episode.")
    add("step", np.arange(steps, dtype=np.int64), "1", "Number of the step, from 0.")
    add("time", episode["time"], "s", "Simulated time after the step, from the start of the episode.")
    for signal in signals(episode):
        for name, values in signal.columns().items():
            add(name, values, signal.unit, signal.meaning)
    for name, meaning in (("terminated", "Success or failure ended the episode."), ("truncated", "It was cut off.")):
        add(name, episode[name].astype(bool), "1", meaning)
    if "touch_ptr" in episode:
        add("touch_idx", _lists(episode, "touch_ptr", "touch_idx", np.int32), "1", "Indices in the touch observation.")
        add(
            "touch_val",
            _lists(episode, "touch_ptr", "touch_val", np.float32),
            "N",
            "Values at these indices; others are 0.",
        )
    for name, unit, meaning in (
        ("geom", "1", "Ids of both geoms of each contact, pair by pair."),
        ("pos", "m", "Positions of the contacts in the world, three numbers each."),
        ("dist", "m", "Distances of the surfaces; negative is penetration."),
        ("force", "N", "Forces of the first geom on the second: normal and two tangents, three numbers each."),
    ):
        kind = np.int32 if name == "geom" else np.float32
        add(f"contact_{name}", _lists(episode, "contact_ptr", f"contact_{name}", kind), unit, meaning)
    manifest = {"babybench": json.dumps(episode.manifest)}
    return pa.table(arrays, schema=pa.schema(fields, metadata=manifest))


def _lists(episode: Episode, ends: str, name: str, kind: Any) -> Any:
    """Returns a list for each step."""
    import pyarrow as pa

    values = episode[name]
    width = int(np.prod(values.shape[1:], dtype=int))
    offsets = pa.array((episode[ends].astype(np.int64) * width).astype(np.int32))
    return pa.ListArray.from_arrays(offsets, pa.array(values.ravel().astype(kind)))
