"""Who serves ``mimoEnv`` where a MIMo lies on the path: this package, or MIMo with a warning."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

NAMES = ("mimoActuation", "mimoEnv", "mimoProprioception", "mimoTouch", "mimoVestibular", "mimoVision")
WHERE = "import mimoEnv, mimoTouch as t; who = lambda m: getattr(m, 'WHO', 'babybench'); print('served by', who(mimoEnv), who(t))"
OURS, MIMOS = "served by babybench babybench", "served by MIMo MIMo"


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A folder with a script that puts a MIMo of its own first on its path."""
    for name in NAMES:
        (tmp_path / "MIMo" / name).mkdir(parents=True)
        (tmp_path / "MIMo" / name / "__init__.py").write_text("WHO = 'MIMo'\n")
    (tmp_path / "script.py").write_text(
        f"import sys\nsys.path.insert(0, {str(tmp_path / 'MIMo')!r})\nprint(*sys.argv[1:])\n{WHERE}\n"
    )
    return tmp_path


def run(checkout: Path, *arguments: str, **env: str) -> subprocess.CompletedProcess[str]:
    """Runs Python there."""
    inherited = {k: v for k, v in os.environ.items() if not k.startswith(("BABYBENCH_", "PYTHONWARNINGS"))}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=checkout,
        env={**inherited, **env},
        capture_output=True,
        text=True,
        timeout=600,
    )


def hooked() -> bool:
    """Returns whether this Python knows of the package from its start, as an installed wheel sees to."""
    code = "import sys; print('babybench_kit.swap' in sys.modules)"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "True"


def first(checkout: Path) -> str:
    return f"import sys; sys.path.insert(0, {str(checkout / 'MIMo')!r})"


@pytest.mark.parametrize("package", ["babybench", "babybench_core"])
def test_a_script_that_is_run_by_the_package_reaches_it(checkout: Path, package: str) -> None:
    done = run(checkout, "-m", package, "run", "script.py", "--train_for", "3")
    assert done.stdout.split("\n")[:2] == ["--train_for 3", OURS], done.stderr
    assert done.stderr == ""


def test_a_module_is_run_too(checkout: Path) -> None:
    done = run(checkout, "-m", "babybench", "run", "-m", "script", "-x")
    assert done.stdout.split("\n")[:2] == ["-x", OURS], done.stderr


def test_processes_of_a_script_that_is_run_by_the_package_reach_it(checkout: Path) -> None:
    if not hooked():
        pytest.skip("the package is not installed: it is run from its sources")
    (checkout / "parent.py").write_text(
        "import subprocess, sys\nsubprocess.run([sys.executable, 'script.py'], check=True)\n"
    )
    done = run(checkout, "-m", "babybench", "run", "parent.py")
    assert OURS in done.stdout, done.stderr


def test_a_script_that_is_not_there(checkout: Path) -> None:
    done = run(checkout, "-m", "babybench", "run", "other.py")
    assert done.returncode == 1
    assert "there is no file 'other.py'" in done.stderr
    assert "Traceback" not in done.stderr


def test_the_variable_decides(checkout: Path) -> None:
    if not hooked():
        pytest.skip("the package is not installed: it is run from its sources")
    assert OURS in run(checkout, "script.py", BABYBENCH_MIMO="babybench").stdout
    kept = run(checkout, "script.py", BABYBENCH_MIMO="original")
    assert MIMOS in kept.stdout
    assert kept.stderr == ""
    wrong = run(checkout, "script.py", BABYBENCH_MIMO="mine")
    assert "BABYBENCH_MIMO is 'mine', expected babybench or original" in wrong.stderr


def test_whoever_imports_babybench_first_reaches_it(checkout: Path) -> None:
    done = run(checkout, "-c", f"{first(checkout)}; import babybench; {WHERE}")
    assert OURS in done.stdout
    assert done.stderr == ""


def test_where_mimo_serves_one_warning_says_so(checkout: Path) -> None:
    late = run(checkout, "-c", f"{first(checkout)}; {WHERE}; import babybench, mimoVision; print(mimoVision.WHO)")
    assert MIMOS in late.stdout
    assert late.stdout.endswith("MIMo\n")  # all of it is of one make
    assert late.stderr.count("MuJoCo runs these environments") == 1
    assert "python -m babybench_core run SCRIPT" in late.stderr
    assert "BABYBENCH_MIMO=babybench" in late.stderr
    if hooked():
        alone = run(checkout, "script.py")
        assert MIMOS in alone.stdout
        assert alone.stderr.count("MuJoCo runs these environments") == 1


def test_a_mimo_that_is_asked_for_and_not_there(checkout: Path) -> None:
    if importlib.util.find_spec("mimoEnv.showroom"):
        pytest.skip("MIMo is installed")
    done = run(checkout, "-c", "import babybench, mimoEnv", BABYBENCH_MIMO="original")
    assert "ModuleNotFoundError" in done.stderr
    assert "BABYBENCH_MIMO=original asks for it" in done.stderr
