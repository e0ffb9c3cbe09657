"""MIMo 3 at other ages: ``mimo_infant.growth``."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from babybench_core import _native

from ..assets import scene_path
from ..growth import adjust_mimo_to_age, delete_growth_scene, get_version
from ..known_scenes import known_scene
from ..settings import Settings, blueprint

__all__ = [
    "adjust_mimo_to_age",
    "calc_volume",
    "create_growth_scene",
    "delete_growth_scene",
    "get_growth_params",
    "get_version",
    "growth_function",
    "mj_unit",
]

_SCENES = {"v1": "benchmark_scene.xml", "v2": "benchmarkv2_scene.xml"}
_TRUNK = frozenset({"lb", "cb", "ub1", "ub2", "ub3", "head"})
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_HALVES = {"len": 0.5, "circ": 0.5 / np.pi}


def growth_function(x: ArrayLike, a: float, b: float, c: float) -> Any:
    """Returns a measure at an age, ``a ln(x + b) + c``."""
    return a * np.log(np.asarray(x) + b) + c


def calc_volume(size: Sequence[float], geom_type: str) -> float:
    """Returns the volume of a geom of a size, m^3: ``sphere``, ``capsule``, ``box`` or ``cylinder``.

    Raises:
        ValueError: The type is another one.
    """
    if geom_type == "sphere":
        return float(4 / 3 * np.pi * size[0] ** 3)
    if geom_type == "capsule":
        return float(np.pi * size[0] ** 2 * (4 / 3 * size[0] + 2 * size[1]))
    if geom_type == "cylinder":
        return float(2 * np.pi * size[0] ** 2 * size[1])
    if geom_type == "box":
        return float(8 * np.prod(size[:3]))
    raise ValueError(f"geom_type is {geom_type!r}, expected sphere, capsule, box or cylinder")


def mj_unit(nums: ArrayLike, unit: str, measure: str) -> Any:
    """Returns measures as sizes of geoms, m: half of a length (``len``), the radius of a circumference (``circ``).

    Raises:
        ValueError: The unit is not ``m``, ``cm`` or ``mm``, or the measure is another one.
    """
    if unit not in _METRES or measure not in _HALVES:
        raise ValueError(f"unit is {unit!r} and measure {measure!r}, expected m, cm or mm, and len or circ")
    sizes = np.asarray(nums) * _METRES[unit] * _HALVES[measure]
    return sizes if np.ndim(nums) else float(sizes)


def get_growth_params(age: float, mimo_version: str, custom: Any = None) -> dict[str, dict[str, Any]]:
    """Returns MIMo's sizes at an age, months, by name.

    They are size and position of ``geoms``, positions of ``bodies``, ``joints`` and ``sites`` in their bodies, m, and the
    ``gears`` of motors.

    Raises:
        ValueError: MIMo has no size at this age, or the version is neither ``v1`` nor ``v2``.
        NotImplementedError: ``custom`` is given.
    """
    if custom is not None:
        raise NotImplementedError(
            "custom: give measurements as keys of a configuration (babybench.make(..., head_circumference=...))"
        )
    if mimo_version not in _SCENES:
        raise ValueError(f"mimo_version is {mimo_version!r}, expected v1 or v2")
    scene = known_scene(scene_path(_SCENES[mimo_version], 3), True)
    config = {"compat": "reference", "age": float(age), "mimo_version": 3}
    config.update(touch_active=False, vision_active=False, vestibular_active=False)
    model = blueprint(Settings(dict(_native.config_from_mapping(config))), scene)
    read, names = model.model_array, model.model_names
    sizes, positions = read("geom_size"), read("geom_pos")
    return {
        "geoms": {
            name: {"size": sizes[k].tolist(), "pos": positions[k].tolist()}
            for k, name in enumerate(names["geom"])
            if name.startswith("geom:") or name in _TRUNK
        },
        "bodies": _rows(names["body"], read("body_pos")),
        "joints": _rows(names["joint"], read("jnt_pos"), "robot:"),
        "sites": _rows(names["site"], read("site_pos")),
        "gears": {name: float(gear) for name, gear in zip(names["actuator"], read("actuator_gear"))},
    }


def _rows(names: Sequence[str], rows: NDArray[Any], prefix: str = "") -> dict[str, list[float]]:
    return {name: row.tolist() for name, row in zip(names, rows) if name and name.startswith(prefix)}


def create_growth_scene(
    growth_params: Mapping[str, Any], path_scene: str | os.PathLike[str], long_format: bool = True
) -> NoReturn:
    """Raises an error: scenes grow by age.

    Raises:
        NotImplementedError: Always.
    """
    raise NotImplementedError(
        f"create_growth_scene: {Path(path_scene).name} grows by age here; call adjust_mimo_to_age(age, path_scene)"
    )
