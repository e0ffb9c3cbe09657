"""Scenes as files: the contents of a ``scene.xml``, and the location of the assets that it includes."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from babybench_core import _native

from .flat import flat
from .tables import GROUND, PARTS, VERSIONS

_INCLUDE = re.compile(r'<include\s+file="([^"]*)"\s*(?:/>|>\s*</include>)')
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_ROOT = re.compile(r'<body\s+name="mimo_location"\s+([^>]*)>')
_SCENE_KEY = re.compile(r"""^\s*["']?scene["']?\s*:""", re.MULTILINE)
_BUILT = {"mujoco", "worldbody", "body", "freejoint", "include"}
"""Elements of a document that includes everything else, as BabyBench builds it."""

UNSERVED = (
    "{path}: {what}; BabyBench's own environments take the scenes that babybench.build_xml.build writes. "
    "Change the files that such a scene includes (they are read from where it names them), or subclass "
    "mimoEnv.envs.mimo_env.MIMoEnv, which takes any scene with MIMo"
)


class SceneError(ValueError):
    """A scene that is not one of BabyBench's."""


@dataclass(frozen=True)
class Document:
    """A document that is compiled as it stands."""

    text: str
    folder: Path
    """The folder of the files that it names."""
    files: Mapping[str, bytes] = field(default_factory=dict)
    """Contents of files by name, which replace those of the file system."""
    path: Path | None = None
    """The file that it was read from; ``None`` if a program has compiled it."""

    @classmethod
    def at(cls, path: Path) -> Document:
        """Reads a file."""
        path = path.resolve()
        return cls(path.read_text(encoding="utf-8"), path.parent, path=path)


@dataclass
class Scene:
    """The content of a ``scene.xml``."""

    keys: dict[str, Any] = field(default_factory=dict)
    """Keys of a configuration that the scene decides: ``scene``, ``act_*``."""
    version: str = "v1"
    """The version of MIMo."""
    assets: Path | None = None
    """The folder of the files that it includes; ``None`` if they do not exist."""
    place: dict[str, list[float]] | None = None
    """MIMo's place, if it is not BabyBench's: ``pos``, m."""
    servos: bool | None = None
    """Whether its actuators are position servos; ``None`` if it has no actuators."""
    third: bool = False
    """Whether it has MIMo 3, whose chest is a body of its own."""
    document: Document | None = None
    """The document, if it is compiled as it stands: any scene with MIMo."""


def _attributes(text: str) -> dict[str, str]:
    return dict(re.findall(r'(\w+)="([^"]*)"', text))


def _numbers(text: str) -> list[float]:
    return [float(number) for number in text.split()]


def _place(path: Path, text: str, scene: str) -> dict[str, list[float]] | None:
    """Returns MIMo's place, if it is not the scene's own."""
    root = _ROOT.search(text)
    if root is None:
        raise SceneError(UNSERVED.format(path=path, what="it has no body mimo_location"))
    found, usual = _attributes(root.group(1)), _attributes(GROUND[scene])
    position = _numbers(found.pop("pos", "0 0 0"))
    usual_position = _numbers(usual.pop("pos"))
    if {name: _numbers(value) for name, value in found.items()} != {
        name: _numbers(value) for name, value in usual.items()
    }:
        raise SceneError(UNSERVED.format(path=path, what="its body mimo_location is turned another way"))
    return None if position == usual_position else {"pos": position}


def _complete(path: Path, text: str) -> Scene:
    """Reads a scene that holds everything itself, with its configuration in a comment, as this library writes it."""
    comment = _COMMENT.match(text)
    if comment is None or _SCENE_KEY.search(comment.group(0)) is None:
        raise SceneError(UNSERVED.format(path=path, what="it includes nothing of BabyBench"))
    try:
        config = _native.config_from_yaml(comment.group(0)[4:-3], str(path))
    except ValueError as error:
        raise SceneError(UNSERVED.format(path=path, what="it includes nothing of BabyBench")) from error
    keys = {key: config[key] for key in ("scene", *(f"act_{part}" for part in PARTS))}
    servos = config["actuation_model"] == "positional"
    return Scene(keys=keys, version=VERSIONS[config["behavior"]], servos=servos)


def read_scene(path: Path) -> Scene:
    """Reads the contents of a ``scene.xml``.

    Raises:
        FileNotFoundError: There is no such file.
        SceneError: It is not one of BabyBench's.
    """
    text = path.read_text(encoding="utf-8")
    body = _COMMENT.sub("", text)
    names = [Path(file) for file in _INCLUDE.findall(body)]
    if not any(name.parent.name == "babybench" for name in names):
        return _complete(path, text.lstrip())
    others = sorted(set(re.findall(r"<(\w+)", body)) - _BUILT)
    strange = [str(name) for name in names if name.parent.name != "babybench"]
    if others or strange:
        what = f"it has {', '.join(f'<{name}>' for name in others) or 'includes ' + ', '.join(strange)}"
        raise SceneError(UNSERVED.format(path=path, what=what))
    stems = [name.stem for name in names]
    version = "v2" if "mimo_v2" in stems else "v1"
    actuators = [
        stem.removesuffix("_v1").removesuffix("_v2").split("_")
        for stem in stems
        if stem.startswith(("motor_", "position_"))
    ]
    scene = next((name for name in ("crib", "cubes") if name in stems), "base")
    keys: dict[str, Any] = {"scene": scene}
    keys.update({f"act_{part}": any(part == found[1] for found in actuators) for part in PARTS})
    folder = (path.parent / names[0]).parent.parent
    return Scene(
        keys=keys,
        version=version,
        assets=folder if (folder / "babybench" / "base.xml").is_file() else None,
        place=_place(path, body, scene),
        servos=any(found[0] == "position" for found in actuators) if actuators else None,
    )


def read_any_scene(path: Path) -> Scene:
    """Reads the contents of any document with MIMo.

    Raises:
        FileNotFoundError: There is no such file.
    """
    try:
        return read_scene(path)
    except (SceneError, KeyError):
        return document_scene(Document.at(path), _bodies(path))


def document_scene(document: Document, bodies: Set[str | None]) -> Scene:
    """Returns the scene of a document with these bodies."""
    return Scene(version="v2" if "right_ffdistal" in bodies else "v1", third=bodies >= _CHEST, document=document)


_CHEST = {"chest", "upper_body", "lower_body"}
"""Bodies of which only MIMo 3 has all."""


def _bodies(path: Path) -> set[str | None]:
    """Returns the names of the bodies in a document."""
    try:
        return {body.get("name") for body in flat(path).iter("body")}
    except (OSError, ValueError, ElementTree.ParseError):
        return set()  # the compiler reports the fault


def kit_assets() -> Path | None:
    """Returns the assets of the first checkout of the starter kit on ``sys.path``, if there is one."""
    for entry in sys.path:
        folder = Path(entry or ".") / "MIMo" / "mimoEnv" / "assets"
        if (folder / "babybench" / "base.xml").is_file():
            return folder.resolve()
    return None
