"""Changes to the model of an environment: whole arrays, or the rows of elements by their names."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from babybench_core import _native, hints

Changes = Mapping[str, Union[npt.ArrayLike, Mapping[str, npt.ArrayLike]]]
"""Arrays of the model by MuJoCo's names, each as a whole or as a mapping from names of elements to their rows."""

_KINDS = {
    "body": "body",
    "jnt": "joint",
    "geom": "geom",
    "site": "site",
    "cam": "camera",
    "actuator": "actuator",
    "eq": "equality",
}
"""Kinds of elements by the prefix of their arrays' names."""

_OF_DOFS = frozenset(
    {
        *("qvel", "qacc", "qfrc_applied", "qfrc_bias", "qfrc_passive", "qfrc_actuator", "qfrc_smooth", "qacc_smooth"),
        *("qfrc_constraint", "qacc_warmstart"),
    }
)
"""Arrays of the state with a row for each degree of freedom."""

_STATE_KINDS = {
    **dict.fromkeys(("xpos", "xquat", "xmat", "xipos", "ximat", "subtree_com", "cvel", "cacc"), "body"),
    **dict.fromkeys(("cfrc_ext", "cfrc_int", "xfrc_applied"), "body"),
    **dict.fromkeys(("xanchor", "xaxis"), "joint"),
    "ctrl": "actuator",
}
"""Kinds of elements of the other arrays of the state."""


def arrays(
    changes: object, present: Callable[[str], npt.NDArray[Any]], blueprint: _native.Blueprint
) -> dict[str, npt.NDArray[Any]]:
    """Returns whole arrays; elements that a mapping does not name keep their rows.

    Raises:
        TypeError: The changes are not a mapping of names.
        KeyError: The array or element does not exist.
        ValueError: Numbers have another shape.
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
    for element, numbers in value.items():
        rows = rows_of(name, element, blueprint)
        try:
            array[rows] = numbers
        except ValueError:
            shape = array[rows if isinstance(rows, int) else rows[0]].shape
            raise ValueError(f"{name}: {element!r} has numbers of the shape {shape}, got {numbers!r}") from None
    return array


def rows_of(name: str, element: object, blueprint: _native.Blueprint) -> Any:
    """Returns the row of an element in an array as a number, or the rows of a joint as a list.

    Raises:
        TypeError: The array does not have a row for each element.
        KeyError: There is no such element.
    """
    if name in _OF_DOFS or name.startswith("dof_"):
        joint = element_of(name, "joint", element, blueprint)
        return np.flatnonzero(np.asarray(blueprint.model_array("dof_jntid")) == joint).tolist()
    if name in ("qpos", "qpos0", "qpos_spring"):
        joint = element_of(name, "joint", element, blueprint)
        first, kind = blueprint.model_array("jnt_qposadr")[joint], blueprint.model_array("jnt_type")[joint]
        return list(range(int(first), int(first) + (7, 4, 1, 1)[int(kind)]))
    kind = _STATE_KINDS.get(name) or _KINDS.get(name.split("_")[0])
    if kind is None:
        raise TypeError(f"{name} is not an array with a row for each element: give it numbers, not a mapping")
    return element_of(name, kind, element, blueprint)


def element_of(name: str, kind: str, element: object, blueprint: _native.Blueprint) -> int:
    """Returns the number of an element by its name in the document; a geom may be given by the name of its part.

    Raises:
        KeyError: There is no such element.
    """
    names = names_of(kind, blueprint)
    for known_names in (names, part_names(blueprint) if kind == "geom" else []):
        if isinstance(element, str) and element and element in known_names:
            return known_names.index(element)
    known = [known_name for known_name in names if known_name]
    raise KeyError(f"{name}: there is no {kind} {element!r}{hints.nearest(str(element), known)}")


def element(wanted: Union[str, int], kind: str, blueprint: _native.Blueprint) -> int:
    """Returns the number of an element that is given by name or by number.

    Raises:
        KeyError: There is no such element.
    """
    if isinstance(wanted, str):
        return element_of(kind, kind, wanted, blueprint)
    count = len(blueprint.model_names[kind])
    number = operator.index(wanted)
    if not 0 <= number < count:
        raise KeyError(f"there is no {kind} {number}: their numbers are 0 to {count - 1}")
    return number


def part_names(blueprint: _native.Blueprint) -> list[str]:
    """Returns the part of each geom: the body, and the index among its geoms."""
    bodies = [blueprint.model_names["body"][b] for b in blueprint.model_array("geom_bodyid")]
    count = {body: bodies.count(body) for body in set(bodies)}
    seen: dict[str, int] = dict.fromkeys(bodies, 0)
    names = []
    for body in bodies:
        seen[body] += 1
        names.append(body if count[body] == 1 else f"{body} {seen[body]}/{count[body]}")
    return names


def names_of(kind: str, blueprint: _native.Blueprint) -> list[str]:
    """Returns the names of elements by id, as the document gives them; a geom without a name has that of its part."""
    names = list(blueprint.model_names[kind])
    if kind != "geom":
        return names
    taken = set(names)
    parts = (part if part not in taken else f"{part} (geom)" for part in part_names(blueprint))
    return [name or part for name, part in zip(names, parts)]


def read(
    name: str, state: Callable[[str], npt.NDArray[Any]], model: Callable[[str], npt.NDArray[Any]]
) -> npt.NDArray[Any]:
    """Returns an array of the state or of the model by its name.

    Raises:
        KeyError: There is no such array; the text has the nearest names.
    """
    if name in _native.Env.STATE_ARRAYS:
        return state(name)
    try:
        return model(name)
    except KeyError:
        known = [*_native.Env.STATE_ARRAYS, *_native.Blueprint.MODEL_ARRAYS, *_native.CHANGEABLE]
        raise KeyError(f"there is no array {name!r}{hints.nearest(name, known)}") from None


OPTIONS = ("age", "model")
"""The options of a reset of one environment."""


def options_of(options: object, known: Sequence[str] = OPTIONS) -> Mapping[str, Any]:
    """Returns the options of a reset.

    Raises:
        TypeError: The options are not a mapping.
        ValueError: There is no such option.
    """
    if options is None:
        return {}
    if not isinstance(options, Mapping):
        raise TypeError(f"the options of a reset are {options!r}, expected a mapping with {', '.join(known)}")
    for name in options:
        if name not in known:
            meant = hints.nearest(str(name), known)
            raise ValueError(
                f"options[{name!r}]: there is no such option of a reset; there are {', '.join(known)}{meant}"
            )
    return options


def of_vector(name: str, wanted: Any, count: int, one: type) -> list[Any]:
    """Returns one option per environment of a vector, from a single value for all or a list with one value each.

    Raises:
        TypeError: The value is neither.
        ValueError: The list has another length.
    """
    if wanted is None or isinstance(wanted, one):
        return [wanted] * count
    try:
        each = list(wanted)
    except TypeError:
        what = "a mapping" if one is Mapping else "a number"
        raise TypeError(f"options[{name!r}] is {wanted!r}, expected {what} or a list of {count} of them") from None
    if len(each) != count:
        raise ValueError(f"options[{name!r}] has {len(each)} entries, but there are {count} environments")
    return each


def whole(name: str, value: Any, least: int) -> int:
    """Returns a whole number of at least ``least``; NumPy's numbers are accepted.

    Raises:
        TypeError: The value is not a whole number.
        ValueError: The number is smaller.
    """
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}, expected a whole number") from None
    if number < least:
        raise ValueError(f"{name} is {number}, expected at least {least}")
    return number


def seed_of(seed: Any) -> Union[int, None]:
    """Returns a seed as a whole number; NumPy's numbers are accepted.

    Raises:
        TypeError: The value is not a whole number.
        ValueError: The number is below 0, or has more than 64 bits.
    """
    if seed is None:
        return None
    try:
        number = operator.index(seed)
    except TypeError:
        raise TypeError(f"seed is {seed!r}, expected a whole number or None") from None
    if not 0 <= number < 2**64:
        raise ValueError(f"seed is {number}, expected 0 to 2**64 - 1")
    return number
