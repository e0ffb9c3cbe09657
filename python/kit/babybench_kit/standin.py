"""Stand-ins for modules that are not installed: MIMo's packages, and MuJoCo's bindings.

A stand-in is a single file at the top of ``site-packages``. A folder of the same name wins over it, so that installing the
real package neither overwrites it nor is shadowed by it, in whatever order. :mod:`babybench_kit.swap` decides who serves.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
import sys
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path

from babybench_kit import swap

_TREES = Path(__file__).parent / "standins"
MUJOCO = "BABYBENCH_MUJOCO"
"""The variable that disables an installed MuJoCo if it is ``off``."""


def real(name: str) -> ModuleSpec | None:
    """Finds the real package of a name, which is a folder; stand-ins are files."""
    for entry in sys.path:
        spec = PathFinder.find_spec(name, [entry])
        if spec is not None and spec.origin is not None and spec.submodule_search_locations is not None:
            return spec
    for finder in sys.meta_path:
        if finder in (importlib.machinery.BuiltinImporter, importlib.machinery.FrozenImporter, PathFinder):
            continue
        if isinstance(finder, swap.Swap):
            continue
        spec = finder.find_spec(name, None, None)
        if spec is not None and spec.origin is not None and spec.submodule_search_locations is not None:
            return spec
    return None


def own(name: str) -> ModuleSpec | None:
    """Finds the tree of this package that stands in for a module."""
    tree = _TREES / name
    return importlib.util.spec_from_file_location(name, tree / "__init__.py", submodule_search_locations=[str(tree)])


def serve(name: str) -> None:
    """Replaces a stand-in by the real module of its name, or else by the tree that stands in for it."""
    if name == "mujoco":
        spec = None if os.environ.get(MUJOCO) == "off" else real(name)
        if spec is None:
            from babybench_core.mujoco.installing import put

            put()
            return
    else:
        sys.modules.pop(name, None)  # the stand-in itself, which would pass for MIMo's own
        spec = swap.find(name)
        if spec is None and os.environ.get(swap.CHOICE) == "original":
            text = f"No module named {name!r}: MIMo is not installed, but {swap.CHOICE}=original asks for it"
            raise ModuleNotFoundError(text, name=name)
        spec = spec or own(name)
    if spec is None or spec.loader is None:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
