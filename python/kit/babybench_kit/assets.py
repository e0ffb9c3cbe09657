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

from .geom_names import BODIES, with_geom_names
from .standard_scenes import write_scenes

_FOLDERS = {2: "assets", 3: "assets3"}
"""The folder of each version of MIMo."""
_BASES = {2: "mimoEnv.envs.mimo_env", 3: "mimo_infant.simulation.envs.mimo_env"}
_OVERLAYS = ("mimo3/", "mimo3/reference/")
"""Folders of documents in which MIMo 3 differs from MIMo 2; the last one wins."""


def assets_path(version: int = 2) -> Path:
    """Returns the folder of the library's assets with a version of MIMo, without writing into it."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    folder = Path(base) / "babybench" / _native.__version__ / _FOLDERS[version]
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    # the home folder is not writable
    user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
    return Path(tempfile.gettempdir()) / f"babybench-{user}-{_native.__version__}" / _FOLDERS[version]


def scene_path(name: str, version: int = 2) -> str:
    """Returns the path of one of MIMo's scenes, which :func:`assets_folder` writes."""
    return str(assets_path(version) / name)


def assets_folder(version: int = 2) -> Path:
    """Returns a folder with the library's assets and a version of MIMo, written on first use.

    It has ``babybench/*.xml``, ``tex/*.png``, ``toys/*.obj``, MIMo's scenes under the names of their files, and
    ``mimo/*.xml``, which scenes include.
    """
    folder = assets_path(version)
    _write_assets(folder, version)
    write_scenes(folder, version)
    return folder


def _files(version: int) -> dict[str, bytes]:
    """Returns the library's files by path; those of MIMo 3 replace others of their names."""
    files: dict[str, bytes] = dict(_native.embedded_files())
    if version == 2:
        return files
    for overlay in _OVERLAYS:
        found = {name: content for name, content in files.items() if name.startswith(overlay)}
        files.update({f"babybench/{Path(name).name}": content for name, content in found.items()})
    for name in BODIES:
        files[f"babybench/{name}.xml"] = with_geom_names(files[f"babybench/{name}.xml"])
    return files


def _write_assets(folder: Path, version: int) -> None:
    for name, content in _files(version).items():
        path = folder / name
        if path.is_file() and path.stat().st_size == len(content):
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        # another process may write the same file
        part = path.with_name(f"{path.name}.{os.getpid()}")
        part.write_bytes(content)
        part.replace(path)


def written(module: str, paths: Mapping[str, str], version: int = 2) -> Callable[[str], Any]:
    """Returns the ``__getattr__`` of one of MIMo's modules: paths of scenes, written on first use, and names of ``mimo_env``."""

    def get(name: str) -> Any:
        if name in paths:
            assets_folder(version)
            return paths[name]
        if not name.startswith("_"):
            base = importlib.import_module(_BASES[version])
            if hasattr(base, name):
                return getattr(base, name)
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    return get
