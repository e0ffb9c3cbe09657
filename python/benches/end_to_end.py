"""Whole runs of this package and of the starter kit in turn: how long a user waits, from the start of Python on.

    python benches/end_to_end.py KIT --kit-python KIT_PYTHON

KIT is a checkout of the starter kit, KIT_PYTHON a Python with what the kit needs (and Stable-Baselines3 for the second
table). The random policy is the kit's ``examples/random_selftouch.py``, unchanged, on both sides. The learner is the kit's
``examples/intrinsic_selftouch_count.py`` on its side and ``examples/ppo_selftouch.py``, the same reward on a vector, on this
one; it is left out where Stable-Baselines3 is not installed. Prints tables in Markdown.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
CONFIG = "examples/config_selftouch.yml"
Command = list[str]


def measure(command: Command, folder: Path, path: str = "") -> tuple[float, float, float]:
    """Runs a program to its end.

    Returns:
        Wall time and CPU time, s; the most memory it held, MB.
    """
    environment = {**os.environ, "MUJOCO_GL": os.environ.get("MUJOCO_GL", "osmesa")}
    if path:
        environment["PYTHONPATH"] = path
    with tempfile.TemporaryFile() as said:
        started = time.perf_counter()
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=said, stderr=said)
        _, status, used = os.wait4(process.pid, 0)
        wall = time.perf_counter() - started
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            said.seek(0)
            sys.exit(f"{' '.join(command)} failed:\n{said.read().decode(errors='replace')[-2000:]}")
    return wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def by_turns(title: str, kit: Command, ours: Command, room: Path, rounds: int) -> None:
    """Prints a table of two programs that run in turn."""
    found: dict[str, list[tuple[float, float, float]]] = {"starter kit": [], "this package": []}
    for _ in range(rounds):
        # a checkout without MIMo for this package, which stands in for it
        found["starter kit"].append(measure(kit, room / "kit", str(room / "kit" / "MIMo")))
        found["this package"].append(measure(ours, room / "ours"))
    print(f"\n| {title} | wall time, s | CPU time, s | memory, MB |\n|---|--:|--:|--:|")
    for name, runs in found.items():
        wall, cpu, memory = ([run[i] for run in runs] for i in range(3))
        print(f"| {name} | {listed(wall)} | {listed(cpu)} | {max(memory):.0f} |")
    pairs = list(zip(*found.values()))
    print(f"| ratio | {ratios(pairs, 0)} | {ratios(pairs, 1)} | {ratios(pairs, 2)} |", flush=True)


def listed(values: list[float]) -> str:
    """Writes numbers one after the other."""
    return ", ".join(f"{value:.2f}" if value < 10 else f"{value:.1f}" for value in values)


def ratios(pairs: list[tuple[tuple[float, float, float], ...]], column: int) -> str:
    """Writes the ratio of the first to the second number of each pair."""
    return ", ".join(f"{kit[column] / ours[column]:.1f}" for kit, ours in pairs)


def has_learner(python: str) -> bool:
    """Returns whether a Python has Stable-Baselines3."""
    find = "import importlib.util as i, sys; sys.exit(i.find_spec('stable_baselines3') is None)"
    return subprocess.run([python, "-c", find], check=False).returncode == 0


def main() -> None:
    """Prints the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kit", type=Path, help="a checkout of the starter kit")
    parser.add_argument("--kit-python", required=True, help="a Python with what the kit needs")
    parser.add_argument("--random-steps", type=int, default=2000)
    parser.add_argument("--learning-steps", type=int, default=4096, help="0 leaves the learner out")
    parser.add_argument("--rounds", type=int, default=3)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        room = Path(folder)
        shutil.copytree(chosen.kit, room / "kit")
        shutil.copytree(chosen.kit, room / "ours", ignore=lambda _, names: [n for n in names if n.endswith(".py")])
        shutil.copytree(chosen.kit / "examples", room / "ours" / "examples", dirs_exist_ok=True)
        script = ["examples/random_selftouch.py", "--train_for", str(chosen.random_steps)]
        title = f"random policy, {chosen.random_steps:,} steps"
        by_turns(title, [chosen.kit_python, *script], [sys.executable, *script], room, chosen.rounds)
        if chosen.learning_steps == 0:
            return
        if not (has_learner(chosen.kit_python) and has_learner(sys.executable)):
            print("\nPPO is left out: it needs Stable-Baselines3 on both sides.")
            return
        steps = str(chosen.learning_steps)
        by_turns(
            f"PPO, {chosen.learning_steps:,} steps",
            [chosen.kit_python, "examples/intrinsic_selftouch_count.py", "--train_for", steps],
            [sys.executable, str(EXAMPLES / "ppo_selftouch.py"), "--config", CONFIG, "--steps", steps],
            room,
            chosen.rounds,
        )


if __name__ == "__main__":
    main()
