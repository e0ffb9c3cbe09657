"""The scenes of this package, and those of programs, by path."""

from __future__ import annotations

import os
from pathlib import Path

from . import tables
from .assets import assets_folder, assets_path
from .scene import Scene, read_any_scene, read_scene

SCENE_NAME = "babybench.xml"
"""The scene of environments without a configuration."""

_DEFAULT_SCENE = Scene(
    keys={"scene": "base", **{f"act_{part}": True for part in tables.PARTS}},
    place={"pos": [0.0, 0.0, 0.075]},
    servos=False,
)
"""Description of :data:`SCENE_NAME`."""


def prepare_scene(model_path: str | os.PathLike[str]) -> None:
    """Writes a scene of this package on first use."""
    path = Path(model_path)
    for version in (2, 3):
        if not path.is_file() and path.parent == assets_path(version):
            assets_folder(version)


def known_scene(model_path: str | os.PathLike[str], any_scene: bool) -> Scene:
    """Returns the data about a scene, which is written first if it is one of this package."""
    path = Path(model_path)
    prepare_scene(path)
    if path.is_file():
        return read_any_scene(path) if any_scene else read_scene(path)
    if path.name == SCENE_NAME:
        return _DEFAULT_SCENE
    raise FileNotFoundError(f"File {path} does not exist")
