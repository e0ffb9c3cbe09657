"""The parts of MIMo's body as BabyBench's configurations group them, and MIMo's default parameters of the senses."""

from __future__ import annotations

from typing import Any

PARTS = ("body", "head", "eyes", "arms", "hands", "fingers", "legs", "feet")
"""The words in the keys ``act_*``, ``lock_*`` and ``touch_*`` of a configuration."""

VERSIONS = {"none": "v1", "self_touch": "v1", "hand_regard": "v2"}
"""The version of MIMo that each behavior has."""

GROUND = {
    "base": 'pos="0 0 .1" euler="0 -90 0"',
    "crib": 'pos="0 0 0.3" euler="0 -90 0"',
    "cubes": 'pos="0 0 0.0467196" quat="0.885453 -0.000184209 -0.464728 -0.000527509"',
}
"""Where MIMo is put in each scene: attributes of its outermost body."""


def _pairs(**spacings: float) -> dict[str, float]:
    """Returns the spacing of the left and of the right part of each pair, m."""
    return {f"{side}_{part}": spacing for part, spacing in spacings.items() for side in ("left", "right")}


_TRUNK = {"hip": 0.025, "lower_body": 0.025, "upper_body": 0.030, "head": 0.013}
_LEGS = _pairs(toes=0.010, foot=0.015, lower_leg=0.038, upper_leg=0.027)
_UPPER = {**_TRUNK, **_pairs(eye=1.0, upper_arm=0.024, lower_arm=0.024, hand=0.007)}
_DIGITS = ("ff", "mf", "rf", "lf")
_PHALANGES = {
    **{f"{digit}distal": 0.002 for digit in (*_DIGITS, "th")},
    **{f"{digit}middle": 0.004 for digit in _DIGITS},
    "thhub": 0.004,
    **{f"{digit}knuckle": 0.004 for digit in _DIGITS},
    "thbase": 0.004,
    "lfmetacarpal": 0.007,
}

SPACING_V1 = {**_LEGS, **_UPPER, **_pairs(fingers=0.002)}
"""Distance between touch sensors on each body of MIMo v1, m, in the order in which the kit lists the bodies."""

SPACING_V2 = {
    **_pairs(big_toe=0.010),
    **_LEGS,
    **_UPPER,
    **{f"left_{name}": spacing for name, spacing in _PHALANGES.items()},
    **{f"right_{name}": spacing for name, spacing in _PHALANGES.items()},
}
"""The same for MIMo v2."""

_STEMS = {
    "big_toe": "feet",
    "toes": "feet",
    "foot": "feet",
    "lower_leg": "legs",
    "upper_leg": "legs",
    "eye": "eyes",
    "upper_arm": "arms",
    "lower_arm": "arms",
    "hand": "hands",
    "hip": "body",
    "lower_body": "body",
    "upper_body": "body",
    "head": "head",
}
PART_OF_BODY = {
    body: _STEMS.get(body.removeprefix("left_").removeprefix("right_"), "fingers")
    for body in {**SPACING_V2, **SPACING_V1}
}
"""The part of each body of either version."""


def touch_params(spacing: dict[str, float] = SPACING_V1) -> dict[str, Any]:
    """Returns parameters of touch as MIMo's constructor takes them."""
    return {"scales": dict(spacing), "touch_function": "force_vector", "response_function": "spread_linear"}


def vision_params(size: int) -> dict[str, dict[str, int]]:
    """Returns parameters of two eyes of ``size`` by ``size`` pixels."""
    return {eye: {"width": size, "height": size} for eye in ("eye_left", "eye_right")}


def proprioception_params() -> dict[str, Any]:
    """Returns parameters of proprioception; the threshold is in rad."""
    return {"components": ["velocity", "torque", "limits", "actuation"], "threshold": 0.035}


def vestibular_params() -> dict[str, Any]:
    """Returns parameters of the sense of balance."""
    return {"sensors": ["vestibular_acc", "vestibular_gyro"]}


# Parameters of MIMo's own environments where none are given, which ``mimoEnv.envs.mimo_env`` calls DEFAULT_..._PARAMS.
PROPRIOCEPTION_DEFAULTS = proprioception_params()
VISION_DEFAULTS = vision_params(256)
VESTIBULAR_DEFAULTS = vestibular_params()
TOUCH_DEFAULTS = touch_params()
TOUCH_DEFAULTS_V2 = touch_params(SPACING_V2)
# Parameters of BabyBench's environments where none are given. As in the kit, scripts can change them.
PROPRIOCEPTION_PARAMS = proprioception_params()
VISION_PARAMS = vision_params(64)
VESTIBULAR_PARAMS = vestibular_params()
TOUCH_PARAMS = touch_params()
