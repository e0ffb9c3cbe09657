"""MIMo's sensations in a given motion: joint angles over time, from a video of an infant, a capture or a record."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from babybench_core import _native, scenes

if TYPE_CHECKING:
    from babybench_core.data import Record

MotionLike = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""A file, or ``names``, ``angles`` and ``rate``, with ``root_pos`` and ``root_quat`` where the root is known."""


@dataclass(frozen=True)
class Played:
    """The result of playing a motion."""

    record: Record
    """The record of MIMo's sensations."""
    steps: int
    """Number of steps."""
    error: float
    """Deviation of the joints from the motion, rad, root mean square; 0 when played kinematically."""
    worst: Optional[tuple[str, float]]
    """The joint with the largest deviation, and that deviation, rad."""
    beyond_limits: list[str]
    """Joints whose range the motion leaves."""


def play_motion(
    motion: MotionLike,
    folder: Union[str, Path],
    config: scenes.ConfigLike = None,
    *,
    track: bool = False,
    degrees: bool = False,
    senses: bool = True,
    eyes_every: Optional[int] = None,
    seed: Optional[int] = None,
    **keys: object,
) -> Played:
    """Plays a motion and records what MIMo would feel and see into a new folder: ``babybench senses`` in Python.

    Args:
        motion: A file (``.npz`` or ``.csv``), or a mapping: ``names`` of joints, ``angles`` (frames, joints), rad, ``rate``,
            Hz, and where the root is known ``root_pos`` (frames, 3), m, and ``root_quat`` (frames, 4), w first.
        folder: A folder without a record.
        config: The configuration; see :func:`babybench.make`.
        track: Whether motors track the angles and physics does the rest. By default MIMo is put into each pose.
        degrees: Whether the angles are in degrees.
        senses: Whether every other sense is recorded as observed, too.
        eyes_every: Number of steps from one recorded observation of both eyes to the next.
        seed: The seed of the reset.
        **keys: Keys of the configuration that replace those of ``config``.

    Raises:
        FileNotFoundError: The file does not exist.
        FileExistsError: The folder has a record.
        ValueError: A damaged file, numbers that are not finite, joints that MIMo does not have, or ``track`` with muscles.
    """
    from babybench_core import data
    from babybench_core.env import Env

    env = Env(config, **keys)  # type: ignore[arg-type]
    with tempfile.TemporaryDirectory() as temporary:
        path = os.fspath(motion) if not isinstance(motion, Mapping) else _write(motion, Path(temporary) / "motion.npz")
        policy = f"motion, {'tracking' if track else 'kinematic'}"
        recorder = _native.Recorder(env._core, folder, senses, eyes_every, policy)
        env.reset(seed=seed)
        steps, error, worst, beyond = _native.play_senses(env._core, recorder, path, degrees, track, 0)
    return Played(data.open(folder), steps, error, worst, beyond)


def _write(motion: Mapping[str, Any], path: Path) -> str:
    """Writes a mapping as a file.

    Raises:
        ValueError: A key is missing or unknown.
    """
    known, needed = ("names", "angles", "rate", "root_pos", "root_quat"), ("names", "angles", "rate")
    for name in motion:
        if name not in known:
            raise ValueError(f"a motion has no {name!r}; it has {', '.join(known)}")
    for name in needed:
        if name not in motion:
            raise ValueError(f"the motion has no {name!r}")
    arrays: dict[str, Any] = {name: np.asarray(motion[name], str if name == "names" else np.float64) for name in motion}
    np.savez(path, **arrays)
    return os.fspath(path)


def of_episode(record: Record, number: int) -> dict[str, Any]:
    """Returns the motion of an episode; see :meth:`babybench.data.Record.motion`."""
    episode, joints = record[number], record.manifest["joints"]
    qpos = episode["qpos"].astype(np.float64)
    motion: dict[str, Any] = {
        "names": [joint["name"] for joint in joints],
        "angles": qpos[:, [joint["qpos"] for joint in joints]],
        "rate": 1.0 / record.manifest["dt"],
    }
    env = record.environment(vision_active=False, touch_active=False)
    parents, body = env.array("body_parentid"), record.bodies.index("hip")
    while body > 0:
        for joint in np.flatnonzero((env.array("jnt_bodyid") == body) & (env.array("jnt_type") == 0)):
            at = int(env.array("jnt_qposadr")[joint])
            motion.update(root_pos=qpos[:, at : at + 3], root_quat=qpos[:, at + 3 : at + 7])
        body = int(parents[body])
    return motion
