"""The parts of the stand-ins for MIMo's classes that scripts replace, in a subclass or on one instance."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from typing import Any, ClassVar


def replaced(instance: object, original: Mapping[str, Any], names: Iterable[str]) -> list[str]:
    """Returns which methods of an instance are not those of ``original``, the namespace of this package's own class."""
    own, cls = vars(instance), type(instance)
    return [name for name in names if name in own or inspect.getattr_static(cls, name) is not original[name]]


def refuse_uncalled(cls: type, uncalled: Iterable[str], instead: str) -> None:
    """Refuses a subclass that replaces methods that are never called.

    Raises:
        TypeError: It does; the text names them.
    """
    found = sorted(set(uncalled) & set(vars(cls)))
    if found:
        raise TypeError(
            f"{cls.__name__} replaces {', '.join(found)} of MIMo's own class, which is never called here, as the engine "
            f"does that work: {instead}, or run this with BABYBENCH_MIMO=original where MIMo is installed"
        )


class Replaceable:
    """A part of an environment that the engine computes until a script replaces attributes or methods of it."""

    _uncalled: ClassVar[frozenset[str]] = frozenset()
    """Methods of MIMo's class that have no counterpart here."""
    _instead: ClassVar[str] = "replace the method that calls it"
    _state: ClassVar[frozenset[str]] = frozenset()
    """Attributes that change in every step."""
    env: Any
    _changed: set[str]

    def __init_subclass__(cls, **arguments: Any) -> None:
        """Refuses subclasses that replace methods that are never called."""
        super().__init_subclass__(**arguments)
        refuse_uncalled(cls, cls._uncalled, cls._instead)

    def _made(self) -> None:
        """Ends the construction: later assignments are a script's own."""
        self.__dict__["_parts_of_mimo"] = frozenset(name for name in vars(self) if name[0] != "_") - self._state
        self.__dict__["_changed"] = set()

    @property
    def _replaced(self) -> frozenset[str]:
        """Returns the attributes and methods that a script has assigned on this instance."""
        return frozenset(self.__dict__.get("_changed", ()))

    def __setattr__(self, name: str, value: Any) -> None:
        super().__setattr__(name, value)
        parts = self.__dict__.get("_parts_of_mimo", ())
        if name in parts or (parts and callable(getattr(type(self), name, None))):
            self._changed.add(name)
            self._taken_over()

    def _taken_over(self) -> None:
        """Records that a script has replaced something."""
        self.env._reconsider()
