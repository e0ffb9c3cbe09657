"""MIMo at other ages, as documents: ``mimoGrowth``."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from babybench_core import _native

from .flat import flat
from .scene import Document, read_any_scene
from .settings import Settings, blueprint

_TURNED = ("quat", "axisangle", "xyaxes", "zaxis", "euler", "fromto")
_MARK = "_babybench_age_"
"""Part of the name of each grown document, without which :func:`delete_growth_scene` deletes nothing."""


def _numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in np.ravel(values))


def _bodies(root: ElementTree.Element) -> Iterator[ElementTree.Element]:
    """Returns the bodies of a document in the order of their ids."""
    for world in root.iter("worldbody"):
        for child in world:
            yield from child.iter("body")


def grown(path: Path, age: float) -> ElementTree.Element:
    """Returns a document with its includes, in which MIMo has an age, months.

    Raises:
        ValueError: MIMo has no size at this age, or the document has bodies that are not written out.
    """
    path = path.resolve()
    scene = read_any_scene(path)
    scene.document = Document.at(path)
    config = {
        "compat": "reference",
        "age": float(age),
        "touch_active": False,
        "vision_active": False,
        "vestibular_active": False,
        "mimo_version": 3 if scene.third else 2,
    }
    model = blueprint(Settings(dict(_native.config_from_mapping(config))), scene)
    root, read = flat(path), model.model_array
    for compiler in root.iter("compiler"):
        compiler.set("inertiafromgeom", "auto")
    known, bodies = model.model_names["body"][1:], list(_bodies(root))
    if len(bodies) != len(known) or any(body.get("name") not in (None, name) for body, name in zip(bodies, known)):
        raise ValueError(
            f"{path}: MIMo can grow only in documents that write out all bodies, without frames and replicates"
        )
    parts: dict[str, dict[int, int]] = {"geom": {}, "joint": {}, "site": {}}
    owners = {"geom": read("geom_bodyid"), "joint": read("jnt_bodyid"), "site": read("site_bodyid")}
    for number, element in enumerate(bodies, 1):
        element.set("pos", _numbers(read("body_pos")[number]))
        if read("body_mass")[number] > 0:
            _set_inertia(element, read, number)
        for kind, owner in owners.items():
            first = parts[kind].setdefault(number, int(np.searchsorted(owner, number)))
            found = [child for child in element if child.tag in ((kind, "freejoint") if kind == "joint" else (kind,))]
            for at, child in enumerate(found, first):
                _set_part(child, kind, read, at)
    motors = [actuator for section in root.iter("actuator") for actuator in section]
    for number, actuator in enumerate(motors):
        if actuator.tag == "motor":
            actuator.set("gear", _numbers(read("actuator_gear")[number]))
    return root


def _set_inertia(body: ElementTree.Element, read: Any, number: int) -> None:
    for old in body.findall("inertial"):
        body.remove(old)
    values = {"pos": "body_ipos", "quat": "body_iquat", "mass": "body_mass", "diaginertia": "body_inertia"}
    inertial = ElementTree.Element("inertial", {key: _numbers(read(name)[number]) for key, name in values.items()})
    body.insert(0, inertial)


def _set_part(part: ElementTree.Element, kind: str, read: Any, number: int) -> None:
    if part.tag == "freejoint" or (kind == "joint" and part.get("type") == "free"):
        return
    if kind == "joint":
        part.set("pos", _numbers(read("jnt_pos")[number]))
        return
    if kind == "geom" and part.get("mesh") is not None:
        return
    for key in _TURNED:
        part.attrib.pop(key, None)
    for key in ("pos", "quat", "size"):
        part.set(key, _numbers(read(f"{kind}_{key}")[number]))


def adjust_mimo_to_age(
    age: float, path_scene: str | os.PathLike[str], custom: Any = None, create_log: bool = True
) -> str:
    """Writes a copy of a scene in which MIMo has an age, and returns its path.

    The copy has a name of its own, so programs that run at the same time do not disturb each other. Without a file:
    ``MIMoEnv(model_path, age=6)``.

    Args:
        age: Months, 0 to 24.
        path_scene: The scene.
        custom: Must be ``None``: measurements are keys of a configuration here.
        create_log: Not used: nothing is logged.

    Raises:
        FileNotFoundError: There is no such scene.
        ValueError: MIMo has no size at this age.
        NotImplementedError: ``custom`` is given.
    """
    if custom is not None:
        raise NotImplementedError(
            "custom: give measurements as keys of a configuration (babybench.make(..., head_circumference=...))"
        )
    path = Path(path_scene)
    if not path.is_file():
        raise FileNotFoundError(f"{path_scene} does not exist")
    root = grown(path, age)
    handle, name = tempfile.mkstemp(prefix=f"{path.stem}{_MARK}", suffix=".xml")
    with os.fdopen(handle, "wb") as file:
        ElementTree.ElementTree(root).write(file, encoding="utf-8")
    return name


def delete_growth_scene(growth_path_scene: str | os.PathLike[str]) -> None:
    """Deletes a scene that :func:`adjust_mimo_to_age` has written.

    Raises:
        ValueError: It did not write this file.
    """
    path = Path(growth_path_scene)
    if _MARK not in path.name:
        raise ValueError(f"{path} was not written by adjust_mimo_to_age, and is not deleted")
    path.unlink(missing_ok=True)


def get_version(path: str | os.PathLike[str]) -> str:
    """Returns the version of MIMo in a scene: ``v1`` or ``v2``, who has fingers."""
    return read_any_scene(Path(path)).version
