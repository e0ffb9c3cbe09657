"""Converts the kit's configurations to the engine's."""

from __future__ import annotations

import functools
import json
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from babybench_core import _native

from .scene import Scene
from .tables import PART_OF_BODY, PARTS, SPACING_V1

_FORGOTTEN = {"save_dir": "results", "save_logs_every": 1000, "max_episode_steps": 1_000_000_000, "seed": 0}
"""Keys that do not change the engine: configurations that differ only in these share a compiled scene."""


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


def _names(params: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the keys of a configuration that name the functions in touch parameters."""
    keys: dict[str, Any] = {"touch_active": True}
    for key, function in (("touch_function", "touch_function"), ("touch_response", "response_function")):
        # a name that the engine does not have is a method of the sense, which then computes without the engine
        known = _native.config_keys()[key]["choices"]
        keys[key] = params[function] if params[function] in known else known[-1]
    return keys


def _touch(params: Mapping[str, Any]) -> dict[str, Any] | None:
    """Returns the keys of a configuration for the sensors in touch parameters; ``None`` if no keys can express them."""
    scales = params["scales"]
    factors = {round(scale / SPACING_V1[body], 12) for body, scale in scales.items() if body in SPACING_V1}
    keys = _names(params)
    for part in PARTS:
        on = [body in scales for body in SPACING_V1 if PART_OF_BODY[body] == part]
        if any(on) != all(on):
            return None
        keys[f"touch_{part}"] = all(on)
    if len(factors) != 1 or any(body not in SPACING_V1 for body in scales):
        return None
    keys["touch_scale"] = factors.pop()
    return keys


def _own_touch(params: Mapping[str, Any]) -> tuple[dict[str, Any], list[tuple[str, float]]]:
    """Returns the keys of a configuration for touch parameters, and any distances between sensors."""
    keys = {**_names(params), **{f"touch_{part}": True for part in PARTS}, "touch_scale": 1.0}
    return keys, [(str(body), float(scale)) for body, scale in params["scales"].items()]


def _vision(params: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the keys of a configuration that give the eyes of vision parameters."""
    if set(params) != {"eye_left", "eye_right"}:
        return {"vision_active": False}  # the sense draws these cameras itself
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


@dataclass
class Settings:
    """The part of MIMo's constructor arguments that the engine needs."""

    config: dict[str, Any]
    """The complete configuration."""
    spacing: list[tuple[str, float]] | None = None
    """Bodies and the distances between their touch sensors, m, if no configuration gives them."""


def engine_settings(
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
    age: float | None = None,
) -> Settings:
    """Returns the part of MIMo's constructor arguments that the engine needs."""
    keys = {"compat": "reference", **known(config)}
    keys.update(_FORGOTTEN)
    keys.update(frame_skip=frame_skip, render_size=size, actuation_model=actuation)
    if age is not None:
        keys["age"] = age
    if scene.third:
        keys["mimo_version"] = 3
    keys["vestibular_active"] = balance is not None
    keys.update(_vision(vision) if vision is not None else {"vision_active": False})
    spacing = None
    if touch is None or not touch["scales"]:
        keys["touch_active"] = False
    elif scene.document is None and (usual := _touch(touch)) is not None:
        keys.update(usual)
    elif behavior != "none":
        raise ValueError(
            "touch_params: BabyBench's behaviors have MIMo's own distances between sensors times one number (touch_scale), on "
            "whole parts of the body (touch_*); subclass mimoEnv.envs.mimo_env.MIMoEnv for others"
        )
    else:
        own, spacing = _own_touch(touch)
        keys.update(own)
    if scene.document is None:
        _actuators(keys, scene)
        behavior = _behavior(behavior, scene)
    keys["behavior"] = behavior
    return Settings(dict(_native.config_from_mapping(keys)), spacing)


def _behavior(behavior: str, scene: Scene) -> str:
    """Returns the behavior of the engine, which has one version of MIMo."""
    if scene.version == "v2":
        if behavior == "self_touch":
            raise ValueError("behavior: self_touch has MIMo v1 here, but the scene has MIMo v2")
        return "hand_regard"
    if behavior == "hand_regard":
        raise ValueError("behavior: hand_regard has MIMo v2 here, but the scene has MIMo v1")
    return behavior


@functools.lru_cache(maxsize=2)
def _blueprint(config: str, assets: Path | None) -> _native.Blueprint:
    return _native.Blueprint(json.loads(config), assets)


def blueprint(settings: Settings, scene: Scene) -> _native.Blueprint:
    """Returns the compiled scene of a configuration; the last two of BabyBench's are kept."""
    config = settings.config
    if scene.document is None and settings.spacing is None:
        return _blueprint(json.dumps(config, sort_keys=True), scene.assets)
    if scene.document is None:
        return _native.Blueprint.by_hand(config, touch_spacing=settings.spacing or [], assets=scene.assets)
    document = scene.document
    return _native.Blueprint.by_hand(
        config,
        document=document.text,
        version=scene.version,
        folder=document.folder,
        files=dict(document.files),
        touch_spacing=settings.spacing or [],
    )
