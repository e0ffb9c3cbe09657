"""Compiled scenes, which environments of one configuration share."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional, Union
from weakref import WeakValueDictionary

from babybench_core import hints
from babybench_core._native import Blueprint, config_examples, config_from_mapping, config_from_yaml

ConfigLike = Union[Mapping[str, object], str, "os.PathLike[str]", None]
"""A configuration: its keys, the name of an example, the path of a YAML file, or nothing for the defaults."""


class UnexpectedKeyword(TypeError, ValueError):
    """A keyword that is not a key of the configuration.

    It is a ``ValueError``, like the same key in a file, and a ``TypeError``, which tells libraries that offer an environment
    optional arguments to leave them out.
    """


_shared: WeakValueDictionary[tuple[object, ...], Blueprint] = WeakValueDictionary()
_populations: WeakValueDictionary[tuple[object, ...], Blueprint] = WeakValueDictionary()
"""The infant made last of each population that environments use."""


def read_config(config: ConfigLike = None, **keys: object) -> dict[str, Any]:
    """Returns all keys of a configuration with their values.

    Args:
        config: A mapping, the name of an example (``self_touch``, ``hand_regard``, ``test_installation``, or a task: ``reach``,
            ``standup``, ``selfbody``, ``catch``, ``roll_over``, ``mobile``, ``play``), the path of a YAML file, or nothing for
            the defaults. The path of a scene is relative to the folder of that file.
        **keys: Keys that replace those of ``config``; a path is relative to the working directory.

    Raises:
        FileNotFoundError: The file does not exist.
        ValueError: An unknown key or a value that is not allowed; the text names it and what is allowed.
        TypeError: A value of a type that no key has, or a keyword that is not a key.
    """
    found: Mapping[str, object]
    if config is None:
        found = {}
    elif isinstance(config, Mapping):
        found = config
    elif not isinstance(config, (str, os.PathLike)):
        raise TypeError(
            f"a configuration is a mapping, the name of an example, or the path of a YAML file, not the "
            f"{type(config).__name__} {config!r} (a list of configurations makes a VectorEnv)"
        )
    else:
        examples = config_examples()
        found = examples.get(os.fspath(config)) or _read_file(Path(config), list(examples))
    try:
        return config_from_mapping({**found, **keys})
    except ValueError as error:
        for key in keys:
            if f"unknown key `{key}`" in str(error):
                raise UnexpectedKeyword(f"got an unexpected keyword argument {key!r}: {error}") from None
        raise


def _read_file(path: Path, examples: list[str]) -> dict[str, Any]:
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        choices = ", ".join(examples)
        meant = hints.nearest(str(path), examples)
        text = f"there is no file {str(path)!r}, and no example of that name; examples are {choices}{meant}"
        raise FileNotFoundError(text) from None
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: {error}; save the file as UTF-8") from None
    return config_from_yaml(text, str(path), path.parent)


def blueprint(config: Mapping[str, object], assets: Optional[Union[str, os.PathLike[str]]] = None) -> Blueprint:
    """Compiles a scene, or returns the one that environments of the same configuration already use.

    A custom scene is compiled each time, because its files may have changed.

    Args:
        config: A configuration; missing keys get their default.
        assets: A folder with MJCF and textures laid out like the kit's, instead of those that come with the package.
    """
    full = config_from_mapping(config)
    where = None if assets is None else os.path.realpath(assets)
    key = (repr(full), where)
    if str(full["scene"]).endswith(".xml"):
        return Blueprint(full, where)
    found = _shared.get(key)
    if found is None:
        found = _shared[key] = _infant(full, where) if full["body_random"] else Blueprint(full, where)
    return found


def _infant(full: dict[str, Any], where: Optional[str]) -> Blueprint:
    """Compiles a scene with an infant of a population, from the scene of another of them if there is one."""
    population = (repr({**full, "body_number": 0}), where)
    other = _populations.get(population)
    made = Blueprint(full, where) if other is None else other.with_body_number(full["body_number"])
    _populations[population] = made
    return made


def camera_of(blueprint: Blueprint, camera: Optional[str]) -> str:
    """Returns the requested camera, or that of the room. Tasks have none and show the left eye's view.

    Raises:
        ValueError: The camera does not exist.
    """
    cameras = blueprint.model_names["camera"]
    if camera is None:
        return "corner" if "corner" in cameras else cameras[0]
    if camera not in cameras:
        raise ValueError(f"camera is {camera!r}, expected one of {', '.join(cameras)}")
    return camera
