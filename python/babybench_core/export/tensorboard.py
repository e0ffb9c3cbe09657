"""TensorBoard, by its own writer: scalars of steps, a run for each episode, and measures of episodes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

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


def _steps(record: Record, number: int, path: Path, every: int) -> None:
    episode = record[number]
    with _Scalars(path) as scalars:
        for signal in signals(episode):
            unit = "" if signal.unit == "1" else f", {signal.unit}"
            for label, values in zip(signal.labels, signal.values.T):
                tag = f"{signal.name}{unit}" + (f"/{label}" if label else "")
                for step in range(0, episode.steps, every):
                    scalars.add(tag, float(values[step]), step, float(episode["time"][step]), signal.meaning)


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
