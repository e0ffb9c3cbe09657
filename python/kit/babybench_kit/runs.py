"""Environments that are trained and evaluated in a folder: ``babybench.utils.make_env``."""

from __future__ import annotations

import importlib
import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium as gym

from babybench_core import _native, hints

from . import swap
from .assets import assets_folder
from .build_xml import build
from .scene import kit_assets
from .tables import PARTS

ENVS = {"none": "BabyBench", "self_touch": "BabyBench-SelfTouch", "hand_regard": "BabyBench-HandRegard"}
"""The id of each behavior's environment."""


def make_dir(dir_name: str | os.PathLike[str]) -> None:
    """Makes a folder, if it does not exist."""
    Path(dir_name).mkdir(parents=True, exist_ok=True)


def make_save_dirs(save_dir: str | os.PathLike[str]) -> None:
    """Makes the folder of a run, with ``logs`` and ``videos`` in it."""
    for name in ("logs", "videos"):
        make_dir(Path(save_dir) / name)


def _mimo() -> str | None:
    """Imports ``mimoEnv``, which registers the ids; returns its folder if it is MIMo's own."""
    module = importlib.import_module("mimoEnv")
    if swap.is_own(module):
        return None
    folder = Path(module.__file__ or "").parent
    swap.tell("mimoEnv", str(folder))
    return str(folder / "assets")


_NEEDED = (
    "behavior",
    "scene",
    "actuation_model",
    *(f"act_{part}" for part in PARTS),
    "save_dir",
    "save_logs_every",
    "max_episode_steps",
    "frame_skip",
    "render_size",
)
"""Keys that a scene and a run need."""


def _complete(config: Any) -> dict[str, Any]:
    """Returns a configuration with the defaults of keys that a scene and a run need."""
    if not isinstance(config, Mapping):
        raise TypeError(
            f"make_env needs a configuration, a dict, not {type(config).__name__}: "
            "make_env(yaml.safe_load(open('config.yml'))), or babybench.make('self_touch') for an example"
        )
    keys = _native.config_keys()
    return {**{key: keys[key]["default"] for key in _NEEDED}, **config}


def make_env(config: Mapping[str, Any] | None = None, training: bool = True) -> Any:
    """Makes the environment of a configuration.

    Training writes the scene to ``save_dir/scene.xml`` and logs to ``save_dir/logs``; evaluation takes the scene that is there.
    The files that the scene includes are those of the first checkout of the kit on ``sys.path``, or else the library's own.

    Args:
        config: The configuration. Missing keys get their default (``babybench.config_keys()``), except for those of the
            senses: without them the senses are the kit's own.
        training: Whether this is training.

    Warns:
        UserWarning: Another process trains into this folder, or a log of an earlier run is there, which will be replaced.

    Raises:
        AssertionError: There is no scene to evaluate.
        TypeError: ``config`` is not a mapping.
        ValueError: A behavior that the kit does not have.
    """
    config = _complete(config)
    behavior = config["behavior"]
    if behavior not in ENVS:
        meant = hints.nearest(str(behavior), ENVS)
        raise ValueError(f"configuration: behavior is {behavior!r}, expected one of {', '.join(ENVS)}{meant}")
    scene_path = Path(config["save_dir"]) / "scene.xml"
    own_assets = _mimo()
    folder = None
    if training is True:
        make_save_dirs(config["save_dir"])
        folder = _own(config["save_dir"])
        assets = own_assets or str(kit_assets() or assets_folder())
        scene_path.write_text(build(config, path_to_assets=assets) + "\n", encoding="utf-8")
    else:
        if not scene_path.parent.exists():
            raise AssertionError(f"{scene_path.parent}: there is no such folder; was this configuration trained?")
        if not scene_path.exists():
            raise AssertionError(f"{scene_path}: there is no such file; was this configuration trained?")
    env: Any = gym.make(
        ENVS[behavior],
        model_path=str(scene_path.resolve()),
        actuation_model=config["actuation_model"],
        max_episode_steps=config["max_episode_steps"],
        frame_skip=config["frame_skip"],
        width=config["render_size"],
        height=config["render_size"],
        config=config,
        training=training,
    )
    env.unwrapped.run_folder = folder
    return env


def _own(save_dir: str | os.PathLike[str]) -> _native.Folder | None:
    """Claims the folder of a run, and warns if the logs of two runs would mix.

    The kit continues without a message, so these are warnings where the command line refuses.
    """
    log = Path(save_dir) / "logs" / "training.pkl"
    try:
        folder = _native.Folder(save_dir)
    except OSError as error:
        warnings.warn(
            f"make_env: {error}: both write {log}, and the records of the one that writes last remain", stacklevel=3
        )
        return None
    if log.exists() and log.stat().st_size > 0:
        warnings.warn(
            f"make_env: {log} is the log of an earlier run, which this one replaces when it logs; choose another save_dir to "
            "keep it",
            stacklevel=3,
        )
    return folder
