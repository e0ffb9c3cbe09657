"""Modules that stand in for others where those are not installed: MIMo's packages, and MuJoCo's bindings.

A stand-in is a single file at the top of ``site-packages``. A folder of the same name wins over it, so that installing the
real package neither overwrites it nor is shadowed by it, in whatever order; a real package elsewhere on ``sys.path``, such as
an editable installation, wins as well. ``BABYBENCH_MIMO=babybench`` turns that round and takes the stand-ins for MIMo.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
import sys
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path

_TREES = Path(__file__).parent / "standins"
CHOICE = "BABYBENCH_MIMO"
"""The variable that takes the stand-ins for MIMo where MIMo is installed: ``babybench``."""
MUJOCO = "BABYBENCH_MUJOCO"
"""The variable that does without MuJoCo where MuJoCo is installed: ``off``."""


def _real(name: str) -> ModuleSpec | None:
    """Finds the real package of a name: a folder, as stand-ins are files."""
    for entry in sys.path:
        spec = PathFinder.find_spec(name, [entry])
        if spec is not None and spec.origin is not None and spec.submodule_search_locations is not None:
            return spec
    for finder in sys.meta_path:
        if finder in (importlib.machinery.BuiltinImporter, importlib.machinery.FrozenImporter, PathFinder):
            continue
        spec = finder.find_spec(name, None, None)
        if spec is not None and spec.origin is not None and spec.submodule_search_locations is not None:
            return spec
    return None


def serve(name: str) -> None:
    """Puts the real module of a name into the place of its stand-in, or else the tree that stands in for it."""
    own = os.environ.get(MUJOCO) == "off" if name == "mujoco" else os.environ.get(CHOICE) == "babybench"
    spec = None if own else _real(name)
    if spec is None:
        tree = _TREES / name
        spec = importlib.util.spec_from_file_location(
            name, tree / "__init__.py", submodule_search_locations=[str(tree)]
        )
    if spec is None or spec.loader is None:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
