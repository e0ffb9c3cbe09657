"""Changes of the model of an environment: whole arrays, or the rows of elements by their names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from babybench_core import _native, hints

Changes = Mapping[str, Union[npt.ArrayLike, Mapping[str, npt.ArrayLike]]]
"""Arrays of the model by MuJoCo's names, each as a whole or as a mapping from names of elements to their rows."""

_KINDS = {"body": "body", "jnt": "joint", "geom": "geom", "actuator": "actuator", "eq": "equality"}
"""Kinds of elements by what the names of their arrays begin with."""


def arrays(
    changes: object, present: Callable[[str], npt.NDArray[Any]], blueprint: _native.Blueprint
) -> dict[str, npt.NDArray[Any]]:
    """Returns whole arrays; elements that a mapping does not name keep their rows.

    Raises:
        TypeError: Something that is not a mapping of names.
        KeyError: The array or element does not exist.
        ValueError: Numbers of another shape.
    """
    if not isinstance(changes, Mapping):
        raise TypeError(f"the changes of the model are {changes!r}, expected a mapping from names of arrays to numbers")
    return {name: _whole(name, value, present, blueprint) for name, value in changes.items()}


def _whole(
    name: object, value: Any, present: Callable[[str], npt.NDArray[Any]], blueprint: _native.Blueprint
) -> npt.NDArray[Any]:
    if not isinstance(name, str):
        raise TypeError(f"{name!r} is not the name of an array of the model")
    if not isinstance(value, Mapping):
        return np.asarray(value)
    array = present(name)
    prefix = name.split("_")[0]
    if prefix == "dof":
        kind, rows = "joint", _rows_of_joints(blueprint)
    elif prefix in _KINDS:
        kind = _KINDS[prefix]
        rows = {found: [k] for k, found in enumerate(blueprint.model_names[kind]) if found}
    else:
        raise TypeError(f"{name} is not an array with a row for each element: give it numbers, not a mapping")
    for element, numbers in value.items():
        if element not in rows:
            known = [known_name for known_name in rows if known_name]
            raise KeyError(f"{name}: there is no {kind} {element!r}{hints.nearest(str(element), known)}")
        try:
            array[rows[element]] = numbers
        except ValueError:
            shape = array[rows[element][0]].shape
            raise ValueError(f"{name}: {element!r} has numbers of the shape {shape}, got {numbers!r}") from None
    return array


def _rows_of_joints(blueprint: _native.Blueprint) -> dict[str, list[int]]:
    joints = blueprint.model_names["joint"]
    rows: dict[str, list[int]] = {}
    for row, joint in enumerate(blueprint.model_array("dof_jntid")):
        rows.setdefault(joints[joint], []).append(row)
    return rows


def of_options(options: Union[Mapping[str, Any], None]) -> Any:
    """Returns the changes that the options of a reset ask for, or nothing."""
    return None if options is None else options.get("model")


def of_vector(wanted: Any, count: int) -> list[Any]:
    """Returns the changes of each environment of a vector, from one mapping for all or a list with one or ``None`` for each.

    Raises:
        TypeError: Something else.
        ValueError: A list of another length.
    """
    if wanted is None or isinstance(wanted, Mapping):
        return [wanted] * count
    try:
        each = list(wanted)
    except TypeError:
        raise TypeError(f"options['model'] is {wanted!r}, expected a mapping or a list of {count} of them") from None
    if len(each) != count:
        raise ValueError(f"options['model'] has {len(each)} entries, but there are {count} environments")
    return each
