"""Beside an installation of MIMo: which of the two serves, and that none harms the other."""

from __future__ import annotations

import importlib.metadata
import shutil
import sys
from pathlib import Path

import pytest

from .conftest import MIMO, run

STAND_INS = (*MIMO, "mimoGrowth", "mimo_infant", "mujoco")  # the kit's MIMo has no mimoGrowth, and is not MIMo 3
WHERE = "import mimoEnv.utils, mimoTouch.touch as t; print(mimoEnv.utils.__file__); print(t.TrimeshTouch.__module__)"


def own_files() -> list[Path]:
    """Returns the modules of this package at the top of its folder, wherever it is installed or developed."""
    import babybench_kit

    return [Path(babybench_kit.__file__).parent.parent / f"{name}.py" for name in STAND_INS]


def place_own(site: Path) -> None:
    """Installs the stand-ins into a folder, as pip does: file by file."""
    for file in own_files():
        shutil.copy(file, site / file.name)


def place_mimo(whole: Path, site: Path) -> None:
    """Installs MIMo into a folder, as pip does: file by file."""
    for name in MIMO:
        ignored = shutil.ignore_patterns("assets", "__pycache__")
        shutil.copytree(whole / "MIMo" / name, site / name, ignore=ignored, dirs_exist_ok=True)


def tops(distribution: str) -> set[str]:
    """Returns what a distribution has put at the top of ``site-packages``."""
    try:
        files = importlib.metadata.files(distribution) or []
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("the package is not installed: it is run from its sources")
    return {file.parts[0] for file in files if file.parts[0] != ".." and not file.parts[0].endswith(".dist-info")}


def test_no_file_lies_where_mimo_or_mujoco_put_their_own() -> None:
    assert tops("babybench") == {"babybench", "babybench_core"}
    compiled = {"__pycache__"}  # where an installer compiles
    assert tops("babybench-kit") - compiled == {
        "babybench_kit",
        "babybench_kit.pth",
        *(f"{name}.py" for name in STAND_INS),
    }


@pytest.mark.parametrize("first", ["mimo", "babybench"])
def test_mimo_serves_where_it_is_installed_in_either_order(
    kit_python: str, whole: Path, tmp_path: Path, first: str
) -> None:
    site = tmp_path / "site"
    site.mkdir()
    place_own(site) if first == "babybench" else place_mimo(whole, site)
    place_own(site) if first == "mimo" else place_mimo(whole, site)
    done = run(kit_python, "-c", WHERE, cwd=tmp_path, path=(site,))
    assert done.stdout.split() == [str(site / "mimoEnv" / "utils.py"), "mimoTouch.touch"]
    # uninstalling one leaves the other whole
    for name in MIMO:
        shutil.rmtree(site / name)
    done = run(kit_python, "-c", WHERE, cwd=tmp_path, path=(site,))
    assert done.stdout.split()[1] == "babybench_kit.touch"
    place_mimo(whole, site)
    for name in STAND_INS:
        (site / f"{name}.py").unlink()
    done = run(kit_python, "-c", WHERE, cwd=tmp_path, path=(site,))
    assert done.stdout.split()[1] == "mimoTouch.touch"


def test_an_editable_mimo_serves_too_unless_told_otherwise(kit_python: str, whole: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    site.mkdir()
    place_own(site)
    # pip install -e puts MIMo's folder at the end of the path
    editable = f"import sys; sys.path.append({str(whole / 'MIMo')!r}); {WHERE}"
    done = run(kit_python, "-c", editable, cwd=tmp_path, path=(site,))
    assert done.stdout.split()[1] == "mimoTouch.touch"
    done = run(kit_python, "-c", editable, cwd=tmp_path, path=(site,), BABYBENCH_MIMO="babybench")
    assert done.stdout.split()[1] == "babybench_kit.touch"


def test_environments_of_an_installed_mimo_are_made_with_a_warning(
    kit_python: str, whole: Path, checkout: Path
) -> None:
    make = (
        f"import sys; sys.path.remove(''); sys.path.append({str(whole / 'MIMo')!r}); import mimoEnv, yaml, babybench.utils as u\n"
        "c = yaml.safe_load(open('examples/config_selftouch.yml')); c['touch_active'] = False\n"
        "print(type(u.make_env(c).unwrapped).__module__)\n"
    )
    done = run(kit_python, "-c", make, cwd=checkout)
    assert done.stdout.split()[-1] == "mimoEnv.babybench.selftouch"
    assert "BABYBENCH_MIMO=babybench" in done.stderr
    done = run(kit_python, "-c", make, cwd=checkout, BABYBENCH_MIMO="original")
    assert done.stdout.split()[-1] == "mimoEnv.babybench.selftouch"
    assert "BABYBENCH_MIMO" not in done.stderr
    for how in ({"BABYBENCH_MIMO": "babybench"}, {}):
        first = make if how else make.replace("import mimoEnv, ", "import ")
        done = run(kit_python, "-c", first, cwd=checkout, **how)
        assert done.stdout.split()[-1] == "babybench_kit.env"
        assert "BABYBENCH_MIMO" not in done.stderr


def test_a_checkout_with_mimo_and_babybench_of_its_own_reaches_the_package(kit_python: str, whole: Path) -> None:
    script = whole / "whoever.py"
    script.write_text(
        "import sys; sys.path.insert(0, 'MIMo')\nimport babybench.utils as u, mimoEnv\nprint(u.__file__, mimoEnv.__file__)"
    )
    for arguments, env in ((("-m", "babybench_core", "run"), {}), ((), {"BABYBENCH_MIMO": "babybench"})):
        done = run(kit_python, *arguments, script, cwd=whole, **env)
        utils, mimo = done.stdout.split()
        assert utils == str(whole / "babybench" / "utils.py")
        assert "babybench_kit" in mimo
    done = run(kit_python, script, cwd=whole)
    assert done.stdout.split()[1] == str(whole / "MIMo" / "mimoEnv" / "__init__.py")
    assert "python -m babybench_core run SCRIPT" in done.stderr


def test_the_stand_in_for_mujoco_tells_what_it_does_not_have() -> None:
    code = "import mujoco; print(mujoco.stands_in, mujoco.MjSpec)\ntry: mujoco.mjr_render\nexcept AttributeError as e: print(e)"
    done = run(sys.executable, "-c", code, cwd=Path.cwd(), BABYBENCH_MUJOCO="off")
    if "pip install mujoco" not in done.stdout:
        pytest.fail(done.stdout + done.stderr)
