"""Search paths of modules: beside the installed package, in the folders of a checkout."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from typing import overload


class SearchPath(list):  # type: ignore[type-arg]
    """The folders of a package, followed by those of the same name on ``sys.path`` at the time of a look-up."""

    def __init__(self, own: Iterable[str], name: str) -> None:
        """Begins with the folders of the installed package."""
        super().__init__(own)
        self._name = name

    def __iter__(self) -> Iterator[str]:
        seen = set()
        folders = (os.path.join(entry or os.curdir, self._name) for entry in list(sys.path))
        for folder in (*list.__iter__(self), *filter(os.path.isdir, folders)):
            real = os.path.realpath(folder)
            if real not in seen:
                seen.add(real)
                yield folder

    def __len__(self) -> int:
        return sum(1 for _ in self)

    @overload  # type: ignore[override]
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: int | slice) -> str | list[str]:
        return list(self)[index]


def extended(path: Iterable[str], name: str = "babybench") -> SearchPath:
    """Returns a package's path that also finds the modules that a checkout adds to its folder of the same name."""
    return SearchPath(path, name)
