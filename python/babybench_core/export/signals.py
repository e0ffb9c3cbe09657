"""The signals of a record, step by step, with names and units: the same in every format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from babybench_core.data import Episode

PAIRS = ("right_eye_right_hand", "right_eye_left_hand", "left_eye_right_hand", "left_eye_left_hand")
"""The pairs of an eye and a hand, in the order of the arrays."""
REGIONS = (
    "head",
    "trunk",
    "right arm",
    "left arm",
    "right hand",
    "left hand",
    "right leg",
    "left leg",
    "right foot",
    "left foot",
)
"""The regions of the body, with sides."""
UNITS = {
    "qpos0": "m, rad",
    "qvel0": "m/s, rad/s",
    "activity0": "1",
    "drawn": "1",
    "time": "s",
    "actions": "1",
    "qpos": "m, rad",
    "qvel": "m/s, rad/s",
    "touch_ptr": "1",
    "touch_idx": "1",
    "touch_val": "N",
    "touch_len": "1",
    "contact_ptr": "1",
    "contact_geom": "1",
    "contact_pos": "m",
    "contact_dist": "m",
    "contact_force": "N",
    "reward": "1",
    "terminated": "1",
    "truncated": "1",
    "first_touch_step": "1",
    "first_touch_hand": "1",
    "first_touch_geom": "1",
    "regards": "1",
    "gaze_angles": "rad",
    "is_success": "1",
    "is_failure": "1",
    "return": "1",
    "eye_steps": "1",
    "eye_size": "pixel",
    "observation": "rad, rad/s, N m",
    "vestibular": "m/s^2, rad/s",
    "reflexes": "1",
    "touch_pooled": "N, 1",
    "pain": "1",
    "eye_left_depth": "m",
    "eye_right_depth": "m",
}
"""Units of the arrays of an archive; ``1`` for numbers without."""


@dataclass(frozen=True)
class Signal:
    """Numbers over time."""

    name: str
    """Name of the quantity: ``angle``."""
    unit: str
    """Their unit; ``1`` for numbers without."""
    meaning: str
    """Description, one sentence."""
    labels: Sequence[str]
    """Label of each column; one empty label where there is only one."""
    values: npt.NDArray[Any]
    """(T, columns)."""

    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """Returns the columns by name: ``angle robot:right_elbow``."""
        names = (f"{self.name} {label}".strip() for label in self.labels)
        return {name: self.values[:, k] for k, name in enumerate(names)}


def signals(episode: Episode) -> list[Signal]:
    """Returns the values of each step of an episode, without time."""
    manifest = episode.manifest
    joints, each = manifest["joints"], [""]
    names = [joint["name"] for joint in joints]
    angles = episode["qpos"][:, [joint["qpos"] for joint in joints]]
    velocities = episode["qvel"][:, [joint["dof"] for joint in joints]]
    found = [
        Signal("angle", "rad", "Joint angles after the step.", names, angles),
        Signal("velocity", "rad/s", "Joint velocities after the step.", names, velocities),
        Signal("action", "1", "Actions, as they were given.", list(manifest["actions"]), episode["actions"]),
        Signal("reward", "1", "Reward of the step.", each, episode["reward"][:, None]),
    ]
    if "touch_ptr" in episode:
        count = np.diff(episode["touch_ptr"])[:, None]
        found.append(Signal("touch values", "1", "Numbers of the touch observation that are not zero.", each, count))
        found.append(
            Signal("touch", "N", "Sum of the forces on the sensors of a region.", REGIONS, touch_by_region(episode))
        )
    found.append(Signal("contacts", "1", "Contacts in the scene.", each, np.diff(episode["contact_ptr"])[:, None]))
    if "regards" in episode:
        meaning = "Steps so far with the hand within 15 degrees of where the eye looks."
        found.append(Signal("regards", "1", meaning, PAIRS, episode["regards"]))
        meaning = "How far the hand is off the axis of the eye."
        found.append(Signal("gaze angle", "rad", meaning, PAIRS, episode["gaze_angles"]))
    if "return" in episode:
        found.append(Signal("return", "1", "Sum of the rewards so far.", each, episode["return"][:, None]))
    return found


def regions(manifest: Mapping[str, Any]) -> dict[str, int]:
    """Returns the number of the region, among :data:`REGIONS`, of each of MIMo's bodies."""
    found = {}
    for geom in manifest["geoms"]:
        if geom["region"] is not None:
            name = f"{geom['side']} {geom['region']}" if geom["side"] else geom["region"]
            # eyes are parts of the head
            found[geom["body"]] = REGIONS.index(name if name in REGIONS else geom["region"])
    return found


def sensor_regions(episode: Episode) -> npt.NDArray[np.intp]:
    """Returns the index of each touch sensor's region; -1 for other bodies."""
    record, of = episode.record, regions(episode.manifest)
    names = record.bodies
    by_body = np.array([of.get(name, -1) for name in names], np.intp)
    by_sensor: npt.NDArray[np.intp] = by_body[record.skin()["body"]]
    return by_sensor


def sensor_forces(episode: Episode) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], npt.NDArray[np.float32]]:
    """Returns the touch of an episode by sensor: steps, sensors and nonzero magnitudes, N, by step, then sensor."""
    step = np.repeat(np.arange(episode.steps), np.diff(episode["touch_ptr"]))
    count = len(episode.record.skin()["body"])
    width = max(1, int(episode["touch_len"]) // max(1, count))
    key = step.astype(np.int64) * count + episode["touch_idx"] // width
    found, where = np.unique(key, return_inverse=True)
    squares = np.zeros(len(found))
    np.add.at(squares, where, episode["touch_val"].astype(np.float64) ** 2)
    return found // max(1, count), found % max(1, count), np.sqrt(squares).astype(np.float32)


def touch_by_region(episode: Episode) -> npt.NDArray[np.float32]:
    """Returns the sum of the forces on the sensors of each region in each step, (T, regions), N."""
    step, sensor, force = sensor_forces(episode)
    region = sensor_regions(episode)[sensor]
    out = np.zeros((episode.steps, len(REGIONS)), np.float32)
    own = region >= 0
    np.add.at(out, (step[own], region[own]), force[own])
    return out
