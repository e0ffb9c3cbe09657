"""The library's MJCF files and textures as files."""

from __future__ import annotations

import contextlib
import importlib
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Callable

from babybench_core import _native

from .standard_scenes import write_scenes


def assets_path() -> Path:
    """Returns the folder of the library's assets, without writing into it."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    folder = Path(base) / "babybench" / _native.__version__ / "assets"
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    # no home that can be written to
    user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
    return Path(tempfile.gettempdir()) / f"babybench-{user}-{_native.__version__}" / "assets"


def scene_path(name: str) -> str:
    """Returns the path of one of MIMo's scenes, which :func:`assets_folder` writes."""
    return str(assets_path() / name)


def assets_folder() -> Path:
    """Returns a folder with the library's assets, written on first use.

    It has ``babybench/*.xml``, ``tex/*.png``, ``toys/*.obj``, MIMo's scenes under the names of their files, and
    ``mimo/*.xml``, which scenes include.
    """
    folder = assets_path()
    _write_assets(folder)
    write_scenes(folder)
    return folder


def _write_assets(folder: Path) -> None:
    for name, content in _native.embedded_files().items():
        path = folder / name
        if path.is_file() and path.stat().st_size == len(content):
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        # another process may write the same
        part = path.with_name(f"{path.name}.{os.getpid()}")
        part.write_bytes(content)
        part.replace(path)


def written(module: str, paths: Mapping[str, str]) -> Callable[[str], Any]:
    """Returns the ``__getattr__`` of one of MIMo's modules: paths of scenes, written on first use, and names of ``mimo_env``."""

    def get(name: str) -> Any:
        if name in paths:
            assets_folder()
            return paths[name]
        if not name.startswith("_"):
            base = importlib.import_module("mimoEnv.envs.mimo_env")
            if hasattr(base, name):
                return getattr(base, name)
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    return get
