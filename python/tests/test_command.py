"""The command line of the package: the commands of the program babybench."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

CONFIG = "behavior: self_touch\nscene: base\ntouch_active: false\nvision_active: false\nsave_dir: run\nmax_episode_steps: 20\n"
COMMANDS = (
    "run",
    "inspect",
    "render",
    "scene",
    "simulate",
    "replay",
    "view",
    "senses",
    "test-installation",
    "doctor",
    "train",
    "score",
    "report",
    "evaluate",
    "measure",
    "benchmark",
    "protocol",
    "pack",
)
COMMAND = [sys.executable, "-m", "babybench"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "c.yml").write_text(CONFIG)
    return tmp_path


def call(folder: Path, *arguments: str, package: str = "babybench") -> subprocess.CompletedProcess[str]:
    """Runs a command there."""
    return subprocess.run(
        [sys.executable, "-m", package, *arguments], cwd=folder, capture_output=True, text=True, timeout=600
    )


def test_every_command_is_there(folder: Path) -> None:
    done = call(folder, "--help")
    assert done.returncode == 0, done.stderr
    assert "Usage: python -m babybench <COMMAND>" in done.stdout
    assert "run [-m] SCRIPT [ARGUMENT ...]" in done.stdout
    for command in COMMANDS:
        assert f"\n  {command} " in done.stdout
        helped = call(folder, command, "--help", package="babybench_core")
        assert helped.returncode == 0, helped.stderr
        assert f"Usage: python -m babybench_core {command}" in helped.stdout


def test_a_run_from_training_to_the_report(folder: Path) -> None:
    assert "action" in call(folder, "inspect", "--config", "c.yml").stdout
    assert call(folder, "run", "--config", "c.yml", "--steps", "5", "--quiet").returncode == 0
    for arguments in (
        ("train", "--config", "c.yml", "--train-for", "60", "--quiet"),
        ("evaluate", "--config", "c.yml", "--episodes", "1", "--duration", "10", "--no-render", "--quiet"),
        ("score", "run"),
        ("report", "run"),
        ("render", "--config", "c.yml", "--camera", "corner", "--out", "room.png"),
        ("scene", "new", "room"),
        ("scene", "check", "room/room.xml"),
    ):
        done = call(folder, *arguments)
        assert done.returncode == 0, (arguments, done.stdout, done.stderr)
    assert (folder / "run" / "logs" / "training.pkl").is_file()
    assert (folder / "run" / "report.html").is_file()
    assert (folder / "room.png").read_bytes()[1:4] == b"PNG"


def test_a_policy_that_is_an_onnx_model_is_evaluated(folder: Path) -> None:
    policy = Path(__file__).parents[2] / "policies" / "reach.onnx"
    (folder / "reach.yml").write_text("behavior: reach\nsave_dir: reach\n")
    arguments = ("--config", "reach.yml", "--episodes", "3", "--no-render", "--quiet", "--policy", str(policy))
    done = call(folder, "evaluate", *arguments)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count('"is_success"') == 3, done.stdout


def test_the_doctor_describes_python_and_the_machine_and_compares_bits(folder: Path) -> None:
    done = call(folder, "doctor")
    assert done.returncode == 0, done.stdout + done.stderr
    lines = dict(line.split(maxsplit=1) for line in done.stdout.splitlines())
    assert lines["python"].startswith(sys.version.split()[0])
    assert {"numpy", "gymnasium", "mujoco", "babybench", "system", "processor", "threads", "adapter"} <= set(lines)
    assert "of 12 checksums" in lines["self-check"], lines["self-check"]
    done = call(folder, "doctor", "--no-check")
    assert done.returncode == 0
    assert "self-check" not in done.stdout
    assert call(folder, "doctor", "--no-checks").returncode == 2


def test_a_model_is_simulated(folder: Path) -> None:
    (folder / "ball.xml").write_text(
        "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    )
    done = call(folder, "simulate", "ball.xml")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (("score", "nowhere"), 1, "error: "),
        (("inspect", "--config", "none.yml"), 1, "none.yml"),
        (("fly",), 2, "unrecognized subcommand 'fly'"),
        (("run",), 2, "run [-m] SCRIPT [ARGUMENT ...]"),
        ((), 2, "Usage: python -m babybench <COMMAND>"),
    ],
)
def test_what_fails_says_so(folder: Path, arguments: tuple[str, ...], code: int, said: str) -> None:
    done = call(folder, *arguments)
    assert done.returncode == code
    assert said in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_a_training_that_is_interrupted_saves_its_log(folder: Path) -> None:
    process = subprocess.Popen(
        [*COMMAND, "train", "--config", "c.yml", "--train-for", "100000000", "--quiet"],
        cwd=folder,
        stderr=subprocess.PIPE,
        text=True,
        # what a shell starts in the background ignores interruptions, and so would this
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    deadline = time.monotonic() + 60
    while not (folder / "run" / "scene.xml").is_file() and time.monotonic() < deadline:
        time.sleep(0.1)
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=600)
    assert process.returncode == 130, said
    assert "interrupted" in said
    assert (folder / "run" / "logs" / "training.pkl").is_file()
