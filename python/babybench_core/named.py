"""Elements by number and by name, as MuJoCo's models and states have them: ``model.body("hip").mass``."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .hints import nearest

KINDS = {
    "body": "body",
    "joint": "joint",
    "jnt": "joint",
    "geom": "geom",
    "site": "site",
    "camera": "camera",
    "cam": "camera",
    "equality": "equality",
    "eq": "equality",
    "tendon": "tendon",
    "actuator": "actuator",
    "sensor": "sensor",
    "texture": "texture",
    "tex": "texture",
    "material": "material",
    "mat": "material",
}
"""The methods that find elements, and the kind of each."""

PREFIX = {"joint": "jnt", "camera": "cam", "equality": "eq", "texture": "tex", "material": "mat"}
"""Prefix of the names of a kind's arrays, where it differs from the kind."""


def widened(values: NDArray[Any], width: int) -> NDArray[Any]:
    """Returns rows of a width, padded with zeros."""
    rows = values.reshape(len(values), -1) if len(values) else np.zeros((0, width), values.dtype)
    wide = np.zeros((len(rows), width), dtype=rows.dtype)
    wide[:, : rows.shape[1]] = rows
    return wide


def span(array: NDArray[Any], starts: NDArray[Any], number: int) -> NDArray[Any]:
    """Returns the part of an array that belongs to an element, from its start to that of the next one."""
    ends = [*starts[1:], len(array)]
    return array[starts[number] : ends[number]]


class Element:
    """One element of a model or of a state: its id, its name, and its rows of the arrays."""

    def __init__(self, owner: Any, kind: str, number: int, name: str) -> None:
        """Makes the element of a kind."""
        self.__dict__.update(_owner=owner, _kind=kind, id=number, name=name)

    def __getattr__(self, name: str) -> Any:
        """Returns the element's part of an array."""
        if name.startswith("_"):
            raise AttributeError(name)
        return self._owner._part(self._kind, self.id, name)

    def __setattr__(self, name: str, value: Any) -> None:
        """Writes the element's part of an array."""
        getattr(self, name)[...] = value

    def __repr__(self) -> str:
        return f"<{self._kind} {self.id} {self.name!r}>"


class Named(ABC):
    """Look-up of elements by number and by name, shared by models and states.

    Classes that show an environment under MuJoCo's names register with the class that they stand for, so that ``isinstance``
    holds.
    """

    _names: dict[str, list[str]]
    _numbers: dict[str, dict[str, int]]

    def _find(self, kind: str, key: int | str | bytes) -> tuple[int, str]:
        names = self._names[kind]
        if isinstance(key, bytes):
            key = key.decode()
        if isinstance(key, str):
            number = self._numbers[kind].get(key)
            if number is None:
                known = sorted(name for name in names if name)
                raise KeyError(f"Invalid name '{key}'{nearest(key, known) or '.'} Valid names: {known}")
            return number, key
        number = int(key)
        if not 0 <= number < len(names):
            raise IndexError(f"Invalid index {number}. Valid indices from 0 to {len(names) - 1}")
        return number, names[number]


def numbers(names: dict[str, list[str]]) -> dict[str, dict[str, int]]:
    """Returns the ids of all elements that have a name, by kind."""
    return {kind: {name: number for number, name in enumerate(found) if name} for kind, found in names.items()}


def accessor(kind: str) -> Callable[..., Element]:
    """Makes the method that finds the elements of a kind."""

    def access(self: Any, key: int | str | bytes = 0) -> Element:
        number, name = self._find(kind, key)
        return Element(self, kind, number, name)

    access.__doc__ = f"Returns the {kind} with an id or a name."
    return access
