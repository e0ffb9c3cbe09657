"""Hints at the name to use instead of one that does not exist."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Any, NoReturn


def nearest(name: str, names: Iterable[str]) -> str:
    """Returns a question after the name that may be meant, or nothing."""
    known = list(names)
    plain = {known_name.lower().replace("_", "").removeprefix("robot:"): known_name for known_name in known}
    found = difflib.get_close_matches(name.lower().replace("_", "").removeprefix("robot:"), plain, n=1)
    return f"; did you mean `{plain[found[0]]}`?" if found else ""


_STATE = (
    "this environment has no MuJoCo objects: env.array({example!r}) copies an array of the state or of the scene by MuJoCo's "
    "name, {more}"
)
_CHANGES = "env.set_state(qpos, qvel) changes positions, env.touch.contacts() has the contacts with skin"
ENV: Mapping[str, str] = {
    "data": "data: " + _STATE.format(example="qpos", more=_CHANGES),
    "model": "model: " + _STATE.format(example="jnt_range", more="env.geom_names and env.actuator_names are names"),
    "sim": "sim: " + _STATE.format(example="qpos", more=_CHANGES),
    "mujoco_renderer": "mujoco_renderer: env.picture(camera, width, height), env.depth(camera), env.segmentation(camera)",
    "vision": "vision: the observation has eye_left and eye_right; env.picture(camera, width, height) draws any camera",
    "vestibular": "vestibular: the observation has it, (6,): m/s^2 and rad/s",
    "actuation_model": 'actuation_model: env.config["actuation_model"] is its name, env.array("ctrl") what it drives',
    "init_qpos": 'init_qpos: env.reset() goes there, and env.array("qpos") is where MIMo is then',
    "compute_reward": "compute_reward: this environment has no goals",
}
"""Attributes of the starter kit's environments, and of environments with goals."""

TOUCH: Mapping[str, str] = {
    "sensor_outputs": "sensor_outputs: env.touch.of(body) has the values of a body, env.touch.sparse() those that are not 0",
    "sensor_positions": "sensor_positions: env.touch.positions, by the names of bodies",
    "sensor_scales": "sensor_scales: env.config['touch_scale'] times MIMo's own",
    "get_touch_obs": "get_touch_obs: observation['touch']",
    "contact_tuples": "contact_tuples: env.touch.contacts()",
    "get_contacts": "get_contacts: env.touch.contacts()",
    "meshes": "meshes: env.touch.positions has the sensors of each body",
}
"""Attributes of the starter kit's sense of touch."""

_PARTS = "observation['observation'][env.proprioception.slices['angles']], ['velocities'], ['torques'], ..."
PROPRIOCEPTION: Mapping[str, str] = {
    "sensor_outputs": f"sensor_outputs: {_PARTS}",
    "get_proprioception_obs": "get_proprioception_obs: observation['observation']",
    "joint_ids": "joint_ids: env.proprioception.joint_names, and env.proprioception.where('angles', name)",
}
"""Attributes of the starter kit's proprioception."""


def refuse(owner: Any, name: str, hints: Mapping[str, str]) -> NoReturn:
    """Suggests a replacement for an attribute.

    Raises:
        AttributeError: Always.
    """
    raise AttributeError(hints.get(name, f"{type(owner).__name__!r} object has no attribute {name!r}"))
