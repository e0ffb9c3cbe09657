"""The postures in which MIMo's tasks begin: angles of his joints, rad, in the order of his own tables."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_CROUCHING: dict[str, float] = {
    "hip_lean1": -0.0134586,
    "hip_rot1": -0.259285,
    "hip_bend1": 0.407198,
    "hip_lean2": -0.0565839,
    "hip_rot2": -0.248653,
    "hip_bend2": 0.38224,
    "head_swivel": 0,
    "head_tilt": 0,
    "head_tilt_side": 0,
    "left_eye_horizontal": 0,
    "left_eye_vertical": 0,
    "left_eye_torsional": 0,
    "right_eye_horizontal": 0,
    "right_eye_vertical": 0,
    "right_eye_torsional": 0,
    "right_shoulder_horizontal": 1.59608,
    "right_shoulder_ad_ab": 2.57899,
    "right_shoulder_rotation": 0.259329,
    "right_elbow": -0.188292,
    "right_hand1": -0.429857,
    "right_hand2": -0.99162,
    "right_hand3": -0.0568468,
    "right_fingers": -1.4206,
    "left_shoulder_horizontal": 0.778157,
    "left_shoulder_ad_ab": 2.9349,
    "left_shoulder_rotation": 1.16941,
    "left_elbow": -0.547872,
    "left_hand1": -1.54373,
    "left_hand2": -0.98379,
    "left_hand3": 0.225526,
    "left_fingers": -1.27117,
    "right_hip1": -2.26831,
    "right_hip2": -0.295142,
    "right_hip3": -0.313409,
    "right_knee": -2.53125,
    "right_foot1": -0.109924,
    "right_foot2": -0.0352949,
    "right_foot3": 0.106372,
    "right_toes": 0.0205777,
    "left_hip1": -2.118,
    "left_hip2": -0.233242,
    "left_hip3": 0.369615,
    "left_knee": -2.34683,
    "left_foot1": -0.279261,
    "left_foot2": -0.477783,
    "left_foot3": 0.111583,
    "left_toes": 0.0182025,
}
_SITTING: dict[str, float] = {
    "hip_lean1": 0.039088,
    "hip_rot1": 0.113112,
    "hip_bend1": 0.5323,
    "hip_lean2": 0,
    "hip_rot2": 0,
    "hip_bend2": 0.5323,
    "head_swivel": 0,
    "head_tilt": 0,
    "head_tilt_side": 0,
    "left_eye_horizontal": 0,
    "left_eye_vertical": 0,
    "left_eye_torsional": 0,
    "right_eye_horizontal": 0,
    "right_eye_vertical": 0,
    "right_eye_torsional": 0,
    "left_shoulder_horizontal": 0.683242,
    "left_shoulder_ad_ab": 0.3747,
    "left_shoulder_rotation": -0.62714,
    "left_elbow": -0.756016,
    "left_hand1": 0.28278,
    "left_hand2": 0,
    "left_hand3": 0,
    "left_fingers": -0.461583,
    "right_hip1": -1.51997,
    "right_hip2": -0.397578,
    "right_hip3": 0.0976615,
    "right_knee": -1.85479,
    "right_foot1": -0.585865,
    "right_foot2": -0.358165,
    "right_foot3": 0,
    "right_toes": 0,
    "left_hip1": -1.23961,
    "left_hip2": -0.8901,
    "left_hip3": 0.7156,
    "left_knee": -2.531,
    "left_foot1": -0.63562,
    "left_foot2": 0.5411,
    "left_foot3": 0.366514,
    "left_toes": 0.24424,
}
CROUCHING_BASE = np.array([-0.103287, 0.00444494, 0.0672742, 0.965518, -0.00942109, -0.207444, 0.157016])
"""Position and orientation of the base of the crouching MIMo."""
SITTING_BASE = np.array([0.0579584, -0.00157173, 0.0566738, 0.892294, -0.0284863, -0.450353, -0.0135029])
"""Position and orientation of the base of the sitting MIMo."""


def _posture(angles: dict[str, float]) -> dict[str, NDArray[np.float64]]:
    return {f"robot:{joint}": np.array([angle]) for joint, angle in angles.items()}


CROUCHING: dict[str, NDArray[np.float64]] = {"mimo_location": CROUCHING_BASE, **_posture(_CROUCHING)}
SITTING: dict[str, NDArray[np.float64]] = _posture(_SITTING)
