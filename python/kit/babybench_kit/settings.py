"""From the kit's configurations to the engine's."""

from __future__ import annotations

import functools
import json
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from babybench_core import _native

from .scene import Scene
from .tables import PART_OF_BODY, PARTS, SPACING_V1

_FORGOTTEN = {"save_dir": "results", "save_logs_every": 1000, "max_episode_steps": 1_000_000_000, "seed": 0}
"""Keys that do not change the engine; an environment is shared by configurations that differ in these."""


@functools.cache
def _keys() -> frozenset[str]:
    return frozenset(_native.config_keys())


def known(config: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the keys that exist, with values; warns about others, which the kit does not read either."""
    strange = sorted(str(key) for key in config if key not in _keys())
    if strange:
        warnings.warn(
            f"configuration: {', '.join(strange)} {'is' if len(strange) == 1 else 'are'} not known and has no effect"
            if len(strange) == 1
            else f"configuration: {', '.join(strange)} are not known and have no effect",
            stacklevel=4,
        )
    return {key: value for key, value in config.items() if key in _keys() and value is not None}


def _touch(params: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the keys of a configuration that give the sensors of touch parameters."""
    scales = params["scales"]
    factors = {round(scale / SPACING_V1[body], 12) for body, scale in scales.items() if body in SPACING_V1}
    keys: dict[str, Any] = {"touch_active": True}
    for key, function in (("touch_function", "touch_function"), ("touch_response", "response_function")):
        # a name that the engine does not have is that of a method of the sense, which does without the engine
        known = _native.config_keys()[key]["choices"]
        keys[key] = params[function] if params[function] in known else known[-1]
    groups = {part: [body for body in SPACING_V1 if PART_OF_BODY[body] == part] for part in PARTS}
    for part, bodies in groups.items():
        on = [body in scales for body in bodies]
        if any(on) != all(on):
            raise ValueError(
                f"touch_params: {part} are partly with sensors; the engine turns the parts of the body on and off "
                "as a whole, with the keys touch_* of a configuration"
            )
        keys[f"touch_{part}"] = all(on)
    if len(factors) > 1 or any(body not in SPACING_V1 for body in scales):
        raise ValueError(
            "touch_params: these scales are not MIMo's own times one number; the engine takes that number as touch_scale"
        )
    keys["touch_scale"] = factors.pop() if factors else 1.0
    return keys


def _vision(params: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the keys of a configuration that give the eyes of vision parameters."""
    if set(params) != {"eye_left", "eye_right"}:
        raise ValueError(
            "vision_params: the engine draws eye_left and eye_right for the observation; "
            "other cameras are drawn by env.mujoco_renderer.render(camera_name=...)"
        )
    sizes = {(eye["width"], eye["height"]) for eye in params.values()}
    if len(sizes) == 1 and len(set(*sizes)) == 1:
        return {"vision_active": True, "vision_resolution": sizes.pop()[0]}
    keys: dict[str, Any] = {"vision_active": True}
    for side in ("left", "right"):
        for extent in ("width", "height"):
            keys[f"vision_{extent}_{side}"] = params[f"eye_{side}"][extent]
    return keys


def _actuators(keys: dict[str, Any], scene: Scene) -> None:
    """Takes the actuators from the scene, which the configuration must be able to drive."""
    keys.update(scene.keys)
    wants_servos = keys.get("actuation_model") == "positional"
    if scene.servos is not None and scene.servos != wants_servos:
        has, needs = ("position servos", "motors") if scene.servos else ("motors", "position servos")
        raise ValueError(
            f"actuation_model: {keys.get('actuation_model', 'spring_damper')} needs {needs}, but the scene has {has}: "
            "train with this configuration first, or give it a save_dir of its own"
        )


def engine_config(
    config: Mapping[str, Any],
    scene: Scene,
    *,
    behavior: str,
    frame_skip: int,
    size: int,
    touch: Mapping[str, Any] | None,
    vision: Mapping[str, Any] | None,
    balance: Mapping[str, Any] | None,
    actuation: str,
) -> dict[str, Any]:
    """Returns the complete configuration of the engine for the arguments of MIMo's constructor."""
    keys = {"compat": "reference", **known(config)}
    keys.update(_FORGOTTEN)
    keys.update(frame_skip=frame_skip, render_size=size, actuation_model=actuation)
    keys["vestibular_active"] = balance is not None
    keys.update(_touch(touch) if touch is not None else {"touch_active": False})
    keys.update(_vision(vision) if vision is not None else {"vision_active": False})
    _actuators(keys, scene)
    if scene.version == "v2":
        if behavior == "self_touch":
            raise ValueError("behavior: self_touch has MIMo v1 here, but the scene has MIMo v2")
        behavior = "hand_regard"
    elif behavior == "hand_regard":
        raise ValueError("behavior: hand_regard has MIMo v2 here, but the scene has MIMo v1")
    keys["behavior"] = behavior
    return dict(_native.config_from_mapping(keys))


@functools.lru_cache(maxsize=2)
def _blueprint(config: str, assets: Path | None) -> _native.Blueprint:
    return _native.Blueprint(json.loads(config), assets)


def blueprint(config: Mapping[str, Any], assets: Path | None) -> _native.Blueprint:
    """Returns the compiled scene of a configuration; the last two are kept."""
    return _blueprint(json.dumps(dict(config), sort_keys=True), assets)
