"""A checkout of the starter kit to compare with, and recordings of it and of what runs in its place.

``BABYBENCH_KIT`` is the checkout; it is copied, never written to. ``BABYBENCH_KIT_PYTHON`` is a Python with this package and
``requirements.txt`` of this folder; MIMo itself is not installed there. ``BABYBENCH_GYMNASIUM_029`` is a folder into which
Gymnasium 0.29 was installed (``pip install --target``).
"""

from __future__ import annotations

import os
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

CONFIGS = ("selftouch", "handregard", "test_installation")
STEPS = 300
WITHOUT_MUJOCO = Path(__file__).parent / "without_mujoco"
MIMO = ("mimoActuation", "mimoEnv", "mimoProprioception", "mimoTouch", "mimoVestibular", "mimoVision")


def variable(name: str, what: str) -> str:
    """Returns a variable of the environment, or skips the test."""
    value = os.environ.get(name)
    if not value:
        pytest.skip(f"{name} is not set: {what}")
    return value


def run(
    python: str, *args: object, cwd: Path, path: tuple[object, ...] = (), fails: bool = False, **env: str
) -> subprocess.CompletedProcess[str]:
    """Runs a Python program and returns what it printed; it must succeed, or fail."""
    inherited = {k: v for k, v in os.environ.items() if not k.startswith(("BABYBENCH_", "PYTHONWARNINGS"))}
    inherited["PYTHONPATH"] = os.pathsep.join([*map(str, path), *filter(None, [os.environ.get("PYTHONPATH")])])
    inherited.update(MUJOCO_GL="osmesa", MPLBACKEND="agg", OMP_NUM_THREADS="1", **env)
    done = subprocess.run(
        [python, *map(str, args)], cwd=cwd, env=inherited, capture_output=True, text=True, timeout=600
    )
    assert (done.returncode != 0) is fails, f"{args}: {done.returncode}\n{done.stdout[-3000:]}\n{done.stderr[-5000:]}"
    return done


@pytest.fixture(scope="session")
def kit() -> Path:
    """The checkout of the starter kit."""
    return Path(variable("BABYBENCH_KIT", "there is no starter kit to compare with"))


@pytest.fixture(scope="session")
def kit_python() -> str:
    """A Python on which the starter kit runs."""
    return variable("BABYBENCH_KIT_PYTHON", "there is no Python with MuJoCo and what else the starter kit needs")


@pytest.fixture(scope="session")
def gymnasium_029() -> str:
    """A folder with Gymnasium 0.29."""
    return variable("BABYBENCH_GYMNASIUM_029", "there is no folder with Gymnasium 0.29")


@pytest.fixture(scope="session")
def whole(kit: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the starter kit with MIMo."""
    copy = tmp_path_factory.mktemp("kit") / "whole"
    shutil.copytree(kit, copy, ignore=shutil.ignore_patterns(".git", "__pycache__"))
    for folder, _, files in os.walk(copy):
        for name in ("", *files):
            os.chmod(os.path.join(folder, name), 0o755 if not name else 0o644)
    return copy


@pytest.fixture
def checkout(whole: Path, tmp_path: Path) -> Path:
    """A copy of the starter kit of which only the assets of MIMo are left, as if MIMo were not installed."""
    copy = tmp_path / "checkout"
    shutil.copytree(whole, copy, ignore=shutil.ignore_patterns("MIMo"))
    shutil.copytree(whole / "MIMo" / "mimoEnv" / "assets", copy / "MIMo" / "mimoEnv" / "assets")
    return copy


@pytest.fixture(scope="session")
def recordings(
    whole: Path, kit_python: str, tmp_path_factory: pytest.TempPathFactory
) -> Callable[[str, str], dict[str, Any]]:
    """Recordings by configuration and by what was run.

    That is ``kit``, ``kit cold`` (its solver starts each step afresh), ``mujoco`` (this library beside MuJoCo) or ``alone``.
    """
    folder = tmp_path_factory.mktemp("recordings")
    record = Path(__file__).parent / "record.py"

    def recorded(config: str, who: str) -> dict[str, Any]:
        out = folder / f"{config}-{who}.pkl"
        if not out.exists():
            who, *how = who.split()
            path = {"kit": (whole / "MIMo",), "alone": (WITHOUT_MUJOCO,)}.get(who, ())
            env = {"mujoco": {"BABYBENCH_MIMO": "babybench"}, "alone": {"BABYBENCH_MUJOCO": "off"}}.get(who, {})
            file = whole / "examples" / f"config_{config}.yml"
            run(kit_python, record, file, STEPS, out, *how, cwd=whole, path=path, **env)
        with out.open("rb") as f:
            return pickle.load(f)  # type: ignore[no-any-return]

    return recorded


@pytest.fixture(params=["alone", "mujoco", "gymnasium 0.29"])
def interpreter(request: pytest.FixtureRequest) -> tuple[str, tuple[object, ...]]:
    """A Python, and folders on its path: this one; the kit's own, with MuJoCo; this one with another Gymnasium."""
    if request.param == "mujoco":
        return request.getfixturevalue("kit_python"), ()
    if request.param == "alone":
        return sys.executable, ()
    return sys.executable, (request.getfixturevalue("gymnasium_029"),)
