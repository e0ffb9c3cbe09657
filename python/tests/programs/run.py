"""Fetches public programs on MIMo and runs them on this package: ``python tests/programs/run.py FOLDER``.

Needs git, the network, and the installed packages babybench, babybench-kit and matplotlib. Programs are fetched into FOLDER at
the commits of the table, and stay as they are. Their code is not part of this repository. ``python/docs/programs.md`` has
the results.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

LIMIT = 600
"""Seconds that a program may take."""


@dataclass(frozen=True)
class Program:
    """A program of a repository, and what it prints when all is well."""

    repository: str
    commit: str
    command: tuple[str, ...]
    prints: str
    beside: tuple[str, str, str] | None = None
    """A folder in its own in which it looks for another repository, and that one's name and commit."""


_TACTILE = ("uchanable/tactile-lm", "b96603d6caa2fe872ccedd9375e71ea5b5df6c7c")
_MOTHER = ("ctu-vras/mom-for-mimo", "8a0f73a2ef1236b616c5473050d42c709125bc9b")
_MIMO = ("trieschlab/MIMo", "623c9af9f289ec62c666518b3af1384da5bb3ebb")
_LENZ = ("miles-lenz/MIMo", "9f0f538dfa1da8b116ce96fc3c0be757ff8f6a41")
_FEDOZZI = ("marcogfedozzi/MIMo", "a20082914e0d42abb0c638b884f57e94c19b2141")
_DOHM = ("dohmjan/MIMo", "b72119eceefde78b3dc855bd439b236d84187467")
_TARO = ("ooo7OneuBLT/Taro", "c714c09af20b78846a3cb717ab00b0169f56ef2e")
_SCENE = """
import os, gymnasium, mimoEnv, mom_mimoEnv
path = os.path.abspath("mom_mimoEnv/assets/{scene}.xml")
env = gymnasium.make("MIMoAdultRetargeting-v0", model_path=path, vision_params=None)
env.reset(seed=0)
env.step(env.action_space.sample())
print("bodies that follow recordings:", env.unwrapped.model.nmocap)
"""
_BENCHMARK = """
import gymnasium, runpy
import babybench, mimoEnv
run = runpy.run_path("mimoEnv/benchmark.py")["run"]
env = gymnasium.make("MIMoBench-v0", vision_params=None)
env.reset(seed=0)
run(env, 20)
print("ran")
"""
_FILE = """
import os, runpy
import babybench, mimoEnv
from mimoEnv.envs.mimo_env import SCENE_DIRECTORY
env = runpy.run_path("mimoEnv/envs/{file}.py")["{cls}"](model_path={scene})
env.reset(seed=0)
for _ in range(20):
    env.step(env.action_space.sample())
print("ran")
"""
PROGRAMS = (
    Program(*_TACTILE, ("ct_touch/test_ct_touch.py",), "ALL TESTS PASSED"),
    Program(*_TACTILE, ("som/test_mimo_integration.py",), "All MIMo integration tests passed"),
    *(
        Program(*_MOTHER, ("-c", _SCENE.format(scene=scene)), f"bodies that follow recordings: {count}")
        for scene, count in (("mom1_scene", 34), ("mom_front_scene", 35), ("testing", 0))
    ),
    *(
        Program(*_TARO, (f"{script}.py",), prints, ("MIMo", *_MIMO))
        for script, prints in (
            ("D/scripts/two_agent_env", "na=88 nb=88"),
            ("D/scripts/d_env", "608"),
            ("D/scripts/d_beta_env", "OK:"),
            ("D/scripts/d_beta_puppet", "OK:"),
            ("D/scripts/d_c5_growth_check", "11.27"),
            ("D/scripts/d_touch_check", "15897"),
            ("D/scripts/d_touch_control", "=>"),
            ("D/scripts/diag_controllability", "qpos"),
            ("E/scripts/e_limb_strength", "NOTE"),
            ("E/scripts/e_reach_space", "NOTE"),
            ("E/scripts/e_toy_check", "verdict"),
        )
    ),
    Program(*_MIMO, ("-c", _BENCHMARK), "ran"),
    Program(*_DOHM, ("-c", _BENCHMARK), "ran"),
    Program(
        *_LENZ,
        ("-c", _FILE.format(file="roll_over", cls="MIMoRollOverEnv", scene="'mimoEnv/assets/roll_over_scene.xml'")),
        "ran",
    ),
    Program(
        *_FEDOZZI,
        (
            "-c",
            _FILE.format(
                file="custom", cls="MIMoCustomEnv", scene="os.path.join(SCENE_DIRECTORY, 'selfbody_scene.xml')"
            ),
        ),
        "ran",
    ),
)


def fetch(repository: str, commit: str, folder: Path) -> Path:
    """Fetches a commit of a repository, unless it is there."""
    target = folder / repository.replace("/", "+")
    if not (target / ".git").is_dir():
        target.mkdir(parents=True)
        address = f"https://github.com/{repository}.git"
        fetch_commit = ("fetch", "-q", "--depth", "1", address, commit)
        for command in (("init", "-q"), fetch_commit, ("checkout", "-q", "FETCH_HEAD")):
            subprocess.run(["git", "-C", str(target), *command], check=True)
    return target


def prepare(program: Program, folder: Path) -> Path:
    """Fetches what a program needs, and returns its folder."""
    target = fetch(program.repository, program.commit, folder)
    if program.beside is not None:
        name, repository, commit = program.beside
        other = fetch(repository, commit, folder)
        if not (target / name).exists():
            (target / name).symlink_to(other.resolve(), target_is_directory=True)
    return target


def run(program: Program, folder: Path) -> tuple[bool, str]:
    """Runs a program on this package, and tells whether it printed what it should, and its last line."""
    settings = {"BABYBENCH_MIMO": "babybench", "MPLBACKEND": "Agg", "PYTHONPATH": str(folder)}
    command = [sys.executable, "-W", "ignore", *program.command]
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env={**os.environ, **settings},
            capture_output=True,
            text=True,
            timeout=LIMIT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False, f"took more than {LIMIT} s"
    printed = done.stdout + done.stderr
    lines = [line for line in printed.splitlines() if line.strip("= ")]
    return done.returncode == 0 and program.prints in printed, lines[-1] if lines else ""


def main(folder: Path) -> int:
    """Runs all programs, and returns how many failed."""
    failed = 0
    for program in PROGRAMS:
        started = time.perf_counter()
        passed, last = run(program, prepare(program, folder))
        failed += not passed
        name = program.command[0] if program.command[0] != "-c" else program.prints
        seconds, state = time.perf_counter() - started, "ran" if passed else "FAILED"
        print(f"{state}  {program.repository}: {name} ({seconds:.0f} s)  {last[:100]}", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
