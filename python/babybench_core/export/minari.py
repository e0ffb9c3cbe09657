"""Minari: a data set of observations and actions for offline learning."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from babybench_core.export import episodes, library

if TYPE_CHECKING:
    from babybench_core.data import Record

_FOLDER = "MINARI_DATASETS_PATH"


@contextmanager
def _datasets(path: Optional[Path]) -> Iterator[None]:
    """Makes Minari write into a folder."""
    if path is None:
        yield
        return
    before = os.environ.get(_FOLDER)
    os.environ[_FOLDER] = str(path)
    try:
        yield
    finally:
        if before is None:
            del os.environ[_FOLDER]
        else:
            os.environ[_FOLDER] = before


def write(record: Record, dataset_id: str, path: Optional[Path]) -> Any:
    """Makes the data set; see :meth:`babybench.data.Record.to_minari`."""
    minari = library("minari")
    from minari.data_collector import EpisodeBuffer

    env = record.environment()
    buffers = []
    for number in episodes(record):
        differs = record.replay(number)
        if differs is not None:
            raise ValueError(
                f"{record.folder}: episode {number} is not repeated with the same bits from step {differs} on, so that its"
                " observations are not known: a program changed the scene, or another version recorded it"
            )
        steps = list(record.repeat(number))
        keys = list(env.observation_space.spaces)
        buffers.append(
            EpisodeBuffer(
                id=number,
                observations={key: np.stack([step[0][key] for step in steps]) for key in keys},
                actions=record[number]["actions"],
                rewards=[step[1] for step in steps[1:]],
                terminations=[step[2] for step in steps[1:]],
                truncations=[step[3] for step in steps[1:]],
                infos=None,
            )
        )
    configuration = record.manifest["configuration"]
    with _datasets(path):
        return minari.create_dataset_from_buffers(
            dataset_id,
            buffers,
            action_space=env.action_space,
            observation_space=env.observation_space,
            algorithm_name=record.manifest["policy"] or "unknown",
            author="babybench",
            description=f"{configuration['behavior']} in the scene {configuration['scene']}, by babybench"
            f" {record.manifest['babybench']}.",
            code_permalink="https://babybench.github.io/2025",
            requirements=["babybench"],
        )
