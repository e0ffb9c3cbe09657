"""The library's MJCF files and textures as files."""

from __future__ import annotations

import os
from pathlib import Path

from babybench_core import _native


def assets_folder() -> Path:
    """Returns a folder with the library's assets, written on first use: ``babybench/*.xml``, ``tex/*.png``, ``toys/*.obj``."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    folder = Path(base) / "babybench" / _native.__version__ / "assets"
    try:
        _write_assets(folder)
    except OSError:
        # no home that can be written to
        import tempfile

        user = os.getuid() if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
        folder = Path(tempfile.gettempdir()) / f"babybench-{user}-{_native.__version__}" / "assets"
        _write_assets(folder)
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
