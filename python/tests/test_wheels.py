"""What is imported where this package is installed alone, with ``babybench-kit`` and beside MuJoCo, in any order of pip's.

``BABYBENCH_WHEELS`` is a folder with the wheels of both packages; ``.ci/python`` builds them. The rest comes from the network.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

MIMO = ("mimoActuation", "mimoEnv", "mimoProprioception", "mimoTouch", "mimoVestibular", "mimoVision")
MUJOCO = "mujoco==3.3.0"
PACKAGES = ("babybench", "babybench-kit", "mujoco")

WHO = """
import importlib
for name in ("mujoco", "mimoEnv"):
    try:
        module = importlib.import_module(name)
    except ModuleNotFoundError as error:
        print(f"no {name}" if error.name == name else error.name)
    else:
        ours = getattr(module, "stands_in", "babybench_kit" in module.__file__)
        print("babybench-kit's" if ours else "MuJoCo's")
"""
NEITHER, KIT, BOTH, MUJOCO_ALONE = (
    ["no mujoco", "no mimoEnv"],
    ["babybench-kit's", "babybench-kit's"],
    ["MuJoCo's", "babybench-kit's"],
    ["MuJoCo's", "no mimoEnv"],
)


class Place:
    """An environment of Python with what both packages and MuJoCo depend on."""

    def __init__(self, folder: Path, wheels: Path) -> None:
        self.folder, self.wheels = folder, wheels
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        self.python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
        self.pip("install", "--find-links", str(wheels), "babybench[kit]", MUJOCO)
        self.site = Path(self.run("-c", "import babybench; print(babybench.__file__)").stdout.strip()).parent.parent

    def run(self, *arguments: str, code: int = 0) -> subprocess.CompletedProcess[str]:
        """Runs its Python in its own folder, where nothing else lies."""
        env = {k: v for k, v in os.environ.items() if not k.startswith(("BABYBENCH_", "PYTHON"))}
        done = subprocess.run(
            [str(self.python), *arguments], cwd=self.folder, env=env, capture_output=True, text=True, timeout=600
        )
        assert done.returncode == code, done.stdout + done.stderr
        return done

    def pip(self, *arguments: str) -> None:
        self.run("-m", "pip", "--quiet", "--disable-pip-version-check", *arguments)

    def install(self, package: str) -> None:
        """Installs one of the packages, whose dependencies are there."""
        self.pip("install", "--no-deps", "--find-links", str(self.wheels), MUJOCO if package == "mujoco" else package)

    def uninstall(self, *packages: str) -> None:
        self.pip("uninstall", "--yes", *packages)

    def who(self) -> list[str]:
        """Tells whose ``mujoco`` and whose ``mimoEnv`` are imported; nothing is said beside."""
        done = self.run("-c", WHO)
        assert done.stderr == ""
        return done.stdout.splitlines()


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Place:
    """The environment, with all three."""
    wheels = os.environ.get("BABYBENCH_WHEELS")
    if not wheels:
        pytest.skip("BABYBENCH_WHEELS is not set: there are no wheels to install")
    return Place(tmp_path_factory.mktemp("place"), Path(wheels))


@pytest.fixture
def installed(place: Place) -> Callable[..., Place]:
    """Installs packages, in order, into the environment without any of them."""

    def install(*packages: str) -> Place:
        place.uninstall(*PACKAGES)
        for package in packages:
            place.install(package)
        return place

    return install


def test_the_extra_brings_the_kit(place: Place) -> None:
    assert place.who() == BOTH


def test_alone_it_brings_no_module_of_another_name(installed: Callable[..., Place]) -> None:
    place = installed("babybench")
    assert place.who() == NEITHER
    for name in MIMO:
        assert f"No module named '{name}'" in place.run("-c", f"import {name}", code=1).stderr
    code = """
import babybench, gymnasium, sys
env = babybench.make("self_touch", touch_active=False)
env.reset(seed=0)
env.step(env.action_space.sample())
from babybench import mujoco
assert "mujoco" not in sys.modules and mujoco.MjModel.from_xml_string("<mujoco/>").nbody == 1
try:
    gymnasium.make("Hopper-v5")
except gymnasium.error.DependencyNotInstalled:
    print("no MuJoCo")
"""
    assert place.run("-c", code).stdout == "no MuJoCo\n"


def test_alone_it_says_what_brings_the_kit(installed: Callable[..., Place]) -> None:
    place = installed("babybench")
    for name in ("babybench.utils", "babybench.eval", "babybench.build_xml"):
        said = place.run("-c", f"import {name}", code=1).stderr
        assert said.splitlines()[-1] == (
            f"ModuleNotFoundError: {name} needs the package babybench-kit, which is not installed: "
            'pip install "babybench[kit]"'
        )
    said = place.run("-m", "babybench", "run", "script.py", code=1).stderr
    assert said.startswith("error: ")
    assert 'pip install "babybench[kit]"' in said


@pytest.mark.parametrize("order", [("babybench-kit", "mujoco"), ("mujoco", "babybench-kit")], ids=" then ".join)
def test_mujoco_itself_is_imported_and_either_can_go(installed: Callable[..., Place], order: tuple[str, str]) -> None:
    place = installed("babybench", *order)
    assert place.who() == BOTH
    place.uninstall("babybench-kit")
    assert place.who() == MUJOCO_ALONE
    place.install("babybench-kit")
    place.uninstall("mujoco")
    assert place.who() == KIT
    place.install("mujoco")
    assert place.who() == BOTH


def test_the_kit_without_the_package_gets_in_nobody_s_way(installed: Callable[..., Place]) -> None:
    place = installed("babybench", "babybench-kit", "mujoco")
    place.uninstall("babybench")
    assert place.who() == ["MuJoCo's", "babybench_core"]
    place.uninstall("mujoco")
    assert place.who() == ["babybench_core", "babybench_core"]


def test_nothing_is_left_of_them(installed: Callable[..., Place]) -> None:
    place = installed(*PACKAGES)
    assert place.who() == BOTH
    place.uninstall(*PACKAGES)
    assert place.who() == NEITHER
    left = [
        path.name
        for path in (*place.site.iterdir(), *place.site.glob("__pycache__/*"))
        if path.name.startswith(("babybench", *MIMO, "mujoco"))
    ]
    assert left == []
