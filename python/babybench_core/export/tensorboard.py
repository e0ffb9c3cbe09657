"""TensorBoard, by its own writer: scalars of steps, a run for each episode, and measures of episodes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from babybench_core.export import episodes, library
from babybench_core.export.signals import signals

if TYPE_CHECKING:
    from babybench_core.data import Record


def write(record: Record, path: Path, every: int) -> None:
    """Writes a folder of runs: ``episode_N`` by step, ``episodes`` by number; a tag is ``signal (unit)/column``.

    Scalars carry the simulated time, so that TensorBoard's "relative" axis is seconds of simulation.
    """
    library("tensorboard")
    if every < 1:
        raise ValueError(f"every is {every}; expected at least 1")
    for number in episodes(record):
        _steps(record, number, path / f"episode_{number}", every)
    _episodes(record, path / "episodes")


class _Scalars:
    """The events of a run."""

    def __init__(self, path: Path) -> None:
        from tensorboard.summary import Writer

        path.mkdir(parents=True, exist_ok=True)
        self._writer = Writer(str(path))

    def add(self, tag: str, value: float, step: int, time: float, meaning: str) -> None:
        self._writer.add_scalar(tag, value, step, wall_time=time, description=meaning)

    def __enter__(self) -> _Scalars:
        return self

    def __exit__(self, *exception: object) -> None:
        self._writer.close()


def _crc_table() -> npt.NDArray[np.uint32]:
    """Returns the table of CRC-32C, reflected polynomial 0x82F63B78."""
    table = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        table = (table >> 1) ^ np.where(table & 1, np.uint32(0x82F63B78), np.uint32(0))
    return table


_CRC = _crc_table()
_AT_ONCE = 512
"""Number of steps whose events are made together."""


def _checksums(records: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint32]:
    """Returns the masked CRC-32C of records of one length, (records, bytes)."""
    crc = np.full(len(records), 0xFFFFFFFF, np.uint32)
    for column in np.ascontiguousarray(records.T):
        crc = _CRC[(crc ^ column) & 0xFF] ^ (crc >> 8)
    crc ^= np.uint32(0xFFFFFFFF)
    masked: npt.NDArray[np.uint32] = ((crc >> 15) | (crc << 17)) + np.uint32(0xA282EAD8)
    return masked


def _framed(events: npt.NDArray[np.uint8]) -> bytes:
    """Returns serialised events of one length, (events, bytes), in the format of an event file."""
    count, size = events.shape
    length = np.broadcast_to(np.frombuffer(np.uint64(size).tobytes(), np.uint8), (count, 8))
    of_length, of_event = (_checksums(part).astype("<u4").view(np.uint8).reshape(count, 4) for part in (length, events))
    return np.concatenate([length, of_length, events, of_event], axis=1).tobytes()


def _steps(record: Record, number: int, path: Path, every: int) -> None:
    """Writes the scalars of an episode: one event per step, whose bytes differ from the last one's only in the numbers."""
    from tensorboard.compat.proto.event_pb2 import Event
    from tensorboard.compat.proto.summary_pb2 import Summary, SummaryMetadata
    from tensorboard.compat.proto.tensor_pb2 import TensorProto
    from tensorboard.compat.proto.types_pb2 import DT_FLOAT

    episode = record[number]
    tags, columns, meanings = [], [], []
    for signal in signals(episode):
        unit = "" if signal.unit == "1" else f", {signal.unit}"
        tags += [f"{signal.name}{unit}" + (f"/{label}" if label else "") for label in signal.labels]
        columns.append(signal.values)
        meanings += [signal.meaning] * len(signal.labels)
    steps = np.arange(0, episode.steps, every)
    values = np.concatenate(columns, axis=1)[steps].astype("<f4")
    times = episode["time"][steps].tolist()

    def number_of(value: float) -> Any:
        return TensorProto(dtype=DT_FLOAT, float_val=[value])

    def event(step: int, **what: Any) -> bytes:
        return bytes(Event(wall_time=times[step], step=int(steps[step]), **what).SerializeToString())

    path.mkdir(parents=True, exist_ok=True)
    with (path / f"events.out.tfevents.{number:010d}.babybench").open("wb") as file:

        def write(serialised: bytes) -> None:
            file.write(_framed(np.frombuffer(serialised, np.uint8)[None]))

        write(Event(wall_time=0.0, file_version="brain.Event:2").SerializeToString())
        if not len(steps):
            return
        kind = SummaryMetadata.PluginData(plugin_name="scalars")
        described = [
            Summary.Value(
                tag=tag,
                tensor=number_of(float(value)),
                metadata=SummaryMetadata(plugin_data=kind, summary_description=meaning),
            )
            for tag, value, meaning in zip(tags, values[0], meanings)
        ]
        write(event(0, summary=Summary(value=described)))
        # a number is the last four bytes of its value, as all other fields have lower numbers
        plain = [Event(summary=Summary(value=[Summary.Value(tag=tag, tensor=number_of(1.0))])) for tag in tags]
        sizes = [len(one.summary.SerializeToString()) for one in plain]
        whole = Event(summary=Summary(value=[one.summary.value[0] for one in plain])).SerializeToString()
        ends = len(whole) - sum(sizes) + np.cumsum(sizes)
        where = (ends[:, None] + np.arange(-4, 0)).ravel()
        for first in range(1, len(steps), _AT_ONCE):
            last = min(first + _AT_ONCE, len(steps))
            heads = [event(step) for step in range(first, last)]
            for size in sorted({len(head) for head in heads}):
                group = [k for k, head in enumerate(heads) if len(head) == size]
                events = np.empty((len(group), size + len(whole)), np.uint8)
                events[:, :size] = np.frombuffer(b"".join(heads[k] for k in group), np.uint8).reshape(-1, size)
                events[:, size:] = np.frombuffer(whole, np.uint8)
                numbers = values[[first + k for k in group]]
                events[:, size + where] = np.ascontiguousarray(numbers).view(np.uint8).reshape(len(group), -1)
                file.write(_framed(events))


def _episodes(record: Record, path: Path) -> None:
    with _Scalars(path) as scalars:
        for number in episodes(record):
            time = float(number)
            scalars.add("return", float(np.sum(record[number]["reward"])), number, time, "Sum of the rewards.")
            for name, value in _numbers("", record.measure(number)):
                scalars.add(f"measures/{name}", value, number, time, "As the guide defines it.")


def _numbers(prefix: str, measures: dict[str, Any]) -> list[tuple[str, float]]:
    """Returns the numbers of nested dictionaries by path."""
    found: list[tuple[str, float]] = []
    for name, value in measures.items():
        if isinstance(value, dict):
            found += _numbers(f"{prefix}{name}.", value)
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            found.append((prefix + name, float(value)))
    return found
