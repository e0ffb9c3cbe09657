"""Neurodata Without Borders, written with pynwb: one session, whose trials are the episodes."""

from __future__ import annotations

import datetime
import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from babybench_core.export import episodes, library
from babybench_core.export.signals import signals

if TYPE_CHECKING:
    from babybench_core.data import Record

_GAP = 1.0
"""Seconds of the session between two episodes."""
_NAMES = {"1": "n.a.", "rad": "radians", "rad/s": "radians/s", "N": "newtons"}
"""Units, as NWB writes them."""


def write(record: Record, path: Path, session_start_time: Optional[datetime.datetime]) -> None:
    """Writes a record: behavior as time series in ``processing/behavior``, images in ``acquisition``, episodes as trials."""
    pynwb = library("nwb")
    starts = _starts(record)
    file = _session(pynwb, record, session_start_time)
    file.add_trial_column("episode", "Number of the episode.")
    file.add_trial_column("steps", "Number of steps.")
    file.add_trial_column("return", "Sum of the rewards.")
    for number, start in starts.items():
        episode = record[number]
        end = start + float(episode["time"][-1])
        total = float(np.sum(episode["reward"]))
        file.add_trial(start_time=start, stop_time=end, episode=number, steps=episode.steps, **{"return": total})
    behavior = file.create_processing_module("behavior", "What MIMo did and felt, after each step.")
    clock = _clock(record, starts)
    first: Any = None
    told = [signals(record[number]) for number in starts]
    for parts in zip(*told):
        head = parts[0]
        columns = f" Columns: {', '.join(head.labels)}." if len(head.labels) > 1 else ""
        series = pynwb.TimeSeries(
            name=head.name.replace(" ", "_"),
            description=head.meaning + columns,
            unit=_NAMES[head.unit],
            data=np.squeeze(np.concatenate([part.values for part in parts]), 1 if len(head.labels) == 1 else ()),
            timestamps=clock if first is None else first,
        )
        first = first or series
        behavior.add(series)
    if all("touch_ptr" in record[number] for number in starts):
        behavior.add(_touch(record, starts))
    _eyes(pynwb, file, record, starts)
    with pynwb.NWBHDF5IO(path, "w") as io:
        io.write(file)


def _session(pynwb: Any, record: Record, start: Optional[datetime.datetime]) -> Any:
    manifest = record.manifest
    text = json.dumps(manifest, sort_keys=True)
    if start is None:
        # a record does not know when it was made, but its description was written then
        modified = (record.folder / "manifest.json").stat().st_mtime
        start = datetime.datetime.fromtimestamp(modified, datetime.timezone.utc)
    months = manifest["configuration"].get("age")
    digest = hashlib.sha256(text.encode()).hexdigest()
    return pynwb.NWBFile(
        session_description=f"MIMo, a simulated infant: {manifest['configuration']['behavior']} in babybench.",
        identifier=digest,
        session_start_time=start,
        session_id=digest[:12],
        experiment_description="A record of babybench; nothing of it was measured on a living being.",
        source_script="babybench.data.Record.to_nwb",
        source_script_file_name="babybench",
        keywords=["simulation", "infant", "touch", manifest["policy"] or "policy"],
        notes=text,
        subject=pynwb.file.Subject(
            subject_id="MIMo",
            description="A simulated infant by the model MIMo, in a body of the given age.",
            species="Homo sapiens",
            **_individual(manifest.get("infant")),
            # without an age of its own the model is that of 18 months
            age=f"P{round((18 if months is None else months) * 30.4375)}D",
        ),
    )


def _individual(infant: Optional[dict[str, Any]]) -> dict[str, str]:
    """Returns sex and weight of the record's infant; those of a body by the formulas are unknown."""
    if infant is None:
        return {"sex": "U"}
    return {"sex": {"boy": "M", "girl": "F"}[infant["sex"]], "weight": f"{infant['weight']:.3f} kg"}


def _starts(record: Record) -> dict[int, float]:
    """Returns when each episode starts in the session, s."""
    found, at = {}, 0.0
    for number in episodes(record):
        found[number] = at
        at += float(record[number]["time"][-1]) + _GAP
    return found


def _clock(record: Record, starts: dict[int, float]) -> Any:
    return np.concatenate([start + record[number]["time"] for number, start in starts.items()])


def _touch(record: Record, starts: dict[int, float]) -> Any:
    """Returns the touch of all steps as a table with lists: indices and values of the observation's nonzero numbers."""
    from hdmf.common import DynamicTable, VectorData, VectorIndex

    idx, val, ends, at = [], [], [], 0
    for number in starts:
        episode = record[number]
        idx.append(episode["touch_idx"].astype(np.int32))
        val.append(episode["touch_val"].astype(np.float32))
        ends.append(at + episode["touch_ptr"][1:].astype(np.int64))
        at += len(idx[-1])
    index = np.concatenate(ends)
    place = VectorData(name="touch_idx", description="Indices in the touch observation.", data=np.concatenate(idx))
    value = VectorData(
        name="touch_val", description="Values at these indices, newtons; others are 0.", data=np.concatenate(val)
    )
    time = VectorData(name="time", description="Time after the step, seconds.", data=_clock(record, starts))
    columns = [
        time,
        VectorIndex(name="touch_idx_index", data=index, target=place),
        place,
        VectorIndex(name="touch_val_index", data=index.copy(), target=value),
        value,
    ]
    return DynamicTable(name="touch_sparse", description="The touch observation of each step, sparse.", columns=columns)


def _eyes(pynwb: Any, file: Any, record: Record, starts: dict[int, float]) -> None:
    from pynwb.image import ImageSeries

    seeing = [number for number in starts if "eye_steps" in record[number]]
    for eye in ("eye_left", "eye_right"):
        if not seeing or eye not in record[seeing[0]]:
            continue
        images = np.concatenate([record[number][eye] for number in seeing])
        times = np.concatenate([starts[n] + record[n]["time"][record[n]["eye_steps"]] for n in seeing])
        # NWB counts columns before rows
        series = ImageSeries(
            name=eye,
            description=f"What the {eye[4:]} eye observed: red, green, blue; time, x, y.",
            data=np.swapaxes(images, 1, 2),
            unit="n.a.",
            format="raw",
            timestamps=times,
        )
        file.add_acquisition(series)
