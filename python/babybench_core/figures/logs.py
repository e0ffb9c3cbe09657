"""Training logs, read for curves."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from babybench_core.export.signals import PAIRS

Floats = npt.NDArray[np.float64]
_SCORED = 34
"""Parts in the denominator of the score for each hand."""
_WINDOW = 0.1
"""Window of moving means, as a share of the episodes so far."""

METRICS = {
    "score": "score",
    "parts": "parts touched, per episode",
    "in view": "time with a hand in view, %",
    "return": "return",
    "success": "episodes with success, %",
}
"""Quantities that curves can show, and the labels of their axes."""


def find(path: Union[str, Path]) -> Path:
    """Returns the file of a training: the one given, or that of the run in a folder.

    Raises:
        FileNotFoundError: The file does not exist.
    """
    path = Path(path)
    for file in (path, path / "training.jsonl", path / "logs" / "training.jsonl"):
        if file.is_file():
            return file
    raise FileNotFoundError(f"{path}: no training log (logs/training.jsonl) is there")


def read(path: Union[str, Path]) -> list[dict[str, Any]]:
    """Returns the records of a training log: a dictionary for each episode of at least one step.

    Raises:
        FileNotFoundError: There is no log.
        ValueError: The log is damaged, or has no episodes.
    """
    file = find(path)
    records, number = [], 0
    try:
        with file.open(encoding="utf-8") as lines:
            for line in lines:
                number += 1
                record = json.loads(line)
                if int(record["steps"]) > 0:
                    records.append(record)
    except (ValueError, TypeError, KeyError):
        raise ValueError(f"{file}, line {number}: not a record of a training log") from None
    if not records:
        raise ValueError(f"{file}: the log has no episodes")
    return records


def default_metric(record: dict[str, Any]) -> str:
    """Returns the default metric of a log."""
    return "return" if "return" in record else "score"


def curve(records: list[dict[str, Any]], metric: str) -> tuple[Floats, Floats]:
    """Returns numbers of steps, and the metric after them.

    Raises:
        ValueError: The metric does not exist, or the log does not have it.
    """
    if metric not in METRICS:
        raise ValueError(f"there is no metric {metric!r}; there are {', '.join(METRICS)}")
    lengths = np.array([record["steps"] for record in records], np.float64)
    try:
        values = _VALUES[metric](records, lengths)
    except KeyError as error:
        raise ValueError(f"the log has no {metric}: its records have no {error}") from None
    return np.cumsum(lengths), values


def _score(records: list[dict[str, Any]], lengths: Floats) -> Floats:
    """Scores the episodes so far, as ``babybench score`` does."""
    if "right_hand_touches" not in records[0]:
        seen = np.array([sum(record[pair] for pair in PAIRS) for record in records], np.float64)
        return np.asarray(np.cumsum(seen) / (4 * np.cumsum(lengths)))
    touched: list[set[int]] = [set(), set()]
    values = []
    for record in records:
        for parts, hand in zip(touched, ("right", "left")):
            parts.update(record[f"{hand}_hand_touches"])
        values.append(sum(min(len(parts), _SCORED) for parts in touched) / (2 * _SCORED))
    return np.array(values)


def _parts(records: list[dict[str, Any]], lengths: Floats) -> Floats:
    return _smooth([len(r["right_hand_touches"]) + len(r["left_hand_touches"]) for r in records])


def _in_view(records: list[dict[str, Any]], lengths: Floats) -> Floats:
    return _smooth([100 * sum(r[pair] for pair in PAIRS) / (4 * r["steps"]) for r in records])


def _return(records: list[dict[str, Any]], lengths: Floats) -> Floats:
    return _smooth([r["return"] for r in records])


def _success(records: list[dict[str, Any]], lengths: Floats) -> Floats:
    return _smooth([100.0 * bool(r["is_success"]) for r in records])


_VALUES = {"score": _score, "parts": _parts, "in view": _in_view, "return": _return, "success": _success}


def _smooth(values: list[Any]) -> Floats:
    """Returns means over the last tenth of the episodes so far, at least over five."""
    sums = np.concatenate([[0.0], np.cumsum(np.array(values, np.float64))])
    ends = np.arange(1, len(sums))
    begins = ends - np.minimum(ends, np.maximum(5, (_WINDOW * ends).astype(int)))
    return np.asarray((sums[ends] - sums[begins]) / (ends - begins))
