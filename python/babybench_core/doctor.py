"""``python -m babybench doctor``: versions of Python and its packages, then what the program ``babybench doctor`` prints."""

from __future__ import annotations

import platform
import sys
from importlib import metadata
from typing import Optional

REQUIRED = ("numpy", "gymnasium")
OPTIONAL = {
    "babybench-kit": "scripts of the starter kit",
    "mujoco": "MuJoCo beside this package",
    "stable-baselines3": "babybench.sb3",
    "torch": "learners",
    "pettingzoo": "babybench.pettingzoo",
    "matplotlib": "babybench.figures",
    "pygame": 'render_mode="human"',
    "pillow": "babybench.film",
    "ipykernel": "notebooks",
    "pyarrow": "Parquet",
    "h5py": "HDF5",
    "pynwb": "NWB",
    "rerun-sdk": "Rerun",
    "tensorboard": "TensorBoard",
    "minari": "Minari",
}


def lines() -> list[tuple[str, str]]:
    """Returns facts about the interpreter and its packages, as pairs of a name and a value."""
    facts = [
        ("python", f"{platform.python_version()}, {platform.python_implementation()}, {sys.executable}"),
    ]
    needed = [(package, _version(package) or "missing: pip install babybench installs it") for package in REQUIRED]
    optional = [(package, _version(package) or f"not installed: {purpose}") for package, purpose in OPTIONAL.items()]
    return facts + needed + optional


def _version(package: str) -> Optional[str]:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def main() -> None:
    """Prints the facts."""
    for name, value in lines():
        print(f"{name:<16} {value}")
    sys.stdout.flush()  # the native part writes to the same pipe
