"""Contacts, as MuJoCo's states have them: arrays with an entry for each, or one by one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray


class Contact:
    """One contact, as MuJoCo's ``MjContact``."""

    def __init__(self, columns: dict[str, NDArray[Any]], index: int) -> None:
        """Reads one row of the columns."""
        for name, column in columns.items():
            value = column[index]
            setattr(self, name, value if value.ndim else value.item())
        self.H = np.zeros(36)

    def __repr__(self) -> str:
        return f"<contact of geoms {self.geom1} and {self.geom2}, dist {self.dist}>"  # type: ignore[attr-defined]


class ContactList:
    """The contacts of an instant: arrays with an entry for each, or one by one."""

    def __init__(self, columns: dict[str, NDArray[Any]]) -> None:
        """Adds the columns that MuJoCo derives."""
        count = len(columns["geom1"])
        geoms = np.stack([columns["geom1"], columns["geom2"]], axis=1)
        nothing = np.full((count, 2), -1, dtype=np.int32)
        self._columns = {
            **{name: column for name, column in columns.items() if name != "force"},
            "geom": geoms,
            "flex": nothing,
            "elem": nothing,
            "vert": nothing,
            "exclude": np.zeros(count, dtype=np.int32),
            "mu": columns["friction"][:, 0].copy(),
        }
        self._forces = columns["force"]

    def __getattr__(self, name: str) -> Any:
        """Returns a column."""
        columns = self.__dict__.get("_columns", {})
        if name in columns:
            return columns[name]
        raise AttributeError(
            f"contact.{name}: contacts have {', '.join(columns)}; install mujoco (pip install mujoco) for others"
        )

    def __len__(self) -> int:
        return len(self._columns["geom1"])

    @overload
    def __getitem__(self, index: int) -> Contact: ...

    @overload
    def __getitem__(self, index: slice) -> ContactList: ...

    def __getitem__(self, index: int | slice) -> Contact | ContactList:
        """Returns a contact, or the list of a slice."""
        count = len(self)
        if isinstance(index, slice):
            some = ContactList.__new__(ContactList)
            some._columns = {name: column[index] for name, column in self._columns.items()}
            some._forces = self._forces[index]
            return some
        if not -count <= index < count:
            raise IndexError(f"contact {index}: there are {count}")
        return Contact(self._columns, index)

    def __iter__(self) -> Iterator[Contact]:
        return (self[index] for index in range(len(self)))
